//! `luminaire view`.

use super::{ViewOptions, tell};
use luminaire::backend::{Backend, Request};
use luminaire::film::Film;
use luminaire::scene::{self, FilmSettings, Scene};
use luminaire::{Error, Result};
use luminaire_view::Options;
use std::process::ExitCode;

/// Loads a scene and shows it until the window is closed.
pub fn run(options: &ViewOptions) -> Result<ExitCode> {
    if options.device.is_some() && options.backend.backend() == Some(Backend::Cpu) {
        return Err(Error::Usage(
            "--device chooses a Vulkan device, but --backend cpu uses none: leave one of them out".into(),
        ));
    }
    options.estimator.check()?;
    let mut scene = scene::load(&options.scene)?;
    resize(options, &mut scene.film);
    Film::check_size(scene.film.width, scene.film.height)?;
    change_settings(options, &mut scene)?;
    scene.warnings.iter().for_each(|warning| tell(&format!("warning: {warning}")));
    let request = Request { backend: options.backend.backend(), device: options.device.clone() };
    luminaire_view::run(Options { scene, request, spp: options.spp.unwrap_or(u32::MAX) })?;
    Ok(ExitCode::SUCCESS)
}

/// Puts the options in the place of the scene's film size.
fn resize(options: &ViewOptions, film: &mut FilmSettings) {
    let FilmSettings { width, height, .. } = *film;
    let scaled = |given: u32, this: u32, other: u32| {
        (f64::from(given) * f64::from(this) / f64::from(other)).round().clamp(1.0, 16384.0) as u32
    };
    (film.width, film.height) = match (options.width, options.height) {
        (None, None) => (width, height),
        (Some(w), None) => (w, scaled(w, height, width)),
        (None, Some(h)) => (scaled(h, width, height), h),
        (Some(w), Some(h)) => (w, h),
    };
}

/// Puts the options in the place of the scene's estimator, sampler, seed and exposure.
fn change_settings(options: &ViewOptions, scene: &mut Scene) -> Result<()> {
    // Whether the picture can only be black depends on the estimator.
    let dark = scene.dark_because();
    scene.warnings.extend(options.estimator.apply(&mut scene.integrator)?);
    let settings = &mut scene.settings;
    settings.sampler = options.estimator.sampler.unwrap_or(settings.sampler);
    settings.seed = options.seed.unwrap_or(settings.seed);
    settings.exposure = options.exposure.unwrap_or(settings.exposure);
    let now = scene.dark_because();
    if now != dark {
        scene.warnings.retain(|warning| Some(warning) != dark.as_ref());
        scene.warnings.extend(now);
    }
    Ok(())
}
