//! luminaire: a path tracer on Vulkan that is held against a double-precision reference.
//!
//! A scene is plain data ([`scene`]). Two tracers turn it into radiance samples: the double-precision [`mod@reference`] and the
//! GPU renderer ([`gpu`]: one GLSL kernel, on ray queries or on a compute-shader BVH). Both draw the same
//! [`sampling`] numbers, so they are compared sample by sample. A [`film`] adds the samples up and knows how uncertain they are; [`render`]
//! drives it all, and [`backend`] chooses who traces.
//!
//! On it stand three crates beside it: `luminaire-measure` compares pictures, benchmarks, and shows where methods fail; `luminaire-view` is the window;
//! `luminaire-cli` is the program `luminaire`.
//!
//! ```text
//! scene file + OBJ/MTL ─ scene::load ─► Scene ─┬─► reference (f64) ───────────────┐
//!                                              └─► acceleration (ray query | BVH) ├─► Film ─► PNG / EXR / HDR
//!                                                  + buffers ─► path_trace kernel ┘
//! ```
//!
//! # Rendering from a program
//!
//! ```
//! use luminaire::backend::{self, Backend, Request};
//! use luminaire::{render::Limits, scene};
//!
//! # fn main() -> luminaire::Result<()> {
//! # let temporary = tempfile::tempdir().unwrap();
//! # let folder = temporary.path();
//! let mut scene = scene::load("scenes/cornell/cornell.toml".as_ref())?;
//! (scene.film.width, scene.film.height) = (32, 32);
//! // `Request::default()` takes the fastest backend of the best device.
//! let request = Request { backend: Some(Backend::Cpu), device: None };
//! let mut renderer = backend::open(&scene, &request)?;
//! let film = renderer.render(Limits { spp: Some(4), ..Limits::default() })?;
//! film.save(&folder.join("cornell.png"), backend::development(&scene))?;
//! # assert_eq!((film.width, film.least_samples()), (32, 4));
//! # assert!(folder.join("cornell.png").is_file());
//! # Ok(())
//! # }
//! ```
//!
//! The parts: a [`Scene`] is loaded ([`scene::load`]) or built in code ([`scene::build`]) and may be changed until it is opened; a [`Renderer`] is that scene on a
//! device ([`backend::open`]); a [`Film`] holds the samples, and what follows from them: [`Film::mean`], [`Film::error`],
//! [`Film::to_linear`]. To watch a render, end it, or go on with it, there is [`Renderer::resume`]; [`part`] keeps one in a file.
//!
//! `examples/` has programs: `render_file` (a file to a picture, with progress), `scene_in_code` (no file; all backends compared), `progressive` (one
//! thread renders, another one looks).
//!
//! # From the lecture to the code
//!
//! Every system of the lecture "Raytracing" (R. Kuffner dos Anjos), slide by slide. Shaders are under `shaders/`; each function has a twin in
//! [`mod@reference`], mostly of the same name (the loop of its `radiance` is split into `camera_path` and `extend_path`). Tests are under `tests/`,
//! scenes under `scenes/`; every scene is rendered by every backend against the reference (`gpu::scenes`).
//!
//! | | slide | file: function | tests | scene |
//! |---|---|---|---|---|
//! | 1 | Surface Element Class: `Surfel`, Blinn-Phong (normalised) | `surfel.glsl`: `surfel`; `bsdf.glsl`: `bsdf_and_pdf`; [`reference::surfel`], [`reference::bsdf`] | `gpu::functions::bsdf_matches`, `reference::scattering` | `plates` |
//! | 2 | A Simple Raytracer: direct light and the ambient term | `path.glsl`: `SIMPLE`; [`scene::Integrator::Simple`] | `gpu::pictures` ("simple"), `gpu::features` ("parallel") | `simple` |
//! | 3 | Path Trace Function: emission, direct, indirect light | `path.glsl`: `extend_path`; [`reference::path`] | `gpu::pictures`, `reference::transport` | `cornell` |
//! | 4 | Lighting Functions: direct light of a point, ambient | `luminaire.glsl`: `direct_light`; [`reference::luminaire`] | `gpu::pictures::inverse_square_and_none_at_infinity` | `simple`, `shadows` |
//! | 5 | Intersection Problems: displacing the intersection | `surfel.glsl`: `offset_ray_origin` | `gpu::intersection::surfaces_do_not_hit_themselves` | all |
//! | 6 | Shadows & Attenuation: shadow rays, inverse square, infinity | `luminaire.glsl`: `direct_light`; `intersect*.glsl`: `occluded` | `reference::light`, `gpu::intersection` | `shadows`, `spotlights` |
//! | 7 | Inefficient Integration: evenly distributed directions | `warp.glsl`: `uniform_hemisphere`; [`scene::Directions::Uniform`] | `reference::scattering`, `gpu::features::every_choice_of_the_estimator_equals_the_reference` | `directions` |
//! | 8 | More Efficient Integration: cosine, BSDF | `warp.glsl`: `cosine_hemisphere`, `glossy_half_vector`; `bsdf.glsl`: `bsdf_direction` | `gpu::densities::everything_is_drawn_by_its_density`, `reference::scattering` | `directions` |
//! | 9 | Image Loop: samples added up at the image; samples or time end it | `path_trace.comp`; [`render`]; [`sampling`] | `render::tests`, `sampling` | all |
//! | 10 | Extinction: re-weighted, or literally | `path.glsl`: `EXTINCTION`; `scatter.glsl`: `survival` | `reference::estimators` (furnaces) | `extinction`, `furnace` |
//! | 11 | Albedo Termination: a threshold | `path.glsl`: `THRESHOLD` | `reference::estimators` (furnaces) | `extinction` |
//! | 12 | Area Luminaires: of any shape, by area or solid angle, with MIS | `luminaire.glsl`: `direct_light`, `is_near`; `warp.glsl`: `spherical_triangle` | `gpu::pictures::irradiance_of_a_triangle_lamp`, `reference::light` | `lamps`, `many-lights` |
//! | 13 | Impulse Reflection: 60 % impulse, 40 % other | `impulse.glsl`: `impulses`; `scatter.glsl`: `scatter`; [`reference::impulse`] | `reference::impulses` | `mirror` |
//! | 14 | Adding Transmission: refraction, BSDF over the sphere | `fresnel.glsl`: `fresnel`, `refract_direction`; [`reference::fresnel`], [`reference::impulse`] | `reference::impulses`, `gpu::features` ("glass") | `glass`, `furnace/glass` |
//! | 15 | Sensor Modelling: pixel filter, lens, projection, shift | `sensor.glsl`: `sensor_ray`; [`reference::sensor`] | `reference::sensor`, `gpu::sensor` | `lens`, `lens/orthographic` |
//! | 16 | Assumptions: escaping light disappears, steady state, RGB | `path.glsl`: `extend_path`; [`scene::Environment`] where a scene asks for one | `reference::environment`, `gpu::features` ("open air") | `furnace`, `environment` |
//!
//! Beyond the slides: multiple importance sampling (`luminaire.glsl`: `emission_weight`, `power_heuristic`), a tree over many luminaires
//! (`light_tree.glsl`: `choose_by_tree`; [`scene::light_tree`], [`reference::light_tree`]; `gpu::light_tree`, `reference::light_tree`), spots, suns and
//! photometric lamps (`luminaire.glsl`: `spot_falloff`, `sunlight`; `sun.glsl`, `profile.glsl`; [`reference::sun`], [`reference::profile`]; `reference::directed`,
//! `gpu::densities`), textures and holes (`texture.glsl`), an environment (`environment.glsl`), Owen-scrambled Sobol points ([`sampling::sobol`]), metallic-roughness surfaces with rough glass
//! (`physical.glsl`, `microfacet.glsl`; [`scene::Physical`], [`reference::physical`]; `gpu::physical`, `reference::physical`). Where a line of a slide is wrong taken
//! literally (the half vector, missing densities, emission counted twice), what it means is computed; the extinction without
//! re-weighting and the threshold stay selectable ([`scene::PRESETS`]), because their errors are instructive.

pub mod backend;
#[cfg(feature = "denoise")]
pub mod denoise;
pub mod error;
pub mod files;
pub mod film;
pub mod gpu;
mod memory;
pub mod part;
pub mod picture;
pub mod reference;
pub mod render;
pub mod sampling;
pub mod scene;

pub use backend::Renderer;
pub use error::{Error, Result};
pub use film::Film;
/// The vectors and maps that scenes are made of, in the version that this library wants.
pub use glam;
pub use scene::Scene;
