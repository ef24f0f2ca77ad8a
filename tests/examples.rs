//! The examples of the library run, and do what they say.
#![allow(dead_code, missing_docs)] // Their `main` is not called, and they are no library.

#[path = "../examples/progressive.rs"]
mod progressive;
#[path = "../examples/render_file.rs"]
mod render_file;
#[path = "../examples/scene_in_code.rs"]
mod scene_in_code;

use luminaire_measure::metrics::compare;

#[test]
fn a_file_becomes_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("wall.toml");
    let text =
        "[film]\nwidth = 8\nheight = 6\n[environment]\nradiance = [0.5, 0.5, 0.5]\n[[object]]\nmesh = \"wall.obj\"\n";
    std::fs::write(&scene, text).unwrap();
    std::fs::write(folder.path().join("wall.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let picture = folder.path().join("wall.png");
    render_file::render(&scene, &picture, Some(4)).unwrap();
    let picture = luminaire::picture::read(&picture).unwrap();
    assert_eq!((picture.width, picture.height), (8, 6));
    assert!(picture.rgb.iter().flatten().all(|v| *v > 0.0), "{:?}", picture.rgb);
}

#[test]
fn a_scene_in_code_looks_the_same_on_every_backend() {
    let scene = scene_in_code::still_life(24, 16);
    let films = scene_in_code::on_every_backend(&scene, 16).unwrap();
    let reference = scene_in_code::picture(&films[0].1);
    assert!(reference.rgb.iter().flatten().any(|v| *v > 0.1), "the picture is black");
    for (backend, film) in &films {
        let relmse = compare(&scene_in_code::picture(film), &reference, 0).unwrap().relmse;
        // The same random numbers: only where rounding decides what a ray hits, a sample differs.
        assert!(relmse < 0.1 * film.error().unwrap().rel_mse, "{backend}: {relmse}");
    }
}

#[test]
fn frames_come_until_the_picture_is_good_enough() {
    let scene = scene_in_code::still_life(64, 48);
    let (mut frames, mut last) = (0, None);
    let rendered = progressive::watch(&scene, 0.1, |frame| {
        assert_eq!(frame.srgb.len(), 3 * 64 * 48);
        frames += 1;
        last = frame.error;
    })
    .unwrap();
    assert!(frames > 0 && last.is_some_and(|error| error <= 0.1), "{frames} frames, the last {last:?}");
    assert!(rendered.progress.error.unwrap().relative() < 0.2);
}
