//! Bottom-level acceleration structures of the meshes and a top-level one of the objects.

use crate::Result;
use crate::gpu::bvh::MeshBvh;
use crate::gpu::layout::{Object, Triangle};
use crate::gpu::vulkan::buffer::Buffer;
use crate::gpu::vulkan::device::Device;
use crate::gpu::vulkan::submission::{barrier, submit};
use crate::gpu::vulkan::texel_buffer::TexelBuffer;
use crate::scene::{self, Scene};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// What to do where a scene is too large for the driver.
const ADVICE: &str = "split the scene, or use --backend compute-bvh or cpu";

/// An acceleration structure and the buffer it lives in.
struct Structure {
    raw: vk::AccelerationStructureKHR,
    buffer: Buffer,
}

/// The top-level structure, with the bottom-level ones that it refers to.
pub(super) struct TopLevel {
    top: Structure,
    _bottom: Vec<Structure>,
}

impl TopLevel {
    /// The handle to bind.
    pub(super) fn handle(&self) -> vk::AccelerationStructureKHR {
        self.top.raw
    }

    /// Builds all structures; `triangles` holds three texels a triangle, in the order of `meshes`.
    pub(super) fn build(
        device: &Arc<Device>,
        scene: &Scene,
        meshes: &[MeshBvh],
        triangles: &TexelBuffer,
        objects: &[Object],
    ) -> Result<Self> {
        // 24 bits hold the object's index in an instance.
        let most_objects = device.max_instances.min(1 << 24);
        device.check_limit(
            "the top-level acceleration structure",
            objects.len() as u64,
            most_objects,
            "objects (maxInstanceCount)",
            ADVICE,
        )?;
        let mut bottom = Vec::with_capacity(meshes.len());
        for (mesh, place) in scene.meshes.iter().zip(meshes) {
            let count = place.order.len() as u64;
            device.check_limit(&mesh.name, count, device.max_primitives, "triangles (maxPrimitiveCount)", ADVICE)?;
            let address = triangles.buffer.address() + u64::from(place.triangle_offset) * size_of::<Triangle>() as u64;
            // Every corner is 16 bytes, the last four of which are not a coordinate; three make a triangle, without indices.
            let data = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
                .vertex_format(vk::Format::R32G32B32_SFLOAT)
                .vertex_data(vk::DeviceOrHostAddressConstKHR { device_address: address })
                .vertex_stride(16)
                .max_vertex(3 * count as u32 - 1)
                .index_type(vk::IndexType::NONE_KHR);
            let geometry = vk::AccelerationStructureGeometryKHR::default()
                .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
                .geometry(vk::AccelerationStructureGeometryDataKHR { triangles: data })
                .flags(vk::GeometryFlagsKHR::OPAQUE);
            let kind = vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL;
            bottom.push(Structure::build(device, &format!("BLAS {}", mesh.name), kind, geometry, count as u32)?);
        }

        let holes = objects_with_holes(scene);
        let loader = device.acceleration_structure();
        let instances: Vec<[u8; 64]> = objects
            .iter()
            .enumerate()
            .map(|(place, object)| {
                let mesh = scene.objects[object.scene_index as usize].mesh;
                let info = vk::AccelerationStructureDeviceAddressInfoKHR::default()
                    .acceleration_structure(bottom[mesh as usize].raw);
                // SAFETY: the structure is alive.
                let address = unsafe { loader.get_acceleration_structure_device_address(&info) };
                instance_record(&object.object_to_world, place as u32, holes[object.scene_index as usize], address)
            })
            .collect();
        let usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
        let instance_buffer = Buffer::upload(device, "TLAS instances", &instances, usage)?;
        let data = vk::AccelerationStructureGeometryInstancesDataKHR::default()
            .data(vk::DeviceOrHostAddressConstKHR { device_address: instance_buffer.address() });
        let geometry = vk::AccelerationStructureGeometryKHR::default()
            .geometry_type(vk::GeometryTypeKHR::INSTANCES)
            .geometry(vk::AccelerationStructureGeometryDataKHR { instances: data })
            .flags(vk::GeometryFlagsKHR::OPAQUE);
        let kind = vk::AccelerationStructureTypeKHR::TOP_LEVEL;
        let top = Structure::build(device, "TLAS", kind, geometry, objects.len() as u32)?;
        Ok(TopLevel { top, _bottom: bottom })
    }
}

/// For each object, whether a ray may pass any of its triangles.
fn objects_with_holes(scene: &Scene) -> Vec<bool> {
    let materials: Vec<bool> = scene.materials.iter().map(|m| m.has_holes()).collect();
    let any = materials.contains(&true);
    let meshes: Vec<bool> =
        scene.meshes.iter().map(|mesh| any && mesh.triangles.iter().any(|t| materials[t.material as usize])).collect();
    let of_object = |object: &scene::Object| match object.material {
        Some(material) => materials[material as usize],
        None => meshes[object.mesh as usize],
    };
    scene.objects.iter().map(of_object).collect()
}

/// A `VkAccelerationStructureInstanceKHR` as its bytes: 3x4 matrix, index and mask, flags, address.
fn instance_record(rows: &[[f32; 4]; 3], index: u32, holes: bool, address: u64) -> [u8; 64] {
    let mut record = [0u8; 64];
    record[..48].copy_from_slice(bytemuck::bytes_of(rows));
    record[48..52].copy_from_slice(&(index | 0xff00_0000).to_ne_bytes());
    let mut flags = vk::GeometryInstanceFlagsKHR::TRIANGLE_FACING_CULL_DISABLE;
    if holes {
        // The geometry says that it is opaque; instances that are not come back to the shader as candidates.
        flags |= vk::GeometryInstanceFlagsKHR::FORCE_NO_OPAQUE;
    }
    record[52..56].copy_from_slice(&(flags.as_raw() << 24).to_ne_bytes());
    record[56..].copy_from_slice(&address.to_ne_bytes());
    record
}

impl Structure {
    fn build(
        device: &Arc<Device>,
        name: &str,
        kind: vk::AccelerationStructureTypeKHR,
        geometry: vk::AccelerationStructureGeometryKHR<'_>,
        count: u32,
    ) -> Result<Self> {
        let loader = device.acceleration_structure();
        let geometries = [geometry];
        let mut info = vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(kind)
            .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
            .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
            .geometries(&geometries);
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        // SAFETY: `info` describes one geometry, `count` is its number of primitives.
        unsafe {
            loader.get_acceleration_structure_build_sizes(
                vk::AccelerationStructureBuildTypeKHR::DEVICE,
                &info,
                &[count],
                &mut sizes,
            );
        }
        let usage =
            vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let buffer = Buffer::new(device, name, sizes.acceleration_structure_size, usage, MemoryLocation::GpuOnly)?;
        let create = vk::AccelerationStructureCreateInfoKHR::default()
            .buffer(buffer.raw)
            .size(sizes.acceleration_structure_size)
            .ty(kind);
        // SAFETY: the buffer has the usage and size that the structure needs and lives as long as it.
        let raw = unsafe { loader.create_acceleration_structure(&create, None) }
            .map_err(|e| device.error("vkCreateAccelerationStructureKHR", e))?;
        let structure = Structure { raw, buffer };
        device.set_name(raw, name);

        let scratch = Buffer::new(
            device,
            "build scratch",
            sizes.build_scratch_size + device.scratch_alignment,
            vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS,
            MemoryLocation::GpuOnly,
        )?;
        info.dst_acceleration_structure = structure.raw;
        info.scratch_data.device_address = scratch.address().next_multiple_of(device.scratch_alignment);
        let range = [vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(count)];
        submit(device, name, |cmd| {
            // SAFETY: inputs, scratch and destination are alive until the submission has ended.
            unsafe { loader.cmd_build_acceleration_structures(cmd, &[info], &[&range]) };
            barrier(
                device,
                cmd,
                (
                    vk::PipelineStageFlags::ACCELERATION_STRUCTURE_BUILD_KHR,
                    vk::AccessFlags::ACCELERATION_STRUCTURE_WRITE_KHR,
                ),
                (
                    vk::PipelineStageFlags::ACCELERATION_STRUCTURE_BUILD_KHR | vk::PipelineStageFlags::COMPUTE_SHADER,
                    vk::AccessFlags::ACCELERATION_STRUCTURE_READ_KHR,
                ),
            );
        })?;
        Ok(structure)
    }
}

impl Drop for Structure {
    fn drop(&mut self) {
        let device = &self.buffer.device;
        if device.is_hung() {
            return;
        }
        // SAFETY: every submission was waited for; the buffer, a field, outlives the structure.
        unsafe { device.acceleration_structure().destroy_acceleration_structure(self.raw, None) };
    }
}
