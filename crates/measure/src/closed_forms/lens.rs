//! Depth of field: the circle of confusion of a thin lens, and the conservation of its energy.
//!
//! A lens of radius R that is in focus at f sees, from the middle of the film, all of a disc of radius `R |z - f| / f` in the plane at the
//! distance z, each part of it by the same share of the lens. On the film, as seen in the plane of focus, a point at z becomes a disc of the
//! radius `R |z - f| / z`.

use super::case::{Case, View};
use super::formulas::disc_beyond;
use super::views::empty;
use glam::{Affine3A, Vec3};
use luminaire::scene::build::{add, lamp, mesh, quad};
use luminaire::scene::{Lens, Mesh, Projection, Scene};
use std::f64::consts::{PI, TAU};

const SUBJECT: &str = "depth of field";
const RADIUS: f32 = 0.25;
const FOCUS: f32 = 2.0;

/// Looks along -z through a lens.
fn scene(blades: u32, projection: Projection) -> Scene {
    let mut scene = empty();
    scene.sensor.projection = projection;
    scene.sensor.lens = Some(Lens { radius: RADIUS, focus_distance: FOCUS, blades, rotation: 15.0 });
    scene
}

/// The whole picture is a speck in its middle.
const SPECK: Projection = Projection::Perspective { fov: 1e-3 };

/// Radius of what the middle of the film sees at a distance.
fn confusion(z: f32) -> f32 {
    RADIUS * (z - FOCUS).abs() / FOCUS
}

/// A half-plane of radiance 1 at the distance `z` whose edge is `share` of the circle of confusion from the middle.
fn knife_edge(name: &str, z: f32, share: f32, projection: Projection) -> Case {
    let mut scene = scene(0, projection);
    let edge = confusion(z) * share;
    add(
        &mut scene,
        quad(Vec3::new(edge, -8.0, -z), Vec3::X * 8.0, Vec3::Y * 16.0),
        lamp(Vec3::ONE),
        Affine3A::IDENTITY,
    );
    let name = format!("edge at {share} of the circle of confusion, {name}");
    let formula = "(acos s - s sqrt(1 - s^2)) / pi";
    Case::estimated(SUBJECT, name, formula, disc_beyond(f64::from(share)), vec![View { scene, weight: 1.0 }]).effort(4)
}

/// A regular polygon around the axis, and its area.
fn disc(radius: f32, z: f32) -> (Mesh, f64) {
    const CORNERS: u32 = 64;
    let angle = |i: u32| std::f32::consts::TAU * i as f32 / CORNERS as f32;
    let corners = (0..CORNERS).map(|i| Vec3::new(radius * angle(i).cos(), radius * angle(i).sin(), -z)).collect();
    let triangles: Vec<_> = (1..CORNERS - 1).map(|i| [0, i, i + 1]).collect();
    let area = 0.5 * f64::from(CORNERS) * (TAU / f64::from(CORNERS)).sin() * f64::from(radius).powi(2);
    (mesh(corners, &triangles), area)
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = vec![
        knife_edge("before the focus", 1.0, 0.5, SPECK),
        knife_edge("behind the focus", 4.0, 0.0, SPECK),
        knife_edge("behind the focus", 4.0, 0.5, SPECK),
        knife_edge("behind the focus", 4.0, 0.875, SPECK),
        knife_edge("parallel rays", 4.0, 0.5, Projection::Orthographic { height: 1e-5 }),
    ];
    for (name, blades, aperture) in [("round aperture", 0, PI), ("six blades", 6, 1.5 * 3f64.sqrt())] {
        let z = 6.0;
        let (lamp_mesh, area) = disc(0.25, z);
        let mut blurred = scene(blades, SPECK);
        add(&mut blurred, lamp_mesh, lamp(Vec3::ONE), Affine3A::IDENTITY);
        let expected = area / (aperture * f64::from(confusion(z)).powi(2));
        let view = View { scene: blurred, weight: 1.0 };
        let name_of_disc = format!("disc out of focus, {name}");
        let formula = "its area over that of the blur";
        cases.push(Case::estimated(SUBJECT, name_of_disc, formula, expected, vec![view]).effort(4));

        // All of the blurred picture of a square, 2 x 2 at the distance 4: what it would be without a lens.
        let fov = 53.13f32;
        let side = 2.0 * f64::from(FOCUS) * (0.5 * f64::from(fov)).to_radians().tan();
        let mut whole = scene(blades, Projection::Perspective { fov });
        add(
            &mut whole,
            quad(Vec3::new(-1.0, -1.0, -4.0), Vec3::X * 2.0, Vec3::Y * 2.0),
            lamp(Vec3::ONE),
            Affine3A::IDENTITY,
        );
        let expected = 4.0 * (f64::from(FOCUS) / 4.0).powi(2) / (side * side);
        let view = View { scene: whole, weight: 1.0 };
        let name = format!("square out of focus, whole picture, {name}");
        cases.push(
            Case::estimated(SUBJECT, name, "A (f / z)^2 over the picture's area", expected, vec![view]).effort(2),
        );
    }
    cases
}
