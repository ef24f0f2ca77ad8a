//! Measuring: statistics of pictures.

pub mod statistics;
