//! Every luminaire of a scene in one table, one of which is chosen: by its power, or by a tree over them.

use super::environment::EnvironmentDistribution;
use super::estimator::{Directions, Estimator, Extinction, Integrator, LightChoice, LightSampling};
use super::lamp_shapes::lamp_shapes;
use super::light_tree::{LightTree, Source};
use super::luminaire::{Luminaire, one_minus_cos, spot_edge};
use super::material::Material;
use super::mesh::{outward, widen};
use super::sun_disc::SunDisc;
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
    /// A point luminaire of any kind, or one at infinity without an extent.
    Impulse(Luminaire),
    /// A triangle that emits.
    Area(EmissiveTriangle),
    /// A disc at infinity.
    Sun(SunDisc),
    /// The scene's environment.
    Environment,
}

/// All luminaires, and the alias table that chooses among them in proportion to their power.
#[derive(Debug, Clone, Default)]
pub struct LuminaireTable {
    /// Point luminaires and those at infinity without an extent first, in the scene's order; then the emissive triangles, object by object; then the discs
    /// at infinity, in the scene's order; then the environment.
    pub entries: Vec<SampledLuminaire>,
    /// Chooses an index into `entries`.
    pub choice: AliasTable,
    /// Which direction of the environment is chosen, if it is an entry.
    pub environment: Option<EnvironmentDistribution>,
    /// For each material, the probability of choosing a triangle of it, for each unit of its area; 0 if it does not emit.
    pub area_density: Vec<f64>,
    /// But at least this, however small a triangle is.
    pub least_probability: f64,
    /// Chooses by place in the stead of `choice`, where the scene asks for it or it pays.
    pub tree: Option<LightTree>,
}

/// A luminaire is chosen at least so often as this share of what it would be if all had the same power.
const LEAST_SHARE: f64 = 1.0 / 1024.0;
/// And at least by so many of the 2^32 random numbers, of which the table may lose one to rounding.
const LEAST_NUMBERS: f64 = 8.0;

/// The least share of the whole with which one of so many is chosen.
fn least_share(count: usize) -> f64 {
    (LEAST_SHARE / count as f64).max(LEAST_NUMBERS / 4_294_967_296.0)
}

impl LuminaireTable {
    /// Collects the luminaires of a scene that emit anything.
    pub fn new(scene: &Scene) -> Self {
        let mut entries: Vec<SampledLuminaire> =
            scene.luminaires.iter().filter(|luminaire| !luminaire.is_disc()).map(impulse).collect();
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
        let environment = scene
            .environment
            .as_ref()
            .and_then(|environment| EnvironmentDistribution::new(environment, left_to_paths(scene, &scene.integrator)));
        entries.extend(scene.luminaires.iter().filter(|luminaire| luminaire.is_disc()).filter_map(disc));
        entries.extend(environment.as_ref().map(|_| SampledLuminaire::Environment));
        let exitance: Vec<f64> = scene.materials.iter().map(|material| exitance(scene, material)).collect();
        let powers: Vec<f64> = entries
            .iter()
            .map(|entry| match entry {
                SampledLuminaire::Impulse(luminaire) => impulse_power(luminaire, center, radius),
                SampledLuminaire::Area(triangle) => exitance[triangle.material as usize] * triangle.area(),
                SampledLuminaire::Sun(sun) => PI * radius * radius * sun.irradiance().element_sum() / 3.0,
                SampledLuminaire::Environment => {
                    PI * radius * radius * environment.as_ref().map_or(0.0, |environment| environment.sampled)
                }
            })
            .collect();
        let tree = light_tree(scene, &entries, &powers);
        let emits: Vec<bool> = powers.iter().map(|p| *p > 0.0).collect();
        let mut keep = emits.iter();
        entries.retain(|_| *keep.next().expect("one flag an entry"));
        let mut powers: Vec<f64> = powers.into_iter().filter(|p| *p > 0.0).collect();
        // What no random number stood for would never be found, and the power heuristic would wait for it.
        let least = least_share(powers.len()) * powers.iter().sum::<f64>();
        powers.iter_mut().for_each(|power| *power = power.max(least));
        let total_power: f64 = powers.iter().sum();
        let area_density = exitance.iter().map(|e| if *e == 0.0 { 0.0 } else { e / total_power }).collect();
        let least_probability = if powers.is_empty() { 0.0 } else { least / total_power };
        let choice = AliasTable::new(&powers);
        LuminaireTable { choice, entries, environment, area_density, least_probability, tree }
    }

    /// Whether what is sampled of a scene's light would be the same with another integrator: with a sky it depends on what else finds its light. (Whether there is a
    /// tree is left out: a tracer that has one need not choose by it, and one that has none chooses by power.)
    pub fn is_same_for(scene: &Scene, integrator: &Integrator) -> bool {
        scene.environment.is_none() || left_to_paths(scene, &scene.integrator) == left_to_paths(scene, integrator)
    }

    /// The probability of choosing an emissive triangle of this material and area, as it was asked for. With 32 random bits the table comes
    /// only near ([`AliasTable::pdf`]), the less so the smaller it is. What is divided by is what the table does; the power heuristic, whose
    /// weights have to add up to 1 wherever the light is found, goes by this.
    pub fn area_probability(&self, material: u32, area: f64) -> f64 {
        (self.area_density[material as usize] * area).max(self.least_probability)
    }

    /// The probability of choosing an entry, as the power heuristic has it.
    pub fn ideal_probability(&self, entry: usize) -> f64 {
        match &self.entries[entry] {
            SampledLuminaire::Area(triangle) => self.area_probability(triangle.material, triangle.area()),
            SampledLuminaire::Impulse(_) | SampledLuminaire::Sun(_) | SampledLuminaire::Environment => {
                self.choice.pdf[entry]
            }
        }
    }

    /// The discs at infinity, with the number of each in the table; they stand there in a row.
    pub fn suns(&self) -> impl Iterator<Item = (usize, &SunDisc)> {
        let after = self.environment_entry().unwrap_or(self.entries.len());
        // From behind, so that a table of a million triangles is not searched.
        let is_sun = |entry: &&SampledLuminaire| matches!(entry, SampledLuminaire::Sun(_));
        let count = self.entries[..after].iter().rev().take_while(is_sun).count();
        let suns = self.entries[after - count..after].iter().zip(after - count..);
        suns.filter_map(|(entry, index)| if let SampledLuminaire::Sun(sun) = entry { Some((index, sun)) } else { None })
    }

    /// Where the environment stands: last, if it is there. Without power, in a scene without extent, it is not.
    fn environment_entry(&self) -> Option<usize> {
        let last = self.entries.len().checked_sub(1)?;
        matches!(self.entries[last], SampledLuminaire::Environment).then_some(last)
    }

    /// The probability of choosing the environment; 0 if there is none.
    pub fn environment_probability(&self) -> f64 {
        self.environment_entry().map_or(0.0, |entry| self.choice.pdf[entry])
    }
}

/// How much of a sky's mean radiance is left to paths that escape. Where they go by the BSDF, and nothing but Russian roulette by the whole path
/// ends them, they find an even sky better than light sampling does. The lobes of a surface share its paths, so that a weak one has few: where a
/// material in use has several, whatever its maps make of them, a quarter of the mean is sampled.
fn left_to_paths(scene: &Scene, integrator: &Integrator) -> f64 {
    let Estimator { light_sampling, directions, extinction, albedo_threshold, .. } = integrator.estimator();
    let found = light_sampling == LightSampling::Mis
        && directions == Directions::Bsdf
        && matches!(extinction, Extinction::Off | Extinction::Throughput)
        && albedo_threshold.is_none();
    let lobes = |m: &Material| [m.lambert != Vec3::ZERO, m.glossy != Vec3::ZERO, m.has_impulse()];
    let several = |m: &Material| match &m.physical {
        Some(physical) => physical.metallic < 1.0 || physical.maps.metallic.is_some() || physical.clearcoat > 0.0,
        None => lobes(m).into_iter().filter(|has| *has).count() > 1,
    };
    if !found {
        return 0.0;
    }
    // First by the materials, which are few: their triangles may be many.
    let several = scene.materials.iter().any(several)
        && scene.materials.iter().zip(scene.materials_in_use()).any(|(material, used)| used && several(material));
    if several { 0.75 } else { 1.0 }
}

/// The tree over all entries that are somewhere and emit, if the estimator chooses by one; `entries` may have some of no power, which the table
/// leaves out.
fn light_tree(scene: &Scene, entries: &[SampledLuminaire], powers: &[f64]) -> Option<LightTree> {
    let estimator = scene.integrator.estimator();
    if estimator.light_sampling == LightSampling::None || estimator.light_choice == LightChoice::Power {
        return None;
    }
    let mean = |colour: Vec3| colour.as_dvec3().element_sum() / 3.0;
    let (mut sources, mut outer, mut index) = (vec![], vec![], 0);
    // That of the tree first.
    let mut outer_powers = vec![0.0];
    // Which of the emissive triangles an entry of the table is.
    let (mut place, mut emissive) = (vec![], 0);
    for (entry, own_power) in entries.iter().zip(powers) {
        let is_area = matches!(entry, SampledLuminaire::Area(_));
        let own_place = is_area.then_some(emissive);
        emissive += u32::from(is_area);
        if own_power.is_nan() || *own_power <= 0.0 {
            continue;
        }
        let source = |corners, normal, two_sided, strength| Source {
            entry: index,
            corners,
            normal,
            two_sided,
            closed: false,
            cone: None,
            strength,
        };
        match entry {
            SampledLuminaire::Impulse(Luminaire::Point { position, intensity }) => {
                sources.push(source([*position; 3], DVec3::ZERO, false, mean(*intensity)));
                outer_powers[0] += own_power;
            }
            SampledLuminaire::Area(triangle) => {
                let two_sided = !scene.materials[triangle.material as usize].one_sided;
                let corners = triangle.vertices.map(|vertex| vertex.as_vec3());
                // The power of a side is pi times this.
                let strength = own_power / PI * if two_sided { 0.5 } else { 1.0 };
                sources.push(source(corners, triangle.normal, two_sided, strength));
                outer_powers[0] += own_power;
            }
            SampledLuminaire::Impulse(Luminaire::Spot { position, direction, intensity, inner, outer }) => {
                let within = spot_flux(*inner, *outer) / (2.0 * PI * one_minus_cos(f64::from(*outer)));
                let cone = source([*position; 3], direction.as_dvec3(), false, within * mean(*intensity));
                sources.push(Source { cone: Some(f64::from(*outer)), ..cone });
                outer_powers[0] += own_power;
            }
            SampledLuminaire::Impulse(Luminaire::Photometric { position, direction, intensity, profile, .. }) => {
                let reach = profile.reach();
                let within = profile.flux() / (2.0 * PI * one_minus_cos(reach));
                let cone = source([*position; 3], direction.as_dvec3(), false, within * mean(*intensity));
                sources.push(Source { cone: Some(reach), ..cone });
                outer_powers[0] += own_power;
            }
            SampledLuminaire::Impulse(Luminaire::Infinite { .. } | Luminaire::Sun { .. })
            | SampledLuminaire::Sun(_)
            | SampledLuminaire::Environment => {
                outer.push(index);
                outer_powers.push(*own_power);
            }
        }
        place.push(own_place);
        index += 1;
    }
    if sources.is_empty() || (lamp_shapes(&mut sources) == 1 && estimator.light_choice == LightChoice::Auto) {
        return None;
    }
    let environment = matches!(entries.last(), Some(SampledLuminaire::Environment));
    let environment = environment && powers.last().is_some_and(|power| *power > 0.0);
    let least = least_share(outer_powers.len()) * outer_powers.iter().sum::<f64>();
    outer_powers.iter_mut().for_each(|weight| *weight = weight.max(least));
    let place = |entry: u32| place[entry as usize];
    Some(LightTree::new(scene, sources, place, emissive as usize, &outer, &outer_powers, environment))
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
    // From far away only the solid angle of the sphere counts.
    let solid_angle = |position: &Vec3| {
        let sine2 = (radius * radius / position.as_dvec3().distance_squared(center)).min(1.0);
        if sine2 < 1.0 { 2.0 * PI * sine2 / (1.0 + (1.0 - sine2).sqrt()) } else { 4.0 * PI }
    };
    match luminaire {
        Luminaire::Point { position, intensity } => solid_angle(position) * mean(intensity),
        // At most all of it, at most the brightest of it on the whole sphere: where the cone goes does not count, so that no light is without power.
        Luminaire::Spot { position, intensity, inner, outer, .. } => {
            spot_flux(*inner, *outer).min(solid_angle(position)) * mean(intensity)
        }
        Luminaire::Photometric { position, intensity, profile, .. } => {
            profile.flux().min(solid_angle(position) * profile.largest()) * mean(intensity)
        }
        Luminaire::Infinite { irradiance, .. } | Luminaire::Sun { irradiance, .. } => {
            PI * radius * radius * mean(irradiance)
        }
    }
}

/// What a spot of the intensity 1 sends: within the inner cone all, and up to the outer one a third of it, as a square falls.
fn spot_flux(inner: f32, outer: f32) -> f64 {
    let (edge, scale) = spot_edge(inner, outer);
    2.0 * PI * (edge - 2.0 / 3.0 / scale)
}

/// The entry of a luminaire without an extent: a disc of no size is a direction.
fn impulse(luminaire: &Luminaire) -> SampledLuminaire {
    SampledLuminaire::Impulse(match luminaire {
        Luminaire::Sun { direction, irradiance, .. } => {
            Luminaire::Infinite { direction: *direction, irradiance: *irradiance }
        }
        other => other.clone(),
    })
}

/// The entry of a disc.
fn disc(luminaire: &Luminaire) -> Option<SampledLuminaire> {
    match *luminaire {
        Luminaire::Sun { direction, irradiance, angle } => {
            Some(SampledLuminaire::Sun(SunDisc::new(direction, irradiance, angle)))
        }
        _ => None,
    }
}
