//! The progressive loop: batches, limits (samples, time, noise), progress, cancellation.
//!
//! Samples are summed in groups that follow each other, whose bounds depend on the sample's index alone: one by one below 8, by two below 16, then by four.
//! A batch is one tile and some of these groups, as many as a device does in the time it asks for. How the work was cut into batches therefore never shows in the picture: the same groups are added in the same order, to
//! the last bit. A limit of the noise is looked at after numbers of samples that follow from the picture alone, so it does not depend on the
//! device's speed either.
//!
//! [`render`] and [`resume`] are the whole loop; a program that has other things to do between two batches does the [steps](Run::step) itself.

mod aovs;
mod budget;
mod cropped;
mod patches;
mod progress;
mod rendered;
mod run;
mod schedule;
mod shares;
mod tracer;

pub use aovs::aovs;
pub use budget::{Budget, Pace};
pub use cropped::Cropped;
pub use progress::{LEAST_FOR_NOISE, Limits, MOST_WITHOUT_ESTIMATE, Progress};
pub use rendered::{DROPPED_NAMED, End, Rendered};
pub use run::Run;
pub(crate) use schedule::is_a_pass;
pub use shares::Shares;
pub use tracer::{SceneTracer, Traced, Tracer};

use crate::Result;
use rendered::at_a_look;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Renders `width` by `height` pixels until a limit is met or `stop` is set, calling `progress` after each batch.
///
/// # Errors
/// If the film does not fit into memory. A failure of the tracer is an [`End`], so that what was done is not lost.
pub fn render(
    tracer: &mut dyn Tracer,
    size: (u32, u32),
    limits: Limits,
    progress: &mut dyn FnMut(&Progress),
    stop: &AtomicBool,
) -> Result<Rendered> {
    Ok(resume(tracer, Rendered::nothing(size, 0)?, limits, &mut |rendered| progress(&rendered.progress), stop))
}

/// Goes on with a render until a limit is met or `stop` is set, calling `watch` after each batch.
///
/// A render that was ended and resumed gives the same picture as one that was not, to the last bit, if the limits and the tracer are the
/// same: which batches are left follows from what the film holds.
pub fn resume(
    tracer: &mut dyn Tracer,
    mut rendered: Rendered,
    limits: Limits,
    watch: &mut dyn FnMut(&Rendered),
    stop: &AtomicBool,
) -> Rendered {
    let mut budget = Budget::new(Pace::OfTracer);
    let before = rendered.progress.seconds;
    let start = Instant::now();
    // Also what `watch` does takes time.
    let elapsed = || before + start.elapsed().as_secs_f64();
    rendered.progress.limits = limits;
    rendered.end = End::Samples;
    if limits.noise.is_some() && rendered.shares.is_none() {
        // An earlier run may have had no such limit.
        rendered.noise_aim = rendered.noise_aim.max(at_a_look(rendered.film.most_samples()));
    }
    let mut run = Run::new(rendered, limits.spp.unwrap_or(u32::MAX));
    if let Some(limit) = limits.noise {
        if run.is_at_noise_aim() && run.is_quiet_enough(limit) {
            return Rendered { end: End::Noise, ..run.into_rendered() };
        }
        run.aim_at_noise();
    }
    let mut end = End::Samples;
    while !run.is_done() {
        if stop.load(Ordering::Relaxed) {
            end = End::Stopped;
            break;
        }
        if limits.seconds.is_some_and(|limit| elapsed() >= limit) {
            end = End::Time;
            break;
        }
        if let Err(error) = run.step(tracer, &mut budget) {
            end = End::Failed(error);
            break;
        }
        run.set_seconds(elapsed());
        let (mut quiet, mut unknown) = (false, false);
        if let Some(limit) = limits.noise.filter(|_| run.is_at_noise_aim()) {
            quiet = run.is_quiet_enough(limit);
            let rendered = run.rendered();
            unknown = rendered.progress.error.is_none() && rendered.film.least_samples() >= MOST_WITHOUT_ESTIMATE;
        } else if run.is_between_passes() && run.estimate_is_due() {
            run.estimate();
        }
        watch(run.rendered());
        if quiet {
            end = End::Noise;
            break;
        }
        if unknown {
            end = End::NoEstimate;
            break;
        }
    }
    run.set_seconds(elapsed());
    // Also of what a render did that ended in the middle of a pass.
    run.estimate();
    Rendered { end, ..run.into_rendered() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::film::{AovSum, Batch, PixelSum, Rays, Tile, group_length};
    use crate::sampling::{random4, uniform};
    use std::ops::Range;

    /// Radiance of random numbers that differ widely in size, so that any other order of addition shows.
    struct Fake {
        width: u32,
        max_sums: usize,
        batch_seconds: f64,
        /// Pretended seconds a sample.
        sample_seconds: f64,
        batches: Vec<Batch>,
        fail_at: Option<usize>,
    }

    impl Fake {
        fn new(width: u32, max_sums: usize, batch_seconds: f64) -> Self {
            Fake { width, max_sums, batch_seconds, sample_seconds: 1e-6, batches: Vec::new(), fail_at: None }
        }
    }

    impl Tracer for Fake {
        fn trace(&mut self, batch: &Batch) -> Result<Traced> {
            if self.fail_at == Some(self.batches.len()) {
                return Err(Error::NoDevice("the device is lost".into()));
            }
            self.batches.push(batch.clone());
            let tile = batch.tile;
            let mut sums = Vec::new();
            for group in 0..batch.groups() {
                for y in tile.y..tile.y + tile.height {
                    for x in tile.x..tile.x + tile.width {
                        let mut sum = PixelSum::default();
                        for sample in batch.group_samples(group) {
                            let [r, g, b, e] = random4(y * self.width + x, sample, 0, 1);
                            let scale = 10f64.powi((e % 16) as i32 - 8);
                            for (s, v) in sum.radiance.iter_mut().zip([r, g, b]) {
                                *s += uniform(v) * scale;
                            }
                            sum.rays += Rays { all: 2, shadow: 1 };
                        }
                        sums.push(sum);
                    }
                }
            }
            let samples = tile.pixels() as u32 * (batch.samples.end - batch.samples.start);
            Ok(Traced { sums, dropped: vec![], device_seconds: Some(f64::from(samples) * self.sample_seconds) })
        }

        fn aovs(&mut self, tile: Tile, samples: Range<u32>) -> Result<Vec<AovSum>> {
            let pixel = |i: usize| tile.x + i as u32 % tile.width + (tile.y + i as u32 / tile.width) * self.width;
            let sum = |i| AovSum { hits: pixel(i), depth: samples.len() as f32, ..AovSum::default() };
            Ok((0..tile.pixels()).map(sum).collect())
        }

        fn max_sums(&self) -> usize {
            self.max_sums
        }

        fn batch_seconds(&self) -> f64 {
            self.batch_seconds
        }
    }

    fn run(fake: &mut Fake, size: (u32, u32), spp: u32) -> Rendered {
        let limits = Limits { spp: Some(spp), ..Limits::default() };
        render(fake, size, limits, &mut |_| {}, &AtomicBool::new(false)).unwrap()
    }

    #[test]
    fn batch_sizes_never_show() {
        let size = (37, 23);
        let mut films = Vec::new();
        // From one pixel at a time to everything at once; 71 samples end in the middle of a group.
        for (max_sums, seconds) in
            [(4, 1.0), (5, 1e-5), (64, 1.0), (10_000_000, 1e-4), (10_000_000, 3e-3), (10_000_000, 1e9)]
        {
            let mut fake = Fake::new(size.0, max_sums, seconds);
            let rendered = run(&mut fake, size, 71);
            assert!(matches!(rendered.end, End::Samples));
            assert!(rendered.film.samples.iter().all(|s| *s == 71));
            assert_eq!(rendered.progress.rays, 37 * 23 * 71 * 2);
            assert_eq!(rendered.progress.shadow_rays, 37 * 23 * 71);
            films.push(rendered.film);
        }
        assert!(films.iter().all(|film| *film == films[0]));
    }

    #[test]
    fn steps_by_another_clock_give_the_same_film() {
        let size = (37, 23);
        // By the clock of its device it would be slow.
        let mut fake = Fake { sample_seconds: 1.0, ..Fake::new(size.0, 10_000_000, 1e9) };
        let mut budget = Budget::new(Pace::WithinSeconds(1e9));
        let mut stepped = Run::new(Rendered::nothing(size, 0).unwrap(), 71);
        while !stepped.is_done() {
            let before = budget.samples();
            stepped.step(&mut fake, &mut budget).unwrap();
            assert!(budget.samples() >= before);
        }
        let batches = fake.batches.len();
        stepped.step(&mut fake, &mut budget).unwrap();
        assert_eq!(fake.batches.len(), batches, "nothing is left to do");
        let rendered = run(&mut Fake::new(size.0, 100, 1e-3), size, 71);
        assert!(stepped.rendered().film == rendered.film);
        assert_eq!(stepped.rendered().progress.spp(), 71.0);
        assert!(!stepped.estimate_is_due(), "less than a second was traced");
        stepped.estimate();
        assert_eq!(stepped.into_rendered().progress.error, rendered.progress.error);
    }

    #[test]
    fn aovs_come_in_the_order_of_the_pixels() {
        for (size, max_sums) in [((37, 23), 1 << 20), ((37, 23), 100), ((37, 23), 10), ((3, 2), 4), ((1, 5), 4)] {
            let mut fake = Fake::new(size.0, max_sums, 1.0);
            let stop = AtomicBool::new(false);
            let found = aovs(&mut fake, size, 1000, &stop).unwrap().unwrap();
            assert_eq!(found.samples, 64);
            let pixels: Vec<u32> = found.sums.iter().map(|sum| sum.hits).collect();
            assert_eq!(pixels, (0..size.0 * size.1).collect::<Vec<u32>>());
            stop.store(true, Ordering::SeqCst);
            assert!(aovs(&mut fake, size, 1000, &stop).unwrap().is_none());
        }
    }

    #[test]
    fn every_pixel_once_per_group_within_the_limits() {
        for (size, max_sums, seconds) in
            [((37, 23), 100, 1e-3), ((5000, 3), 1 << 20, 1e-3), ((1, 1), 4, 1.0), ((8, 600), 1 << 20, 1e-2)]
        {
            let mut fake = Fake::new(size.0, max_sums, seconds);
            run(&mut fake, size, 100);
            let mut next = vec![0u32; size.0 as usize * size.1 as usize];
            for batch in &fake.batches {
                assert!(batch.tile.pixels() * batch.groups() as usize <= max_sums);
                assert_eq!(batch.group, group_length(batch.samples.start));
                for y in batch.tile.y..batch.tile.y + batch.tile.height {
                    for x in batch.tile.x..batch.tile.x + batch.tile.width {
                        let next = &mut next[(y * size.0 + x) as usize];
                        assert_eq!(*next, batch.samples.start);
                        *next = batch.samples.end;
                    }
                }
            }
            assert!(next.iter().all(|n| *n == 100));
        }
    }

    #[test]
    fn batches_grow_slowly_and_shrink_at_once() {
        let mut fake = Fake::new(512, 1 << 30, 0.1);
        run(&mut fake, (512, 512), 64);
        let samples: Vec<usize> = fake.batches.iter().map(|b| b.tile.pixels() * b.samples.len()).collect();
        assert_eq!(samples[..2], [64, 256]);
        let mut largest = samples[0];
        for next in &samples[1..] {
            assert!(*next <= 4 * largest, "{samples:?}");
            largest = largest.max(*next);
        }
        assert!(largest > 90_000, "{samples:?}");
        assert!(samples.iter().all(|s| *s <= 100_000), "{samples:?}");
    }

    #[test]
    fn time_ends_at_a_batch() {
        let mut fake = Fake::new(64, 1 << 20, 0.001);
        let limits = Limits { seconds: Some(0.05), ..Limits::default() };
        let mut calls = 0;
        let rendered = render(&mut fake, (64, 64), limits, &mut |_| calls += 1, &AtomicBool::new(false)).unwrap();
        assert!(matches!(rendered.end, End::Time));
        assert!(rendered.progress.seconds >= 0.05 && rendered.progress.seconds < 5.0);
        assert_eq!(calls, fake.batches.len());
        assert_eq!(rendered.progress.samples, rendered.film.samples.iter().map(|s| u64::from(*s)).sum::<u64>());
    }

    #[test]
    fn stop_keeps_what_was_done() {
        let mut fake = Fake::new(64, 4096, 1e-3);
        let stop = AtomicBool::new(false);
        let limits = Limits { spp: Some(1000), ..Limits::default() };
        let mut until_three = |p: &Progress| stop.store(p.samples >= 3 * 4096 * 4, Ordering::Relaxed);
        let rendered = render(&mut fake, (64, 64), limits, &mut until_three, &stop).unwrap();
        assert!(matches!(rendered.end, End::Stopped));
        assert!(rendered.progress.samples >= 3 * 4096 * 4 && rendered.progress.samples < 1000 * 4096);
        assert!(rendered.film.least_samples() >= 4);
    }

    #[test]
    fn a_step_that_failed_is_made_up_for() {
        let whole = run(&mut Fake::new(37, 500, 1.0), (37, 23), 9).film;
        let mut fake = Fake { fail_at: Some(3), ..Fake::new(37, 500, 1.0) };
        let (mut run, mut budget) = (Run::new(Rendered::nothing((37, 23), 0).unwrap(), 9), Budget::new(Pace::OfTracer));
        let mut failures = 0;
        while !run.is_done() {
            if run.step(&mut fake, &mut budget).is_err() {
                failures += 1;
                fake.fail_at = None;
            }
        }
        assert_eq!((failures, run.into_rendered().film == whole), (1, true));
    }

    #[test]
    fn a_failure_keeps_what_was_done() {
        let mut fake = Fake { fail_at: Some(1), ..Fake::new(64, 2048, 1.0) };
        let rendered = run(&mut fake, (64, 64), 4);
        assert!(matches!(rendered.end, End::Failed(Error::NoDevice(_))));
        assert_eq!((rendered.film.least_samples(), rendered.film.most_samples()), (0, 4));
    }

    #[test]
    fn the_noise_ends_a_render_after_the_same_samples_at_any_speed() {
        let mut films = Vec::new();
        for seconds in [1e-4, 3e-3, 1e9] {
            let limits = Limits { noise: Some(0.5), spp: Some(100_000), ..Limits::default() };
            let mut fake = Fake::new(37, 10_000_000, seconds);
            let rendered = render(&mut fake, (37, 23), limits, &mut |_| {}, &AtomicBool::new(false)).unwrap();
            assert!(matches!(rendered.end, End::Noise), "{:?}", rendered.end);
            assert!(rendered.progress.error.unwrap().relative() <= 0.5);
            assert!(rendered.film.most_samples() > LEAST_FOR_NOISE);
            films.push(rendered.film);
        }
        assert!(films.iter().all(|film| *film == films[0]));
    }

    /// No light, and a limit of the noise: there is nothing to estimate, and the render ends all the same.
    #[test]
    fn a_picture_without_light_ends_without_an_estimate() {
        struct Dark;
        impl Tracer for Dark {
            fn trace(&mut self, batch: &Batch) -> Result<Traced> {
                let sums = vec![PixelSum::default(); batch.tile.pixels() * batch.groups() as usize];
                Ok(Traced { sums, dropped: vec![], device_seconds: None })
            }
            fn aovs(&mut self, _: Tile, _: Range<u32>) -> Result<Vec<AovSum>> {
                Ok(vec![])
            }
            fn max_sums(&self) -> usize {
                1 << 20
            }
            fn batch_seconds(&self) -> f64 {
                1e9
            }
        }
        let limits = Limits { noise: Some(0.5), ..Limits::default() };
        let rendered = render(&mut Dark, (16, 16), limits, &mut |_| {}, &AtomicBool::new(false)).unwrap();
        assert!(matches!(rendered.end, End::NoEstimate), "{:?}", rendered.end);
        assert_eq!((rendered.progress.error, rendered.film.most_samples()), (None, MOST_WITHOUT_ESTIMATE));
        assert_eq!(rendered.film.black_share(), Some(1.0));
    }
}
