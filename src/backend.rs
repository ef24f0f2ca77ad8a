//! Which tracer runs, on which device, and why.

use crate::film::Film;
use crate::gpu::{Device, GpuTracer, Instance, PhysicalDevice};
use crate::reference::Reference;
use crate::render::{self, End, Limits, Rendered, SceneTracer};
use crate::scene::Scene;
use crate::{Error, Result};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The three ways to trace rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// The kernel on Vulkan ray queries over bottom- and top-level acceleration structures.
    RayQuery,
    /// The kernel on our own traversal of a compressed wide BVH in plain buffers.
    ComputeBvh,
    /// The double-precision reference.
    Cpu,
}

impl std::fmt::Display for Backend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Backend::RayQuery => "ray-query",
            Backend::ComputeBvh => "compute-bvh",
            Backend::Cpu => "cpu",
        })
    }
}

/// What the caller asked for.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// A backend; none: `auto`.
    pub backend: Option<Backend>,
    /// A device by index or part of its name; none: the best.
    pub device: Option<String>,
}

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

/// What one Vulkan device offers.
#[derive(Debug, Clone)]
pub struct DeviceReport {
    /// Index, as `--device` takes it.
    pub index: usize,
    /// Name of the device.
    pub name: String,
    /// Driver name and version, Vulkan version.
    pub driver: String,
    /// "discrete GPU", "integrated GPU", "virtual GPU", "software (CPU)" or "other".
    pub kind: &'static str,
    /// What it offers and lacks, a line each: feature and yes / no / value.
    pub features: Vec<(String, String)>,
    /// Whether it offers ray queries.
    pub ray_query: bool,
    /// The backend that `auto` would run there, or why the device cannot be used.
    pub backend: std::result::Result<Backend, String>,
    /// Why that backend.
    pub why: String,
    /// True for the device that is used unless another is asked for.
    pub preferred: bool,
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

/// The backend that is the faster one on a device, and why.
fn preferred(ray_query: bool, software: bool) -> (Backend, &'static str) {
    match (ray_query, software) {
        (true, false) => (Backend::RayQuery, "the GPU offers ray queries"),
        (true, true) => {
            (Backend::ComputeBvh, "a software device, on which our BVH is faster than the driver's ray queries")
        }
        (false, _) => (Backend::ComputeBvh, "the device offers no ray queries"),
    }
}

/// The device and backend for a request.
fn choose<'a>(devices: &'a [PhysicalDevice], request: &Request) -> Result<(&'a PhysicalDevice, Backend, String)> {
    let wants_ray_query = request.backend == Some(Backend::RayQuery);
    let device = match &request.device {
        Some(wanted) => {
            let names: Vec<&str> = devices.iter().map(|d| d.name.as_str()).collect();
            &devices[find(&names, wanted)?]
        }
        None => devices
            .iter()
            .filter(|d| d.usable().is_ok() && (d.ray_query || !wants_ray_query))
            // The first of the best, in the loader's order.
            .rev()
            .max_by_key(|d| d.rank())
            .ok_or_else(|| {
                let found: Vec<String> = devices.iter().map(|d| d.name.clone()).collect();
                let found = if found.is_empty() { "there is no device at all".into() } else { found.join(", ") };
                Error::NoDevice(if wants_ray_query {
                    format!("no device offers ray queries ({found}): use --backend compute-bvh, which needs none")
                } else {
                    format!("no Vulkan device is usable ({found}): see `luminaire devices`, or use --backend cpu")
                })
            })?,
    };
    device.usable().map_err(|reason| Error::NoDevice(format!("{} cannot be used: {reason}", device.name)))?;
    if wants_ray_query && !device.ray_query {
        let advice =
            if device.ray_tracing_pipeline { " (it has ray-tracing pipelines, but those are not used)" } else { "" };
        return Err(Error::NoDevice(format!(
            "{} offers no ray queries{advice}: use --backend compute-bvh, which needs none, or another --device",
            device.name
        )));
    }
    Ok(match request.backend {
        Some(backend) => (device, backend, "as asked".into()),
        None => {
            let (backend, why) = preferred(device.ray_query, device.is_software());
            (device, backend, why.into())
        }
    })
}

/// Which of the devices has this index, or a name that contains this text (without regard to case).
fn find(names: &[&str], wanted: &str) -> Result<usize> {
    if let Ok(index) = wanted.parse::<usize>()
        && index < names.len()
    {
        return Ok(index);
    }
    let lower = wanted.to_lowercase();
    let mut found = names.iter().enumerate().filter(|(_, name)| name.to_lowercase().contains(&lower));
    let problem = match (found.next(), found.next()) {
        (Some((index, _)), None) => return Ok(index),
        (Some(_), Some(_)) => format!("several devices are called like `{wanted}`: give an index"),
        _ => format!("no device has the index or a name like `{wanted}`; there are"),
    };
    let list: String = names.iter().enumerate().map(|(index, name)| format!("\n  {index}: {name}")).collect();
    Err(Error::NoDevice(problem + &list))
}

/// Every Vulkan device of this machine.
///
/// # Errors
/// If there is no Vulkan loader or no driver, with what to install.
pub fn devices() -> Result<Vec<DeviceReport>> {
    let devices = Instance::new()?.devices()?;
    let best = choose(&devices, &Request::default()).ok().map(|(device, ..)| device.index);
    Ok(devices
        .iter()
        .map(|d| {
            let (backend, why) = preferred(d.ray_query, d.is_software());
            DeviceReport {
                index: d.index,
                name: d.name.clone(),
                driver: d.driver.clone(),
                kind: d.kind(),
                features: d.features(),
                ray_query: d.ray_query,
                backend: d.usable().map(|()| backend),
                why: why.into(),
                preferred: best == Some(d.index),
            }
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Estimator, Extinction, Integrator, load};

    #[test]
    fn ray_query_where_a_gpu_offers_it_and_the_bvh_elsewhere() {
        assert_eq!(preferred(true, false).0, Backend::RayQuery);
        assert_eq!(preferred(false, false).0, Backend::ComputeBvh);
        assert_eq!(preferred(true, true).0, Backend::ComputeBvh);
        assert_eq!(preferred(false, true).0, Backend::ComputeBvh);
    }

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

    #[test]
    fn devices_are_found_by_index_and_by_name() {
        let names = ["NVIDIA GeForce RTX 4090", "llvmpipe (LLVM 15)", "NVIDIA GeForce RTX 4070"];
        assert_eq!(find(&names, "1").unwrap(), 1);
        assert_eq!(find(&names, "LLVM").unwrap(), 1);
        // No such index, but a part of a name.
        assert_eq!(find(&names, "4090").unwrap(), 0);
        assert!(find(&names, "nvidia").unwrap_err().to_string().contains("give an index\n  0: NVIDIA"));
        assert_eq!(find(&names, "407").unwrap(), 2);
        assert!(find(&names, "9").is_ok() && find(&names, "8").unwrap_err().to_string().contains("  1: llvmpipe"));
    }
}
