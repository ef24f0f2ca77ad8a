//! The figures of a run that `--stats` writes, as JSON.

use super::outcome::Outcome;
use super::seconds::Seconds;
use luminaire::picture::{Crop, Tone};
use luminaire::render::End;
use serde::Serialize;

/// The estimated error.
#[derive(Debug, Clone, Copy, Serialize)]
struct ErrorFigures {
    /// The root of `rel_mse`: what `--noise` bounds, without the fireflies.
    relative: f64,
    rel_mse: f64,
    rmse: f64,
    /// Pixels that are left out of it.
    fireflies: u64,
    /// Pixels that are left out of it because they have too few samples.
    unknown: u64,
    relative_with_fireflies: f64,
}

/// What `--stats` writes.
#[derive(Debug, Serialize)]
pub struct Stats<'a> {
    version: &'static str,
    scene: String,
    triangles: u64,
    width: u32,
    height: u32,
    /// Where these pixels lie, if they are a part of a picture.
    crop: Option<Crop>,
    /// "samples", "time" or "noise": a limit was met; "no-estimate": there was `--noise`, and nothing to estimate; "interrupted"; "failed".
    end: &'static str,
    spp_least: u32,
    spp_most: u32,
    /// Whether parts of the picture have different numbers of samples: `--adaptive` was asked for and paid.
    adaptive: bool,
    seed: u32,
    backend: String,
    device: &'a str,
    driver: &'a str,
    why: &'a str,
    seconds: Seconds,
    /// Estimated, without fireflies; none if there are too few samples, or the picture is black.
    error: Option<ErrorFigures>,
    samples: u64,
    rays: u64,
    camera_rays: u64,
    bounce_rays: u64,
    shadow_rays: u64,
    mrays_per_second: f64,
    samples_per_second: f64,
    dropped: u64,
    /// The share of the pixels that are black; none if none has samples.
    black_share: Option<f64>,
    /// Whether one of the warnings tells of light that no estimator finds: then `error` is of the rest.
    lacks_light: bool,
    /// Of a PNG, in stops.
    exposure: f32,
    /// Whether the exposure was `auto`.
    exposure_found: bool,
    tone: Tone,
    outputs: Vec<String>,
    /// What the loader had to guess, drop or scale, what the picture lacks, and what became of the render.
    warnings: Vec<&'a str>,
}

impl<'a> Stats<'a> {
    /// Gathers the figures.
    pub fn new(outcome: &'a Outcome, outputs: &[std::path::PathBuf]) -> Self {
        let Outcome { scene, renderer, rendered, seconds, .. } = outcome;
        let progress = &rendered.progress;
        Stats {
            version: env!("CARGO_PKG_VERSION"),
            scene: scene.path.display().to_string(),
            triangles: scene.triangle_count(),
            width: rendered.film.width,
            height: rendered.film.height,
            crop: rendered.film.crop,
            end: match rendered.end {
                End::Samples => "samples",
                End::Time => "time",
                End::Noise => "noise",
                End::NoEstimate => "no-estimate",
                End::Stopped => "interrupted",
                End::Failed(_) => "failed",
            },
            spp_least: rendered.film.least_samples(),
            spp_most: rendered.film.most_samples(),
            adaptive: rendered.shares.is_some(),
            seed: scene.settings.seed,
            backend: renderer.backend.to_string(),
            device: &renderer.device,
            driver: &renderer.driver,
            why: &renderer.why,
            seconds: *seconds,
            error: progress.error.map(|e| ErrorFigures {
                relative: e.relative(),
                rel_mse: e.rel_mse,
                rmse: e.rmse,
                fireflies: e.fireflies,
                unknown: e.unknown,
                relative_with_fireflies: e.relative_with_fireflies(),
            }),
            samples: progress.samples,
            rays: progress.rays,
            camera_rays: progress.samples,
            // Rays of samples that a driver did not finish are not counted, but the samples are.
            bounce_rays: progress.rays.saturating_sub(progress.samples + progress.shadow_rays),
            shadow_rays: progress.shadow_rays,
            mrays_per_second: progress.mrays_per_second(),
            samples_per_second: if progress.seconds > 0.0 { progress.samples as f64 / progress.seconds } else { 0.0 },
            dropped: rendered.dropped,
            black_share: rendered.film.black_share(),
            lacks_light: outcome.foreseen.lacks_light,
            exposure: outcome.foreseen.development.exposure,
            exposure_found: outcome.foreseen.found.is_some(),
            tone: outcome.foreseen.development.tone,
            outputs: outputs.iter().map(|path| path.display().to_string()).collect(),
            warnings: scene.warnings.iter().chain(&outcome.warnings).map(String::as_str).collect(),
        }
    }
}
