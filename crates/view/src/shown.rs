//! [`Shown`]: what of a film the window shows: the picture, its error, or a property of the first surface.

use super::first_hit::FirstHit;

/// What of a film is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The picture, as a PNG of it looks.
    Picture,
    /// The estimated relative error of every pixel, with its scale.
    Error,
    /// A property of the first surface.
    First(FirstHit),
}

impl Shown {
    /// Its name, for messages and the title.
    pub fn name(self) -> &'static str {
        match self {
            Shown::Picture => "picture",
            Shown::Error => "error map",
            Shown::First(FirstHit::Albedo) => "albedo",
            Shown::First(FirstHit::Normal) => "normals",
            Shown::First(FirstHit::Depth) => "depth",
        }
    }
}
