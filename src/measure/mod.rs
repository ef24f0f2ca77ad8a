//! Measuring: statistics of pictures, charts, and the sweeps that show where methods fail.

pub mod chart;
pub mod intersect_f32;
pub mod rays;
pub mod stability;
pub mod statistics;
mod workbench;

pub use workbench::Workbench;
