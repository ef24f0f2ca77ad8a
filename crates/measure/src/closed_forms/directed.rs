//! Direct light that has a shape in direction: spots, discs at infinity, photometric profiles.

use super::case::{BOUND, Case, View};
use super::luminaires::{ALBEDO, look_along, plane};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::scene::build::{add, matte, quad};
use luminaire::scene::{Luminaire, Profile};
use std::f64::consts::PI;

const SUBJECT: &str = "direct light by its direction";

/// A spot of the intensity 2 that shines down.
fn spot(position: Vec3, inner: f32, outer: f32) -> Luminaire {
    Luminaire::Spot { position, direction: -Vec3::Y, intensity: Vec3::splat(2.0), inner, outer }
}

/// A disc of the irradiance 2, at an angle from the zenith.
fn sun(zenith: f64, angle: f32) -> Luminaire {
    let (sine, cosine) = zenith.to_radians().sin_cos();
    let direction = DVec3::new(-sine, -cosine, 0.0).as_vec3();
    Luminaire::Sun { direction, irradiance: Vec3::splat(2.0), angle }
}

/// A lamp at a point that hangs as it was measured, with these candelas by angle, the same all around or for 0, 90, 180, 270, 360 degrees.
fn photometric(position: Vec3, vertical: Vec<f32>, candela: Vec<f32>) -> Luminaire {
    let even = candela.len() == vertical.len();
    let horizontal = if even { vec![0.0] } else { vec![0.0, 90.0, 180.0, 270.0, 360.0] };
    let profile = Profile { name: "lamp".into(), vertical, horizontal, candela }.into();
    Luminaire::Photometric { position, direction: -Vec3::Y, up: Vec3::X, intensity: Vec3::ONE, profile }
}

/// A luminaire over a plane, seen at the origin.
fn lit_by(luminaire: Luminaire) -> View {
    let mut view = plane(Vec3::ZERO, Vec3::Y);
    view.scene.luminaires.push(luminaire);
    view
}

/// A disc whose middle is on the horizon, of a radius in radians: half of it lights a level plane, with this over its radiance (half the integral of
/// `w x dw` along its rim and along the horizon).
fn half_disc(radius: f64) -> f64 {
    radius - radius.sin() * radius.cos()
}

/// A disc in the zenith behind a half-plane whose edge, seen from a point, is at the angle `edge` from the zenith; what of it lights a level plane there, over its
/// radiance (the same integral along rim and edge).
fn behind_edge(radius: f64, edge: f64) -> f64 {
    let limit = (-edge.tan() / radius.tan()).clamp(-1.0, 1.0).acos();
    limit * radius.sin().powi(2) + edge.sin() * (radius.sin() * limit.sin()).asin()
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut certain = |name: String, formula, expected, luminaire, bound| {
        cases.push(Case::certain(SUBJECT, name, formula, expected, lit_by(luminaire), bound));
    };
    for (inner, outer) in [(0.0f32, 90.0f32), (20.0, 40.0), (30.0, 30.0), (0.005, 0.01)] {
        let name = format!("spot of {inner} to {outer} degrees, on its axis");
        certain(name, "I / d^2", 2.0 / 9.0, spot(Vec3::Y * 3.0, inner, outer), BOUND);
    }
    // Aside by the tangent of the angle.
    for (degrees, inner, outer, bound) in [
        (10.0f64, 20.0f32, 40.0f32, BOUND),
        (30.0, 20.0, 40.0, 2e-5),
        (38.0, 20.0, 40.0, 2e-5),
        (60.0, 0.0, 90.0, 2e-6),
    ] {
        let angle = degrees.to_radians();
        let place = Vec3::new((3.0 * angle.tan()) as f32, 3.0, 0.0);
        let [from, to] = [inner, outer].map(|edge| f64::from(edge).to_radians().cos());
        let falloff = ((angle.cos() - to) / (from - to)).clamp(0.0, 1.0).powi(2);
        let name = format!("spot of {inner} to {outer} degrees, {degrees} from its axis");
        let formula = "I cos / d^2, times the squared share of the edge in cosines";
        certain(name, formula, 2.0 * falloff * angle.cos().powi(3) / 9.0, spot(place, inner, outer), bound);
    }
    let even = photometric(Vec3::new(1.0, 3.0, 0.0), vec![0.0, 180.0], vec![2.0; 2]);
    certain(
        "profile that is the same everywhere".into(),
        "as a point: I cos / d^2",
        6.0 / 10f64.powf(1.5),
        even,
        BOUND,
    );
    let degrees: Vec<f32> = (0..=18).map(|i| 5.0 * i as f32).collect();
    let cosines: Vec<f32> =
        degrees.iter().map(|degrees| (2.0 * f64::from(*degrees).to_radians().cos()) as f32).collect();
    let lambert = photometric(Vec3::new(3.0, 3.0, 0.0), degrees, cosines);
    certain(
        "profile that is a cosine, 45 degrees from its axis".into(),
        "I cos^2 / d^2",
        2.0 * 0.5 / 18.0,
        lambert,
        2e-6,
    );
    // Candelas that rise by 1 a degree; a plane's point at 30 degrees, in five directions around.
    let rows = [90.0f32, 0.0, 30.0, 60.0, 90.0].iter().flat_map(|most| [0.0, *most]).collect::<Vec<f32>>();
    for (around, most) in [(0.0f64, 90.0), (45.0, 45.0), (80.0, 10.0), (135.0, 15.0), (240.0, 50.0), (315.0, 75.0)] {
        let angle = 30f64.to_radians();
        // Counter-clockwise from above: from +x to -z. The lamp is on the other side of what it lights.
        let (sine, cosine) = around.to_radians().sin_cos();
        let place = DVec3::new(-angle.tan() * cosine, 1.0, angle.tan() * sine).as_vec3();
        let lamp = photometric(place, vec![0.0, 90.0], rows.clone());
        let name = format!("profile of four sides, 30 degrees from its axis, {around} around");
        let (bound, expected) = (1e-5, most / 3.0 * angle.cos().powi(3));
        certain(name, "I cos^3 / h^2, bilinear by angles", expected, lamp, bound);
    }

    for (inner, outer) in [(20.0f32, 40.0f32), (1.0, 50.0), (30.0, 30.0)] {
        let mut view = lit_by(spot(Vec3::Y * 1.5, inner, outer));
        look_along(&mut view.scene, Vec3::Y * 0.25, -Vec3::Y, 4.0);
        view.weight *= 16.0;
        let [from, to] = [inner, outer].map(|edge| 1.0 - f64::from(edge).to_radians().cos());
        let expected = 2.0 * 2.0 * PI * (from + (to - from) / 3.0);
        let name = format!("flux of a spot of {inner} to {outer} degrees");
        cases.push(Case::estimated(
            SUBJECT,
            name,
            "2 pi I (a + (b - a) / 3), a and b being 1 - cos",
            expected,
            vec![view],
        ));
    }

    for (zenith, angle) in [(0.0, 1e-4f32), (0.0, 0.53), (60.0, 0.53), (60.0, 50.0), (20.0, 120.0), (0.0, 180.0)] {
        let name = format!("disc of {angle} degrees, {zenith} from the zenith");
        let expected = 2.0 * f64::to_radians(zenith).cos();
        cases.push(Case::estimated(SUBJECT, name, "E cos", expected, vec![lit_by(sun(zenith, angle))]));
    }
    for angle in [10.0f32, 90.0] {
        let radius = f64::from(0.5 * angle).to_radians();
        let expected = 2.0 / (PI * radius.sin().powi(2)) * half_disc(radius);
        let name = format!("disc of {angle} degrees on the horizon");
        cases.push(Case::estimated(SUBJECT, name, "L (r - sin r cos r)", expected, vec![lit_by(sun(90.0, angle))]));
    }
    for edge in [-5.0f64, -2.5, 0.0, 2.5, 5.0] {
        let mut view = lit_by(sun(0.0, 20.0));
        let end = (-edge.to_radians().tan()) as f32;
        let screen = quad(Vec3::new(end - 8.0, 1.0, -8.0), Vec3::X * 8.0, Vec3::Z * 16.0);
        add(&mut view.scene, screen, matte(Vec3::ZERO), Affine3A::IDENTITY);
        let radius = 10f64.to_radians();
        let expected = 2.0 / (PI * radius.sin().powi(2)) * behind_edge(radius, edge.to_radians());
        let name = format!("disc of 20 degrees in the zenith, a screen's edge {edge} degrees beyond its middle");
        cases.push(Case::estimated(SUBJECT, name, "L (t sin^2 r + sin a asin(sin r sin t))", expected, vec![view]));
    }
    let mut view = lit_by(sun(0.0, 30.0));
    view.scene.luminaires.extend([sun(10.0, 40.0), sun(60.0, 0.0)]);
    let expected = 2.0 + 2.0 * 10f64.to_radians().cos() + 1.0;
    cases.push(Case::estimated(
        SUBJECT,
        "two discs that overlap, and infinity".into(),
        "their sum",
        expected,
        vec![view],
    ));
    // Seen: by a mirror, which light sampling does not see, and by the camera.
    let mut view = lit_by(sun(0.0, 60.0));
    view.scene.materials[0].lambert = Vec3::ZERO;
    view.scene.materials[0].reflection = Vec3::splat(ALBEDO);
    view.weight = 1.0;
    view.scene.sensor.position = Vec3::Y / 16.0;
    view.scene.sensor.up = Vec3::X;
    let radiance = 2.0 / (PI * 0.25);
    let (name, formula) = ("disc of 60 degrees by a mirror", "R E / (pi sin^2 r)");
    cases.push(Case::certain(SUBJECT, name.into(), formula, 0.5 * radiance, view, BOUND));
    cases
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Against the integral of the cosine over the part of the disc.
    #[test]
    fn parts_of_discs() {
        let lit = |radius: f64, tilt: f64, visible: &dyn Fn(DVec3) -> bool| {
            const N: u32 = 1000;
            let unit = |i: u32| (f64::from(i) + 0.5) / f64::from(N);
            let all = (0..N).flat_map(|i| (0..N).map(move |j| (unit(i), 2.0 * PI * unit(j))));
            let (whole, (sin, cos)) = (1.0 - radius.cos(), tilt.sin_cos());
            let sum: f64 = all
                .map(|(share, around)| {
                    let z = 1.0 - share * whole;
                    let s = (1.0 - z * z).sqrt();
                    let (x, y) = (s * around.cos(), s * around.sin());
                    // Turned about z.
                    let w = DVec3::new(cos * x + sin * z, cos * z - sin * x, y);
                    if visible(w) { w.y.max(0.0) } else { 0.0 }
                })
                .sum();
            sum * 2.0 * PI * whole / f64::from(N * N)
        };
        for radius in [0.1, 0.7, FRAC_PI_2] {
            let found = lit(radius, FRAC_PI_2, &|_| true);
            assert!((found / half_disc(radius) - 1.0).abs() < 2e-3, "{radius}: {found} {}", half_disc(radius));
            for edge in [-2.0, -0.05, 0.0, 0.04, 2.0].map(|edge: f64| edge * radius.min(0.7)) {
                let plane = DVec3::new(edge.cos(), edge.sin(), 0.0);
                let found = lit(radius, 0.0, &|w| w.dot(plane) > 0.0);
                let expected = behind_edge(radius, edge);
                assert!((found - expected).abs() < 2e-3 * radius * radius, "{radius}, {edge}: {found} {expected}");
            }
        }
    }
}
