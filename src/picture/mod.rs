//! Pictures on disk, without what made them: PNG to look at, EXR and HDR to compute with; reading them, and PFM, to compare; and images
//! as textures and environments.

pub(crate) mod decode;
mod first_bytes;
mod format;
mod openexr;
mod pfm;
mod pixels;
mod read;
mod srgb;
mod write;

pub use format::{Format, check_output};
pub use openexr::{Attribute, Exr, Values};
pub(crate) use openexr::{read_channels, read_texts};
pub use pixels::Picture;
pub use read::read;
pub(crate) use srgb::linear;
pub use srgb::{srgb, to_srgb8};
pub use write::{save_linear, save_png};
