//! How a render is cut into batches.

use crate::film::{Batch, Film, GROUPS_IN_TURN, LONGEST_GROUP, Tile, group_length};

/// The most samples of a pixel in one batch: a workgroup for what an invocation takes, and as many as every Vulkan device takes along an axis.
pub(super) const MAX_PASS: u64 = 65_535 * (LONGEST_GROUP * GROUPS_IN_TURN) as u64;

/// Where the groups end that one invocation of the kernel takes in turn, among them the one with sample `start`.
fn groups_end(start: u32) -> u32 {
    let stride = group_length(start) * GROUPS_IN_TURN;
    (start / stride + 1).saturating_mul(stride)
}

/// Where groups of another length begin than at sample `start`.
fn equal_end(start: u32) -> u32 {
    match start {
        0..8 => 8,
        8..16 => 16,
        _ => u32::MAX,
    }
}

/// Whether a pass over the film may take these samples; an empty range, between two passes, counts as one.
pub(crate) fn is_a_pass(samples: std::ops::Range<u32>) -> bool {
    let length = u64::from(samples.end - samples.start);
    // Groups of one pass are of equal length.
    length == 0 || samples.end <= equal_end(samples.start) && length <= MAX_PASS
}

/// Cuts the work into batches: pass after pass over the whole film, so that it fills evenly.
#[derive(Debug)]
pub(super) struct Schedule {
    width: u32,
    height: u32,
    spp: u32,
    /// No pass goes beyond this sample, unless it begins there.
    aim: u32,
    /// The samples of the present pass.
    pass: std::ops::Range<u32>,
    /// Where the next tile begins.
    x: u32,
    y: u32,
}

impl Schedule {
    /// What is left to do of a film until every pixel has all samples before number `end`. In an unfinished pass, which shows in
    /// some pixels having fewer samples than others, the first of these is next.
    pub(super) fn of(film: &Film, end: u32) -> Self {
        let (width, height) = (film.width, film.height);
        let [start, pass_end] = [film.least_samples(), film.most_samples()].map(|n| film.first_sample + n);
        let most = film.most_samples();
        match film.samples.iter().position(|n| *n < most) {
            Some(pixel) if start < end => {
                let (x, y) = (pixel as u32 % width, pixel as u32 / width);
                Schedule { width, height, spp: end, aim: u32::MAX, pass: start..pass_end, x, y }
            }
            _ => Schedule { width, height, spp: end, aim: u32::MAX, pass: start..start, x: 0, y: height },
        }
    }

    /// Samples that all pixels have if the last batch ended a pass.
    pub(super) fn pass_done(&self) -> Option<u32> {
        (self.y == self.height).then_some(self.pass.end)
    }

    /// Lets the next passes end at sample `aim`.
    pub(super) fn aim(&mut self, aim: u32) {
        self.aim = aim;
    }

    /// Whether no batch is left.
    pub(super) fn is_done(&self) -> bool {
        let empty = self.width == 0 || self.height == 0;
        empty || self.y == self.height && self.pass.end >= self.spp
    }

    /// The next batch, of at most `budget` samples and `max_sums` sums, but at least what an invocation of the kernel takes of one pixel.
    pub(super) fn next(&mut self, budget: u64, max_sums: usize) -> Option<Batch> {
        if self.is_done() {
            return None;
        }
        if self.y == self.height {
            let start = self.pass.end;
            (self.x, self.y) = (0, 0);
            self.pass = start..self.pass_end(start, budget, max_sums as u64);
        }
        let samples = self.pass.clone();
        let group = group_length(samples.start);
        let length = u64::from(samples.end - samples.start);
        let whole = Batch { tile: Tile { x: 0, y: 0, width: 1, height: 1 }, samples: samples.clone(), group };
        let pixels = (budget / length).min(max_sums as u64 / u64::from(whole.groups())).max(1);
        let mut tile = Tile { x: self.x, y: self.y, width: self.width - self.x, height: 1 };
        let rows = pixels / u64::from(self.width);
        if self.x == 0 && rows > 0 {
            // Bands of nearly equal height, so that no sliver is left over.
            let left = u64::from(self.height - self.y);
            tile.height = left.div_ceil(left.div_ceil(rows)) as u32;
        } else {
            tile.width = u64::from(tile.width).min(pixels) as u32;
        }
        self.x += tile.width;
        if self.x == self.width {
            (self.x, self.y) = (0, self.y + tile.height);
        }
        Some(Batch { tile, samples, group })
    }

    /// Where a pass from sample `start` ends: several groups of equal length if the whole film with them fits one batch.
    fn pass_end(&self, start: u32, budget: u64, max_sums: u64) -> u32 {
        let in_turn = u64::from(GROUPS_IN_TURN);
        let stride = u64::from(group_length(start)) * in_turn;
        // After an end in the middle of groups, first their rest: where the next ones begin must not depend on the device's speed.
        let begun = u64::from(start) % stride != 0;
        let pixels = u64::from(self.width) * u64::from(self.height);
        let fitting = (budget / (pixels * stride)).min(max_sums / (pixels * in_turn)).max(1);
        let fitting = if begun { 1 } else { fitting };
        let end = u64::from(groups_end(start)) + (fitting - 1) * stride;
        let equal = u64::from(equal_end(start)).min(u64::from(start) + MAX_PASS);
        let aim = if self.aim > start { self.aim } else { u32::MAX };
        end.min(equal).min(u64::from(self.spp.min(aim))) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fresh((width, height): (u32, u32), end: u32) -> Schedule {
        Schedule::of(&Film::new(width, height).unwrap(), end)
    }

    #[test]
    fn group_bounds() {
        let bounds: Vec<u32> =
            std::iter::successors(Some(0), |b| Some(groups_end(*b))).take_while(|b| *b <= 96).collect();
        assert_eq!(bounds, [0, 4, 8, 16, 32, 48, 64, 80, 96]);
        for start in 0..1000 {
            assert!((start..equal_end(start).min(2000)).all(|next| group_length(next) == group_length(start)));
            let next = equal_end(start);
            assert!(next == u32::MAX || group_length(next) > group_length(start));
        }
        assert!(
            (0..1000).all(|start| groups_end(start) > start && groups_end(groups_end(start) - 1) == groups_end(start))
        );
        assert_eq!((groups_end(u32::MAX), group_length(u32::MAX)), (u32::MAX, 4));
    }

    #[test]
    fn a_fast_device_gets_many_groups_at_once() {
        let mut schedule = fresh((64, 64), 1000);
        let passes: Vec<_> = std::iter::from_fn(|| schedule.next(4096 * 480, 1 << 30)).collect();
        assert!(passes.iter().all(|b| b.tile.pixels() == 4096));
        let ranges: Vec<_> = passes.iter().map(|b| b.samples.clone()).collect();
        assert_eq!(ranges, [0..8, 8..16, 16..496, 496..976, 976..1000]);
    }

    #[test]
    fn a_pass_ends_at_the_aim() {
        let mut schedule = fresh((64, 64), 1000);
        schedule.aim(77);
        let passes: Vec<_> = std::iter::from_fn(|| schedule.next(1 << 40, 1 << 30)).map(|b| b.samples).collect();
        assert_eq!(passes, [0..8, 8..16, 16..77, 77..80, 80..1000]);
    }

    #[test]
    fn a_single_pixel_stays_within_the_dispatch_limit() {
        let mut schedule = fresh((1, 1), u32::MAX);
        schedule.pass.end = 64;
        assert_eq!(schedule.next(1 << 40, 1 << 30).map(|b| b.groups()), Some(65_535 * GROUPS_IN_TURN));
    }

    #[test]
    fn the_last_sample_number_is_an_end() {
        let mut schedule = fresh((1, 1), u32::MAX);
        schedule.pass.end = u32::MAX - 7;
        assert_eq!(schedule.next(1 << 40, 1 << 30).map(|b| b.samples), Some(u32::MAX - 7..u32::MAX));
        assert_eq!(schedule.next(1 << 40, 1 << 30), None);
    }

    #[test]
    fn every_pass_is_a_pass_and_nothing_else() {
        for (budget, end) in [(16, 100), (700, 1000), (1 << 40, 2000)] {
            let mut schedule = fresh((3, 2), end);
            while let Some(batch) = schedule.next(budget, 1 << 30) {
                assert!(is_a_pass(batch.samples.clone()), "{:?}", batch.samples);
            }
        }
        for wrong in [0..9, 3..9, 4..9, 8..17, 0..100_000_000, 16..100_000_000] {
            assert!(!is_a_pass(wrong.clone()), "{wrong:?}");
        }
    }

    #[test]
    fn a_film_tells_where_its_render_was() {
        for (batches_before, end) in [(0, 40), (1, 40), (5, 40), (23, 77), (60, 77)] {
            let mut film = Film::new(37, 23).unwrap();
            let mut schedule = Schedule::of(&film, end);
            schedule.aim(50);
            let work: Vec<_> = std::iter::from_fn(|| schedule.next(700, 1 << 30)).collect();
            for batch in &work[..batches_before.min(work.len())] {
                film.add(batch, &vec![Default::default(); batch.tile.pixels() * batch.groups() as usize]);
            }
            let mut again = Schedule::of(&film, end);
            again.aim(50);
            let rest: Vec<_> = std::iter::from_fn(|| again.next(700, 1 << 30)).collect();
            assert_eq!(rest, work[batches_before.min(work.len())..]);
        }
    }

    #[test]
    fn a_later_part_has_the_groups_of_the_whole() {
        let mut film = Film::new(1, 1).unwrap();
        film.first_sample = 64;
        let mut schedule = Schedule::of(&film, 128);
        assert_eq!(schedule.next(16, 1 << 30).map(|b| (b.samples, b.group)), Some((64..80, 4)));
        film.first_sample = 70;
        let mut schedule = Schedule::of(&film, 128);
        let passes: Vec<_> = std::iter::from_fn(|| schedule.next(1 << 40, 1 << 30)).map(|b| b.samples).collect();
        assert_eq!(passes, [70..80, 80..128]);
    }
}
