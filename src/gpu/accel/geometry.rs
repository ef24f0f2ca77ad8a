//! Triangles and objects on a device, with what rays are traced against.

use super::ray_query;
use crate::gpu::bvh::{MeshBvh, STACK_SIZE, TwoLevelBvh, spatial_order};
use crate::gpu::layout::Object;
use crate::gpu::pack::triangle::{
    corner_tangents, object, texture_coordinates, triangles, vertex_colours, vertex_normals,
};
use crate::gpu::specialization::KernelModel;
use crate::gpu::vulkan::binding::Binding;
use crate::gpu::vulkan::device::Device;
use crate::gpu::vulkan::texel_buffer::TexelBuffer;
use crate::scene::{LightTree, Scene};
use crate::{Error, Result};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;

/// A scene's geometry on a device.
pub struct Geometry {
    intersector: Intersector,
    triangles: TexelBuffer,
    normals: TexelBuffer,
    uvs: TexelBuffer,
    colours: TexelBuffer,
    tangents: TexelBuffer,
    objects: TexelBuffer,
}

/// What binding 1 holds.
enum Intersector {
    ComputeBvh(TexelBuffer),
    RayQuery(ray_query::TopLevel),
}

impl Geometry {
    /// Uploads a scene and builds what rays are traced against; also says where each mesh's triangles came to lie. What the kernel
    /// does not model is left out.
    ///
    /// # Errors
    /// If the scene is beyond a limit of the device, or the driver fails.
    pub fn build(
        device: &Arc<Device>,
        scene: &Scene,
        ray_query: bool,
        model: &KernelModel,
        tree: Option<&LightTree>,
    ) -> Result<(Self, Vec<MeshBvh>)> {
        if ray_query {
            Self::build_ray_query(device, scene, model, tree)
        } else {
            Self::build_compute_bvh(device, scene, model, tree)
        }
    }

    fn build_compute_bvh(
        device: &Arc<Device>,
        scene: &Scene,
        model: &KernelModel,
        tree: Option<&LightTree>,
    ) -> Result<(Self, Vec<MeshBvh>)> {
        let bvh = TwoLevelBvh::build(scene, model.features.instances);
        if bvh.stack_depth > STACK_SIZE {
            return Err(Error::Limit {
                what: "the BVH".into(),
                needed: format!("{} levels", bvh.stack_depth),
                device: "the kernel's traversal stack".into(),
                limit: format!("{STACK_SIZE}"),
                advice: "the geometry is degenerate (very many triangles in one place?): clean it, or use --backend \
                         ray-query or cpu"
                    .into(),
            });
        }
        let nodes = TexelBuffer::new(device, "BVH nodes", &bvh.nodes, vk::BufferUsageFlags::empty())?;
        let usage = vk::BufferUsageFlags::empty();
        let geometry =
            Self::with_order(device, scene, (model, tree), &bvh.meshes, &bvh.object_order, usage, |_, _| {
                Ok(Intersector::ComputeBvh(nodes))
            })?;
        Ok((geometry, bvh.meshes))
    }

    fn build_ray_query(
        device: &Arc<Device>,
        scene: &Scene,
        model: &KernelModel,
        tree: Option<&LightTree>,
    ) -> Result<(Self, Vec<MeshBvh>)> {
        let mut triangle_offset = 0;
        let meshes: Vec<MeshBvh> = scene
            .meshes
            .iter()
            .map(|mesh| {
                let centroids: Vec<Vec3> = mesh
                    .triangles
                    .iter()
                    .map(|t| t.vertices.iter().map(|v| mesh.positions[*v as usize]).sum())
                    .collect();
                let order = spatial_order(&centroids);
                let mesh = MeshBvh { root: 0, triangle_offset, order };
                triangle_offset += mesh.order.len() as u32;
                mesh
            })
            .collect();
        let mesh_centres: Vec<Vec3> = scene
            .meshes
            .iter()
            .map(|m| {
                let (low, high) = m.bounds();
                0.5 * (low + high)
            })
            .collect();
        let centres: Vec<Vec3> =
            scene.objects.iter().map(|o| o.object_to_world.transform_point3(mesh_centres[o.mesh as usize])).collect();
        let usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
        let order = spatial_order(&centres);
        let geometry = Self::with_order(device, scene, (model, tree), &meshes, &order, usage, |triangles, objects| {
            ray_query::TopLevel::build(device, scene, &meshes, triangles, objects).map(Intersector::RayQuery)
        })?;
        Ok((geometry, meshes))
    }

    /// Uploads triangles, normals and objects in the given order.
    fn with_order(
        device: &Arc<Device>,
        scene: &Scene,
        (model, tree): (&KernelModel, Option<&LightTree>),
        meshes: &[MeshBvh],
        object_order: &[u32],
        usage: vk::BufferUsageFlags,
        intersector: impl FnOnce(&TexelBuffer, &[Object]) -> Result<Intersector>,
    ) -> Result<Self> {
        let corners = triangles(scene, meshes, model.features.light_tree);
        let normals = if model.features.vertex_normals { vertex_normals(scene, meshes) } else { vec![] };
        let textured = model.features.textures || model.features.holes || model.features.anisotropy;
        let uvs = if textured { texture_coordinates(scene, meshes) } else { vec![] };
        let colours = if model.features.vertex_colours { vertex_colours(scene, meshes) } else { vec![] };
        let tangents = if model.features.tangents { corner_tangents(scene, meshes) } else { vec![] };
        let objects: Vec<Object> = object_order.iter().map(|&index| object(scene, meshes, tree, index)).collect();
        let triangles = TexelBuffer::new(device, "triangles", &corners, usage)?;
        let normals = TexelBuffer::new(device, "normals", &normals, vk::BufferUsageFlags::empty())?;
        let uvs = TexelBuffer::new(device, "texture coordinates", &uvs, vk::BufferUsageFlags::empty())?;
        let colours = TexelBuffer::new(device, "vertex colours", &colours, vk::BufferUsageFlags::empty())?;
        let tangents = TexelBuffer::new(device, "tangents", &tangents, vk::BufferUsageFlags::empty())?;
        let intersector = intersector(&triangles, &objects)?;
        Ok(Geometry {
            intersector,
            triangles,
            normals,
            uvs,
            colours,
            tangents,
            objects: TexelBuffer::new(device, "objects", &objects, vk::BufferUsageFlags::empty())?,
        })
    }

    /// Bindings 1 to 4, 9, 14 and 16.
    pub(crate) fn bindings(&self) -> [Binding<'_>; 7] {
        let intersector = match &self.intersector {
            Intersector::ComputeBvh(nodes) => Binding::Texel(nodes),
            Intersector::RayQuery(top) => Binding::AccelerationStructure(top.handle()),
        };
        [
            intersector,
            Binding::Texel(&self.triangles),
            Binding::Texel(&self.normals),
            Binding::Texel(&self.objects),
            Binding::Texel(&self.uvs),
            Binding::Texel(&self.colours),
            Binding::Texel(&self.tangents),
        ]
    }
}
