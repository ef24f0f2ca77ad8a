//! White furnaces over a grid of roughness, metal and transmission: the table of `docs/accuracy.md`, with fewer samples.

#[path = "../../../tests/common/mod.rs"]
mod common;

use luminaire_measure::furnaces::{KINDS, ROUGHNESSES, measure, white_metal};

/// White metals, plastics, glass and mixtures are white on every backend: metals and plastics within 0.5 %, what transmits within 1 %.
#[test]
fn white_balls_are_white_over_a_grid() {
    let balls = measure(&common::bench(), 256).expect("the backends work");
    assert_eq!(balls.len(), KINDS.len() * ROUGHNESSES.len());
    for ball in &balls {
        let most = if ball.transmission > 0.0 { 1e-2 } else { 5e-3 };
        for found in &ball.found {
            let off = (found.mean - 1.0).abs();
            assert!(found.error < 4e-2, "{ball:?} is not sharp enough");
            assert!(off < most + 4.0 * found.error, "{ball:?}");
        }
    }
}

/// A white metal of roughness 0.05 to 1 sends back all light within 0.5 % at every angle.
#[test]
fn white_metals_are_white_at_every_angle() {
    for worst in white_metal(&common::bench(), 8000).expect("the backends work") {
        println!("{worst:?}");
        assert!((worst.found - 1.0).abs() <= 5e-3, "{worst:?}");
    }
}
