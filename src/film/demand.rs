//! What a film and its files take of this machine's memory.

use super::BLOCKS;
use crate::memory::{available, gib, threads_demand};
use crate::{Error, Result};

/// Bytes a pixel of the sums and the numbers of samples.
pub(crate) const FILM_BYTES: u64 = 24 * BLOCKS as u64 + 4;
/// Bytes a pixel of the means of all samples, which every file needs.
pub(crate) const MEAN_BYTES: u64 = 12;
/// Eight bits a channel, and what they deflate to.
const PNG: u64 = 6;
/// The standard error, the relative error and the fireflies.
const ERRORS: u64 = 17;
/// What an EXR file holds of means and errors.
const EXR: u64 = 24;
/// What the camera sees first, and the channels of it.
const AOVS: u64 = 32;
const AOV_CHANNELS: u64 = 32;
/// The sums and the numbers of samples once more, as the channels of an EXR file.
const SUMS: u64 = FILM_BYTES;

/// The samples that met nothing, alpha as numbers, and colours that are not multiplied by it, with their eight bits.
const ALPHA: u64 = 4 + 4 + 12 + 4;

/// What does not grow with the film: a batch of sums on the device and here, the rows in which errors are estimated, the blocks of a file.
const FIXED: u64 = 40 << 20;

/// A film, and which files are written of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Demand {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// A checkpoint or a part, which hold the sums.
    pub sums: bool,
    /// An EXR file.
    pub exr: bool,
    /// An EXR file with what the camera sees first.
    pub aovs: bool,
    /// A picture of the estimated error.
    pub errors: bool,
    /// A picture with alpha.
    pub alpha: bool,
}

impl Demand {
    /// Bytes of memory that are taken at most: by the film, and by the file that takes most, since one is written after the other. Scene, driver and program are
    /// not counted.
    pub fn bytes(&self) -> u64 {
        let exr = MEAN_BYTES + ERRORS + EXR;
        let aovs = if self.aovs { AOVS } else { 0 };
        let files = [
            MEAN_BYTES + PNG,
            if self.errors { ERRORS + PNG } else { 0 },
            if self.exr { exr } else { 0 },
            if self.aovs { exr + AOV_CHANNELS } else { 0 },
            // Also what it takes to go on from one: its channels, beside the film.
            if self.sums { exr + SUMS } else { 0 },
        ];
        let alpha = if self.alpha { ALPHA } else { 0 };
        FIXED + self.pixels() * (FILM_BYTES + aovs + alpha + files.into_iter().max().unwrap_or(0))
    }

    /// Bytes on disk of a checkpoint or a part at most: noise does not deflate.
    pub fn file_bytes(&self) -> u64 {
        self.pixels() * (SUMS + EXR)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Refuses what the memory that is free now cannot hold.
    ///
    /// # Errors
    /// [`Error::Limit`], and [`Error::Usage`] for more pixels than have a number.
    pub fn check(&self) -> Result<()> {
        if self.pixels() > u64::from(u32::MAX) {
            return Err(Error::Usage(format!(
                "{} x {} pixels are more than the 2^32 - 1 that have a number",
                self.width, self.height
            )));
        }
        // What is rendered is not to be lost when it is written, and by then every thread has what it takes.
        self.fits(available().map(|bytes| bytes.saturating_sub(threads_demand())))
    }

    fn fits(&self, available: Option<u64>) -> Result<()> {
        match available.filter(|bytes| self.bytes() > *bytes) {
            Some(bytes) => Err(self.too_large(format!("{}, what is free now", gib(bytes)))),
            None => Ok(()),
        }
    }

    /// The error of a film for which there is no more than `limit`.
    pub(super) fn too_large(&self, limit: String) -> Error {
        let files = match self {
            Demand { sums: true, .. } => " and its checkpoint or part",
            Demand { aovs: true, .. } => " and its layers",
            _ => "",
        };
        Error::Limit {
            what: format!("a film of {} x {} pixels{files}", self.width, self.height),
            needed: format!("{} of memory", gib(self.bytes())),
            device: "this machine".into(),
            limit,
            advice: "choose a smaller --width and --height".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absurd_sizes_are_refused() {
        let absurd = Demand { width: 65536, height: 65535, sums: true, ..Demand::default() };
        let error = absurd.fits(Some(8 << 30)).unwrap_err().to_string();
        assert!(
            error.contains("65536 x 65535") && error.contains("1780.0 GiB") && error.contains("8192.0 MiB"),
            "{error}"
        );
        let plain = Demand { width: 1920, height: 1080, ..Demand::default() };
        assert!(plain.fits(Some(8 << 30)).is_ok() && plain.fits(None).is_ok());
        assert!(plain.fits(Some(plain.bytes())).is_ok() && plain.fits(Some(plain.bytes() - 1)).is_err());
        let too_many = Demand { width: 65536, height: 65536, ..Demand::default() };
        assert_eq!(too_many.check().unwrap_err().exit_code(), 2);
    }

    #[test]
    fn every_file_wants_its_memory() {
        let plain = Demand { width: 100, height: 10, ..Demand::default() };
        let of = |demand: Demand| (demand.bytes() - FIXED) / 1000;
        let sums = Demand { sums: true, ..plain };
        assert_eq!(of(Demand { alpha: true, ..plain }), 214 + ALPHA);
        assert_eq!(
            [of(plain), of(Demand { errors: true, ..plain }), of(Demand { exr: true, ..plain })],
            [214, 219, 249]
        );
        assert_eq!([of(Demand { aovs: true, ..plain }), of(sums), of(Demand { aovs: true, ..sums })], [313, 445, 477]);
        assert_eq!(sums.file_bytes(), 220_000);
    }
}
