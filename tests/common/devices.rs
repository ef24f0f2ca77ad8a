//! The backends of this machine, and what to do where one is missing.
#![allow(dead_code)] // Each test binary uses a part of it.

use luminaire::backend::Backend;
use luminaire_measure::Workbench;
use std::io::Write;

/// Says that something was not tested, past the capture of the test harness; fails where everything must be tested
/// (`LUMINAIRE_REQUIRE_GPU=1`).
pub fn skip(what: &str) {
    assert!(std::env::var_os("LUMINAIRE_REQUIRE_GPU").is_none_or(|v| v != "1"), "LUMINAIRE_REQUIRE_GPU=1, but {what}");
    let _ = writeln!(std::io::stderr(), "SKIP: {what}");
}

/// Every backend of this machine; those that cannot run are said to be skipped.
pub fn bench() -> Workbench {
    let bench = Workbench::new(false).expect("a device that is there opens");
    let backends = bench.backends();
    for gpu in [Backend::ComputeBvh, Backend::RayQuery] {
        if !backends.contains(&gpu) {
            skip(&format!("{gpu} cannot run here: {}", bench.device));
        }
    }
    bench
}
