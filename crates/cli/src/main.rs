//! The command line: arguments, one library call, exit code and message.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = cli::Args::parse();
    let done = match &args.command {
        cli::Command::Render(options) => cli::render::run(options),
        cli::Command::View(options) => cli::view::run(options),
        cli::Command::Merge(options) => cli::merge::run(options),
        cli::Command::Compare(options) => cli::compare::run(options),
        cli::Command::Devices => cli::devices::run(),
        cli::Command::Inspect(options) => cli::inspect::run(&options.scene),
        cli::Command::Stability(options) => cli::stability::run(options),
        cli::Command::Bench(options) => cli::bench::run(options),
        cli::Command::Completions(options) => cli::completions::run(options.shell),
        cli::Command::Man(options) => cli::man::run(options.folder.as_deref()),
    };
    let code = done.unwrap_or_else(|error| {
        cli::tell(&format!("error: {error}"));
        ExitCode::from(error.exit_code())
    });
    match luminaire::gpu::validation_messages() {
        0 => code,
        count => {
            cli::tell(&format!("error: the Vulkan validation layer had {count} complaints; see above"));
            ExitCode::FAILURE
        }
    }
}
