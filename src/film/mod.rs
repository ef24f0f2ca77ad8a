//! The film: what a tracer measured, added up.

mod aov;
mod batch;
mod blocks;
mod brightness;
mod convergence;
mod demand;
mod error;
mod error_estimate;
mod output;
mod pixel_error;

pub use aov::{AovSum, Aovs};
pub use batch::{Batch, GROUPS_IN_TURN, MOST_RADIANCE, PixelSum, Rays, SampleId, Tile};
pub(crate) use batch::{LONGEST_GROUP, group_length};
pub use blocks::{BLOCKS, Blocks};
pub use brightness::{Brightness, REL_MSE};
pub use convergence::Convergence;
pub use demand::Demand;
pub(crate) use demand::{FILM_BYTES, MEAN_BYTES};
pub use error::{ErrorMap, INTERVAL_95};
pub use error_estimate::{ErrorEstimate, relative_in_words};
pub use output::HDR_HAS_NO_ALPHA;

use crate::Result;
use crate::picture::Crop;
use std::collections::BTreeMap;

/// Everything measured so far: for every pixel, rows from the top, the sums of the radiance over [`Blocks`] of its samples, and how many there
/// are.
///
/// The sums are `f64`: at 1e7 samples they are right to ten digits, where `f32` sums are 9 % off.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of the first sample of every pixel: 0, unless the film holds a later part of a render.
    pub first_sample: u32,
    /// Radiance of each pixel in linear RGB, added up over the finite samples of each block; 0 in places without a block.
    pub sums: Vec<[[f64; 3]; BLOCKS]>,
    /// Samples of each pixel, from `first_sample` on. They differ between pixels where a render ended in the middle of a pass.
    pub samples: Vec<u32>,
    /// How many of them were not finite and are left out, by pixel and place of the block, where there are any.
    pub dropped: BTreeMap<(usize, usize), u32>,
    /// Samples of each pixel whose camera ray met nothing, where the picture has alpha.
    pub missed: Option<Vec<u32>>,
    /// Which part of a picture the film is, if it is not the whole.
    pub crop: Option<Crop>,
}

impl Film {
    /// A black film without samples.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::Error::Limit) if it does not fit into memory, as [`Film::check_size`] finds.
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Film::check_size(width, height)?;
        let pixels = width as usize * height as usize;
        let mut film = Film {
            width,
            height,
            first_sample: 0,
            sums: Vec::new(),
            samples: Vec::new(),
            dropped: BTreeMap::new(),
            missed: None,
            crop: None,
        };
        let demand = Demand { width, height, ..Demand::default() };
        let refused = |_| demand.too_large("what the system would give".into());
        film.sums.try_reserve_exact(pixels).map_err(refused)?;
        film.samples.try_reserve_exact(pixels).map_err(refused)?;
        film.sums.resize(pixels, Default::default());
        film.samples.resize(pixels, 0);
        Ok(film)
    }

    /// Checks that a film of this size, and a picture of it, fit into the memory that is free now.
    ///
    /// # Errors
    /// As for [`Demand::check`].
    pub fn check_size(width: u32, height: u32) -> Result<()> {
        Demand { width, height, ..Demand::default() }.check()
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.sums.len()
    }

    /// Adds what a tracer measured for `batch`, in ascending order of the samples.
    ///
    /// # Panics
    /// If there is not one sum for each pixel and group, the tile leaves the film, or the samples do not follow on those of every pixel in groups that each
    /// are in one block.
    pub fn add(&mut self, batch: &Batch, sums: &[PixelSum]) {
        let tile = batch.tile;
        assert_eq!(sums.len(), tile.pixels() * batch.groups() as usize, "one sum a pixel and group");
        assert!(tile.x + tile.width <= self.width && tile.y + tile.height <= self.height, "a tile inside the film");
        let begun = batch.samples.start.wrapping_sub(self.first_sample);
        let mut blocks = Blocks::of(self.first_sample..batch.samples.start.max(self.first_sample));
        for (group, sums) in sums.chunks_exact(tile.pixels().max(1)).enumerate() {
            // Group by group, so that sums are added in an order that does not depend on what a batch holds.
            let samples = batch.group_samples(group as u32);
            let before = std::mem::replace(&mut blocks, Blocks::of(self.first_sample..samples.end));
            let place = blocks.place(samples.start);
            assert_eq!(place, blocks.place(samples.end - 1), "groups in one block");
            for (row, sums) in sums.chunks_exact(tile.width as usize).enumerate() {
                let start = (tile.y as usize + row) * self.width as usize + tile.x as usize;
                for (column, sum) in sums.iter().enumerate() {
                    let pixel = start + column;
                    assert_eq!(self.samples[pixel], begun, "samples without a gap");
                    if before.length() < blocks.length() {
                        self.regroup(pixel, before, blocks);
                    }
                    for (total, s) in self.sums[pixel][place].iter_mut().zip(sum.radiance) {
                        *total += s;
                    }
                    if sum.dropped > 0 {
                        *self.dropped.entry((pixel, place)).or_default() += sum.dropped;
                    }
                    if sum.missed > 0 {
                        self.count_misses()[pixel] += sum.missed;
                    }
                }
            }
        }
        for row in tile.y..tile.y + tile.height {
            let start = row as usize * self.width as usize + tile.x as usize;
            for samples in &mut self.samples[start..start + tile.width as usize] {
                *samples += batch.samples.end - batch.samples.start;
            }
        }
    }

    /// Gives the picture alpha: what [`RenderSettings::transparent`](crate::scene::RenderSettings::transparent) lets a tracer count. Returns the counts of all pixels.
    pub fn count_misses(&mut self) -> &mut Vec<u32> {
        let pixels = self.sums.len();
        self.missed.get_or_insert_with(|| vec![0; pixels])
    }

    /// The share of a pixel's finite samples that met something; 0 without samples, 1 in a picture without alpha.
    pub fn alpha(&self, pixel: usize) -> f64 {
        let Some(missed) = &self.missed else { return 1.0 };
        // What met nothing is finite.
        let samples = self.finite_samples(pixel);
        if samples == 0 { 0.0 } else { f64::from(samples.saturating_sub(missed[pixel])) / f64::from(samples) }
    }

    /// The alpha of all pixels, row by row from the top; none in a picture without it.
    pub fn alphas(&self) -> Option<Vec<f32>> {
        self.missed.as_ref()?;
        Some((0..self.pixels()).map(|pixel| self.alpha(pixel) as f32).collect())
    }

    /// The blocks that a pixel's samples fall into.
    pub fn blocks(&self, pixel: usize) -> Blocks {
        Blocks::of(self.first_sample..self.first_sample + self.samples[pixel])
    }

    /// How many finite samples each block of a pixel has.
    pub fn block_samples(&self, pixel: usize) -> [u32; BLOCKS] {
        let blocks = self.blocks(pixel);
        std::array::from_fn(|place| {
            let taken = blocks.samples(place).len() as u32;
            if self.dropped.is_empty() { taken } else { taken - self.dropped.get(&(pixel, place)).unwrap_or(&0) }
        })
    }

    /// How many finite samples a pixel has.
    pub fn finite_samples(&self, pixel: usize) -> u32 {
        let taken = self.samples[pixel];
        if self.dropped.is_empty() {
            return taken;
        }
        taken - self.dropped.range((pixel, 0)..(pixel, BLOCKS)).map(|(_, count)| count).sum::<u32>()
    }

    /// Makes of a pixel's blocks those of a larger number of samples, which are no shorter.
    fn regroup(&mut self, pixel: usize, from: Blocks, to: Blocks) {
        let sums = &mut self.sums[pixel];
        for place in 0..from.count() {
            let target = to.place(from.samples(place).start);
            // In ascending order: what was in the target has gone before anything is added to it.
            if target < place {
                let sum = std::mem::take(&mut sums[place]);
                (0..3).for_each(|c| sums[target][c] += sum[c]);
                if let Some(count) = self.dropped.remove(&(pixel, place)) {
                    *self.dropped.entry((pixel, target)).or_default() += count;
                }
            }
        }
    }

    /// Adds the samples of a film of the same size that go on where those of this film end.
    ///
    /// # Panics
    /// If the sizes differ, or the other film's samples do not follow on those of every pixel.
    pub fn append(&mut self, next: &Film) {
        let place = |film: &Film| (film.width, film.height, film.crop);
        assert_eq!(place(self), place(next), "films of one size and place");
        for pixel in 0..self.pixels() {
            assert_eq!(self.first_sample + self.samples[pixel], next.first_sample, "samples without a gap");
            let (before, more) = (self.blocks(pixel), next.blocks(pixel));
            self.samples[pixel] += next.samples[pixel];
            let blocks = self.blocks(pixel);
            self.regroup(pixel, before, blocks);
            for place in 0..more.count() {
                let target = blocks.place(more.samples(place).start);
                (0..3).for_each(|c| self.sums[pixel][target][c] += next.sums[pixel][place][c]);
                if let Some(count) = next.dropped.get(&(pixel, place)) {
                    *self.dropped.entry((pixel, target)).or_default() += count;
                }
            }
        }
        for (pixel, missed) in next.missed.iter().flatten().enumerate() {
            self.count_misses()[pixel] += missed;
        }
    }

    /// Mean radiance of a pixel by its index, `y * width + x`, in linear RGB; black if it has no sample.
    pub fn mean(&self, pixel: usize) -> [f64; 3] {
        let samples = self.finite_samples(pixel);
        let sum = |channel: usize| self.sums[pixel].iter().map(|block| block[channel]).sum::<f64>();
        if samples == 0 { [0.0; 3] } else { [0, 1, 2].map(|c| sum(c) / f64::from(samples)) }
    }

    /// Mean radiance of all pixels: linear RGB, row by row from the top.
    pub fn to_linear(&self) -> Vec<f32> {
        (0..self.pixels()).flat_map(|pixel| self.mean(pixel).map(|v| v as f32)).collect()
    }

    /// The number of samples of the pixel that has the fewest.
    pub fn least_samples(&self) -> u32 {
        self.samples.iter().copied().min().unwrap_or(0)
    }

    /// The number of samples of the pixel that has the most.
    pub fn most_samples(&self) -> u32 {
        self.samples.iter().copied().max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(v: f64) -> PixelSum {
        PixelSum { radiance: [v; 3], rays: Rays { all: 1, shadow: 0 }, dropped: 0, missed: 0 }
    }

    #[test]
    fn sums_do_not_drift() {
        let mut film = Film::new(1, 1).unwrap();
        let tile = Tile { x: 0, y: 0, width: 1, height: 1 };
        let sums = vec![grey(0.1); 1000];
        let mut single = 0.0f32;
        for i in 0..10_000 {
            film.add(&Batch { tile, samples: i * 1000..(i + 1) * 1000, group: 1 }, &sums);
            (0..1000).for_each(|_| single += 0.1);
        }
        assert_eq!(film.samples, [10_000_000]);
        assert!((film.mean(0)[0] / 0.1 - 1.0).abs() < 1e-9, "{}", film.mean(0)[0]);
        assert!((single / 1e6 - 1.0).abs() > 0.05, "f32 would do: {single}");
    }

    #[test]
    fn a_batch_lands_on_its_tile() {
        let mut film = Film::new(4, 3).unwrap();
        let tile = Tile { x: 1, y: 1, width: 2, height: 2 };
        film.add(&Batch { tile, samples: 0..2, group: 1 }, &[1.0, 2.0, 3.0, 4.0, 10.0, 20.0, 30.0, 40.0].map(grey));
        // The third sample, of the third block.
        film.add(&Batch { tile, samples: 2..3, group: 16 }, &[100.0, 200.0, 300.0, 400.0].map(grey));
        let sums: Vec<f64> = film.sums.iter().map(|s| s.iter().map(|block| block[0]).sum()).collect();
        assert_eq!(sums, [0.0, 0.0, 0.0, 0.0, 0.0, 111.0, 222.0, 0.0, 0.0, 333.0, 444.0, 0.0]);
        assert_eq!(film.sums[6].map(|block| block[1]), [2.0, 20.0, 200.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(film.samples, [0, 0, 0, 0, 0, 3, 3, 0, 0, 3, 3, 0]);
        assert_eq!(film.block_samples(5), [1, 1, 1, 0, 0, 0, 0, 0]);
        film.samples[0] = u32::MAX;
        let block = 1 << 29;
        assert_eq!(film.block_samples(0), [block, block, block, block, block, block, block, block - 1]);
        film.samples[0] = 0;
        assert_eq!(film.mean(6), [74.0; 3]);
        assert_eq!(film.to_linear()[..3], [0.0; 3]);
        assert_eq!(film.to_linear()[3 * 5..3 * 6], [37.0; 3]);
        assert_eq!((film.least_samples(), film.most_samples()), (0, 3));
    }

    #[test]
    fn groups_hold_every_sample_once_and_begin_at_multiples() {
        let tile = Tile { x: 0, y: 0, width: 1, height: 1 };
        for (samples, group) in [
            (0..4, 1),
            (4..71, 16),
            (3..11, 4),
            (0..1, 1),
            (0..2, 3),
            (16..16, 1),
            (64..257, 16),
            (u32::MAX - 9..u32::MAX, 4),
        ] {
            let batch = Batch { tile, samples: samples.clone(), group };
            let mut seen = vec![];
            for g in 0..batch.groups() {
                let these: Vec<u32> = batch.group_samples(g).collect();
                assert!(!these.is_empty() && these.len() <= group as usize, "{batch:?} {g}: {these:?}");
                assert!(these.iter().all(|s| s / group == samples.start / group + g), "{batch:?} {g}: {these:?}");
                seen.extend(these);
            }
            assert_eq!(seen, samples.clone().collect::<Vec<_>>(), "{batch:?}");
        }
    }

    #[test]
    fn samples_that_are_not_finite_are_left_out() {
        let mut film = Film::new(1, 1).unwrap();
        let tile = Tile { x: 0, y: 0, width: 1, height: 1 };
        let lost = PixelSum { dropped: 1, ..grey(0.0) };
        film.add(
            &Batch { tile, samples: 0..8, group: 1 },
            &[grey(8.0), lost, lost, lost, grey(2.0), grey(2.0), lost, grey(4.0)],
        );
        assert_eq!(film.block_samples(0), [1, 0, 0, 0, 1, 1, 0, 1]);
        assert_eq!(film.mean(0), [4.0; 3]);
        // Blocks of two have what both have.
        film.add(&Batch { tile, samples: 8..12, group: 2 }, &[grey(4.0), PixelSum { dropped: 1, ..grey(6.0) }]);
        assert_eq!(film.block_samples(0), [1, 0, 2, 1, 2, 1, 0, 0]);
        assert_eq!(film.sums[0].map(|block| block[0]), [8.0, 0.0, 4.0, 4.0, 4.0, 6.0, 0.0, 0.0]);
        assert_eq!((film.finite_samples(0), film.mean(0)), (7, [26.0 / 7.0; 3]));
        assert_eq!(film.dropped.values().sum::<u32>(), 5);
    }

    /// The blocks of any cutting, also into films that are joined afterwards, are those of the samples: added up one by one.
    #[test]
    fn blocks_hold_their_samples_however_they_came() {
        let tile = Tile { x: 0, y: 0, width: 1, height: 1 };
        let value = |sample: u32| f64::from(sample * sample % 1009);
        let lost = |sample: u32| sample % 37 == 5;
        let film = |samples: std::ops::Range<u32>| {
            let mut film = Film::new(1, 1).unwrap();
            film.first_sample = samples.start;
            let mut next = samples.start;
            while next < samples.end {
                let group = group_length(next);
                let end = (next / group * group + group).min(samples.end);
                let finite = (next..end).filter(|sample| !lost(*sample)).map(value).sum();
                let dropped = (next..end).filter(|sample| lost(*sample)).count() as u32;
                film.add(&Batch { tile, samples: next..end, group }, &[PixelSum { dropped, ..grey(finite) }]);
                next = end;
            }
            film
        };
        for cuts in [
            vec![0, 100],
            vec![0, 64, 100],
            vec![0, 3, 5, 21, 22, 70, 100],
            vec![0, 16, 32],
            vec![13, 77],
            vec![64, 70, 80],
        ] {
            let mut whole = film(cuts[0]..cuts[1]);
            for next in cuts[1..].windows(2) {
                whole.append(&film(next[0]..next[1]));
            }
            let blocks = Blocks::of(cuts[0]..cuts[cuts.len() - 1]);
            assert_eq!(whole.blocks(0), blocks);
            for place in 0..BLOCKS {
                let samples: Vec<u32> = blocks.samples(place).filter(|sample| !lost(*sample)).collect();
                assert_eq!(whole.block_samples(0)[place] as usize, samples.len(), "{cuts:?}, {place}");
                assert_eq!(whole.sums[0][place], [samples.into_iter().map(value).sum::<f64>(); 3], "{cuts:?}, {place}");
            }
        }
    }
}
