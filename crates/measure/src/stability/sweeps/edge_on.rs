//! A lamp seen from its edge.

use crate::Workbench;
use crate::stability::judge::everywhere;
use crate::stability::lamp::{DEFAULT, Found, farthest, highest, lit_by, measure, powers, samples, starts};
use crate::stability::light::within;
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::Vec3;
use luminaire::Result;
use luminaire::scene::Scene;
use luminaire::scene::build::quad;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "edge-on",
    family: Family::Light,
    title: "sine of the angle between a lamp's plane and the direction to it, 1 to 1e-5",
    run: |bench| sweep(bench, &powers(bench, -5, 0), samples(bench)),
};

/// A lamp by the sine of the angle between its plane and the direction to its middle: at 0 its edge is seen.
fn scene(sine: f64) -> (Scene, f64) {
    let along = Vec3::new(sine as f32, (1.0 - sine * sine).sqrt() as f32, 0.0) * 0.5;
    lit_by(Vec3::new(0.3, 0.5, 0.8), quad(Vec3::Y - 0.5 * along - 0.2 * Vec3::Z, along, 0.5 * Vec3::Z))
}

/// The sweep over some sines in ascending order, with so many samples each.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, sines: &[f64], samples: u32) -> Result<Sweep> {
    let found = measure(bench, (sines, samples), Worse::Downwards, scene)?;
    let range = stretch(sines.iter().copied(), Worse::Downwards, "(sine)");
    let (verdicts, findings) = (found.verdicts.clone(), findings(&found));
    let advice = "The defaults find the light of a lamp at every tilt; chance alone soon loses it.";
    let summary = everywhere(&verdicts, DEFAULT, advice);
    let x = "sine of the angle between the lamp's plane and the direction to it";
    let charts = found.charts(x, "of a lamp seen edge-on");
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

fn findings(Found { fireflies, shares, gpu, tally, .. }: &Found) -> Findings {
    Findings {
        starts: starts(),
        how: "A lamp seen from its edge takes up less of the sky, in proportion to the sine: chance meets it as much more rarely. \
              Sampling its area is not disturbed, because the same cosine makes every sample as much fainter."
            .into(),
        mends: format!(
            "A triangle of less than a thousandth of a steradian is sampled by area even where it is near, because solid angles cancel. \
             The largest sample of the default is {:.1} times the mean, and the light, held against Lambert's formula, is {} on the \
             CPU and {} on the GPU at every sine. {}",
            highest(&fireflies[4]),
            within(farthest([&shares[4]], 0.0..=2.0)),
            within(farthest(gpu, 0.0..=2.0)),
            tally.sentence(),
        ),
        sees: "With the defaults nothing; without light sampling, fireflies in the light of screens and panels that are seen from the side."
            .into(),
    }
}
