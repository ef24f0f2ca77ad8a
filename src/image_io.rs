//! Pictures on disk: PNG to look at, EXR and HDR to compute with; and reading them, and PFM, to compare.
//!
//! Every file is written beside its final place and renamed, so that nobody ever sees half of one.

pub(crate) mod image_file;
mod openexr;
mod pfm;
mod picture;

pub use openexr::{Attribute, Exr, Values};
pub(crate) use openexr::{read_channels, read_texts};
pub use picture::{Picture, read};

use crate::film::{Aovs, ErrorEstimate, Film};
use crate::{Error, Result};
use image::{ExtendedColorType, ImageEncoder};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// File formats, by the ending of the name.
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
                "{}: a picture cannot be written as .{other}: choose .png, .exr or .hdr",
                path.display()
            ))),
            None => Err(Error::Usage(format!(
                "{}: the name has no ending that says which format to write: add .png, .exr or .hdr",
                path.display()
            ))),
        }
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

/// Checks that a file can be created at `path` or replaced there.
///
/// # Errors
/// [`Error::Write`] if the folder is missing or not writable, or `path` is itself a folder.
pub fn check_writable(path: &Path) -> Result<()> {
    let folder = folder_of(path);
    if path.is_dir() {
        return Err(Error::write(path, "it is a folder; give a file name"));
    }
    if !folder.is_dir() {
        return Err(Error::write(path, format!("the folder {} does not exist; create it first", folder.display())));
    }
    if path.as_os_str().as_encoded_bytes().last().is_some_and(|b| std::path::is_separator(char::from(*b))) {
        return Err(Error::write(path, "it is the name of a folder; give a file name"));
    }
    // A rename would replace what somebody has protected.
    if std::fs::metadata(path).is_ok_and(|about| about.permissions().readonly()) {
        return Err(Error::write(path, "it is read-only; make it writable, or give another name"));
    }
    // Permission bits do not tell about read-only file systems, so one is really created (and removed).
    create_beside(path).map(drop)
}

/// Writes a film to `path` in the format of its ending. `exposure` is in stops and changes a PNG only.
///
/// # Errors
/// [`Error::Usage`] for an unknown ending, [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save(path: &Path, film: &Film, exposure: f32) -> Result<()> {
    match Format::of(path)? {
        Format::Exr => save_exr(path, film, vec![], vec![]),
        Format::Png | Format::Hdr => save_linear(path, film.width, film.height, &film.to_linear(), exposure),
    }
}

/// Writes linear RGB, row by row from the top, to `path` in the format of its ending. `exposure` is in stops and changes a PNG only.
///
/// # Errors
/// As [`save`].
pub fn save_linear(path: &Path, width: u32, height: u32, linear: &[f32], exposure: f32) -> Result<()> {
    let format = Format::of(path)?;
    write_atomically(path, |out| match format {
        Format::Png => image::codecs::png::PngEncoder::new(out).write_image(
            &to_srgb8(linear, exposure),
            width,
            height,
            ExtendedColorType::Rgb8,
        ),
        Format::Exr => {
            let exr =
                Exr { width, height, rgb: bytemuck::cast_slice(linear), error: None, more: vec![], attributes: &[] };
            Ok(out.write_all(&exr.encode().map_err(std::io::Error::other)?)?)
        }
        Format::Hdr => image::codecs::hdr::HdrEncoder::new(out).write_image(
            bytemuck::cast_slice(&before_truncation(linear)),
            width,
            height,
            ExtendedColorType::Rgb32F,
        ),
    })
}

/// Writes a film as an EXR picture with the layers of its AOVs ([`Aovs::channels`]) and the number of samples, `samples`.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save_with_aovs(path: &Path, film: &Film, aovs: &Aovs) -> Result<()> {
    let mut more = aovs.channels();
    more.push(("samples".into(), Values::Integer(film.samples.clone())));
    save_exr(path, film, more, vec![])
}

/// Writes a film as an EXR picture with further channels and attributes.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub(crate) fn save_exr(
    path: &Path,
    film: &Film,
    more: Vec<(String, Values)>,
    about: Vec<(&str, Attribute<'_>)>,
) -> Result<()> {
    let bytes = encode_exr(film, &film.to_linear(), more, about).map_err(|e| Error::write(path, e))?;
    write_atomically(path, |out| out.write_all(&bytes))
}

/// The bytes of an EXR file: a film's means, their standard errors, and `more`.
fn encode_exr<'a>(
    film: &Film,
    linear: &[f32],
    more: Vec<(String, Values)>,
    mut attributes: Vec<(&'a str, Attribute<'a>)>,
) -> std::io::Result<Vec<u8>> {
    let errors = film.error_map();
    attributes.push(("samplesPerPixel", Attribute::Number(f64::from(film.least_samples()))));
    attributes.push(("droppedSamples", Attribute::Number(film.dropped.values().copied().map(f64::from).sum())));
    if let Some(ErrorEstimate { rmse, rel_mse, fireflies, .. }) = errors.as_ref().map(|errors| errors.total) {
        attributes.push(("estimatedRMSE", Attribute::Number(rmse)));
        attributes.push(("estimatedRelMSE", Attribute::Number(rel_mse)));
        attributes.push(("fireflies", Attribute::Number(fireflies as f64)));
    }
    let error = errors.as_ref().map(|errors| &errors.standard_error[..]);
    let rgb = bytemuck::cast_slice(linear);
    let exr = Exr { width: film.width, height: film.height, rgb, error, more, attributes: &attributes };
    exr.encode().map_err(std::io::Error::other)
}

/// Writes `text` to `path`.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save_text(path: &Path, text: &str) -> Result<()> {
    write_atomically(path, |out| out.write_all(text.as_bytes()))
}

/// Writes an 8-bit picture as a PNG.
///
/// # Errors
/// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
pub fn save_png(path: &Path, picture: &image::RgbImage) -> Result<()> {
    write_atomically(path, |out| {
        let (width, height) = picture.dimensions();
        image::codecs::png::PngEncoder::new(out).write_image(picture, width, height, ExtendedColorType::Rgb8)
    })
}

/// The non-linear sRGB value of a linear one in [0, 1] (IEC 61966-2-1).
pub fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Linear values, times `2^exposure` and clamped, as 8-bit sRGB.
pub fn to_srgb8(linear: &[f32], exposure: f32) -> Vec<u8> {
    let scale = exposure.exp2();
    // Rust's `as` saturates, and takes NaN (0 times an infinite scale) to 0.
    linear.iter().map(|v| (255.0 * srgb((v * scale).clamp(0.0, 1.0))).round() as u8).collect()
}

/// Half a step of RGBE more of everything: the encoder truncates, which would make a picture darker by half a step in the mean (2 % in the
/// weakest channel of the Cornell box).
fn before_truncation(linear: &[f32]) -> Vec<f32> {
    let more = |pixel: &[f32]| {
        let largest = pixel.iter().copied().fold(0.0, f32::max);
        let power = (largest.log2().floor() + 1.0).exp2();
        let step = power / 256.0;
        // The largest channel may be rounded up to the next power of two, where steps are twice as long.
        let half = if largest + 0.5 * step >= power { step } else { 0.5 * step };
        let more = |v: &f32| if largest > 0.0 && half.is_finite() { v + half } else { *v };
        [more(&pixel[0]), more(&pixel[1]), more(&pixel[2])]
    };
    linear.chunks_exact(3).flat_map(more).collect()
}

/// Whether two names lead to one file, or would once it is written.
pub fn same_file(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        // A link leads elsewhere only if there is something.
        std::fs::canonicalize(path)
            .ok()
            .or_else(|| Some(std::fs::canonicalize(folder_of(path)).ok()?.join(path.file_name()?)))
    };
    a == b || place(a).is_some_and(|a| Some(a) == place(b))
}

/// The folder in which `path` lies.
fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => PathBuf::from("."),
        Some(parent) => parent.to_owned(),
        None => PathBuf::from("/"),
    }
}

/// How the names of the files end that are renamed once they are complete.
const TEMPORARY_SUFFIX: &str = ".luminaire.tmp";

/// How the names of those begin that are to become `path`. Short enough for a file system where the name itself is.
fn temporary_prefix(path: &Path) -> String {
    let name: String = path.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    format!(".{name}.")
}

/// Removes what a process left that was killed while it wrote `path`.
pub fn remove_left_over(path: &Path) {
    let prefix = temporary_prefix(path);
    let Ok(entries) = std::fs::read_dir(folder_of(path)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        // What remains in the middle is the random part: without it, other files of similar names would match.
        let middle = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(TEMPORARY_SUFFIX));
        if middle.is_some_and(|middle| middle.len() == 6 && middle.chars().all(char::is_alphanumeric)) {
            // Nobody waits for it: if it stays, it only takes room.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A new file in the folder of `path`, removed when dropped.
fn create_beside(path: &Path) -> Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    let prefix = temporary_prefix(path);
    builder.prefix(&prefix).suffix(TEMPORARY_SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // What any new file gets, less the umask; a temporary file would be its owner's alone.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
        .tempfile_in(folder_of(path))
        .map_err(|e| Error::write(path, format!("the folder {} cannot be written to ({e})", folder_of(path).display())))
}

/// Lets `fill` write a temporary file, and moves that to `path` once it is complete on the disk.
fn write_atomically<E: ToString>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::result::Result<(), E>,
) -> Result<()> {
    let file = create_beside(path)?;
    let mut out = BufWriter::new(file);
    fill(&mut out).map_err(|e| Error::write(path, e))?;
    let file = out.into_inner().map_err(|e| Error::write(path, e.error()))?;
    file.as_file().sync_all().map_err(|e| Error::write(path, e))?;
    file.persist(path).map_err(|e| Error::write(path, e.error))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film of 9 x 2 pixels with values from 0 to 1e5, two samples each.
    fn film() -> Film {
        let mut film = Film::new(9, 2).unwrap();
        for (pixel, sums) in film.sums.iter_mut().enumerate() {
            let v = 10f64.powi(pixel as i32 - 12);
            sums[1] = [2.0 * v, 4.0 * v, 0.0];
        }
        film.samples.fill(2);
        film
    }

    fn read(path: &Path) -> Vec<f32> {
        image::open(path).unwrap().into_rgb32f().into_raw()
    }

    #[test]
    fn exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.EXR");
        save(&path, &film(), 3.0).unwrap();
        assert_eq!(read(&path), film().to_linear());
    }

    #[test]
    fn hdr_keeps_eight_bits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        save(&path, &film(), 3.0).unwrap();
        let (got, expected) = (read(&path), film().to_linear());
        assert_eq!(got.len(), expected.len());
        for (pixel, (got, expected)) in got.chunks(3).zip(expected.chunks(3)).enumerate() {
            let largest = expected.iter().copied().fold(0.0, f32::max);
            for (g, e) in got.iter().zip(expected) {
                assert!((g - e).abs() <= largest / 128.0, "pixel {pixel}: {g} for {e}");
            }
        }
    }

    /// Every number is off by half a step at most, and they are right in the mean.
    #[test]
    fn hdr_is_rounded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        let mut film = Film::new(50, 40).unwrap();
        for (i, sums) in film.sums.iter_mut().enumerate() {
            let v = 0.25 * 1.000_7f64.powi(i as i32);
            sums[0] = [v, 0.3 * v, 0.05 * v];
        }
        // Rounded up to the next power of two.
        film.sums[7][0] = [0.999, 0.5, 0.003_8];
        film.samples.fill(1);
        save(&path, &film, 0.0).unwrap();
        let (got, expected) = (read(&path), film.to_linear());
        let mut off = 0.0;
        for (got, expected) in got.chunks(3).zip(expected.chunks(3)) {
            let step = (expected[0] * 1.002).log2().floor().exp2() / 128.0;
            for (g, e) in got.iter().zip(expected) {
                assert!((g - e).abs() <= 0.501 * step, "{got:?} for {expected:?}");
            }
            off += f64::from(got[2] - expected[2]) / f64::from(expected[2]);
        }
        assert!((off / 2000.0).abs() < 1e-3, "the weakest channel is off by {} in the mean", off / 2000.0);
        // 0.0038 is just below half a step of 1/128.
        assert_eq!(got[3 * 7..3 * 8], [1.0, 0.5, 0.0]);
    }

    #[test]
    fn png_is_exposed_srgb() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut film = Film::new(3, 1).unwrap();
        for (sums, value) in film.sums.iter_mut().zip([[0.0, 0.001, 0.05], [0.107, 0.25, 0.5], [1.0, 7.0, -1.0]]) {
            sums[0] = value;
        }
        film.samples.fill(1);
        save(&path, &film, 1.0).unwrap();
        // Twice the values; the expected ones are the standard's formula worked out by hand.
        assert_eq!(image::open(&path).unwrap().into_rgb8().into_raw(), [0, 7, 89, 127, 188, 255, 255, 255, 0]);
        assert_eq!(to_srgb8(&[0.0, f32::INFINITY, f32::NAN], 0.0), [0, 255, 0]);
    }

    #[test]
    fn srgb_transfer_is_continuous_and_inverse_of_the_standard() {
        for code in 0..=255u8 {
            let v = f64::from(code) / 255.0;
            let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
            assert_eq!(to_srgb8(&[linear as f32], 0.0), [code]);
        }
        assert!((srgb(0.003_130_8) - srgb(0.003_130_9)).abs() < 1e-5);
    }

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

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        save_text(&path, "old").unwrap();
        let failed = write_atomically(&path, |out| {
            out.write_all(b"half").unwrap();
            Err("the disk is full")
        });
        assert!(failed.unwrap_err().to_string().contains("the disk is full"));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        save_text(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn files_get_ordinary_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("a.json"), folder.path().join("b"));
        save_text(&ours, "x").unwrap();
        std::fs::write(&plain, "x").unwrap();
        let mode = |p: &Path| p.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
