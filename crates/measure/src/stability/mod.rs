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
pub mod slivers;
mod spot;
mod sweep;
mod trial;
pub mod verdict;
mod words;

pub use page::{Head, Outcome, page};
pub use sweep::{Definition, Family, Findings, SUMMARY, Sweep};

use luminaire::{Error, Result};

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
/// [`Error::Usage`] for a name that no sweep has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    if let Some(unknown) = names.iter().find(|name| SWEEPS.iter().all(|sweep| sweep.name != **name)) {
        let known: Vec<_> = SWEEPS.iter().map(|sweep| sweep.name).collect();
        return Err(Error::Usage(format!("there is no sweep `{unknown}`; there are: {}", known.join(", "))));
    }
    let wanted = |sweep: &&Definition| names.is_empty() || names.iter().any(|name| name == sweep.name);
    Ok(SWEEPS.iter().filter(wanted).copied().collect())
}
