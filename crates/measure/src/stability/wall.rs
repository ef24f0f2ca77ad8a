//! A floor that is lit by way of a wall: what the sweeps over caustics look at.

use super::light::looking_from;
use crate::chart::Axis;
use glam::{Affine3A, Vec3};
use luminaire::scene::build::{add, matte, quad};
use luminaire::scene::{Material, Scene};

/// The floor's.
pub(super) const ALBEDO: f32 = 0.5;
/// The wall's.
pub(super) const REFLECTANCE: f32 = 0.9;
/// Where the light is, one unit above the floor.
pub(super) const LIGHT: Vec3 = Vec3::new(0.25, 1.0, 0.0);
/// Its image behind the wall.
pub(super) const IMAGE: Vec3 = Vec3::new(1.75, 1.0, 0.0);

/// The wall: a corner and two edges.
pub(super) const WALL: [Vec3; 3] = [Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.0, 0.0, 2.0)];

/// The axis of the noise.
pub(super) fn variance(of: &str) -> Axis {
    Axis::log(format!("variance of a sample / (light by way of the {of})²"))
}

/// A floor, on which the camera looks, and a wall at x = 1.
pub(super) fn room(wall: Material) -> Scene {
    let mut scene = looking_from(Vec3::new(-0.5, 1.0, 0.8));
    let floor = quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0);
    add(&mut scene, floor, matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    let [corner, up, along] = WALL;
    add(&mut scene, quad(corner, up, along), wall, Affine3A::IDENTITY);
    scene
}
