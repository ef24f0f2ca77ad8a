//! A scene is plain, validated data: no Vulkan, no file handles.
//!
//! Lengths are in the scene's own unit (the unit of the OBJ files), colours are linear RGB. Everything is `f32` because that
//! is what the files hold and what the GPU receives; the reference widens the same numbers to `f64`, so both tracers see
//! the same scene to the last bit.

mod load;
mod luminaire;
mod material;
mod mtl;
mod obj;
mod obj_text;
mod preview;
mod text;
mod toml;
mod toml_values;

pub use load::load;
pub(crate) use luminaire::widen;
pub use luminaire::{EmissiveTriangle, LuminaireTable, SampledLuminaire};

use glam::{Affine3A, Vec3};
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
    /// Point luminaires and luminaires at infinity. Area luminaires are the emissive triangles of `objects`.
    pub luminaires: Vec<Luminaire>,
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

/// The surface's scattering and emission: normalised Blinn-Phong (slide "Surface Element Class").
///
/// `lambert + glossy <= 1` in every channel; the loader scales down what exceeds it and warns.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name in the MTL or scene file.
    pub name: String,
    /// Albedo for the ambient stand-in of the simple ray tracer (`Ka`).
    pub ambient: Vec3,
    /// Diffuse albedo (`Kd`).
    pub lambert: Vec3,
    /// Glossy albedo at normal incidence (`Ks`).
    pub glossy: Vec3,
    /// Blinn-Phong exponent, >= 0 (`Ns`).
    pub exponent: f32,
    /// Emitted radiance, on both sides (`Ke`).
    pub emission: Vec3,
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

/// A pinhole perspective camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Eye point.
    pub position: Vec3,
    /// Point in the middle of the picture.
    pub target: Vec3,
    /// A direction that is up in the picture; not parallel to the line of sight.
    pub up: Vec3,
    /// Vertical field of view in degrees, in (0, 180).
    pub fov: f32,
}

/// Size of the picture and its pixel filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FilmSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// How a pixel weighs the light around it.
    pub filter: Filter,
}

/// Pixel filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Filter {
    /// Evenly over the pixel's own square.
    #[default]
    Box,
}

/// Which of the lecture's estimators computes the radiance along a camera ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Integrator {
    /// Emission, direct light of one luminaire chosen by power, indirect light by cosine-distributed directions, ended by extinction.
    Path {
        /// At most this many indirect bounces; none: extinction alone ends a path. 0 is direct light only.
        max_bounces: Option<u32>,
    },
    /// The simple ray tracer: emission, direct light, and the ambient term in place of indirect light.
    Simple {
        /// Ambient radiance, multiplied by the surface's ambient albedo.
        ambient: Vec3,
    },
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
}

impl Default for RenderSettings {
    fn default() -> Self {
        RenderSettings { spp: 64, seed: 0, exposure: 0.0 }
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
