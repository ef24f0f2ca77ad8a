//! What the tests share: scenes built in code, and statistics.
#![allow(dead_code)] // Each test binary uses a part of it.

pub mod directions;
pub mod scenes;
pub mod statistics;
