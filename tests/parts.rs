//! Parts and checkpoints on disk: whatever byte of one changes, its samples are refused or are what they were.

use glam::{Affine3A, Vec3};
use luminaire::backend::{self, Backend, Request};
use luminaire::part::{self, Provenance};
use luminaire::picture::Crop;
use luminaire::reference::Reference;
use luminaire::render::{Cropped, End, Limits, Rendered, resume};
use luminaire::scene::build::{add, empty, lamp, quad};
use luminaire::{Error, Film, Scene};
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A lamp, and its render with some samples that are left out.
fn rendered() -> (Scene, Rendered) {
    let mut scene = empty(3, 2);
    let wall = quad(Vec3::new(-1.0, -1.0, -1.0), Vec3::X * 3.0, Vec3::Y * 3.0);
    add(&mut scene, wall, lamp(Vec3::new(1.0, 2.0, 3.0)), Affine3A::IDENTITY);
    let mut renderer = backend::open(&scene, &Request { backend: Some(Backend::Cpu), device: None }).unwrap();
    let limits = Limits { spp: Some(6), ..Limits::default() };
    let nothing = Rendered::nothing(renderer.size, 0).unwrap();
    let mut rendered = renderer.resume(nothing, limits, &mut |_| {}, &AtomicBool::new(false)).unwrap();
    assert!(matches!(rendered.end, End::Samples));
    rendered.film.dropped.insert((4, 2), 1);
    rendered.film.sums[3][1] = [1.0e-300, -0.0, 12345.678];
    (scene, rendered)
}

/// What is read back; an error in words.
fn read(path: &Path) -> Result<Film, String> {
    let refused = |error: Error| error.to_string();
    Ok(part::read(path).map_err(refused)?.0.film)
}

#[test]
fn no_byte_changes_unnoticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.exr");
    let (scene, rendered) = rendered();
    part::save(&path, &rendered, &Provenance::of(&scene)).unwrap();
    let sound = std::fs::read(&path).unwrap();
    assert!(read(&path).unwrap() == rendered.film);
    let mut file = std::fs::File::options().write(true).open(&path).unwrap();
    let mut put = |at: usize, byte: u8| {
        file.seek(SeekFrom::Start(at as u64)).unwrap();
        file.write_all(&[byte]).unwrap();
    };
    // One bit of every byte, and every bit of some of them.
    for at in 0..sound.len() {
        let thorough = at % 64 == 0;
        for bit in if thorough { 0..8 } else { at % 8..at % 8 + 1 } {
            put(at, sound[at] ^ 1 << bit);
            assert!(read(&path).is_err(), "byte {at} of {}, bit {bit}", sound.len());
            if thorough {
                assert!(part::resume(&path, &scene).is_err() && part::merge(std::slice::from_ref(&path)).is_err());
            }
        }
        put(at, sound[at]);
    }
    // Cut off, and grown.
    for length in [0, 7, 100, sound.len() / 2, sound.len() - 1] {
        std::fs::write(&path, &sound[..length]).unwrap();
        assert!(read(&path).is_err(), "{length} bytes");
    }
    std::fs::write(&path, [&sound[..], &[0]].concat()).unwrap();
    assert!(read(&path).unwrap_err().contains("damaged"));
    std::fs::write(&path, &sound).unwrap();
    assert!(read(&path).unwrap() == rendered.film && part::resume(&path, &scene).is_ok());
}

/// A transparent piece of a picture is read back with its alpha and its place, and nothing else goes on from it.
#[test]
fn a_transparent_crop_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.exr");
    let (mut scene, _) = rendered();
    scene.settings.transparent = true;
    (scene.film.width, scene.film.height) = (5, 4);
    // The wall's left edge.
    scene.sensor.shift.x = -1.0;
    let crop = Crop { x: 2, y: 1, width: 3, height: 2, whole: (5, 4) };
    let mut rendered = Rendered::nothing_of_crop(crop, 0).unwrap();
    let limits = Limits { spp: Some(6), ..Limits::default() };
    let mut tracer = Reference::new(&scene);
    let mut tracer = Cropped::new(&mut tracer, Some(&crop));
    rendered.film.count_misses();
    let rendered = resume(&mut tracer, rendered, limits, &mut |_| {}, &AtomicBool::new(false));
    let alphas = rendered.film.alphas().unwrap();
    assert!(alphas.contains(&0.0) && alphas.iter().any(|alpha| *alpha > 0.0), "{alphas:?}");
    let provenance = Provenance::of(&scene).cropped(Some(crop));
    part::save(&path, &rendered, &provenance).unwrap();
    assert!(read(&path).unwrap() == rendered.film);
    let merged = part::merge(std::slice::from_ref(&path)).unwrap().0;
    assert!(merged.film == rendered.film && merged.film.crop == Some(crop));
    assert!(part::resume_crop(&path, &scene, Some(crop)).unwrap().film == rendered.film);
    let refused = |scene: &Scene, crop| part::resume_crop(&path, scene, crop).unwrap_err().to_string();
    assert!(refused(&scene, None).contains("crop (2,1,3,2 there, all of it here)"));
    assert!(refused(&scene, Some(Crop { x: 1, ..crop })).contains("crop (2,1,3,2 there, 1,1,3,2 here)"));
    scene.settings.transparent = false;
    assert!(refused(&scene, Some(crop)).contains("background (transparent there, opaque here)"));
}

#[test]
fn without_a_digest_nothing_is_believed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.exr");
    let (scene, rendered) = rendered();
    part::save(&path, &rendered, &Provenance::of(&scene)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let name = b"luminaire.digest";
    let at = bytes.windows(name.len()).position(|bytes| bytes == name).unwrap();
    let mut older = bytes.clone();
    older[at..at + name.len()].copy_from_slice(b"luminaire.digesu");
    std::fs::write(&path, older).unwrap();
    assert!(read(&path).unwrap_err().contains("no digest"));
    // And a picture is still no part.
    rendered.film.save(&path, 0.0).unwrap();
    assert!(read(&path).unwrap_err().contains("not a part of a render"));
}

#[test]
fn the_same_render_is_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, rendered) = rendered();
    let files = ["a.exr", "b.exr"].map(|name| {
        let path = folder.path().join(name);
        part::save(&path, &rendered, &Provenance::of(&scene)).unwrap();
        std::fs::read(path).unwrap()
    });
    assert!(files[0] == files[1]);
}
