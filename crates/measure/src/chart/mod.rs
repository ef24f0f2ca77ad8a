//! Charts as data, as SVG and as CSV.

mod axis;
mod csv;
mod data;
mod ruler;
mod svg;

pub use axis::{Axis, Scale};
pub use csv::CSV_HEADER;
pub use data::{Chart, FRONT, Point, Series};
