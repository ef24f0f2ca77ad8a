//! `luminaire stability`.

use super::progress::duration;
use super::{StabilityOptions, print, table, tell};
use luminaire::files::{check_writable, save_text};
use luminaire::{Error, Result};
use luminaire_measure::Workbench;
use luminaire_measure::stability::{Definition, Head, Outcome, SWEEPS, Sweep, named, page};
use std::path::{Component, Path};
use std::process::ExitCode;
use std::time::Instant;

/// Where the files go unless `--out` says otherwise.
const FOLDER: &str = "stability";

/// Runs the sweeps and writes what they found. One that fails does not stop the others.
pub fn run(options: &StabilityOptions) -> Result<ExitCode> {
    if options.list {
        let rows: Vec<_> = SWEEPS.iter().map(|sweep| vec![sweep.name.into(), sweep.title.into()]).collect();
        print(&table(0, &rows))?;
        return Ok(ExitCode::SUCCESS);
    }
    let sweeps = named(&options.sweeps)?;
    let folder = options.out.clone().unwrap_or_else(|| FOLDER.into());
    let file = options.page.clone().unwrap_or_else(|| folder.join("README.md"));
    std::fs::create_dir_all(&folder).map_err(|e| Error::write(&folder, format!("the folder cannot be made ({e})")))?;
    check_writable(&folder.join("check.csv"))?;
    check_writable(&file)?;

    let start = Instant::now();
    let bench = Workbench::new(options.long)?;
    let backends: Vec<_> = bench.backends().iter().map(ToString::to_string).collect();
    let missing = ["compute-bvh", "ray-query"].into_iter().filter(|name| !backends.iter().any(|there| there == name));
    let missing: Vec<_> = missing.collect();
    let mut ran = backends.join(", ");
    if !missing.is_empty() {
        ran += &format!(" (not here: {})", missing.join(", "));
    }
    tell(&format!("{} sweeps on {ran}; {}", sweeps.len(), bench.device));

    let mut outcomes: Vec<Outcome> = Vec::new();
    for (number, sweep) in sweeps.iter().enumerate() {
        tell(&format!("{}/{} {}: {}", number + 1, sweeps.len(), sweep.name, sweep.title));
        let began = Instant::now();
        let outcome = (sweep.run)(&bench).and_then(|done| write(&folder, sweep, &done).map(|()| done));
        match &outcome {
            Ok(_) => tell(&format!("    done in {}", duration(began.elapsed().as_secs_f64()))),
            Err(error) => tell(&format!("error: the sweep `{}` failed: {error}", sweep.name)),
        }
        outcomes.push((*sweep, outcome));
    }
    let head = Head {
        command: command(options),
        device: bench.device.clone(),
        backends: ran,
        folder: seen_from(&file, &folder),
    };
    save_text(&file, &page(&head, &outcomes))?;

    let failed = outcomes.iter().filter(|(_, outcome)| outcome.is_err()).count();
    print(&format!("{} sweeps in {}: {}\n", sweeps.len(), duration(start.elapsed().as_secs_f64()), file.display()))?;
    if failed > 0 {
        tell(&format!("error: {failed} of {} sweeps failed; the page has the others", sweeps.len()));
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the charts of a sweep, and its numbers.
fn write(folder: &Path, sweep: &Definition, done: &Sweep) -> Result<()> {
    save_text(&folder.join(format!("{}.csv", sweep.name)), &done.csv())?;
    done.charts
        .iter()
        .try_for_each(|chart| save_text(&folder.join(format!("{}-{}.svg", sweep.name, chart.name)), &chart.svg()))
}

/// The command that makes the page again.
fn command(options: &StabilityOptions) -> String {
    let mut words = vec!["luminaire stability".to_owned()];
    words.extend(options.sweeps.iter().cloned());
    words.extend(options.out.iter().map(|path| format!("--out {}", path.display())));
    words.extend(options.page.iter().map(|path| format!("--page {}", path.display())));
    words.extend(options.long.then(|| "--long".to_owned()));
    words.join(" ")
}

/// How a page names a folder: relative to its own, with slashes, so that both can be moved together.
pub(super) fn seen_from(page: &Path, folder: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (page, folder) = (absolute(page), absolute(folder));
    let here = page.parent().unwrap_or(Path::new("/"));
    let parts = |path: &Path| -> Vec<String> {
        let named = path.components().filter(|part| *part != Component::CurDir);
        named.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let (here, there) = (parts(here), parts(&folder));
    let shared = here.iter().zip(&there).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", here.len() - shared).map(str::to_owned);
    let way: Vec<String> = up.chain(there[shared..].iter().cloned()).collect();
    if way.is_empty() { ".".into() } else { way.join("/") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_find_their_charts() {
        let seen = |page: &str, folder: &str| seen_from(Path::new(page), Path::new(folder));
        assert_eq!(seen("docs/stability.md", "docs/stability"), "stability");
        assert_eq!(seen("stability/README.md", "stability"), ".");
        assert_eq!(seen("a/b/page.md", "c/d"), "../../c/d");
        assert_eq!(seen("./page.md", "./d/"), "d");
        assert_eq!(seen("/x/page.md", "/y"), "../y");
    }
}
