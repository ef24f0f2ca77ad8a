//! Rough glass and metals whose index of refraction goes through 1.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::report::words::share;
use crate::stability::judge::{everywhere, light};
use crate::stability::light::{Spot, Tally, chart, looking_from, off, series};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{SURE, Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, icosphere, quad};
use luminaire::scene::{Environment, Estimator, Extinction, LightSampling, Material, Physical, Scene};

/// The sweep over the index.
pub const DEFINITION: Definition = Definition {
    name: "rough-index",
    family: Family::Light,
    title: "index of refraction of rough glass, 1.5 to 1, from outside and from inside; and of a metal, from 5 through 1 to 0.2",
    run,
};

/// The default, and paths alone.
const METHODS: [&str; 2] = ["both, with roulette", "BSDF sampling"];
/// A third method, if so: what the metal reflects.
const METAL: &str = "a smooth metal (index, not less 1)";
/// Roughnesses of the glass.
const ROUGHNESSES: [f32; 3] = [0.0, 0.15, 0.5];
/// Extinction coefficients of the metal.
const EXTINCTIONS: [f32; 3] = [0.0, 0.1, 3.0];

/// Which points.
pub struct Steps {
    /// Indices of the glass, in descending order.
    pub glass: Vec<f32>,
    /// Indices of the metal, in descending order.
    pub metal: Vec<f32>,
    /// Samples of a point.
    pub samples: u32,
}

fn run(bench: &Workbench) -> Result<Sweep> {
    let mut steps = Steps {
        glass: vec![1.5, 1.2, 1.1, 1.03, 1.01, 1.001, 1.0001, 1.0],
        metal: vec![5.0, 2.0, 1.1, 1.001, 1.0, 0.999, 0.9, 0.5, 0.2],
        samples: 1 << 14,
    };
    if bench.long {
        steps.glass.extend([1.4, 1.3, 1.05, 1.02, 1.003, 1.0003]);
        steps.glass.sort_by(|a, b| b.total_cmp(a));
        steps.samples *= 8;
    }
    sweep(bench, &steps)
}

/// A ball of glass in white light, seen from outside or from inside, and the radiance that the camera sees.
fn ball(index: f32, roughness: f32, inside: bool) -> (Scene, f64) {
    let mut scene = looking_from(if inside { Vec3::new(0.3, 0.2, 0.1) } else { Vec3::new(3.0, 1.0, 2.0) });
    let physical = Physical { roughness, ior: index, transmission: 1.0, ..Physical::default() };
    // Not seen straight.
    let aside = Affine3A::from_translation(Vec3::new(-0.3, 0.5, 0.1));
    add(&mut scene, icosphere(3), Material { physical: Some(physical), ..Material::default() }, aside);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    // Inside, light is denser by the square of the index.
    (scene, if inside { f64::from(index).powi(2) } else { 1.0 })
}

/// A smooth metal in white light, seen at 60 degrees, and its reflectance: Fresnel's formulas in complex numbers.
fn metal(eta: f32, k: f32) -> (Scene, f64) {
    let mut scene = looking_from(Vec3::new(3f32.sqrt(), 1.0, 0.0));
    let conductor = Some([Vec3::splat(eta), Vec3::splat(k)]);
    let physical = Physical { metallic: 1.0, roughness: 0.0, conductor, ..Physical::default() };
    let plate = quad(Vec3::new(-2.0, 0.0, -2.0), Vec3::Z * 4.0, Vec3::X * 4.0);
    add(&mut scene, plate, Material { physical: Some(physical), ..Material::default() }, Affine3A::IDENTITY);
    scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
    (scene, complex_reflectance([eta.into(), k.into()], 0.5))
}

/// Reflectance of unpolarised light by an index of `n + i k`.
fn complex_reflectance([n, k]: [f64; 2], cosine: f64) -> f64 {
    // The square of the index, and its product with the refracted cosine: the root of index^2 - sin^2.
    let square = [n * n - k * k, 2.0 * n * k];
    let [re, im] = [square[0] - (1.0 - cosine * cosine), square[1]];
    let size = re.hypot(im);
    let bent = [(0.5 * (size + re)).max(0.0).sqrt(), (0.5 * (size - re)).max(0.0).sqrt()];
    let ratio = |a: [f64; 2], b: [f64; 2]| {
        let (less, sum) = ((a[0] - b[0]).hypot(a[1] - b[1]), (a[0] + b[0]).hypot(a[1] + b[1]));
        (less / sum).powi(2)
    };
    let across = ratio([cosine, 0.0], bent);
    let along = ratio([square[0] * cosine, square[1] * cosine], bent);
    0.5 * (across + along)
}

/// The sweep over some indices.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, steps: &Steps) -> Result<Sweep> {
    let backends = bench.backends();
    let mut tally = Tally::default();
    let sides = [("from outside", false), ("from inside", true)];
    let names = |of: &[Backend]| -> Vec<Series> {
        let one = |(side, roughness): (&str, f32)| {
            of.iter().map(move |b| format!("roughness {roughness}, {side}, {b}")).collect::<Vec<_>>()
        };
        series(sides.iter().flat_map(|(side, _)| ROUGHNESSES.map(|r| (*side, r))).flat_map(one))
    };
    let mut found = [names(&backends), names(&[Backend::Cpu])];
    let mut noise = found.clone();
    let default = Estimator::default();
    let alone = Estimator {
        light_sampling: LightSampling::None,
        extinction: Extinction::Off,
        max_bounces: Some(200),
        ..default
    };
    for &index in &steps.glass {
        let mut line = [0, 0];
        for (_, inside) in sides {
            for roughness in ROUGHNESSES {
                let (scene, truth) = ball(index, roughness, inside);
                for (method, (estimator, of)) in
                    [(default, &backends[..]), (alone, &[Backend::Cpu])].into_iter().enumerate()
                {
                    for &backend in of {
                        let spot = Spot::new(bench, backend, &scene, estimator, steps.samples)?;
                        tally.add(&spot);
                        found[method][line[method]].points.push(spot.share(index.into(), truth));
                        noise[method][line[method]].points.push(spot.noise(index.into(), truth));
                        line[method] += 1;
                    }
                }
            }
        }
    }
    let mut reflected = series(EXTINCTIONS.iter().flat_map(|k| backends.iter().map(move |b| format!("k {k}, {b}"))));
    for &eta in &steps.metal {
        for (k, lines) in EXTINCTIONS.into_iter().zip(reflected.chunks_mut(backends.len())) {
            let (scene, truth) = metal(eta, k);
            for (line, &backend) in lines.iter_mut().zip(&backends) {
                let spot = Spot::new(bench, backend, &scene, alone, 512)?;
                tally.add(&spot);
                // Of the white light: the metal may reflect none.
                line.points.push(Point { x: eta.into(), y: 1.0 + spot.mean.mean - truth, error: None });
            }
        }
    }
    let mut verdicts: Vec<_> = METHODS
        .iter()
        .zip(&found)
        .zip(&noise)
        .map(|((method, found), noise)| {
            light(method, &noise.iter().collect::<Vec<_>>(), &found.iter().collect::<Vec<_>>(), Worse::Downwards)
        })
        .collect();
    verdicts.push(light(METAL, &[], &reflected.iter().collect::<Vec<_>>(), Worse::Downwards));
    let range = stretch(steps.glass.iter().map(|index| f64::from(*index)), Worse::Downwards, "(index)");
    let summary = everywhere(&verdicts, METHODS[0], "Any index is safe, from both sides.");
    let farthest = |all: &[Series]| all.iter().map(|s| off(s, 0.0..=f64::INFINITY)).fold(0.0, f64::max);
    let findings = Findings {
        starts: "White light that a ball of glass lets by; and, less what is expected, what a metal reflects of it:"
            .into(),
        how: format!(
            "What rough glass reflects and lets through is tabled over index, roughness and angle, so that nothing is lost; between the numbers of the table it is off. \
             The farthest that a ball is off, beyond {SURE} standard errors, is {}; the metal's reflectance is off by {}.",
            share(farthest(&found[0])),
            share(farthest(&reflected)),
        ),
        mends: format!(
            "Glass that hardly bends the light hardly spreads it: below a width of 1e-4 it goes straight on, and at an index of 1 all of it does. {}",
            tally.sentence()
        ),
        sees: "Nothing: a body fades out as its index goes to 1, whatever its roughness.".into(),
    };
    let minus_one = |mut line: Series| {
        line.points.iter_mut().for_each(|point| point.x -= 1.0);
        line
    };
    let energy = found.iter().flatten().cloned().map(minus_one).collect();
    let charts = vec![
        chart(
            "energy",
            "White light by way of a ball of rough glass, over the truth",
            "index of refraction, minus 1",
            Axis::linear("share found"),
            energy,
        ),
        chart(
            "metal",
            "Reflectance of a smooth metal at 60 degrees",
            "index of refraction",
            Axis::linear("1 + reflectance found - truth"),
            reflected,
        ),
    ];
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_forms::formulas::reflectance;

    /// Without extinction it is that of glass; straight, that of the textbook.
    #[test]
    fn complex_indices() {
        for eta in [1.5, 0.9, 1.0] {
            assert!((complex_reflectance([eta, 0.0], 0.5) - reflectance(eta, 0.5f64.acos())).abs() < 1e-12, "{eta}");
        }
        let (n, k) = (0.2f64, 3.9f64);
        let expected = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        assert!((complex_reflectance([n, k], 1.0) - expected).abs() < 1e-12);
    }
}
