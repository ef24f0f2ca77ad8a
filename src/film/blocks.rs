//! Blocks of a pixel's samples, from whose spread its error is estimated.

use super::batch::group_length;
use std::ops::Range;

/// The most blocks of a pixel.
pub const BLOCKS: usize = 8;

/// Into which blocks the samples of a pixel fall: block `b` has the samples from number `b * length` to before `(b + 1) * length`, as far as there are any.
///
/// The length is the least power of two by which there are no more than [`BLOCKS`], and no group of samples ([`Batch`](super::Batch)) has a share in two: what
/// blocks a pixel has follows from its samples alone. When there are more of those, pairs of blocks become one. So a power of two of samples from number 0 on,
/// from 8 on, makes eight blocks, which are each and together, and two and two and four and four, nets of the sampler's sequence
/// ([`sobol`](crate::sampling::sobol)); other numbers make five to eight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Blocks {
    first: u32,
    end: u32,
    /// The logarithm of the length.
    log: u32,
}

impl Blocks {
    /// Those of these samples.
    pub fn of(samples: Range<u32>) -> Self {
        let Range { start: first, end } = samples;
        let last = end.saturating_sub(1).max(first);
        let mut log = group_length(last).ilog2();
        while (last >> log) - (first >> log) >= BLOCKS as u32 {
            log += 1;
        }
        Blocks { first, end, log }
    }

    /// All samples.
    pub fn range(self) -> Range<u32> {
        self.first..self.end
    }

    /// Samples of a block.
    pub fn length(self) -> u32 {
        1 << self.log
    }

    /// In which place the block of this sample is kept.
    pub fn place(self, sample: u32) -> usize {
        ((sample >> self.log) - (self.first >> self.log)) as usize
    }

    /// How many blocks hold a sample.
    pub fn count(self) -> usize {
        if self.end > self.first { self.place(self.end - 1) + 1 } else { 0 }
    }

    /// The samples in the block in this place: none if that is empty, and fewer than [`Blocks::length`] in the first and last if some are not there.
    pub fn samples(self, place: usize) -> Range<u32> {
        let start = (u64::from(self.first >> self.log) + place as u64) << self.log;
        let within = |sample: u64| sample.clamp(self.first.into(), self.end.max(self.first).into()) as u32;
        within(start)..within(start + u64::from(self.length()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_few_and_hold_every_sample_once() {
        let ends = [0, 1, 2, 7, 8, 9, 15, 16, 17, 31, 64, 65, 100, 127, 1000, 1 << 20, (1 << 31) + 1, u32::MAX];
        for first in [0, 1, 3, 8, 13, 16, 64, 70, 100, 1 << 20, u32::MAX - 70] {
            for end in ends.map(|n: u32| first.saturating_add(n)) {
                let blocks = Blocks::of(first..end);
                let mut next = first;
                for place in 0..BLOCKS {
                    let samples = blocks.samples(place);
                    assert_eq!(samples.is_empty(), place >= blocks.count(), "{first}..{end}, {place}");
                    if !samples.is_empty() {
                        assert_eq!(samples.start, next);
                        assert_eq!((blocks.place(samples.start), blocks.place(samples.end - 1)), (place, place));
                        assert!(samples.end == end || samples.end.is_multiple_of(blocks.length()));
                        next = samples.end;
                    }
                }
                assert_eq!(next, end);
                // No more than is needed.
                let last = end.max(first + 1) - 1;
                let half = blocks.length() / 2;
                assert!(half < group_length(last) || last / half - first / half >= 8, "{first}..{end}");
            }
        }
    }

    #[test]
    fn the_length_of_whole_renders() {
        let of = |end: u32| (Blocks::of(0..end).length(), Blocks::of(0..end).count());
        let found = [1, 4, 8, 9, 16, 17, 32, 33, 64, 96, 100, 128, 1 << 20].map(of);
        let expected = [
            (1, 1),
            (1, 4),
            (1, 8),
            (2, 5),
            (2, 8),
            (4, 5),
            (4, 8),
            (8, 5),
            (8, 8),
            (16, 6),
            (16, 7),
            (16, 8),
            (1 << 17, 8),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn longer_renders_have_longer_blocks() {
        // What merging and going on rely on: blocks become blocks of the longer length as a whole.
        for first in [0, 3, 8, 70] {
            for (start, end) in
                [(first, first + 5), (first + 2, first + 40), (first + 5, first + 9), (first, first + 99)]
            {
                let (part, whole) = (Blocks::of(start..end), Blocks::of(first..first + 99));
                assert!(part.length() <= whole.length(), "{start}..{end}");
            }
        }
    }
}
