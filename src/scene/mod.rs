//! A scene is plain, validated data: no Vulkan, no file handles.
//!
//! Lengths are in the scene's own unit (the unit of the OBJ files), colours are linear RGB. Everything is `f32` because that
//! is what the files hold and what the GPU receives; the reference widens the same numbers to `f64`, so both tracers see
//! the same scene to the last bit.

pub mod albedo_table;
pub mod brushed_table;
pub mod build;
mod coat;
mod darkness;
mod environment;
mod estimator;
mod filter;
mod first_view;
mod lamp_shapes;
pub mod light_tree;
mod load;
mod luminaire;
mod luminaire_table;
mod material;
mod mesh;
mod overlap;
mod physical;
mod profile;
pub(crate) mod rounding;
mod sensor;
mod sets;
mod settings;
mod studio_sky;
mod sun_disc;
mod tangents;
mod texture;
mod world;

pub use crate::picture::Tone;
pub use crate::sampling::Sampler;
pub use coat::coat_transmittance;
pub use environment::{Environment, EnvironmentDistribution, EnvironmentImage};
pub use estimator::{
    AreaSampling, Directions, Estimator, EstimatorChanges, Extinction, Integrator, LightChoice, LightSampling, PRESETS,
};
pub use filter::Filter;
pub use first_view::{FirstView, Side};
pub use light_tree::LightTree;
pub use load::{Choices, SceneFile, Sky, Up, is_bare, is_scene, load, load_with, metal_name, scene_file, use_camera};
pub use luminaire::{LEAST_ANGLE, Luminaire, one_minus_cos, photometric_frame, spot_edge};
pub use luminaire_table::{EmissiveTriangle, LuminaireTable, SampledLuminaire};
pub use material::{BumpMap, Maps, Material, NormalMap};
pub use mesh::{Mesh, Object, Triangle};
pub(crate) use mesh::{moved_box, outward, widen};
pub use physical::{
    COAT_INDEX, ChannelMap, LEAST_ALPHA, Physical, PhysicalMaps, conductor_average, conductor_reflectance,
};
pub use profile::Profile;
pub use sensor::{Camera, Lens, Pivot, Projection, Sensor};
pub use settings::{Exposure, FilmSettings, RenderSettings};
pub use sun_disc::SunDisc;
pub use texture::Texture;
pub use world::Scene;
