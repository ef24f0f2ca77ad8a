//! Is the promise of a limit of the noise kept? The true error of many renders at the moment at which they ended.

use luminaire::Result;
use luminaire::film::{Brightness, Film};
use luminaire::render::{End, Limits, Rendered, Tracer, resume};
use luminaire::scene::Scene;
use std::sync::atomic::AtomicBool;

/// Seeds of the pictures under test are `FIRST_SEED` and those after it; the truth has those before.
const FIRST_SEED: u32 = 2000;
/// Pictures of which the truth is the mean; their spread is its own variance.
const TRUTHS: u32 = 8;
/// From so many samples a pixel on, a power of two, it is known what an oracle would have done, ...
const LEAST: u32 = 32;
/// ... to this many, another one.
const MOST: u32 = 1024;

/// One render that a limit of the noise has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The limit, a relative error.
    pub limit: f64,
    /// The true relative error at the end, without the fireflies of the picture at the end.
    pub error: f64,
    /// Samples a pixel, averaged over the pixels.
    pub samples: f64,
    /// The samples a pixel, the same for all, after which the error of this seed was first below the limit: looked at after every eighth of the power of two below.
    pub oracle: f64,
}

/// What a picture is held against.
struct Truth {
    mean: Vec<[f64; 3]>,
    /// The variance of the mean.
    variance: Vec<[f64; 3]>,
    brightness: Brightness,
}

impl Truth {
    fn of(pictures: &[Film]) -> Self {
        let n = pictures.len() as f64;
        let pixels = pictures[0].pixels();
        let each = |pixel: usize, channel: usize| pictures.iter().map(move |film| film.mean(pixel)[channel]);
        let mean: Vec<[f64; 3]> = (0..pixels).map(|pixel| [0, 1, 2].map(|c| each(pixel, c).sum::<f64>() / n)).collect();
        let spread = |pixel: usize, c: usize| each(pixel, c).map(|found| (found - mean[pixel][c]).powi(2)).sum::<f64>();
        let variance = (0..pixels).map(|pixel| [0, 1, 2].map(|c| spread(pixel, c) / (n - 1.0) / n)).collect();
        let brightness = Brightness::of(mean.iter().flatten().copied());
        Truth { mean, variance, brightness }
    }

    /// The true relMSE of a picture, without its fireflies. The truth's own variance is taken off.
    fn rel_mse(&self, film: &Film) -> f64 {
        let fireflies = film.error_map().expect("several samples a pixel").firefly;
        let (mut sum, mut counted) = (0.0, 0u32);
        for pixel in (0..film.pixels()).filter(|pixel| !fireflies[*pixel]) {
            for (c, found) in film.mean(pixel).into_iter().enumerate() {
                let expected = self.mean[pixel][c];
                let relative = |off: f64| self.brightness.relative_square(off, expected);
                sum += relative(found - expected) - relative(self.variance[pixel][c].sqrt());
                counted += 1;
            }
        }
        (sum / f64::from(counted)).max(0.0)
    }
}

/// Renders `scene` with `seeds` seeds until each of some limits of the noise: the errors, in the mean of the seeds, of as many samples a pixel as `at` says. Gives
/// the stops of every seed for each of these. The truth has `truth` samples.
///
/// `open` gives a tracer for a scene; `adaptive` is that of [`Limits`]. A render that no limit ends has four times the samples that an oracle could have taken.
///
/// # Errors
/// If a tracer cannot be had, or fails.
///
/// # Panics
/// If `at` has a number that is no eighth of a power of two from 32 to 1024, or there is no light.
pub fn stops(
    open: &dyn Fn(&Scene) -> Result<Box<dyn Tracer>>,
    scene: &Scene,
    at: &[u32],
    seeds: u32,
    truth: u32,
    adaptive: bool,
) -> Result<Vec<Vec<Stop>>> {
    let mut scene = scene.clone();
    let size = (scene.film.width, scene.film.height);
    let nothing = || Rendered::nothing(size, 0);
    let go_on = |tracer: &mut dyn Tracer, rendered: Rendered, limits: Limits| -> Result<Rendered> {
        let rendered = resume(tracer, rendered, limits, &mut |_| {}, &AtomicBool::new(false));
        match rendered.end {
            End::Failed(error) => Err(error),
            _ => Ok(rendered),
        }
    };
    let samples = |spp: u32| Limits { spp: Some(spp), ..Limits::default() };
    let mut pictures = vec![];
    for seed in FIRST_SEED - TRUTHS..FIRST_SEED {
        scene.settings.seed = seed;
        pictures.push(go_on(open(&scene)?.as_mut(), nothing()?, samples(truth / TRUTHS))?.film);
    }
    let truth = Truth::of(&pictures);
    let looks: Vec<u32> =
        std::iter::successors(Some(LEAST), |n| Some(n + (1 << n.ilog2()) / 8)).take_while(|n| *n <= MOST).collect();
    // The true errors of every seed as it goes on.
    let mut curves = vec![];
    for seed in FIRST_SEED..FIRST_SEED + seeds {
        scene.settings.seed = seed;
        let mut tracer = open(&scene)?;
        let (mut rendered, mut curve) = (nothing()?, vec![]);
        for look in &looks {
            rendered = go_on(tracer.as_mut(), rendered, samples(*look))?;
            curve.push(truth.rel_mse(&rendered.film));
        }
        curves.push((seed, tracer, curve));
    }
    let mut found = vec![];
    for at in at {
        let place = looks.iter().position(|look| look == at).expect("an eighth of a power of two");
        let rel_mse = curves.iter().map(|(.., curve)| curve[place]).sum::<f64>() / f64::from(seeds);
        let limits = Limits { spp: Some(4 * MOST), noise: Some(rel_mse.sqrt()), adaptive, ..Limits::default() };
        let mut stops = vec![];
        for (_, tracer, curve) in &mut curves {
            let rendered = go_on(tracer.as_mut(), nothing()?, limits)?;
            let oracle = curve.iter().position(|error| *error <= rel_mse).map_or(MOST, |place| looks[place]);
            stops.push(Stop {
                limit: rel_mse.sqrt(),
                error: truth.rel_mse(&rendered.film).sqrt(),
                samples: rendered.progress.spp(),
                oracle: oracle.into(),
            });
        }
        found.push(stops);
    }
    Ok(found)
}
