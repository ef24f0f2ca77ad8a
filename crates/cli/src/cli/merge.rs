//! `luminaire merge`.

use super::progress::percent;
use super::{MergeOptions, print};
use luminaire::{Error, Result, files, part, picture};
use std::process::ExitCode;

/// Joins parts of a render, and writes the picture.
pub fn run(options: &MergeOptions) -> Result<ExitCode> {
    for (i, path) in options.output.iter().enumerate() {
        if options.output[..i].contains(path) {
            return Err(Error::Usage(format!("-o {} is given twice", path.display())));
        }
        if options.parts.iter().any(|part| files::same_file(part, path)) {
            return Err(Error::Usage(format!("-o {}: that is one of the parts", path.display())));
        }
        picture::check_output(path)?;
    }
    let (whole, provenance) = part::merge(&options.parts)?;
    let exposure = options.exposure.unwrap_or(provenance.exposure);
    let mut text = String::new();
    for path in &options.output {
        whole.film.save(path, exposure)?;
        text += &format!(
            "{}: {} x {} pixels, {} samples a pixel from {} part{}\n",
            path.display(),
            whole.film.width,
            whole.film.height,
            whole.film.least_samples(),
            options.parts.len(),
            if options.parts.len() == 1 { "" } else { "s" }
        );
    }
    if let Some(error) = whole.progress.error {
        text += &format!("estimated error {} (RMSE {:.3e})\n", percent(error.relative()), error.rmse);
    }
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}
