//! Indirect light: furnaces, closed rooms, and surfaces that light others (CIE 171, 5.6 to 5.8).

use super::case::{Case, View};
use super::formulas::polygon;
use super::luminaires::{infinite, look_along, point};
use super::views::{empty, speck};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::scene::build::{add, cube, estimator, icosphere, matte, quad};
use luminaire::scene::{Estimator, Extinction, LightSampling, Material};
use std::f64::consts::PI;

/// A closed shell of triangles that emits 1, seen from inside.
fn furnace(albedo: f32) -> View {
    let mut scene = empty();
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    let glowing = Material { emission: Vec3::ONE, ..matte(Vec3::splat(albedo)) };
    add(&mut scene, icosphere(3), glowing, Affine3A::IDENTITY);
    View { scene, weight: 1.0 }
}

fn furnaces() -> Vec<Case> {
    const SUBJECT: &str = "furnaces";
    let mut cases = Vec::new();
    for albedo in [0.2f32, 0.5, 0.8, 0.95] {
        let expected = 1.0 / (1.0 - f64::from(albedo));
        let name = format!("closed shell, albedo {albedo}");
        cases.push(Case::estimated(SUBJECT, name, "Le / (1 - a)", expected, vec![furnace(albedo)]));
    }
    for bounces in [0u32, 3] {
        let mut view = furnace(0.8);
        estimator(&mut view.scene).max_bounces = Some(bounces);
        let expected = (0..=bounces as i32 + 1).map(|k| f64::from(0.8f32).powi(k)).sum();
        let name = format!("albedo 0.8, at most {bounces} bounces");
        cases.push(Case::estimated(SUBJECT, name, "1 + a + ... + a^(k + 1)", expected, vec![view]));
    }
    let mut view = furnace(0.8);
    let estimator = estimator(&mut view.scene);
    *estimator =
        Estimator { light_sampling: LightSampling::None, extinction: Extinction::Literal, ..Estimator::default() };
    let expected = 1.0 / (1.0 - f64::from(0.8f32).powi(2));
    let name = "albedo 0.8, extinction as the slide has it".into();
    cases.push(Case::estimated(SUBJECT, name, "Le / (1 - a^2)", expected, vec![view]));
    cases
}

/// A closed room of one albedo. What arrives is what the lamp gives and what was reflected of what arrives, so over all surfaces the mean irradiance is
/// `(Phi / A) / (1 - rho)`, whatever the room's shape; the indirect part of it is `(Phi / A) rho / (1 - rho)`.
fn closed_rooms() -> Vec<Case> {
    const SUBJECT: &str = "closed rooms";
    let mut cases = Vec::new();
    for albedo in [0.05f32, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95] {
        // A cube of 4 x 4 x 4 with the lamp in its middle: all faces are alike, one is seen.
        let mut scene = empty();
        add(&mut scene, cube(), matte(Vec3::splat(albedo)), Affine3A::from_scale(Vec3::splat(2.0)));
        scene.luminaires.push(point(Vec3::ZERO, 1.0));
        look_along(&mut scene, -Vec3::Z, -Vec3::Z, 4.0);
        let rho = f64::from(albedo);
        let flux = 4.0 * PI / 96.0;
        let name = format!("CIE 171 5.8: room of 4 x 4 x 4, point in the middle, rho {albedo}");
        let view = View { scene, weight: PI / rho };
        let formula = "(Phi / A) / (1 - rho)";
        cases.push(Case::estimated(SUBJECT, name, formula, flux / (1.0 - rho), vec![view]));
    }
    // In a sphere the same holds at every point. Facets lie inside it by at most 5e-4, between which and 1e-3 the irradiance is.
    let mut scene = empty();
    add(&mut scene, icosphere(5), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.sensor.position = Vec3::new(0.25, 0.125, 0.5);
    scene.luminaires.push(point(Vec3::ZERO, std::f32::consts::PI));
    let name = "sphere (20480 triangles), point in the middle, rho 0.5".into();
    let view = View { scene, weight: 1.0 };
    cases.push(Case::estimated(SUBJECT, name, "rho / pi I / (1 - rho)", 1.0, vec![view]).slack(1e-3));
    cases
}

/// A square S of 1 x 1 on the floor, x and z from 0 to 1, of albedo 0.8, is lit from infinity at 35 degrees. It lights a speck of albedo 0.5 at `at`
/// that looks along `normal` and is not lit itself; the weighted picture is the speck's irradiance over that of S.
fn reflected(at: Vec3, normal: Vec3) -> View {
    let (sine, cosine) = 35f32.to_radians().sin_cos();
    let mut scene = empty();
    add(&mut scene, quad(Vec3::ZERO, Vec3::X, Vec3::Z), matte(Vec3::splat(0.8)), Affine3A::IDENTITY);
    let (a, b) = (Vec3::new(normal.y, normal.z, normal.x), Vec3::new(normal.z, normal.x, normal.y));
    // So small that it takes nothing from S and gives nothing back: 1e-6 of its light.
    let size = 1.0 / 1024.0;
    add(&mut scene, quad(at - 0.5 * size * (a + b), size * a, size * b), matte(Vec3::splat(0.5)), Affine3A::IDENTITY);
    scene.luminaires.push(infinite(Vec3::new(sine, -cosine, 0.0), 1.0));
    scene.sensor = speck(at, normal);
    View { scene, weight: PI / 0.5 / f64::from(cosine) }
}

/// Irradiance at a point from a part of S, z from `low` to 1, over that of S.
fn from_part(at: Vec3, normal: Vec3, low: f64) -> f64 {
    let corners = [(0.0, low), (1.0, low), (1.0, 1.0), (0.0, 1.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
    f64::from(0.8f32) / PI * polygon(at.as_dvec3(), normal.as_dvec3(), &corners)
}

fn surfaces() -> Vec<Case> {
    const SUBJECT: &str = "diffuse reflection";
    let mut cases = Vec::new();
    for (where_, at, normal) in [
        ("ceiling 1 above its middle", Vec3::new(0.5, 1.0, 0.5), -Vec3::Y),
        ("ceiling 1/2 above, 1 aside", Vec3::new(0.5, 0.5, 1.5), -Vec3::Y),
        ("wall 1/4 away, 1/4 up", Vec3::new(-0.25, 0.25, 0.5), Vec3::X),
        ("wall 1/4 away, 2 up", Vec3::new(-0.25, 2.0, 0.5), Vec3::X),
    ] {
        let name = format!("CIE 171 5.6: a lit square lights a {where_}");
        let view = reflected(at, normal);
        let expected = from_part(at, normal, 0.0);
        cases.push(Case::estimated(SUBJECT, name, "rho / pi Lambert's polygon", expected, vec![view]).effort(8));
    }
    // An obstruction that the light runs along: a black plate in the plane z = -1/8, up to a height. From a point at z = -1/2 and the height y one
    // sees over it what is beyond z: 1 - (z + 1/2)^-1 3/8 times y above the floor.
    for (where_, at, normal, top) in [
        ("ceiling", Vec3::new(0.5, 1.0, -0.5), -Vec3::Y, 0.4375f32),
        ("wall", Vec3::new(0.5, 1.0, -0.5), Vec3::Z, 0.5),
        ("ceiling, half of it hidden", Vec3::new(0.5, 1.0, -0.5), -Vec3::Y, 0.625),
    ] {
        let low = f64::from(at.y) * 0.375 / f64::from(at.y - top) - 0.5;
        let mut view = reflected(at, normal);
        let plate = quad(Vec3::new(-8.0, -1.0, -0.125), Vec3::X * 16.0, Vec3::Y * (1.0 + top));
        add(&mut view.scene, plate, matte(Vec3::ZERO), Affine3A::IDENTITY);
        let expected = from_part(at, normal, low);
        let name = format!("CIE 171 5.7: the same past an obstruction, {where_}");
        cases.push(Case::estimated(SUBJECT, name, "polygon of what is not hidden", expected, vec![view]).effort(8));
    }
    cases
}

pub(super) fn cases() -> Vec<Case> {
    [furnaces(), closed_rooms(), surfaces()].concat()
}
