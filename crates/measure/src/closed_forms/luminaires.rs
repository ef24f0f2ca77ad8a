//! Direct light: irradiance from points, polygons, discs, spheres, infinity and an environment (CIE 171, 5.2 and 5.3).

use super::case::{BOUND, Case, View};
use super::formulas::{polygon, polyhedron, solid_angle, solid_angle_of_rectangle};
use super::views::{empty, speck};
use glam::{Affine3A, DVec3, Vec3, Vec3Swizzles};
use luminaire::scene::build::{add, icosphere, lamp, matte, mesh, quad};
use luminaire::scene::{Environment, Integrator, Luminaire, Mesh, Projection, Scene};
use std::f64::consts::PI;

const SUBJECT: &str = "direct light";

/// Albedo of everything that is lit.
pub(super) const ALBEDO: f32 = 0.5;

/// A wide plane of [`ALBEDO`] through `point` with the normal `normal`, an axis; seen at `point`. Weighted, its picture is the irradiance there.
pub(super) fn plane(point: Vec3, normal: Vec3) -> View {
    let (a, b) = (normal.yzx(), normal.zxy());
    let mut scene = empty();
    add(&mut scene, quad(point - 16.0 * (a + b), 32.0 * a, 32.0 * b), matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    scene.sensor = speck(point, normal);
    View { scene, weight: PI / f64::from(ALBEDO) }
}

/// A luminaire at a point.
pub(super) fn point(position: Vec3, intensity: f32) -> Luminaire {
    Luminaire::Point { position, intensity: Vec3::splat(intensity) }
}

/// Light from infinity that travels in `direction`.
pub(super) fn infinite(direction: Vec3, irradiance: f32) -> Luminaire {
    Luminaire::Infinite { direction, irradiance: Vec3::splat(irradiance) }
}

/// Parallel rays along `forward`, an axis, from `eye`, onto a square with this side.
pub(super) fn look_along(scene: &mut Scene, eye: Vec3, forward: Vec3, side: f32) {
    scene.sensor.position = eye;
    scene.sensor.target = eye + forward;
    scene.sensor.up = forward.yzx().abs();
    scene.sensor.projection = Projection::Orthographic { height: side };
}

/// A flat polygon as a fan of triangles.
fn fan(corners: &[Vec3]) -> Mesh {
    let triangles: Vec<_> = (1..corners.len() as u32 - 1).map(|i| [0, i, i + 1]).collect();
    mesh(corners.to_vec(), &triangles)
}

fn widen(corners: &[Vec3]) -> Vec<DVec3> {
    corners.iter().map(|corner| corner.as_dvec3()).collect()
}

/// The corners of a regular polygon around `middle`, in the plane of `a` and `b`, its radii.
fn round(middle: Vec3, a: Vec3, b: Vec3, corners: u32) -> Vec<Vec3> {
    let angle = |i: u32| std::f32::consts::TAU * i as f32 / corners as f32;
    (0..corners).map(|i| middle + a * angle(i).cos() + b * angle(i).sin()).collect()
}

/// A polygon of radiance 1 lights a point of a plane.
fn lit_by_polygon(name: &str, at: Vec3, normal: Vec3, corners: &[Vec3]) -> Case {
    let mut view = plane(at, normal);
    add(&mut view.scene, fan(corners), lamp(Vec3::ONE), Affine3A::IDENTITY);
    let expected = polygon(at.as_dvec3(), normal.as_dvec3(), &widen(corners));
    Case::estimated(SUBJECT, name.into(), "Lambert's polygon", expected, vec![view])
}

/// World-space faces of a sphere of triangles, counter-clockwise as seen from outside.
fn faces(ball: &Mesh, middle: Vec3) -> Vec<[DVec3; 3]> {
    let corner = |v: u32| (ball.positions[v as usize] + middle).as_dvec3();
    ball.triangles.iter().map(|t| t.vertices.map(corner)).collect()
}

/// A sphere of radius 1 and radiance 1 lights the origin of the plane y = 0.
fn lit_by_sphere(name: &str, middle: Vec3) -> Case {
    let mut ball = icosphere(3);
    let triangles = faces(&ball, middle);
    ball.positions.iter_mut().for_each(|p| *p += middle);
    let mut view = plane(Vec3::ZERO, Vec3::Y);
    add(&mut view.scene, ball, lamp(Vec3::ONE), Affine3A::IDENTITY);
    let expected = polyhedron(DVec3::ZERO, DVec3::Y, &triangles);
    Case::estimated(SUBJECT, name.into(), "Lambert's polygon, face by face", expected, vec![view]).effort(2)
}

/// A diffuse sphere of triangles, lit by one luminaire of strength 1 and seen by parallel rays along -z: mean radiance of its bounding square.
/// Faces that see the luminaire are wholly lit: the body is convex.
fn lit_sphere(name: &str, formula: &'static str, luminaire: Luminaire) -> Case {
    let ball = icosphere(3);
    let mut flux = 0.0;
    for face in faces(&ball, Vec3::ZERO) {
        let area = 0.5 * (face[1] - face[0]).cross(face[2] - face[0]);
        let arriving = match &luminaire {
            Luminaire::Point { position, .. } => {
                let position = position.as_dvec3();
                if area.dot(position - face[0]) > 0.0 { solid_angle(position, face) } else { 0.0 }
            }
            Luminaire::Infinite { direction, .. } => area.dot(-direction.as_dvec3()).max(0.0),
            _ => unreachable!("a point or infinity"),
        };
        flux += arriving * area.normalize().z.max(0.0);
    }
    let mut scene = empty();
    add(&mut scene, ball, matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    scene.luminaires.push(luminaire);
    look_along(&mut scene, Vec3::Z * 2.0, -Vec3::Z, 2.0);
    let expected = f64::from(ALBEDO) / PI * flux / 4.0;
    Case::estimated(SUBJECT, name.into(), formula, expected, vec![View { scene, weight: 1.0 }])
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();

    // Points and infinity: no chance, but for where in the speck a ray meets the plane.
    for (x, h) in [(0.0f32, 3.0f32), (1.0, 3.0), (2.0, 3.0), (4.0, 3.0), (8.0, 3.0), (0.0, 0.125), (0.0, 1000.0)] {
        let mut view = plane(Vec3::X * x, Vec3::Y);
        view.scene.luminaires.push(point(Vec3::Y * h, 2.0));
        let expected = 2.0 * f64::from(h) / f64::from(h * h + x * x).powf(1.5);
        let name = format!("CIE 171 5.2: point {h} above a plane, {x} aside");
        cases.push(Case::certain(SUBJECT, name, "I cos / d^2", expected, view, BOUND));
    }
    for degrees in [0.0f32, 45.0, 86.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let mut view = plane(Vec3::ZERO, Vec3::Y);
        view.scene.luminaires.push(infinite(Vec3::new(sine, -cosine, 0.0), 2.0));
        let name = format!("luminaire at infinity, {degrees} degrees");
        cases.push(Case::certain(SUBJECT, name, "E cos", 2.0 * f64::from(cosine), view, BOUND));
    }
    let mut view = plane(Vec3::ZERO, Vec3::Y);
    view.scene.luminaires.push(point(Vec3::Y, 2.0));
    view.scene.integrator = Integrator::Simple { ambient: Vec3::splat(0.25) };
    view.scene.materials[0].ambient = Vec3::splat(0.75);
    view.weight = 1.0;
    let expected = 0.25 * 0.75 + f64::from(ALBEDO) / PI * 2.0;
    let name = "simple ray tracer: ambient and a point".into();
    cases.push(Case::certain(SUBJECT, name, "La ka + kd / pi I / d^2", expected, view, BOUND));

    let mut view = plane(Vec3::ZERO, Vec3::Y);
    view.scene.luminaires = vec![point(Vec3::Y * 2.0, 4.0), infinite(Vec3::new(0.6, -0.8, 0.0), 1.0)];
    view.scene.luminaires.push(point(Vec3::new(2.0, 1.0, 0.0), 1.0));
    let expected = 1.0 + f64::from(0.8f32) + 5f64.powf(-1.5);
    let name = "two points and infinity, one chosen at a time".into();
    cases.push(Case::estimated(SUBJECT, name, "their sum", expected, vec![view]));

    let mut view = plane(Vec3::ZERO, Vec3::Y);
    view.scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    let name = "environment of one colour over a plane".into();
    cases.push(Case::estimated(SUBJECT, name, "pi L", PI, vec![view]));

    for h in [0.5f32, 3.0] {
        let mut view = plane(Vec3::ZERO, Vec3::Y);
        view.scene.luminaires.push(point(Vec3::Y * h, 1.0));
        look_along(&mut view.scene, Vec3::Y * 0.25, -Vec3::Y, 4.0);
        view.weight *= 16.0;
        let expected = solid_angle_of_rectangle(4.0, 4.0, f64::from(h));
        let name = format!("flux of a point {h} above a square of 4 x 4");
        cases.push(Case::estimated(SUBJECT, name, "I times its solid angle", expected, vec![view]));
    }

    // Area luminaires.
    let panel = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| Vec3::new(x, 2.0, z));
    for x in [0.0f32, 1.0, 4.0] {
        let name = format!("CIE 171 5.3: square lamp 2 above a plane, {x} aside");
        cases.push(lit_by_polygon(&name, Vec3::X * x, Vec3::Y, &panel));
    }
    for y in [0.0f32, 1.5] {
        let name = format!("CIE 171 5.3: the same on a wall 2 away, {} below", 2.0 - y);
        cases.push(lit_by_polygon(&name, Vec3::new(-2.0, y, 0.0), Vec3::X, &panel));
    }
    let v = Vec3::new;
    let triangle = [v(-0.5, 1.0, -0.25), v(0.75, 1.5, 0.0), v(0.0, 1.25, 1.0)];
    cases.push(lit_by_polygon("triangle, tilted", Vec3::ZERO, Vec3::Y, &triangle));
    let tilted = [v(1.0, 0.25, -1.0), v(1.0, 0.25, 1.0), v(2.0, 2.25, 1.0), v(2.0, 2.25, -1.0)];
    cases.push(lit_by_polygon("quadrilateral, tilted", Vec3::ZERO, Vec3::Y, &tilted));
    let half = tilted.map(|corner| corner - Vec3::Y);
    cases.push(lit_by_polygon("the same, partly below the horizon", Vec3::ZERO, Vec3::Y, &half));
    let far_below = [v(0.5, -1.5, 0.0), v(1.0, 0.5, -0.5), v(1.0, 0.75, 0.75)];
    cases.push(lit_by_polygon("triangle, mostly below the horizon", Vec3::ZERO, Vec3::Y, &far_below));
    let strip = [v(-2.0, 1.0, 0.0), v(2.0, 1.0, 0.0), v(2.0, 1.0, 1.0 / 256.0), v(-2.0, 1.0, 1.0 / 256.0)];
    cases.push(lit_by_polygon("strip of 1 : 1024", Vec3::ZERO, Vec3::Y, &strip));
    let near = [v(-8.0, 0.25, -8.0), v(8.0, 0.25, -8.0), v(8.0, 0.25, 8.0), v(-8.0, 0.25, 8.0)];
    cases.push(lit_by_polygon("square of 16 x 16 at 1/4", Vec3::ZERO, Vec3::Y, &near));
    for d in [0.25f32, 1.0, 8.0] {
        let disc = round(Vec3::Y * d, Vec3::X, Vec3::Z, 64);
        // pi R^2 / (R^2 + d^2) of the circle, to 0.2 %.
        cases.push(lit_by_polygon(&format!("disc of radius 1 (64 corners) at {d}"), Vec3::ZERO, Vec3::Y, &disc));
    }
    let disc = round(v(1.0, 1.5, 0.5), v(0.8, 0.6, 0.0), Vec3::Z, 64);
    cases.push(lit_by_polygon("disc, aside and tilted", Vec3::ZERO, Vec3::Y, &disc));
    cases.push(lit_by_sphere("sphere of radius 1 (1280 triangles), 2 above", Vec3::Y * 2.0));
    cases.push(lit_by_sphere("sphere, 60 degrees from the normal", v(3.4640625, 2.0, 0.0)));
    cases.push(lit_by_sphere("sphere, partly below the horizon", v(2.0, 0.25, 0.0)));

    // Lit spheres.
    let name = "sphere lit from behind the sensor (infinity)";
    cases.push(lit_sphere(name, "E cos, face by face", infinite(-Vec3::Z, 1.0)));
    let name = "sphere lit at a phase of 90 degrees (infinity)";
    cases.push(lit_sphere(name, "E cos, face by face", infinite(-Vec3::X, 1.0)));
    let name = "sphere lit by a point, 2 from its middle";
    cases.push(lit_sphere(name, "I times solid angles", point(v(1.2, 0.0, 1.6), 1.0)));
    cases
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is expected of triangles is close to the closed forms of what they stand for.
    #[test]
    fn triangles_stand_for_discs_and_spheres() {
        for d in [0.25f32, 1.0, 8.0] {
            let disc = round(Vec3::Y * d, Vec3::X, Vec3::Z, 64);
            let found = polygon(DVec3::ZERO, DVec3::Y, &widen(&disc));
            let circle = PI / (1.0 + f64::from(d * d));
            assert!((found / circle - 1.0).abs() < 2e-3, "{d}: {found} {circle}");
        }
        let ball = faces(&icosphere(3), Vec3::Y * 2.0);
        let found = polyhedron(DVec3::ZERO, DVec3::Y, &ball);
        assert!((found / (PI / 4.0) - 1.0).abs() < 1e-2, "{found}");
        // Lambert's sphere: 2/3 of the radiance of a disc facing the light; at the phase a: (sin a + (pi - a) cos a) / pi of that.
        let full = lit_sphere("", "", infinite(-Vec3::Z, 1.0)).expected;
        let sphere = f64::from(ALBEDO) / PI * 2.0 / 3.0 * PI / 4.0;
        assert!((full / sphere - 1.0).abs() < 1e-2, "{full} {sphere}");
        let side = lit_sphere("", "", infinite(-Vec3::X, 1.0)).expected;
        assert!((side / (sphere / PI) - 1.0).abs() < 1e-2, "{side}");
        // All the light of a point outside: I times the solid angle of the sphere.
        let lamp = DVec3::new(1.2, 0.0, 1.6);
        let lit = |face: &&[DVec3; 3]| (face[1] - face[0]).cross(face[2] - face[0]).dot(lamp - face[0]) > 0.0;
        let all: f64 = faces(&icosphere(3), Vec3::ZERO).iter().filter(lit).map(|face| solid_angle(lamp, *face)).sum();
        assert!((all / (2.0 * PI * (1.0 - 0.75f64.sqrt())) - 1.0).abs() < 1e-2, "{all}");
    }
}
