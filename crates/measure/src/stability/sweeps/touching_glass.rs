//! Bodies of glass that touch, or nearly.

use crate::Workbench;
use crate::chart::{Axis, Point};
use crate::report::table::Table;
use crate::stability::geometry::{COMPUTE_BVH, REFERENCE, add, chart, decades, name_of};
use crate::stability::glass::{around_glass, glass};
use crate::stability::judge::{geometric, safe_until, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::scene::Scene;
use luminaire::scene::build::{add as add_mesh, cube, empty, icosphere};

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "touching-glass",
    family: Family::Geometry,
    title: "Bodies of glass, 0.1 to 1e-8 of their size apart",
    run,
};

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-8, -1, bench), 16)
}

/// Two cubes of glass side by side, turned.
fn side_by_side(gap: f64) -> Scene {
    let mut scene = empty(32, 32);
    let turned = Affine3A::from_rotation_x(0.3) * Affine3A::from_rotation_y(0.7);
    let half = Affine3A::from_scale(Vec3::splat(0.5));
    add_mesh(&mut scene, cube(), glass(1.5), turned * Affine3A::from_translation(Vec3::X * -0.5) * half);
    let right = Affine3A::from_translation(Vec3::X * (0.5 + gap as f32));
    add_mesh(&mut scene, cube(), glass(1.5), turned * right * half);
    scene
}

/// A ball of water in a ball of glass.
fn nested(gap: f64) -> Scene {
    let mut scene = empty(32, 32);
    let turned = Affine3A::from_rotation_x(0.3);
    add_mesh(&mut scene, icosphere(2), glass(1.5), turned);
    // Water, seen from the glass.
    let inner = turned * Affine3A::from_scale(Vec3::splat((1.0 - gap) as f32));
    add_mesh(&mut scene, icosphere(2), glass(1.33 / 1.5), inner);
    scene
}

/// Builds a scene with a gap.
type SceneOfGap = fn(f64) -> Scene;

/// The sweep over some gaps with so many samples a pixel.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, gaps: &[f64], samples: u32) -> Result<Sweep> {
    let x = || Axis::log("gap in sizes of the bodies");
    let mut charts = Vec::new();
    let mut touching = Vec::new();
    let scenes: [(&str, &str, SceneOfGap); 2] = [
        ("side-by-side", "Two cubes of glass side by side in white light", side_by_side),
        ("nested", "A ball of water in a ball of glass in white light", nested),
    ];
    for (name, words, scene) in scenes {
        let mut chart = chart(name, &format!("{words}: off from white"), x(), "difference of the mean from 1");
        for &gap in gaps {
            for backend in bench.backends() {
                let seen = around_glass(bench, &mut scene(gap), backend, 1000, samples, Vec3::new(0.5, 0.3, 3.0))?;
                let y = (seen.mean - 1.0).abs();
                add(&mut chart, name_of(backend), Point { x: gap, y, error: Some(seen.error) });
            }
        }
        for backend in bench.backends() {
            let seen = around_glass(bench, &mut scene(0.0), backend, 1000, samples, Vec3::new(0.5, 0.3, 3.0))?;
            touching.push((words, name_of(backend), seen.mean));
        }
        charts.push(chart);
    }
    let verdicts = geometric(&[], &charts.iter().collect::<Vec<_>>(), Worse::Downwards);
    let range = stretch(gaps.iter().copied(), Worse::Downwards, "of the size");
    let summary = up_to(&verdicts, COMPUTE_BVH, |end| {
        format!("Leave a gap of at least {end} of the size between bodies of glass.")
    });
    Ok(Sweep { charts, range, summary, findings: findings(&touching, &verdicts), verdicts })
}

fn findings(touching: &[(&str, &str, f64)], verdicts: &[Verdict]) -> Findings {
    let row =
        |(scene, method, mean): &(&str, &str, f64)| vec![scene.to_string(), method.to_string(), format!("{mean:.4}")];
    let touching = Table::new(["bodies", "method", "mean"]).with_rows(touching.iter().map(row)).markdown();
    let until = |method: &str, words: fn(String) -> String| safe_until(verdicts, method).map_or(String::new(), words);
    Findings {
        starts: format!("With no gap at all, where a mean of 1 is right:\n\n{touching}\nWith a gap:"),
        how: format!(
            "Of two surfaces in one place a ray meets one, leaves it by its rounding bound, and is past the other. It then takes itself to be outside of a body \
             in which it is, and the factors of the squared index (2.25 for glass) no longer cancel: such a path brings too much light, or too little. In \
             double precision the same happens to corners that are given in single precision{}.",
            until(REFERENCE, |end| format!(", in gaps narrower than {end}"))
        ),
        mends: format!(
            "The bound is some units in the last place of the size{}. Where faces of glass coincide with others, or nearly (nearer than rays tell apart, as after \
             the rounding of files, or overlapping by up to 1e-4 of the size of their triangles), the loader draws their body in by that and a hair, so that a \
             mean of 1 is what users see; this sweep leaves that out. luminaire has no priorities of nested media.",
            until(COMPUTE_BVH, |end| format!(", so that gaps of {end} and more are safe"))
        ),
        sees: format!(
            "In scenes that are loaded, a hair of air between glass and what it touches; a warning says so. Bodies that are too thin to be drawn in stay, and a \
             warning says that, too; finely cut faces that overlap by more than their file rounds may stay without one. There, and in scenes built in code, glass that touches is too bright or too dark in patches: call `Scene::part_touching_glass`{}. Where there is no air between, as between a liquid and \
             its glass, model the common face once, with the ratio of both indices.",
            safe_until(verdicts, COMPUTE_BVH)
                .map_or(String::new(), |end| format!(", or leave a gap of {end} of the size"))
        ),
    }
}
