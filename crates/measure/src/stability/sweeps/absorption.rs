//! Bodies that absorb, from black to clear.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::closed_forms::formulas::reflectance;
use crate::stability::geometry::decades;
use crate::stability::judge::{everywhere, light};
use crate::stability::light::{Spot, Tally, chart, looking_from, off, series, within};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::scene::build::{add, cube};
use luminaire::scene::{Environment, Estimator, Extinction, Material, Physical, Scene};

/// The sweep over the length in which light is absorbed.
pub const DEFINITION: Definition = Definition {
    name: "absorption",
    family: Family::Light,
    title: "length of a body in which a share 1/e of the light is left, 1e-6 to 1e6 of its thickness, in white light",
    run,
};

/// How paths end.
const METHODS: [&str; 2] = ["with roulette", "without roulette"];
/// The bodies: all are plates of the thickness 1.
const BODIES: [&str; 3] = ["glass, index 1.5", "fog, index 1", "fog, seen from its middle"];
/// 1/e.
const LEFT: f32 = 0.367_879_44;
/// Towards the camera.
const EYE: Vec3 = Vec3::new(0.4, 1.0, 0.2);

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-6, 6, bench), if bench.long { 1 << 16 } else { 1 << 13 })
}

/// A body in white light, and the radiance that the camera sees.
fn plate(body: usize, length: f64) -> (Scene, f64) {
    let index = if body == 0 { 1.5 } else { 1.0 };
    let inside = body == 2;
    let eye = if inside { EYE * 0.25 } else { EYE * 4.0 };
    let mut scene = looking_from(eye);
    let physical = Physical {
        roughness: 0.0,
        ior: index as f32,
        transmission: 1.0,
        attenuation_color: Vec3::splat(LEFT),
        attenuation_distance: length as f32,
        ..Physical::default()
    };
    // Twice as deep as the camera sees it, in all directions: the origin is at its upper face, or in its middle.
    let middle = if inside { Vec3::ZERO } else { Vec3::Y * -0.5 };
    let place = Affine3A::from_translation(middle) * Affine3A::from_scale(Vec3::new(1e3, 0.5, 1e3));
    add(&mut scene, cube(), Material { physical: Some(physical.clone()), ..Material::default() }, place);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    let towards: DVec3 = eye.as_dvec3().normalize();
    let angle = towards.y.acos();
    let refracted = (angle.sin() / index).asin();
    // From the middle of the plate the camera, which is a quarter above it, looks down through the rest.
    let depth = if inside { 0.25 * f64::from(EYE.y) + 0.5 } else { 1.0 };
    let passed = (-physical.absorption().x * depth / refracted.cos()).exp();
    let f = reflectance(index, angle);
    // What is reflected, and what comes through after any number of reflections between the faces, from above and from below.
    (scene, f + (1.0 - f) * (1.0 - f) * passed / (1.0 - f * passed))
}

/// The sweep over some lengths, with so many samples a point.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, lengths: &[f64], samples: u32) -> Result<Sweep> {
    let backends = bench.backends();
    let mut tally = Tally::default();
    let names = |method: &str| -> Vec<Series> {
        series(BODIES.iter().flat_map(|body| backends.iter().map(move |b| format!("{body}, {method}, {b}"))))
    };
    let mut found = METHODS.map(names);
    let mut variances = METHODS.map(names);
    for &length in lengths {
        for body in 0..BODIES.len() {
            let (scene, truth) = plate(body, length);
            for (method, extinction) in [Extinction::Throughput, Extinction::Off].into_iter().enumerate() {
                let estimator = Estimator { extinction, max_bounces: Some(64), ..Estimator::default() };
                for (index, &backend) in backends.iter().enumerate() {
                    let spot = Spot::new(bench, backend, &scene, estimator, samples)?;
                    tally.add(&spot);
                    // Of the white light, because there may be nothing else.
                    let line = body * backends.len() + index;
                    let error = (spot.variance > 0.0).then_some(spot.mean.error);
                    found[method][line].points.push(Point { x: length, y: 1.0 + spot.mean.mean - truth, error });
                    variances[method][line].points.push(Point { x: length, y: spot.variance, error: None });
                }
            }
        }
    }
    let verdicts: Vec<_> = (0..METHODS.len())
        .map(|method| {
            let variances: Vec<_> = variances[method].iter().collect();
            light(METHODS[method], &variances, &found[method].iter().collect::<Vec<_>>(), Worse::Downwards)
        })
        .collect();
    let range = stretch(lengths.iter().copied(), Worse::Downwards, "of the thickness");
    let summary = everywhere(&verdicts, METHODS[0], "Bodies may be as clear or as dense as they like.");
    let farthest = found.iter().flatten().map(|s| off(s, 0.0..=f64::INFINITY)).fold(0.0, f64::max);
    let findings = Findings {
        starts: "Differences from what is expected, over the white light:".into(),
        how: format!(
            "Not at all: the light is {} on every backend. A dense body is black, but for what its surface reflects; a clear one lets all through.",
            within(farthest)
        ),
        mends: format!(
            "What a length of the body lets through is one exponential of the length between two surfaces. The camera may be inside. {}",
            tally.sentence()
        ),
        sees: "Glass that goes from black to clear. A length that is far from the size of the body means that its unit is not that of the scene.".into(),
    };
    let energy = found.into_iter().flatten().collect();
    let axis = Axis::linear("1 + light found - truth");
    let title = "Light through a plate that absorbs, in white light of radiance 1";
    let charts = vec![chart("energy", title, "length of absorption over the thickness", axis, energy)];
    Ok(Sweep { charts, range, verdicts, summary, findings })
}
