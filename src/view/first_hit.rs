//! What the camera sees first, traced on the host: albedo, normal and depth of the surface behind each pixel.

use crate::Result;
use crate::backend::SceneTracer;
use crate::film::{AovSum, Batch, PixelSum, Rays, Tile};
use crate::reference::Reference;
use crate::render::{Traced, Tracer};
use crate::sampling::ray_salt;
use crate::scene::{FilmSettings, Integrator, Scene, Sensor};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// What of the first surface is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstHit {
    /// All of its albedos, added up, at most 1.
    Albedo,
    /// The unit shading normal in world space, on the side of the camera.
    Normal,
    /// How far it is from where the ray begins, in the scene's unit; then the share of the samples that met a surface, and 0.
    Depth,
}

/// A tracer whose "radiance" is a property of the first surface: so it fills a film as the others do, with the pixel filter and the lens.
pub struct FirstHits {
    reference: Reference,
    kind: FirstHit,
    seed: u32,
    /// Of the film.
    width: u32,
}

impl FirstHits {
    /// Builds the reference's trees for a scene.
    pub fn new(scene: &Scene, kind: FirstHit) -> Self {
        FirstHits { reference: Reference::new(scene), kind, seed: scene.settings.seed, width: scene.film.width }
    }

    /// Lets it show something else.
    pub fn show(&mut self, kind: FirstHit) {
        self.kind = kind;
    }

    fn value(&self, pixel: u32, sample: u32) -> DVec3 {
        let (origin, direction) = self.reference.sensor_ray(pixel, sample);
        let salt = ray_salt(pixel, sample, 0, self.seed);
        let Some(hit) = self.reference.closest_hit(origin, direction, f64::INFINITY, salt) else { return DVec3::ZERO };
        if self.kind == FirstHit::Depth {
            return DVec3::new(hit.t, 1.0, 0.0);
        }
        let surfel = self.reference.surfel(&hit, -direction);
        match self.kind {
            FirstHit::Normal => surfel.shading_normal,
            // Of a dielectric either the one or the other.
            _ => (surfel.lambert + surfel.glossy + surfel.reflection.max(surfel.transmission)).min(DVec3::ONE),
        }
    }
}

impl SceneTracer for FirstHits {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        self.width = film.width;
        self.reference.look(sensor, film)
    }

    fn integrate(&mut self, _: &Integrator) -> Result<()> {
        // What is seen first does not depend on it.
        Ok(())
    }
}

impl Tracer for FirstHits {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let tile = batch.tile;
        let pixels = tile.pixels();
        let sum = |index: usize| {
            let (group, in_tile) = ((index / pixels) as u32, (index % pixels) as u32);
            let pixel = (tile.y + in_tile / tile.width) * self.width + tile.x + in_tile % tile.width;
            let mut sum = PixelSum::default();
            let mut radiance = DVec3::ZERO;
            for sample in batch.group_samples(group) {
                sum.rays += Rays { all: 1, shadow: 0 };
                match self.value(pixel, sample) {
                    value if value.is_finite() => radiance += value,
                    _ => sum.dropped += 1,
                }
            }
            PixelSum { radiance: radiance.to_array(), ..sum }
        };
        let sums = (0..pixels * batch.groups() as usize).into_par_iter().map(sum).collect();
        Ok(Traced { sums, ..Traced::default() })
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        self.reference.aovs(tile, samples)
    }

    fn max_sums(&self) -> usize {
        self.reference.max_sums()
    }

    fn batch_seconds(&self) -> f64 {
        self.reference.batch_seconds()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load;

    #[test]
    fn a_square_that_faces_the_camera() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.mtl"), "newmtl a\nKd 0.2 0.4 0.6\n").unwrap();
        let quad = "mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl a\nf 1 2 3 4\n";
        std::fs::write(folder.path().join("a.obj"), quad).unwrap();
        // It fills the left half of the picture.
        let text = "[film]\nwidth = 2\nheight = 1\n[sensor]\nkind = \"orthographic\"\nheight = 2\nposition = [1, 0, 3]\ntarget = [1, 0, 0]\n\
                    [[luminaire]]\nkind = \"point\"\nposition = [0, 0, 5]\nintensity = [1, 1, 1]\n[[object]]\nmesh = \"a.obj\"\n";
        std::fs::write(folder.path().join("a.toml"), text).unwrap();
        let scene = load(&folder.path().join("a.toml")).unwrap();
        let batch = Batch { tile: Tile { x: 0, y: 0, width: 2, height: 1 }, samples: 0..4, group: 1 };
        for (kind, expected) in [
            (FirstHit::Albedo, [0.2f32, 0.4, 0.6].map(f64::from)),
            (FirstHit::Normal, [0.0, 0.0, 1.0]),
            (FirstHit::Depth, [3.0, 1.0, 0.0]),
        ] {
            let mut tracer = FirstHits::new(&scene, FirstHit::Albedo);
            tracer.show(kind);
            let sums = tracer.trace(&batch).unwrap().sums;
            assert_eq!(sums.len(), 8);
            for (i, sum) in sums.iter().enumerate() {
                let expected = if i % 2 == 0 { expected } else { [0.0; 3] };
                assert!(sum.radiance.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{kind:?} {sum:?}");
            }
        }
    }
}
