//! Triangles that are long and narrow, that have no area, or that lie on each other.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::random::Random;
use crate::rays::Ray;
use crate::report::table::Table;
use crate::stability::geometry::{
    BARE_BOXES, COMPUTE_BVH, Departures, RAY_QUERY, Stand, T_MIN, add, baked, chart, decades, lost, named, per_million,
    percentile_999, rays_to_faces, rays_to_features, value,
};
use crate::stability::judge::{geometric, off_from, safe_until, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Verdict, Worse, place, stretch};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::reference::hit::Hit;
use luminaire::scene::build::{icosphere, mesh};
use luminaire::scene::{Mesh, Scene, Triangle};

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "slivers",
    family: Family::Geometry,
    title: "Triangles 1 to 1e8 times as long as they are wide",
    run,
};

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(0, 8, bench), 40_000)
}

/// Quads side by side that are cut into two slivers each.
const SLIVERS: u32 = 64;

/// A floor at y = 0, x from -0.5 to 0.5, whose middle is a strip of slivers of length 1 and some width along z; wide quads that share the strip's
/// long edges make the rest, so that a ray which misses a sliver has lost its way.
fn floor(width: f64) -> Mesh {
    let half = f64::from(SLIVERS / 2);
    let mut lines: Vec<f64> = (0..=SLIVERS).map(|i| (f64::from(i) - half) * width).collect();
    lines.insert(0, -half * width - 1.0);
    lines.push(half * width + 1.0);
    let positions = lines.iter().flat_map(|&z| [Vec3::new(-0.5, 0.0, z as f32), Vec3::new(0.5, 0.0, z as f32)]);
    let quads = (0..lines.len() as u32 - 1).map(|i| 2 * i);
    let triangles: Vec<_> = quads.flat_map(|a| [[a, a + 2, a + 3], [a, a + 3, a + 1]]).collect();
    mesh(positions.collect(), &triangles)
}

/// The sweep over some aspects (length over width) with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, aspects: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("length over width of the triangles");
    let million = "rays a million";
    let turned = Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3))
        * Affine3A::from_rotation_x(0.3)
        * Affine3A::from_rotation_z(0.7);
    let level = Affine3A::from_translation(Vec3::Y * 0.3);
    let mut charts = Vec::new();
    for (name, words, map) in [("level", "level", level), ("turned", "turned", turned)] {
        let title = format!("Rays that pass through a floor of slivers, {words}");
        let mut lost_chart = chart(&format!("lost-{name}"), &title, x(), million);
        let title = format!("Hits off by more than 1e-3 of the slivers' length, {words}");
        let mut wrong = chart(&format!("wrong-{name}"), &title, x(), million);
        let title = format!("99.9th percentile of how far hits slide along the floor, {words}");
        let mut slide = chart(&format!("slide-{name}"), &title, x(), "distance in lengths of the slivers");
        let title = format!("Rays that meet the floor which they leave, {words}");
        let mut self_hits = chart(&format!("self-hits-{name}"), &title, x(), million);
        for &aspect in aspects {
            let scene = baked(floor(1.0 / aspect), map);
            let stand = Stand::new(bench, &scene)?;
            let rays = rays_to_strip(map, 1.0 / aspect, rays);
            let hits = stand.hits(&rays, true)?;
            for (method, found) in &hits {
                add(&mut lost_chart, method, per_million(aspect, lost(found), rays.len()));
            }
            for (method, found) in &hits[1..] {
                let both = found.iter().zip(&hits[0].1).filter_map(|(f, e)| Some((f.as_ref()?, e.as_ref()?)));
                let count = both.filter(|(f, e)| (f.t - e.t).abs() > 1e-3).count();
                add(&mut wrong, method, per_million(aspect, count, rays.len()));
                let y = slide_error(&scene, found, &hits[0].1);
                add(&mut slide, method, Point { x: aspect, y, error: None });
            }
            for Departures { name, second, .. } in stand.leaves(&rays, &[(T_MIN, 1e-4)])? {
                // A floor is not met again, wherever on it.
                add(&mut self_hits, name, per_million(aspect, second.iter().flatten().count(), rays.len()));
            }
        }
        charts.extend([lost_chart, wrong, slide, self_hits]);
    }
    // How far hits slide is left out: it is seen in textures alone.
    let counts: Vec<_> = charts.iter().filter(|chart| !chart.name.starts_with("slide")).collect();
    let verdicts = geometric(&counts, &[], Worse::Upwards);
    let range = stretch(aspects.iter().copied(), Worse::Upwards, "times as long as wide");
    let summary = summary(&charts, &verdicts);
    let findings = findings(bench, &charts, &verdicts)?;
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// What to do about slivers.
fn summary(charts: &[Chart], verdicts: &[Verdict]) -> String {
    let slides = named(charts, "slide-turned").series.iter().find(|series| series.name == COMPUTE_BVH);
    let textures =
        slides.and_then(off_from).map_or(String::new(), |x| format!("; textures on them slide from {} on", place(x)));
    up_to(verdicts, COMPUTE_BVH, |end| format!("Triangles may be {end} times as long as wide{textures}."))
}

/// Rays from above to points of the strip: in its triangles, on their edges and on their corners.
fn rays_to_strip(map: Affine3A, width: f64, n: usize) -> Vec<Ray> {
    let mut random = Random::new(24);
    let half = f64::from(SLIVERS / 2);
    let ray = |i: usize| {
        let line = (random.below(SLIVERS as usize) as f64 - half) * width;
        let z = line + if i.is_multiple_of(2) { 0.0 } else { random.uniform() * width };
        let target = Vec3::new(random.between(-0.49, 0.49) as f32, 0.0, z as f32);
        let from = Vec3::new(
            random.between(-1.0, 1.0) as f32,
            random.between(0.3, 1.0) as f32,
            random.between(-1.0, 1.0) as f32,
        );
        Ray::through(map.transform_point3(from), map.transform_point3(target))
    };
    (0..n).map(ray).collect()
}

/// The 99.9th percentile of the distance between the points that the weights of the corners give, and those of the reference.
fn slide_error(scene: &Scene, hits: &[Option<Hit>], expected: &[Option<Hit>]) -> f64 {
    let point = |hit: &Hit| {
        let mesh = &scene.meshes[0];
        let [a, b, c] = mesh.triangles[hit.triangle as usize].vertices.map(|v| mesh.positions[v as usize].as_dvec3());
        let [v, w] = hit.barycentrics;
        a * (1.0 - v - w) + b * v + c * w
    };
    let pairs = hits.iter().zip(expected).filter_map(|(h, e)| Some((h.as_ref()?, e.as_ref()?)));
    percentile_999(pairs.map(|(h, e)| point(h).distance(point(e))))
}

/// A ball of whose triangles there are two each, with a third triangle on each edge whose corners are in line but for rounding.
fn doubled_ball() -> Mesh {
    let mut ball = icosphere(3);
    let triangles = ball.triangles.clone();
    ball.triangles.extend(&triangles);
    for triangle in &triangles {
        let [a, b, _] = triangle.vertices;
        let middle = 0.5 * (ball.positions[a as usize] + ball.positions[b as usize]);
        ball.positions.push(middle);
        ball.triangles.push(Triangle { vertices: [a, b, ball.positions.len() as u32 - 1], ..*triangle });
    }
    ball
}

/// What the methods make of that ball: rays lost, hits off by more than 1e-3, and rays that meet the place which they leave, as a table.
fn doubled(bench: &Workbench) -> Result<String> {
    let map = Affine3A::from_translation(Vec3::new(0.8, -0.5, 0.3)) * Affine3A::from_rotation_x(0.3);
    let scene = baked(doubled_ball(), map);
    let stand = Stand::new(bench, &scene)?;
    let mut random = Random::new(29);
    let inner = map * Affine3A::from_scale(Vec3::splat(0.4));
    let rays = rays_to_features(&scene, inner, 30_000, &mut random);
    let hits = stand.hits(&rays, true)?;
    let inwards = rays_to_faces(&scene, inner, 30_000, &mut random);
    let leaves = stand.leaves(&inwards, &[])?;
    let again = |method: &str| {
        let Departures { first, second, .. } = leaves.iter().find(|departures| departures.name == method)?;
        let pairs = first.iter().zip(second).filter_map(|(f, s)| Some((f.as_ref()?, s.as_ref()?)));
        let corners = |hit: &Hit| scene.meshes[0].triangles[hit.triangle as usize].vertices;
        Some(pairs.filter(|(f, s)| corners(f) == corners(s)).count())
    };
    let row = |(name, found): &(&str, Vec<Option<Hit>>)| {
        let off = found.iter().zip(&hits[0].1).filter_map(|(f, e)| Some((f.as_ref()?.t - e.as_ref()?.t).abs()));
        let off = off.filter(|off| *off > 1e-3).count();
        let again = again(name).map_or("–".into(), |count| count.to_string());
        vec![name.to_string(), lost(found).to_string(), off.to_string(), again]
    };
    let table =
        Table::new(["method", "lost", "wrong", "meet the place that they left"]).with_rows(hits.iter().map(row));
    Ok(format!(
        "In a ball whose triangles are all there twice, with triangles of no height on its edges, of {} rays:\n\n{}\nOn a floor of slivers, where how far hits \
         slide is left out of the verdicts, because it is seen in textures alone:",
        rays.len(),
        table.markdown()
    ))
}

fn findings(bench: &Workbench, charts: &[Chart], verdicts: &[Verdict]) -> Result<Findings> {
    let safe = safe_until(verdicts, COMPUTE_BVH);
    let wrong = |method: &str, aspect: f64| value(named(charts, "wrong-turned"), method, aspect);
    let slide = |method: &str, aspect: f64| value(named(charts, "slide-turned"), method, aspect);
    Ok(Findings {
        starts: doubled(bench)?,
        how: format!(
            "The areas from which the place in a triangle is computed are differences of products that are as large as its length squared: where it is \
             narrower than that difference is certain (1 : 1e5), the distance, taken from the areas as the watertight test's authors have it, is any \
             between those of the corners. Hits are then wrong ({} a million at 1 : 1e6), and a ray that leaves meets the triangle again. What \
             is lost is lost at the edges, of which slivers have more than other triangles.",
            wrong(BARE_BOXES, 1e6)
        ),
        mends: format!(
            "The compute BVH decides by the watertight test and takes the distance from the triangle's plane, whose normal is the product of its two shorter \
             edges ({} a million wrong at 1 : 1e6), unless the corners are in one line. The shading normal is that product too. Triangles of exactly no area are dropped \
             when a scene is loaded.",
            wrong(COMPUTE_BVH, 1e6)
        ),
        sees: format!(
            "{} But the place along a sliver is computed from the areas: hits, and textures with them, slide by {} of its \
             length at 1 : 1e4, {} at 1e5 and {} at 1e6 (ray query: {}). Where single precision cannot place the corners any more, the surface has folds.",
            safe.map_or("Leaks and spots.".into(), |end| format!(
                "By the compute BVH no leaks and no spots up to 1 : {end}, and some beyond."
            )),
            slide(COMPUTE_BVH, 1e4),
            slide(COMPUTE_BVH, 1e5),
            slide(COMPUTE_BVH, 1e6),
            slide(RAY_QUERY, 1e6)
        ),
    })
}
