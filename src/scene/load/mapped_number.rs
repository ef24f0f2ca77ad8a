//! A number or a colour of a material that a map multiplies, while they are still being read.

use super::map_draft::MapDraft;
use super::map_file::MapFile;
use glam::Vec3;

/// One of them, with its map. Where the number is missing it is 1 beside the map; where it is 0 the map does nothing.
#[derive(Debug)]
pub(super) struct Mapped<'a> {
    /// Its key in a scene file.
    pub key: &'static str,
    /// The key of the map.
    pub map_key: &'static str,
    /// What is said of it.
    pub number: Number<'a>,
    /// Its map.
    pub map: &'a MapDraft,
}

/// What is said of a number or a colour.
#[derive(Debug)]
pub(super) enum Number<'a> {
    /// A number.
    One(&'a mut Option<f32>),
    /// A colour.
    Colour(&'a mut Option<Vec3>),
}

impl Number<'_> {
    /// Whether anything is said.
    fn is_stated(&self) -> bool {
        match self {
            Number::One(number) => number.is_some(),
            Number::Colour(colour) => colour.is_some(),
        }
    }

    /// Whether it is said to be 0, in all channels.
    fn is_zero(&self) -> bool {
        match self {
            Number::One(number) => **number == Some(0.0),
            Number::Colour(colour) => **colour == Some(Vec3::ZERO),
        }
    }

    fn forget(&mut self) {
        match self {
            Number::One(number) => **number = None,
            Number::Colour(colour) => **colour = None,
        }
    }
}

impl Mapped<'_> {
    /// The map that does nothing, because its number is 0.
    pub(super) fn idle_map(&self) -> Option<&MapFile> {
        self.map.file().filter(|_| self.number.is_zero())
    }

    /// Forgets a 0 over which `other`, in which it is missing, names a map. Returns that map.
    pub(super) fn wake<'b>(&mut self, other: &'b Mapped) -> Option<&'b MapFile> {
        let map = other.map.file().filter(|_| self.number.is_zero() && !other.number.is_stated())?;
        self.number.forget();
        Some(map)
    }
}
