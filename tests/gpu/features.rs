//! Every feature and every choice of the estimator, the kernel against the reference; and the kernel that models only what a scene needs
//! against the one that models everything.

use super::pictures::{differing, mean, pixels};
use super::*;
use crate::common::bodies::bodies_room;
use crate::common::relief::{relief_room, smooth_terminators};
use crate::common::scenes::*;
use crate::common::stage::*;
use crate::common::statistics::*;
use glam::Vec3;
use luminaire::gpu::specialization::Features;
use luminaire::reference::Reference;
use luminaire::scene::{
    AreaSampling, Directions, Estimator, Extinction, Integrator, LightChoice, LightSampling, Projection, Scene,
};

/// The scenes that have all features between them.
pub fn scenes(size: u32) -> Vec<(&'static str, Scene)> {
    let mut parallel = textured_room(size, size);
    parallel.sensor.projection = Projection::Orthographic { height: 3.0 };
    parallel.integrator = Integrator::Simple { ambient: Vec3::splat(0.3) };
    vec![
        ("glass", glass_room(size, size)),
        ("textures", textured_room(size, size)),
        ("open air", open_air(size, size)),
        ("physical", physical_room(size, size)),
        ("parallel", parallel),
        ("stage", stage(size, size)),
        ("relief", relief_room(size, size)),
        ("smooth terminator", smooth_terminators(size, size)),
        ("bodies", bodies_room(size, size)),
    ]
}

/// Same random numbers, few bounces: pixel by pixel the picture of the reference, to 2e-4, or where half vectors of narrow lobes round, to 1e-3, and where steep normals
/// on mirrors and glass magnify what rounds, to 2e-3. Samples that fall on different sides of an
/// edge, or of a choice, are allowed to 1 pixel in 200.
#[test]
fn every_feature_equals_the_reference_pixel_by_pixel() {
    for (name, mut scene) in scenes(96) {
        if let Integrator::Path(estimator) = &mut scene.integrator {
            estimator.max_bounces = Some(match name {
                "glass" | "physical" => 3,
                "relief" | "bodies" => 2,
                _ => 1,
            });
        }
        let expected = pixels(&mut Reference::new(&scene), &scene, 8);
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 8);
            let tolerance = match name {
                "physical" | "bodies" => 1e-3,
                "relief" => 2e-3,
                _ => 2e-4,
            };
            let count = differing(&found, &expected, tolerance);
            println!("{name}, {}: {count} of {} pixels differ", backend.name(), found.len());
            assert!(count <= found.len() / 200, "{name}, {}: {count} pixels differ", backend.name());
            let (a, b) = (mean(&found), mean(&expected));
            assert!((a - b).abs().cmple(b * 2e-3).all(), "{name}, {}: means {a} and {b}", backend.name());
        });
    }
}

/// Full paths, other seeds: the reference's distribution, pixel by pixel (Welch's test, corrected for their number) and in the mean.
#[test]
fn every_feature_has_the_reference_s_distribution() {
    if on_the_old_driver() {
        return;
    }
    for (name, mut scene) in scenes(24) {
        let samples = 512;
        let expected = render(&mut Reference::new(&scene), 24, 24, samples, 16);
        scene.settings.seed = 1;
        on_every_backend(|backend| {
            let found = render(&mut backend.tracer(&scene), 24, 24, samples, 16);
            let p = compare(&found, &expected);
            let (a, b) = (total(&found), total(&expected));
            let z = (a.mean - b.mean) / a.error.hypot(b.error);
            println!("{name}, {}: pixels p = {p:.3}, means {} and {}, z = {z:.2}", backend.name(), a.mean, b.mean);
            assert!(p >= SIGNIFICANCE, "{name}, {}: p = {p:e}", backend.name());
            assert!(two_sided(z) >= SIGNIFICANCE, "{name}, {}: z = {z}", backend.name());
        });
    }
}

/// Every value of every choice, all else being the default: the picture of the reference.
#[test]
fn every_choice_of_the_estimator_equals_the_reference() {
    if on_the_old_driver() {
        return;
    }
    let base = Estimator { max_bounces: Some(2), ..Estimator::default() };
    let mut choices = vec![
        ("no light sampling", Estimator { light_sampling: LightSampling::None, ..base }),
        ("direct", Estimator { light_sampling: LightSampling::Direct, ..base }),
        ("by area", Estimator { area_sampling: AreaSampling::Area, ..base }),
        ("by power", Estimator { light_choice: LightChoice::Power, ..base }),
        ("by the tree", Estimator { light_choice: LightChoice::Tree, ..base }),
        ("uniform", Estimator { directions: Directions::Uniform, ..base }),
        ("cosine", Estimator { directions: Directions::Cosine, ..base }),
        ("no extinction", Estimator { extinction: Extinction::Off, ..base }),
        ("literal", Estimator { extinction: Extinction::Literal, ..base }),
        ("surface", Estimator { extinction: Extinction::Surface, ..base }),
        ("threshold", Estimator { albedo_threshold: Some(0.3), ..base }),
    ];
    choices.extend(
        luminaire::scene::PRESETS.map(|(name, estimator)| (name, Estimator { max_bounces: Some(2), ..estimator })),
    );
    let mut scene = glass_room(64, 64);
    for (name, estimator) in choices {
        scene.integrator = Integrator::Path(estimator);
        let expected = pixels(&mut Reference::new(&scene), &scene, 4);
        // One backend is enough: what differs between them is not the estimator.
        if let Some(backend) = backends().first() {
            let found = pixels(&mut backend.tracer(&scene), &scene, 4);
            let count = differing(&found, &expected, 2e-4);
            println!("{name}: {count} of {} pixels differ", found.len());
            assert!(count <= found.len() / 150, "{name}: {count} pixels differ");
        }
    }
    assert_eq!(luminaire::gpu::validation_messages(), 0);
}

/// The kernel that models everything gives the picture of the one that models what the scene needs. Not the same bits: with a feature
/// switched on, the same number may come from a longer formula (a filter through its table, a lens of radius 0, a transform that
/// does nothing), which rounds otherwise.
#[test]
fn the_specialised_kernel_is_the_whole_kernel() {
    let mut all = scenes(64);
    all.push(("room", cornell_like(64, 64)));
    for (name, scene) in all {
        on_every_backend(|backend| assert_specialisation_is_invisible(backend, name, &scene));
    }
}

/// At the same random numbers at most 1 pixel in 100 differs by more than 1e-3: samples that rounding put on the other side of a choice.
pub fn assert_specialisation_is_invisible(backend: &Intersector, name: &str, scene: &Scene) {
    let found = pixels(&mut backend.tracer(scene), scene, 4);
    let mut whole = luminaire::gpu::GpuTracer::with_model(&backend.device, scene, backend.ray_query, |model| {
        model.features = Features::ALL;
    })
    .expect("the scene fits the device");
    let expected = pixels(&mut whole, scene, 4);
    let count = differing(&found, &expected, 1e-3);
    println!("{name}, {}: {count} of {} pixels differ", backend.name(), found.len());
    assert!(count <= found.len() / 100, "{name}, {}: {count} pixels differ", backend.name());
    let (a, b) = (mean(&found), mean(&expected));
    assert!((a - b).abs().cmple(b * 5e-3 + 1e-9).all(), "{name}, {}: means {a} and {b}", backend.name());
}
