//! Two ways to provide the kernel's geometry: ray queries over Vulkan acceleration structures, or the compute BVH.
//!
//! Both bind the same buffers of triangles, normals and objects; only binding 1 differs, and the order of what is in them.

mod geometry;
mod ray_query;

pub use geometry::Geometry;
