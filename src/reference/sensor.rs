//! The pinhole camera.

use super::Reference;
use crate::sampling::{SENSOR_BLOCK, random4, uniform};
use glam::DVec3;

impl Reference {
    /// Origin and unit direction of the ray for a sample of a pixel (`y * width + x`): evenly over the pixel's square.
    pub fn sensor_ray(&self, pixel: u32, sample: u32) -> (DVec3, DVec3) {
        let random = random4(pixel, sample, SENSOR_BLOCK, self.scene.settings.seed);
        let (width, height) = (self.scene.film.width, self.scene.film.height);
        let x = (f64::from(pixel % width) + uniform(random[0])) / f64::from(width);
        let y = (f64::from(pixel / width) + uniform(random[1])) / f64::from(height);
        let (right, up) = (2.0 * x - 1.0, 1.0 - 2.0 * y);

        let sensor = &self.scene.sensor;
        let position = sensor.position.as_dvec3();
        let forward = (sensor.target.as_dvec3() - position).normalize();
        let right_axis = forward.cross(sensor.up.as_dvec3()).normalize();
        let up_axis = right_axis.cross(forward);
        let crate::scene::Projection::Perspective { fov } = sensor.projection else { return (position, forward) };
        let half = (0.5 * f64::from(fov)).to_radians().tan();
        let aspect = f64::from(width) / f64::from(height);
        (position, (forward + right_axis * (right * half * aspect) + up_axis * (up * half)).normalize())
    }
}
