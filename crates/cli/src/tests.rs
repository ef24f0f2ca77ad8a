//! The definition of all options, and what is made from it.

use crate::Args;
use crate::completions::script;
use crate::man::{Pages, pages};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};
use clap_complete::Shell;
use std::process::Command;

#[test]
fn the_definition_is_sound() {
    Args::command().debug_assert();
}

/// What bash offers for the last of `words`.
fn offered(words: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("luminaire.bash"), script(Shell::Bash, Args::command())).unwrap();
    let (line, last) = (words.join(" "), words.len() - 1);
    let ask = format!(
        "set -eu; . ./luminaire.bash; COMP_WORDS=({line}); COMP_CWORD={last}; _luminaire luminaire '{}' '{}'; \
         printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        words[last],
        words[last - 1]
    );
    let output = Command::new("bash").current_dir(folder.path()).args(["--norc", "-c", &ask]).output();
    let output = output.expect("bash runs");
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn bash_completes_subcommands_options_and_values() {
    assert_eq!(offered(&["luminaire", "ren"]), ["render"]);
    assert_eq!(offered(&["luminaire", "render", "--back"]), ["--backend"]);
    assert_eq!(offered(&["luminaire", "render", "--backend", "c"]), ["compute-bvh", "cpu"]);
    assert_eq!(offered(&["luminaire", "completions", "z"]), ["zsh"]);
}

#[test]
fn every_shell_has_a_script_that_knows_every_subcommand() {
    for shell in <Shell as clap::ValueEnum>::value_variants() {
        let script = script(*shell, Args::command());
        for command in Args::command().get_subcommands() {
            assert!(script.contains(command.get_name()), "{shell}: {}", command.get_name());
        }
    }
}

#[test]
fn every_subcommand_has_a_page_with_examples_and_exit_codes() {
    let Pages { program: main, subcommands: others } = pages(Args::command());
    let subcommands: Vec<_> = Args::command().get_subcommands().map(|c| c.get_name().to_owned()).collect();
    assert_eq!(main.name, "luminaire.1");
    assert_eq!(
        others.iter().map(|page| page.name.clone()).collect::<Vec<_>>(),
        subcommands.iter().map(|name| format!("luminaire-{name}.1")).collect::<Vec<_>>()
    );
    for page in others.iter().chain([&main]) {
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "EXAMPLES", "\"EXIT STATUS\""] {
            assert_eq!(page.text.matches(&format!("\n.SH {section}\n")).count(), 1, "{} {section}", page.name);
        }
        let (_, status) = page.text.split_once("EXIT STATUS").unwrap();
        for code in ["\n  0 ", "\n  1 ", "\n  2 "] {
            assert!(status.contains(code), "{}: {code:?} in\n{status}", page.name);
        }
    }
    for name in &subcommands {
        assert!(main.text.contains(&format!("luminaire\\-{name}(1)")), "{name} in\n{}", main.text);
    }
    let render = &others[subcommands.iter().position(|name| name == "render").unwrap()].text;
    assert!(render.contains("\\-\\-backend") && render.contains("ray\\-query"), "{render}");
}

/// The command lines of a page: lines of its code that begin with `luminaire`, and code within its text that does.
fn command_lines(page: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for (index, part) in page.split("```").enumerate() {
        if index % 2 == 0 {
            let code = part.split('`').skip(1).step_by(2);
            lines.extend(code.filter(|code| code.starts_with("luminaire ")).map(|code| code.replace('\n', " ")));
            continue;
        }
        let joined = part.replace("\\\n", " ");
        let commands = joined.lines().flat_map(|line| line.split("&&")).map(str::trim);
        lines.extend(commands.filter(|line| line.starts_with("luminaire ")).map(str::to_owned));
    }
    lines
}

/// The words of a command line, without a comment and without what a shell does behind it.
fn words(line: &str) -> Vec<String> {
    let ends = |word: &&str| !(word.starts_with('#') || ["|", ">", "2>", "||", ";", "&"].contains(word));
    line.split_whitespace().take_while(ends).map(|word| word.trim_matches(['"', '\'', ';']).to_owned()).collect()
}

/// Every command line of the pages can be read. Where a page names a part of one, something may be missing.
#[test]
fn the_commands_of_all_pages_are_read() {
    let house = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let docs = std::fs::read_dir(house.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = docs.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let more = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "scenes/README.md"].map(|name| house.join(name));
    let (mut count, mut wrong) = (0, Vec::new());
    for path in pages.chain(more) {
        for line in command_lines(&std::fs::read_to_string(&path).unwrap()) {
            count += 1;
            // What others write in the place of values, and features that are not built in.
            if line.contains("...") || line.contains("--watch") || line.contains("--denoised") || line.contains("${") {
                continue;
            }
            let Err(error) = Args::try_parse_from(words(&line)) else { continue };
            let partial = [
                ErrorKind::MissingRequiredArgument,
                ErrorKind::DisplayHelp,
                ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand,
                ErrorKind::DisplayVersion,
            ];
            // A value that is left out, or stands for one.
            let stands_for_one = match error.get(ContextKind::InvalidValue) {
                Some(ContextValue::String(value)) => value.chars().all(|c| c.is_ascii_uppercase()),
                _ => false,
            };
            if !partial.contains(&error.kind()) && !stands_for_one {
                wrong.push(format!("{}: {line}\n{error}", path.display()));
            }
        }
    }
    assert!(count > 40, "only {count} command lines were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
