//! The benchmark: error over time, and the cost of rays. A new chart is added to the [`Section`] it belongs to, a new section to [`SECTIONS`].
//!
//! Every part of it gives a [`Section`]: what was measured as numbers with their spread, which are called [`Figure`]s here, and the charts and
//! sentences made of them. The folders `convergence` and `rays`, and the files `preparation` and `growth`, hold the section of their name.
//! [`SECTIONS`] lists the parts, [`Report`] is a run of them, [`html`] and [`markdown`] make a page of it, and [`Baseline`] compares it with an
//! earlier run.

mod baseline;
mod convergence;
mod definition;
mod effort;
mod figure;
pub mod figure_name;
pub mod growth;
pub mod meshes;
mod page;
pub mod power_law;
mod preparation;
pub mod rays;
mod record;
mod renders;
mod report;
pub mod rounds;
mod scene;
mod section;
mod settings;

pub use baseline::{Baseline, Change, MARGIN, Verdict};
pub use convergence::{Candidate, STANDARD, check_estimator, front};
pub use definition::{Definition, Outcome, Progress};
pub use effort::Effort;
pub use figure::{Better, Figure};
pub use page::{file_name, html, markdown};
pub use record::Machine;
pub use report::Report;
pub use scene::BenchScene;
pub use section::Section;
pub use settings::Settings;

use crate::report::choice;
use luminaire::Result;

/// Every part, in the order of the page.
pub const SECTIONS: &[Definition] =
    &[convergence::DEFINITION, preparation::DEFINITION, rays::DEFINITION, growth::DEFINITION];

/// The parts of these names, in the order of the page; all of them for no name.
///
/// # Errors
/// [`Error::Usage`](luminaire::Error::Usage) for a name that no part has; it lists those there are.
pub fn named(names: &[String]) -> Result<Vec<Definition>> {
    choice::named("section", SECTIONS, |section| section.name, names)
}
