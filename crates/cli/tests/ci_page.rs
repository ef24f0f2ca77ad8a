//! The workflow of docs/ci.md is run, not read: its commands, on a small scene, with a clone of this repository where it says OWNER's.

#[path = "../../../tests/common/devices.rs"]
mod devices;

use devices::skip;
use std::path::Path;
use std::process::{Command, Output};

const HOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// What stands between a line of three backticks with `language` and the next one.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap_or_default().to_owned()).collect()
}

/// The steps of a workflow that run something: name and script.
fn steps(workflow: &str) -> Vec<(String, String)> {
    let mut steps = Vec::new();
    let mut name = String::new();
    let mut lines = workflow.lines().peekable();
    while let Some(line) = lines.next() {
        let words = line.trim_start();
        if let Some(found) = words.strip_prefix("- name: ") {
            name = found.to_owned();
        }
        let Some(script) = words.strip_prefix("run: ") else { continue };
        let mut script = script.to_owned();
        if script == "|" {
            // All that is further to the right.
            let depth = line.len() - words.len();
            script.clear();
            while let Some(next) =
                lines.next_if(|next| next.trim().is_empty() || next.len() - next.trim_start().len() > depth)
            {
                script += next.trim_start();
                script.push('\n');
            }
        }
        steps.push((name.clone(), script));
    }
    steps
}

/// The value of a variable under `env`.
fn variable(workflow: &str, name: &str) -> String {
    let prefix = format!("  {name}: ");
    let line = workflow.lines().find_map(|line| line.strip_prefix(&prefix));
    line.unwrap_or_else(|| panic!("{name} is not under env")).to_owned()
}

fn page() -> String {
    std::fs::read_to_string(format!("{HOUSE}/docs/ci.md")).unwrap()
}

fn git(words: &[&str]) -> Option<Output> {
    Command::new("git").current_dir(HOUSE).args(words).output().ok().filter(|output| output.status.success())
}

/// The line that installs names the one package of the repository that has the program, and a commit that git would find.
#[test]
fn what_it_installs_is_there() {
    let page = page();
    let workflow = blocks(&page, "yaml").remove(0);
    let (_, install) = steps(&workflow).into_iter().find(|(_, script)| script.contains("cargo install")).unwrap();
    let words: Vec<&str> = install.split_whitespace().map(|word| word.trim_matches('"')).collect();
    assert_eq!(words[..6], ["cargo", "install", "--locked", "--git", "$LUMINAIRE", "--rev"], "{install}");
    let ["$COMMIT", package] = words[6..] else { panic!("{install}") };
    assert!(variable(&workflow, "LUMINAIRE").starts_with("https://"), "git clones it");
    assert_eq!(variable(&workflow, "COMMIT").len(), 40, "cargo install --rev wants all of it");

    if git(&["rev-parse", "--is-inside-work-tree"]).is_none() {
        return skip("git or its repository is missing: the commands of docs/ci.md were not tried on a clone");
    }
    let folder = tempfile::tempdir().unwrap();
    let clone = folder.path().join("clone");
    let source = format!("file://{}", house());
    let output = Command::new("git").args(["clone", "--quiet", "--depth", "1", &source]).arg(&clone).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // As Cargo does with --git: every Cargo.toml of the clone is a candidate.
    let manifests = Command::new("git").current_dir(&clone).args(["ls-files", "*Cargo.toml"]).output().unwrap();
    let mut with_the_program = Vec::new();
    for manifest in String::from_utf8(manifests.stdout).unwrap().lines() {
        let metadata = Command::new(env!("CARGO"))
            .current_dir(&clone)
            .args(["metadata", "--no-deps", "--format-version", "1", "--offline", "--manifest-path", manifest])
            .output()
            .unwrap();
        assert!(metadata.status.success(), "{manifest}: {}", String::from_utf8_lossy(&metadata.stderr));
        let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).unwrap();
        for found in metadata["packages"].as_array().unwrap() {
            let targets = found["targets"].as_array().unwrap();
            if targets.iter().any(|target| target["kind"][0] == "bin" && target["name"] == "luminaire") {
                with_the_program.push(found["name"].as_str().unwrap().to_owned());
            }
        }
    }
    with_the_program.sort();
    with_the_program.dedup();
    assert_eq!(with_the_program, [package], "the packages with the program luminaire");
    // --locked wants it.
    assert!(clone.join("Cargo.lock").is_file());
}

/// This repository's folder, without `..`.
fn house() -> String {
    Path::new(HOUSE).canonicalize().unwrap().display().to_string()
}

/// Its other commands, in their order, do what they are for; so do those for a shell, and a wrong picture fails.
#[cfg(unix)]
#[test]
fn its_commands_work() {
    if luminaire::backend::devices().is_ok_and(|devices| devices.iter().all(|device| device.backend.is_err())) {
        return skip("no Vulkan device is usable: the commands of docs/ci.md were not run");
    }
    let page = page();
    let workflow = blocks(&page, "yaml").remove(0);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["bin", "scenes", "tests"] {
        std::fs::create_dir(path(name)).unwrap();
    }
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_luminaire"), path("bin/luminaire")).unwrap();
    let (scene, reference) = (variable(&workflow, "SCENE"), variable(&workflow, "REFERENCE"));
    // Without the lamp, at whose edges so few pixels would differ by chance.
    let sensor = "[sensor]\nposition = [278, 273, -800]\ntarget = [278, 200, 280]\nfov = 20\n";
    let object = format!("[[object]]\nmesh = '{}/scenes/cornell/cornell.obj'\n", house());
    std::fs::write(path(&scene), format!("[film]\nwidth = 24\nheight = 24\n{sensor}{object}")).unwrap();
    let run = |script: &str| {
        let bin = format!("{}:{}", path("bin").display(), std::env::var("PATH").unwrap_or_default());
        let mut shell = Command::new("sh");
        shell.current_dir(folder.path()).args(["-e", "-c", script]);
        shell.env("PATH", bin).env("SCENE", &scene).env("REFERENCE", &reference).output().unwrap()
    };
    let works = |script: &str| {
        let output = run(script);
        assert!(output.status.success(), "{script}\n{}", String::from_utf8_lossy(&output.stderr));
    };
    let shell = blocks(&page, "sh");
    let making = shell.iter().find(|script| script.contains("--seed 1 -o")).expect("how the reference is made");
    works(making);
    assert!(path(&reference).is_file(), "the reference is made where the workflow looks for it");

    let steps = steps(&workflow);
    let names: Vec<&str> = steps.iter().map(|(name, _)| name.as_str()).collect();
    let expected = ["A Vulkan driver that needs no GPU", "Build luminaire", "What will run", "Render", "Compare"];
    assert_eq!(names, expected);
    for (_, script) in &steps[2..] {
        works(script);
    }
    for name in ["picture.exr", "picture.png", "run.json", "error.png", "error.json"] {
        assert!(path("out").join(name).is_file(), "{name}");
    }
    let alone = shell.iter().find(|script| script.contains("mkdir -p out")).expect("the commands for a shell");
    works(alone);

    // Another picture is noticed.
    let (_, render) = &steps[3];
    let (_, compare) = &steps[4];
    works(&format!("{} --max-bounces 0", render.trim_end()));
    assert_eq!(run(compare).status.code(), Some(1), "a picture without its indirect light is within the limits");
}
