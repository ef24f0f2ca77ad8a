//! A scene is plain, validated data: no Vulkan, no file handles.
//!
//! Lengths are in the scene's own unit (the unit of the OBJ files), colours are linear RGB. Everything is `f32` because that
//! is what the files hold and what the GPU receives; the reference widens the same numbers to `f64`, so both tracers see
//! the same scene to the last bit.

pub mod build;
mod darkness;
mod environment;
mod environment_file;
mod estimator;
mod filter;
mod load;
mod luminaire;
mod map_options;
mod material;
mod mtl;
mod obj;
mod obj_faces;
mod obj_text;
mod polygon;
mod preview;
mod surface;
mod text;
mod texture;
mod toml;
mod toml_settings;
mod toml_tables;
mod toml_values;

pub use crate::sampling::Sampler;
pub use environment::EnvironmentDistribution;
pub use estimator::{
    AreaSampling, Directions, Estimator, EstimatorChanges, Extinction, Integrator, LightSampling, PRESETS,
};
pub use load::load;
pub(crate) use luminaire::widen;
pub use luminaire::{EmissiveTriangle, LuminaireTable, SampledLuminaire};
pub use surface::{Maps, Material, Texture};

use glam::{Affine3A, Vec2, Vec3};
use std::path::PathBuf;

/// A whole scene, checked: indices are in range, numbers are finite, there is at least one triangle.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The file it came from.
    pub path: PathBuf,
    /// Meshes, in object space; an OBJ file is one mesh.
    pub meshes: Vec<Mesh>,
    /// Instances of meshes. Never empty.
    pub objects: Vec<Object>,
    /// Materials; triangles and objects refer to them by index. Never empty.
    pub materials: Vec<Material>,
    /// Images; the maps of materials refer to them by index.
    pub textures: Vec<Texture>,
    /// Point luminaires and luminaires at infinity. Area luminaires are the emissive triangles of `objects`.
    pub luminaires: Vec<Luminaire>,
    /// Light from where rays escape to; none: escaping light disappears.
    pub environment: Option<Environment>,
    /// The camera.
    pub sensor: Sensor,
    /// Film size and pixel filter.
    pub film: FilmSettings,
    /// Which estimator runs.
    pub integrator: Integrator,
    /// Samples, seed and exposure, unless the caller wants others.
    pub settings: RenderSettings,
    /// What the loader had to guess, drop or scale; one sentence each, with file and line where there is one.
    pub warnings: Vec<String>,
}

/// Triangles in object space.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// A name for messages: the file name.
    pub name: String,
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals: empty (no triangle has any), or one for each position; a zero vector means "none here", and a
    /// triangle with such a corner is shaded flat.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v upwards: empty (no triangle has any), or one for each position.
    pub uvs: Vec<Vec2>,
    /// The triangles; all have a non-zero area.
    pub triangles: Vec<Triangle>,
}

/// Three corners and a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Mesh::positions`] (and [`Mesh::normals`]).
    pub vertices: [u32; 3],
    /// Index into [`Scene::materials`].
    pub material: u32,
}

/// An instance of a mesh.
#[derive(Debug, Clone)]
pub struct Object {
    /// A name for messages.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Object space to world space; invertible, may mirror and scale unevenly.
    pub object_to_world: Affine3A,
    /// Replaces the material of every triangle, if given.
    pub material: Option<u32>,
}

/// Light from infinitely far away in all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Radiance, or a factor to the image.
    pub radiance: Vec3,
    /// The image; none: the same from everywhere.
    pub image: Option<EnvironmentImage>,
    /// Degrees by which the image is turned about +y, counter-clockwise seen from above.
    pub rotation: f32,
}

/// A latitude-longitude image: the upper edge is +y, the middle is -z, the right half is +x.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentImage {
    /// A name for messages: the file name.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Linear RGB from the upper left, row by row; not negative, finite, not all zero.
    pub texels: Vec<Vec3>,
}

/// A luminaire without an area.
#[derive(Debug, Clone, PartialEq)]
pub enum Luminaire {
    /// An impulse in space.
    Point {
        /// World position.
        position: Vec3,
        /// Radiant intensity, in radiance times length squared.
        intensity: Vec3,
    },
    /// An impulse in direction: parallel light that does not attenuate.
    Infinite {
        /// Unit vector in which the light travels.
        direction: Vec3,
        /// Irradiance on a surface perpendicular to `direction`.
        irradiance: Vec3,
    },
}

/// The camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Eye point.
    pub position: Vec3,
    /// Point in the middle of the picture.
    pub target: Vec3,
    /// A direction that is up in the picture; not parallel to the line of sight.
    pub up: Vec3,
    /// How directions become pixels.
    pub projection: Projection,
    /// A thin lens; none: a pinhole, everything is in focus.
    pub lens: Option<Lens>,
}

/// How directions become pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// All rays through the eye point.
    Perspective {
        /// Vertical field of view in degrees, in (0, 180).
        fov: f32,
    },
    /// Parallel rays; with a lens those through the middle of the aperture, which moves along with the pixel (a telecentric lens).
    Orthographic {
        /// Height of what the picture shows, in the scene's unit; greater than 0.
        height: f32,
    },
}

/// A thin lens around the eye point; with parallel rays around the point where each ray begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Radius of the aperture, greater than 0; for blades, of the circle through the corners.
    pub radius: f32,
    /// Distance along the line of sight of the plane that is in focus; greater than 0.
    pub focus_distance: f32,
    /// Corners of the aperture, at least 3; 0: a disk.
    pub blades: u32,
    /// Degrees by which the aperture is turned.
    pub rotation: f32,
}

/// Size of the picture and its pixel filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// How a pixel weighs the light around it.
    pub filter: Filter,
    /// Half the width of the filter's square in pixels; greater than 0.
    pub filter_radius: f32,
}

/// Pixel filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Filter {
    /// Evenly over a square.
    #[default]
    Box,
    /// Linear to zero at the radius, in x times in y.
    Tent,
    /// A Gaussian with a standard deviation of a third of the radius, cut there.
    Gaussian,
    /// The four-term Blackman-Harris window over the diameter.
    #[serde(rename = "blackman-harris")]
    BlackmanHarris,
}

impl Filter {
    /// Half the width of the filter's square in pixels, unless a scene says otherwise.
    pub fn default_radius(self) -> f32 {
        match self {
            Filter::Box => 0.5,
            Filter::Tent => 1.0,
            Filter::Gaussian | Filter::BlackmanHarris => 1.5,
        }
    }
}

/// What a scene file may say about its own rendering.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RenderSettings {
    /// Samples a pixel.
    pub spp: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Exposure in stops: the PNG shows radiance times 2^exposure.
    pub exposure: f32,
    /// Where the random numbers come from.
    pub sampler: Sampler,
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings { spp: 64, seed: 0, exposure: 0.0, sampler: Sampler::default() }
    }
}

impl Scene {
    /// Triangles over all instances.
    pub fn triangle_count(&self) -> u64 {
        self.objects.iter().map(|o| self.meshes[o.mesh as usize].triangles.len() as u64).sum()
    }

    /// The material of a triangle of an instance: the instance's own, else the triangle's.
    pub fn material_of(&self, object: &Object, triangle: &Triangle) -> &Material {
        &self.materials[object.material.unwrap_or(triangle.material) as usize]
    }
}

impl Scene {
    /// World-space bounding box of all instances (of the corners of the meshes' own boxes, so not always the smallest).
    pub fn world_bounds(&self) -> (glam::DVec3, glam::DVec3) {
        let boxes: Vec<_> = self.meshes.iter().map(Mesh::bounds).collect();
        let mut low = glam::DVec3::INFINITY;
        let mut high = glam::DVec3::NEG_INFINITY;
        for object in &self.objects {
            let to_world = luminaire::widen(object.object_to_world);
            let (a, b) = boxes[object.mesh as usize];
            for corner in 0..8 {
                let pick = |bit: u32, axis: usize| if corner >> bit & 1 == 0 { a[axis] } else { b[axis] };
                let p = Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2));
                let p = to_world.transform_point3(p.as_dvec3());
                low = low.min(p);
                high = high.max(p);
            }
        }
        (low, high)
    }
}

impl Mesh {
    /// Object-space bounding box of the positions.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
    }
}
