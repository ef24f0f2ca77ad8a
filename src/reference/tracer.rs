//! The reference at work: batches of samples, first hits, another camera.

use super::prepared_scene::{Reference, filter_table};
use crate::Result;
use crate::film::{AovSum, Batch, MOST_RADIANCE, PixelSum, Rays, SampleId, Tile};
use crate::render::{SceneTracer, Traced, Tracer};
use crate::scene::{FilmSettings, Integrator, Sensor};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

impl SceneTracer for Reference {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        (self.scene.sensor, self.scene.film) = (sensor.clone(), *film);
        self.filter = filter_table(film);
        Ok(())
    }

    fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        integrator.check_ends()?;
        self.set_integrator(integrator);
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
                let (mut sum, mut rays, mut dropped, mut missed) = (DVec3::ZERO, Rays::default(), vec![], 0);
                for sample in batch.group_samples(group) {
                    let mut first = this.scene.settings.transparent;
                    let (radiance, traced) = this.follow(pixel, sample, &mut |vertex| {
                        missed += u32::from(first && vertex.hit.is_none());
                        first = false;
                        true
                    });
                    rays += traced;
                    if radiance.is_finite() && radiance.abs().max_element() < MOST_RADIANCE {
                        sum += radiance;
                    } else {
                        dropped.push(SampleId { pixel, sample });
                    }
                }
                (PixelSum { radiance: sum.to_array(), rays, dropped: dropped.len() as u32, missed }, dropped)
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
