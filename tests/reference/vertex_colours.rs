//! Colours of vertices.

use crate::common::scenes::*;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::{Integrator, Material};

#[test]
fn they_multiply_the_albedos_and_vary_linearly() {
    let mut scene = empty(1, 1);
    let mut triangle = mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    triangle.colours = vec![Vec3::X, Vec3::Y, Vec3::new(0.5, 0.25, 1.0)];
    let material = Material {
        ambient: Vec3::new(0.5, 0.25, 1.0),
        glossy: Vec3::splat(0.1),
        exponent: 5.0,
        ..matte(Vec3::new(0.8, 0.4, 0.2))
    };
    add(&mut scene, triangle, material, Affine3A::IDENTITY);
    scene.integrator = Integrator::Simple { ambient: Vec3::ONE };
    let tracer = Reference::new(&scene);
    let hit = tracer.closest_hit(DVec3::new(0.25, 0.5, 1.0), -DVec3::Z, f64::INFINITY, 0).expect("the triangle");
    let surfel = tracer.surfel(&hit, DVec3::Z);
    let colour = 0.25 * DVec3::X + 0.25 * DVec3::Y + 0.5 * DVec3::new(0.5, 0.25, 1.0);
    let of = |albedo: DVec3| albedo * colour;
    let near = |a: DVec3, b: DVec3| (a - b).abs().max_element() < 1e-7;
    assert!(near(surfel.lambert, of(DVec3::new(0.8, 0.4, 0.2))), "{surfel:?}");
    assert!(near(surfel.ambient, of(DVec3::new(0.5, 0.25, 1.0))), "{surfel:?}");
    assert!(near(surfel.glossy, DVec3::splat(0.1)), "{surfel:?}");
}
