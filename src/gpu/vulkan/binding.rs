//! One thing that a kernel reads or writes: a buffer, texels, or an acceleration structure.

use super::buffer::Buffer;
use super::texel_buffer::TexelBuffer;
use ash::vk;

/// What a shader sees at one binding; the position in the list is the binding's number.
pub enum Binding<'a> {
    /// A uniform buffer.
    Uniform(&'a Buffer),
    /// A storage buffer.
    Storage(&'a Buffer),
    /// A `usamplerBuffer`.
    Texel(&'a TexelBuffer),
    /// A top-level acceleration structure.
    AccelerationStructure(vk::AccelerationStructureKHR),
}

impl Binding<'_> {
    /// The kind of descriptor that it takes.
    pub(in crate::gpu) fn descriptor_type(&self) -> vk::DescriptorType {
        match self {
            Binding::Uniform(_) => vk::DescriptorType::UNIFORM_BUFFER,
            Binding::Storage(_) => vk::DescriptorType::STORAGE_BUFFER,
            Binding::Texel(_) => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
            Binding::AccelerationStructure(_) => vk::DescriptorType::ACCELERATION_STRUCTURE_KHR,
        }
    }
}
