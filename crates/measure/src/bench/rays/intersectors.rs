//! Ray query, compute BVH and reference on the same rays, by the kind of the rays and the size of the room.

use super::kinds::{Kind, RaySet, reference_result};
use crate::Workbench;
use crate::bench::definition::Progress;
use crate::bench::effort::Effort;
use crate::bench::meshes::{self, Room};
use crate::bench::rounds::Rounds;
use crate::bench::settings::Settings;
use crate::rays::Ray;
use glam::Vec3;
use luminaire::backend::Backend;
use luminaire::gpu::RayTracer;
use luminaire::gpu::bvh::{TwoLevelBvh, spatial_order};
use luminaire::reference::Reference;
use luminaire::scene::Scene;
use luminaire::{Error, Result};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// What is measured, and for how long.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Who traces; the reference, if it is among them, comes first.
    pub backends: Vec<Backend>,
    /// Triangles of the rooms of one mesh.
    pub triangles: Vec<u64>,
    /// Instances of the other rooms.
    pub instances: Vec<u64>,
    /// Rays of each kind: this squared; a multiple of 8.
    pub side: u32,
    /// How often everything is timed.
    pub rounds: usize,
    /// Seconds of one timing, about: the rays are traced as often as that takes.
    pub seconds: f64,
}

impl Plan {
    /// What suits a machine and the time that there is.
    pub fn new(bench: &Workbench, settings: &Settings) -> Self {
        let powers = |last: u32| (0..=last).map(|e| 10u64.pow(e));
        let (triangles, instances) = match settings.effort {
            Effort::Quick => (4, 2),
            Effort::Standard if bench.is_software() => (6, 5),
            _ => (7, 5),
        };
        Plan {
            backends: settings.backends.clone(),
            triangles: powers(triangles).skip(3).collect(),
            instances: powers(instances).collect(),
            // Traced many times in one dispatch, so that any GPU has enough of them in flight.
            side: if bench.is_software() { 128 } else { 512 },
            rounds: settings.rounds,
            seconds: if settings.effort == Effort::Long { 0.1 } else { 0.03 },
        }
    }
}

/// Of one intersector in one room.
#[derive(Debug, Clone)]
pub struct Intersector {
    /// Which.
    pub backend: Backend,
    /// Seconds to build what rays are traced against, and to upload it.
    pub build: Rounds,
    /// Seconds of that on the host before the driver sees anything: building the BVH, or sorting the triangles for the driver; none for the reference.
    pub host: Rounds,
    /// Bytes of device memory that the room holds; none for the reference.
    pub bytes: Option<u64>,
    /// Millions of rays a second, by the order of [`Kind::ALL`].
    pub rates: [Rounds; 4],
    /// Rays of each kind that do not meet what the reference says they meet.
    pub mismatches: [usize; 4],
}

/// What grows from room to room.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Triangles of one mesh.
    Triangles,
    /// Instances of a small mesh.
    Instances,
}

/// A room, and all that traced in it.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Its part of a figure's name.
    pub room: String,
    /// What grows.
    pub family: Family,
    /// How many triangles or instances.
    pub count: u64,
    /// Rays of each kind.
    pub rays: usize,
    /// The intersectors, by the order of [`Plan::backends`].
    pub intersectors: Vec<Intersector>,
    /// Who is missing, and why: sentences.
    pub left_out: Vec<String>,
}

impl Measured {
    /// One of its intersectors.
    pub fn by(&self, backend: Backend) -> Option<&Intersector> {
        self.intersectors.iter().find(|i| i.backend == backend)
    }
}

/// Most rays on which the reference is timed.
const REFERENCE_RAYS: usize = 1 << 16;
/// How often a room is built, unless that takes longer than [`LONG_BUILD`] seconds.
const BUILDS: usize = 3;
const LONG_BUILD: f64 = 1.0;
/// One ray in this number may meet something else than the reference says, because rounding decides at edges; more are an error.
const ONE_IN: usize = 1000;

/// Measures every room of a plan.
///
/// # Errors
/// If the driver fails, or an intersector does not find what the reference finds. A room that is too large for a device is only left out.
pub fn measure(bench: &Workbench, plan: &Plan, progress: Progress) -> Result<Vec<Measured>> {
    let mut all = Vec::new();
    // The first build of a driver compiles its own kernels.
    let first = meshes::one_mesh(1000);
    for backend in plan.backends.iter().filter(|b| **b != Backend::Cpu) {
        bench.ray_tracer(&first.scene, *backend, &[])?;
    }
    let rooms = plan.triangles.iter().map(|n| (Family::Triangles, *n));
    for (family, n) in rooms.chain(plan.instances.iter().map(|n| (Family::Instances, *n))) {
        let room = match family {
            Family::Triangles => meshes::one_mesh(n),
            Family::Instances => meshes::instances(n),
        };
        progress(&format!("rays in {}", room.name));
        all.push(measure_room(bench, plan, room, family)?);
    }
    Ok(all)
}

fn measure_room(bench: &Workbench, plan: &Plan, mut room: Room, family: Family) -> Result<Measured> {
    let side = plan.side.next_multiple_of(8);
    (room.scene.film.width, room.scene.film.height) = (side, side);
    let start = Instant::now();
    let reference = Reference::new(&room.scene);
    let reference_seconds = start.elapsed().as_secs_f64();
    let set = RaySet::new(&room, &reference, side);
    let count = match family {
        Family::Triangles => room.scene.triangle_count(),
        Family::Instances => room.scene.objects.len() as u64 - 1,
    };
    let mut measured = Measured {
        room: room.name.clone(),
        family,
        count,
        rays: set.len(),
        intersectors: Vec::new(),
        left_out: Vec::new(),
    };
    if plan.backends.contains(&Backend::Cpu) {
        measured
            .intersectors
            .push(Intersector { build: Rounds(vec![reference_seconds]), ..Intersector::new(Backend::Cpu) });
    }
    let mut tracers = build(bench, plan, &room, &set, &mut measured)?;
    let mut repeats = Vec::new();
    for (which, tracer) in &mut tracers {
        let here = &mut measured.intersectors[*which];
        here.mismatches = check(&room, here.backend, tracer, &set)?;
        repeats.push(calibrate(tracer, set.len(), plan.seconds)?);
    }
    for _ in 0..plan.rounds {
        for (k, kind) in Kind::ALL.into_iter().enumerate() {
            if plan.backends.contains(&Backend::Cpu) {
                let rate = reference_rate(&reference, kind, &set.rays[k]);
                measured.intersectors[0].rates[k].0.push(rate);
            }
            for ((which, tracer), repeats) in tracers.iter().zip(&repeats) {
                // A GPU that has just idled has to speed up again.
                if !bench.is_software() {
                    tracer.trace(range(k, set.len()), kind.any_hit(), repeats[k])?;
                }
                let seconds = tracer.trace(range(k, set.len()), kind.any_hit(), repeats[k])?;
                let rays = set.len() as f64 * f64::from(repeats[k]);
                measured.intersectors[*which].rates[k].0.push(rays / seconds * 1e-6);
            }
        }
    }
    Ok(measured)
}

impl Intersector {
    fn new(backend: Backend) -> Self {
        let empty = || Rounds::default();
        Intersector {
            backend,
            build: empty(),
            host: empty(),
            bytes: None,
            rates: [empty(), empty(), empty(), empty()],
            mismatches: [0; 4],
        }
    }
}

/// Builds the room on every device that has room for it, several times in turn. Gives the last of the tracers with their places in `measured`.
fn build(
    bench: &Workbench,
    plan: &Plan,
    room: &Room,
    set: &RaySet,
    measured: &mut Measured,
) -> Result<Vec<(usize, RayTracer)>> {
    let calls: Vec<_> = set.rays.iter().flatten().map(Ray::call).collect();
    let mut tracers: Vec<(usize, RayTracer)> = Vec::new();
    for backend in plan.backends.iter().filter(|b| **b != Backend::Cpu) {
        let tracer = match bench.ray_tracer(&room.scene, *backend, &calls) {
            Ok(tracer) => tracer,
            Err(error @ (Error::Limit { .. } | Error::Vulkan { call: "allocating memory", .. })) => {
                measured.left_out.push(format!("{} is left out on {backend}: {error}.", room.name));
                continue;
            }
            Err(error) => return Err(error),
        };
        let host = Rounds(vec![host_seconds(&room.scene, *backend)]);
        let bytes = Some(tracer.scene_bytes);
        let build = Rounds(vec![tracer.build_seconds]);
        tracers.push((measured.intersectors.len(), tracer));
        measured.intersectors.push(Intersector { build, host, bytes, ..Intersector::new(*backend) });
    }
    for _ in 1..BUILDS {
        for (which, tracer) in &tracers {
            if tracer.build_seconds <= LONG_BUILD {
                let here = &mut measured.intersectors[*which];
                here.build.0.push(bench.ray_tracer(&room.scene, here.backend, &[])?.build_seconds);
                here.host.0.push(host_seconds(&room.scene, here.backend));
            }
        }
    }
    Ok(tracers)
}

/// Seconds for what the host does before anything is uploaded: the BVH, or the order in which a driver gets triangles and objects.
fn host_seconds(scene: &Scene, backend: Backend) -> f64 {
    let start = Instant::now();
    if backend == Backend::ComputeBvh {
        TwoLevelBvh::build(scene, scene.objects.len() > 1);
    } else {
        for mesh in &scene.meshes {
            let centroid = |vertices: [u32; 3]| vertices.iter().map(|v| mesh.positions[*v as usize]).sum::<Vec3>();
            spatial_order(&mesh.triangles.iter().map(|t| centroid(t.vertices)).collect::<Vec<_>>());
        }
        spatial_order(&scene.objects.iter().map(|o| o.object_to_world.translation.into()).collect::<Vec<_>>());
    }
    start.elapsed().as_secs_f64()
}

/// Where the rays of a kind lie among all.
fn range(kind: usize, rays: usize) -> std::ops::Range<usize> {
    kind * rays..(kind + 1) * rays
}

/// Counts the rays of each kind that meet something else than the reference says.
///
/// # Errors
/// If they are more than 1 in 1000 of a kind, or the driver fails.
pub fn check(room: &Room, backend: Backend, tracer: &RayTracer, set: &RaySet) -> Result<[usize; 4]> {
    let mut mismatches = [0; 4];
    for (k, kind) in Kind::ALL.into_iter().enumerate() {
        tracer.trace(range(k, set.len()), kind.any_hit(), 1)?;
        let found = tracer.results(set.len())?;
        mismatches[k] = found.iter().zip(&set.expected[k]).filter(|(f, e)| !agree(f64::from(**f), **e)).count();
        if mismatches[k] * ONE_IN > set.len() {
            let (n, words) = (mismatches[k], kind.words());
            return Err(Error::scene(
                Path::new(&room.name),
                format!(
                    "{n} of {} {words} rays do not meet on {backend} what the reference says that they meet, and at most 1 in {ONE_IN} may: a \
                     rate of wrong hits would say nothing; run the tests (make test) on this device",
                    set.len()
                ),
            ));
        }
    }
    Ok(mismatches)
}

/// Whether two distances are the same: to 1e-4 of themselves and of the rooms' size, which slanting rays need.
fn agree(found: f64, expected: f64) -> bool {
    found == expected || expected.is_finite() && (found - expected).abs() <= 1e-4 * (1.0 + expected)
}

/// How often the rays of each kind have to be traced to take `seconds`; everything has run once before.
fn calibrate(tracer: &RayTracer, rays: usize, seconds: f64) -> Result<[u32; 4]> {
    let mut repeats = [1; 4];
    for (k, kind) in Kind::ALL.into_iter().enumerate() {
        // The second run is as warm as the rounds.
        for _ in 0..2 {
            let taken = tracer.trace(range(k, rays), kind.any_hit(), repeats[k])?;
            let wanted = seconds / taken.max(1e-7) * f64::from(repeats[k]);
            repeats[k] = wanted.ceil().clamp(1.0, f64::from(tracer.most_repeats())) as u32;
        }
    }
    Ok(repeats)
}

/// Millions of rays a second by the reference, on some of the rays evenly chosen.
fn reference_rate(reference: &Reference, kind: Kind, rays: &[Ray]) -> f64 {
    let step = rays.len().div_ceil(REFERENCE_RAYS).max(1);
    let some: Vec<&Ray> = rays.iter().step_by(step).collect();
    let start = Instant::now();
    let sum: f64 = some.par_iter().map(|ray| reference_result(reference, kind, ray).min(1.0)).sum();
    let seconds = start.elapsed().as_secs_f64();
    // The results are used, so that nothing is left out.
    std::hint::black_box(sum);
    some.len() as f64 / seconds * 1e-6
}

#[cfg(test)]
mod tests {
    use super::agree;

    #[test]
    fn distances_agree_or_not() {
        assert!(agree(f64::INFINITY, f64::INFINITY) && agree(1.0, 1.0001) && agree(0.0, 0.0));
        assert!(
            !agree(f64::INFINITY, 1.0) && !agree(1.0, f64::INFINITY) && !agree(1.0, 1.001) && !agree(f64::NAN, 1.0)
        );
        assert!(!agree(1.0, 0.0) && !agree(0.0, 1.0));
    }
}
