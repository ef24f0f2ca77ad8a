//! Pictures on disk, without what made them: PNG to look at, EXR and HDR to compute with; reading them, and PFM, to compare; and images
//! as textures and environments.

mod crop;
pub(crate) mod decode;
mod development;
mod encoding;
mod foreign;
mod format;
mod icc;
mod mark;
mod openexr;
mod pfm;
mod pixels;
mod png_colours;
mod primaries;
mod radiance;
mod read;
pub(crate) mod source;
mod srgb;
mod tone;
mod write;

pub use crate::memory::{available as free_memory, gib as bytes_in_words};
pub use crop::Crop;
pub use development::{Development, to_srgb8};
pub use format::{Format, check_output};
pub(crate) use mark::MARK;
pub use mark::mark;
pub use openexr::{Attribute, Exr, Values};
pub(crate) use openexr::{read_channels, read_texts};
pub use pixels::Picture;
pub use read::read;
pub(crate) use srgb::linear;
pub use srgb::srgb;
pub use tone::Tone;
pub(crate) use tone::luminance;
pub use write::{save_linear, save_png, save_png_with_alpha};
pub(crate) use write::{save_marked, save_marked_with_alpha};
