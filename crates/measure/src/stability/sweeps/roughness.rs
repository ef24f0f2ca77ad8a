//! Microfacets from rough to a mirror: who finds the light, and whether any is lost or made.

use crate::Workbench;
use crate::stability::judge::everywhere;
use crate::stability::light::within;
use crate::stability::plate::{METHODS, Plates, Step};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{NOISY_VARIANCE, Worse, stretch};
use glam::Vec3;
use luminaire::Result;

/// The sweep over the roughness.
pub const DEFINITION: Definition = Definition {
    name: "roughness",
    family: Family::Light,
    title: "roughness of a metallic-roughness plate, 1 to 1e-6: a white metal under an even sky, and a dark dielectric that mirrors a small, a middling and a large lamp",
    run,
};

/// How the white plate is seen: steep and grazing.
const EYES: [(&str, Vec3); 2] = [("", Vec3::new(0.8, 0.6, 0.0)), (" at grazing", Vec3::new(1.0, 0.05, 0.0))];

fn run(bench: &Workbench) -> Result<Sweep> {
    let mut roughnesses = vec![1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.0101, 0.0099, 1e-3, 1e-4, 1e-5, 1e-6];
    if bench.long {
        roughnesses.extend([0.7, 0.3, 0.15, 0.03, 0.015, 0.005]);
        roughnesses.sort_by(|a: &f32, b| b.total_cmp(a));
    }
    sweep(bench, &roughnesses, if bench.long { 1 << 17 } else { 1 << 14 })
}

/// The sweep over some roughnesses, with so many samples a point.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, roughnesses: &[f32], samples: u32) -> Result<Sweep> {
    let steps: Vec<_> =
        roughnesses.iter().map(|&roughness| Step { x: roughness.into(), roughness, anisotropy: 0.0 }).collect();
    let plates = Plates::new(bench, &steps, &EYES, samples)?;
    let verdicts = plates.verdicts(Worse::Downwards);
    let range = stretch(steps.iter().map(|step| step.x), Worse::Downwards, "(roughness)");
    let summary = everywhere(&verdicts, METHODS[0], "Any roughness is safe: the defaults find every highlight.");
    let findings = findings(&plates);
    Ok(Sweep { charts: plates.charts("perceptual roughness"), range, verdicts, summary, findings })
}

fn findings(plates: &Plates) -> Findings {
    let [least, most] = plates.white();
    Findings {
        starts: format!(
            "Of three lamps the worst counts; a sample varies by more than ten times its mean (variance above {NOISY_VARIANCE}), or light is missing:"
        ),
        how: format!(
            "By noise, not by bias: a narrow lobe is rarely met by a point on a lamp or by a direction that ignores it, a small lamp rarely by a direction of a \
             wide lobe. Below a roughness of 0.01 the surface is a mirror: no point of a lamp is worth anything there, and light sampling alone finds \
             nothing. Where the mirror begins, it shows all of a small lamp, of which the narrowest lobe spreads a share past its edge: 0.3 % of a lamp of 0.006 of its distance. The white metal sends out {least:.4} to {most:.4} of an even sky, from roughness 1 to the mirror, steeply and 3 degrees above the \
             horizon, chance included."
        ),
        mends: format!(
            "Visible normals and points on lamps, weighted against each other: with roulette a sample varies by at most {:.2} times the squared mean. What \
             microfacets send to each other is given back. On every backend the light of the lamps, held against the formulas of Trowbridge and Reitz and of Smith, \
             is {}. {}",
            plates.noisiest(0),
            within(plates.off_lamps()),
            plates.tally.sentence(),
        ),
        sees: "With the defaults, even noise at every roughness and no visible step where the mirror begins. With `--light-sampling direct` highlights that grow grainy and then \
               are gone, with `none` fireflies of small lamps on rough surfaces, with cosine directions no highlights at all."
            .into(),
    }
}
