//! What the geometric sweeps share: the methods side by side, counts of failures as points, and charts in words.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point, Series};
use crate::intersect_f32::{Test, Triangles};
use crate::random::Random;
use crate::rays::{Ray, probe_hits, reference_hits, reference_leaves};
use crate::report::words::number;
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::gpu::probe::{Function, Probe};
use luminaire::reference::Reference;
use luminaire::reference::hit::Hit;
use luminaire::scene::{Mesh, Scene, build};

/// The reference, as a method.
pub(super) const REFERENCE: &str = "f64 reference";
/// The kernel on the compute BVH, as a method.
pub(super) const COMPUTE_BVH: &str = "compute BVH";
/// The kernel on the driver's ray queries, as a method.
pub(super) const RAY_QUERY: &str = "ray query";
/// A model, in boxes that lose nothing, so that what is lost is lost by the triangle test.
pub(super) const MOELLER_TRUMBORE: &str = "f32 Möller-Trumbore";
/// The fixed smallest distance that renderers without a bound on their errors use, on a model that loses nothing else.
pub(super) const T_MIN: &str = "f32 watertight, t_min 1e-4";
/// A model whose triangle test loses nothing, so that what is lost is lost by the boxes.
pub(super) const BARE_BOXES: &str = "f32 watertight, boxes not padded";

/// What the kernel's backends are called in charts.
pub(super) fn name_of(backend: Backend) -> &'static str {
    match backend {
        Backend::Cpu => REFERENCE,
        Backend::ComputeBvh => COMPUTE_BVH,
        Backend::RayQuery => RAY_QUERY,
    }
}

/// What each method says that each ray meets.
pub(super) type Answers = Vec<(&'static str, Vec<Option<Hit>>)>;

/// Every method with one scene. The reference comes first.
pub(super) struct Stand {
    reference: Reference,
    probes: Vec<(&'static str, Probe)>,
    moeller_trumbore: Triangles,
    bare_boxes: Triangles,
    watertight: Triangles,
}

impl Stand {
    /// Opens every backend of the bench with a scene.
    pub(super) fn new(bench: &Workbench, scene: &Scene) -> Result<Self> {
        let gpu = bench.backends().into_iter().filter(|backend| *backend != Backend::Cpu);
        let open = |backend| Ok((name_of(backend), bench.probe(scene, backend)?));
        Ok(Stand {
            reference: Reference::new(scene),
            probes: gpu.map(open).collect::<Result<_>>()?,
            moeller_trumbore: Triangles::new(scene, Test::MoellerTrumbore { epsilon: 0.0 }, true),
            bare_boxes: Triangles::new(scene, Test::Watertight, false),
            watertight: Triangles::new(scene, Test::Watertight, true),
        })
    }

    /// The closest hits: of the reference, of the kernel, and with `models` those of the `f32` models.
    pub(super) fn hits(&self, rays: &[Ray], models: bool) -> Result<Answers> {
        let mut answers = vec![(REFERENCE, reference_hits(&self.reference, rays))];
        for (name, probe) in &self.probes {
            answers.push((name, probe_hits(probe, Function::ClosestHit, rays)?));
        }
        if models {
            answers.push((MOELLER_TRUMBORE, self.moeller_trumbore.hits(rays, 0.0)));
            answers.push((BARE_BOXES, self.bare_boxes.hits(rays, 0.0)));
        }
        Ok(answers)
    }

    /// What the rays meet first, and after they were mirrored off that: by the reference, by the kernel, and with each of `fixed` as the
    /// smallest distance that keeps self-hits off.
    pub(super) fn leaves(&self, rays: &[Ray], fixed: &[(&'static str, f32)]) -> Result<Vec<Departures>> {
        let mut all = vec![Departures {
            name: REFERENCE,
            first: reference_hits(&self.reference, rays),
            second: reference_leaves(&self.reference, rays),
        }];
        for (name, probe) in &self.probes {
            let hits = |function| probe_hits(probe, function, rays);
            all.push(Departures { name, first: hits(Function::ClosestHit)?, second: hits(Function::Leave)? });
        }
        if !fixed.is_empty() {
            let first = self.watertight.hits(rays, 0.0);
            all.extend(fixed.iter().map(|&(name, t_min)| Departures {
                name,
                first: first.clone(),
                second: self.watertight.leaves(rays, t_min),
            }));
        }
        Ok(all)
    }
}

/// What rays meet that are mirrored off a surface.
pub(super) struct Departures {
    /// The method.
    pub(super) name: &'static str,
    /// The hits from which they leave.
    pub(super) first: Vec<Option<Hit>>,
    /// What they meet then.
    pub(super) second: Vec<Option<Hit>>,
}

impl Departures {
    /// Rays whose second hit is the triangle that they left, and those that meet nothing although the first ray met something.
    pub(super) fn self_hits_and_escapes(&self) -> [usize; 2] {
        let pairs = || self.first.iter().zip(&self.second);
        let same = |(f, s): &(&Option<Hit>, &Option<Hit>)| matches!((f, s), (Some(f), Some(s)) if (f.object, f.triangle) == (s.object, s.triangle));
        [pairs().filter(same).count(), pairs().filter(|(f, s)| f.is_some() && s.is_none()).count()]
    }
}

/// A scene of one mesh, placed by an instance transform.
pub(super) fn placed(mesh: Mesh, map: Affine3A) -> Scene {
    let mut scene = build::empty(1, 1);
    build::add(&mut scene, mesh, build::matte(Vec3::ZERO), map);
    scene
}

/// The same, placed by its vertices: they are moved and rounded, and triangles that lose their area are dropped, as the loader does.
pub(super) fn baked(mut mesh: Mesh, map: Affine3A) -> Scene {
    mesh.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
    let at = |v: u32| mesh.positions[v as usize].as_dvec3();
    mesh.triangles.retain(|t| {
        let [a, b, c] = t.vertices.map(at);
        (b - a).cross(c - a) != DVec3::ZERO
    });
    let mut scene = placed(mesh, Affine3A::IDENTITY);
    // Without a material of its own the object needs no instance.
    scene.objects[0].material = None;
    scene
}

/// Rays to points on the first object's faces, edges and vertices, a third each, from points that `from` maps from the cube from -1 to 1.
pub(super) fn rays_to_features(scene: &Scene, from: Affine3A, n: usize, random: &mut Random) -> Vec<Ray> {
    rays_to(scene, from, n, random, |[a, b, c], i, random| match i % 3 {
        0 => a,
        1 => a.lerp(b, random.uniform() as f32),
        _ => {
            let (u, v) = (random.uniform() as f32, random.uniform() as f32);
            a + (b - a) * u.min(v) + (c - a) * (1.0 - u.max(v))
        }
    })
}

/// Rays to points inside the first object's triangles, from points that `from` maps from the cube from -1 to 1: what leaves an edge of less than 90 degrees
/// may start behind the other face, however little it is moved.
pub(super) fn rays_to_faces(scene: &Scene, from: Affine3A, n: usize, random: &mut Random) -> Vec<Ray> {
    rays_to(scene, from, n, random, |[a, b, c], _, random| {
        let (u, v) = (random.uniform() as f32, random.uniform() as f32);
        a + (b - a) * u.min(v) + (c - a) * (1.0 - u.max(v))
    })
}

/// Rays to points of the first object's triangles: `target` of corners and count.
pub(super) fn rays_to(
    scene: &Scene,
    from: Affine3A,
    n: usize,
    random: &mut Random,
    target: impl Fn([Vec3; 3], usize, &mut Random) -> Vec3,
) -> Vec<Ray> {
    let object = &scene.objects[0];
    let mesh = &scene.meshes[object.mesh as usize];
    let ray = |i: usize| {
        let triangle = mesh.triangles[random.below(mesh.triangles.len())];
        let corners = triangle.vertices.map(|v| mesh.positions[v as usize]);
        let to = object.object_to_world.transform_point3(target(corners, i, random));
        Ray::through(from.transform_point3(random.in_cube()), to)
    };
    (0..n).map(ray).collect()
}

/// A share as a point: `count` of `of`, as a number per million.
pub(super) fn per_million(x: f64, count: usize, of: usize) -> Point {
    let million = 1e6 / of as f64;
    // None found does not mean that there is none.
    Point { x, y: count as f64 * million, error: Some((count.max(1) as f64).sqrt() * million) }
}

/// Rays that meet nothing.
pub(super) fn lost(hits: &[Option<Hit>]) -> usize {
    hits.iter().filter(|hit| hit.is_none()).count()
}

/// The 99.9th percentile of how far hits are from the reference's along unit rays, over both finding something.
pub(super) fn distance_error(hits: &[Option<Hit>], expected: &[Option<Hit>]) -> f64 {
    let both = hits.iter().zip(expected).filter_map(|(h, e)| Some((h.as_ref()?.t - e.as_ref()?.t).abs()));
    percentile_999(both)
}

/// The 99.9th percentile; NaN of nothing.
pub(super) fn percentile_999(errors: impl Iterator<Item = f64>) -> f64 {
    let mut errors: Vec<f64> = errors.collect();
    errors.sort_by(f64::total_cmp);
    errors.len().checked_sub(1).map_or(f64::NAN, |last| errors[last - last / 1000])
}

/// An empty chart.
pub(super) fn chart(name: &str, title: &str, x: Axis, y: &str) -> Chart {
    Chart { name: name.into(), title: title.into(), x, y: Axis::log(y), series: vec![] }
}

/// Adds a point to the line of a method.
pub(super) fn add(chart: &mut Chart, method: &str, point: Point) {
    match chart.series.iter_mut().find(|series| series.name == method) {
        Some(series) => series.points.push(point),
        None => chart.series.push(Series { name: method.into(), points: vec![point] }),
    }
}

/// Powers of ten from `first` to `last`, upwards or downwards, every third of one where there is time.
pub(super) fn decades(first: i32, last: i32, bench: &Workbench) -> Vec<f64> {
    let steps = if bench.long { 3 } else { 1 };
    let exponents = first.min(last) * steps..=first.max(last) * steps;
    exponents.map(|e| 10f64.powf(f64::from(e) / f64::from(steps))).collect()
}

/// The chart of a name.
pub(super) fn named<'a>(charts: &'a [Chart], name: &str) -> &'a Chart {
    charts.iter().find(|chart| chart.name == name).expect("the sweep has made this chart")
}

/// The value of a method nearest to some `x`, in words; "not measured" where it did not run.
pub(super) fn value(chart: &Chart, method: &str, x: f64) -> String {
    let off = |p: &&Point| (p.x / x).ln().abs();
    let points = chart.series.iter().filter(|series| series.name == method).flat_map(|series| &series.points);
    points.min_by(|a, b| off(a).total_cmp(&off(b))).map_or("not measured".into(), |point| number(point.y))
}
