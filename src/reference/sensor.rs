//! The camera (slide "Sensor Modelling"): pixel filter, perspective or parallel projection, pinhole or thin lens, shift.

use super::prepared_scene::Reference;
use super::warp::{concentric_disk, uniform_triangle};
use crate::sampling::{SENSOR_BLOCK, uniform};
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

impl Reference {
    /// Origin and unit direction of the ray for a sample of a pixel (`y * width + x`).
    ///
    /// Through a lens, all rays of a point of the film meet in one point of the plane of focus. Parallel rays have such a lens each
    /// (a telecentric lens). Without a lens they start at the eye point, or in the plane through it.
    pub fn sensor_ray(&self, pixel: u32, sample: u32) -> (DVec3, DVec3) {
        let settings = &self.scene.settings;
        let random = settings.sampler.numbers(pixel, sample, SENSOR_BLOCK, settings.seed);
        let film = &self.scene.film;
        let (width, height) = (f64::from(film.width), f64::from(film.height));
        let x = (f64::from(pixel % film.width) + self.filter_offset(random[0])) / width;
        let y = (f64::from(pixel / film.width) + self.filter_offset(random[1])) / height;
        let sensor = &self.scene.sensor;
        let shift = sensor.shift.as_dvec2();
        let (x, y) = (2.0 * (x + shift.x) - 1.0, 1.0 - 2.0 * (y - shift.y));

        let position = sensor.position.as_dvec3();
        let forward = (sensor.target.as_dvec3() - position).normalize();
        let right = forward.cross(sensor.up.as_dvec3()).normalize();
        let up = right.cross(forward);
        let (origin, line) = match sensor.projection {
            Projection::Perspective { fov } => {
                let half = (0.5 * f64::from(fov)).to_radians().tan();
                (position, forward + right * (x * half * width / height) + up * (y * half))
            }
            Projection::Orthographic { height: extent } => {
                let half = 0.5 * f64::from(extent);
                (position + right * (x * half * width / height) + up * (y * half), forward)
            }
        };
        let Some(lens) = sensor.lens else { return (origin, line.normalize()) };
        let point = lens_point(&lens, random[2], random[3]);
        let offset = right * point.x + up * point.y;
        (origin + offset, (line * f64::from(lens.focus_distance) - offset).normalize())
    }

    /// From a pixel's left (upper) edge to a film point, in pixels.
    fn filter_offset(&self, random: u32) -> f64 {
        if self.filter.is_empty() {
            return uniform(random);
        }
        let interval = (random >> 24) as usize;
        let [low, high] = [self.filter[interval], self.filter[interval + 1]].map(f64::from);
        0.5 + low + (high - low) * uniform(random << 8)
    }
}

/// A point on the aperture, evenly: to the right and up, in the scene's unit.
///
/// The first corner of an aperture with blades is to the right, turned counter-clockwise (as the camera looks) by the rotation.
pub fn lens_point(lens: &Lens, u: u32, v: u32) -> DVec2 {
    let point = if lens.blades == 0 {
        concentric_disk(uniform(u), uniform(v))
    } else {
        // The sector is the integer part of u times the blades, and what is left of u is uniform again.
        let product = u64::from(u) * u64::from(lens.blades);
        let sector = (product >> 32) as u32;
        let corner = |k: u32| {
            let turns = f64::from(k) / f64::from(lens.blades);
            DVec2::from_angle(TAU * turns + f64::from(lens.rotation).to_radians())
        };
        let [a, b, _] = uniform_triangle(uniform(product as u32), uniform(v));
        a * corner(sector) + b * corner(sector + 1)
    };
    f64::from(lens.radius) * point
}
