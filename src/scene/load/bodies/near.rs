//! Points that are meant to be one, but for the rounding of numbers.

use crate::scene::sets::Sets;
use glam::DVec3;
use std::collections::HashMap;

/// Pairs of points that are compared: where more lie that close together, nobody can tell which are meant to be one.
const MOST_PAIRS: usize = 1 << 24;

/// Points, each with a reach, and which of them are one.
#[derive(Default)]
pub(super) struct Near {
    points: Vec<(DVec3, f64)>,
    sets: Sets,
    /// By cell of a grid, the points whose reach touches it.
    cells: HashMap<[i64; 3], Vec<u32>>,
    cell: f64,
}

impl Near {
    /// One more point, and how far from it others are meant to be it. Gives its number.
    pub fn add(&mut self, point: DVec3, reach: f64) -> u32 {
        self.points.push((point, reach));
        self.points.len() as u32 - 1
    }

    /// Finds out which points are one, when all have been added.
    pub fn join(&mut self) {
        self.sets = Sets::new(self.points.len());
        // Most points then touch one cell.
        self.cell = self.points.iter().fold(f64::MIN_POSITIVE, |most, (_, reach)| most.max(8.0 * reach));
        let mut pairs = 0;
        for (number, (point, reach)) in (0..).zip(&self.points) {
            let (low, high) = (self.cell_of(*point - *reach), self.cell_of(*point + *reach));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        let others = self.cells.entry([x, y, z]).or_default();
                        for &other in &*others {
                            pairs += 1;
                            if pairs > MOST_PAIRS {
                                break;
                            }
                            let (at, of_other) = self.points[other as usize];
                            if at.distance(*point) <= reach.max(of_other) {
                                self.sets.join(number as usize, other as usize);
                            }
                        }
                        others.push(number);
                    }
                }
            }
        }
    }

    /// The number that stands for a point and all that are one with it.
    pub fn one(&mut self, number: u32) -> u32 {
        self.sets.of(number as usize) as u32
    }

    /// The number that stands for the points at a place, if there are any.
    pub fn at(&mut self, place: DVec3) -> Option<u32> {
        let there = |&&number: &&u32| {
            let (point, reach) = self.points[number as usize];
            point.distance(place) <= reach
        };
        let found = self.cells.get(&self.cell_of(place))?.iter().find(there).copied();
        found.map(|number| self.one(number))
    }

    /// Where a point is, and its reach.
    pub fn point(&self, number: u32) -> (DVec3, f64) {
        self.points[number as usize]
    }

    fn cell_of(&self, point: DVec3) -> [i64; 3] {
        (point / self.cell).floor().to_array().map(|x| x as i64)
    }
}
