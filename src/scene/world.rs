//! `Scene`: the scene as a whole.

use super::{
    Camera, Environment, FilmSettings, Integrator, Luminaire, Material, Mesh, Object, RenderSettings, Sensor, Texture,
    Triangle,
};
use super::{moved_box, widen};
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// A whole scene, checked: indices are in range, numbers are finite, there is at least one triangle.
///
/// What is large (meshes, textures, the image of the environment) is shared: a clone costs little, and changing one does not show in the other
/// ([`Arc::make_mut`]).
#[derive(Debug, Clone)]
pub struct Scene {
    /// The file it came from.
    pub path: PathBuf,
    /// What has to be added to a world position to have it in the coordinates of the files: the loader moves scenes that lie far from the origin,
    /// as surveyors' do, before their numbers are rounded to single precision. Zero for all others.
    pub origin: DVec3,
    /// Meshes, in object space; an OBJ file is one mesh.
    pub meshes: Vec<Arc<Mesh>>,
    /// Instances of meshes. Never empty.
    pub objects: Vec<Object>,
    /// Materials; triangles and objects refer to them by index. Never empty.
    pub materials: Vec<Material>,
    /// Images; the maps of materials refer to them by index.
    pub textures: Vec<Arc<Texture>>,
    /// Point luminaires and luminaires at infinity. Area luminaires are the emissive triangles of `objects`.
    pub luminaires: Vec<Luminaire>,
    /// Light from where rays escape to; none: escaping light disappears.
    pub environment: Option<Environment>,
    /// The camera that is rendered.
    pub sensor: Sensor,
    /// Every camera that the scene file has, in its order; [`Scene::sensor`] is the first of them unless somebody chose another. Empty if it has none.
    pub cameras: Vec<Camera>,
    /// Film size and pixel filter.
    pub film: FilmSettings,
    /// Which estimator runs.
    pub integrator: Integrator,
    /// Samples, seed, exposure and tone curve, unless the caller wants others.
    pub settings: RenderSettings,
    /// What the loader had to guess, drop or scale; one sentence each, with file and line where there is one.
    pub warnings: Vec<String>,
    /// What the loader chose where a bare model says nothing, one sentence each: no reason to worry, but to know.
    pub notes: Vec<String>,
    /// The object that is a ground which the loader made, if there is one: it reaches far beyond the model.
    pub ground: Option<u32>,
    /// Every file that the scene was loaded from or that one of its files names, so that none of them is written to: the scene file, meshes, MTL files, images,
    /// those that nothing shows or that cannot be used included. A file that is missing is none of them.
    pub files: Vec<PathBuf>,
}

impl Scene {
    /// Why single precision, and so a GPU, cannot draw this picture, as a sentence for a warning; none if it can. It follows from the size of the
    /// film, too.
    pub fn blurred_because(&self) -> Option<String> {
        self.sensor.is_beyond_single_precision(&self.film, self.world_bounds()).then(|| {
            format!(
                "{}: a pixel is smaller than what single precision tells apart at these distances and coordinates, so that a GPU's picture is \
                 blurred or shifted: take --backend cpu, or bring the scene nearer to the camera and to the origin",
                self.path.display()
            )
        })
    }

    /// Triangles over all instances.
    pub fn triangle_count(&self) -> u64 {
        self.objects.iter().map(|o| self.meshes[o.mesh as usize].triangles.len() as u64).sum()
    }

    /// The material of a triangle of an instance: the instance's own, else the triangle's.
    pub fn material_of(&self, object: &Object, triangle: &Triangle) -> &Material {
        &self.materials[object.material.unwrap_or(triangle.material) as usize]
    }

    /// For each material, whether a triangle is made of it.
    pub fn materials_in_use(&self) -> Vec<bool> {
        let mut used = vec![false; self.materials.len()];
        let mut own = vec![false; self.meshes.len()];
        for object in &self.objects {
            match object.material {
                Some(material) => used[material as usize] = true,
                None => own[object.mesh as usize] = true,
            }
        }
        for (mesh, _) in self.meshes.iter().zip(own).filter(|(_, own)| *own) {
            mesh.triangles.iter().for_each(|triangle| used[triangle.material as usize] = true);
        }
        used
    }

    /// World-space bounding box of all triangles of all instances but the ground that the loader made, the smallest: every corner counts, so that
    /// it takes longer than [`Scene::model_bounds`].
    pub fn tight_bounds(&self) -> (DVec3, DVec3) {
        let mut corners: Vec<Option<Vec<DVec3>>> = vec![None; self.meshes.len()];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (_, object) in (0..).zip(&self.objects).filter(|(index, _)| self.ground != Some(*index)) {
            let to_world = widen(object.object_to_world);
            let mesh = &self.meshes[object.mesh as usize];
            let corners = corners[object.mesh as usize].get_or_insert_with(|| mesh.corners());
            let (a, b) =
                corners.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
            let [a, b] = moved_box([a, b], &to_world);
            // Most instances lie within what others reach.
            if a.cmpge(low).all() && b.cmple(high).all() {
                continue;
            }
            for corner in corners.iter() {
                let place = to_world.transform_point3(*corner);
                (low, high) = (low.min(place), high.max(place));
            }
        }
        (low, high)
    }

    /// World-space bounding box of all instances (of the corners of the meshes' own boxes, so not always the smallest).
    pub fn world_bounds(&self) -> (glam::DVec3, glam::DVec3) {
        self.bounds_of(|_| true)
    }

    /// [`Scene::world_bounds`] without the ground that the loader made: what is looked at.
    pub fn model_bounds(&self) -> (glam::DVec3, glam::DVec3) {
        self.bounds_of(|object| self.ground != Some(object))
    }

    fn bounds_of(&self, counts: impl Fn(u32) -> bool) -> (glam::DVec3, glam::DVec3) {
        let boxes: Vec<_> = self.meshes.iter().map(|mesh| mesh.bounds()).collect();
        let mut low = glam::DVec3::INFINITY;
        let mut high = glam::DVec3::NEG_INFINITY;
        for (_, object) in (0..).zip(&self.objects).filter(|(index, _)| counts(*index)) {
            let to_world = widen(object.object_to_world);
            let (a, b) = boxes[object.mesh as usize];
            let moved = moved_box([a, b].map(|corner| corner.as_dvec3()), &to_world);
            (low, high) = (low.min(moved[0]), high.max(moved[1]));
        }
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::build::{add, empty, matte, quad};
    use glam::{Affine3A, DVec3, Quat, Vec3};
    use std::sync::Arc;

    #[test]
    fn tight_bounds_are_those_of_the_turned_triangles() {
        let mut scene = empty(1, 1);
        // A square on its corner becomes one on its side, twice.
        let diamond = quad(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::new(-1.0, 1.0, 0.0));
        let turn = Affine3A::from_quat(Quat::from_rotation_z(-std::f32::consts::FRAC_PI_4));
        add(&mut scene, diamond, matte(Vec3::ONE), turn);
        let inner = scene.objects[0].clone();
        scene.objects.push(super::Object { object_to_world: Affine3A::from_scale(Vec3::splat(0.25)) * turn, ..inner });
        // A vertex that no triangle has.
        Arc::make_mut(&mut scene.meshes[0]).positions.push(Vec3::splat(9.0));
        let (low, high) = scene.tight_bounds();
        let root = std::f64::consts::SQRT_2;
        assert!(
            (low - DVec3::ZERO).length() < 1e-6 && (high - DVec3::new(root, root, 0.0)).length() < 1e-6,
            "{low} {high}"
        );
        let (_, loose) = scene.world_bounds();
        assert!(loose.x > 2.0, "{loose}");
        scene.objects.truncate(1);
        scene.objects[0].object_to_world = Affine3A::from_translation(Vec3::splat(5.0));
        assert_eq!(scene.tight_bounds(), (DVec3::new(4.0, 5.0, 5.0), DVec3::new(6.0, 7.0, 5.0)));
    }

    #[test]
    fn a_clone_shares_what_is_large() {
        let mut scene = empty(1, 1);
        add(&mut scene, quad(Vec3::ZERO, Vec3::X, Vec3::Y), matte(Vec3::ONE), Affine3A::IDENTITY);
        let mut other = scene.clone();
        assert!(Arc::ptr_eq(&scene.meshes[0], &other.meshes[0]));
        Arc::make_mut(&mut other.meshes[0]).positions[0] = Vec3::Z;
        assert_eq!([&scene, &other].map(|scene| scene.meshes[0].positions[0]), [Vec3::ZERO, Vec3::Z]);
    }
}
