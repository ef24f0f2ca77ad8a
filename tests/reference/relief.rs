//! What bends normals: the guard, gradients of heights, tangents.

use crate::common::relief::*;
use crate::common::scenes::*;
use crate::transport::means;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use luminaire::reference::fresnel::reflect;
use luminaire::reference::normal_map::{LEAST_REFLECTED, guarded_normal, surface_gradient};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::*;

/// Whatever a map says and wherever one looks from: a unit vector on the side of `wo`, about which the mirror direction is above the surface; what needs no guard
/// stays as it is; and there is no jump from there on.
#[test]
fn guarded_normals_mirror_above_the_surface() {
    let [mut kept, mut changed] = [0, 0];
    for i in 0..20_000 {
        let [a, b, c, d] = random4(i, 0, 0, 5).map(uniform);
        let geometric = DVec3::Z;
        let grazing = if i % 2 == 0 { 1.0 } else { 1e-3 };
        let wo = DVec3::new((6.3 * a).cos(), (6.3 * a).sin(), 0.0) * (1.0 - (grazing * b).powi(2)).sqrt()
            + DVec3::Z * (grazing * b).max(1e-6);
        let wo = wo.normalize();
        let n = DVec3::new((6.3 * c).cos() * d, (6.3 * c).sin() * d, 2.0 * uniform(random4(i, 1, 0, 5)[0]) - 0.5)
            .normalize();
        let guarded = guarded_normal(geometric, wo, n);
        assert!((guarded.length() - 1.0).abs() < 1e-9, "{wo} {n}: {guarded}");
        assert!(guarded.dot(wo) > 0.0, "{wo} {n}: {guarded}");
        let height = reflect(wo, guarded).z;
        let least = (0.9 * wo.z).min(LEAST_REFLECTED);
        assert!(height >= least - 1e-9, "{wo} {n}: {guarded}, {height}");
        if n.dot(wo) > 0.0 && reflect(wo, n).z >= least {
            assert_eq!(guarded, n);
            kept += 1;
        } else {
            changed += 1;
        }
        // A little more of the tilt: a little more of a change.
        let near = (n + 1e-7 * DVec3::new(b - 0.5, a - 0.5, d - 0.5)).normalize();
        let apart = (guarded_normal(geometric, wo, near) - guarded).length();
        assert!(apart < 1e-3, "{wo} {n}: jumps by {apart}");
    }
    assert!(kept > 1000 && changed > 1000, "{kept} {changed}");
}

/// In any triangle, the gradient of what is linear in space is its part within the plane; a triangle without an area has none.
#[test]
fn gradients_lie_in_the_triangle() {
    for i in 0..1000 {
        let v = |k| DVec3::from_array([0, 1, 2].map(|c| uniform(random4(i, k, 0, 6)[c as usize]) - 0.5));
        let (corners, slope) = ([v(0), v(1), v(2)], v(3));
        let [a, b, c] = corners;
        let gradient = surface_gradient(corners, [slope.dot(b - a), slope.dot(c - a)]);
        let n = (b - a).cross(c - a).normalize();
        assert!((gradient - (slope - n * n.dot(slope))).length() < 1e-6, "{corners:?}");
    }
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 3.0];
    assert_eq!(surface_gradient(line, [1.0, 2.0]), DVec3::ZERO);
}

/// Tangents lie where u grows, with the sign by which v does; triangles whose coordinates have no area have none, and that is said; what needs none gets none.
#[test]
fn tangents_are_made_for_what_needs_them() {
    let mut scene = empty(2, 2);
    let mut mesh = quad(Vec3::ZERO, Vec3::X * 2.0, Vec3::Y);
    mesh.uvs = vec![Vec2::ZERO, Vec2::Y, Vec2::new(-3.0, 1.0), Vec2::X * -3.0];
    add(&mut scene, mesh.clone(), with_normals(0, 1.0, matte(Vec3::ONE)), Affine3A::IDENTITY);
    // A triangle without an area in the picture, and one whose corners are all at one place.
    let mut flat = mesh.clone();
    flat.uvs[3] = flat.uvs[0];
    flat.uvs[2] = flat.uvs[0];
    add(&mut scene, flat, with_normals(0, 1.0, matte(Vec3::ONE)), Affine3A::IDENTITY);
    add(&mut scene, mesh.clone(), matte(Vec3::ONE), Affine3A::IDENTITY);
    let brushed = Physical { anisotropy: 0.5, ..copper(0.3) };
    add(&mut scene, mesh.clone(), Material { physical: Some(brushed), ..Material::default() }, Affine3A::IDENTITY);
    add(&mut scene, mesh.clone(), Material { physical: Some(copper(0.3)), ..Material::default() }, Affine3A::IDENTITY);
    add(&mut scene, mesh, with_heights(0, 1.0, matte(Vec3::ONE)), Affine3A::IDENTITY);
    let warnings = scene.add_tangents();
    let tangents = |mesh: usize| &scene.meshes[mesh].tangents;
    for tangent in tangents(0) {
        assert!((tangent.truncate() - Vec3::NEG_Y).length() < 1e-6, "{tangent}");
        // Up, along v, is +x: to the right of +z and -y.
        assert_eq!(tangent.w, 1.0, "z x -y = x");
    }
    assert_eq!(tangents(1)[3..6], [glam::Vec4::ZERO; 3]);
    assert!(warnings.len() == 1 && warnings[0].contains("2 triangles of 2"), "{warnings:?}");
    assert!(tangents(2).is_empty() && !tangents(3).is_empty() && tangents(4).is_empty() && tangents(5).is_empty());
    assert!(scene.add_tangents().is_empty(), "they are there");
}

/// Around a ball of longitudes and latitudes, tangents go around it, and are one across edges.
#[test]
fn tangents_go_around_a_ball() {
    let mut scene = empty(2, 2);
    add(&mut scene, mapped_ball(3), with_normals(0, 1.0, matte(Vec3::ONE)), Affine3A::IDENTITY);
    assert!(scene.add_tangents().is_empty());
    let mesh = &scene.meshes[0];
    for (triangle, tangents) in mesh.triangles.iter().zip(mesh.tangents.chunks(3)) {
        for (v, tangent) in triangle.vertices.iter().zip(tangents) {
            let p = mesh.positions[*v as usize];
            if p.y.abs() < 0.8 {
                let east = Vec3::new(p.z, 0.0, -p.x).normalize();
                assert!(tangent.truncate().dot(east) > 0.99, "{p}: {tangent}");
                assert_eq!(tangent.w, 1.0);
            }
        }
    }
}

/// Where vertex normals lean inwards nothing comes through a sheet from behind, though the terminator is smoothed.
#[test]
fn smoothed_terminators_let_nothing_through_from_behind() {
    for (lean, elevation) in [(30.0, 10.0), (2.0, 0.5), (0.01, 0.002)] {
        for azimuth in [0.0, 45.0, 110.0, 200.0, 290.0] {
            let found = means(&hollow_sheet(lean, elevation, azimuth), 16);
            assert!(found.iter().all(|channel| channel.mean == 0.0), "{lean}, {elevation}, {azimuth}: {found:?}");
        }
    }
}
