//! Two ways to provide the kernel's geometry: ray queries over Vulkan acceleration structures, or the compute BVH.
//!
//! Both bind the same buffers of triangles, normals and objects; only binding 1 differs, and the order of what is in them.

mod ray_query;

use crate::gpu::bvh::{MeshBvh, STACK_SIZE, TwoLevelBvh, spatial_order};
use crate::gpu::layout::Object;
use crate::gpu::model::KernelModel;
use crate::gpu::{Binding, Device, TexelBuffer};
use crate::scene::{Scene, widen};
use crate::{Error, Result};
use ash::vk;
use glam::{DAffine3, Vec2, Vec3};
use std::sync::Arc;

/// A scene's geometry on a device.
pub struct Geometry {
    intersector: Intersector,
    triangles: TexelBuffer,
    normals: TexelBuffer,
    uvs: TexelBuffer,
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
    ) -> Result<(Self, Vec<MeshBvh>)> {
        if ray_query {
            Self::build_ray_query(device, scene, model)
        } else {
            Self::build_compute_bvh(device, scene, model)
        }
    }

    fn build_compute_bvh(device: &Arc<Device>, scene: &Scene, model: &KernelModel) -> Result<(Self, Vec<MeshBvh>)> {
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
        let geometry = Self::with_order(device, scene, model, &bvh.meshes, &bvh.object_order, usage, |_, _| {
            Ok(Intersector::ComputeBvh(nodes))
        })?;
        Ok((geometry, bvh.meshes))
    }

    fn build_ray_query(device: &Arc<Device>, scene: &Scene, model: &KernelModel) -> Result<(Self, Vec<MeshBvh>)> {
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
        let geometry = Self::with_order(device, scene, model, &meshes, &order, usage, |triangles, objects| {
            ray_query::TopLevel::build(device, scene, &meshes, triangles, objects).map(Intersector::RayQuery)
        })?;
        Ok((geometry, meshes))
    }

    /// Uploads triangles, normals and objects in the given order.
    fn with_order(
        device: &Arc<Device>,
        scene: &Scene,
        model: &KernelModel,
        meshes: &[MeshBvh],
        object_order: &[u32],
        usage: vk::BufferUsageFlags,
        intersector: impl FnOnce(&TexelBuffer, &[Object]) -> Result<Intersector>,
    ) -> Result<Self> {
        let count: usize = meshes.iter().map(|m| m.order.len()).sum();
        let mut triangles: Vec<[u32; 4]> = Vec::with_capacity(3 * count);
        let vertex_normals = model.features.vertex_normals;
        let textured = model.features.textures || model.features.holes;
        let mut normals: Vec<[u32; 4]> = Vec::with_capacity(if vertex_normals { 3 * count } else { 0 });
        let mut uvs: Vec<[u32; 4]> = Vec::with_capacity(if textured { 2 * count } else { 0 });
        let texel = |v: Vec3, w: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), w];
        for (mesh, place) in scene.meshes.iter().zip(meshes) {
            for &index in &place.order {
                let triangle = mesh.triangles[index as usize];
                let corners = triangle.vertices.map(|v| mesh.positions[v as usize]);
                let extra = [triangle.material, index, shape(corners)];
                for (corner, vertex) in triangle.vertices.into_iter().enumerate() {
                    triangles.push(texel(corners[corner], extra[corner]));
                    if vertex_normals {
                        normals.push(texel(mesh.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO), 0));
                    }
                }
                if textured {
                    let [a, b, c] = triangle
                        .vertices
                        .map(|v| mesh.uvs.get(v as usize).copied().unwrap_or(Vec2::ZERO).to_array().map(f32::to_bits));
                    uvs.extend([[a[0], a[1], b[0], b[1]], [c[0], c[1], 0, 0]]);
                }
            }
        }
        let objects: Vec<Object> = object_order
            .iter()
            .map(|&index| {
                let object = &scene.objects[index as usize];
                let place = &meshes[object.mesh as usize];
                let to_world = widen(object.object_to_world);
                Object {
                    object_to_world: rows(to_world),
                    world_to_object: rows(to_world.inverse()),
                    root_node: place.root,
                    triangle_offset: place.triangle_offset,
                    material: object.material.unwrap_or(u32::MAX),
                    scene_index: index,
                }
            })
            .collect();
        let triangles = TexelBuffer::new(device, "triangles", &triangles, usage)?;
        let normals = TexelBuffer::new(device, "normals", &normals, vk::BufferUsageFlags::empty())?;
        let uvs = TexelBuffer::new(device, "texture coordinates", &uvs, vk::BufferUsageFlags::empty())?;
        let intersector = intersector(&triangles, &objects)?;
        Ok(Geometry {
            intersector,
            triangles,
            normals,
            uvs,
            objects: TexelBuffer::new(device, "objects", &objects, vk::BufferUsageFlags::empty())?,
        })
    }

    /// Bindings 1 to 4 and 9.
    pub(crate) fn bindings(&self) -> [Binding<'_>; 5] {
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
        ]
    }
}

/// The rows of an affine map, rounded to `f32`.
fn rows(map: DAffine3) -> [[f32; 4]; 3] {
    let m = map.matrix3;
    [0, 1, 2].map(|r| [m.x_axis[r], m.y_axis[r], m.z_axis[r], map.translation[r]].map(|x| x as f32))
}

/// What the kernel's distance along a ray needs to know of a triangle: which edge is the longest (0: from the first corner to the second, 1: to
/// the third, 2: back), and 4 if the other two edges say what plane it lies in.
fn shape([a, b, c]: [Vec3; 3]) -> u32 {
    let edges = [b - a, c - b, a - c];
    let lengths = edges.map(|edge| edge.abs().max_element());
    let longest = (0..3).rev().max_by(|i, j| lengths[*i].total_cmp(&lengths[*j])).unwrap_or(0);
    let (next, last) = ((longest + 1) % 3, (longest + 2) % 3);
    let normal = edges[next].cross(edges[last]);
    let plane = normal.abs().max_element() > 1e-4 * lengths[next] * lengths[last];
    longest as u32 + 4 * u32::from(plane)
}
