//! The camera.

use super::settings::FilmSettings;
use glam::{DQuat, DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

/// The camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Eye point.
    pub position: Vec3,
    /// Point in the middle of the picture; with a shift, a point of the line of sight.
    pub target: Vec3,
    /// A direction that is up in the picture; not parallel to the line of sight.
    pub up: Vec3,
    /// How directions become pixels.
    pub projection: Projection,
    /// A thin lens; none: a pinhole, everything is in focus.
    pub lens: Option<Lens>,
    /// What is shown lies so many widths of the picture to the right, and heights above, of what is around the line of sight: a shift lens. The camera does
    /// not turn, so that what is parallel to the picture (the verticals of a house, looked at horizontally) stays so.
    pub shift: Vec2,
}

/// One of the cameras of a scene, by its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Its name; empty if it has none.
    pub name: String,
    /// What it sees, and how.
    pub sensor: Sensor,
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

/// About what a sensor turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pivot {
    /// The axis through its target: it moves around that.
    Target,
    /// The axis through its own position: it stays where it is, and looks around.
    Position,
}

/// An `up` is along an axis within so many degrees.
const UPRIGHT: f64 = 1.0;
/// A line of sight within so many degrees of -y looks down.
const LOOKS_DOWN: f64 = 30.0;
/// Relative error of one rounding in single precision.
const ROUNDING: f64 = f32::EPSILON as f64 * 0.5;
/// A pixel that is larger than so many roundings of a ray's points is drawn well.
const ROUNDINGS_IN_A_PIXEL: f64 = 16.0;

impl Sensor {
    /// The sensor after so many turns about the vertical axis ([`Sensor::vertical`]) through its target, or on the spot: counter-clockwise as seen from
    /// above, so that the scene seems to turn clockwise. After none it is the sensor itself.
    #[must_use]
    pub fn turned(&self, turns: f64, pivot: Pivot) -> Sensor {
        if turns == 0.0 {
            return self.clone();
        }
        let turn = DQuat::from_axis_angle(self.vertical(), turns * TAU);
        let (position, target) = (self.position.as_dvec3(), self.target.as_dvec3());
        let (position, target) = match pivot {
            Pivot::Target => (target + turn * (position - target), target),
            Pivot::Position => (position, position + turn * (target - position)),
        };
        let up = (turn * self.up.as_dvec3()).as_vec3();
        Sensor { position: position.as_vec3(), target: target.as_vec3(), up, ..self.clone() }
    }

    /// Which way is up in the scene: +y; but the sensor's `up` where that is +z, and the sensor does not look down the y axis, as from
    /// straight above: then z is vertical, as in Blender.
    pub fn vertical(&self) -> DVec3 {
        let up = self.up.as_dvec3().normalize();
        let is_z = up.z > UPRIGHT.to_radians().cos();
        let looks_down = -self.forward().y > LOOKS_DOWN.to_radians().cos();
        if is_z && !looks_down { up } else { DVec3::Y }
    }

    /// How far in front of the eye point, along the line of sight, a tracer of single precision lets camera rays start: 0, the eye point itself,
    /// unless pixels are so small, and so far away, that the rounding of points and directions would show. Then it is a plane in front of the
    /// scene's bounds; there is none if the bounds reach up to the eye point.
    pub fn start(&self, film: &FilmSettings, bounds: (DVec3, DVec3)) -> f64 {
        let distance = self.in_front_of(bounds);
        let largest = self.position.as_dvec3().abs().max_element().max(distance);
        if self.pixel(film, distance) < ROUNDINGS_IN_A_PIXEL * ROUNDING * largest { distance } else { 0.0 }
    }

    /// Whether single precision is too coarse for the picture, from wherever rays start: by its rounding over the depth of the scene, and by
    /// the coordinates there.
    pub fn is_beyond_single_precision(&self, film: &FilmSettings, bounds: (DVec3, DVec3)) -> bool {
        let start = self.start(film, bounds);
        let depth = (bounds.1 - bounds.0).length();
        let coordinates = (self.position.as_dvec3() + start * self.forward()).abs().max_element();
        let largest = match self.projection {
            Projection::Perspective { .. } => coordinates.max(depth),
            // All rays round alike: a shift, not a blur.
            Projection::Orthographic { .. } => coordinates,
        };
        self.pixel(film, self.in_front_of(bounds) + depth) < ROUNDINGS_IN_A_PIXEL * ROUNDING * largest
    }

    /// The height of a pixel at a distance.
    fn pixel(&self, film: &FilmSettings, distance: f64) -> f64 {
        let height = match self.projection {
            Projection::Perspective { fov } => 2.0 * distance * (f64::from(fov).to_radians() / 2.0).tan(),
            Projection::Orthographic { height } => f64::from(height),
        };
        height / f64::from(film.height)
    }

    fn forward(&self) -> DVec3 {
        (self.target.as_dvec3() - self.position.as_dvec3()).normalize()
    }

    /// The distance of a plane across the line of sight that has all of the bounds behind it, by a quarter of their size; 0 if the eye point
    /// is not in front of it.
    fn in_front_of(&self, (low, high): (DVec3, DVec3)) -> f64 {
        let forward = self.forward();
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let nearest = forward.dot(middle - self.position.as_dvec3()) - forward.abs().dot(half);
        (nearest - 0.5 * half.length()).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::build::pinhole;

    #[test]
    fn it_turns_about_the_vertical_as_seen_from_above() {
        let sensor = |position, up| Sensor {
            position,
            target: Vec3::new(1.0, 1.0, 1.0),
            up,
            projection: Projection::Perspective { fov: 40.0 },
            lens: None,
            shift: Vec2::ZERO,
        };
        // From the front, +z, a quarter of a turn goes to the right, +x; heights stay.
        let start = sensor(Vec3::new(1.0, 3.0, 5.0), Vec3::Y * 7.0);
        let near = |turns: f64, expected: Vec3| {
            let turned = start.turned(turns, Pivot::Target);
            assert!(turned.position.distance(expected) < 1e-6, "{turns}: {}", turned.position);
            assert_eq!((turned.target, turned.up), (start.target, start.up));
        };
        near(0.25, Vec3::new(5.0, 3.0, 1.0));
        near(0.5, Vec3::new(1.0, 3.0, -3.0));
        near(0.75, Vec3::new(-3.0, 3.0, 1.0));
        assert_eq!(start.turned(0.0, Pivot::Target), start);
        // On the spot it looks into the same directions.
        for turns in [0.25, 0.4, 0.875] {
            let (around, spot) = (start.turned(turns, Pivot::Target), start.turned(turns, Pivot::Position));
            assert_eq!((spot.position, spot.up), (start.position, start.up));
            let sights = [&around, &spot].map(|sensor| sensor.target - sensor.position);
            assert!(sights[0].distance(sights[1]) < 1e-5, "{sights:?}");
        }
        // Where +z is up, as in Blender; also seen from above at an angle.
        let up = sensor(Vec3::new(1.0, -3.0, 2.0), Vec3::Z).turned(0.25, Pivot::Target);
        assert!(up.position.distance(Vec3::new(5.0, 1.0, 2.0)) < 1e-6 && up.up == Vec3::Z, "{}", up.position);
        let up = sensor(Vec3::new(1.0, 1.0 + 4.0, 5.0), Vec3::Z).turned(0.5, Pivot::Target);
        assert!(up.position.distance(Vec3::new(1.0, -3.0, 5.0)) < 1e-5, "{}", up.position);
    }

    #[test]
    fn the_picture_turns_where_it_looks_straight_down() {
        for up in [-Vec3::Z, Vec3::Z, Vec3::X] {
            let down = pinhole(Vec3::new(1.0, 5.0, 1.0), Vec3::ONE, up, 40.0);
            let turned = down.turned(0.25, Pivot::Target);
            assert!(turned.position.distance(down.position) < 1e-6, "{}", turned.position);
            let expected = Vec3::new(up.z, 0.0, -up.x);
            assert!(turned.up.distance(expected) < 1e-6, "{up}: {}", turned.up);
        }
        // A camera that is held at a slant, and tilted: all of it turns about y.
        let slanted = pinhole(Vec3::new(0.0, 2.0, 3.0), Vec3::ZERO, Vec3::new(0.5, 1.0, 0.0), 40.0);
        let half = slanted.turned(0.5, Pivot::Target);
        assert!(half.position.distance(Vec3::new(0.0, 2.0, -3.0)) < 1e-6, "{}", half.position);
        assert!(half.up.distance(Vec3::new(-0.5, 1.0, 0.0)) < 1e-6, "{}", half.up);
        assert_eq!(slanted.vertical(), DVec3::Y);
    }
}
