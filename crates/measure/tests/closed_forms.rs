//! Closed forms and published cases on every backend: the cases of `docs/accuracy.md`, all of them, with fewer samples.
//!
//! Without a Vulkan device only the reference is measured, and that is said; with `LUMINAIRE_REQUIRE_GPU=1` it fails.

#[path = "../../../tests/common/mod.rs"]
mod common;

use luminaire::gpu::validation_messages;
use luminaire_measure::closed_forms::{Table, cases};

/// Two-sided, for all cases and backends together: a right program would fail once in ten thousand choices of the seed.
const SIGNIFICANCE: f64 = 1e-4;
/// The most that a standard error may be of what is expected, so that no case passes for lack of samples.
const BLUNTEST: f64 = 0.03;
/// Samples for each of 256 pixels, and per effort.
const SAMPLES: u32 = 64;

#[test]
fn every_backend_agrees_with_every_closed_form() {
    let bench = common::bench();
    let table = Table::measure(&bench, cases(), SAMPLES, |_| ()).expect("the backends work");
    let verdict = table.verdict();
    println!("{}\n{}\n{verdict:#?}", table.by_chance().markdown(), table.without_chance().markdown());
    let beyond = table.beyond_rounding();
    assert!(beyond.is_empty(), "{beyond:#?}");
    let (error, case) = (verdict.bluntest_error, &verdict.bluntest);
    assert!(error <= BLUNTEST, "{case}: the standard error is {error:.3} of what is expected");
    assert!(verdict.largest >= SIGNIFICANCE, "{}: z = {:.1}, p = {:.1e}", verdict.furthest, verdict.z, verdict.largest);
    assert!(verdict.squares >= SIGNIFICANCE, "the deviations are too large together: p = {:.1e}", verdict.squares);
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}
