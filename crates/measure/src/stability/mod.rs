//! The stability map: every method over the range in which it can fail, on every backend.

mod albedo;
pub mod caustics;
pub mod distance;
pub mod edges;
pub mod eta;
mod extinction;
pub mod gaps;
mod geometry;
pub mod glass;
pub mod glossy;
pub mod instances;
mod judge;
mod many;
pub mod near_lamps;
mod page;
mod rooms;
mod samples;
pub mod scale;
mod series;
pub mod slivers;
mod spot;
mod sweep;
mod trial;
pub mod verdict;

pub use page::{Head, Outcome, page};
pub use sweep::{Definition, Family, Findings, SUMMARY, Sweep};

use crate::report::choice;
use luminaire::Result;

/// Every sweep, in the order of the map.
pub const SWEEPS: &[Definition] = &[
    distance::DEFINITION,
    scale::DEFINITION,
    edges::DEFINITION,
    slivers::DEFINITION,
    gaps::DEFINITION,
    instances::DEFINITION,
    eta::DEFINITION,
    glass::DEFINITION,
    glossy::DEFINITION,
    near_lamps::DISTANCE,
    near_lamps::TILT,
    caustics::MIRROR,
    caustics::LOBE,
    albedo::DEFINITION,
    extinction::DEFINITION,
    samples::DEFINITION,
    many::DEFINITION,
];

/// The sweeps of these names, in the order of the map; all of them for no name.
///
/// # Errors
/// [`Error::Usage`](luminaire::Error::Usage) for a name that no sweep has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    choice::named("sweep", SWEEPS, |sweep| sweep.name, names)
}
