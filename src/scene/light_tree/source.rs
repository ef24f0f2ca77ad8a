//! Luminaires as the tree sees them.

use glam::{DVec3, Vec3};

/// What a luminaire is to the tree.
#[derive(Debug, Clone)]
pub struct Source {
    /// Index into the luminaire table.
    pub entry: u32,
    /// Corners as the kernel has them, three times the same for a point.
    pub corners: [Vec3; 3],
    /// Unit normal; zero: light goes everywhere alike.
    pub normal: DVec3,
    /// Whether both sides emit.
    pub two_sided: bool,
    /// Whether it is a part of a closed lamp, of which nobody outside sees the inner sides; then the normal is outward.
    pub closed: bool,
    /// Degrees from the normal within which all of its light stays; then that light is the same within, as far as the tree is concerned.
    pub cone: Option<f64>,
    /// Intensity along the normal, or the mean of a cone's, averaged over the channels.
    pub strength: f64,
}

impl Source {
    /// Whether it is all the same which of its sides the normal is on.
    pub(super) fn turns(&self) -> bool {
        self.two_sided && !self.closed
    }

    /// Whether its cone reaches behind it, so that it has no side.
    pub(super) fn shines_back(&self) -> bool {
        self.cone.is_some_and(|cone| cone > 90.0)
    }
}
