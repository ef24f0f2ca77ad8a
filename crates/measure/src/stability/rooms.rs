//! The closed rooms of the sweeps.

use glam::{Affine3A, Vec3};
use luminaire::scene::build::*;
use luminaire::scene::{Estimator, Extinction, Integrator, LightSampling, Material, Scene};

/// A closed shell of 320 triangles that emits 1 everywhere and reflects `albedo`: the radiance is `1 / (1 - albedo)` everywhere. Light is
/// found by chance, so that a path without roulette has no variance.
pub(super) fn furnace((width, height): (u32, u32), albedo: f32, changes: Estimator) -> Scene {
    let mut scene = empty(width, height);
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    let glowing = Material { emission: Vec3::ONE, ..matte(Vec3::splat(albedo)) };
    add(&mut scene, icosphere(2), glowing, Affine3A::IDENTITY);
    scene.integrator = Integrator::Path(Estimator { light_sampling: LightSampling::None, ..changes });
    scene
}

/// The radiance in a [`furnace`], of the albedo that the tracers really see.
pub(super) fn furnace_radiance(albedo: f32) -> f64 {
    1.0 / (1.0 - f64::from(albedo))
}

/// No roulette: something else has to end paths.
pub(super) fn without_roulette() -> Estimator {
    Estimator { extinction: Extinction::Off, ..Estimator::default() }
}

/// A closed room from -2 to 2 with white, red and green walls, a block, and a lamp under the ceiling, which is only found by direct light.
pub(super) fn room((width, height): (u32, u32), changes: Estimator) -> Scene {
    let mut scene = empty(width, height);
    scene.sensor = pinhole(Vec3::new(0.0, 0.0, 1.875), Vec3::new(0.0, -0.25, -1.0), Vec3::Y, 75.0);
    let (x, y, z, low) = (Vec3::X * 4.0, Vec3::Y * 4.0, Vec3::Z * 4.0, Vec3::splat(-2.0));
    let [white, red, green] = [Vec3::splat(0.75), Vec3::new(0.65, 0.1, 0.08), Vec3::new(0.15, 0.5, 0.12)];
    for (corner, a, b, albedo) in [
        (low, x, z, white),
        (low + y, x, z, white),
        (low, x, y, white),
        (low + z, x, y, white),
        (low, y, z, red),
        (low + x, y, z, green),
    ] {
        add(&mut scene, quad(corner, a, b), matte(albedo), Affine3A::IDENTITY);
    }
    let panel = quad(Vec3::new(-0.5, 1.9375, -0.5), Vec3::X, Vec3::Z);
    add(&mut scene, panel, lamp(Vec3::new(14.0, 12.0, 9.0)), Affine3A::IDENTITY);
    let block = Affine3A::from_translation(Vec3::new(-0.5, -1.0, -0.75))
        * Affine3A::from_rotation_y(0.4)
        * Affine3A::from_scale(Vec3::new(0.5, 1.0, 0.4));
    add(&mut scene, cube(), matte(Vec3::splat(0.6)), block);
    scene.integrator = Integrator::Path(Estimator { light_sampling: LightSampling::Direct, ..changes });
    scene
}
