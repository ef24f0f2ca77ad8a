//! Bodies that absorb: light in and through them is found alike by all estimators, and is what a formula says.

use crate::common::bodies::*;
use crate::common::statistics::*;
use crate::transport::means;
use glam::DVec3;
use luminaire::scene::{Estimator, Integrator, LightSampling};

/// In a glowing ball, opaque or with holes, a plate gets of its glow and of the sky what the way to the middle lets through, however light is looked for.
#[test]
fn in_a_glowing_body_all_estimators_have_the_mean_of_a_formula() {
    for (opacity, outside) in [(1.0, false), (1.0, true), (0.5, false), (0.5, true)] {
        let (mut scene, [low, high]) = plate_in_a_glowing_ball(opacity, outside);
        for (seed, estimator) in estimators().into_iter().enumerate() {
            scene.integrator = Integrator::Path(estimator);
            scene.settings.seed = seed as u32;
            for (channel, found) in means(&scene, 1250).into_iter().enumerate() {
                println!(
                    "opacity {opacity}, from outside {outside}: {found:?} in {} to {}",
                    low[channel], high[channel]
                );
                found.assert_within(low[channel], high[channel], 2e-2);
            }
        }
    }
}

/// The same of a rough one, from outside, where there is no formula.
#[test]
fn through_a_rough_glowing_body_all_estimators_have_one_mean() {
    for opacity in [1.0, 0.6] {
        let mean = |estimator: Estimator, seed: u32| {
            let mut scene = plate_in_a_rough_ball(6, 6, opacity);
            scene.integrator = Integrator::Path(estimator);
            scene.settings.seed = seed;
            means(&scene, 1000)[2]
        };
        let expected = mean(Estimator { light_sampling: LightSampling::None, ..Estimator::default() }, 100);
        for (seed, estimator) in estimators().into_iter().enumerate() {
            let found = mean(estimator, seed as u32);
            let p = same_mean(found, expected);
            println!("opacity {opacity}: {found:?} for {expected:?}, p = {p:.1e}");
            assert!(found.error < 0.02 * found.mean, "{estimator:?}: {found:?} is not sharp enough");
            assert!(p >= SIGNIFICANCE, "{estimator:?}: {found:?} instead of {expected:?}, p = {p:.1e}");
        }
    }
}

/// Beer's law by the length inside, wherever the camera stands, and whether the boundary is there or has a hole.
#[test]
fn holes_are_crossings_of_the_boundary() {
    for opacity in [1.0, 0.5] {
        for (distance, length) in [(3.0, 2.0), (21.0, 2.0), (101.0, 2.0), (0.0, 1.0)] {
            let scene = cube_from(distance, 0.0, opacity);
            let found = DVec3::from_array(means(&scene, 64).map(|estimate| estimate.mean));
            let expected = COLOR.powf(length);
            assert!((found - expected).length() < 1e-4, "opacity {opacity}, from {distance}: {found} for {expected}");
        }
    }
}

/// Light that is found through the holes of a body alone is absorbed by what lies between them.
#[test]
fn light_through_holes_is_absorbed_between_them() {
    for parallel in [true, false] {
        let (scene, expected) = under_a_pierced_cube(parallel);
        for (channel, found) in means(&scene, 4000).into_iter().enumerate() {
            found.assert_is(expected[channel], 1e-2);
        }
    }
}
