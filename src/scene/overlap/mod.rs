//! What lies in one place twice, or in the plane of something else: lamps (`lamps.rs`), and glass that touches other surfaces (`glass.rs`).

mod contact;
mod doubled;
mod edits;
mod face;
mod glass;
mod groups;
mod lamps;
mod pull;
mod report;
mod search;
mod union;
