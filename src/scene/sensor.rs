//! The camera.

use super::settings::FilmSettings;
use glam::{DVec3, Vec3};

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

/// Relative error of one rounding in single precision.
const ROUNDING: f64 = f32::EPSILON as f64 * 0.5;
/// A pixel that is larger than so many roundings of a ray's points is drawn well from the eye point itself.
const ROUNDINGS_IN_A_PIXEL: f64 = 64.0;

impl Sensor {
    /// How far in front of the eye point, along the line of sight, a tracer of single precision lets camera rays start: 0, the eye point itself,
    /// unless pixels are so small, and so far away, that the rounding of points and directions would show. Then it is a plane in front of the
    /// scene's bounds; there is none if the bounds reach up to the eye point.
    pub fn start(&self, film: &FilmSettings, bounds: (DVec3, DVec3)) -> f64 {
        if self.is_coarse(film, bounds) { self.in_front_of(bounds) } else { 0.0 }
    }

    /// Whether single precision is too coarse for the picture, and [`Sensor::start`] is no help.
    pub fn is_beyond_single_precision(&self, film: &FilmSettings, bounds: (DVec3, DVec3)) -> bool {
        self.is_coarse(film, bounds) && self.in_front_of(bounds) == 0.0
    }

    /// Whether a pixel is small beside the rounding of points as far away as the scene.
    fn is_coarse(&self, film: &FilmSettings, bounds: (DVec3, DVec3)) -> bool {
        let position = self.position.as_dvec3();
        let middle = 0.5 * (bounds.0 + bounds.1);
        let distance = position.distance(middle);
        let half = match self.projection {
            Projection::Perspective { fov } => distance * (f64::from(fov).to_radians() / 2.0).tan(),
            Projection::Orthographic { height } => 0.5 * f64::from(height),
        };
        let pixel = 2.0 * half / f64::from(film.height);
        pixel < ROUNDINGS_IN_A_PIXEL * ROUNDING * distance.max(position.abs().max_element())
    }

    /// The distance of a plane across the line of sight that has all of the bounds behind it, by a quarter of their size; 0 if the eye point
    /// is not in front of it.
    fn in_front_of(&self, (low, high): (DVec3, DVec3)) -> f64 {
        let position = self.position.as_dvec3();
        let forward = (self.target.as_dvec3() - position).normalize();
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        (forward.dot(middle - position) - forward.abs().dot(half) - 0.5 * half.length()).max(0.0)
    }
}
