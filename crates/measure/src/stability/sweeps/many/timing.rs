//! The time of a ray and the memory of a scene, against those of a smaller scene.

use super::scenes::film;
use crate::Workbench;
use crate::stability::trial::Trial;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::render::Tracer;
use luminaire::scene::Scene;

/// Timings of each number, in turn with the smallest; their least counts.
const ROUNDS: usize = 4;

/// How much longer a ray takes in `scene` than in `smallest`, timed in turn, and the tracer of `scene` with the bytes it holds.
pub(super) struct Compared {
    pub ratio: f64,
    pub bytes: Option<f64>,
    pub tracer: Box<dyn Tracer>,
}

/// A tracer that is warm, and how many samples take it long enough to be timed.
fn timed(tracer: &mut dyn Tracer, size: (u32, u32), rays: f64, seconds: f64) -> Result<u32> {
    // The first run compiles the kernel. Two samples at least, so that two cores have work.
    Trial::new(tracer, size, 1, rays)?;
    let mut samples = 2;
    while Trial::new(tracer, size, samples, rays)?.seconds < seconds && samples < 4096 {
        samples *= 2;
    }
    Ok(samples)
}

/// Times a scene in turn with the smallest of its kind. A sample takes about so many `rays` of each, and a timing so many `seconds`.
///
/// # Errors
/// If a device fails.
pub(super) fn compare(
    bench: &Workbench,
    backend: Backend,
    (smallest, scene): (&Scene, &Scene),
    rays: [f64; 2],
    seconds: f64,
) -> Result<Compared> {
    let mut small = bench.tracer(smallest, backend)?;
    let before = bench.allocated_bytes(backend);
    let mut tracer = bench.tracer(scene, backend)?;
    let bytes = before.zip(bench.allocated_bytes(backend)).map(|(before, after)| (after - before) as f64);
    let size = film(scene);
    let counts = [timed(small.as_mut(), size, rays[0], seconds)?, timed(tracer.as_mut(), size, rays[1], seconds)?];
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for (which, tracer) in [&mut small, &mut tracer].into_iter().enumerate() {
            let trial = Trial::new(tracer.as_mut(), size, counts[which], rays[which])?;
            least[which] = least[which].min(trial.seconds_a_ray());
        }
    }
    Ok(Compared { ratio: least[1] / least[0], bytes, tracer })
}
