//! How a render with shares is cut into batches.

use super::schedule::MAX_PASS;
use super::shares::Shares;
use crate::film::{Batch, Film, GROUPS_IN_TURN, LONGEST_GROUP, Tile};

/// An invocation of the kernel takes so many samples.
const IN_TURN: u32 = LONGEST_GROUP * GROUPS_IN_TURN;

/// Goes over the tiles of a film, row by row from the top: those that lie beside each other and want the same samples are rendered at once.
#[derive(Debug)]
pub(super) struct Patches {
    /// The first tile that may lack samples.
    tile: u32,
}

impl Patches {
    /// Begins with the first tile.
    pub(super) fn new() -> Self {
        Patches { tile: 0 }
    }

    /// Finds the next tile that lacks samples. None if all have what they are to have when those of the smallest share have `step`.
    pub(super) fn find(&mut self, film: &Film, shares: &Shares, step: u32) -> Option<u32> {
        while self.tile < shares.tiles() && lacking(film, shares, step, self.tile).1 == 0 {
            self.tile += 1;
        }
        (self.tile < shares.tiles()).then_some(self.tile)
    }

    /// The next batch, of at most `budget` samples and `max_sums` sums, but at least a group of every pixel of a tile.
    pub(super) fn next(
        &mut self,
        film: &Film,
        shares: &Shares,
        step: u32,
        budget: u64,
        max_sums: usize,
    ) -> Option<Batch> {
        let first = self.find(film, shares, step)?;
        let wanted = lacking(film, shares, step, first);
        let [x, y, mut width, height] = shares.tile(first);
        let begin = wanted.0;
        let fits = |width: u32, samples: u32| {
            let pixels = u64::from(width * height);
            pixels * u64::from(samples) <= budget
                && pixels * u64::from(samples.div_ceil(LONGEST_GROUP)) <= max_sums as u64
        };
        let mut next = first + 1;
        while next < shares.tiles() && lacking(film, shares, step, next) == wanted {
            let [_, same_row, more, _] = shares.tile(next);
            if same_row != y || !fits(width + more, wanted.1.min(IN_TURN)) {
                break;
            }
            (width, next) = (width + more, next + 1);
        }
        // As many rounds as fit; how they are cut does not show in the picture.
        let mut samples = u64::from(wanted.1).min(MAX_PASS) as u32;
        while samples > LONGEST_GROUP && !fits(width, samples) {
            samples = (samples / 2).next_multiple_of(if samples > 2 * IN_TURN { IN_TURN } else { LONGEST_GROUP });
        }
        Some(Batch { tile: Tile { x, y, width, height }, samples: begin..begin + samples, group: LONGEST_GROUP })
    }
}

/// The samples that a tile has, and how many it lacks.
fn lacking(film: &Film, shares: &Shares, step: u32, tile: u32) -> (u32, u32) {
    let [x, y, ..] = shares.tile(tile);
    let samples = film.samples[(y * film.width + x) as usize];
    (samples, shares.samples(tile, step).saturating_sub(samples))
}
