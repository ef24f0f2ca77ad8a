//! Skies through openings: sky components and the conservation of flux (CIE 171, 5.4, 5.9 and 5.11).

use super::case::{Case, View};
use super::formulas::{hemisphere, parallel_rectangles, perpendicular_rectangles, sky_through};
use super::luminaires::{ALBEDO, look_along, plane};
use super::views::empty;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::scene::build::{add, matte, quad};
use luminaire::scene::{Environment, EnvironmentImage, Scene};
use std::f64::consts::PI;

const SUBJECT: &str = "daylight";

/// Rows of the overcast sky's image. Between two of them the picture of the sky is linear in the angle, off by at most 1/12 of the squared step.
const ROWS: u32 = 512;
/// The bound of it, 3e-6 of the zenith's radiance, over the least of the sky's, which is a third.
const SKY_SLACK: f64 = 1e-5;

fn uniform() -> Environment {
    Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 }
}

/// The CIE's overcast sky with a zenith of 1 (Moon and Spencer 1942), and its mirror image below the horizon.
fn overcast_radiance(cosine: f64) -> f64 {
    (1.0 + 2.0 * cosine.abs()) / 3.0
}

fn overcast() -> Environment {
    let angle = |row: u32| PI * (f64::from(row) + 0.5) / f64::from(ROWS);
    let texels = (0..ROWS).map(|row| Vec3::splat(overcast_radiance(angle(row).cos()) as f32)).collect();
    let image = EnvironmentImage { name: "overcast sky".into(), width: 1, height: ROWS, texels };
    Environment { image: Some(image.into()), ..uniform() }
}

fn black(scene: &mut Scene, corner: Vec3, a: Vec3, b: Vec3) {
    add(scene, quad(corner, a, b), matte(Vec3::ZERO), Affine3A::IDENTITY);
}

/// A black room, x and z from -2 to 2 and 3 high, over the plane that is lit. The roof has an opening of 2 x 2 in its middle, or, if there is a window, none;
/// the wall x = 2 then has a window, y from 1 to 2.5 and z from -1 to 1.
fn room(at: Vec3, window: bool) -> (View, [DVec3; 3]) {
    let mut view = plane(at, Vec3::Y);
    let scene = &mut view.scene;
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let v = Vec3::new;
    black(scene, v(-2.0, 0.0, -2.0), 4.0 * x, 3.0 * y);
    black(scene, v(-2.0, 0.0, 2.0), 4.0 * x, 3.0 * y);
    black(scene, v(-2.0, 0.0, -2.0), 4.0 * z, 3.0 * y);
    if window {
        black(scene, v(-2.0, 3.0, -2.0), 4.0 * x, 4.0 * z);
        black(scene, v(2.0, 0.0, -2.0), 4.0 * z, y);
        black(scene, v(2.0, 2.5, -2.0), 4.0 * z, 0.5 * y);
        black(scene, v(2.0, 1.0, -2.0), z, 1.5 * y);
        black(scene, v(2.0, 1.0, 1.0), z, 1.5 * y);
        (view, [v(2.0, 1.0, -1.0), 2.0 * z, 1.5 * y].map(|v| v.as_dvec3()))
    } else {
        black(scene, v(2.0, 0.0, -2.0), 4.0 * z, 3.0 * y);
        black(scene, v(-2.0, 3.0, -2.0), 4.0 * x, z);
        black(scene, v(-2.0, 3.0, 1.0), 4.0 * x, z);
        black(scene, v(-2.0, 3.0, -1.0), x, 2.0 * z);
        black(scene, v(1.0, 3.0, -1.0), x, 2.0 * z);
        (view, [v(-1.0, 3.0, -1.0), 2.0 * x, 2.0 * z].map(|v| v.as_dvec3()))
    }
}

/// The five sides of a box of 1 x 1 x 1 whose top is open: corner, edges, and the direction in which one looks at it from inside.
fn sides() -> [(Vec3, Vec3, Vec3, Vec3); 5] {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    [(Vec3::ZERO, x, z, -y), (Vec3::ZERO, x, y, -z), (z, x, y, z), (Vec3::ZERO, y, z, -x), (x, y, z, x)]
}

/// One side of the box under the uniform sky, the others black; weighted, its picture is the share of the flux through the opening that
/// arrives there.
fn side(seen: usize) -> View {
    let mut scene = empty();
    for (index, (corner, a, b, forward)) in sides().into_iter().enumerate() {
        let albedo = if index == seen { ALBEDO } else { 0.0 };
        add(&mut scene, quad(corner, a, b), matte(Vec3::splat(albedo)), Affine3A::IDENTITY);
        if index == seen {
            look_along(&mut scene, Vec3::splat(0.5) + 0.25 * forward, forward, 1.0);
        }
    }
    scene.environment = Some(uniform());
    View { scene, weight: 1.0 / f64::from(ALBEDO) }
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut view = plane(Vec3::ZERO, Vec3::Y);
    view.scene.environment = Some(overcast());
    let name = "overcast sky, nothing in its way".into();
    let expected = hemisphere(overcast_radiance);
    cases.push(Case::estimated(SUBJECT, name, "7/9 pi Lz", expected, vec![view]).slack(SKY_SLACK));

    let points = [
        ("5.9: roof opening, below its middle", Vec3::ZERO, false),
        ("5.9: roof opening, in the corner", Vec3::new(1.5, 0.0, 1.5), false),
        ("5.11: window, 1 from it", Vec3::X, true),
        ("5.11: window, 3 from it", -Vec3::X, true),
    ];
    for (where_, at, window) in points {
        for (sky, environment) in [("uniform", uniform()), ("overcast", overcast())] {
            let (mut view, opening) = room(at, window);
            let slack = if environment.image.is_some() { SKY_SLACK } else { 0.0 };
            let expected = sky_through(at.as_dvec3(), DVec3::Y, opening, |direction| {
                if slack == 0.0 { 1.0 } else { overcast_radiance(direction.y) }
            });
            view.scene.environment = Some(environment);
            let name = format!("CIE 171 {where_}, {sky} sky");
            let formula = "integral of L cos over the opening";
            cases.push(Case::estimated(SUBJECT, name, formula, expected, vec![view]).slack(slack).effort(4));
        }
    }

    let floor = parallel_rectangles(1.0, 1.0, 1.0);
    let name = "CIE 171 5.4: open box, share of the sky's flux on the floor".into();
    cases.push(Case::estimated(SUBJECT, name, "Howell C-11", floor, vec![side(0)]));
    let wall = perpendicular_rectangles(1.0, 1.0, 1.0);
    let name = "CIE 171 5.4: open box, share on a wall".into();
    cases.push(Case::estimated(SUBJECT, name, "Howell C-14", wall, vec![side(4)]));
    let name = "CIE 171 5.4: open box, all that entered arrives".into();
    cases.push(Case::estimated(SUBJECT, name, "1", 1.0, (0..5).map(side).collect()));

    let mut scene = empty();
    for (corner, a, b, _) in sides() {
        add(&mut scene, quad(corner, a, b), matte(Vec3::ONE), Affine3A::IDENTITY);
    }
    scene.sensor.position = Vec3::new(0.5, 0.75, 0.75);
    scene.sensor.target = Vec3::new(0.5, 0.5, 0.0);
    scene.environment = Some(uniform());
    let name = "open box that absorbs nothing under a white sky: what entered leaves".into();
    cases.push(Case::estimated(SUBJECT, name, "1", 1.0, vec![View { scene, weight: 1.0 }]));
    cases
}
