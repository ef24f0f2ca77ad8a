//! Renders that are killed, interrupted, divided or given more samples: nothing is lost, and the picture is the same.

mod common;
#[path = "../../../tests/common/devices.rs"]
mod devices;

use common::running::Running;
use luminaire::picture::{self, Picture};
use std::path::PathBuf;
use std::process::{Command, Output};
use std::time::Duration;

/// Samples of a render that has to be interrupted: more where it was at its end before the signal came, as on a machine that is busy or fast.
const LONGER_AND_LONGER: [u32; 4] = [200, 1000, 5000, 25_000];

/// A folder of one test.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Folder(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// `luminaire render` of the Cornell box on the reference, with these options.
    fn render(&self, options: &str) -> Command {
        self.render_on("cpu", options)
    }

    fn render_on(&self, backend: &str, options: &str) -> Command {
        let mut command = self.luminaire(&["render"]);
        command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cornell/cornell.toml"));
        command.args(["--width", "48", "--backend", backend]).args(options.split_whitespace());
        command
    }

    fn luminaire(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
        command.current_dir(self.0.path()).args(words).env_remove("LUMINAIRE_VALIDATION");
        command
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    fn picture(&self, name: &str) -> Picture {
        picture::read(&self.path(name)).unwrap()
    }

    fn names(&self) -> Vec<String> {
        common::names(self.0.path())
    }

    /// Waits until a program has written a file.
    fn wait_for(&self, name: &str, program: &Running) {
        program.until(name, || self.path(name).exists().then_some(()));
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs a command that must do its work.
fn done(mut command: Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?} said:\n{}", said(&output));
    said(&output)
}

/// Runs a command that must fail with `code` and say `parts`.
fn fails(mut command: Command, code: i32, parts: &[&str]) {
    let output = command.output().unwrap();
    let said = said(&output);
    assert_eq!(output.status.code(), Some(code), "{command:?} said:\n{said}");
    for part in parts {
        assert!(said.contains(part), "{command:?} does not say {part:?}, but:\n{said}");
    }
    assert!(!said.contains("panicked"), "{said}");
}

/// The largest relative difference of two pictures' numbers.
fn furthest(a: &Picture, b: &Picture) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let pairs = a.rgb.as_flattened().iter().zip(b.rgb.as_flattened());
    pairs.map(|(a, b)| f64::from((a - b).abs()) / f64::from(b.abs()).max(1e-12)).fold(0.0, f64::max)
}

/// Kills a render at random moments until one run reaches the end; the picture must be that of a render that nobody killed.
fn killed_and_resumed(backend: &str, samples: [u32; 3]) {
    let enough = samples.into_iter().any(|spp| {
        let folder = Folder::new();
        done(folder.render_on(backend, &format!("--spp {spp} -o whole.exr --quiet")));
        let kills = kills(&folder, backend, spp);
        assert_eq!(folder.bytes("whole.exr"), folder.bytes("killed.exr"), "after {kills} kills");
        assert_eq!(folder.names(), ["c.exr", "killed.exr", "whole.exr"], "something is left over");
        kills >= 2
    });
    assert!(enough, "the renders are too short to be killed");
}

/// Renders `killed.exr`, and kills that up to eight times; how often it was.
fn kills(folder: &Folder, backend: &str, spp: u32) -> u32 {
    let options = format!("--spp {spp} -o killed.exr --checkpoint c.exr --checkpoint-every 0.01 --resume --quiet");
    let saved = || std::fs::metadata(folder.path("c.exr")).and_then(|file| file.modified()).ok();
    for kills in 0..8 {
        let before = saved();
        let program = Running::start(&mut folder.render_on(backend, &options));
        // Not before something new is saved: else a slow machine would never come to an end.
        program.until("a checkpoint, or the end", || (saved() != before || program.ended().is_some()).then_some(()));
        std::thread::sleep(Duration::from_micros(rand::random_range(0..60_000)));
        if let Some(status) = program.ended() {
            assert!(status.success(), "{}", program.state());
            return kills;
        }
        program.kill();
        if folder.path("killed.exr").exists() {
            assert_eq!(folder.bytes("whole.exr"), folder.bytes("killed.exr"), "a picture of an unfinished render");
        }
    }
    done(folder.render_on(backend, &options));
    8
}

#[test]
fn a_killed_render_goes_on_to_the_same_bits() {
    killed_and_resumed("cpu", [256, 1024, 4096]);
}

#[test]
fn a_killed_render_on_vulkan_goes_on_to_the_same_bits() {
    let bench = devices::bench();
    if bench.backends().contains(&luminaire::backend::Backend::ComputeBvh) {
        killed_and_resumed("compute-bvh", [1024, 4096, 16_384]);
    }
}

#[test]
fn an_interrupted_render_goes_on_to_the_same_bits() {
    for spp in LONGER_AND_LONGER {
        let folder = Folder::new();
        let options = format!("--spp {spp} -o part.exr --checkpoint c.exr --checkpoint-every 0.05");
        let program = Running::start(&mut folder.render(&options));
        folder.wait_for("c.exr", &program);
        // The shell's own `kill`: a bare system has no other.
        let signalled = Command::new("sh").args(["-c", &format!("kill -s TERM {}", program.id())]).status().unwrap();
        assert!(signalled.success());
        let output = program.output();
        if output.status.success() {
            continue;
        }
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(said(&output).contains("the same command with --resume goes on"), "{}", said(&output));
        done(folder.render(&format!("--spp {spp} -o whole.exr --quiet")));
        assert_ne!(folder.bytes("whole.exr"), folder.bytes("part.exr"), "the render was not interrupted");
        assert!(done(folder.render(&format!("{options} --resume"))).contains("going on from"));
        assert_eq!(folder.bytes("whole.exr"), folder.bytes("part.exr"));
        return;
    }
    panic!("no render is long enough to be interrupted");
}

#[test]
fn a_limit_of_the_noise_does_not_show_that_a_render_was_resumed() {
    let folder = Folder::new();
    done(folder.render("--noise 0.05 -o whole.exr --quiet"));
    let options = "--noise 0.05 -o resumed.exr --checkpoint c.exr --resume --quiet";
    for batches in ["1", "5", "4"] {
        let mut losing = folder.render(options);
        losing.env("LUMINAIRE_LOSE_DEVICE_AFTER", batches);
        fails(losing, 3, &["lost"]);
        assert_ne!(folder.bytes("whole.exr"), folder.bytes("resumed.exr"), "the render was at its end");
    }
    // Once more when it is finished: that must not add to it.
    for _ in 0..2 {
        done(folder.render(options));
        assert_eq!(folder.bytes("whole.exr"), folder.bytes("resumed.exr"));
    }
}

#[test]
fn a_finished_render_gets_more_samples() {
    let folder = Folder::new();
    done(folder.render("--spp 64 -o whole.exr --quiet"));
    let said = done(folder.render("--spp 16 -o more.exr --checkpoint c.exr --resume"));
    assert!(said.contains("no checkpoint yet; starting anew"), "{said}");
    done(folder.render("--spp 64 -o more.exr --checkpoint c.exr --resume --quiet"));
    assert_eq!(folder.bytes("whole.exr"), folder.bytes("more.exr"));
    // Fewer than there are: what there is.
    let said = done(folder.render("--spp 8 -o fewer.exr --checkpoint c.exr --resume"));
    assert!(said.contains("already held more samples") && said.contains("64"), "{said}");
    assert_eq!(folder.bytes("whole.exr"), folder.bytes("fewer.exr"));
}

#[test]
fn a_checkpoint_of_another_render_is_refused_with_the_difference() {
    let folder = Folder::new();
    done(folder.render("--spp 4 -o a.exr --checkpoint c.exr --quiet"));
    let before = folder.bytes("c.exr");
    let go_on = "--spp 8 -o b.exr --checkpoint c.exr --resume";
    for (options, difference) in [
        ("--seed 7", "seed (0 there, 7 here)"),
        ("--height 40", "size (48 x 48 there, 48 x 40 here)"),
        ("--sampler independent", "sampler"),
        ("--max-bounces 3", "integrator"),
        ("--samples 4..8 -o part.exr", "samples from number 0 on"),
    ] {
        let options = if options.starts_with("--samples") {
            format!("{options} --checkpoint c.exr --resume")
        } else {
            format!("{go_on} {options}")
        };
        fails(folder.render(&options), 1, &["c.exr", difference]);
    }
    // Another scene, whose digests differ.
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/shadows/shadows.toml");
    let mut other = folder.luminaire(&["render", scene, "--width", "48", "--height", "48", "--backend", "cpu"]);
    other.args(go_on.split_whitespace());
    fails(other, 1, &["geometry", "materials", "luminaires", "camera"]);
    // Without --resume it would be overwritten.
    fails(folder.render("--spp 8 -o b.exr --checkpoint c.exr"), 2, &["c.exr", "--resume"]);
    assert_eq!(folder.bytes("c.exr"), before);
    assert_eq!(folder.names(), ["a.exr", "c.exr"]);
}

#[test]
fn a_damaged_checkpoint_is_refused() {
    let folder = Folder::new();
    done(folder.render("--spp 4 -o a.exr --checkpoint c.exr --quiet"));
    let whole = folder.bytes("c.exr");
    let go_on = "--spp 8 -o b.exr --checkpoint c.exr --resume";
    for length in [0, 3, 40, 400, whole.len() / 2, whole.len() - 1] {
        std::fs::write(folder.path("c.exr"), &whole[..length]).unwrap();
        fails(folder.render(go_on), 1, &["c.exr"]);
    }
    std::fs::copy(folder.path("a.exr"), folder.path("c.exr")).unwrap();
    fails(folder.render(go_on), 1, &["not a part of a render", "--samples"]);
    std::fs::write(folder.path("c.exr"), "no picture at all").unwrap();
    fails(folder.render(go_on), 1, &["c.exr"]);
    // Wherever a byte is wrong, there is an error or a picture, and no panic.
    for _ in 0..40 {
        let mut bytes = whole.clone();
        let at = rand::random_range(0..bytes.len().min(3000));
        bytes[at] ^= rand::random_range(1..=255u8);
        std::fs::write(folder.path("c.exr"), &bytes).unwrap();
        let output = folder.render(go_on).output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1)), "byte {at}: {:?} {}", output.status, said(&output));
        assert!(!said(&output).contains("panicked"), "byte {at}: {}", said(&output));
    }
}

#[test]
fn parts_in_any_order_are_the_whole() {
    let folder = Folder::new();
    done(folder.render("--spp 48 -o whole.exr -o whole.png --quiet"));
    for range in ["0..16", "16..21", "21..48"] {
        done(folder.render(&format!("--samples {range} -o {range}.exr --quiet")));
    }
    let merge = |parts: &[&str], output: &str| {
        let mut command = folder.luminaire(&["merge", "-o", output]);
        command.args(parts);
        command
    };
    done(merge(&["21..48.exr", "0..16.exr", "16..21.exr"], "a.exr"));
    done(merge(&["0..16.exr", "16..21.exr", "21..48.exr"], "b.exr"));
    assert_eq!(folder.bytes("a.exr"), folder.bytes("b.exr"));
    let (whole, merged) = (folder.picture("whole.exr"), folder.picture("a.exr"));
    assert!(furthest(&merged, &whole) < 1e-6, "{:e}", furthest(&merged, &whole));
    // The error bar, too: every sample is in the block where the whole has it.
    let (expected, found) = (whole.error.unwrap(), merged.error.unwrap());
    for (e, f) in expected.as_flattened().iter().zip(found.as_flattened()) {
        assert!((e - f).abs() <= 1e-5 * e, "{f} for {e}");
    }
    done(merge(&["0..16.exr", "16..21.exr", "21..48.exr"], "a.png"));
    assert_eq!(folder.bytes("a.png"), folder.bytes("whole.png"));

    let before = folder.names();
    fails(merge(&["0..16.exr", "21..48.exr"], "c.exr"), 2, &["samples 16..21 are in none", "--samples 16..21"]);
    fails(merge(&["16..21.exr", "21..48.exr"], "c.exr"), 2, &["samples 0..16 are in none"]);
    fails(merge(&["0..16.exr", "0..16.exr"], "c.exr"), 2, &["samples 0..16 are in both 0..16.exr"]);
    fails(merge(&["0..16.exr", "whole.exr"], "c.exr"), 1, &["whole.exr", "not a part of a render"]);
    fails(merge(&["0..16.exr", "16..21.exr"], "16..21.exr"), 2, &["one of the parts"]);
    fails(merge(&["0..16.exr", "16..21.exr"], "./16..21.exr"), 2, &["one of the parts"]);
    fails(merge(&["0..16.exr", "none.exr"], "c.exr"), 1, &["none.exr"]);
    assert_eq!(folder.names(), before);
    done(folder.render("--samples 16..48 --seed 5 -o other.exr --quiet"));
    fails(merge(&["0..16.exr", "other.exr"], "c.exr"), 2, &["0..16.exr", "other.exr", "seed (0 in the first, 5"]);
    done(folder.render("--samples 12..48 -o overlap.exr --quiet"));
    fails(merge(&["overlap.exr", "0..16.exr"], "c.exr"), 2, &["samples 12..16 are in both 0..16.exr", "overlap.exr"]);
}

#[test]
fn an_unfinished_part_is_not_merged() {
    let folder = Folder::new();
    let options = "--samples 0..1000000 -o part.exr --checkpoint c.exr --checkpoint-every 0.01";
    let program = Running::start(&mut folder.render(options));
    folder.wait_for("c.exr", &program);
    program.kill();
    // Also where the kill came between two passes, so that all pixels have equally many samples.
    fails(folder.luminaire(&["merge", "c.exr", "-o", "a.exr"]), 2, &["c.exr", "not finished", "--samples 0.."]);
}

#[test]
fn parts_are_asked_for_with_sense() {
    let folder = Folder::new();
    for bad in ["8..8", "8..4", "8", "a..b", "0..4294967296"] {
        fails(folder.render(&format!("--samples {bad} -o a.exr")), 2, &["--samples", "64..128"]);
    }
    fails(folder.render("--samples 0..4 -o a.png"), 2, &["-o PART.exr"]);
    fails(folder.render("--samples 0..4 --spp 4 -o a.exr"), 2, &["--spp"]);
    fails(folder.render("--spp 4 --resume"), 2, &["--checkpoint"]);
    fails(folder.render("--spp 4 --checkpoint c.png"), 2, &["c.png", ".exr"]);
    fails(folder.render("--spp 4 --checkpoint a.exr -o a.exr"), 2, &["a.exr"]);
    // The same file by another name.
    fails(folder.render("--spp 4 --checkpoint ./a.exr -o a.exr"), 2, &["a.exr", "twice"]);
    fails(folder.render("--spp 4 --checkpoint none/c.exr"), 1, &["none", "does not exist"]);
    assert!(folder.names().is_empty());
}

#[test]
fn a_device_that_fails_costs_nothing() {
    let folder = Folder::new();
    done(folder.render("--spp 64 -o whole.exr --quiet"));
    let options = "--spp 64 -o lost.exr --checkpoint c.exr --resume";
    let mut losing = folder.render(options);
    losing.env("LUMINAIRE_LOSE_DEVICE_AFTER", "9");
    fails(losing, 3, &["error: ", "lost", "the same command goes on from the checkpoint"]);
    assert_ne!(folder.bytes("whole.exr"), folder.bytes("lost.exr"), "the render did not fail");
    done(folder.render(options));
    assert_eq!(folder.bytes("whole.exr"), folder.bytes("lost.exr"));
}

#[test]
fn a_folder_that_disappears_costs_only_what_was_to_be_written_there() {
    for spp in LONGER_AND_LONGER {
        let folder = Folder::new();
        std::fs::create_dir(folder.path("out")).unwrap();
        let options = format!("--spp {spp} --checkpoint c.exr --checkpoint-every 0.01 --resume -o");
        let program = Running::start(&mut folder.render(&format!("{options} out/a.exr")));
        folder.wait_for("c.exr", &program);
        // Also with a picture in it: that render was at its end.
        std::fs::remove_dir_all(folder.path("out")).unwrap();
        let output = program.output();
        if output.status.success() {
            continue;
        }
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("out/a.exr") && said.contains("in the checkpoint"), "{said}");
        done(folder.render(&format!("{options} a.exr --quiet")));
        done(folder.render(&format!("--spp {spp} -o whole.exr --quiet")));
        assert_eq!(folder.bytes("a.exr"), folder.bytes("whole.exr"));
        return;
    }
    panic!("no render is long enough to lose its folder");
}

#[test]
fn a_checkpoint_that_cannot_be_written_does_not_end_a_render() {
    for spp in LONGER_AND_LONGER {
        let folder = Folder::new();
        std::fs::create_dir(folder.path("saves")).unwrap();
        let options = format!("--spp {spp} --checkpoint saves/c.exr --checkpoint-every 0.01 -o a.exr");
        let program = Running::start(&mut folder.render(&options));
        folder.wait_for("saves/c.exr", &program);
        // Again where the render puts a file there meanwhile.
        while std::fs::remove_dir_all(folder.path("saves")).is_err() && folder.path("saves").exists() {}
        let output = program.output();
        if output.status.success() {
            continue;
        }
        let said = said(&output);
        // The picture is there all the same.
        assert_eq!(output.status.code(), Some(1), "{said}");
        if !said.contains("warning: cannot write saves/c.exr") {
            continue; // Only the last checkpoint was still to come.
        }
        assert!(said.contains("error: cannot write saves"), "{said}");
        done(folder.render(&format!("--spp {spp} -o whole.exr --quiet")));
        assert_eq!(folder.bytes("a.exr"), folder.bytes("whole.exr"));
        return;
    }
    panic!("no render is long enough to lose its folder");
}

/// Renders the Cornell box on the reference, larger than the other tests do.
fn large(folder: &Folder, options: &str) -> Running {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cornell/cornell.toml");
    let mut command = folder.luminaire(&["render", scene, "--backend", "cpu"]);
    Running::start(command.args(options.split_whitespace()))
}

/// Sends SIGTERM to a program so often. The shell's own `kill`: a bare system has no other.
fn terminate(program: &Running, times: usize) {
    let line = vec![format!("kill -s TERM {}", program.id()); times].join("; ");
    let _ = Command::new("sh").args(["-c", &line]).output().unwrap();
}

#[test]
fn an_interrupt_while_the_checkpoint_is_saved_ends_the_render_afterwards() {
    for times in [1, 2, 3] {
        let folder = Folder::new();
        // Hardly anything but saving.
        let options = "--width 256 --height 256 --time 600 -o a.exr --checkpoint c.exr --checkpoint-every 0.000001";
        let program = large(&folder, options);
        folder.wait_for("c.exr", &program);
        terminate(&program, times);
        let output = program.output();
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(!said(&output).contains("nothing is written"), "{}", said(&output));
        assert!(
            !folder.names().iter().any(|name| name.ends_with(".tmp") || name.ends_with(".lock")),
            "{times}: {:?}",
            folder.names()
        );
    }
}

#[test]
fn an_interrupt_while_layers_are_made_costs_only_the_layers() {
    let folder = Folder::new();
    let program =
        large(&folder, "--width 640 --height 480 --spp 1 --aov -o a.exr --checkpoint c.exr --checkpoint-every 600");
    folder.wait_for("c.exr", &program);
    terminate(&program, 1);
    let output = program.output();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    assert!(said(&output).contains("without layers"), "{}", said(&output));
    assert!(picture::read(&folder.path("a.exr")).is_ok());
    assert!(!folder.bytes("a.exr")[..4096].windows(8).any(|bytes| bytes == b"albedo.R"), "there are layers");
}

#[cfg(unix)]
#[test]
fn a_failed_device_and_a_failed_file_are_both_told() {
    let folder = Folder::new();
    let render = folder.render("-o a.exr --quiet");
    let words: Vec<_> = render.get_args().map(|word| word.to_str().unwrap()).collect();
    // No file may become larger than nothing.
    let line = format!("trap '' XFSZ; ulimit -f 0; exec {} {}", env!("CARGO_BIN_EXE_luminaire"), words.join(" "));
    let mut losing = Command::new("sh");
    losing.current_dir(folder.0.path()).args(["-c", &line]).env("LUMINAIRE_LOSE_DEVICE_AFTER", "1");
    fails(losing, 3, &["lost", "cannot write"]);
    assert_eq!(folder.names(), [""; 0]);
}
