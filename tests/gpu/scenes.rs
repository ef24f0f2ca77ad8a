//! Every scene file of `scenes/`: the kernel against the reference, and the specialised kernel against the whole one.

use super::features::assert_specialisation_is_invisible;
use super::pictures::{differing, mean, pixels};
use super::*;
use crate::common::statistics::*;
use luminaire::reference::Reference;
use luminaire::scene::{self, Integrator, Material, Sampler};
use std::path::{Path, PathBuf};

/// Every scene file, by name.
fn scene_files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let folders = std::fs::read_dir(root).expect("the scenes are there").map(|entry| entry.expect("a folder").path());
    let mut files: Vec<PathBuf> = folders
        .filter(|folder| folder.is_dir())
        .flat_map(|folder| std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path()))
        .filter(|file| file.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    files.sort();
    assert!(files.len() >= 14, "only {} scenes were found", files.len());
    files
}

/// A scene in a small picture, and its name.
fn small(file: &Path) -> (String, Scene) {
    let mut scene = scene::load(file).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.warnings, Vec::<String>::new(), "{}", file.display());
    scene.film.width = 48;
    scene.film.height = 48;
    (file.file_stem().expect("a name").to_string_lossy().into_owned(), scene)
}

/// Same random numbers, at most two indirect bounces: the reference's picture, but for the samples that rounding puts on the other side
/// of an edge or of a choice. Glass turns every such sample into another one, and relief magnifies the rounding of a hit's place from bounce to bounce.
#[test]
fn scenes_equal_the_reference_pixel_by_pixel() {
    for file in scene_files() {
        let (name, mut scene) = small(&file);
        if let Integrator::Path(estimator) = &mut scene.integrator {
            estimator.max_bounces = Some(2);
        }
        let expected = pixels(&mut Reference::new(&scene), &scene, 4);
        on_every_backend(|backend| {
            let found = pixels(&mut backend.tracer(&scene), &scene, 4);
            let count = differing(&found, &expected, 1e-3);
            let (a, b) = (mean(&found), mean(&expected));
            println!("{name}, {}: {count} of {} pixels differ, means {a:.4} {b:.4}", backend.name(), found.len());
            let relief = scene.materials.iter().any(Material::bends_normal);
            assert!(
                count <= found.len() / if relief { 20 } else { 50 },
                "{name}, {}: {count} pixels differ",
                backend.name()
            );
            // One sample of a caustic may be a hundredth of a picture this small.
            assert!((a - b).abs().cmple(b * 2e-2).all(), "{name}, {}: means {a} and {b}", backend.name());
        });
    }
}

/// Full paths, other seeds: no pixel differs significantly from the reference's.
#[test]
fn scenes_have_the_reference_s_distribution() {
    if on_the_old_driver() {
        return;
    }
    let files = scene_files();
    for file in &files {
        let (name, mut scene) = small(file);
        (scene.film.width, scene.film.height) = (16, 16);
        scene.settings.sampler = Sampler::Independent;
        let expected = render(&mut Reference::new(&scene), 16, 16, 512, 16);
        scene.settings.seed += 1;
        on_every_backend(|backend| {
            let found = render(&mut backend.tracer(&scene), 16, 16, 512, 16);
            let p = compare(&found, &expected);
            println!(
                "{name}, {}: pixels p = {p:.3}, means {:?} and {:?}",
                backend.name(),
                total(&found),
                total(&expected)
            );
            assert!(p >= SIGNIFICANCE / files.len() as f64, "{name}, {}: p = {p:e}", backend.name());
        });
    }
}

/// What a scene does not use may be left out of its kernel.
#[test]
fn specialisation_is_invisible_in_every_scene() {
    if on_the_old_driver() {
        return;
    }
    for file in scene_files() {
        let (name, scene) = small(&file);
        on_every_backend(|backend| assert_specialisation_is_invisible(backend, &name, &scene));
    }
}
