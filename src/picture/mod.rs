//! Pictures on disk, without what made them: PNG to look at, EXR and HDR to compute with; reading them, and PFM, to compare; and images
//! as textures and environments.

mod crop;
pub(crate) mod decode;
mod encoding;
mod first_bytes;
mod foreign;
mod format;
mod icc;
mod openexr;
mod pfm;
mod pixels;
mod png_colours;
mod primaries;
mod radiance;
mod read;
mod srgb;
mod write;

pub use crate::memory::{available as free_memory, gib as bytes_in_words};
pub use crop::Crop;
pub use format::{Format, check_output};
pub use openexr::{Attribute, Exr, Values};
pub(crate) use openexr::{read_channels, read_texts};
pub use pixels::Picture;
pub use read::read;
pub(crate) use srgb::linear;
pub use srgb::{srgb, to_srgb8};
pub use write::{save_linear, save_png, save_png_with_alpha};
