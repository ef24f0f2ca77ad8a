//! Lamps that lie on each other: the floor under them has the radiance that one lamp gives it, whatever the light sampling.

use crate::common::lamps::{expected, files, scene};
use crate::common::scenes::estimator;
use crate::common::statistics::*;
use luminaire::reference::Reference;
use luminaire::scene::LightSampling;

#[test]
fn one_lamp_is_counted_once() {
    assert!((expected() - 0.2395).abs() < 1e-4);
    for (name, mesh, more) in files() {
        let mut scene = scene(&mesh, more);
        for (light_sampling, samples, bound) in
            [(LightSampling::None, 1024, 0.08), (LightSampling::Direct, 256, 0.02), (LightSampling::Mis, 256, 0.02)]
        {
            estimator(&mut scene).light_sampling = light_sampling;
            let found = total(&render(&mut Reference::new(&scene), 4, 4, samples, 16));
            let off = found.mean / expected() - 1.0;
            assert!(
                off.abs() < bound && (found.mean - expected()).abs() < 5.0 * found.error + 1e-3,
                "{name}, {light_sampling:?}: {} +- {} instead of {}",
                found.mean,
                found.error,
                expected()
            );
        }
    }
}
