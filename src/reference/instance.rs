//! Where objects stand.

use glam::{DAffine3, DMat3};

/// Where an object stands.
pub(super) struct Instance {
    pub to_world: DAffine3,
    pub to_object: DAffine3,
    /// Inverse transpose: takes normals to world space.
    pub normal_to_world: DMat3,
}
