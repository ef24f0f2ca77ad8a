//! The film and the sensor of the cases' pictures.

use glam::{Vec3, Vec3Swizzles};
use luminaire::scene::{Scene, Sensor, build};

/// Pixels on each side of every picture.
pub const SIDE: u32 = 16;

/// An empty scene of the size of every picture.
pub(super) fn empty() -> Scene {
    build::empty(SIDE, SIDE)
}

/// A sensor whose whole picture is a speck of a millionth around `point`, seen from the side of `normal`, an axis, out of a distance of 1/16.
pub(super) fn speck(point: Vec3, normal: Vec3) -> Sensor {
    let aside = normal.yzx();
    build::pinhole(point + normal / 16.0 + aside / 64.0, point, normal.zxy(), 1e-3)
}
