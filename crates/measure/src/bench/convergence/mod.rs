//! The section `convergence`: error over time, by estimator and backend.

mod contenders;
mod measured;
mod pareto;
mod reference_picture;
mod section;
mod trial;

pub use contenders::{STANDARD, check_estimator};
pub use pareto::{Candidate, front};
pub(super) use section::DEFINITION;
