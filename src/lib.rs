//! luminaire: a Vulkan path tracer that knows what is right.
//!
//! A scene is plain data ([`scene`]). Two tracers turn it into radiance samples: the double-precision [`reference`] and the
//! GPU renderer ([`gpu`], [`accel`]: one GLSL kernel on ray queries or on a compute-shader BVH). Both draw the same
//! [`sampling`] numbers, so they are compared pixel by pixel. A [`film`] adds the samples up; [`render`] drives it all.

pub mod accel;
pub mod backend;
pub mod bvh;
pub mod error;
pub mod film;
pub mod gpu;
pub mod image_io;
pub mod reference;
pub mod render;
pub mod sampling;
pub mod scene;

pub use error::{Error, Result};
