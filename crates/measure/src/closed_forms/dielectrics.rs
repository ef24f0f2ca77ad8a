//! Mirrors and glass: Fresnel's reflectance, plates, and bodies in light that comes from everywhere (CIE 171, 5.5).

use super::case::{BOUND, Case, Measured, View};
use super::formulas::reflectance;
use super::views::empty;
use glam::{Affine3A, Vec3};
use luminaire::scene::build::{add, cube, estimator, icosphere, lamp, matte, pinhole, quad};
use luminaire::scene::{Environment, Extinction, Material, Mesh, Scene};

const SUBJECT: &str = "mirrors and glass";

fn glass(eta: f32) -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta), ..matte(Vec3::ZERO) }
}

fn white() -> Environment {
    Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 }
}

/// Some scene, for functions that need none.
pub(super) fn any_scene() -> Scene {
    surface(1.5)
}

/// The plane y = 0, of the index `eta` below over that above.
fn surface(eta: f32) -> Scene {
    let mut scene = empty();
    let plane = quad(Vec3::new(-64.0, 0.0, -64.0), Vec3::Z * 128.0, Vec3::X * 128.0);
    add(&mut scene, plane, glass(eta), Affine3A::IDENTITY);
    scene
}

/// Looks down at the origin at an angle to +y; gives the angle in radian that single precision made of it.
fn look(scene: &mut Scene, degrees: f32) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let eye = Vec3::new(sine, cosine, 0.0);
    scene.sensor = pinhole(eye, Vec3::ZERO, Vec3::Z, 1e-3);
    f64::from(eye.x).atan2(f64::from(eye.y))
}

/// A plane of radiance 1 at a height.
fn sky_at(scene: &mut Scene, height: f32) {
    let plane = quad(Vec3::new(-512.0, height, -512.0), Vec3::X * 1024.0, Vec3::Z * 1024.0);
    add(scene, plane, lamp(Vec3::ONE), Affine3A::IDENTITY);
}

/// Radiance of a surface that mirrors a lamp above and has nothing below.
fn reflected(eta: f32, degrees: f32) -> (View, f64) {
    let mut scene = surface(eta);
    sky_at(&mut scene, 16.0);
    let angle = look(&mut scene, degrees);
    (View { scene, weight: 1.0 }, reflectance(f64::from(eta), angle))
}

/// Nothing is lost at any bounce, so that, where chance does not end paths, every single sample is right.
fn never_extinct(scene: &mut Scene) {
    let estimator = estimator(scene);
    (estimator.extinction, estimator.max_bounces) = (Extinction::Off, Some(10_000));
}

/// A body of glass in white light, of which every sample is known.
fn glass_in_white_light(
    name: &str,
    formula: &'static str,
    expected: f64,
    body: Mesh,
    eta: f32,
    place: Affine3A,
) -> Case {
    let mut view = in_white_light(body, glass(eta), place);
    never_extinct(&mut view.scene);
    Case::certain(SUBJECT, name.into(), formula, expected, view, BOUND)
}

/// A body in white light.
fn in_white_light(body: Mesh, material: Material, place: Affine3A) -> View {
    let mut scene = empty();
    add(&mut scene, body, material, place);
    scene.environment = Some(white());
    scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 30.0);
    View { scene, weight: 1.0 }
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    // The function itself: normal incidence, Brewster's angle, on both sides of the critical angle, grazing.
    let brewster = 1.5f64.atan();
    let critical = (1.0f64 / 1.5).asin();
    for (what, eta, angle) in [
        ("normal incidence", 1.5, 0.0),
        ("normal incidence", 2.4, 0.0),
        ("30 degrees", 1.5, 30f64.to_radians()),
        ("Brewster's angle", 1.5, brewster),
        ("75 degrees", 1.5, 75f64.to_radians()),
        ("85 degrees", 1.5, 85f64.to_radians()),
        ("1 degree short of the critical angle", 1.0 / 1.5, critical - 1f64.to_radians()),
        ("0.01 degrees beyond the critical angle", 1.0 / 1.5, critical + 0.01f64.to_radians()),
    ] {
        let formula = match what {
            "normal incidence" => "((eta - 1) / (eta + 1))^2",
            "Brewster's angle" => "1/2 ((eta^2 - 1) / (eta^2 + 1))^2",
            _ => "Fresnel",
        };
        let expected = match what {
            "Brewster's angle" => 0.5 * (f64::powi(eta, 2) - 1.0).powi(2) / (f64::powi(eta, 2) + 1.0).powi(2),
            _ => reflectance(eta, angle),
        };
        cases.push(Case {
            subject: SUBJECT,
            name: format!("reflectance, index {eta:.4}, {what}"),
            formula,
            expected,
            slack: 0.0,
            effort: 1,
            measured: Measured::Reflectance { eta, angle, bound: BOUND },
        });
    }
    // The same in pictures.
    for (what, eta, degrees) in [
        ("normal incidence", 1.5, 0.0),
        ("Brewster's angle", 1.5, brewster.to_degrees() as f32),
        ("80 degrees", 1.5, 80.0),
        ("45 degrees", 2.4, 45.0),
        ("35 degrees", 1.0 / 1.5, 35.0),
    ] {
        let (view, expected) = reflected(eta, degrees);
        let name = format!("picture of a reflection, index {eta:.4}, {what}");
        cases.push(Case::estimated(SUBJECT, name, "Fresnel", expected, vec![view]).effort(8));
    }
    let (mut total, _) = reflected(1.0 / 1.5, 45.0);
    never_extinct(&mut total.scene);
    let name = "picture of a reflection, index 0.6667, 45 degrees: total".into();
    cases.push(Case::certain(SUBJECT, name, "1", 1.0, total, BOUND));
    for degrees in [0.0f32, 45.0, 60.0, 80.0] {
        let mut scene = empty();
        add(&mut scene, cube(), glass(1.5), Affine3A::from_scale(Vec3::new(64.0, 0.125, 64.0)));
        sky_at(&mut scene, -16.0);
        let angle = look(&mut scene, degrees);
        let f = reflectance(1.5, angle);
        let name = format!("CIE 171 5.5: through a plate of glass that absorbs nothing, {degrees} degrees");
        let view = View { scene, weight: 1.0 };
        let formula = "(1 - F) / (1 + F)";
        cases.push(Case::estimated(SUBJECT, name, formula, (1.0 - f) / (1.0 + f), vec![view]).effort(2));
    }
    // White light.
    let place = Affine3A::from_translation(-Vec3::Z * 3.0);
    for eta in [0.67f32, 1.5, 2.4] {
        let name = format!("glass body (80 triangles) of index {eta} in white light");
        cases.push(glass_in_white_light(&name, "1", 1.0, icosphere(1), eta, place));
    }
    let wall = quad(Vec3::new(-9.0, -9.0, 1.0), Vec3::X * 18.0, Vec3::Y * 18.0);
    for probability in [0.1f32, 0.6] {
        let mirror = Material {
            reflection: Vec3::splat(0.6),
            impulse_probability: Some(probability),
            ..matte(Vec3::splat(0.4))
        };
        let name = format!("60 % mirror, 40 % diffuse, chosen with probability {probability}, in white light");
        let view = in_white_light(wall.clone(), mirror, place);
        cases.push(Case::estimated(SUBJECT, name, "1", 1.0, vec![view]));
    }
    for degrees in [0.0f32, 35.0] {
        let mut scene = surface(1.0 / 1.5);
        scene.environment = Some(white());
        let angle = look(&mut scene, degrees);
        let eta = f64::from(1.0f32 / 1.5);
        let f = reflectance(eta, angle);
        let name = format!("white light seen from inside glass, one surface, {degrees} degrees");
        let expected = (1.0 - f) / (eta * eta) + f;
        let view = View { scene, weight: 1.0 };
        cases.push(Case::estimated(SUBJECT, name, "(1 - F) eta^2 + F", expected, vec![view]));
    }
    let name = "white light in the middle of a glass ball";
    cases.push(glass_in_white_light(name, "eta^2", 2.25, icosphere(2), 1.5, Affine3A::IDENTITY));
    cases
}
