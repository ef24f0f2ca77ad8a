//! Brushed metal, from round lobes to scratches: who finds the light, and whether any is lost or made.

use crate::Workbench;
use crate::stability::judge::everywhere;
use crate::stability::light::within;
use crate::stability::plate::{METHODS, Plates, Step};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{NOISY_VARIANCE, Worse, stretch};
use glam::Vec3;
use luminaire::Result;
use std::f32::consts::FRAC_1_SQRT_2;

/// The sweep over the ratio of the widths.
pub const DEFINITION: Definition = Definition {
    name: "anisotropy",
    family: Family::Light,
    title: "widths of a brushed plate's microfacets, 1 : 1 to 1e4 : 1: a white metal under an even sky, and a dark dielectric that mirrors a small, a middling and a large lamp",
    run,
};

/// How the white plate is seen.
const EYES: [(&str, Vec3); 3] = [
    (" seen along", Vec3::new(0.8, 0.6, 0.0)),
    (" seen across", Vec3::new(0.0, 0.6, 0.8)),
    (" seen between", Vec3::new(0.8 * FRAC_1_SQRT_2, 0.6, 0.8 * FRAC_1_SQRT_2)),
];

fn run(bench: &Workbench) -> Result<Sweep> {
    let (ratios, samples) = match bench.long {
        false => (vec![1.0, 3.0, 10.0, 100.0, 1e3, 1e4], 1 << 15),
        true => (vec![1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4], 1 << 18),
    };
    sweep(bench, &ratios, samples)
}

/// The sweep over some ratios of the widths, the larger of which is 1, with so many samples a point.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, ratios: &[f64], samples: u32) -> Result<Sweep> {
    let step = |&x: &f64| Step { x, roughness: (1.0 / x).sqrt() as f32, anisotropy: 1.0 };
    let steps: Vec<_> = ratios.iter().map(step).collect();
    let plates = Plates::new(bench, &steps, &EYES, samples)?;
    let verdicts = plates.verdicts(Worse::Upwards);
    let range = stretch(ratios.iter().copied(), Worse::Upwards, ": 1");
    let summary = everywhere(&verdicts, METHODS[0], "Surfaces may be brushed as much as the file says.");
    let findings = findings(&plates);
    Ok(Sweep { charts: plates.charts("width along over width across"), range, verdicts, summary, findings })
}

fn findings(plates: &Plates) -> Findings {
    let [least, most] = plates.white();
    Findings {
        starts: format!(
            "Of three lamps and an even sky the worst counts; a sample varies by more than ten times its mean (variance above {NOISY_VARIANCE}), or light is missing \
             or too much:"
        ),
        how: format!(
            "The light of lamps is {}, by the formulas of Trowbridge and Reitz and of Smith. What microfacets send to each other is a table of both widths and of the direction. \
             The white metal sends out {least:.3} to {most:.3} of an even sky.",
            within(plates.off_lamps()),
        ),
        mends: format!(
            "Visible normals are stretched as the lobe is, and weighted against points on lamps: with roulette a sample varies by at most {:.2} times the squared mean. {}",
            plates.noisiest(0),
            plates.tally.sentence(),
        ),
        sees: "Streaks that are as long and as bright as they should be, with even noise.".into(),
    }
}
