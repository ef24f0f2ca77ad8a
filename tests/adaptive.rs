//! Samples where they are needed: shares of tiles, from outside.

use luminaire::film::{AovSum, Batch, PixelSum, Rays, Tile};
use luminaire::part::{self, Provenance};
use luminaire::render::{End, Limits, Rendered, Traced, Tracer, resume};
use luminaire::sampling::{random4, uniform};
use luminaire::scene::build::empty;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

const SIDE: u32 = 40;

/// Grey pixels of radiance 1, whose samples are skewed: rare ones are brighter, and the others darker by [`spread`].
struct Uneven {
    seed: u32,
    /// The probability of the bright ones.
    rare: f64,
    /// By how much all are spread, over [`spread`].
    scale: f64,
    batch_seconds: f64,
    batches: usize,
}

impl Uneven {
    fn new(seed: u32) -> Self {
        Uneven { seed, rare: 0.125, scale: 1.0, batch_seconds: 1e9, batches: 0 }
    }
}

/// It halves from the left to the right several times.
fn spread(x: u32) -> f64 {
    0.5 * (-f64::from(x) / 9.0).exp2()
}

impl Tracer for Uneven {
    fn trace(&mut self, batch: &Batch) -> luminaire::Result<Traced> {
        self.batches += 1;
        let tile = batch.tile;
        let mut sums = Vec::new();
        for group in 0..batch.groups() {
            for y in tile.y..tile.y + tile.height {
                for x in tile.x..tile.x + tile.width {
                    let mut sum = PixelSum::default();
                    for sample in batch.group_samples(group) {
                        let random = uniform(random4(y * SIDE + x, sample, 0, self.seed)[0]);
                        let value = 1.0
                            + self.scale * spread(x) * if random < self.rare { 1.0 / self.rare - 1.0 } else { -1.0 };
                        sum.radiance.iter_mut().for_each(|sum| *sum += value);
                        sum.rays += Rays { all: 1, shadow: 0 };
                    }
                    sums.push(sum);
                }
            }
        }
        let samples = tile.pixels() * batch.samples.len();
        Ok(Traced { sums, dropped: vec![], device_seconds: Some(samples as f64 * 1e-6) })
    }

    fn aovs(&mut self, tile: Tile, _: Range<u32>) -> luminaire::Result<Vec<AovSum>> {
        Ok(vec![AovSum::default(); tile.pixels()])
    }

    fn max_sums(&self) -> usize {
        1 << 20
    }

    fn batch_seconds(&self) -> f64 {
        self.batch_seconds
    }
}

fn nothing() -> Rendered {
    Rendered::nothing((SIDE, SIDE), 0).unwrap()
}

fn limits(noise: f64) -> Limits {
    Limits { noise: Some(noise), spp: Some(4096), adaptive: true, ..Limits::default() }
}

fn render(tracer: &mut Uneven, noise: f64) -> Rendered {
    resume(tracer, nothing(), limits(noise), &mut |_| {}, &AtomicBool::new(false))
}

#[test]
fn noisy_tiles_get_more_samples_and_the_error_is_met_with_fewer() {
    let rendered = render(&mut Uneven::new(1), 0.03);
    assert!(matches!(rendered.end, End::Noise));
    let samples = |x: usize| rendered.film.samples[20 * SIDE as usize + x];
    assert!(samples(2) >= 4 * samples(38), "{} and {}", samples(2), samples(38));
    let even = Limits { adaptive: false, ..limits(0.03) };
    let even = resume(&mut Uneven::new(1), nothing(), even, &mut |_| {}, &AtomicBool::new(false));
    assert!(even.shares.is_none());
    let saved = rendered.progress.spp() / even.progress.spp();
    assert!(saved < 0.85, "{} and {} samples a pixel", rendered.progress.spp(), even.progress.spp());
    let square = rendered.film.to_linear().iter().map(|v| f64::from(v - 1.0).powi(2)).sum::<f64>();
    let error = (square / f64::from(3 * SIDE * SIDE) / (1.0 + 1.0 / 9.0)).sqrt();
    assert!(error < 1.1 * 0.03, "{error}");
}

/// The mean of many adaptive renders is the truth: other samples decide than are reported. If a tile decided by its own, rare bright samples would get it more of them,
/// and count for less: z is -4 then.
#[test]
fn adaptive_samples_have_no_bias() {
    let renders = 400;
    let (mut sum, mut square, mut adaptive) = (0.0, 0.0, 0);
    for seed in 0..renders {
        let rendered = render(&mut Uneven { rare: 1.0 / 128.0, scale: 0.1, ..Uneven::new(seed) }, 0.019);
        adaptive += u32::from(rendered.shares.is_some());
        // In units of what a sample varies, so that quiet pixels say as much as noisy ones.
        let off = |pixel: usize| (rendered.film.mean(pixel)[0] - 1.0) / spread(pixel as u32 % SIDE);
        let off = (0..rendered.film.pixels()).map(off).sum::<f64>() / f64::from(SIDE * SIDE);
        sum += off;
        square += off * off;
    }
    let n = f64::from(renders);
    let z = sum / n / (square / n / n).sqrt();
    println!("bias {:+.4} spreads, z {z:+.2}, shares in {adaptive} of {renders}", sum / n);
    assert!(adaptive > renders * 8 / 10, "{adaptive}");
    assert!(z.abs() < 3.0, "z {z:+.2}");
}

#[test]
fn batches_and_interruptions_do_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint.exr");
    let provenance = Provenance::of(&empty(SIDE, SIDE));
    let whole = render(&mut Uneven::new(7), 0.03);
    assert!(whole.shares.is_some());
    for batch_seconds in [2e-4, 1e-2] {
        let mut tracer = Uneven { batch_seconds, ..Uneven::new(7) };
        let rendered = render(&mut tracer, 0.03);
        assert!(rendered.film == whole.film && rendered.shares == whole.shares, "{batch_seconds}");
        // Interrupted again and again, each time read from a file: the first time in the middle of the even part.
        for every in [5, tracer.batches / 6] {
            if every == 5 && tracer.batches > 200 {
                continue;
            }
            let (mut rendered, stop) = (nothing(), AtomicBool::new(false));
            let mut runs = 0;
            loop {
                let mut tracer = Uneven { batch_seconds, ..Uneven::new(7) };
                let mut batches = 0;
                let mut watch = |_: &Rendered| {
                    batches += 1;
                    stop.store(batches >= every, Ordering::Relaxed);
                };
                stop.store(false, Ordering::Relaxed);
                rendered = resume(&mut tracer, rendered, limits(0.03), &mut watch, &stop);
                runs += 1;
                part::save(&path, &rendered, &provenance).unwrap();
                if !matches!(rendered.end, End::Stopped) {
                    break;
                }
                rendered = part::read(&path).unwrap().0;
            }
            assert!(runs > 3 && matches!(rendered.end, End::Noise), "{runs}");
            assert!(rendered.film == whole.film && rendered.shares == whole.shares, "{batch_seconds}, {every}");
        }
    }
    let refused = part::merge(&[path]).unwrap_err();
    assert!(refused.to_string().contains("--adaptive") && refused.exit_code() == 2, "{refused}");
}

/// What was begun with shares goes on with them, also where no noise ends it, and never beyond the samples in the mean.
#[test]
fn shares_stay_without_a_limit_of_the_noise() {
    let begun = render(&mut Uneven::new(3), 0.05);
    let (shares, before) = (begun.shares.clone().unwrap(), begun.progress.spp());
    let more = Limits { spp: Some(2 * before as u32), ..Limits::default() };
    let rendered = resume(&mut Uneven::new(3), begun, more, &mut |_| {}, &AtomicBool::new(false));
    assert!(matches!(rendered.end, End::Samples) && rendered.shares.as_ref() == Some(&shares));
    let spp = rendered.progress.spp();
    assert!(spp <= 2.0 * before && spp > 1.7 * before, "{before} and {spp}");
}
