//! `luminaire completions`.

use crate::shared::printing::print;
use clap_complete::Shell;
use luminaire::Result;
use std::process::ExitCode;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire completions bash > ~/.local/share/bash-completion/completions/luminaire
      for yourself; for everyone: /usr/share/bash-completion/completions/luminaire
  luminaire completions zsh > ~/.zfunc/_luminaire
      with `fpath=(~/.zfunc $fpath)` before `compinit` in ~/.zshrc
  luminaire completions fish > ~/.config/fish/completions/luminaire.fish

Exit codes:
  0  printed
  1  standard output cannot be written
  2  wrong usage: there is no script for this shell";

/// For which shell.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// The shell that will read the script.
    shell: clap_complete::Shell,
}

/// Prints the script for a shell; `program` is the definition of all options.
pub fn run(options: &Options, program: clap::Command) -> Result<ExitCode> {
    print(&script(options.shell, program))?;
    Ok(ExitCode::SUCCESS)
}

/// The script: what the shell is to do when somebody presses Tab behind `luminaire`.
pub fn script(shell: Shell, mut program: clap::Command) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, env!("CARGO_BIN_NAME"), &mut script);
    String::from_utf8_lossy(&script).into_owned()
}
