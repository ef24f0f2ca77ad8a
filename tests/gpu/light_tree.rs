//! The light tree on the device: the choices and the probabilities of the reference.

use super::functions::floats;
use super::*;
use crate::common::many_lamps::*;
use crate::common::statistics::*;
use luminaire::gpu::layout::NONE;
use luminaire::gpu::probe::{Call, Function, Probe};
use luminaire::reference::Reference;
use luminaire::sampling::random4;
use luminaire::scene::{LuminaireTable, SampledLuminaire};

#[test]
fn the_tree_is_the_reference_s() {
    for (name, unit) in [("assorted", 1.0f32), ("tiny", 1e-16), ("huge", 1e13)] {
        let scene = assorted(unit);
        let tracer = Reference::new(&scene);
        let tree = tracer.light_tree().expect("several lamps");
        let entries = LuminaireTable::new(&scene).entries;
        let size = 3.0 * f64::from(unit);
        let surfaces: Vec<_> = (0..40).map(|number| some_surface(number, size)).collect();
        let bits = |v: glam::DVec3| v.as_vec3().to_array().map(f32::to_bits);
        on_every_backend(|backend| {
            let probe = Probe::new(&backend.device, &scene, backend.ray_query).expect("a probe");
            let per_surface = 5000;
            let mut calls: Vec<Call> = vec![];
            for (number, surface) in (0..).zip(&surfaces) {
                let ([x, y, z], [a, b, c]) = (bits(surface.position), bits(surface.shading_normal));
                calls.extend((0..per_surface).map(|i| {
                    let [.., random, more] = random4(i, number, 3, 17);
                    [[x, y, z, random], [a, b, c, more]]
                }));
            }
            let results = probe.call(Function::ChooseByTree, &calls).expect("the probe runs");
            let (mut others, mut farthest) = (0, 0.0f64);
            let mut counts = vec![vec![0u32; entries.len() + 1]; surfaces.len()];
            for (at, (call, result)) in calls.iter().zip(&results).enumerate() {
                let number = at / per_surface as usize;
                let expected = tracer.choose_luminaire(&surfaces[number], [0, 0, call[0][3], call[1][3]]);
                let [index, probability, ..] = result[0];
                counts[number][if index == NONE { entries.len() } else { index as usize }] += 1;
                match expected {
                    Some((chosen, expected, _)) if chosen == index as usize => {
                        farthest = farthest.max((f64::from(f32::from_bits(probability)) / expected - 1.0).abs());
                    }
                    None if index == NONE => {}
                    _ => others += 1,
                }
            }
            println!("{name}, {}: {others} other choices, off by {farthest:.1e}", backend.name());
            assert!(others <= calls.len() / 2000, "{name}, {}: {others} other choices", backend.name());
            assert!(farthest < 1e-3, "{name}, {}: off by {farthest:e}", backend.name());

            // Where a ray meets a lamp.
            let lamps: Vec<_> =
                entries.iter().filter_map(|e| if let SampledLuminaire::Area(t) = e { Some(t) } else { None }).collect();
            let mut calls: Vec<Call> = vec![];
            for surface in &surfaces {
                let ([x, y, z], [a, b, c]) = (bits(surface.position), bits(surface.shading_normal));
                // Every emissive triangle has an area here.
                calls.extend((0..lamps.len() as u32).map(|place| [[x, y, z, place], [a, b, c, 0]]));
            }
            let results = probe.call(Function::TreeProbability, &calls).expect("the probe runs");
            let mut tests = vec![];
            for (number, results) in results.chunks(lamps.len()).enumerate() {
                let mut expected: Vec<f64> = vec![];
                for (lamp, result) in lamps.iter().zip(results) {
                    let found = floats(result[0])[0];
                    let right = tracer.tree_probability(tree, &surfaces[number], lamp.object, lamp.triangle);
                    // By a number or two of 2^24 where it is next to nothing.
                    assert!((found - right).abs() <= 1e-3 * right + 3e-7, "{name}: {found} for {right}");
                    expected.push(found * f64::from(per_surface));
                }
                // The areas come after the points and what is infinitely far away.
                let first = entries.iter().position(|e| matches!(e, SampledLuminaire::Area(_))).expect("lamps");
                let mut drawn = counts[number][first..first + lamps.len()].to_vec();
                drawn.push(per_surface - drawn.iter().sum::<u32>());
                expected.push((f64::from(per_surface) - expected.iter().sum::<f64>()).max(0.0));
                if expected.iter().filter(|expected| **expected >= 10.0).count() >= 2 {
                    tests.push((format!("{name}, {number}"), chi_square_against(&drawn, &expected)));
                }
            }
            assert!(tests.len() > 30, "{}", tests.len());
            assert_plausible(&tests);
        });
    }
    assert_eq!(validation_messages(), 0);
}
