//! Measuring: statistics of pictures, whether the error bar is right, charts, and the sweeps that show where methods fail.

pub mod calibration;
pub mod chart;
pub mod stability;
pub mod statistics;
mod workbench;

pub use workbench::Workbench;
