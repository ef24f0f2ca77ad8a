//! The program `luminaire`: options, one call of the library, a message and an exit code. Results go to stdout, everything else to stderr.

#![allow(rustdoc::invalid_html_tags, reason = "doc comments of options are their help, where <NAME> stands for a name")]

mod advice;
mod bench;
mod compare;
mod completions;
mod devices;
mod inspect;
mod man;
mod merge;
mod render;
mod scene;
mod shared;
mod stability;
mod view;

#[cfg(test)]
mod tests;

use clap::{CommandFactory, Parser};
use shared::exit_codes::EXIT_CODES;
use shared::printing;
use std::ffi::{OsStr, OsString};
use std::process::ExitCode;

/// Before the exit codes in `--help`.
const EXAMPLES: &str = "\
Examples:
  luminaire render scenes/cornell/cornell.toml
  luminaire render model.obj -o model.png -o model.exr --spp 256
  luminaire render model.obj -o model.png --checkpoint model.checkpoint.exr --resume
  luminaire view model.obj
  luminaire compare model.exr reference.exr
  luminaire inspect model.obj
  luminaire scene model.obj > model.toml
  luminaire devices
  luminaire stability --list
  luminaire bench --quick

";

// The program's name is not its package's, which clap would take.
/// A Vulkan path tracer: ray queries or a compute-shader BVH, proved against a double-precision reference.
#[derive(Debug, clap::Parser)]
#[command(name = env!("CARGO_BIN_NAME"), version, after_help = format!("{EXAMPLES}{EXIT_CODES}"), subcommand_required = true)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Render a scene to PNG, EXR or HDR files.
    Render(render::Options),
    /// Join the parts of a render that --samples wrote.
    Merge(merge::Options),
    /// Show a scene in a window: the camera moves, and the picture gets better while it rests.
    View(view::Options),
    /// Tell how far a picture is from a reference, and whether that is within limits.
    Compare(compare::Options),
    /// List every Vulkan device, what it offers, and which backend it would run and why.
    #[command(after_help = devices::HELP)]
    Devices,
    /// Show what was loaded from a scene, and every warning.
    Inspect(inspect::Options),
    /// Write the scene file that a bare OBJ gets, with every key explained.
    Scene(scene::Options),
    /// Run methods over the ranges in which they can fail, on every backend here: charts, numbers, and a page.
    Stability(stability::Options),
    /// Measure speed against accuracy: scenes, backends and estimators side by side, as a page, charts and numbers.
    Bench(bench::Options),
    /// Print a script with which a shell completes subcommands, options and their values.
    Completions(completions::Options),
    /// Print the manual page, or write one page for each subcommand to a folder.
    Man(man::Options),
}

/// The words of a command line, in which `--option -1,2` is written `--option=-1,2`: what begins with a minus and a digit is a value, also one that is no number, so
/// that the option itself says what it expects.
fn negative_values(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = vec![];
    for word in words {
        let is_negative = word.as_encoded_bytes().strip_prefix(b"-").is_some_and(|rest| {
            // Numbers as such are known to be values.
            rest.first().is_some_and(u8::is_ascii_digit)
                && std::str::from_utf8(rest).map_or(true, |n| n.parse::<f64>().is_err())
        });
        match joined.last_mut() {
            Some(option) if is_negative && is_long_option(option) => {
                option.push("=");
                option.push(word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

/// Whether a word is an option that has no value yet.
fn is_long_option(word: &OsStr) -> bool {
    word.as_encoded_bytes().strip_prefix(b"--").is_some_and(|name| !name.is_empty() && !name.contains(&b'='))
}

fn main() -> ExitCode {
    luminaire::backend::fit_threads();
    // Where memory is refused, Rust says so and aborts, as drivers do: that is a failure like others, and no crash.
    #[cfg(unix)]
    let _ = signal_hook::flag::register_conditional_shutdown(
        signal_hook::consts::SIGABRT,
        1,
        std::sync::Arc::new(std::sync::atomic::AtomicBool::new(true)),
    );
    let given = negative_values(std::env::args_os());
    let words: Vec<String> = given.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let args =
        Args::try_parse_from(&given).unwrap_or_else(|error| advice::with_advice(error, &words, Args::command()).exit());
    let result = match &args.command {
        Command::Render(options) => render::run(options),
        Command::Merge(options) => merge::run(options),
        Command::View(options) => view::run(options),
        Command::Compare(options) => compare::run(options),
        Command::Devices => devices::run(),
        Command::Inspect(options) => inspect::run(options),
        Command::Scene(options) => scene::run(options),
        Command::Stability(options) => stability::run(options),
        Command::Bench(options) => bench::run(options),
        Command::Completions(options) => completions::run(options, Args::command()),
        Command::Man(options) => man::run(options, Args::command()),
    };
    let code = result.unwrap_or_else(|error| {
        printing::error(&error);
        ExitCode::from(error.exit_code())
    });
    match luminaire::gpu::validation_messages() {
        0 => code,
        count => {
            printing::error(format_args!("the Vulkan validation layer had {count} complaints; see above"));
            ExitCode::FAILURE
        }
    }
}
