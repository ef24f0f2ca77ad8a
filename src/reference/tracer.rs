//! The tracer: a scene, and what is made of it before the first ray.

use super::instance::Instance;
use super::tree::Trees;
use crate::Result;
use crate::film::{AovSum, Batch, MOST_RADIANCE, PixelSum, Rays, SampleId, Tile};
use crate::render::{SceneTracer, Traced, Tracer};
use crate::scene::{FilmSettings, Integrator, LuminaireTable, Scene, Sensor, widen};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// The reference tracer with its scene; seed, film size and integrator are the scene's own.
pub struct Reference {
    pub(super) scene: Scene,
    pub(super) instances: Vec<Instance>,
    /// None: every triangle is tested.
    pub(super) trees: Option<Trees>,
    pub(super) luminaires: LuminaireTable,
    /// Inverse of the pixel filter's distribution; empty for the pixel's own square.
    pub(super) filter: Vec<f32>,
}

impl Reference {
    /// A tracer that finds triangles through a tree of boxes. The caller sees to it that the estimator ends
    /// ([`crate::scene::Estimator::ends`]).
    pub fn new(scene: &Scene) -> Self {
        let mut reference = Self::brute_force(scene);
        reference.trees = Some(Trees::new(scene, &reference.instances));
        reference
    }

    /// A tracer that tests every triangle for every ray: the oracle for [`Reference::new`], too simple to be wrong.
    pub fn brute_force(scene: &Scene) -> Self {
        let instances = scene
            .objects
            .iter()
            .map(|object| {
                let to_world = widen(object.object_to_world);
                let to_object = to_world.inverse();
                Instance { to_world, to_object, normal_to_world: to_object.matrix3.transpose() }
            })
            .collect();
        let (luminaires, filter) = (LuminaireTable::new(scene), filter_table(&scene.film));
        Reference { scene: scene.clone(), instances, trees: None, luminaires, filter }
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
fn filter_table(film: &FilmSettings) -> Vec<f32> {
    if film.is_pixel_square() { vec![] } else { film.filter.inverse_cdf(film.filter_radius) }
}

impl SceneTracer for Reference {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        (self.scene.sensor, self.scene.film) = (sensor.clone(), *film);
        self.filter = filter_table(film);
        Ok(())
    }

    fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        integrator.check_ends()?;
        self.scene.integrator = *integrator;
        Ok(())
    }
}

impl Tracer for Reference {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let this = &*self;
        let tile = batch.tile;
        let pixels = tile.pixels();
        let (sums, dropped): (Vec<PixelSum>, Vec<Vec<SampleId>>) = (0..pixels * batch.groups() as usize)
            .into_par_iter()
            .map(|index| {
                let (group, in_tile) = ((index / pixels) as u32, (index % pixels) as u32);
                let pixel = (tile.y + in_tile / tile.width) * this.scene.film.width + tile.x + in_tile % tile.width;
                let (mut sum, mut rays, mut dropped) = (DVec3::ZERO, Rays::default(), vec![]);
                for sample in batch.group_samples(group) {
                    let (radiance, traced) = this.radiance(pixel, sample);
                    rays += traced;
                    if radiance.is_finite() && radiance.abs().max_element() < MOST_RADIANCE {
                        sum += radiance;
                    } else {
                        dropped.push(SampleId { pixel, sample });
                    }
                }
                (PixelSum { radiance: sum.to_array(), rays, dropped: dropped.len() as u32 }, dropped)
            })
            .unzip();
        Ok(Traced { sums, dropped: dropped.concat(), device_seconds: None })
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        let this = &*self;
        let sums = (0..tile.pixels() as u32).into_par_iter().map(|in_tile| {
            let pixel = (tile.y + in_tile / tile.width) * this.scene.film.width + tile.x + in_tile % tile.width;
            this.first_hits(pixel, samples.clone())
        });
        Ok(sums.collect())
    }

    fn max_sums(&self) -> usize {
        1 << 22
    }

    fn batch_seconds(&self) -> f64 {
        0.2
    }
}
