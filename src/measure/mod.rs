//! Measuring: statistics of pictures, charts, and the sweeps that show where methods fail.

pub mod chart;
pub mod closed_forms;
pub mod stability;
pub mod statistics;
mod workbench;

pub use workbench::Workbench;
