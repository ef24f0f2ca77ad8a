//! Measuring: statistics of pictures, how far two are apart, whether the error bar is right, charts, and the sweeps that show where methods fail.

pub mod calibration;
pub mod chart;
pub mod flip;
pub mod heat_map;
pub mod metrics;
pub mod stability;
pub mod statistics;
mod workbench;

pub use workbench::Workbench;
