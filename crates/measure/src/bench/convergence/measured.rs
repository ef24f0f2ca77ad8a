//! Error over time, measured: every estimator on every backend renders a scene for as long as it has time.

use super::contenders;
use super::reference_picture::Reference;
use super::trial::Trial;
use crate::Workbench;
use crate::bench::definition::Progress;
use crate::bench::renders::Preparation;
use crate::bench::scene::BenchScene;
use crate::bench::settings::Settings;
use crate::report::words::number;
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::Scene;

/// The seed of the reference is the scene's with these bits changed; the rounds' are the next after the scene's.
const REFERENCE_SEED: u32 = 0x5eed_0000;

/// A scene with all that was measured on it.
pub(super) struct Measured {
    /// The scene's name.
    pub name: String,
    /// Every estimator on every backend.
    pub trials: Vec<Trial>,
    /// The reference's own relMSE, where it is known.
    pub own_error: Option<f64>,
    /// What the reference is, and who is left out: sentences.
    pub notes: Vec<String>,
}

/// Measures a scene.
///
/// # Errors
/// If a backend fails.
pub(super) fn measure(bench: &Workbench, settings: &Settings, of: &BenchScene, progress: Progress) -> Result<Measured> {
    let mut scene = of.scene.clone();
    let seed = scene.settings.seed;
    let (contenders, mut notes) = contenders::contenders(&scene, &settings.estimators);
    let mut trials: Vec<Trial> = settings
        .backends
        .iter()
        .flat_map(|backend| contenders.iter().map(|contender| Trial::new(&contender.name, *backend)))
        .collect();
    progress("    shaders are compiled");
    for (trial, contender) in trials.iter_mut().zip(contenders.iter().cycle()) {
        scene.integrator = contender.integrator;
        scene.settings.sampler = contender.sampler;
        trial.first_ready_seconds = Preparation::measure(bench, &scene, trial.backend)?.ready_seconds;
    }
    (scene.integrator, scene.settings) = (of.scene.integrator, of.scene.settings);
    let reference = reference_of(bench, settings, &mut scene, progress)?;
    let known = reference
        .own_error
        .map_or("whose own error is not known".into(), |error| format!("whose own relMSE is about {}", number(error)));
    notes.insert(0, format!("The reference is {}, {known}.", reference.words));
    for round in 0..settings.rounds {
        progress(&format!("    round {} of {}", round + 1, settings.rounds));
        for (trial, contender) in trials.iter_mut().zip(contenders.iter().cycle()) {
            scene.integrator = contender.integrator;
            scene.settings.sampler = contender.sampler;
            scene.settings.seed = seed.wrapping_add(1 + round as u32);
            trial.round(bench, &scene, &reference, settings.effort.budget_seconds())?;
        }
    }
    Ok(Measured { name: of.name.clone(), trials, own_error: reference.own_error, notes })
}

/// The reference that was given, or one that the fastest backend renders.
fn reference_of(bench: &Workbench, settings: &Settings, scene: &mut Scene, progress: Progress) -> Result<Reference> {
    if let Some(picture) = &settings.reference {
        return Ok(Reference::given(picture));
    }
    let contender = contenders::reference(scene);
    let own = (scene.integrator, scene.settings);
    scene.integrator = contender.integrator;
    scene.settings.sampler = contender.sampler;
    scene.settings.seed ^= REFERENCE_SEED;
    let fastest = fastest(bench, settings, scene)?;
    progress(&format!("    reference on {fastest}, about {} s", settings.effort.reference_seconds()));
    let rendered = Reference::rendered(bench, scene, &contender, fastest, settings.effort.reference_seconds());
    (scene.integrator, scene.settings) = own;
    rendered
}

/// The backend on which a few samples take the least time.
fn fastest(bench: &Workbench, settings: &Settings, scene: &Scene) -> Result<Backend> {
    let (mut fastest, mut least) = (settings.backends[0], f64::INFINITY);
    for &backend in settings.backends.iter().filter(|_| settings.backends.len() > 1) {
        let seconds = Reference::pace(bench, scene, backend)?;
        if seconds < least {
            (fastest, least) = (backend, seconds);
        }
    }
    Ok(fastest)
}
