//! Renders a scene file, or any OBJ, to a picture, and prints how far it is.
//!
//! `cargo run --release --example render_file -- [SCENE [PICTURE]]`

use luminaire::render::{End, Limits, Rendered};
use luminaire::{backend, picture, scene};
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn main() -> luminaire::Result<()> {
    let mut words = std::env::args().skip(1);
    let file = words.next().unwrap_or_else(|| "scenes/cornell/cornell.toml".into());
    let picture = words.next().unwrap_or_else(|| "render_file.png".into());
    render(file.as_ref(), picture.as_ref(), None)
}

/// Renders `file` to `picture`, whose ending says the format; as many samples a pixel as the file says, or `spp`.
pub fn render(file: &Path, picture: &Path, spp: Option<u32>) -> luminaire::Result<()> {
    picture::check_output(picture)?;
    let scene = scene::load(file)?;
    for warning in &scene.warnings {
        eprintln!("warning: {warning}");
    }
    let mut renderer = backend::open(&scene, &backend::Request::default())?;
    eprintln!("{} on {}: {}", renderer.backend, renderer.device, renderer.why);

    let limits = Limits { spp: Some(spp.unwrap_or(scene.settings.spp)), ..Limits::default() };
    let mut progress = |rendered: &Rendered| {
        let progress = &rendered.progress;
        eprint!("\r{:3.0} %, {:.1} Mrays/s", 100.0 * progress.fraction(), progress.mrays_per_second());
    };
    // A thread or a signal handler that sets it ends the render; what is there until then is written.
    let stop = AtomicBool::new(false);
    let rendered = renderer.resume(Rendered::nothing(renderer.size, 0)?, limits, &mut progress, &stop)?;
    eprintln!();
    rendered.film.save(picture, backend::development(&scene))?;
    if let Some(error) = rendered.progress.error {
        println!("{}: estimated error {:.1} %", picture.display(), 100.0 * error.relative());
    }
    // The device failed: the picture holds what it had done before.
    if let End::Failed(error) = rendered.end { Err(error) } else { Ok(()) }
}
