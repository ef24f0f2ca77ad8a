//! What the camera sees first: albedo, normal and depth of the surface behind each pixel.

use luminaire::Result;
use luminaire::film::{AovSum, Batch, PixelSum, Rays, Tile};
use luminaire::render::{SceneTracer, Traced, Tracer};
use luminaire::scene::{FilmSettings, Integrator, Sensor};
use std::ops::Range;

/// What of the first surface is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstHit {
    /// Its albedos.
    Albedo,
    /// The unit shading normal in world space, on the side of the camera.
    Normal,
    /// Its distance in the scene's unit, then 1 where a surface is met, then 0.
    Depth,
}

/// A tracer whose "radiance" is a property of the first surface, taken from the [`Tracer::aovs`] of another tracer, so that it can fill a film.
pub struct FirstHits<'a> {
    /// The other tracer.
    pub tracer: &'a mut dyn SceneTracer,
    /// The property.
    pub kind: FirstHit,
}

impl FirstHits<'_> {
    fn value(&self, sum: &AovSum) -> [f64; 3] {
        match self.kind {
            FirstHit::Albedo => sum.albedo.map(f64::from),
            FirstHit::Normal => sum.normal.map(f64::from),
            FirstHit::Depth => [sum.depth.into(), sum.hits.into(), 0.0],
        }
    }
}

impl SceneTracer for FirstHits<'_> {
    fn look(&mut self, sensor: &Sensor, film: &FilmSettings) -> Result<()> {
        self.tracer.look(sensor, film)
    }

    fn integrate(&mut self, integrator: &Integrator) -> Result<()> {
        self.tracer.integrate(integrator)
    }
}

impl Tracer for FirstHits<'_> {
    fn trace(&mut self, batch: &Batch) -> Result<Traced> {
        let mut sums = Vec::with_capacity(batch.tile.pixels() * batch.groups() as usize);
        for group in 0..batch.groups() {
            let first = sums.len();
            sums.resize(first + batch.tile.pixels(), PixelSum::default());
            // One by one: what is not finite is left out by itself.
            for sample in batch.group_samples(group) {
                let found = self.tracer.aovs(batch.tile, sample..sample + 1)?;
                for (sum, found) in sums[first..].iter_mut().zip(&found) {
                    let value = self.value(found);
                    sum.rays += Rays { all: 1, shadow: 0 };
                    if value.iter().all(|v| v.is_finite()) {
                        sum.radiance.iter_mut().zip(value).for_each(|(sum, v)| *sum += v);
                    } else {
                        sum.dropped += 1;
                    }
                }
            }
        }
        Ok(Traced { sums, ..Traced::default() })
    }

    fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
        self.tracer.aovs(tile, samples)
    }

    fn max_sums(&self) -> usize {
        self.tracer.max_sums() / 2
    }

    fn batch_seconds(&self) -> f64 {
        self.tracer.batch_seconds()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::reference::Reference;
    use luminaire::scene::load;

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
        let batch = Batch { tile: Tile { x: 0, y: 0, width: 2, height: 1 }, samples: 0..11, group: 2 };
        for (kind, expected) in [
            (FirstHit::Albedo, [0.2f32, 0.4, 0.6].map(f64::from)),
            (FirstHit::Normal, [0.0, 0.0, 1.0]),
            (FirstHit::Depth, [3.0, 1.0, 0.0]),
        ] {
            let mut reference = Reference::new(&scene);
            let sums = FirstHits { tracer: &mut reference, kind }.trace(&batch).unwrap().sums;
            assert_eq!(sums.len(), 12);
            for (i, sum) in sums.iter().enumerate() {
                // Five groups of two samples, and one of one.
                let samples = if i < 10 { 2.0 } else { 1.0 };
                let expected = if i % 2 == 0 { expected.map(|v| samples * v) } else { [0.0; 3] };
                assert!(sum.radiance.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{kind:?} {sum:?}");
                assert_eq!(sum.rays.all, samples as u32);
            }
        }
    }
}
