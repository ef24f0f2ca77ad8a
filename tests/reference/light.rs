//! Direct light against closed forms.

use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Mat3, Vec3};
use luminaire::film::Rays;
use luminaire::reference::Reference;
use luminaire::reference::surfel::Surfel;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Estimator, Integrator, Luminaire, Mesh, Scene};
use std::f64::consts::PI;

const ALBEDO: f64 = 0.5;

/// A floor at y = 0 that reflects half of the light.
fn floor() -> Scene {
    let mut scene = empty(1, 1);
    scene.integrator = Integrator::Path(Estimator::preset("cosine").expect("a preset"));
    let floor = quad(Vec3::new(-8.0, 0.0, -8.0), Vec3::X * 16.0, Vec3::Z * 16.0);
    add(&mut scene, floor, matte(Vec3::splat(ALBEDO as f32)), Affine3A::IDENTITY);
    scene
}

/// The floor's surfel under `(x, z)`, seen from above.
fn surfel_at(tracer: &Reference, x: f64, z: f64) -> Surfel {
    let hit = tracer.closest_hit(DVec3::new(x, 1e-3, z), -DVec3::Y, f64::INFINITY, 0).expect("the floor");
    tracer.surfel(&hit, DVec3::Y)
}

/// Irradiance at `(x, z)` by the first `samples` samples of direct light, from the reflected radiance.
fn irradiance(tracer: &Reference, x: f64, z: f64, samples: u32) -> Estimate {
    let surfel = surfel_at(tracer, x, z);
    Estimate::new((0..samples).map(|i| {
        tracer.direct_light(&surfel, DVec3::Y, DVec3::ONE, random4(0, i, 1, 42), 0, &mut Rays::default()).x * PI
            / ALBEDO
    }))
}

/// Lambert's formula: irradiance at `p` with normal `n` from a polygon of radiance 1, all of it above the horizon.
fn lambert_polygon(p: DVec3, n: DVec3, corners: &[DVec3]) -> f64 {
    let r: Vec<DVec3> = corners.iter().map(|c| (c - p).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (r[i], r[(i + 1) % r.len()]);
        a.angle_between(b) * a.cross(b).normalize().dot(n)
    };
    (0.5 * (0..r.len()).map(edge).sum::<f64>()).abs()
}

fn point(position: Vec3, intensity: f32) -> Luminaire {
    Luminaire::Point { position, intensity: Vec3::splat(intensity) }
}

fn lamp_triangle() -> Mesh {
    mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Z], &[[0, 1, 2]])
}

/// Where the lamp of the tests below hangs: sheared, stretched and mirrored.
fn lamp_place() -> Affine3A {
    let shear = Mat3::from_cols(Vec3::new(1.5, 0.25, 0.0), Vec3::Y, Vec3::new(0.5, 0.0, -2.0));
    Affine3A::from_translation(Vec3::new(-0.5, 1.5, 0.75)) * Affine3A::from_mat3(shear)
}

fn lamp_corners() -> Vec<DVec3> {
    lamp_triangle().positions.iter().map(|p| lamp_place().transform_point3(*p).as_dvec3()).collect()
}

#[test]
fn point_luminaire_obeys_the_inverse_square_law() {
    for height in [0.125f32, 1.0, 3.0, 100.0, 1e4] {
        for (x, z) in [(0.0, 0.0), (1.0, 0.5), (-7.0, 3.0)] {
            let mut scene = floor();
            scene.luminaires.push(point(Vec3::new(0.0, height, 0.0), 3.0));
            let h = f64::from(height);
            let expected = 3.0 * h / (x * x + z * z + h * h).powf(1.5);
            let found = irradiance(&Reference::new(&scene), x, z, 4);
            assert!((found.mean / expected - 1.0).abs() < 1e-12, "{} instead of {expected}", found.mean);
        }
    }
}

#[test]
fn infinite_luminaire_obeys_the_cosine_law() {
    for degrees in [0.0f32, 30.0, 60.0, 89.0, 91.0, 180.0] {
        let direction = Affine3A::from_rotation_z(degrees.to_radians()).transform_vector3(-Vec3::Y);
        let mut scene = floor();
        scene.luminaires.push(Luminaire::Infinite { direction, irradiance: Vec3::splat(2.0) });
        let expected = 2.0 * f64::from(-direction.y).max(0.0);
        let found = irradiance(&Reference::new(&scene), 3.0, -2.0, 4).mean;
        assert!((found - expected).abs() <= 1e-12 * expected, "{degrees} degrees: {found} instead of {expected}");
    }
}

/// A triangle of any shape, on both of its sides, against Lambert's formula.
#[test]
fn area_luminaire_matches_lamberts_formula() {
    let mut scene = floor();
    add(&mut scene, lamp_triangle(), lamp(Vec3::splat(4.0)), lamp_place());
    let mut turned = scene.clone();
    std::sync::Arc::make_mut(&mut turned.meshes[1]).triangles[0].vertices = [0, 2, 1];
    for scene in [scene, turned] {
        let tracer = Reference::new(&scene);
        for (x, z) in [(0.0, 0.0), (2.0, -1.0), (-5.0, 4.0)] {
            let expected = 4.0 * lambert_polygon(DVec3::new(x, 0.0, z), DVec3::Y, &lamp_corners());
            irradiance(&tracer, x, z, 100_000).assert_is(expected, 3e-3);
        }
    }
}

/// One luminaire is chosen for each sample, and its probability divided out: the mean is the sum over all.
#[test]
fn choosing_a_luminaire_is_unbiased() {
    let mut scene = floor();
    scene.luminaires.push(point(Vec3::new(1.0, 1.0, 0.0), 3.0));
    scene.luminaires.push(point(Vec3::new(1.0, -2.0, 0.0), 50.0)); // Below the floor.
    let slanted = Vec3::new(0.6, -0.8, 0.0);
    scene.luminaires.push(Luminaire::Infinite { direction: slanted, irradiance: Vec3::splat(0.01) });
    let mesh = add(&mut scene, lamp_triangle(), lamp(Vec3::splat(4.0)), lamp_place());
    let second = Affine3A::from_translation(Vec3::new(-6.0, 1.0, 2.0));
    add_instance(&mut scene, mesh, lamp(Vec3::splat(9.0)), second);
    let second: Vec<DVec3> = lamp_triangle().positions.iter().map(|p| second.transform_point3(*p).as_dvec3()).collect();

    let (x, z) = (-2.0f64, 1.0f64);
    let p = DVec3::new(x, 0.0, z);
    let expected = 3.0 / (9.0 + z * z + 1.0).powf(1.5)
        + 0.01 * 0.8
        + 4.0 * lambert_polygon(p, DVec3::Y, &lamp_corners())
        + 9.0 * lambert_polygon(p, DVec3::Y, &second);
    irradiance(&Reference::new(&scene), x, z, 400_000).assert_is(expected, 6e-3);
}

/// Only what is between a surface and a luminaire casts a shadow.
#[test]
fn blockers_between_shadow_and_blockers_behind_do_not() {
    let slab = |y: f32| quad(Vec3::new(-1.0, y, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0);
    let mut lit_by_point = floor();
    lit_by_point.luminaires.push(point(Vec3::Y * 2.0, 1.0));
    let mut lit_by_area = floor();
    let panel = quad(Vec3::new(-0.25, 2.0, -0.25), Vec3::X * 0.5, Vec3::Z * 0.5);
    add(&mut lit_by_area, panel, lamp(Vec3::ONE), Affine3A::IDENTITY);
    for scene in [lit_by_point, lit_by_area] {
        let open = irradiance(&Reference::new(&scene), 0.25, 0.5, 1000).mean;
        assert!(open > 0.0);
        // Behind the luminaire, as near as f32 can say; in front of it, and just above the floor.
        for (y, expected) in
            [(2.0f32.next_up(), open), (3.0, open), (1e5, open), (2.0f32.next_down(), 0.0), (1.0, 0.0), (1e-2, 0.0)]
        {
            let mut scene = scene.clone();
            add(&mut scene, slab(y), matte(Vec3::ZERO), Affine3A::IDENTITY);
            let tracer = Reference::new(&scene);
            let surfel = {
                let hit =
                    tracer.closest_hit(DVec3::new(0.25, 1e-3, 0.5), -DVec3::Y, f64::INFINITY, 0).expect("the floor");
                tracer.surfel(&hit, DVec3::Y)
            };
            let found = Estimate::new((0..1000).map(|i| {
                tracer.direct_light(&surfel, DVec3::Y, DVec3::ONE, random4(0, i, 1, 42), 0, &mut Rays::default()).x * PI
                    / ALBEDO
            }));
            assert!((found.mean - expected).abs() <= 1e-12, "slab at {y}: {} instead of {expected}", found.mean);
        }
    }
    let mut lit_from_infinity = floor();
    lit_from_infinity.luminaires.push(Luminaire::Infinite { direction: -Vec3::Y, irradiance: Vec3::ONE });
    assert!((irradiance(&Reference::new(&lit_from_infinity), 0.25, 0.5, 1).mean - 1.0).abs() < 1e-12);
    add(&mut lit_from_infinity, slab(1e7), matte(Vec3::ZERO), Affine3A::IDENTITY);
    assert_eq!(irradiance(&Reference::new(&lit_from_infinity), 0.25, 0.5, 1).mean, 0.0);
}

/// Both ends of a shadow ray are rounded: a millimetre is not too short at a distance of a thousand kilometres.
#[test]
fn short_shadow_rays_far_from_the_origin() {
    let place = Affine3A::from_translation(Vec3::new(1e6, -1e6, 1e6)) * Affine3A::from_rotation_x(0.7);
    let mut scene = empty(1, 1);
    let panel = |height: f32| quad(Vec3::new(-1.0, height, -1.0), Vec3::X * 2.0, Vec3::Z * 2.0);
    add(&mut scene, panel(0.0), matte(Vec3::splat(0.5)), place);
    add(&mut scene, panel(1e-3), lamp(Vec3::ONE), place);
    let tracer = Reference::new(&scene);
    let at = |x: f32, y: f32, z: f32| {
        place.matrix3.as_dmat3() * Vec3::new(x, y, z).as_dvec3() + place.translation.as_dvec3()
    };
    for i in 0..1000 {
        let random = random4(0, i, 1, 5);
        let [x, z] = [random[0], random[1]].map(|r| uniform(r) as f32 * 1.8 - 0.9);
        let (from, down) = (at(x, 5e-4, z), at(x, 0.0, z) - at(x, 5e-4, z));
        let hit = tracer.closest_hit(from, down, f64::INFINITY, 0).expect("the floor");
        assert_eq!(hit.object, 0);
        let surfel = tracer.surfel(&hit, -down.normalize());
        let light =
            tracer.direct_light(&surfel, -down.normalize(), DVec3::ONE, random4(0, i, 3, 5), 0, &mut Rays::default());
        assert!(light.x > 0.0, "the lamp or the floor shadows itself at ({x}, {z})");
    }
}

/// A shadow ray is counted where light could arrive, and only there.
#[test]
fn shadow_rays_are_cast_for_light_only() {
    let mut scene = floor();
    scene.luminaires.push(point(Vec3::Y, 1.0));
    let count = |scene: &Scene| {
        let tracer = Reference::new(scene);
        let mut rays = Rays::default();
        tracer.direct_light(&surfel_at(&tracer, 0.0, 0.0), DVec3::Y, DVec3::ONE, [0; 4], 0, &mut rays);
        rays.all
    };
    assert_eq!(count(&scene), 1);
    scene.luminaires[0] = point(-Vec3::Y, 1.0);
    assert_eq!(count(&scene), 0);
    scene.luminaires.clear();
    assert_eq!(count(&scene), 0);
}

/// A closed box whose vertex normals are tilted stays dark inside when it is lit from outside: directions must be on
/// the same side of both normals.
#[test]
fn light_does_not_leak_through_closed_walls() {
    let mut tilted = cube();
    tilted.normals = tilted.positions.iter().map(|p| (Vec3::new(1.5, 1.0, 0.5) * p.normalize()).normalize()).collect();
    let mut scene = empty(16, 16);
    scene.sensor.projection = luminaire::scene::Projection::Perspective { fov: 120.0 };
    add(&mut scene, tilted, matte(Vec3::splat(0.9)), Affine3A::from_rotation_y(0.3));
    for direction in [Vec3::X, -Vec3::X, Vec3::Y, Vec3::Z] {
        scene.luminaires.push(point(direction * 3.0, 100.0));
        scene.luminaires.push(Luminaire::Infinite { direction, irradiance: Vec3::splat(100.0) });
    }
    let image = render(&mut Reference::new(&scene), 16, 16, 64, 4);
    assert!(image.mean.iter().all(|p| *p == [0.0; 3]));
    assert!(image.rays > 16 * 16 * 64 * 5, "paths go on inside: {} rays", image.rays);

    scene.luminaires.push(point(Vec3::ZERO, 1000.0));
    let image = render(&mut Reference::new(&scene), 16, 16, 64, 4);
    assert!(image.mean.iter().all(|p| p[0] > 0.0), "and are lit from inside");
}

/// A one-sided lamp lights and is seen from its outward side only: the side from which its corners are counter-clockwise, also where an
/// instance mirrors it; and the vertex normals overrule the winding.
#[test]
fn one_sided_lamps() {
    use luminaire::scene::Material;
    // Counter-clockwise as seen from +y.
    let panel = quad(Vec3::new(-0.5, 0.0, 0.5), Vec3::X, -Vec3::Z);
    let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let flip = Affine3A::from_scale(Vec3::new(1.0, -1.0, 1.0));
    for (place, normal, above) in [
        (Affine3A::IDENTITY, None, true),
        (mirror, None, true),
        (flip, None, false),
        (Affine3A::IDENTITY, Some(-Vec3::Y), false),
        (mirror, Some(-Vec3::Y), false),
    ] {
        // Floor and ceiling at the same distance; the sensor sees one of them, or the lamp.
        for (eye, target, seen) in [
            (Vec3::new(0.0, -0.5, 0.125), Vec3::new(0.0, -1.0, 0.0), !above),
            (Vec3::new(0.0, 0.5, 0.125), Vec3::new(0.0, 1.0, 0.0), above),
            (Vec3::new(0.0, -0.5, 0.125), Vec3::ZERO, !above),
            (Vec3::new(0.0, 0.5, 0.125), Vec3::ZERO, above),
        ] {
            let mut scene = empty(4, 4);
            scene.sensor = pinhole(eye, target, Vec3::Z, 1.0);
            let mut lamp_mesh = panel.clone();
            lamp_mesh.normals = normal.map_or(vec![], |n| vec![n; 4]);
            add(&mut scene, lamp_mesh, Material { one_sided: true, ..lamp(Vec3::ONE) }, place);
            for y in [-1.0, 1.0] {
                let plane = quad(Vec3::new(-9.0, y, -9.0), Vec3::X * 18.0, Vec3::Z * 18.0);
                add(&mut scene, plane, matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
            }
            for name in ["default", "cosine", "no-light-sampling"] {
                let estimator = Estimator { max_bounces: Some(0), ..Estimator::preset(name).expect("a preset") };
                scene.integrator = Integrator::Path(estimator);
                let tracer = Reference::new(&scene);
                let lit = (0..16)
                    .flat_map(|p| (0..64).map(move |s| (p, s)))
                    .any(|(p, s)| tracer.radiance(p, s).0 != DVec3::ZERO);
                assert_eq!(lit, seen, "{name}, {place:?}, {normal:?}, from {eye} to {target}");
            }
        }
    }
}
