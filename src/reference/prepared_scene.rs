//! The reference tracer: a scene, and what is made of it before the first ray.

use super::instance::Instance;
use super::physical::PhysicalSurface;
use super::tree::Trees;
use crate::memory::available;
use crate::scene::{FilmSettings, Integrator, LuminaireTable, Scene, coat_transmittance, widen};
use glam::DVec3;

/// The reference tracer with its scene; seed, film size and integrator are the scene's own.
pub struct Reference {
    pub(super) scene: Scene,
    pub(super) instances: Vec<Instance>,
    /// None: every triangle is tested.
    pub(super) trees: Option<Trees>,
    pub(super) luminaires: LuminaireTable,
    /// For each material, what [`Surfel::coat_transmittance`](super::surfel::Surfel::coat_transmittance) is.
    pub(super) coats: Vec<f64>,
    /// For each material its metallic-roughness surface, if it is one, without maps.
    pub(super) surfaces: Vec<Option<PhysicalSurface>>,
    /// Whether there is a body that absorbs and is not opaque everywhere.
    pub(super) pierced_bodies: bool,
    /// Inverse of the pixel filter's distribution; empty for the pixel's own square.
    pub(super) filter: Vec<f32>,
}

/// Bytes that a tracer with trees takes for a triangle, as 980 000 of them had it.
const TRIANGLE: u64 = 240;

impl Reference {
    /// Whether the memory that is free holds a tracer of a scene ([`Reference::new`]).
    pub fn fits(scene: &Scene) -> bool {
        let triangles: u64 = scene.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum();
        available().is_none_or(|free| triangles * TRIANGLE <= free)
    }

    /// A tracer that finds triangles through a tree of boxes. The caller sees to it that the estimator ends
    /// ([`crate::scene::Estimator::ends`]).
    pub fn new(scene: &Scene) -> Self {
        let mut reference = Self::brute_force(scene);
        reference.trees = Some(Trees::new(scene, &reference.instances));
        reference
    }

    /// A tracer that tests every triangle for every ray: the oracle for [`Reference::new`], too simple to be wrong.
    pub fn brute_force(scene: &Scene) -> Self {
        let scene = scene.with_tangents();
        let instances = scene
            .objects
            .iter()
            .map(|object| {
                let to_world = widen(object.object_to_world);
                let to_object = to_world.inverse();
                Instance { to_world, to_object, normal_to_world: to_object.matrix3.transpose() }
            })
            .collect();
        let coated = scene.materials.iter().map(|m| m.eta.filter(|_| m.is_coated()));
        let coats = coated.map(|eta| eta.map_or(1.0, |eta| coat_transmittance(eta.into()))).collect();
        let surfaces = scene.materials.iter().map(PhysicalSurface::without_maps).collect();
        let pierced_bodies = scene.materials.iter().any(|material| material.absorbs() && material.has_holes());
        let (luminaires, filter) = (LuminaireTable::new(&scene), filter_table(&scene.film));
        Reference {
            scene: scene.into_owned(),
            instances,
            trees: None,
            luminaires,
            coats,
            surfaces,
            pierced_bodies,
            filter,
        }
    }

    /// Takes another integrator. Which luminaires are sampled, and how often, may depend on it: returns the table that there was, if another one was made.
    pub(super) fn set_integrator(&mut self, integrator: &Integrator) -> Option<LuminaireTable> {
        let same = LuminaireTable::is_same_for(&self.scene, integrator);
        self.scene.integrator = *integrator;
        (!same).then(|| std::mem::replace(&mut self.luminaires, LuminaireTable::new(&self.scene)))
    }

    /// The material of a triangle of an object: the object's, or else the triangle's own.
    pub(super) fn material_index(&self, object: u32, triangle: u32) -> u32 {
        let object = &self.scene.objects[object as usize];
        let own = || self.scene.meshes[object.mesh as usize].triangles[triangle as usize].material;
        object.material.unwrap_or_else(own)
    }

    /// World-space corners of a triangle of an object.
    pub(super) fn corners(&self, object: u32, triangle: u32) -> [DVec3; 3] {
        let mesh = &self.scene.meshes[self.scene.objects[object as usize].mesh as usize];
        let to_world = &self.instances[object as usize].to_world;
        let vertices = mesh.triangles[triangle as usize].vertices;
        vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()))
    }
}

/// What [`Reference::filter`] holds.
pub(super) fn filter_table(film: &FilmSettings) -> Vec<f32> {
    if film.is_pixel_square() { vec![] } else { film.filter.inverse_cdf(film.filter_radius) }
}
