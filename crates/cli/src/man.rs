//! `luminaire man`: manual pages, from the definition that `--help` shows.

use crate::shared::outputs::Outputs;
use crate::shared::printing::print;
use clap::Command;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use luminaire::files::save_text;
use luminaire::{Error, Result};
use std::path::PathBuf;
use std::process::ExitCode;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire man | man -l -
      reads the manual page
  luminaire man ~/.local/share/man/man1
      installs all of them for yourself: then `man luminaire-render`

Exit codes:
  0  printed or written
  1  a page cannot be written
  2  wrong usage: a page would replace a file that luminaire has not written";

/// Where to.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// The folder for luminaire.1, luminaire-render.1 and so on; it is made if it is missing [default: only luminaire.1, to standard output].
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// The page of the program, and those of its subcommands.
pub struct Pages {
    /// luminaire.1.
    pub program: Page,
    /// luminaire-render.1 and so on.
    pub subcommands: Vec<Page>,
}

/// A manual page.
pub struct Page {
    /// The name of its file.
    pub name: String,
    /// roff.
    pub text: String,
}

/// Prints the page of the program, or writes all pages to a folder; `program` is the definition of all options.
pub fn run(options: &Options, program: Command) -> Result<ExitCode> {
    let pages = pages(program);
    let Some(folder) = &options.folder else {
        print(&pages.program.text)?;
        return Ok(ExitCode::SUCCESS);
    };
    std::fs::create_dir_all(folder).map_err(|e| Error::write(folder, format!("the folder cannot be made ({e})")))?;
    let pages: Vec<_> = std::iter::once(pages.program).chain(pages.subcommands).collect();
    let mut outputs = Outputs::default();
    pages.iter().try_for_each(|page| outputs.add_default("DIR", &folder.join(&page.name)))?;
    outputs.check([])?;
    for page in pages {
        let path = folder.join(page.name);
        save_text(&path, &page.text)?;
        print(&format!("{}\n", path.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// All pages.
pub fn pages(program: Command) -> Pages {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    Pages { program: page(&program), subcommands: program.get_subcommands().map(page).collect() }
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

/// The text that follows the options in `--help`, under the headings that manual pages use.
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
