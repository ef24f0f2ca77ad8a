//! A compute pipeline with its one descriptor set.

use super::binding::Binding;
use super::device::Device;
use super::shader::Shader;
use crate::Result;
use ash::vk;
use std::ffi::CStr;
use std::sync::Arc;

/// A compute shader, specialised and bound. The caller keeps the bound resources alive as long as the kernel.
pub struct Kernel {
    pipeline: vk::Pipeline,
    layout: vk::PipelineLayout,
    set_layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    /// Bytes of the push constants.
    push_size: u32,
    device: Arc<Device>,
}

impl Kernel {
    /// Builds the pipeline. `constants[i]` is the specialization constant with id `i`; `push_size` bytes of push constants.
    ///
    /// # Errors
    /// If the shader does not compile (with the `shaderc` feature) or the driver refuses.
    pub fn new(
        device: &Arc<Device>,
        shader: &Shader,
        constants: &[u32],
        bindings: &[Binding<'_>],
        push_size: u32,
    ) -> Result<Self> {
        let raw = &device.raw;
        let name = shader.name;
        let code = shader.code()?;
        let mut kernel = Kernel {
            pipeline: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            pool: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            push_size,
            device: device.clone(),
        };
        let layout_bindings: Vec<_> = bindings
            .iter()
            .enumerate()
            .map(|(i, b)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(i as u32)
                    .descriptor_type(b.descriptor_type())
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let sizes: Vec<_> =
            bindings.iter().map(|b| vk::DescriptorPoolSize { ty: b.descriptor_type(), descriptor_count: 1 }).collect();
        let set_layout_info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&layout_bindings);
        let pool_info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: every handle is from this device and stored in `kernel` as soon as it exists, so that `drop`
        // frees it on an early return; the structures and what they point to live until their call returns.
        unsafe {
            kernel.set_layout = raw
                .create_descriptor_set_layout(&set_layout_info, None)
                .map_err(|e| device.error("vkCreateDescriptorSetLayout", e))?;
            device.set_name(kernel.set_layout, name);
            kernel.pool =
                raw.create_descriptor_pool(&pool_info, None).map_err(|e| device.error("vkCreateDescriptorPool", e))?;
            device.set_name(kernel.pool, name);
            let set_layouts = [kernel.set_layout];
            let set_info =
                vk::DescriptorSetAllocateInfo::default().descriptor_pool(kernel.pool).set_layouts(&set_layouts);
            kernel.set =
                raw.allocate_descriptor_sets(&set_info).map_err(|e| device.error("vkAllocateDescriptorSets", e))?[0];
            device.set_name(kernel.set, name);
            kernel.write_bindings(bindings);

            let push =
                [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: push_size }];
            let layout_info =
                vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts).push_constant_ranges(&push);
            kernel.layout = raw
                .create_pipeline_layout(&layout_info, None)
                .map_err(|e| device.error("vkCreatePipelineLayout", e))?;
            device.set_name(kernel.layout, name);

            let module_info = vk::ShaderModuleCreateInfo::default().code(&code);
            let module =
                raw.create_shader_module(&module_info, None).map_err(|e| device.error("vkCreateShaderModule", e))?;
            device.set_name(module, name);
            let entries: Vec<_> = (0..constants.len() as u32)
                .map(|i| vk::SpecializationMapEntry { constant_id: i, offset: 4 * i, size: 4 })
                .collect();
            let specialization =
                vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::cast_slice(constants));
            const MAIN: &CStr = c"main";
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(MAIN)
                .specialization_info(&specialization);
            let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(kernel.layout)];
            let pipelines = raw.create_compute_pipelines(vk::PipelineCache::null(), &info, None);
            raw.destroy_shader_module(module, None);
            kernel.pipeline = pipelines.map_err(|(_, e)| device.error("vkCreateComputePipelines", e))?[0];
            device.set_name(kernel.pipeline, name);
        }
        Ok(kernel)
    }

    fn write_bindings(&self, bindings: &[Binding<'_>]) {
        for (i, binding) in bindings.iter().enumerate() {
            let buffer_info;
            let view;
            let structure;
            let mut structure_write;
            let mut write = vk::WriteDescriptorSet::default()
                .dst_set(self.set)
                .dst_binding(i as u32)
                .descriptor_type(binding.descriptor_type());
            match binding {
                Binding::Uniform(b) | Binding::Storage(b) => {
                    buffer_info = [vk::DescriptorBufferInfo { buffer: b.raw, offset: 0, range: vk::WHOLE_SIZE }];
                    write = write.buffer_info(&buffer_info);
                }
                Binding::Texel(t) => {
                    view = [t.view];
                    write = write.texel_buffer_view(&view);
                }
                Binding::AccelerationStructure(s) => {
                    structure = [*s];
                    structure_write =
                        vk::WriteDescriptorSetAccelerationStructureKHR::default().acceleration_structures(&structure);
                    write = write.push_next(&mut structure_write);
                    write.descriptor_count = 1;
                }
            }
            // SAFETY: the set is not in use yet, and the resources are alive.
            unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) };
        }
    }

    /// Records a dispatch of `groups` workgroups.
    ///
    /// # Panics
    /// If `push` is not of the size that the kernel was made with.
    pub(crate) fn dispatch(&self, cmd: vk::CommandBuffer, push: &[u8], groups: [u32; 3]) {
        assert_eq!(push.len(), self.push_size as usize, "push constants");
        let raw = &self.device.raw;
        // SAFETY: called while `cmd` is being recorded; pipeline, layout and set belong together; `push` has the size that
        // the layout was made with (asserted above).
        unsafe {
            raw.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::COMPUTE, self.pipeline);
            raw.cmd_bind_descriptor_sets(cmd, vk::PipelineBindPoint::COMPUTE, self.layout, 0, &[self.set], &[]);
            raw.cmd_push_constants(cmd, self.layout, vk::ShaderStageFlags::COMPUTE, 0, push);
            raw.cmd_dispatch(cmd, groups[0], groups[1], groups[2]);
        }
    }
}

impl Drop for Kernel {
    fn drop(&mut self) {
        if self.device.is_hung() {
            return;
        }
        let raw = &self.device.raw;
        // SAFETY: the handles are null or from this device, and every submission was waited for.
        unsafe {
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_pool(self.pool, None);
            raw.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
