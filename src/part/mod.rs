//! A part of a render on disk, from which it can go on, or which can be added to others: an OpenEXR file.
//!
//! The file shows the picture so far (`R`, `G`, `B`, and `error.R`, `error.G`, `error.B`), and beside it, to the last bit, holds what the
//! film holds: for every block `b` of a pixel's samples ([`Blocks`](crate::film::Blocks)) and every channel `c` the `f64` sum of the radiance, as its two halves
//! `sum.b.c.high` and `sum.b.c.low`; the number of samples, `samples`; and, if there are any, the number of samples that were not finite,
//! `dropped.b`. Two texts in the head, both JSON, say what was rendered ([`Provenance`]) and what else was counted. A third is the digest of the whole file: one of
//! which a single bit has changed is refused.

mod digest;
mod file;
mod merge;
mod provenance;

pub use file::{is_part, read, resume, resume_crop, save};
pub use merge::{Shown, merge};
pub use provenance::Provenance;
