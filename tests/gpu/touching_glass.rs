//! Glass that touches other surfaces exactly: it is white in white light, and looks as with a small gap, in the reference and on every backend.

use super::glass::{on_every_tracer, trace};
use crate::common::statistics::*;
use crate::common::touching::{clear, furnaces, scenes};
use glam::{Affine3A, DMat3, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::build::{add, empty, estimator, mesh, pinhole};
use luminaire::scene::{Environment, LightSampling, Mesh, Scene};

/// Nothing is lost and nothing gained: every pixel is 1.
#[test]
fn touching_glass_is_white_in_white_light() {
    for (name, mut scene) in furnaces() {
        let said = scene.part_touching_glass();
        println!("{name}: {said:?}");
        assert_eq!(said.len(), 1, "{name}: {said:?}");
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, 8);
            assert_eq!(traced.dropped, [], "{name}, {backend}");
            let off = traced.sums.iter().flat_map(|sum| sum.radiance).map(|r| (r - 1.0).abs()).fold(0.0, f64::max);
            println!("{name}, {backend}: {off:.2e}");
            assert!(off < 1e-3, "{name}, {backend}: off by {off}");
        });
    }
}

/// The mean over the picture is that of a gap of a thousandth, with the same random numbers.
#[test]
fn touching_glass_looks_as_with_a_small_gap() {
    let gaps = scenes(0.5, 1e-3);
    for ((name, mut scene), (_, mut apart)) in scenes(0.5, 0.0).into_iter().zip(gaps) {
        scene.part_touching_glass();
        assert_eq!(apart.part_touching_glass(), Vec::<String>::new(), "{name}");
        let expected = total(&render(&mut Reference::new(&apart), 16, 16, 32, 4)).mean;
        on_every_tracer(&scene, |backend, tracer| {
            let found = total(&render(tracer, 16, 16, 32, 4)).mean;
            println!("{name}, {backend}: {found}, with a gap {expected}: {:.1e}", found - expected);
            assert!((found - expected).abs() < 1.5e-3, "{name}, {backend}: {found}, with a gap {expected}");
        });
    }
}

/// A box between two corners, with its corners where `place` puts them.
fn cuboid(low: [f64; 3], high: [f64; 3], place: impl Fn(DVec3) -> Vec3) -> Mesh {
    let corner = |i: usize| DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    let faces = [[0, 1, 5, 4], [2, 6, 7, 3], [4, 5, 7, 6], [0, 2, 3, 1], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh((0..8).map(|i| place(corner(i))).collect(), &triangles)
}

/// Two boxes of glass in white light, that is found by chance alone, turned by these angles about two axes and then so large.
fn two_boxes(bodies: [Mesh; 2], turned: DMat3, size: f64) -> Scene {
    let mut scene = empty(24, 18);
    let place = |p: [f64; 3]| (turned * DVec3::from(p) * size).as_vec3();
    scene.sensor = pinhole(place([1.5, 1.4, 3.0]), place([0.0, 0.4, 0.0]), turned.y_axis.as_vec3(), 30.0);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    for body in bodies {
        add(&mut scene, body, clear(1.5), Affine3A::IDENTITY);
    }
    estimator(&mut scene).light_sampling = LightSampling::None;
    scene
}

fn is_white(name: &str, scene: &mut Scene) {
    let said = scene.part_touching_glass();
    assert!(said.len() == 1 && said[0].contains("drawn in"), "{name}: {said:?}");
    on_every_tracer(scene, |backend, tracer| {
        let traced = trace(tracer, scene, 16);
        assert_eq!(traced.dropped, [], "{name}, {backend}");
        let off = traced.sums.iter().flat_map(|sum| sum.radiance).map(|r| (r - 1.0).abs()).fold(0.0, f64::max);
        println!("{name}, {backend}: {off:.2e}");
        assert!(off < 2e-4, "{name}, {backend}: off by {off}");
    });
}

/// Files in millimetres have three decimals: faces that touch are then off each other by what these round, or reach into each other.
#[test]
fn rounded_glass_that_touches_is_white_in_white_light() {
    for k in [1.0, 3.0, 5.0, 12.0, 13.0] {
        let turned = DMat3::from_rotation_y(0.1 + 0.37 * k) * DMat3::from_rotation_z(0.3 * k);
        let rounded = |p: DVec3| ((turned * p * 100.0 * 1000.0).round() / 1000.0).as_vec3();
        let one = cuboid([-0.5, 0.0, -0.5], [0.0, 1.0, 0.5], rounded);
        let other = cuboid([0.0, 0.0, -0.5], [0.6, 0.4, 0.5], rounded);
        is_white(&format!("turned {k} times"), &mut two_boxes([one, other], turned, 100.0));
    }
}

/// Faces that touch at one edge, with a gap or an overlap at the other.
#[test]
fn a_narrow_wedge_between_glass_is_white_in_white_light() {
    for wedge in [8e-6, -8e-6, 2e-5, -2e-5] {
        let turned = DMat3::from_rotation_z(0.4);
        let one = cuboid([-0.5, 0.0, -0.5], [0.0, 1.0, 0.5], |p| (turned * p).as_vec3());
        let other = cuboid([0.0, 0.0, -0.5], [0.6, 1.0, 0.5], |p| {
            let by = if p.x == 0.0 { wedge * p.y } else { 0.0 };
            (turned * (p + DVec3::X * by)).as_vec3()
        });
        is_white(&format!("a wedge of {wedge}"), &mut two_boxes([one, other], turned, 1.0));
    }
}
