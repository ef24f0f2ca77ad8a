//! How many times as many samples each tile of a picture gets as the one that needs fewest: samples where they are needed.
//!
//! A render with a limit of the noise begins evenly. Once that tells enough, every tile of [`TILE`] x [`TILE`] pixels gets a share, a power of two, by the square root of its
//! error, which is what makes the error of the picture least for the samples of all. It keeps this share to the end, so that the samples of a pixel stay a power of two, or a
//! whole number of eighths of one, where the sampler is best.
//!
//! The samples that decide are others than those that are reported: a tile's share follows from the first samples of the eight tiles around it, not from its own. Whoever stops where
//! the samples happen to agree reports, in the mean, too little light; pixels here are independent of each other, so their mean has no such bias. (How much light is in all the
//! picture says when to decide, and where to end; that is one number for all tiles.)

use super::progress::LEAST_FOR_NOISE;
use crate::film::{Film, LONGEST_GROUP};

/// Columns and rows of a tile: a workgroup of the kernel.
pub const TILE: u32 = 8;

/// The largest share is this power of two.
const MOST: u32 = 4;

/// Tiles are told apart where an even picture would need so many times the samples that there are: with fewer there is little left to distribute, ...
const LEAST_AHEAD: f64 = 2.0;
/// ... and with more the errors are better known later.
const MOST_AHEAD: f64 = 8.0;

/// It has to save so much: not more than this part of the samples of an even picture. Errors are not known well enough to promise less.
const WORTH: f64 = 0.93;

/// The estimated error is brought this near to the limit (its square) at once; the rest is looked at step by step.
const NEAR: f64 = 1.1;

/// The share of every tile.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// The film's width and height in pixels.
    size: (u32, u32),
    /// Logarithms of the shares, rows of tiles from the top.
    logs: Vec<u8>,
    /// The mean share of a pixel.
    mean: f64,
}

impl Shares {
    /// Shares by their logarithms, rows of tiles from the top; none if there are not as many as the film has tiles, or one is too large.
    pub fn from_logs(size: (u32, u32), logs: Vec<u8>) -> Option<Self> {
        let tiles = u64::from(size.0.div_ceil(TILE)) * u64::from(size.1.div_ceil(TILE));
        let fine = logs.len() as u64 == tiles && logs.iter().all(|log| u32::from(*log) <= MOST);
        fine.then(|| Shares::new(size, logs))
    }

    fn new(size: (u32, u32), logs: Vec<u8>) -> Self {
        let mut shares = Shares { size, logs, mean: 0.0 };
        let pixels = |tile: u32| shares.tile(tile)[2..].iter().map(|side| f64::from(*side)).product::<f64>();
        let samples = (0..shares.tiles()).map(|tile| pixels(tile) * f64::from(shares.samples(tile, 1)));
        shares.mean = samples.sum::<f64>() / (f64::from(size.0) * f64::from(size.1));
        shares
    }

    /// Shares by those of every pixel; none if they are not powers of two, the same for a tile.
    pub(crate) fn of_pixels(size: (u32, u32), of_pixels: &[u32]) -> Option<Self> {
        let shares = Shares::new(size, vec![0; (size.0.div_ceil(TILE) * size.1.div_ceil(TILE)) as usize]);
        let first = |tile: u32| of_pixels[(shares.tile(tile)[1] * size.0 + shares.tile(tile)[0]) as usize];
        let logs =
            (0..shares.tiles()).map(|tile| first(tile).checked_ilog2().unwrap_or(u32::MAX).min(255) as u8).collect();
        let found = Shares::from_logs(size, logs)?;
        (0..of_pixels.len()).all(|pixel| found.samples_of_pixel(pixel, 1) == of_pixels[pixel]).then_some(found)
    }

    /// Whether a render may have come to these numbers of samples when those of the smallest share are to have `step`: whole groups, the same for a tile.
    pub(crate) fn allow(&self, samples: &[u32], step: u32) -> bool {
        (0..self.tiles()).all(|tile| {
            let [left, top, width, height] = self.tile(tile);
            let there = samples[(top * self.size.0 + left) as usize];
            let rows = (top..top + height).map(|y| (y * self.size.0 + left) as usize);
            there >= LEAST_FOR_NOISE
                && there <= self.samples(tile, step)
                && there.is_multiple_of(LONGEST_GROUP)
                && rows.into_iter().all(|start| samples[start..start + width as usize].iter().all(|n| *n == there))
        })
    }

    /// Logarithms of the shares, rows of tiles from the top.
    pub fn logs(&self) -> &[u8] {
        &self.logs
    }

    /// The shares for an even film, whose squared error has to become `ahead` times smaller; none if it is too early for them, too late, or not worth it.
    pub(super) fn of(film: &Film, ahead: f64) -> Option<Self> {
        if !(LEAST_AHEAD..MOST_AHEAD).contains(&ahead) {
            return None;
        }
        let size = (film.width, film.height);
        let (columns, rows) = (size.0.div_ceil(TILE) as usize, size.1.div_ceil(TILE) as usize);
        let errors = film.own_errors()?;
        let (mut sums, mut pixels) = (vec![0.0; columns * rows], vec![0.0; columns * rows]);
        for (pixel, error) in errors.into_iter().enumerate() {
            let (x, y) = (pixel % film.width as usize, pixel / film.width as usize);
            let tile = y / TILE as usize * columns + x / TILE as usize;
            sums[tile] += error;
            pixels[tile] += 1.0;
        }
        // The mean of the tiles around each.
        let around: Vec<f64> = (0..columns * rows)
            .map(|tile| {
                let (x, y) = (tile % columns, tile / columns);
                let (mut sum, mut count) = (0.0, 0.0);
                for y in y.saturating_sub(1)..(y + 2).min(rows) {
                    for x in x.saturating_sub(1)..(x + 2).min(columns) {
                        let other = y * columns + x;
                        if other != tile {
                            sum += sums[other];
                            count += pixels[other];
                        }
                    }
                }
                if count > 0.0 { sum / count } else { 0.0 }
            })
            .collect();
        let weighted = |of: &dyn Fn(usize) -> f64| (0..pixels.len()).map(|tile| pixels[tile] * of(tile)).sum::<f64>();
        let (even, all) = (weighted(&|tile| around[tile]), pixels.iter().sum::<f64>());
        // The smallest shares that bring the error as far as it has to come.
        let shares = |scale: f64| -> Vec<u8> {
            let log = |error: &f64| (0.5 * error.log2() + scale).round().clamp(0.0, f64::from(MOST));
            around.iter().map(|error| if *error > 0.0 { log(error) as u8 } else { 0 }).collect()
        };
        let left = |logs: &[u8]| weighted(&|tile| around[tile] / f64::from(1u32 << logs[tile])) / even;
        let (mut low, mut high) = (-60.0, 60.0);
        for _ in 0..64 {
            let middle = 0.5 * (low + high);
            if left(&shares(middle)) > NEAR / ahead { low = middle } else { high = middle }
        }
        let logs = shares(high);
        let samples = weighted(&|tile| f64::from(1u32 << logs[tile])) / all;
        (even > 0.0 && left(&logs) <= NEAR / ahead && samples <= WORTH * ahead / NEAR).then(|| Shares::new(size, logs))
    }

    /// Columns of tiles.
    fn columns(&self) -> u32 {
        self.size.0.div_ceil(TILE)
    }

    /// Number of tiles.
    pub(super) fn tiles(&self) -> u32 {
        self.logs.len() as u32
    }

    /// The left and top pixel of a tile, its columns and its rows.
    pub(super) fn tile(&self, tile: u32) -> [u32; 4] {
        let [x, y] = [tile % self.columns() * TILE, tile / self.columns() * TILE];
        [x, y, TILE.min(self.size.0 - x), TILE.min(self.size.1 - y)]
    }

    /// Samples of the pixels of a tile when those of the smallest share have `step`.
    pub fn samples(&self, tile: u32, step: u32) -> u32 {
        step.saturating_mul(1 << self.logs[tile as usize])
    }

    /// The same of the tile that holds a pixel, by its index.
    pub fn samples_of_pixel(&self, pixel: usize, step: u32) -> u32 {
        let (x, y) = (pixel as u32 % self.size.0, pixel as u32 / self.size.0);
        self.samples(y / TILE * self.columns() + x / TILE, step)
    }

    /// Samples a pixel, averaged over the pixels, when those of the smallest share have `step`.
    pub(super) fn mean_samples(&self, step: u32) -> f64 {
        self.mean * f64::from(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Batch, PixelSum, Tile};
    use crate::sampling::{random4, uniform};

    const SIZE: (u32, u32) = (60, 44);

    /// Radiance 1 with noise that `spread` tells of every pixel.
    fn film(spread: impl Fn(u32, u32) -> f64) -> Film {
        let mut film = Film::new(SIZE.0, SIZE.1).unwrap();
        let tile = Tile { x: 0, y: 0, width: SIZE.0, height: SIZE.1 };
        for sample in 0..64 {
            let value = |pixel: u32| {
                1.0 + spread(pixel % SIZE.0, pixel / SIZE.0) * (uniform(random4(pixel, sample, 0, 3)[0]) - 0.5)
            };
            let sums: Vec<_> = (0..SIZE.0 * SIZE.1)
                .map(|pixel| PixelSum { radiance: [value(pixel); 3], ..PixelSum::default() })
                .collect();
            film.add(&Batch { tile, samples: sample..sample + 1, group: 1 }, &sums);
        }
        film
    }

    #[test]
    fn shares_go_as_the_error_of_the_tiles_around() {
        let halves = |x: u32, _| if x < 32 { 0.1 } else { 0.8 };
        let shares = Shares::of(&film(halves), 7.9).unwrap();
        // Eight columns of six rows; eight times the noise, eight times the samples.
        assert_eq!(shares.tiles(), 48);
        let log = |x: usize, y: usize| shares.logs()[y * 8 + x];
        assert!((0..6).all(|y| log(7, y) == log(0, y) + 3 && log(1, y) == log(0, y)), "{:?}", shares.logs());
        assert_eq!((shares.samples(0, 40), shares.samples_of_pixel(59, 40)), (40 << log(0, 0), 40 << log(7, 0)));
        let mean = (0..SIZE.0 * SIZE.1).map(|pixel| shares.samples_of_pixel(pixel as usize, 1)).sum::<u32>();
        assert!((shares.mean_samples(1) - f64::from(mean) / f64::from(SIZE.0 * SIZE.1)).abs() < 1e-9);
        // One tile alone among quiet ones gets what they get, and they more.
        let lonely = |x: u32, y: u32| if (x / 8, y / 8) == (3, 2) { 3.0 } else { 0.1 };
        let shares = Shares::of(&film(lonely), 4.0).unwrap();
        let log = |x: usize, y: usize| shares.logs()[y * 8 + x];
        assert!(log(3, 2) == 0 && log(2, 1) > 1 && log(4, 3) > 1, "{:?}", shares.logs());
    }

    #[test]
    fn an_even_picture_stays_even_and_so_does_one_that_is_nearly_done() {
        assert_eq!(Shares::of(&film(|_, _| 0.5), 4.0), None);
        let halves = film(|x, _| if x < 32 { 0.1 } else { 0.8 });
        assert!(Shares::of(&halves, 7.9).is_some());
        assert!([1.5, 8.0, f64::INFINITY, f64::NAN].iter().all(|ahead| Shares::of(&halves, *ahead).is_none()));
        assert_eq!(Shares::of(&film(|_, _| 0.0), 4.0), None, "nothing to tell apart");
    }

    #[test]
    fn only_what_a_render_comes_to_is_allowed() {
        let logs: Vec<u8> = (0..48).map(|tile| tile % 5).collect();
        let shares = Shares::from_logs(SIZE, logs.clone()).unwrap();
        let each = |step: u32| -> Vec<u32> { (0..60 * 44).map(|pixel| shares.samples_of_pixel(pixel, step)).collect() };
        assert_eq!(Shares::of_pixels(SIZE, &each(1)), Some(shares.clone()));
        assert!(shares.allow(&each(32), 32) && shares.allow(&each(32), 40) && shares.allow(&[32; 60 * 44], 32));
        assert!(!shares.allow(&each(40), 32) && !shares.allow(&[28; 60 * 44], 32));
        let with = |pixel: usize, samples: u32| {
            let mut wrong = each(32);
            wrong[pixel] = samples;
            wrong
        };
        assert!(!shares.allow(&with(61, 36), 64), "within a tile");
        assert!(!shares.allow(&vec![34; 60 * 44], 64), "within a group");
        assert_eq!(Shares::of_pixels(SIZE, &with(61, 32)), None);
        assert_eq!((Shares::of_pixels(SIZE, &[0; 60 * 44]), Shares::of_pixels(SIZE, &[3; 60 * 44])), (None, None));
        assert_eq!((Shares::from_logs(SIZE, vec![0; 47]), Shares::from_logs(SIZE, vec![5; 48])), (None, None));
    }
}
