//! Glass that touches other surfaces exactly: it is white in white light, and looks as with a small gap, in the reference and on every backend.

use super::glass::{on_every_tracer, trace};
use crate::common::statistics::*;
use crate::common::touching::{furnaces, scenes};
use luminaire::reference::Reference;

/// Nothing is lost and nothing gained: every pixel is 1.
#[test]
fn touching_glass_is_white_in_white_light() {
    for (name, mut scene) in furnaces() {
        let said = scene.part_touching_glass();
        println!("{name}: {said:?}");
        assert_eq!(said.len(), 1, "{name}: {said:?}");
        on_every_tracer(&scene, |backend, tracer| {
            let traced = trace(tracer, &scene, 8);
            assert_eq!(traced.dropped, [], "{name}, {backend}");
            let off = traced.sums.iter().flat_map(|sum| sum.radiance).map(|r| (r - 1.0).abs()).fold(0.0, f64::max);
            println!("{name}, {backend}: {off:.2e}");
            assert!(off < 1e-3, "{name}, {backend}: off by {off}");
        });
    }
}

/// The mean over the picture is that of a gap of a thousandth, with the same random numbers.
#[test]
fn touching_glass_looks_as_with_a_small_gap() {
    let gaps = scenes(0.5, 1e-3);
    for ((name, mut scene), (_, mut apart)) in scenes(0.5, 0.0).into_iter().zip(gaps) {
        scene.part_touching_glass();
        assert_eq!(apart.part_touching_glass(), Vec::<String>::new(), "{name}");
        let expected = total(&render(&mut Reference::new(&apart), 16, 16, 32, 4)).mean;
        on_every_tracer(&scene, |backend, tracer| {
            let found = total(&render(tracer, 16, 16, 32, 4)).mean;
            println!("{name}, {backend}: {found}, with a gap {expected}: {:.1e}", found - expected);
            assert!((found - expected).abs() < 1.5e-3, "{name}, {backend}: {found}, with a gap {expected}");
        });
    }
}
