//! An exposure for a scene that leaves it to the program.
//!
//! It does not come from the film, so that it is the same for every backend, seed, number of samples and part of a render: the reference looks at the scene
//! beforehand, always through the same few pixels and with the same random numbers, and paths are short.

use super::prepared_scene::Reference;
use crate::picture::luminance;
use crate::sampling::Sampler;
use crate::scene::{FilmSettings, Filter, Integrator, Scene};
use rayon::prelude::*;

/// About so many pixels across are looked at; as many in all as a square of them has.
const SIDE: f64 = 32.0;
/// Samples of each of these pixels.
const SAMPLES: u32 = 32;
/// Paths have no more bounces.
const MOST_BOUNCES: u32 = 6;
/// This share of the pixels is not brighter than ...
const NOT_BRIGHT: f64 = 0.95;
/// ... a white wall.
const BRIGHT: f64 = 0.8;
/// But the log-average of what is seen stays about middle grey, 0.18, the key of a usual scene (Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone
/// Reproduction for Digital Images", 2002): a stop below, where most is dark beside something bright, and half a stop above, where all is alike.
const KEYS: [f64; 2] = [0.09, 0.25];
/// Less of the samples than this meet a surface: then the sky is the picture.
const LEAST_SURFACE: f64 = 0.01;
/// A pixel counts from so many samples on that found light.
const LEAST_LIT: usize = 2;
/// Less of the pixels count: the light is hardly found, or hardly there, and nothing can be said of it.
const LEAST_COUNTED: f64 = 0.02;
/// Stops are rounded to this, so that a number that is printed can be given again.
const STEP: f64 = 0.125;
/// The most stops that can be given.
const MOST: f64 = 64.0;

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct AutoExposure {
    /// The exposure in stops; 0 if none could be found.
    pub stops: f32,
    /// Why none could be found, as a sentence for a warning.
    pub warning: Option<String>,
}

impl AutoExposure {
    /// The exposure of a scene's picture of the aspect ratio of `film`: a fraction of a second, and the memory of [`Reference::new`].
    ///
    /// The brightest twentieth of the surfaces that the camera sees begins at a luminance of 0.8, as a white wall has it; but the log-average of all of them stays from
    /// 0.09 to 0.25. What the camera sees of the environment itself counts only if there is next to nothing else. Light that is `2^k` times as strong
    /// gives exactly `k` stops less.
    pub fn of(scene: &Scene, film: &FilmSettings) -> Self {
        if !Reference::fits(scene) {
            return Self::none(scene, "there is too little memory to look at the scene beforehand");
        }
        Reference::new(scene).auto_exposure(film)
    }

    fn none(scene: &Scene, why: &str) -> Self {
        let warning = format!("{}: no exposure can be found ({why}), so it is 0 stops", scene.path.display());
        AutoExposure { stops: 0.0, warning: Some(warning) }
    }

    /// The exposure in words: `exposure auto: +1.375 stops`.
    pub fn in_words(&self) -> String {
        format!("exposure auto: {:+} stops", self.stops)
    }
}

/// What the samples of a pixel found.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// The luminance of the samples, added up.
    sum: f64,
    samples: usize,
    /// Those of them that found light.
    lit: usize,
}

impl Seen {
    fn add(&mut self, luminance: f64) {
        self.sum += luminance;
        self.samples += 1;
        self.lit += usize::from(luminance > 0.0);
    }
}

impl Reference {
    /// [`AutoExposure::of`] the scene that this is of.
    pub fn auto_exposure(mut self, film: &FilmSettings) -> AutoExposure {
        let aspect = f64::from(film.width) / f64::from(film.height);
        let side = |factor: f64| (SIDE * factor).round().clamp(1.0, SIDE * SIDE) as u32;
        self.scene.film = FilmSettings {
            width: side(aspect.sqrt()),
            height: side(aspect.sqrt().recip()),
            filter: Filter::Box,
            filter_radius: 0.5,
        };
        self.filter.clear();
        (self.scene.settings.seed, self.scene.settings.sampler) = (0, Sampler::Sobol);
        if let Integrator::Path(estimator) = &mut self.scene.integrator {
            estimator.max_bounces = Some(estimator.max_bounces.map_or(MOST_BOUNCES, |most| most.min(MOST_BOUNCES)));
        }
        let pixels = self.scene.film.width * self.scene.film.height;
        // Of surfaces, and of everything.
        let seen: Vec<[Seen; 2]> = (0..pixels).into_par_iter().map(|pixel| self.seen(pixel)).collect();
        let [on_surfaces, all] = [0, 1].map(|of| seen.iter().map(|seen| seen[of].samples).sum::<usize>());
        let of = usize::from((on_surfaces as f64) < LEAST_SURFACE * all as f64);
        let seen: Vec<Seen> = seen.into_iter().map(|seen| seen[of]).filter(|seen| seen.samples > 0).collect();
        let counted = seen.iter().filter(|seen| seen.lit >= LEAST_LIT);
        let mut logs: Vec<f64> = counted.map(|seen| (seen.sum / seen.samples as f64).log2()).collect();
        if logs.is_empty() || (logs.len() as f64) < LEAST_COUNTED * seen.len() as f64 {
            let why = match seen.iter().map(|seen| seen.lit).sum::<usize>() {
                0 => format!("none of {all} paths found light"),
                lit => format!("only {lit} of {all} paths found light"),
            };
            return AutoExposure::none(&self.scene, &why);
        }
        logs.sort_by(f64::total_cmp);
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let bright = logs[((logs.len() - 1) as f64 * NOT_BRIGHT) as usize];
        let [least, most] = KEYS.map(|key| key.log2() - mean);
        let stops = (BRIGHT.log2() - bright).clamp(least, most);
        let rounded = ((stops / STEP).round() * STEP).clamp(-MOST, MOST);
        // No minus before 0.
        AutoExposure { stops: rounded as f32 + 0.0, warning: None }
    }

    /// What a pixel shows of surfaces, and in all.
    fn seen(&self, pixel: u32) -> [Seen; 2] {
        let mut seen = [Seen::default(); 2];
        for sample in 0..SAMPLES {
            let mut surface = None;
            let (radiance, _) = self.follow(pixel, sample, &mut |vertex| {
                surface.get_or_insert(vertex.hit.is_some());
                true
            });
            let luminance = luminance(radiance);
            if luminance.is_finite() {
                seen[1].add(luminance);
                if surface == Some(true) {
                    seen[0].add(luminance);
                }
            }
        }
        seen
    }
}
