//! Measuring: statistics of pictures, whether the error bar is right, how far two pictures are apart, charts, and the sweeps that show
//! where methods fail.

pub mod bench;
pub mod calibration;
pub mod chart;
pub mod closed_forms;
pub mod flip;
pub mod furnaces;
pub mod heat_map;
pub mod intersect_f32;
pub mod metrics;
pub mod random;
pub mod rays;
pub mod report;
pub mod stability;
pub mod statistics;
pub mod stopping;
mod workbench;

pub use workbench::Workbench;
