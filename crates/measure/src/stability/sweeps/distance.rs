//! How far from the origin a scene may lie.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::random::Random;
use crate::stability::geometry::{
    COMPUTE_BVH, RAY_QUERY, Stand, T_MIN, add, baked, chart, decades, distance_error, lost, named, per_million, placed,
    rays_to_faces, rays_to_features, value,
};
use crate::stability::judge::{geometric, safe_until, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::scene::build::icosphere;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "distance",
    family: Family::Geometry,
    title: "Distance of the scene from the origin, 0.1 to 1e7 of its size",
    run,
};

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(-1, 7, bench), 30_000)
}

/// The sweep over some distances with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, distances: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("distance from the origin in sizes of the body");
    let million = "rays a million";
    let mut charts = Vec::new();
    for way in ["vertices", "instance"] {
        let mut lost_chart =
            chart(&format!("lost-{way}"), &format!("Rays lost by a closed body, placed by its {way}"), x(), million);
        let mut error = chart(
            &format!("error-{way}"),
            &format!("99.9th percentile of the hits' error along the ray, placed by its {way}"),
            x(),
            "error in sizes of the body",
        );
        let mut self_hits = chart(
            &format!("self-hits-{way}"),
            &format!("Rays that meet the triangle that they leave, placed by its {way}"),
            x(),
            million,
        );
        let mut escapes = chart(
            &format!("escapes-{way}"),
            &format!("Rays that leave a face inwards and get out, placed by its {way}"),
            x(),
            million,
        );
        for &distance in distances {
            let mut random = Random::new(21);
            // One unit across, in a direction along which no coordinate is special.
            let shift = Vec3::new(0.8, -0.5, 0.33).normalize() * distance as f32;
            let map = Affine3A::from_translation(shift)
                * Affine3A::from_rotation_x(0.3)
                * Affine3A::from_rotation_z(0.7)
                * Affine3A::from_scale(Vec3::splat(0.5));
            let scene = if way == "vertices" { baked(icosphere(3), map) } else { placed(icosphere(3), map) };
            let inner = map * Affine3A::from_scale(Vec3::splat(0.4));
            let rays = rays_to_features(&scene, inner, rays, &mut random);
            let stand = Stand::new(bench, &scene)?;
            let hits = stand.hits(&rays, way == "vertices")?;
            let n = rays.len();
            for (name, found) in &hits {
                add(&mut lost_chart, name, per_million(distance, lost(found), n));
            }
            for (name, found) in &hits[1..] {
                add(&mut error, name, Point { x: distance, y: distance_error(found, &hits[0].1), error: None });
            }
            let inwards = rays_to_faces(&scene, inner, n, &mut random);
            for departures in stand.leaves(&inwards, &[(T_MIN, 1e-4)])? {
                let [same, out] = departures.self_hits_and_escapes();
                add(&mut self_hits, departures.name, per_million(distance, same, n));
                add(&mut escapes, departures.name, per_million(distance, out, n));
            }
        }
        charts.extend([lost_chart, error, self_hits, escapes]);
    }
    let (errors, counts): (Vec<&Chart>, Vec<_>) = charts.iter().partition(|chart| chart.name.starts_with("error"));
    let verdicts = geometric(&counts, &errors, Worse::Upwards);
    let range = stretch(distances.iter().copied(), Worse::Upwards, "sizes from the origin");
    let summary =
        up_to(&verdicts, COMPUTE_BVH, |end| format!("Keep a scene within {end} of its own sizes from the origin."));
    let findings = findings(&charts, &verdicts);
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

fn findings(charts: &[Chart], verdicts: &[Verdict]) -> Findings {
    let fixed = safe_until(verdicts, T_MIN).map_or("from the start".into(), |end| format!("beyond {end} sizes"));
    let nothing = safe_until(verdicts, COMPUTE_BVH)
        .map_or(String::new(), |end| format!("By the compute BVH nothing up to {end} sizes. Beyond, "));
    let error = |way: &str, method: &str| value(named(charts, &format!("error-{way}")), method, 1e4);
    Findings {
        starts: String::new(),
        how: format!(
            "Single precision has 24 bits: 1e5 sizes from the origin a coordinate is good to 0.8 % of the size, at 1e7 the body \
             is one point. Corners that are placed there are rounded once, and the body stays closed as long as it has a volume; \
             hits on it stay good ({} of the size at 1e4). An instance keeps its shape, and the ray is taken into its space: as a matrix \
             and a translation, which cancel, that rounds by the distance ({} of the size at 1e4 by the ray query). A fixed smallest \
             distance does not grow with the rounding, which passes it {fixed}.",
            error("vertices", COMPUTE_BVH),
            error("instance", RAY_QUERY)
        ),
        mends: format!(
            "The boxes are padded by the largest coordinate, and a ray leaves a surface at the bound of its own rounding there. The compute BVH \
             takes a ray into an instance's space relative to the instance's origin ({} of the size at 1e4). What is left is the rounding of the hit \
             point itself, which may put it behind another face close by.",
            error("instance", COMPUTE_BVH)
        ),
        sees: format!(
            "{nothing}light leaks along edges and thin parts, first as single pixels; where the verdict is wrong, surfaces are visibly stepped. \
             Move the scene to the origin."
        ),
    }
}
