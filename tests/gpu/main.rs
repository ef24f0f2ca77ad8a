//! The kernel against the reference, on both intersectors, on whatever Vulkan device is here.
//!
//! Without a device (or without ray query) a test says SKIP on standard error; with `LUMINAIRE_REQUIRE_GPU=1` it fails.
//! With `LUMINAIRE_VALIDATION=1` every Vulkan call is watched, and a single message fails the test.

#[path = "../common/mod.rs"]
mod common;

mod aovs;
mod bodies;
mod coats;
mod densities;
mod error_bar;
mod estimators;
mod facets;
mod fallback;
mod features;
mod files;
mod framing;
mod functions;
mod glass;
mod intersection;
mod light_tree;
mod maps;
mod overlapping_lamps;
mod physical;
mod pictures;
mod relief;
mod scattering;
mod scenes;
mod sensor;
mod studio;
mod touching_glass;
mod twins;
mod vertex_colours;

use common::skip;
use luminaire::gpu::{Device, GpuTracer, Instance, validation_messages};
use luminaire::scene::Scene;
use std::sync::Arc;

/// Set in the process that runs these tests on a driver without ray query.
const WITHOUT_RAY_QUERY: &str = "LUMINAIRE_TEST_WITHOUT_RAY_QUERY";

/// An open device and the intersector to use on it.
#[derive(Clone)]
struct Intersector {
    device: Arc<Device>,
    ray_query: bool,
}

impl Intersector {
    fn name(&self) -> &'static str {
        if self.ray_query { "ray query" } else { "compute BVH" }
    }

    fn tracer(&self, scene: &Scene) -> GpuTracer {
        GpuTracer::new(&self.device, scene, self.ray_query).expect("the scene fits the device")
    }
}

/// The intersectors that can run here; none without a device.
fn backends() -> Vec<Intersector> {
    let devices = match Instance::new().and_then(|instance| instance.devices()) {
        Ok(devices) => devices,
        Err(e) => {
            skip(&format!("nothing ran on Vulkan: {e}"));
            return Vec::new();
        }
    };
    // The one that a user gets.
    let preferred = luminaire::backend::devices().expect("the devices were there").into_iter().find(|d| d.preferred);
    let Some(device) = preferred.map(|d| &devices[d.index]) else {
        skip("no Vulkan device is usable");
        return Vec::new();
    };
    let open =
        |ray_query| Intersector { device: Device::open(device, ray_query).expect("the device opens"), ray_query };
    let mut backends = vec![open(false)];
    if std::env::var_os(WITHOUT_RAY_QUERY).is_some() {
        assert!(!device.ray_query, "{} was said to have no ray query", device.driver);
    } else if device.ray_query {
        backends.push(open(true));
    } else {
        skip(&format!("{} has no ray query; only the compute BVH was tested", device.name));
    }
    backends
}

/// On the driver without ray query, which is several times slower, tests of what does not depend on the driver return at once: they
/// have run on the other one.
fn on_the_old_driver() -> bool {
    std::env::var_os(WITHOUT_RAY_QUERY).is_some()
}

/// Runs a test on every intersector, and sees that Vulkan had nothing to complain about.
fn on_every_backend(test: impl Fn(&Intersector)) {
    for backend in backends() {
        test(&backend);
    }
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}
