//! Every luminaire of a scene in one table, one of which is chosen by its power.

use super::{Luminaire, Scene};
use crate::sampling::AliasTable;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::f64::consts::PI;

/// A triangle that emits, in world space: an area luminaire of any shape is a set of these.
#[derive(Debug, Clone)]
pub struct EmissiveTriangle {
    /// Index into [`Scene::objects`].
    pub object: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
    /// World-space corners.
    pub vertices: [DVec3; 3],
    /// Emitted radiance, on both sides.
    pub emission: Vec3,
}

impl EmissiveTriangle {
    /// World-space area.
    pub fn area(&self) -> f64 {
        let [a, b, c] = self.vertices;
        0.5 * (b - a).cross(c - a).length()
    }
}

/// One entry of the [`LuminaireTable`].
#[derive(Debug, Clone)]
pub enum SampledLuminaire {
    /// A point luminaire or one at infinity.
    Impulse(Luminaire),
    /// A triangle that emits.
    Area(EmissiveTriangle),
}

/// All luminaires, and the alias table that chooses among them in proportion to their power.
#[derive(Debug, Clone, Default)]
pub struct LuminaireTable {
    /// Point luminaires and those at infinity first, in the scene's order; then the emissive triangles, object by object.
    pub entries: Vec<SampledLuminaire>,
    /// Chooses an index into `entries`.
    pub choice: AliasTable,
}

impl LuminaireTable {
    /// Collects the luminaires of a scene that emit anything.
    pub fn new(scene: &Scene) -> Self {
        let mut entries: Vec<SampledLuminaire> =
            scene.luminaires.iter().cloned().map(SampledLuminaire::Impulse).collect();
        for (object_index, object) in scene.objects.iter().enumerate() {
            let to_world = widen(object.object_to_world);
            let mesh = &scene.meshes[object.mesh as usize];
            for (triangle_index, triangle) in mesh.triangles.iter().enumerate() {
                let emission = scene.material_of(object, triangle).emission;
                if emission == Vec3::ZERO {
                    continue;
                }
                let vertices =
                    triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
                let (object, triangle) = (object_index as u32, triangle_index as u32);
                entries.push(SampledLuminaire::Area(EmissiveTriangle { object, triangle, vertices, emission }));
            }
        }
        let (low, high) = scene.world_bounds();
        let (center, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let powers: Vec<f64> = entries.iter().map(|e| power(e, center, radius)).collect();
        let emits: Vec<bool> = powers.iter().map(|p| *p > 0.0).collect();
        let mut keep = emits.iter();
        entries.retain(|_| *keep.next().expect("one flag an entry"));
        let powers: Vec<f64> = powers.into_iter().filter(|p| *p > 0.0).collect();
        LuminaireTable { choice: AliasTable::new(&powers), entries }
    }
}

/// An affine map in `f64`, from the `f32` numbers that both tracers share.
pub(crate) fn widen(map: glam::Affine3A) -> DAffine3 {
    let m = map.matrix3;
    DAffine3 {
        matrix3: DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3()),
        translation: map.translation.as_dvec3(),
    }
}

/// The radiant power that may reach the scene, averaged over the channels; the scene lies in the sphere with this center and
/// radius.
fn power(luminaire: &SampledLuminaire, center: DVec3, radius: f64) -> f64 {
    let mean = |c: &Vec3| c.as_dvec3().element_sum() / 3.0;
    match luminaire {
        SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => {
            // From far away only the solid angle of the sphere counts.
            let sine2 = (radius * radius / position.as_dvec3().distance_squared(center)).min(1.0);
            let solid_angle = if sine2 < 1.0 { 2.0 * PI * sine2 / (1.0 + (1.0 - sine2).sqrt()) } else { 4.0 * PI };
            solid_angle * mean(intensity)
        }
        SampledLuminaire::Impulse(Luminaire::Infinite { irradiance, .. }) => PI * radius * radius * mean(irradiance),
        SampledLuminaire::Area(triangle) => 2.0 * PI * triangle.area() * mean(&triangle.emission),
    }
}
