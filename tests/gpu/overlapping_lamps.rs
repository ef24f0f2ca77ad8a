//! Lamps that lie on each other, on every backend: the radiance that one lamp gives.

use super::*;
use crate::common::lamps::{expected, files, in_a_large_ceiling, scene};
use crate::common::scenes::estimator;
use crate::common::statistics::*;
use luminaire::scene::LightSampling;

#[test]
fn one_lamp_is_counted_once() {
    let cases = [
        ("double-sided", LightSampling::Mis),
        ("shifted halves", LightSampling::Direct),
        ("one-sided, another lamp at its back", LightSampling::Mis),
        ("another light around it", LightSampling::Mis),
        ("another light around it, of two halves", LightSampling::Direct),
        ("in the plane of a ceiling", LightSampling::Mis),
        ("in the plane of a ceiling", LightSampling::None),
    ];
    for (name, light_sampling) in cases {
        let (_, mesh, more) = files().into_iter().find(|(file, ..)| *file == name).expect("one of the files");
        let mut scene = scene(&mesh, more);
        estimator(&mut scene).light_sampling = light_sampling;
        on_every_backend(|backend| {
            let found = total(&render(&mut backend.tracer(&scene), 4, 4, 4096, 16));
            assert!(
                (found.mean / expected() - 1.0).abs() < 0.04
                    && (found.mean - expected()).abs() < 5.0 * found.error + 1e-3,
                "{name}, {light_sampling:?}, {}: {} +- {} instead of {}",
                backend.name(),
                found.mean,
                found.error,
                expected()
            );
        });
    }
}

/// The larger the ceiling, the further rays round by, and the further the lamp has to be off its plane; out of one that is too large it is cut.
#[test]
fn a_lamp_shows_in_a_large_ceiling() {
    for half in [3.0, 100.0, 800.0, 2000.0] {
        let scene = in_a_large_ceiling(half);
        on_every_backend(|backend| {
            let found = total(&render(&mut backend.tracer(&scene), 16, 16, 16, 16));
            assert!((found.mean - 1.0).abs() < 1e-6, "{half}, {}: {} instead of 1", backend.name(), found.mean);
        });
    }
}
