//! Films to disk.

use super::{Aovs, ErrorEstimate, Film};
use crate::files::write_file_atomically;
use crate::picture::{Attribute, Development, Exr, Format, MARK, Values, save_marked, save_marked_with_alpha};
use crate::{Error, Result};
use std::fs::File;
use std::path::Path;

/// Why a picture with alpha is not written as HDR.
pub const HDR_HAS_NO_ALPHA: &str = "an HDR file has no alpha: write a transparent picture as .png or .exr";

impl Film {
    /// Writes the picture to `path` in the format of its ending. `how` is an exposure in stops, or a whole
    /// [`Development`], and changes a PNG only.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown ending, or a picture with alpha as HDR, [`Error::Write`] if the system refuses; then nothing has changed at `path`.
    pub fn save(&self, path: &Path, how: impl Into<Development>) -> Result<()> {
        match Format::of(path)? {
            Format::Exr => self.save_exr(path, vec![], vec![], |_| Ok(())),
            _ => self.save_shown(path, how.into(), None),
        }
    }

    /// Writes a file that holds no more than a picture.
    fn save_shown(&self, path: &Path, how: Development, mark: Option<&str>) -> Result<()> {
        let size = (self.width, self.height);
        match self.alphas() {
            Some(_) if Format::of(path)? == Format::Hdr => {
                Err(Error::Usage(format!("{}: {HDR_HAS_NO_ALPHA}", path.display())))
            }
            Some(alphas) => save_marked_with_alpha(path, size, &self.to_linear(), &alphas, how, mark),
            None => save_marked(path, size, &self.to_linear(), how, mark),
        }
    }

    /// Writes an EXR picture with the layers of its AOVs ([`Aovs::channels`]) and the number of samples, `samples`.
    ///
    /// # Errors
    /// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
    pub fn save_with_aovs(&self, path: &Path, aovs: &Aovs) -> Result<()> {
        self.save_exr(path, self.with_samples(aovs), vec![], |_| Ok(()))
    }

    /// Writes the picture with a mark, a line of ASCII text, in its head, which [`mark`](crate::picture::mark()) reads; an EXR with these AOVs as
    /// [`Film::save_with_aovs`] does.
    ///
    /// # Errors
    /// As for [`Film::save`].
    pub fn save_marked(&self, path: &Path, how: Development, aovs: Option<&Aovs>, mark: &str) -> Result<()> {
        if Format::of(path)? != Format::Exr {
            return self.save_shown(path, how, Some(mark));
        }
        let more = aovs.map_or(vec![], |aovs| self.with_samples(aovs));
        self.save_exr(path, more, vec![(MARK, Attribute::Text(mark))], |_| Ok(()))
    }

    /// The channels of AOVs and of the numbers of samples.
    fn with_samples(&self, aovs: &Aovs) -> Vec<(String, Values)> {
        let mut more = aovs.channels();
        more.push(("samples".into(), Values::Integer(self.samples.clone())));
        more
    }

    /// Writes an EXR picture with further channels and attributes; `finish` may still change the file.
    ///
    /// # Errors
    /// [`Error::Write`] if the system refuses; then nothing has changed at `path`.
    pub(crate) fn save_exr(
        &self,
        path: &Path,
        more: Vec<(String, Values)>,
        about: Vec<(&str, Attribute<'_>)>,
        finish: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<()> {
        write_file_atomically(path, |file| {
            write_exr(file, self, more, about)?;
            finish(file)
        })
    }
}

/// Writes an EXR file: a film's means, their standard errors, alpha if it has it (the means are those over black, as the format wants them), and `more`.
fn write_exr<'a>(
    out: &mut File,
    film: &Film,
    mut more: Vec<(String, Values)>,
    mut attributes: Vec<(&'a str, Attribute<'a>)>,
) -> std::io::Result<()> {
    let (linear, errors) = (film.to_linear(), film.error_map());
    attributes.push(("samplesPerPixel", Attribute::Number(f64::from(film.least_samples()))));
    attributes.push(("droppedSamples", Attribute::Number(film.dropped.values().copied().map(f64::from).sum())));
    if let Some(ErrorEstimate { rmse, rel_mse, fireflies, .. }) = errors.as_ref().and_then(|errors| errors.total) {
        attributes.push(("estimatedRMSE", Attribute::Number(rmse)));
        attributes.push(("estimatedRelMSE", Attribute::Number(rel_mse)));
        attributes.push(("fireflies", Attribute::Number(fireflies as f64)));
    }
    let error = errors.as_ref().map(|errors| &errors.standard_error[..]);
    let rgb = bytemuck::cast_slice(&linear);
    if let Some(alphas) = film.alphas() {
        more.push(("A".into(), Values::Float(alphas)));
    }
    let exr =
        Exr { width: film.width, height: film.height, rgb, error, more, attributes: &attributes, crop: film.crop };
    exr.write(out).map_err(std::io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{self, to_srgb8};

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
        crate::picture::read(path).unwrap().rgb.into_flattened()
    }

    #[test]
    fn exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.EXR");
        film().save(&path, 3.0).unwrap();
        assert_eq!(read(&path), film().to_linear());
        // And by another reader.
        let image = ::exr::prelude::read_first_rgba_layer_from_file(
            &path,
            |size, _| vec![[0.0f32; 3]; size.area()],
            |pixels, at, (r, g, b, _): (f32, f32, f32, f32)| pixels[at.y() * 9 + at.x()] = [r, g, b],
        );
        assert_eq!(image.unwrap().layer_data.channel_data.pixels.into_flattened(), film().to_linear());
    }

    #[test]
    fn hdr_keeps_eight_bits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        film().save(&path, 3.0).unwrap();
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
        film.save(&path, 0.0).unwrap();
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
    fn a_mark_is_read_again_and_changes_no_pixel() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.png", "a.exr", "a.HDR"] {
            let path = folder.path().join(name);
            film().save(&path, 1.0).unwrap();
            assert_eq!(picture::mark(&path), None, "{name}");
            let plain = read(&path);
            film().save_marked(&path, 1.0.into(), None, "12 of 40: 0a1b").unwrap();
            assert_eq!((picture::mark(&path).as_deref(), read(&path)), (Some("12 of 40: 0a1b"), plain), "{name}");
            std::fs::write(&path, "nothing").unwrap();
            assert_eq!(picture::mark(&path), None, "{name}");
            assert_eq!(picture::mark(folder.path()), None);
        }
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
        film.save(&path, 1.0).unwrap();
        // Twice the values; the expected ones are the standard's formula worked out by hand.
        assert_eq!(image::open(&path).unwrap().into_rgb8().into_raw(), [0, 7, 89, 127, 188, 255, 255, 255, 0]);
        assert_eq!(to_srgb8(&[0.0, f32::INFINITY, f32::NAN], 0.0), [0, 255, 0]);
    }
}
