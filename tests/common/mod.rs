//! What the tests share: scenes built in code, statistics, and what to do where a device is missing.
#![allow(dead_code, unused_imports)] // Each test binary uses a part of it.

pub mod bodies;
pub mod devices;
pub mod directions;
pub mod facets;
pub mod lamps;
pub mod many_lamps;
pub mod relief;
pub mod scenes;
pub mod stage;
pub mod statistics;
pub mod touching;

pub use devices::{bench, skip};
