//! Plates that light each other: the published form factors of squares, as mean irradiance over a plate.

use super::case::{Case, View};
use super::formulas::{parallel_rectangles, perpendicular_rectangles};
use super::luminaires::{ALBEDO, look_along};
use super::views::empty;
use glam::{Affine3A, Vec3};
use luminaire::scene::build::{add, lamp, matte, quad};

const SUBJECT: &str = "form factors";

/// The unit square of the floor, x and z from 0 to 1, is lit by a plate of radiance 1 and seen from above by parallel rays. The weighted
/// picture is the share of the plate's light that reaches it, by reciprocity: mean irradiance over pi.
fn lit_by(corner: Vec3, a: Vec3, b: Vec3, eye: f32) -> View {
    let mut scene = empty();
    add(&mut scene, quad(Vec3::ZERO, Vec3::X, Vec3::Z), matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    add(&mut scene, quad(corner, a, b), lamp(Vec3::ONE), Affine3A::IDENTITY);
    look_along(&mut scene, Vec3::new(0.5, eye, 0.5), -Vec3::Y, 1.0);
    View { scene, weight: 1.0 / f64::from(ALBEDO) }
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for distance in [0.25f32, 1.0, 4.0] {
        let view = lit_by(Vec3::Y * distance, Vec3::X, Vec3::Z, 0.125);
        let expected = parallel_rectangles(1.0, 1.0, f64::from(distance));
        let name = format!("equal parallel squares of 1 x 1 at the distance {distance}");
        cases.push(Case::estimated(SUBJECT, name, "Howell C-11", expected, vec![view]));
    }
    for height in [0.25f32, 1.0, 4.0] {
        let view = lit_by(Vec3::ZERO, Vec3::Y * height, Vec3::Z, 8.0);
        let expected = perpendicular_rectangles(1.0, f64::from(height), 1.0);
        let name = format!("square, and a plate {height} high that stands on its edge");
        cases.push(Case::estimated(SUBJECT, name, "Howell C-14", expected, vec![view]));
    }
    cases
}
