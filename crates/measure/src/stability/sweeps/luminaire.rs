//! A lamp from so near that it fills the sky to so far that it is a point.

use crate::Workbench;
use crate::stability::lamp::{Found, farthest, highest, lit_by, measure, powers, samples, starts};
use crate::stability::light::within;
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, place, stretch};
use glam::Vec3;
use luminaire::Result;
use luminaire::scene::Scene;
use luminaire::scene::build::quad;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "luminaire",
    family: Family::Light,
    title: "distance of a square lamp above a floor, 1e-6 to 1e6 of its side",
    run: |bench| sweep(bench, &powers(bench, -6, 6), samples(bench)),
};

/// A lamp at a distance in its sides: 1e-6 is all but on the floor, 1e6 as small as a star. The camera is between the floor and the lamp,
/// which does not hang symmetrically.
fn scene(distance: f64) -> (Scene, f64) {
    let distance = distance as f32;
    let near = distance.min(1.0);
    let lamp = quad(Vec3::new(-0.4, distance, -0.3), Vec3::X, Vec3::Z);
    lit_by(Vec3::new(0.25 * near, 0.5 * near, near), lamp)
}

/// The sweep over some distances in ascending order, with so many samples each.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, distances: &[f64], samples: u32) -> Result<Sweep> {
    let found = measure(bench, (distances, samples), Worse::Upwards, scene)?;
    let range = stretch(distances.iter().copied(), Worse::Upwards, "sides away");
    let (verdicts, findings) = (found.verdicts.clone(), findings(&found));
    let summary = of_nearest(&verdicts[0]);
    let charts = found.charts("distance / side of the lamp", "of a lamp near and far");
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// How near a lamp may be by the defaults.
fn of_nearest(default: &Verdict) -> String {
    // From there on to the far end everything is safe.
    default.safe_end().map_or("Not safe at the far end of the range.".into(), |safe| {
        format!("Hang no lamp nearer to a surface than {} of its side.", place(safe.from))
    })
}

fn findings(Found { fireflies, shares, gpu, tally, .. }: &Found) -> Findings {
    let default = gpu.iter().skip(1).step_by(2);
    let lost = default.flat_map(|s| &s.points).filter(|p| p.y < 0.95).map(|p| p.x).reduce(f64::max);
    Findings {
        starts: starts(),
        how: format!(
            "Sampled by area alone, a lamp at a small distance is all in the few points straight above, whose inverse square is not bounded: a \
             sample of up to {:.0e} times the mean where they are met, and darkness where not. Chance finds near lamps at once and far \
             ones never. {} Nearer than a few millionths of the \
             floor's own size that is the rounding of single precision: a ray starts off its surface by as much, and so behind the lamp.",
            highest(&fireflies[1]),
            lost.map_or("The GPU finds the light at every distance.".into(), |x| format!("The GPU loses light at {x:.0e} and nearer.")),
        ),
        mends: format!(
            "By solid angle where the lamp is near, by area where it is far, and MIS over both: its largest sample is {:.1} times the \
             mean, and the light, held against Lambert's formula, is {} on the CPU everywhere, and {} on the GPU from 1e-5 on. {}",
            highest(&fireflies[4]),
            within(farthest([&shares[4]], 0.0..=1e9)),
            within(farthest(gpu.iter().skip(1).step_by(2), 9e-6..=1e9)),
            tally.sentence(),
        ),
        sees: "With `area_sampling = \"area\"` and light sampling alone, fireflies and dark spots where a lamp nearly touches a wall. With \
               the defaults nothing at the distances that are safe."
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::verdict::Judgement::{Safe, Wrong};

    #[test]
    fn the_nearest_lamp_has_no_worse_one_beyond() {
        let of = |judged: &[_]| of_nearest(&Verdict::new("", judged.iter().copied(), Worse::Upwards, ""));
        let island = [(1e-3, Safe), (1e-2, Wrong), (0.1, Safe), (1.0, Safe)];
        assert_eq!(of(&island), "Hang no lamp nearer to a surface than 0.1 of its side.");
        assert_eq!(of(&island[..2]), "Not safe at the far end of the range.");
    }
}
