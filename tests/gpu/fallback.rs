//! The fallback for real: all of these tests once more, on a driver that has no ray query.

use super::*;
use std::process::Command;

/// Runs this very program again on the driver whose manifest `LUMINAIRE_OLD_DRIVER` names (`make test` puts Mesa 22.3.6 there).
#[test]
fn everything_on_a_driver_without_ray_query() {
    if std::env::var_os(WITHOUT_RAY_QUERY).is_some() {
        return; // This is that run.
    }
    let Some(manifest) = std::env::var_os("LUMINAIRE_OLD_DRIVER") else {
        skip("there is no driver without ray query here (LUMINAIRE_OLD_DRIVER); the fallback was not tested on one");
        return;
    };
    let output = Command::new(std::env::current_exe().expect("this program"))
        .env(WITHOUT_RAY_QUERY, "1")
        .env("LUMINAIRE_REQUIRE_GPU", "1")
        .env("VK_DRIVER_FILES", &manifest)
        .env("VK_ICD_FILENAMES", &manifest)
        .output()
        .expect("this program runs again");
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "on {}:\n{text}\n{errors}", manifest.to_string_lossy());
    // It tested something: the summary of the test harness says how much.
    let summary = text.lines().find(|l| l.starts_with("test result: ok.")).expect("a summary");
    println!("on a driver without ray query: {summary}");
}
