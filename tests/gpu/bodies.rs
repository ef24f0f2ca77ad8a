//! Bodies that absorb, as the kernel has them: what formulas say, by every estimator, on every backend.

use super::pictures::{mean, pixels};
use super::*;
use crate::common::bodies::*;
use crate::common::statistics::*;
use glam::DVec3;
use luminaire::scene::{Estimator, Integrator, LightSampling};

/// In a glowing ball, opaque or with holes, a plate gets of its glow and of the sky what the way to the middle lets through, however light is looked for.
#[test]
fn in_a_glowing_body_all_estimators_have_the_mean_of_a_formula() {
    for (opacity, outside) in [(1.0, false), (0.5, true)] {
        let (mut scene, [low, high]) = plate_in_a_glowing_ball(opacity, outside);
        // Those that differ most: a kernel takes a second to make.
        for (seed, estimator) in estimators().into_iter().take(3).enumerate() {
            scene.integrator = Integrator::Path(estimator);
            scene.settings.seed = seed as u32;
            on_every_backend(|backend| {
                let found = total(&render(&mut backend.tracer(&scene), 4, 4, 1024, 16));
                let brightness = |c: DVec3| c.element_sum() / 3.0;
                println!("{}, opacity {opacity}, from outside {outside}: {found:?} in {low} to {high}", backend.name());
                found.assert_within(brightness(low), brightness(high), 2e-2);
            });
        }
    }
}

/// The same of a rough one, from outside, where there is no formula.
#[test]
fn through_a_rough_glowing_body_all_estimators_have_one_mean() {
    if on_the_old_driver() {
        return;
    }
    let opacity = 0.6;
    on_every_backend(|backend| {
        let measure = |estimator: Estimator, seed: u32| {
            let mut scene = plate_in_a_rough_ball(6, 6, opacity);
            scene.integrator = Integrator::Path(estimator);
            scene.settings.seed = seed;
            total(&render(&mut backend.tracer(&scene), 6, 6, 1024, 16))
        };
        let none = Estimator { light_sampling: LightSampling::None, ..Estimator::default() };
        let expected = measure(none, 100);
        for (seed, estimator) in estimators().into_iter().take(2).enumerate() {
            let found = measure(estimator, seed as u32);
            let z = (found.mean - expected.mean) / found.error.hypot(expected.error);
            println!("{}, opacity {opacity}: {found:?} for {expected:?}, z = {z:.2}", backend.name());
            assert!(found.error < 0.02 * found.mean, "{estimator:?}: {found:?} is not sharp enough");
            assert!(two_sided(z) >= SIGNIFICANCE, "{estimator:?}: {found:?} instead of {expected:?}");
        }
    });
}

/// Beer's law by the length inside, wherever the camera stands, and whether the boundary is there or has a hole.
#[test]
fn holes_are_crossings_of_the_boundary() {
    for (opacity, roughness) in [(1.0, 0.5), (0.5, 0.0)] {
        for (distance, length) in [(3.0, 2.0), (21.0, 2.0), (101.0, 2.0), (0.0, 1.0)] {
            let scene = cube_from(distance, roughness, opacity);
            let expected = COLOR.powf(length);
            on_every_backend(|backend| {
                let found = mean(&pixels(&mut backend.tracer(&scene), &scene, 64));
                assert!(
                    (found - expected).length() < 1e-4,
                    "{}, opacity {opacity}, from {distance}: {found} for {expected}",
                    backend.name()
                );
            });
        }
    }
}

/// Light that is found through the holes of a body alone is absorbed by what lies between them.
#[test]
fn light_through_holes_is_absorbed_between_them() {
    for parallel in [true, false] {
        let (scene, expected) = under_a_pierced_cube(parallel);
        on_every_backend(|backend| {
            let found = total(&render(&mut backend.tracer(&scene), 4, 4, 4096, 16));
            println!("{}, parallel {parallel}: {found:?} for {expected}", backend.name());
            found.assert_is(expected.element_sum() / 3.0, 1e-2);
        });
    }
}
