//! The stability map: every method over the range in which it can fail, on every backend.

mod geometry;
mod glass;
mod judge;
mod lamp;
mod light;
mod limits;
mod page;
mod plate;
mod rooms;
mod sweep;
pub mod sweeps;
mod trial;
pub mod verdict;
mod wall;

pub use page::{Head, Outcome, page};
pub use sweep::{Definition, Family, Findings, SUMMARY, Sweep};

use crate::report::choice;
use luminaire::Result;

/// Every sweep, in the order of the map.
pub const SWEEPS: &[Definition] = &[
    sweeps::distance::DEFINITION,
    sweeps::scale::DEFINITION,
    sweeps::edges::DEFINITION,
    sweeps::slivers::DEFINITION,
    sweeps::gaps::DEFINITION,
    sweeps::instances::DEFINITION,
    sweeps::eta::DEFINITION,
    sweeps::touching_glass::DEFINITION,
    sweeps::glossy::DEFINITION,
    sweeps::roughness::DEFINITION,
    sweeps::anisotropy::DEFINITION,
    sweeps::rough_index::DEFINITION,
    sweeps::absorption::DEFINITION,
    sweeps::grazing::DEFINITION,
    sweeps::luminaire::DEFINITION,
    sweeps::edge_on::DEFINITION,
    sweeps::spot::DEFINITION,
    sweeps::caustics::DEFINITION,
    sweeps::glossy_caustics::DEFINITION,
    sweeps::albedo::DEFINITION,
    sweeps::extinction::DEFINITION,
    sweeps::samples::DEFINITION,
    sweeps::many::DEFINITION,
];

/// The sweeps of these names, in the order of the map; all of them for no name.
///
/// # Errors
/// [`Error::Usage`](luminaire::Error::Usage) for a name that no sweep has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    choice::named("sweep", SWEEPS, |sweep| sweep.name, names)
}
