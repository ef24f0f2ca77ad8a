//! A scene as the kernels see it: buffers, converted from the plain data.

use super::accel::Geometry;
use super::bvh::MeshBvh;
use super::layout;
use super::memory_check::Budget;
use super::pack::environment::environment;
use super::pack::frame::{aim, estimate, frame, light};
use super::pack::light_tree::light_tree;
use super::pack::luminaire::luminaires;
use super::pack::material::material;
use super::pack::physical::physical;
use super::pack::texture::textures;
use super::specialization::KernelModel;
use super::vulkan::binding::Binding;
use super::vulkan::buffer::Buffer;
use super::vulkan::device::Device;
use super::vulkan::texel_buffer::TexelBuffer;
use crate::Result;
use crate::scene::{Estimator, FilmSettings, Integrator, LightChoice, LightSampling, LuminaireTable, Scene, Sensor};
use ash::vk;
use bytemuck::Pod;
use glam::DVec3;
use std::sync::Arc;

/// Bindings 0 to 6 and 9 to 17.
pub(super) struct GpuScene {
    frame: Buffer,
    /// What `frame` holds.
    frame_data: layout::Frame,
    geometry: Geometry,
    lighting: Lighting,
    textures: TexelBuffer,
    texels: TexelBuffer,
    /// What the lighting is made of again for another integrator, with the places of the meshes' triangles; none if it is always the same.
    lit: Option<(Scene, Vec<MeshBvh>)>,
    /// Whether the scene was made with a light tree, so that geometry leads to its leaves.
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
        let scene = &*scene.with_tangents();
        let table = LuminaireTable::new(scene);
        let mut model = KernelModel::with(scene, &table);
        adjust(&mut model);
        Budget::of(scene, &table, ray_query, &model).check(device)?;
        let (geometry, places) = Geometry::build(device, scene, ray_query, &model, table.tree.as_ref())?;
        let lighting = Lighting::new(device, scene, &table, &places)?;
        let (textures, texels) = if model.features.textures || model.features.holes {
            textures(&scene.textures)
        } else {
            Default::default()
        };
        let frame_data = frame(scene, &table);
        Ok(GpuScene {
            frame: Buffer::upload(device, "frame", &[frame_data], vk::BufferUsageFlags::UNIFORM_BUFFER)?,
            frame_data,
            geometry,
            lighting,
            textures: texel_buffer(device, "textures", &textures)?,
            texels: texel_buffer(device, "texels", &texels)?,
            lit: scene.environment.is_some().then(|| (scene.clone(), places)),
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

    /// Puts another integrator in the place of the present one; kernels have to be made again, with the constants of `model` and what is bound now.
    pub(super) fn integrate(&mut self, device: &Arc<Device>, integrator: &Integrator) -> Result<()> {
        if let Some((scene, places)) = &mut self.lit {
            let same = LuminaireTable::is_same_for(scene, integrator);
            scene.integrator = *integrator;
            if !same {
                // With a tree or without as it was made: geometry leads to its leaves, and kernels of other integrators may come back to it.
                let estimator = integrator.estimator();
                let light_choice = if self.has_light_tree { LightChoice::Tree } else { LightChoice::Power };
                let light_sampling = match estimator.light_sampling {
                    LightSampling::None => LightSampling::Direct,
                    sampling => sampling,
                };
                scene.integrator = Integrator::Path(Estimator { light_choice, light_sampling, ..estimator });
                let table = LuminaireTable::new(scene);
                scene.integrator = *integrator;
                self.lighting = Lighting::new(device, scene, &table, places)?;
                light(&mut self.frame_data, &table);
                self.model.features.environment_sampling = table.environment.is_some();
            }
        }
        self.model.integrator = *integrator;
        // One that was not made with the scene is not made now.
        self.model.features.light_tree =
            self.has_light_tree && integrator.estimator().light_choice != LightChoice::Power;
        estimate(&mut self.frame_data, integrator);
        self.frame.write(&[self.frame_data])
    }

    /// Bindings 0 to 16, of which 7 and 8 are the caller's.
    pub(super) fn bindings<'a>(&'a self, seven: &'a Buffer, eight: &'a Buffer) -> Vec<Binding<'a>> {
        let [intersector, triangles, normals, objects, uvs, colours, tangents] = self.geometry.bindings();
        vec![
            Binding::Uniform(&self.frame),
            intersector,
            triangles,
            normals,
            objects,
            Binding::Texel(&self.lighting.materials),
            Binding::Texel(&self.lighting.luminaires),
            Binding::Storage(seven),
            Binding::Storage(eight),
            uvs,
            Binding::Texel(&self.textures),
            Binding::Texel(&self.texels),
            Binding::Texel(&self.lighting.environment_texels),
            Binding::Texel(&self.lighting.environment_choice),
            colours,
            Binding::Texel(&self.lighting.light_tree),
            Binding::Texel(&self.lighting.physical),
            tangents,
        ]
    }
}

/// The luminaires, and what knows how often they are chosen.
struct Lighting {
    materials: TexelBuffer,
    luminaires: TexelBuffer,
    environment_texels: TexelBuffer,
    environment_choice: TexelBuffer,
    light_tree: TexelBuffer,
    physical: TexelBuffer,
}

impl Lighting {
    fn new(device: &Arc<Device>, scene: &Scene, table: &LuminaireTable, places: &[MeshBvh]) -> Result<Self> {
        let (physical, places_of_physical) = physical(scene);
        let materials = places_of_physical.iter().enumerate();
        let materials: Vec<_> = materials.map(|(i, physical)| material(scene, table, i, *physical)).collect();
        let (environment_texels, environment_choice) =
            scene.environment.as_ref().map(|sky| environment(sky, table.environment.as_ref())).unwrap_or_default();
        // Without one, zeros say so to a kernel that could use it.
        let tree = table.tree.as_ref();
        let tree = tree.map_or_else(|| vec![[0; 4]; layout::LIGHT_TREE_HEADER], |tree| light_tree(tree, table));
        Ok(Lighting {
            materials: texel_buffer(device, "materials", &materials)?,
            luminaires: texel_buffer(device, "luminaires", &luminaires(scene, table, places))?,
            environment_texels: texel_buffer(device, "environment", &environment_texels)?,
            environment_choice: texel_buffer(device, "environment choice", &environment_choice)?,
            light_tree: texel_buffer(device, "light tree", &tree)?,
            physical: texel_buffer(device, "metallic-roughness surfaces", &physical)?,
        })
    }
}

/// A buffer that is read by texels alone.
fn texel_buffer<T: Pod>(device: &Arc<Device>, name: &str, data: &[T]) -> Result<TexelBuffer> {
    TexelBuffer::new(device, name, data, vk::BufferUsageFlags::empty())
}
