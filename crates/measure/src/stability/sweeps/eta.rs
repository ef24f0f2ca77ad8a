//! Glass of all indices of refraction.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::random::Random;
use crate::stability::geometry::{COMPUTE_BVH, REFERENCE, add, chart, name_of, named, value};
use crate::stability::glass::{AroundGlass, around_glass, glass};
use crate::stability::judge::{everywhere, geometric};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::gpu::probe::{Call, Function};
use luminaire::reference::impulse::{fresnel, refract};
use luminaire::scene::build::{add as add_mesh, cube, empty, icosphere};

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "eta",
    family: Family::Geometry,
    title: "Glass with an index of refraction of 4 to 1.0001",
    run,
};

const BY_SINE_OUTSIDE: &str = "f32 by the sine, from outside";
const BY_SINE_INSIDE: &str = "f32 by the sine, from inside";

fn run(bench: &Workbench) -> Result<Sweep> {
    let mut etas = vec![1.0001, 1.001, 1.01, 1.1, 1.33, 1.5, 2.0, 2.4, 4.0];
    if bench.long {
        etas.extend([1.0003, 1.003, 1.03, 1.2, 1.4, 1.7, 3.0]);
        etas.sort_by(f64::total_cmp);
    }
    sweep(bench, &etas, 40_000, 16)
}

/// The sweep over some indices, with so many angles each, and pictures of so many samples a pixel.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, etas: &[f64], angles: usize, samples: u32) -> Result<Sweep> {
    let x = || Axis::log("index of refraction, minus 1");
    let mut reflectance = chart(
        "reflectance",
        "Fresnel's reflectance in single precision, largest error over all angles",
        x(),
        "error of the reflectance",
    );
    let mut direction = chart(
        "direction",
        "Refracted direction in single precision, largest error over all angles",
        x(),
        "error in radians",
    );
    let mut furnace = chart(
        "furnace",
        "A glass ball in white light from everywhere: off from white",
        x(),
        "difference of the mean from 1",
    );
    let mut longest = chart("longest", "Longest path through a glass ball", x(), "rays");
    let mut trapped = chart(
        "trapped",
        "Light that never leaves a glass cube, of all that starts inside (1000 bounces)",
        x(),
        "share of the paths",
    );
    for &eta in etas {
        let eta = f64::from(eta as f32);
        let at = eta - 1.0;
        let mut ball = empty(32, 32);
        add_mesh(&mut ball, icosphere(2), glass(eta), Affine3A::from_rotation_x(0.3));
        let mut inside = empty(32, 32);
        add_mesh(&mut inside, cube(), glass(eta), Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_z(0.7));
        for backend in bench.backends() {
            let name = name_of(backend);
            let outside = around_glass(bench, &mut ball, backend, 10_000, samples, Vec3::Z * 3.0)?;
            add(&mut furnace, name, Point { x: at, y: (outside.mean - 1.0).abs(), error: Some(outside.error) });
            add(&mut longest, name, Point { x: at, y: f64::from(outside.longest), error: None });
            let AroundGlass { ended, .. } =
                around_glass(bench, &mut inside, backend, 1000, samples.min(4), Vec3::new(0.1, 0.2, 0.3))?;
            let n = f64::from(32 * 32 * samples.min(4));
            let share = 1.0 - ended;
            add(&mut trapped, name, Point { x: at, y: share, error: Some((share * ended / n).sqrt()) });
        }
        if bench.backends().contains(&Backend::ComputeBvh) {
            let probe = bench.probe(&ball, Backend::ComputeBvh)?;
            let sides = [("from outside", BY_SINE_OUTSIDE, eta), ("from inside", BY_SINE_INSIDE, 1.0 / eta)];
            for (side, by_sine, eta) in sides {
                let eta = eta as f32;
                let wos = directions(f64::from(eta), angles);
                let calls: Vec<Call> = wos
                    .iter()
                    .map(|wo| [[wo.x.to_bits(), wo.y.to_bits(), wo.z.to_bits(), eta.to_bits()], [0; 4]])
                    .collect();
                let results = probe.call(Function::Refract, &calls)?;
                let (mut of_reflectance, mut of_direction, mut of_sine) = (0.0f64, 0.0f64, 0.0f64);
                for (wo, result) in wos.iter().zip(&results) {
                    let [dx, dy, dz, r] = result[0].map(|bits| f64::from(f32::from_bits(bits)));
                    let sine = f64::from(fresnel_by_sine(eta, wo.z));
                    let eta = f64::from(eta);
                    let expected = fresnel(eta, f64::from(wo.z));
                    of_reflectance = of_reflectance.max((r - expected).abs());
                    of_sine = of_sine.max((sine - expected).abs());
                    let found = DVec3::new(dx, dy, dz);
                    if let Some(expected) = refract(wo.as_dvec3(), DVec3::Z, eta)
                        && found != DVec3::ZERO
                    {
                        of_direction = of_direction.max((found - expected.normalize()).length());
                    }
                }
                let method = format!("{COMPUTE_BVH}, {side}");
                add(&mut reflectance, by_sine, Point { x: at, y: of_sine, error: None });
                add(&mut reflectance, &method, Point { x: at, y: of_reflectance, error: None });
                add(&mut direction, &method, Point { x: at, y: of_direction, error: None });
            }
        }
    }
    let charts = vec![reflectance, direction, furnace, longest, trapped];
    // The axis is the index less 1, by which it is hard; the page has the index.
    let by_index: Vec<Chart> = charts[..3].iter().cloned().map(index_itself).collect();
    // Indices near 1 are the hard ones.
    let mut verdicts = geometric(&[], &[&by_index[2]], Worse::Downwards);
    verdicts.extend(geometric(&[], &[&by_index[0], &by_index[1]], Worse::Downwards));
    let range = stretch(etas.iter().copied(), Worse::Downwards, "(index)");
    let summary = everywhere(
        &verdicts,
        COMPUTE_BVH,
        "Any index is safe; light that starts inside of glass may never leave: limit the bounces.",
    );
    let findings = findings(&charts);
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// The same chart over the index, not over the index less 1.
fn index_itself(mut chart: Chart) -> Chart {
    chart.series.iter_mut().flat_map(|series| &mut series.points).for_each(|point| point.x += 1.0);
    chart
}

/// Directions over +z: even in the angle, and crowded at grazing and at the critical angle.
fn directions(eta: f64, n: usize) -> Vec<Vec3> {
    let mut random = Random::new(28);
    let critical = (1.0 - eta * eta).max(0.0).sqrt();
    let cosine = |i: usize| {
        let tiny = 10f64.powf(random.between(-7.0, -1.0)) * if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        match i % 3 {
            0 => random.between(0.0, std::f64::consts::FRAC_PI_2).cos(),
            1 => tiny.abs(),
            _ => (critical + tiny).abs(),
        }
    };
    let cosines: Vec<f64> = (0..n).map(cosine).collect();
    cosines.iter().map(|c| Vec3::new((1.0 - c * c).max(0.0).sqrt() as f32, 0.0, c.min(1.0) as f32)).collect()
}

/// Fresnel's reflectance in single precision, the refracted cosine by way of the sine: as textbooks have it.
fn fresnel_by_sine(eta: f32, cos_i: f32) -> f32 {
    let sine2 = (1.0 - cos_i * cos_i) / (eta * eta);
    if sine2 >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sine2).sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

fn findings(charts: &[Chart]) -> Findings {
    let at = |chart: &str, method: &str, x: f64| value(named(charts, chart), method, x);
    let inside = format!("{COMPUTE_BVH}, from inside");
    Findings {
        starts: format!(
            "Of the light that starts inside a cube, in the directions of the picture, {} never leaves at an index of 1.5 (reference: {}). \
             Energy, and below it Fresnel's formulas by themselves:",
            at("trapped", COMPUTE_BVH, 0.5),
            at("trapped", REFERENCE, 0.5)
        ),
        how: format!(
            "Near the critical angle the refracted cosine is the root of a small difference, which doubles the share of the digits that are lost; for an index of \
             1.0001 that angle is so near to grazing that hardly any digit is left of 1 - sin^2 (error of the reflectance {} by the sine, {} as the kernel has it). \
             No energy is gained or lost by that: what is not reflected is transmitted. A glass body that stands in its own way keeps light: total internal reflection between parallel faces never ends, \
             and a path takes {} rays to get out of a ball of index 4.",
            at("reflectance", BY_SINE_INSIDE, 1e-4),
            at("reflectance", &inside, 1e-4),
            at("longest", COMPUTE_BVH, 3.0)
        ),
        mends: "The cosine is computed as (eta - 1)(eta + 1) + cos^2, which has no such difference where the index is nearly 1. Light that \
             passes a surface is divided by the square of the index, and multiplied by it on the way out: exactly 1. Extinction ends one path \
             in 10 000 at each bounce, so that trapped light ends."
            .into(),
        sees: "Nothing in the picture. Scenes in which much light is inside of glass bodies (luminaires cast in glass) take long: limit the bounces."
            .into(),
    }
}
