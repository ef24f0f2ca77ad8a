//! The figures in the window's title: samples, speed, error, tracer.

use super::shown::Shown;
use luminaire::render::Progress;

/// The figures of a film of `size`, which is named where the window has another one, and the tracer.
pub fn figures(progress: &Progress, shown: Shown, size: (u32, u32), window: (u32, u32), tracer: &str) -> String {
    let coarse = if size == window { String::new() } else { format!(" of {} x {}", size.0, size.1) };
    let error = match (progress.error, shown) {
        (Some(error), Shown::Picture | Shown::Error) => format!("error {}, ", error.in_words()),
        (None, Shown::Error) => "error not known, ".into(),
        _ => String::new(),
    };
    let (samples, mrays) = (progress.spp(), progress.mrays_per_second());
    format!("{samples:.1} samples a pixel{coarse}, {mrays:.2} Mrays/s, {error}{tracer}")
}

#[cfg(test)]
mod tests {
    use super::super::first_hit::FirstHit;
    use super::*;
    use luminaire::film::ErrorEstimate;

    #[test]
    fn the_line_says_what_is_seen() {
        let error = Some(ErrorEstimate {
            rmse: 0.5,
            rel_mse: 0.0004,
            careful_rel_mse: 0.0005,
            fireflies: 0,
            unknown: 0,
            rel_mse_with_fireflies: 0.01,
        });
        let progress =
            Progress { samples: 250, pixels: 100, rays: 3_000_000, seconds: 2.0, error, ..Progress::default() };
        let line = |shown, size| figures(&progress, shown, size, (20, 10), "cpu");
        let picture = "2.5 samples a pixel, 1.50 Mrays/s, error 2.0 % (10 % with fireflies), cpu";
        assert_eq!(line(Shown::Picture, (20, 10)), picture);
        let black = figures(&Progress { error: None, ..progress }, Shown::Error, (20, 10), (20, 10), "cpu");
        assert_eq!(black, "2.5 samples a pixel, 1.50 Mrays/s, error not known, cpu");
        let depth = Shown::First(FirstHit::Depth);
        assert_eq!(line(depth, (5, 3)), "2.5 samples a pixel of 5 x 3, 1.50 Mrays/s, cpu");
    }
}
