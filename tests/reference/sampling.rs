//! Random directions and points against the densities they claim, the scattering function, and the sensor.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use glam::{Affine3A, DVec3, Mat3, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::scatter::{scatter, survival};
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::{concentric_disk, cosine_hemisphere, frame, uniform_triangle};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::{Directions, Scene};
use std::f64::consts::PI;

const N: u32 = 400_000;

/// Counts `N` mapped points of the unit square.
pub fn histogram(map: impl Fn(f64, f64) -> (f64, f64)) -> Vec<u32> {
    count_in_square((0..N).map(|i| {
        let random = random4(i, 7, 3, 1);
        map(uniform(random[0]), uniform(random[1]))
    }))
}

fn normals() -> Vec<DVec3> {
    let tilted = [DVec3::new(0.3, -0.8, 0.2), DVec3::new(1e-9, 1e-9, -1.0), DVec3::new(-1.0, 2.0, -1e-3)];
    let axes = DVec3::AXES.into_iter().flat_map(|a| [a, -a]);
    axes.chain(tilted.map(DVec3::normalize)).collect()
}

#[test]
fn frames_are_orthonormal() {
    for n in normals() {
        let (t, b) = frame(n);
        for (x, expected) in [(t.length(), 1.0), (b.length(), 1.0), (t.dot(b), 0.0), (t.dot(n), 0.0), (b.dot(n), 0.0)] {
            assert!((x - expected).abs() < 1e-15, "{n}: {t} {b}");
        }
        assert!((t.cross(b) - n).length() < 1e-15, "{n}: not right-handed");
    }
}

/// Under the cosine density, the squared cosine and the azimuth are uniform and independent.
#[test]
fn cosine_hemisphere_is_cosine_distributed() {
    for n in [DVec3::Z, -DVec3::Z, DVec3::new(0.3, -0.8, 0.2).normalize()] {
        let (t, b) = frame(n);
        let counts = histogram(|u, v| {
            let w = cosine_hemisphere(n, u, v);
            assert!((w.length() - 1.0).abs() < 1e-14);
            (w.dot(n).powi(2), (w.dot(b).atan2(w.dot(t)) / (2.0 * PI)).rem_euclid(1.0))
        });
        let p = chi_square(&counts);
        assert!(p >= SIGNIFICANCE, "about {n}: p = {p:.1e}");
    }
    assert_eq!(concentric_disk(0.5, 0.5), glam::DVec2::ZERO);
}

/// For an even distribution over a triangle, `(1 - b0)^2` and `b1 / (1 - b0)` are uniform and independent.
#[test]
fn uniform_triangle_is_uniform() {
    let p = chi_square(&histogram(|u, v| {
        let [b0, b1, b2] = uniform_triangle(u, v);
        assert!(b0 >= 0.0 && b1 >= 0.0 && b2 >= -1e-15 && (b0 + b1 + b2 - 1.0).abs() < 1e-15);
        ((1.0 - b0).powi(2).min(1.0), if b0 < 1.0 { (b1 / (1.0 - b0)).min(1.0) } else { 0.0 })
    }));
    assert!(p >= SIGNIFICANCE, "p = {p:.1e}");
}

/// The chi-square test notices a wrong density.
#[test]
fn chi_square_has_power() {
    let p = chi_square(&histogram(|u, v| {
        let w = cosine_hemisphere(DVec3::Z, u, v);
        (w.z, w.y.atan2(w.x).rem_euclid(2.0 * PI) / (2.0 * PI))
    }));
    assert!(p < 1e-12, "p = {p}");
}

/// The glossy lobe creates no energy: its albedo is 1 at normal incidence and never more. The quadrature is good to 1e-4 (the edge where
/// directions leave the hemisphere).
#[test]
fn glossy_lobe_conserves_energy() {
    for m in [0.0, 1.0, 5.0, 20.0, 100.0, 1000.0, 10_000.0] {
        let surfel = flat_surfel(DVec3::splat(0.0), DVec3::splat(1.0), m);
        let at = |degrees: f64| {
            directional_albedo(&surfel, DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()))
        };
        let normal = at(0.0);
        assert!((normal - 1.0).abs() < 1e-4, "m = {m}: {normal}");
        for degrees in [15.0, 30.0, 45.0, 60.0, 75.0, 89.0] {
            let albedo = at(degrees);
            assert!(albedo <= 1.0 + 1e-4, "m = {m} at {degrees} degrees: {albedo}");
        }
        if m == 20.0 {
            // From another quadrature, over incident directions.
            for (degrees, expected) in [(30.0, 0.7757), (60.0, 0.3279), (89.0, 0.0547)] {
                assert!((at(degrees) - expected).abs() < 1e-4, "{}", at(degrees));
            }
        }
    }
}

/// `scatter` estimates the albedo without bias, for Lambert exactly and for the lobe within its error.
#[test]
fn scatter_weights_match_the_albedo() {
    let wo = DVec3::new(0.6, 0.0, 0.8);
    let diffuse = flat_surfel(DVec3::splat(0.35), DVec3::splat(0.0), 0.0);
    let mixed = flat_surfel(DVec3::splat(0.3), DVec3::splat(0.5), 10.0);
    for (surfel, resolution) in [(diffuse, 1e-15), (mixed, 2e-3)] {
        let expected = directional_albedo(&surfel, wo);
        let weights = (0..N).map(|i| {
            let random = random4(i, 0, 9, 2);
            scatter(&surfel, wo, Directions::Cosine, [uniform(random[0]), uniform(random[1]), 0.0]).weight.x
        });
        if resolution < 1e-9 {
            weights.for_each(|w| assert!((w - 0.35).abs() < 1e-15 || w == 0.0, "{w}"));
        } else {
            Estimate::new(weights).assert_within(expected - 1e-4, expected + 1e-4, resolution);
        }
    }
    assert_eq!(survival(&mixed), 0.8);
    assert_eq!(survival(&flat_surfel(DVec3::splat(1.0), DVec3::splat(0.0), 0.0)), 1.0);
    assert_eq!(survival(&flat_surfel(DVec3::splat(0.0), DVec3::splat(0.0), 0.0)), 0.0);
}

/// Directions are distributed about the shading normal: a cap of cosines above 0.9 around it, all of it above the surface, gets
/// `1 - 0.9^2` of them.
#[test]
fn scatter_is_about_the_shading_normal() {
    let normal = DVec3::new(0.6, 0.0, 0.8);
    let tilted = Surfel { shading_normal: normal, ..flat_surfel(DVec3::splat(0.5), DVec3::splat(0.0), 0.0) };
    let in_cap = (0..N).map(|i| {
        let random = random4(i, 0, 9, 4);
        let s = scatter(&tilted, DVec3::Z, Directions::Cosine, [uniform(random[0]), uniform(random[1]), 0.0]);
        if s.wi.dot(normal) > 0.9 { s.weight.x } else { 0.0 }
    });
    Estimate::new(in_cap).assert_is(0.5 * (1.0 - 0.81), 4e-3);
}

/// Light may go either way, and nothing is scattered to the far side of either normal.
#[test]
fn bsdf_is_reciprocal_and_one_sided() {
    let tilted =
        Surfel { shading_normal: DVec3::new(0.6, 0.0, 0.8), ..flat_surfel(DVec3::splat(0.3), DVec3::splat(0.5), 7.0) };
    let mut scattered = 0;
    for i in 0..1000 {
        let random = random4(i, 0, 0, 3).map(uniform);
        let wo = cosine_hemisphere(DVec3::Z, random[0], random[1]);
        let wi = cosine_hemisphere(if i % 2 == 0 { DVec3::Z } else { DVec3::X }, random[2], random[3]);
        let f = tilted.bsdf(wo, wi);
        if wi.z <= 0.0 || wi.dot(tilted.shading_normal) <= 0.0 {
            assert_eq!(f, DVec3::ZERO);
        } else {
            scattered += 1;
            assert!(f.x >= 0.3 / PI);
            if wo.dot(tilted.shading_normal) > 0.0 {
                assert!((f - tilted.bsdf(wi, wo)).length() <= 1e-14 * f.length());
            }
        }
    }
    assert!((200..900).contains(&scattered));
}

fn ball_at(scene: &mut Scene, position: Vec3, emission: Vec3) {
    let place = Affine3A::from_translation(position) * Affine3A::from_scale(Vec3::splat(0.1));
    add(scene, icosphere(2), lamp(emission), place);
}

/// +x of the camera is right, its up is up, and the field of view is the vertical one.
#[test]
fn sensor_rays() {
    let mut scene = empty(300, 200);
    scene.sensor.position = Vec3::new(1.0, 2.0, 3.0);
    scene.sensor.target = Vec3::new(1.0, 2.0, -5.0);
    scene.sensor.projection = luminaire::scene::Projection::Perspective { fov: 40.0 };
    ball_at(&mut scene, Vec3::new(1.5, 2.0, 0.0), Vec3::X);
    ball_at(&mut scene, Vec3::new(1.0, 2.5, 0.0), Vec3::Y);
    let tracer = Reference::new(&scene);
    let seen = |x: u32, y: u32| tracer.radiance(y * 300 + x, 0).0;
    // 0.5 to the side, 3 away: 0.5 / 3 / tan(20 degrees) * 100 = 45.8 pixels from the centre.
    assert_eq!(seen(150 + 46, 100), DVec3::X);
    assert_eq!(seen(150, 100 - 46), DVec3::Y);
    assert_eq!(seen(150 - 46, 100), DVec3::ZERO);
    assert_eq!(seen(150, 100 + 46), DVec3::ZERO);

    let (origin, direction) = tracer.sensor_ray(0, 5);
    assert_eq!(origin, DVec3::new(1.0, 2.0, 3.0));
    assert!((direction.length() - 1.0).abs() < 1e-15);
    let random = random4(0, 5, 0, 0).map(uniform);
    let half = 20f64.to_radians().tan();
    assert!((direction.x / -direction.z - (2.0 * random[0] / 300.0 - 1.0) * half * 1.5).abs() < 1e-14);
    assert!((direction.y / -direction.z - (1.0 - 2.0 * random[1] / 200.0) * half).abs() < 1e-14);
}

/// Normals of a squeezed, mirrored sphere against those of the ellipsoid that it is.
#[test]
fn normals_of_instances() {
    let axes = DVec3::new(2.0, 0.5, 1.0);
    let mut ball = icosphere(4);
    ball.normals = ball.positions.clone();
    let mut scene = empty(1, 1);
    let squeeze = Affine3A::from_scale(axes.as_vec3() * Vec3::new(-1.0, 1.0, 1.0));
    add(&mut scene, ball, matte(Vec3::ONE), squeeze);
    let tracer = Reference::new(&scene);
    for inside in [false, true] {
        for i in 0..2000 {
            let random = random4(i, 1, 2, 3).map(uniform);
            let direction = cosine_hemisphere(if i % 2 == 0 { DVec3::Z } else { -DVec3::Z }, random[0], random[1]);
            let direction = (direction * axes).normalize();
            let (origin, direction) = if inside { (DVec3::ZERO, direction) } else { (5.0 * direction, -direction) };
            let hit = tracer.closest_hit(origin, direction, f64::INFINITY, 0).expect("a hit");
            let surfel = tracer.surfel(&hit, -direction);
            let gradient = (surfel.position / (axes * axes)).normalize() * if inside { -1.0 } else { 1.0 };
            // Facets of a unit sphere of 5120 are tilted by up to 0.04; the squeeze makes that up to four times more.
            assert!(surfel.geometric_normal.dot(gradient) > 0.16f64.cos());
            // The interpolated normal is exact at the corners, second order between them.
            assert!(surfel.shading_normal.dot(gradient) > 0.01f64.cos(), "{}", surfel.shading_normal.dot(gradient));
            assert!(surfel.geometric_normal.dot(-direction) > 0.0 && surfel.shading_normal.dot(-direction) > 0.0);
            assert!((surfel.shading_normal.length() - 1.0).abs() < 1e-14);
        }
    }
}

/// Without usable vertex normals a triangle is flat; a shading normal that turns away from the viewer gives way.
#[test]
fn shading_normal_falls_back() {
    let mut triangle = mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    let wo = DVec3::new(0.8, 0.0, 0.6);
    let normal = |triangle: &luminaire::scene::Mesh| {
        let mut scene = empty(1, 1);
        add(&mut scene, triangle.clone(), matte(Vec3::ONE), Affine3A::from_mat3(Mat3::IDENTITY));
        let tracer = Reference::new(&scene);
        let hit = tracer.closest_hit(DVec3::new(0.25, 0.25, 0.0) + wo, -wo, f64::INFINITY, 0).expect("a hit");
        tracer.surfel(&hit, wo).shading_normal
    };
    assert_eq!(normal(&triangle), DVec3::Z);
    let slanted = Vec3::new(0.5, 0.0, 0.75).normalize();
    triangle.normals = vec![slanted; 3];
    assert!((normal(&triangle) - slanted.as_dvec3().normalize()).length() < 1e-15);
    triangle.normals = vec![-slanted; 3];
    assert!((normal(&triangle) - slanted.as_dvec3().normalize()).length() < 1e-15, "turned to the viewer's side");
    triangle.normals[1] = Vec3::ZERO;
    assert_eq!(normal(&triangle), DVec3::Z, "one corner without a normal");
    triangle.normals = vec![Vec3::new(-0.9, 0.0, 0.1).normalize(); 3];
    assert_eq!(normal(&triangle), DVec3::Z, "faces away from wo");
}

/// Numbers of neighbouring pixels, samples, blocks and seeds are independent: pairs fall evenly into 16 x 16 cells.
#[test]
fn neighbours_are_independent() {
    let mut smallest = 1.0f64;
    for step in [[1, 0, 0, 0], [512, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] {
        let mut counts = [const { [0u32; 256] }; 4];
        for i in 0..100_000u32 {
            let [pixel, sample, block, seed] = [i % 512, i / 512, 1, 0];
            let here = random4(pixel, sample, block, seed);
            let next = random4(pixel + step[0], sample + step[1], block + step[2], seed + step[3]);
            for k in 0..4 {
                counts[k][(here[k] >> 28 << 4 | next[k] >> 28) as usize] += 1;
            }
        }
        smallest = counts.iter().fold(smallest, |p, c| p.min(chi_square(c)));
    }
    let p = sidak(smallest, 20);
    assert!(p >= SIGNIFICANCE, "p = {p:e}");
}
