//! OpenEXR: pictures of floats, with the standard error of every pixel beside them.

mod channels;
mod choice;
mod picture;
mod writer;

pub(crate) use channels::{read_channels, read_texts};
pub(super) use picture::Opened;
pub use writer::{Attribute, Exr};

use super::pixels::io_in_words;

/// The bytes with which a file begins.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// What the names of the channels begin with that hold the standard error.
const ERROR: &str = "error.";

/// A number for every pixel, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// 32-bit whole numbers.
    Integer(Vec<u32>),
}

fn in_words(error: ::exr::error::Error) -> String {
    match error {
        ::exr::error::Error::NotSupported(what) => format!("this kind of OpenEXR file cannot be read here ({what})"),
        ::exr::error::Error::Invalid(what) => format!("it is damaged or truncated ({what})"),
        ::exr::error::Error::Io(error) => io_in_words(error),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests;
