//! What the tracing of a picture and that of a frame have in common: when it ends, its layers, and what is said of who does it.

use super::options::Options;
use crate::shared::interrupts;
use crate::shared::printing::Notes;
use luminaire::backend::Renderer;
use luminaire::film::Aovs;
use luminaire::render::{End, Limits, Rendered, Tracer, aovs};
use luminaire::scene::Scene;

/// What the camera sees first, where a file is to hold it and the render has come to its end; an interrupt or a failure meanwhile is the render's.
pub fn layers(options: &Options, rendered: &mut Rendered, tracer: &mut dyn Tracer) -> Option<Aovs> {
    if !options.wants_aovs() || matches!(rendered.end, End::Failed(_) | End::Stopped) {
        return None;
    }
    let size = (rendered.film.width, rendered.film.height);
    match aovs(tracer, size, rendered.film.most_samples(), &interrupts::STOP) {
        // Samples are complete then, and the files are written without layers.
        Ok(None) => rendered.end = End::Stopped,
        Ok(found) => return found,
        Err(error) => rendered.end = End::Failed(error),
    }
    None
}

/// Notes which backend renders on which device, and why.
pub fn note_renderer(renderer: &Renderer, notes: Notes) {
    let notice = if renderer.notice { "notice: " } else { "" };
    let driver = if renderer.driver.is_empty() { String::new() } else { format!(", {}", renderer.driver) };
    notes.note(&format!("{notice}{} on {}{driver}: {}", renderer.backend, renderer.device, renderer.why));
}

/// What ends the render: options, or the scene's samples a pixel where no option does.
pub fn limits(options: &Options, scene: &Scene) -> Limits {
    let other_limit = options.time.is_some() || options.noise.is_some();
    let scene_spp = (!other_limit).then_some(scene.settings.spp);
    let spp = options.samples.as_ref().map(|samples| samples.end).or(options.spp).or(scene_spp);
    Limits { spp, seconds: options.time, noise: options.noise, adaptive: options.adaptive }
}
