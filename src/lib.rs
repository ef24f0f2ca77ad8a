//! luminaire: a path tracer on Vulkan that is held against a double-precision reference.
//!
//! A scene is plain data ([`scene`]). Two tracers turn it into radiance samples: the double-precision [`mod@reference`] and the
//! GPU renderer ([`gpu`], [`accel`]: one GLSL kernel, on ray queries or on a compute-shader BVH). Both draw the same
//! [`sampling`] numbers, so they are compared sample by sample. A [`film`] adds the samples up; [`render`] drives it all, and
//! [`backend`] chooses who traces.
//!
//! ```text
//! scene file + OBJ/MTL ─ scene::load ─► Scene ─┬─► reference (f64) ───────────────┐
//!                                              └─► acceleration (ray query | BVH) ├─► Film ─► PNG / EXR / HDR
//!                                                  + buffers ─► path_trace kernel ┘
//! ```
//!
//! ```no_run
//! use luminaire::{backend, image_io, render, scene};
//! use std::{path::Path, sync::atomic::AtomicBool};
//!
//! # fn main() -> luminaire::Result<()> {
//! let scene = scene::load(Path::new("scenes/cornell/cornell.toml"))?;
//! let mut opened = backend::open(&scene, &backend::Request::default())?;
//! let limits = render::Limits { spp: Some(16), seconds: None };
//! let size = (scene.film.width, scene.film.height);
//! let rendered = render::render(opened.tracer.as_mut(), size, limits, &mut |_| {}, &AtomicBool::new(false))?;
//! image_io::save(Path::new("cornell.png"), &rendered.film, scene.settings.exposure)?;
//! # Ok(())
//! # }
//! ```
//!
//! # From the lecture to the code
//!
//! What is here of the lecture "Raytracing" (R. Kuffner dos Anjos). Shaders are under `shaders/`; each function has a twin of
//! the same name in [`mod@reference`] (the loop of its `radiance` is split into `camera_path` and `extend_path`).
//!
//! | slide | system | shader | tests |
//! |---|---|---|---|
//! | Surface Element Class | `Surfel`, normalised Blinn-Phong | `surfel.glsl`, `scatter.glsl` | `gpu::functions::bsdf_matches` |
//! | A Simple Raytracer | direct light and the ambient term | `path.glsl` (`SIMPLE`) | `gpu::pictures`, scene `simple` |
//! | Path Trace Function | emission, direct and indirect light | `path.glsl` | `gpu::pictures` |
//! | Lighting Functions | direct light, ambient | `luminaire.glsl` | `gpu::pictures::inverse_square_and_none_at_infinity` |
//! | Intersection Problems | origins offset by their error bounds | `surfel.glsl`, `offset_ray_origin` | `gpu::intersection::surfaces_do_not_hit_themselves` |
//! | Shadows & Attenuation | shadow rays, inverse square, luminaires at infinity | `luminaire.glsl` | `reference::light` |
//! | More Efficient Integration | cosine-distributed directions | `warp.glsl`, `scatter.glsl` | `gpu::functions::directions_are_cosine_distributed` |
//! | Image Loop | samples added up at the image; samples or time end it | `path_trace.comp`, [`render`] | `render::tests` |
//! | Extinction | re-weighted by the share that survives | `path.glsl` | furnaces in `gpu::pictures` and `reference::transport` |
//! | Area Luminaires | any set of emissive triangles, by area | `luminaire.glsl` | `gpu::pictures::irradiance_of_a_triangle_lamp` |
//! | Sensor Modelling | box filter over the pixel, pinhole | `sensor.glsl` | `gpu::pictures` |
//! | Assumptions | escaping light disappears, steady state, RGB | `path.glsl` | all of them |
//!
//! Not here yet: uniform directions, albedo termination, impulse reflection, transmission, the lens.

pub mod accel;
pub mod backend;
pub mod bvh;
pub mod error;
pub mod film;
pub mod gpu;
pub mod image_io;
pub mod reference;
pub mod render;
pub mod sampling;
pub mod scene;

pub use error::{Error, Result};
