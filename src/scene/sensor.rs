//! The camera.

use glam::Vec3;

/// The camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Eye point.
    pub position: Vec3,
    /// Point in the middle of the picture.
    pub target: Vec3,
    /// A direction that is up in the picture; not parallel to the line of sight.
    pub up: Vec3,
    /// How directions become pixels.
    pub projection: Projection,
    /// A thin lens; none: a pinhole, everything is in focus.
    pub lens: Option<Lens>,
}

/// How directions become pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// All rays through the eye point.
    Perspective {
        /// Vertical field of view in degrees, in (0, 180).
        fov: f32,
    },
    /// Parallel rays; with a lens those through the middle of the aperture, which moves along with the pixel (a telecentric lens).
    Orthographic {
        /// Height of what the picture shows, in the scene's unit; greater than 0.
        height: f32,
    },
}

/// A thin lens around the eye point; with parallel rays around the point where each ray begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Radius of the aperture, greater than 0; for blades, of the circle through the corners.
    pub radius: f32,
    /// Distance along the line of sight of the plane that is in focus; greater than 0.
    pub focus_distance: f32,
    /// Corners of the aperture, at least 3; 0: a disk.
    pub blades: u32,
    /// Degrees by which the aperture is turned.
    pub rotation: f32,
}
