//! What the kernel models for a scene: no more than the scene needs.

use crate::scene::{Integrator, Luminaire, LuminaireTable, SampledLuminaire, Scene};
use glam::{Affine3A, Vec3};

/// The switches of the kernel; each is a specialization constant of `shaders/scene.glsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KernelModel {
    /// The simple ray tracer in place of the path tracer.
    pub simple: bool,
    /// Some material has a glossy lobe.
    pub glossy: bool,
    /// Some mesh has vertex normals.
    pub vertex_normals: bool,
    /// More than one object, or a transform, or a material of the object's own.
    pub instances: bool,
    /// Some luminaire is a point.
    pub point_luminaires: bool,
    /// Some luminaire is at infinity.
    pub infinite_luminaires: bool,
    /// Some triangle emits.
    pub area_luminaires: bool,
}

impl KernelModel {
    /// The model that a scene needs.
    pub fn of(scene: &Scene) -> Self {
        Self::with(scene, &LuminaireTable::new(scene))
    }

    /// The same, where the luminaires are already known.
    pub(crate) fn with(scene: &Scene, table: &LuminaireTable) -> Self {
        let any = |kind: fn(&SampledLuminaire) -> bool| table.entries.iter().any(kind);
        KernelModel {
            simple: matches!(scene.integrator, Integrator::Simple { .. }),
            glossy: scene.materials.iter().any(|m| m.glossy != Vec3::ZERO),
            vertex_normals: scene.meshes.iter().any(|m| !m.normals.is_empty()),
            instances: scene.objects.len() > 1
                || scene.objects.iter().any(|o| o.object_to_world != Affine3A::IDENTITY || o.material.is_some()),
            point_luminaires: any(|l| matches!(l, SampledLuminaire::Impulse(Luminaire::Point { .. }))),
            infinite_luminaires: any(|l| matches!(l, SampledLuminaire::Impulse(Luminaire::Infinite { .. }))),
            area_luminaires: any(|l| matches!(l, SampledLuminaire::Area(_))),
        }
    }

    /// In the order of the constants' ids.
    pub(crate) fn constants(&self) -> [bool; 7] {
        [
            self.simple,
            self.glossy,
            self.vertex_normals,
            self.instances,
            self.point_luminaires,
            self.infinite_luminaires,
            self.area_luminaires,
        ]
    }
}

impl std::fmt::Display for KernelModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.simple { "simple ray tracer" } else { "path tracer" })?;
        f.write_str(", Lambert")?;
        for (on, name) in [
            (self.glossy, "glossy lobe"),
            (self.vertex_normals, "vertex normals"),
            (self.instances, "instances"),
            (self.point_luminaires, "point luminaires"),
            (self.infinite_luminaires, "luminaires at infinity"),
            (self.area_luminaires, "area luminaires"),
        ] {
            if on {
                write!(f, ", {name}")?;
            }
        }
        Ok(())
    }
}
