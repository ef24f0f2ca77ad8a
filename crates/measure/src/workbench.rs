//! The tracers that a measurement puts side by side.

use luminaire::backend::{self, Backend};
use luminaire::gpu::probe::{Call, Probe};
use luminaire::gpu::{Device, GpuTracer, Instance, RayTracer};
use luminaire::reference::Reference;
use luminaire::render::Tracer;
use luminaire::scene::Scene;
use luminaire::{Error, Result};
use std::sync::Arc;

/// Every backend of this machine, opened once.
pub struct Workbench {
    /// Whether there is time for finer steps and more samples.
    pub long: bool,
    compute_bvh: Option<Arc<Device>>,
    ray_query: Option<Arc<Device>>,
    /// Device and driver, or what is missing.
    pub device: String,
}

impl Workbench {
    /// Opens the preferred Vulkan device, once with and once without ray queries. Without one only the reference is left, and
    /// [`field@Workbench::device`] says so.
    ///
    /// # Errors
    /// If a device that is there cannot be opened.
    pub fn new(long: bool) -> Result<Self> {
        let mut bench = Workbench { long, compute_bvh: None, ray_query: None, device: String::new() };
        let (devices, reports) = match (Instance::new().and_then(|i| i.devices()), backend::devices()) {
            (Ok(devices), Ok(reports)) => (devices, reports),
            (Err(e), _) | (_, Err(e)) => {
                bench.device = format!("no Vulkan device ({e})");
                return Ok(bench);
            }
        };
        let Some(device) = reports.iter().find(|report| report.preferred).map(|report| &devices[report.index]) else {
            bench.device = "no usable Vulkan device".into();
            return Ok(bench);
        };
        bench.device = format!("{}, {}", device.name, device.driver);
        bench.compute_bvh = Some(Device::open(device, false)?);
        if device.ray_query {
            bench.ray_query = Some(Device::open(device, true)?);
        }
        Ok(bench)
    }

    /// What can run here: always the reference, which comes first.
    pub fn backends(&self) -> Vec<Backend> {
        let gpu = [(Backend::ComputeBvh, &self.compute_bvh), (Backend::RayQuery, &self.ray_query)];
        let there = gpu.into_iter().filter(|(_, device)| device.is_some()).map(|(backend, _)| backend);
        std::iter::once(Backend::Cpu).chain(there).collect()
    }

    fn device(&self, backend: Backend) -> Result<&Arc<Device>> {
        let device = if backend == Backend::RayQuery { &self.ray_query } else { &self.compute_bvh };
        device.as_ref().ok_or_else(|| Error::NoDevice(format!("{backend} cannot run here: {}", self.device)))
    }

    /// Bytes of device memory that the backend's tracers and probes hold now; none for the CPU and for what is not here.
    pub fn allocated_bytes(&self, backend: Backend) -> Option<u64> {
        (backend != Backend::Cpu).then(|| self.device(backend).ok().map(|device| device.allocated_bytes())).flatten()
    }

    /// A tracer with a scene. The caller sees to it that the estimator ends.
    ///
    /// # Errors
    /// If there is no such backend here, or the scene does not fit it.
    pub fn tracer(&self, scene: &Scene, backend: Backend) -> Result<Box<dyn Tracer>> {
        if backend == Backend::Cpu {
            return Ok(Box::new(Reference::new(scene)));
        }
        Ok(Box::new(GpuTracer::new(self.device(backend)?, scene, backend == Backend::RayQuery)?))
    }

    /// The kernel's functions over a scene, one by one.
    ///
    /// # Errors
    /// If the backend is the CPU or not here, or the scene does not fit it.
    pub fn probe(&self, scene: &Scene, backend: Backend) -> Result<Probe> {
        if backend == Backend::Cpu {
            return Err(Error::NoDevice("the reference needs no probe".into()));
        }
        Probe::new(self.device(backend)?, scene, backend == Backend::RayQuery)
    }
    /// Whether the device is the CPU, or there is none.
    pub fn is_software(&self) -> bool {
        self.compute_bvh.as_ref().is_none_or(|device| device.software)
    }

    /// An intersector by itself, with a scene and the rays that it is to trace (as [`crate::rays::Ray::call`] has them).
    ///
    /// # Errors
    /// If the backend is the CPU or not here, or scene or rays do not fit it.
    pub fn ray_tracer(&self, scene: &Scene, backend: Backend, rays: &[Call]) -> Result<RayTracer> {
        if backend == Backend::Cpu {
            return Err(Error::NoDevice("the reference traces rays by itself".into()));
        }
        RayTracer::new(self.device(backend)?, scene, backend == Backend::RayQuery, rays)
    }
}
