//! A scene on a device, ready to be rendered.

use super::choice::{Backend, Request, choose};
use crate::film::Film;
use crate::gpu::{Device, GpuTracer, Instance};
use crate::reference::Reference;
use crate::render::{self, End, Limits, Rendered, SceneTracer};
use crate::scene::Scene;
use crate::{Error, Result};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A tracer with a scene, ready to run; [`open`] makes it.
pub struct Renderer {
    /// The tracer with the scene loaded.
    pub tracer: Box<dyn SceneTracer>,
    /// Width and height in pixels of the film of the scene that was opened.
    pub size: (u32, u32),
    /// What was chosen.
    pub backend: Backend,
    /// Name of the device.
    pub device: String,
    /// Its driver and version; empty without Vulkan.
    pub driver: String,
    /// One sentence: why this backend on this device.
    pub why: String,
    /// True where the choice deserves a notice (no Vulkan at all, and so on).
    pub notice: bool,
    /// Seconds spent on building the acceleration structures and uploading.
    pub build_seconds: f64,
}

impl Renderer {
    /// Renders the scene until a limit is met: the whole way from a scene to a picture, where nobody watches. Without any limit it never
    /// ends.
    ///
    /// # Errors
    /// If the film does not fit into memory, or the device fails; what was done is lost then. [`Renderer::resume`] keeps it.
    pub fn render(&mut self, limits: Limits) -> Result<Film> {
        let nothing = Rendered::nothing(self.size, 0)?;
        let rendered = self.resume(nothing, limits, &mut |_| {}, &AtomicBool::new(false))?;
        match rendered.end {
            End::Failed(error) => Err(error),
            _ => Ok(rendered.film),
        }
    }

    /// Goes on with a render ([`Rendered::nothing`] of this [`size`](Renderer::size) begins one) until a limit is met or `stop` is set,
    /// calling `watch` after each batch. See [`render::resume`]. A failure of the device is an [`End`].
    ///
    /// # Errors
    /// [`Error::Usage`] if the film is not of this size.
    pub fn resume(
        &mut self,
        rendered: Rendered,
        limits: Limits,
        watch: &mut dyn FnMut(&Rendered),
        stop: &AtomicBool,
    ) -> Result<Rendered> {
        let (width, height) = self.size;
        let film = (rendered.film.width, rendered.film.height);
        if film != self.size {
            return Err(Error::Usage(format!(
                "the scene was opened with a film of {width} x {height} pixels, but the render to go on with has {} x {}",
                film.0, film.1
            )));
        }
        Ok(render::resume(self.tracer.as_mut(), rendered, limits, watch, stop))
    }
}

/// Opens the best tracer for a request.
///
/// # Errors
/// If the request names a device or backend that is not there, the scene does not fit it, or its estimator has paths that
/// never end ([`Estimator::ends`](crate::scene::Estimator::ends)).
pub fn open(scene: &Scene, request: &Request) -> Result<Renderer> {
    scene.integrator.check_ends()?;
    if request.backend == Some(Backend::Cpu) {
        if let Some(device) = &request.device {
            return Err(Error::Usage(format!("--device {device} has no meaning with --backend cpu")));
        }
        return Ok(open_reference(scene, "as asked".into(), false));
    }
    let physical = match Instance::new().and_then(|i| i.devices()) {
        Ok(devices) => devices,
        // Only `auto` without a wish for a device may fall back.
        Err(e) if request.backend.is_some() || request.device.is_some() => return Err(e),
        Err(e) => return Ok(open_reference(scene, format!("no Vulkan here: {e}"), true)),
    };
    let (device, backend, why) = match choose(&physical, request) {
        Ok(choice) => choice,
        Err(e @ Error::NoDevice(_)) if request.backend.is_none() && request.device.is_none() => {
            return Ok(open_reference(scene, e.to_string(), true));
        }
        Err(e) => return Err(e),
    };
    let start = Instant::now();
    let ray_query = backend == Backend::RayQuery;
    let (name, driver) = (device.name.clone(), device.driver.clone());
    let device = Device::open(device, ray_query)?;
    let tracer = Box::new(GpuTracer::new(&device, scene, ray_query)?);
    Ok(Renderer {
        tracer,
        size: (scene.film.width, scene.film.height),
        backend,
        device: name,
        driver,
        why,
        notice: false,
        build_seconds: start.elapsed().as_secs_f64(),
    })
}

fn open_reference(scene: &Scene, why: String, notice: bool) -> Renderer {
    let start = Instant::now();
    let tracer = Box::new(Reference::new(scene));
    let threads = rayon::current_num_threads();
    let device = format!("{threads} CPU thread{}", if threads == 1 { "" } else { "s" });
    Renderer {
        tracer,
        size: (scene.film.width, scene.film.height),
        backend: Backend::Cpu,
        device,
        driver: String::new(),
        why,
        notice,
        build_seconds: start.elapsed().as_secs_f64(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Estimator, Extinction, Integrator, load};

    #[test]
    fn a_scene_whose_paths_never_end_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let mut scene = load(&path).unwrap();
        let request = Request { backend: Some(Backend::Cpu), device: None };
        let most = Estimator::MOST_BOUNCES;
        for (max_bounces, ends) in [(None, false), (Some(u32::MAX), false), (Some(most + 1), false), (Some(most), true)]
        {
            let endless = Estimator { extinction: Extinction::Off, max_bounces, ..Estimator::default() };
            scene.integrator = Integrator::Path(endless);
            match open(&scene, &request) {
                Ok(_) => assert!(ends, "{max_bounces:?}"),
                Err(error) => {
                    assert!(!ends && error.exit_code() == 2 && error.to_string().contains("max_bounces"), "{error}")
                }
            }
        }
    }

    #[test]
    fn a_renderer_renders_its_scene_and_no_film_of_another_size() {
        use crate::scene::build::{add, empty, lamp, quad};
        use glam::{Affine3A, Vec3};
        let mut scene = empty(3, 2);
        let wall = quad(Vec3::new(-9.0, -9.0, -1.0), Vec3::X * 18.0, Vec3::Y * 18.0);
        add(&mut scene, wall, lamp(Vec3::new(1.0, 2.0, 3.0)), Affine3A::IDENTITY);
        let mut renderer = open(&scene, &Request { backend: Some(Backend::Cpu), device: None }).unwrap();
        let limits = Limits { spp: Some(4), ..Limits::default() };
        let film = renderer.render(limits).unwrap();
        assert_eq!((film.width, film.height, film.least_samples()), (3, 2, 4));
        assert!((0..6).all(|pixel| film.mean(pixel) == [1.0, 2.0, 3.0]), "{:?}", film.to_linear());

        let turned = Rendered::nothing((2, 3), 0).unwrap();
        let error = renderer.resume(turned, limits, &mut |_| {}, &AtomicBool::new(false)).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("3 x 2"), "{error}");
    }
}
