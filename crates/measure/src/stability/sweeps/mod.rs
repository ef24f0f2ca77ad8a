//! The sweeps, each in a file of its name on the command line: a new one is also added to [`SWEEPS`](super::SWEEPS).

pub mod absorption;
pub mod albedo;
pub mod anisotropy;
pub mod caustics;
pub mod distance;
pub mod edge_on;
pub mod edges;
pub mod eta;
pub mod extinction;
pub mod gaps;
pub mod glossy;
pub mod glossy_caustics;
pub mod grazing;
pub mod instances;
pub mod luminaire;
pub mod many;
pub mod rough_index;
pub mod roughness;
pub mod samples;
pub mod scale;
pub mod slivers;
pub mod spot;
pub mod touching_glass;
