//! The double-precision tracer: the lecture, function by function, as plain as possible. It says what is right.
//!
//! Everything is `f64`, starting from the scene's `f32` numbers, and every random number is the one that the kernel draws
//! ([`crate::sampling`]). The shader function that does the same mostly has the same name:
//!
//! | lecture | here |
//! |---|---|
//! | Surface Element Class | [`surfel`]: `Surfel`; [`bsdf`]: `Surfel::bsdf`; [`texture`]: `bilinear` |
//! | Lighting Functions, Shadows & Attenuation, Area Luminaires | [`luminaire`]: `direct_light`; [`sun`]; [`profile`]; [`light_tree`]; [`environment`] |
//! | Inefficient Integration, More Efficient Integration | [`bsdf`]: `bsdf_direction`, `bsdf_pdf`; [`warp`] |
//! | Extinction | [`scatter`]: `scatter`, `survival` |
//! | Impulse Reflection, Adding Transmission | [`fresnel`]: `fresnel`, `refract`; [`impulse`]: `impulses` |
//! | (normal and height maps) | [`normal_map`] |
//! | Intersection Problems | [`intersect`], [`surfel`]: `offset_ray_origin` |
//! | Sensor Modelling | [`sensor`]: `sensor_ray` |
//! | (surfaces of real scenes) | [`physical`], [`microfacet`], [`albedo`], [`absorption`] |
//! | (what no estimator of the lecture finds) | [`lost_light`] |
//! | (how bright a picture is to be shown) | `AutoExposure` |
//! | Path Trace Function, A Simple Raytracer, Albedo Termination | [`path`]: `radiance` |

pub mod absorption;
pub mod albedo;
mod aov;
mod auto_exposure;
pub mod bsdf;
pub mod environment;
pub mod fresnel;
pub mod hit;
pub mod impulse;
mod instance;
pub mod intersect;
pub mod light_tree;
pub mod lost_light;
pub mod luminaire;
pub mod microfacet;
pub mod normal_map;
pub mod path;
pub mod physical;
mod physical_surface;
mod prepared_scene;
pub mod profile;
mod rounding;
pub mod scatter;
pub mod sensor;
pub mod sun;
pub mod surfel;
pub mod texture;
mod tracer;
mod tree;
pub mod warp;

pub use auto_exposure::AutoExposure;
pub use prepared_scene::Reference;
