//! Every luminaire of a scene in one table, one of which is chosen by its power.

use super::environment::EnvironmentDistribution;
use super::estimator::{Directions, Estimator, Extinction, Integrator, LightSampling};
use super::luminaire::Luminaire;
use super::material::Material;
use super::mesh::{outward, widen};
use super::world::Scene;
use crate::sampling::AliasTable;
use glam::{DVec3, Vec3};
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
    /// Index into [`Scene::materials`], which knows what it emits.
    pub material: u32,
    /// Unit normal on the outward side, the only one that emits where the material is one-sided.
    pub normal: DVec3,
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
    /// The scene's environment.
    Environment,
}

/// All luminaires, and the alias table that chooses among them in proportion to their power.
#[derive(Debug, Clone, Default)]
pub struct LuminaireTable {
    /// Point luminaires and those at infinity first, in the scene's order; then the emissive triangles, object by object; then
    /// the environment.
    pub entries: Vec<SampledLuminaire>,
    /// Chooses an index into `entries`.
    pub choice: AliasTable,
    /// Which direction of the environment is chosen, if it is an entry.
    pub environment: Option<EnvironmentDistribution>,
    /// For each material, the probability of choosing a triangle of it, for each unit of its area; 0 if it does not emit.
    pub area_density: Vec<f64>,
    /// But at least this, however small a triangle is.
    pub least_probability: f64,
}

/// A luminaire is chosen at least so often as this share of what it would be if all had the same power.
const LEAST_SHARE: f64 = 1.0 / 1024.0;
/// And at least by so many of the 2^32 random numbers, of which the table may lose one to rounding.
const LEAST_NUMBERS: f64 = 8.0;

impl LuminaireTable {
    /// Collects the luminaires of a scene that emit anything.
    pub fn new(scene: &Scene) -> Self {
        let mut entries: Vec<SampledLuminaire> =
            scene.luminaires.iter().cloned().map(SampledLuminaire::Impulse).collect();
        for (object_index, object) in scene.objects.iter().enumerate() {
            let to_world = widen(object.object_to_world);
            let mesh = &scene.meshes[object.mesh as usize];
            for (triangle_index, triangle) in mesh.triangles.iter().enumerate() {
                let material = object.material.unwrap_or(triangle.material);
                if scene.materials[material as usize].emission == Vec3::ZERO {
                    continue;
                }
                let vertices =
                    triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
                let normal = to_world.matrix3.inverse().transpose() * outward(mesh, triangle);
                let normal = normal.normalize_or_zero();
                let (object, triangle) = (object_index as u32, triangle_index as u32);
                entries.push(SampledLuminaire::Area(EmissiveTriangle { object, triangle, vertices, material, normal }));
            }
        }
        let (low, high) = scene.model_bounds();
        let (center, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        let left_to_paths = left_to_paths(scene, &scene.integrator);
        let environment =
            scene.environment.as_ref().and_then(|environment| EnvironmentDistribution::new(environment, left_to_paths));
        entries.extend(environment.as_ref().map(|_| SampledLuminaire::Environment));
        let exitance: Vec<f64> = scene.materials.iter().map(|material| exitance(scene, material)).collect();
        let powers: Vec<f64> = entries
            .iter()
            .map(|entry| match entry {
                SampledLuminaire::Impulse(luminaire) => impulse_power(luminaire, center, radius),
                SampledLuminaire::Area(triangle) => exitance[triangle.material as usize] * triangle.area(),
                SampledLuminaire::Environment => {
                    PI * radius * radius * environment.as_ref().map_or(0.0, |environment| environment.sampled)
                }
            })
            .collect();
        let emits: Vec<bool> = powers.iter().map(|p| *p > 0.0).collect();
        let mut keep = emits.iter();
        entries.retain(|_| *keep.next().expect("one flag an entry"));
        let mut powers: Vec<f64> = powers.into_iter().filter(|p| *p > 0.0).collect();
        // What no random number stood for would never be found, and the power heuristic would wait for it.
        let least_share = (LEAST_SHARE / powers.len() as f64).max(LEAST_NUMBERS / 4_294_967_296.0);
        let least = least_share * powers.iter().sum::<f64>();
        powers.iter_mut().for_each(|power| *power = power.max(least));
        let total_power: f64 = powers.iter().sum();
        let area_density = exitance.iter().map(|e| if *e == 0.0 { 0.0 } else { e / total_power }).collect();
        let least_probability = if powers.is_empty() { 0.0 } else { least / total_power };
        LuminaireTable { choice: AliasTable::new(&powers), entries, environment, area_density, least_probability }
    }

    /// Whether the table of a scene would be the same with another integrator: with a sky it depends on what else finds its light.
    pub fn is_same_for(scene: &Scene, integrator: &Integrator) -> bool {
        scene.environment.is_none() || left_to_paths(scene, &scene.integrator) == left_to_paths(scene, integrator)
    }

    /// The probability of choosing an emissive triangle of this material and area, as it was asked for. With 32 random bits the table comes
    /// only near ([`AliasTable::pdf`]), the less so the smaller it is. What is divided by is what the table does; the power heuristic, whose
    /// weights have to add up to 1 wherever the light is found, goes by this.
    pub fn area_probability(&self, material: u32, area: f64) -> f64 {
        (self.area_density[material as usize] * area).max(self.least_probability)
    }

    /// The probability of choosing the environment; 0 if there is none.
    pub fn environment_probability(&self) -> f64 {
        // The last entry.
        if self.environment.is_some() { self.choice.pdf.last().copied().unwrap_or(0.0) } else { 0.0 }
    }
}

/// How much of a sky's mean radiance is left to paths that escape. Where they go by the BSDF, and nothing but Russian roulette by the whole path
/// ends them, they find an even sky better than light sampling does. The lobes of a surface share its paths, so that a weak one has few: there a
/// quarter of the mean is sampled.
fn left_to_paths(scene: &Scene, integrator: &Integrator) -> f64 {
    let Estimator { light_sampling, directions, extinction, albedo_threshold, .. } = integrator.estimator();
    let found = light_sampling == LightSampling::Mis
        && directions == Directions::Bsdf
        && matches!(extinction, Extinction::Off | Extinction::Throughput)
        && albedo_threshold.is_none();
    let lobes = |m: &Material| [m.lambert != Vec3::ZERO, m.glossy != Vec3::ZERO, m.has_impulse()];
    let several = |m: &Material| lobes(m).into_iter().filter(|has| *has).count() > 1;
    match found {
        false => 0.0,
        true if scene.materials.iter().any(several) => 0.75,
        true => 1.0,
    }
}

/// Power that a surface of this material emits for each unit of area, averaged over the channels and over its texture.
fn exitance(scene: &Scene, material: &Material) -> f64 {
    let texture = material.maps.emission.map_or(DVec3::ONE, |map| scene.textures[map as usize].mean());
    let sides = if material.one_sided { 1.0 } else { 2.0 };
    sides * PI * (material.emission.as_dvec3() * texture).element_sum() / 3.0
}

/// The radiant power of a luminaire without an area that may reach the scene, averaged over the channels; the scene lies in the sphere
/// with this center and radius.
fn impulse_power(luminaire: &Luminaire, center: DVec3, radius: f64) -> f64 {
    let mean = |c: &Vec3| c.as_dvec3().element_sum() / 3.0;
    match luminaire {
        Luminaire::Point { position, intensity } => {
            // From far away only the solid angle of the sphere counts.
            let sine2 = (radius * radius / position.as_dvec3().distance_squared(center)).min(1.0);
            let solid_angle = if sine2 < 1.0 { 2.0 * PI * sine2 / (1.0 + (1.0 - sine2).sqrt()) } else { 4.0 * PI };
            solid_angle * mean(intensity)
        }
        Luminaire::Infinite { irradiance, .. } => PI * radius * radius * mean(irradiance),
    }
}
