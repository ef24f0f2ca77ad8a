//! Light from infinitely far away: a latitude-longitude image around the scene.
//!
//! The azimuth `phi` runs from -z towards +x, the polar angle `theta` from +y down:
//! `direction = (sin theta sin phi, cos theta, -sin theta cos phi)`.

use super::prepared_scene::Reference;
use crate::scene::{Environment, EnvironmentDistribution, EnvironmentImage};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Where a unit direction falls in the image: how far from the left and from the top, as shares of width and height.
fn image_position(environment: &Environment, direction: DVec3) -> [f64; 2] {
    let phi = direction.x.atan2(-direction.z);
    let theta = direction.x.hypot(direction.z).atan2(direction.y);
    [(phi / TAU + 0.5 + turn(environment)).rem_euclid(1.0), theta / PI]
}

/// By how much of a full turn the image is turned.
fn turn(environment: &Environment) -> f64 {
    f64::from(environment.rotation) / 360.0
}

/// Bilinear between the centres of the texels: the columns go round, the rows end at the poles.
fn bilinear(image: &EnvironmentImage, [x, y]: [f64; 2]) -> DVec3 {
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    let (x, y) = (x * width - 0.5, y * height - 0.5);
    let texel = |column: f64, row: f64| {
        let (column, row) = (column.rem_euclid(width) as usize, row.clamp(0.0, height - 1.0) as usize);
        image.texels[row * image.width as usize + column].as_dvec3()
    };
    let (column, row) = (x.floor(), y.floor());
    let upper = texel(column, row).lerp(texel(column + 1.0, row), x - column);
    let lower = texel(column, row + 1.0).lerp(texel(column + 1.0, row + 1.0), x - column);
    upper.lerp(lower, y - row)
}

/// A direction in a texel, evenly over its solid angle: the azimuth goes evenly with `u`, the cosine of the polar angle with `v`.
fn direction_in_texel(
    environment: &Environment,
    [width, height]: [u32; 2],
    [column, row]: [u32; 2],
    [u, v]: [f64; 2],
) -> DVec3 {
    let phi = TAU * ((f64::from(column) + u) / f64::from(width) - 0.5 - turn(environment));
    let edge = |row: u32| (PI * f64::from(row) / f64::from(height)).cos();
    let cos = edge(row) + v * (edge(row + 1) - edge(row));
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    DVec3::new(sin * phi.sin(), cos, -sin * phi.cos())
}

impl Reference {
    fn environment(&self) -> Option<(&Environment, &EnvironmentDistribution)> {
        self.scene.environment.as_ref().zip(self.luminaires.environment.as_ref())
    }

    /// Radiance that a ray in this unit direction finds where it escapes to; zero without an environment.
    pub fn environment_radiance(&self, direction: DVec3) -> DVec3 {
        let Some(environment) = &self.scene.environment else { return DVec3::ZERO };
        let texel = environment
            .image
            .as_ref()
            .map_or(DVec3::ONE, |image| bilinear(image, image_position(environment, direction)));
        environment.radiance.as_dvec3() * texel
    }

    /// A unit direction to the environment, chosen by two numbers, and its density per steradian, without the probability of choosing the
    /// environment among the luminaires. None if no light is sampled there.
    pub fn sample_environment(&self, random: [u32; 2]) -> Option<(DVec3, f64)> {
        let (environment, distribution) = self.environment()?;
        let (texel, place) = distribution.choose(random);
        let direction = direction_in_texel(environment, [distribution.width, distribution.height], texel, place);
        // Not looked up: on the edge of a texel the direction may round into the next one.
        Some((direction, distribution.density(texel)))
    }

    /// The density with which [`Reference::sample_environment`] chooses a unit direction.
    pub fn environment_density(&self, direction: DVec3) -> f64 {
        let Some((environment, distribution)) = self.environment() else { return 0.0 };
        let [x, y] = image_position(environment, direction);
        // Rounding may give the edge itself.
        let cell = |share: f64, n: u32| ((share * f64::from(n)) as u32).min(n - 1);
        let (column, row) = (cell(x, distribution.width), cell(y, distribution.height));
        distribution.density([column, row])
    }
}
