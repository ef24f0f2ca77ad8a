//! Looks at a picture while it is rendered, as a window would: one thread renders, another one gets frames, and ends the render when it likes what it
//! sees.
//!
//! `cargo run --release --example progressive`

use luminaire::render::{End, Limits, Rendered};
use luminaire::scene::{self, Scene};
use luminaire::{backend, picture};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Between two frames.
const FRAME: Duration = Duration::from_millis(100);

/// What is shown.
pub struct Frame {
    /// Samples a pixel so far.
    pub spp: f64,
    /// Estimated relative error; none while there are too few samples for an estimate.
    pub error: Option<f64>,
    /// Red, green and blue of each pixel, rows from the top: what a window or a texture takes.
    pub srgb: Vec<u8>,
}

fn main() -> luminaire::Result<()> {
    let mut scene = scene::load(Path::new("scenes/cornell/cornell.toml"))?;
    (scene.film.width, scene.film.height) = (256, 256);
    let rendered = watch(&scene, 0.05, |frame| {
        let error = frame.error.map_or("not known yet".into(), |error| format!("{:.1} %", 100.0 * error));
        println!("{:5.1} samples a pixel, error {error}, {} bytes to show", frame.spp, frame.srgb.len());
    })?;
    rendered.film.save(Path::new("progressive.png"), backend::development(&scene))?;
    println!("progressive.png: {:.1} s", rendered.progress.seconds);
    Ok(())
}

/// Renders until the estimated relative error is at most `enough`, and gives every frame to `show`.
pub fn watch(scene: &Scene, enough: f64, mut show: impl FnMut(&Frame)) -> luminaire::Result<Rendered> {
    let stop = AtomicBool::new(false);
    let (frames, shown) = channel();
    let rendered = thread::scope(|threads| {
        let worker = threads.spawn(|| render(scene, frames, &stop));
        // Ends when the worker does, and drops its end of the channel.
        for frame in shown {
            show(&frame);
            if frame.error.is_some_and(|error| error <= enough) {
                stop.store(true, Ordering::Relaxed);
            }
        }
        worker.join().expect("the worker does not panic")
    })?;
    match rendered.end {
        End::Failed(error) => Err(error),
        _ => Ok(rendered),
    }
}

/// Renders until `stop` is set, and sends a frame now and then.
fn render(scene: &Scene, frames: Sender<Frame>, stop: &AtomicBool) -> luminaire::Result<Rendered> {
    let mut renderer = backend::open(scene, &backend::Request::default())?;
    let development = backend::development(scene);
    let mut last = Instant::now();
    let mut send = |rendered: &Rendered| {
        if last.elapsed() < FRAME {
            return;
        }
        last = Instant::now();
        let film = &rendered.film;
        let frame = Frame {
            spp: rendered.progress.spp(),
            error: film.error().map(|error| error.relative()),
            srgb: picture::to_srgb8(&film.to_linear(), development),
        };
        // Where nobody looks any more, the render goes on all the same.
        let _ = frames.send(frame);
    };
    // No limit but `stop`.
    renderer.resume(Rendered::nothing(renderer.size, 0)?, Limits::default(), &mut send, stop)
}
