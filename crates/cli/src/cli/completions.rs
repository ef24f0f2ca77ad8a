//! `luminaire completions`.

use super::{Args, print};
use clap::CommandFactory;
use clap_complete::Shell;
use luminaire::Result;
use std::process::ExitCode;

/// Prints the script for a shell.
pub fn run(shell: Shell) -> Result<ExitCode> {
    print(&script(shell))?;
    Ok(ExitCode::SUCCESS)
}

/// The script: what the shell is to do when somebody presses Tab behind `luminaire`.
fn script(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), env!("CARGO_BIN_NAME"), &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    /// What bash offers for the last of `words`.
    fn offered(words: &[&str]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("luminaire.bash"), script(Shell::Bash)).unwrap();
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
            let script = script(*shell);
            for command in Args::command().get_subcommands() {
                assert!(script.contains(command.get_name()), "{shell}: {}", command.get_name());
            }
        }
    }
}
