//! The fallback for real: all of these tests once more, on a driver that has no ray query.

use super::*;
use luminaire::backend::Backend;
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

/// `auto`: ray query on a GPU that offers it, the compute BVH on a device that does not and on software; and it says why.
#[test]
fn auto_takes_the_faster_backend_and_says_why() {
    let scene = crate::common::scenes::cornell_like(4, 4);
    let devices = match luminaire::backend::devices() {
        Ok(devices) => devices,
        Err(e) => return skip(&format!("nothing ran on Vulkan: {e}")),
    };
    let Some(device) = devices.iter().find(|d| d.preferred) else { return skip("no Vulkan device is usable") };
    let opened = luminaire::backend::open(&scene, &Default::default()).expect("a backend");
    let expected = match (device.ray_query, device.kind == "software (CPU)") {
        (true, false) => (Backend::RayQuery, "offers ray queries"),
        (true, true) => (Backend::ComputeBvh, "a software device"),
        (false, _) => (Backend::ComputeBvh, "offers no ray queries"),
    };
    assert_eq!((opened.backend, opened.why.contains(expected.1)), (expected.0, true), "{}", opened.why);
    assert!(!opened.notice && opened.device.contains(&device.name));
    if std::env::var_os(WITHOUT_RAY_QUERY).is_some() {
        let error = luminaire::backend::open(
            &scene,
            &luminaire::backend::Request { backend: Some(Backend::RayQuery), device: None },
        );
        assert!(error.err().expect("refused").to_string().contains("--backend compute-bvh"));
    }
}
