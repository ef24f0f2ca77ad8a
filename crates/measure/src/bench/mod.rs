//! The benchmark: error over time, and the cost of rays.
//!
//! Every part of it gives a [`Section`]: what was measured as numbers with their spread, and the charts and sentences made of them.
//! [`SECTIONS`] lists the parts, [`Report`] is a run of them, [`html`] and [`markdown`] make a page of it, and [`Baseline`] compares it with an
//! earlier run.

mod baseline;
pub mod break_even;
mod contenders;
mod curve;
mod curve_section;
mod definition;
mod effort;
mod figure;
pub mod figure_name;
pub mod growth;
pub mod intersectors;
pub mod meshes;
mod page;
mod pareto;
pub mod power_law;
mod preparation;
pub mod ray_kinds;
pub mod ray_section;
mod record;
mod reference;
mod renders;
mod report;
pub mod rounds;
mod scene;
mod section;
mod settings;
mod trial;

pub use baseline::{Baseline, Change, MARGIN, Verdict};
pub use contenders::{STANDARD, check_estimator};
pub use definition::{Definition, Outcome, Progress};
pub use effort::Effort;
pub use figure::{Better, Figure};
pub use page::{file_name, html, markdown};
pub use pareto::{Candidate, front};
pub use record::Machine;
pub use report::Report;
pub use scene::BenchScene;
pub use section::Section;
pub use settings::Settings;

use crate::report::choice;
use luminaire::Result;

/// Every part, in the order of the page.
pub const SECTIONS: &[Definition] =
    &[curve_section::DEFINITION, preparation::DEFINITION, ray_section::DEFINITION, growth::DEFINITION];

/// The parts of these names, in the order of the page; all of them for no name.
///
/// # Errors
/// [`Error::Usage`](luminaire::Error::Usage) for a name that no part has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    choice::named("section", SECTIONS, |section| section.name, names)
}
