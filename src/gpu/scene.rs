//! A scene as the kernels see it: buffers, converted from the plain data.

use super::accel::Geometry;
use super::layout;
use super::memory_check::Budget;
use super::pack::frame::{aim, estimate, frame};
use super::pack::light_tree::light_tree;
use super::pack::luminaire::luminaires;
use super::pack::material::material;
use super::pack::texture::{environment, textures};
use super::specialization::KernelModel;
use super::vulkan::binding::Binding;
use super::vulkan::buffer::Buffer;
use super::vulkan::device::Device;
use super::vulkan::texel_buffer::TexelBuffer;
use crate::Result;
use crate::scene::{FilmSettings, Integrator, LightChoice, LuminaireTable, Scene, Sensor};
use ash::vk;
use bytemuck::Pod;
use glam::DVec3;
use std::sync::Arc;

/// Bindings 0 to 6 and 9 to 15.
pub(super) struct GpuScene {
    frame: Buffer,
    /// What `frame` holds.
    frame_data: layout::Frame,
    geometry: Geometry,
    materials: TexelBuffer,
    luminaires: TexelBuffer,
    textures: TexelBuffer,
    texels: TexelBuffer,
    environment_texels: TexelBuffer,
    environment_slots: TexelBuffer,
    light_tree: TexelBuffer,
    has_light_tree: bool,
    /// The scene's [`Scene::world_bounds`].
    bounds: (DVec3, DVec3),
    pub(super) model: KernelModel,
}

impl GpuScene {
    /// Uploads a scene. `adjust` may change what the kernel models, to more than the scene needs.
    pub(super) fn new(
        device: &Arc<Device>,
        scene: &Scene,
        ray_query: bool,
        adjust: impl FnOnce(&mut KernelModel),
    ) -> Result<Self> {
        let table = LuminaireTable::new(scene);
        let mut model = KernelModel::with(scene, &table);
        adjust(&mut model);
        Budget::of(scene, &table, ray_query, &model).check(device)?;
        let (geometry, places) = Geometry::build(device, scene, ray_query, &model, table.tree.as_ref())?;
        let materials: Vec<_> = (0..scene.materials.len()).map(|i| material(scene, &table, i)).collect();
        let luminaires = luminaires(scene, &table, &places);
        let (textures, texels) = if model.features.textures || model.features.holes {
            textures(&scene.textures)
        } else {
            Default::default()
        };
        let (environment_texels, environment_slots) = match (&scene.environment, &table.environment) {
            (Some(sky), Some(distribution)) => environment(sky, distribution),
            _ => Default::default(),
        };
        // Without one, zeros say so to a kernel that could use it.
        let tree = table.tree.as_ref().map_or_else(|| vec![[0; 4]; layout::LIGHT_TREE_HEADER], light_tree);
        let frame_data = frame(scene, &table);
        Ok(GpuScene {
            frame: Buffer::upload(device, "frame", &[frame_data], vk::BufferUsageFlags::UNIFORM_BUFFER)?,
            frame_data,
            geometry,
            materials: texel_buffer(device, "materials", &materials)?,
            luminaires: texel_buffer(device, "luminaires", &luminaires)?,
            textures: texel_buffer(device, "textures", &textures)?,
            texels: texel_buffer(device, "texels", &texels)?,
            environment_texels: texel_buffer(device, "environment", &environment_texels)?,
            environment_slots: texel_buffer(device, "environment choice", &environment_slots)?,
            light_tree: texel_buffer(device, "light tree", &tree)?,
            has_light_tree: table.tree.is_some(),
            bounds: scene.world_bounds(),
            model,
        })
    }

    /// Puts another camera and film in the place of the present ones. The kind of projection has to stay: it is a part of the kernel.
    pub(super) fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        aim(&mut self.frame_data, sensor, film, self.bounds);
        self.frame.write(&[self.frame_data])
    }

    /// Puts another integrator in the place of the present one; the kernel has to be made again, with the constants of `model`.
    pub(super) fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        self.model.integrator = *integrator;
        // One that was not made with the scene is not made now.
        self.model.features.light_tree =
            self.has_light_tree && integrator.estimator().light_choice != LightChoice::Power;
        estimate(&mut self.frame_data, integrator);
        self.frame.write(&[self.frame_data])
    }

    /// Bindings 0 to 15, of which 7 and 8 are the caller's.
    pub(super) fn bindings<'a>(&'a self, seven: &'a Buffer, eight: &'a Buffer) -> Vec<Binding<'a>> {
        let [intersector, triangles, normals, objects, uvs, colours] = self.geometry.bindings();
        vec![
            Binding::Uniform(&self.frame),
            intersector,
            triangles,
            normals,
            objects,
            Binding::Texel(&self.materials),
            Binding::Texel(&self.luminaires),
            Binding::Storage(seven),
            Binding::Storage(eight),
            uvs,
            Binding::Texel(&self.textures),
            Binding::Texel(&self.texels),
            Binding::Texel(&self.environment_texels),
            Binding::Texel(&self.environment_slots),
            colours,
            Binding::Texel(&self.light_tree),
        ]
    }
}

/// A buffer that is read by texels alone.
fn texel_buffer<T: Pod>(device: &Arc<Device>, name: &str, data: &[T]) -> Result<TexelBuffer> {
    TexelBuffer::new(device, name, data, vk::BufferUsageFlags::empty())
}
