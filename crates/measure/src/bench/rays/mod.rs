//! The section `rays`: ray query, compute BVH and reference on the same rays, with nothing else.

pub mod break_even;
pub mod intersectors;
pub mod kinds;
mod section;

pub(super) use section::DEFINITION;
pub use section::section;
