//! What is said of a picture's estimated error when it is finished, and of light that it has not found.

use luminaire::film::{ErrorEstimate, Film, relative_in_words};
use luminaire::picture::{Development, to_srgb8};

/// From this share of black pixels on a picture probably lacks what it was meant to show.
const MOSTLY_BLACK: f64 = 0.95;

/// From fewer samples a pixel it cannot be told how fast the error falls.
const LEAST_SAMPLES: u32 = 4;

/// The estimated error, or why there is none; what it does not cover is named. `lacks_light` is that the warnings tell of light which no
/// estimator finds.
pub fn error_line(film: &Film, error: Option<ErrorEstimate>, lacks_light: bool) -> String {
    let Some(error) = error else { return format!("{}\n", no_estimate(film)) };
    let ErrorEstimate { rmse, fireflies, unknown, .. } = error;
    let mut text = match error.relative() {
        0.0 => format!("no noise was found in {}: all blocks of them agree", samples(film)),
        relative => format!("estimated error {} (RMSE {rmse:.3e})", relative_in_words(relative)),
    };
    if fireflies > 0 {
        let with = relative_in_words(error.relative_with_fireflies());
        text += &match fireflies {
            1 => format!(", without 1 pixel that is a firefly or a very small lamp (with it {with})"),
            n => format!(", without {n} pixels that are fireflies or very small lamps (with them {with})"),
        };
    }
    if unknown > 0 {
        text += &format!(", without {unknown} pixels that have too few samples for an estimate");
    }
    if film.least_samples() < LEAST_SAMPLES {
        text += &format!("; uncertain, from {} samples a pixel", film.least_samples());
    }
    if let Some(share) = film.black_share().filter(|share| *share >= MOSTLY_BLACK && film.least_samples() > 0) {
        text += &format!("; {} of the pixels are black", share_in_words(share));
    }
    if lacks_light {
        text += "; of the light that was found alone: the warnings say what the picture lacks";
    }
    text + "\n"
}

/// Why there is no estimate.
fn no_estimate(film: &Film) -> String {
    let missing = film.samples.iter().filter(|samples| **samples == 0).count();
    let why = match film.black_share() {
        Some(_) if missing > 0 => format!("{missing} of {} pixels have no sample", film.samples.len()),
        None => "no sample is finite".into(),
        Some(1.0) => format!("the picture is black, {} found no light", samples(film)),
        _ if film.most_samples() < 2 => "one sample a pixel tells nothing of it".into(),
        _ => format!("only single samples of {} a pixel found any light", film.most_samples()),
    };
    format!("the error cannot be estimated: {why}")
}

/// How many samples a pixel has at most, in words.
fn samples(film: &Film) -> String {
    match film.most_samples() {
        1 => "1 sample a pixel".into(),
        n => format!("{n} samples a pixel"),
    }
}

/// A share of nearly all, rounded down so that it is not said to be all.
fn share_in_words(share: f64) -> String {
    format!("{} %", (1000.0 * share).floor() / 10.0)
}

/// A warning of a picture that is black, or nearly so; none if it is not. `dark` is that an earlier warning says why.
pub fn black_picture(film: &Film, dark: bool) -> Option<String> {
    // What the first pass has not come to may hold the light.
    let share = film.black_share().filter(|share| *share >= MOSTLY_BLACK && film.least_samples() > 0)?;
    let advice = if dark {
        "an earlier warning says why"
    } else {
        "is the camera where it was meant to be ([sensor]), outside of closed bodies, and does a luminaire or the environment light what it sees? \
         `luminaire inspect` lists all three"
    };
    Some(match share {
        1.0 => format!("the picture is black: none of {} found any light; {advice}", samples(film)),
        _ => format!(
            "{} of the pixels are black, where no sample found any light; if that is not meant: {advice}",
            share_in_words(share)
        ),
    })
}

/// A warning of a PNG that shows nothing when it is developed in this way, though there is light; none if it shows something.
pub fn black_when_developed(film: &Film, development: Development) -> Option<String> {
    let largest = film.largest();
    if largest == 0.0 || to_srgb8(&film.to_linear(), development).into_iter().any(|code| code > 0) {
        return None;
    }
    let exposure = development.exposure;
    // Its half-power mean becomes a middle grey.
    let better = (0.2 / film.brightness().half_power_mean()).log2().floor().min(64.0);
    Some(format!(
        "a PNG shows nothing of this picture at an exposure of {exposure} stops: its largest radiance is {largest:.1e}; try --exposure {better}, \
         --exposure auto, or an EXR file"
    ))
}

/// A warning of a limit of the noise that was reached without the fireflies alone; none if they do not hold most of the error.
pub fn noise_with_fireflies(limit: f64, error: ErrorEstimate) -> Option<String> {
    (error.is_mostly_fireflies() && error.relative_with_fireflies() > limit).then(|| {
        format!(
            "--noise {limit} is reached without the fireflies ({}), which hold most of the error: with them it is {}; more samples, or --error-map to see \
             where",
            relative_in_words(error.relative()),
            relative_in_words(error.relative_with_fireflies())
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A film of 40 pixels with so many samples; `lit` of its pixels have this radiance.
    fn film(samples: u32, lit: usize, radiance: f64) -> Film {
        let mut film = Film::new(8, 5).unwrap();
        film.samples.fill(samples);
        let blocks = film.block_samples(0).map(f64::from);
        for sums in film.sums.iter_mut().take(lit) {
            *sums = blocks.map(|samples| [samples * radiance; 3]);
        }
        film
    }

    #[test]
    fn black_is_no_small_error() {
        let says = |film: &Film| error_line(film, film.error(), false);
        let dark = says(&film(16, 0, 1.0));
        assert_eq!(dark, "the error cannot be estimated: the picture is black, 16 samples a pixel found no light\n");
        assert!(says(&film(1, 40, 1.0)).contains("one sample a pixel tells nothing"));
        assert!(says(&film(0, 40, 1.0)).contains("no sample is finite"));
        let flat = says(&film(16, 40, 1.0));
        assert_eq!(flat, "no noise was found in 16 samples a pixel: all blocks of them agree\n");
        let lamp = film(16, 1, 1.0);
        assert!(says(&lamp).contains("no noise was found") && says(&lamp).contains("97.5 % of the pixels are black"));
        assert!(error_line(&lamp, lamp.error(), true).contains("the warnings say what the picture lacks"));

        assert!(black_picture(&film(16, 0, 1.0), false).unwrap().contains("none of 16 samples a pixel"));
        assert!(black_picture(&film(16, 0, 1.0), true).unwrap().contains("an earlier warning"));
        assert!(black_picture(&lamp, false).unwrap().contains("97.5 % of the pixels"));
        assert_eq!(black_picture(&film(16, 3, 1.0), false), None);

        let mut begun = film(4, 0, 1.0);
        begun.samples[3..].fill(0);
        assert!(says(&begun).contains("37 of 40 pixels have no sample"), "{}", says(&begun));
        assert_eq!(black_picture(&begun, false), None);
    }

    #[test]
    fn few_samples_are_uncertain() {
        let error = ErrorEstimate {
            rmse: 0.1,
            rel_mse: 0.01,
            careful_rel_mse: 0.01,
            fireflies: 2,
            unknown: 3,
            rel_mse_with_fireflies: 0.25,
        };
        let says = |samples| error_line(&film(samples, 40, 1.0), Some(error), false);
        assert_eq!(
            says(64),
            "estimated error 10 % (RMSE 1.000e-1), without 2 pixels that are fireflies or very small lamps (with them 50 %), without 3 pixels that have \
             too few samples for an estimate\n"
        );
        assert!(says(3).contains("; uncertain, from 3 samples a pixel"), "{}", says(3));
        assert!(noise_with_fireflies(0.1, error).unwrap().contains("with them it is 50 %"));
        assert_eq!(noise_with_fireflies(0.1, ErrorEstimate { rel_mse_with_fireflies: 0.015, ..error }), None);
    }

    #[test]
    fn what_a_png_would_not_show_is_found_by_its_exposure() {
        let dim = film(16, 40, 1e-6);
        let said = black_when_developed(&dim, 0.0.into()).unwrap();
        assert!(said.contains("1.0e-6") && said.contains("--exposure 17"), "{said}");
        assert_eq!(black_when_developed(&dim, 17.0.into()), None);
        assert_eq!(black_when_developed(&film(16, 0, 1.0), 0.0.into()), None, "black at any exposure");
    }
}
