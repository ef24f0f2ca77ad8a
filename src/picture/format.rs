//! File formats to write, by the ending of the name.

use crate::files::check_writable;
use crate::{Error, Result};
use std::path::Path;

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// 8 bits a channel, sRGB, exposed and clamped.
    Png,
    /// OpenEXR: 32-bit floats, linear RGB, with the estimated standard error of every number in the channels `error.R`, `error.G` and
    /// `error.B`; the exposure is not applied.
    Exr,
    /// Radiance RGBE: 8 bits a channel and a common exponent (about 1 % steps), linear RGB; the exposure is not applied.
    Hdr,
}

impl Format {
    /// The format that a file name's ending stands for, in upper or lower case.
    ///
    /// # Errors
    /// [`Error::Usage`] for any other ending.
    pub fn of(path: &Path) -> Result<Self> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(Format::Png),
            Some("exr") => Ok(Format::Exr),
            Some("hdr") => Ok(Format::Hdr),
            Some(other) => Err(Error::Usage(format!(
                "{}: a picture cannot be written as .{other}: choose .png, .exr or .hdr{}",
                path.display(),
                conversion(other)
            ))),
            None => Err(Error::Usage(format!(
                "{}: the name has no ending that says which format to write: add .png, .exr or .hdr",
                path.display()
            ))),
        }
    }
}

/// How a picture of another ending is made of one that is written, for those that people ask for.
fn conversion(ending: &str) -> String {
    match ending {
        "jpg" | "jpeg" | "webp" | "gif" | "bmp" | "tga" | "ppm" | "avif" | "heic" | "jxl" | "dds" | "pdf" => {
            format!(", and convert that, for example with `magick a.png a.{ending}`")
        }
        "tif" | "tiff" | "pfm" | "dpx" | "tx" | "psd" | "jp2" => {
            format!(", and convert that, for example with `oiiotool a.exr -o a.{ending}`")
        }
        "pic" | "rgbe" => ": .hdr is this format".into(),
        "mp4" | "mov" | "avi" | "webm" => {
            ", a picture for each frame, for example `--turntable 120 -o frame-%04d.png` for `ffmpeg -i frame-%04d.png a.mp4`".into()
        }
        _ => String::new(),
    }
}

/// Checks before the work begins that a picture can be written to `path` after it.
///
/// # Errors
/// [`Error::Usage`] for an unknown ending, [`Error::Write`] if the folder is missing or not writable.
pub fn check_output(path: &Path) -> Result<()> {
    Format::of(path)?;
    check_writable(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_endings_and_missing_folders() {
        for name in ["a.jpg", "a", "png", "a.png.txt"] {
            let error = check_output(Path::new(name)).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{name}");
            assert!(error.to_string().contains(".exr"), "{error}");
        }
        let folder = tempfile::tempdir().unwrap();
        let error = check_output(&folder.path().join("none/a.png")).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.to_string().contains("does not exist"), "{error}");
        std::fs::create_dir(folder.path().join("b.png")).unwrap();
        assert!(check_output(&folder.path().join("b.png")).unwrap_err().to_string().contains("is a folder"));
        check_output(&folder.path().join("c.png")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "the check leaves nothing");
        check_output(Path::new("in-the-current-folder.png")).unwrap();
    }
}
