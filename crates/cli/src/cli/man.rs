//! `luminaire man`: manual pages, from the definition that `--help` shows.

use super::{Args, print};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use luminaire::files::save_text;
use luminaire::{Error, Result};
use std::path::Path;
use std::process::ExitCode;

/// A manual page.
struct Page {
    /// The name of its file.
    name: String,
    /// roff.
    text: String,
}

/// Prints the page of the program, or writes all pages to a folder.
pub fn run(folder: Option<&Path>) -> Result<ExitCode> {
    let (main, others) = pages();
    let Some(folder) = folder else {
        print(&main.text)?;
        return Ok(ExitCode::SUCCESS);
    };
    std::fs::create_dir_all(folder).map_err(|e| Error::write(folder, format!("the folder cannot be made ({e})")))?;
    for page in std::iter::once(main).chain(others) {
        let path = folder.join(page.name);
        save_text(&path, &page.text)?;
        print(&format!("{}\n", path.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The page of the program, and one for each subcommand.
fn pages() -> (Page, Vec<Page>) {
    let mut program = Args::command().disable_help_subcommand(true);
    program.build();
    (page(&program), program.get_subcommands().map(page).collect())
}

fn page(command: &Command) -> Page {
    let release = concat!(env!("CARGO_BIN_NAME"), " ", env!("CARGO_PKG_VERSION"));
    let man = Man::new(command.clone()).source(release);
    let mut text = Vec::new();
    let mut write = || {
        man.render_title(&mut text)?;
        man.render_name_section(&mut text)?;
        man.render_synopsis_section(&mut text)?;
        man.render_description_section(&mut text)?;
        man.render_options_section(&mut text)?;
        if command.has_subcommands() {
            man.render_subcommands_section(&mut text)?;
        }
        end(command).to_writer(&mut text)
    };
    write().expect("memory takes what is written to it");
    Page { name: man.get_filename(), text: String::from_utf8_lossy(&text).into_owned() }
}

/// The sections that stand behind the options in `--help`, by the names that they have in manual pages.
fn end(command: &Command) -> Roff {
    let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let mut roff = Roff::new();
    for line in help.lines() {
        match line {
            "Examples:" => roff.control("SH", ["EXAMPLES"]),
            "Exit codes:" => roff.control("SH", ["EXIT STATUS"]),
            "" => roff.control("PP", []),
            // Each on a line of its own, as in the help.
            _ => roff.text([roman(line)]).control("br", []),
        };
    }
    if !command.has_subcommands() {
        roff.control("SH", ["SEE ALSO"]).text([bold("luminaire"), roman("(1)")]);
    }
    roff
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subcommand_has_a_page_with_examples_and_exit_codes() {
        let (main, others) = pages();
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
}
