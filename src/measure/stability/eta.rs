//! Glass of all indices of refraction.

use super::geometry::{COMPUTE_BVH, Worse, add, chart, describe, name_of};
use super::glass::{AroundGlass, around_glass, glass};
use super::{Definition, Findings, Sweep};
use crate::Result;
use crate::backend::Backend;
use crate::gpu::probe::{Call, Function};
use crate::measure::Workbench;
use crate::measure::chart::{Axis, Point};
use crate::measure::rays::Random;
use crate::reference::impulse::{fresnel, refract};
use crate::scene::build::{add as add_mesh, cube, empty, icosphere};
use glam::{Affine3A, DVec3, Vec3};

/// The sweep.
pub const DEFINITION: Definition = Definition { name: "eta", title: "Glass with an index of refraction of 1.0001 to 4", run };

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
    let mut direction =
        chart("direction", "Refracted direction in single precision, largest error over all angles", x(), "error in radians");
    let mut furnace =
        chart("furnace", "A glass ball in white light from everywhere: off from white", x(), "difference of the mean from 1");
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
            let outside = around_glass(bench, &mut ball, backend, 1000, samples, Vec3::Z * 3.0)?;
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
            for (side, eta) in [("from outside", eta), ("from inside", 1.0 / eta)] {
                let eta = eta as f32;
                let wos = directions(f64::from(eta), angles);
                let calls: Vec<Call> = wos
                    .iter()
                    .map(|wo| [[wo.x.to_bits(), wo.y.to_bits(), wo.z.to_bits(), eta.to_bits()], [0; 4]])
                    .collect();
                let results = probe.call(Function::Refract, &calls)?;
                let (mut of_reflectance, mut of_direction) = (0.0f64, 0.0f64);
                for (wo, result) in wos.iter().zip(&results) {
                    let [dx, dy, dz, r] = result[0].map(|bits| f64::from(f32::from_bits(bits)));
                    let eta = f64::from(eta);
                    of_reflectance = of_reflectance.max((r - fresnel(eta, f64::from(wo.z))).abs());
                    let found = DVec3::new(dx, dy, dz);
                    if let Some(expected) = refract(wo.as_dvec3(), DVec3::Z, eta)
                        && found != DVec3::ZERO
                    {
                        of_direction = of_direction.max((found - expected.normalize()).length());
                    }
                }
                let method = format!("{COMPUTE_BVH}, {side}");
                add(&mut reflectance, &method, Point { x: at, y: of_reflectance, error: None });
                add(&mut direction, &method, Point { x: at, y: of_direction, error: None });
            }
        }
    }
    let charts = vec![reflectance, direction, furnace, longest, trapped];
    let findings = findings(&charts);
    Ok(Sweep { charts, findings })
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

fn findings(charts: &[crate::measure::chart::Chart]) -> Findings {
    let w = Worse::Upwards;
    Findings { starts: charts.iter().map(|c| describe(c, 0.0, w)).collect::<Vec<_>>().join("\n"), how: String::new(), mends: String::new(), sees: String::new() }
}
