//! Whatever is in a photometric file, the scene loads or says why not; what loads is a lamp.
#![no_main]

#[path = "../common/folder.rs"]
mod folder;

use luminaire::scene::{Luminaire, LuminaireTable, load};

const SCENE: &[u8] = b"[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\n[[object]]\nmesh = \"mesh.obj\"\n\
    [[luminaire]]\nkind = \"point\"\nposition = [0, 2, 0]\nprofile = \"lamp.ies\"\n";

libfuzzer_sys::fuzz_target!(init: {
    folder::write("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder::write("scene.toml", SCENE);
}, |bytes: &[u8]| {
    folder::write("lamp.ies", bytes);
    let Ok(scene) = load(&folder::file("scene.toml")) else { return };
    let Luminaire::Photometric { profile, .. } = &scene.luminaires[0] else { panic!("{:?}", scene.luminaires) };
    let (rows, columns) = (profile.horizontal.len(), profile.vertical.len());
    assert!(columns >= 2 && rows >= 1 && profile.candela.len() == rows * columns, "{profile:?}");
    assert!(profile.candela.iter().all(|candela| candela.is_finite() && *candela >= 0.0), "{profile:?}");
    let rising = |angles: &[f32], most: f32| {
        angles.windows(2).all(|pair| pair[0] < pair[1]) && angles.iter().all(|angle| (0.0..=most).contains(angle))
    };
    assert!(rising(&profile.vertical, 180.0) && rising(&profile.horizontal, 360.0), "{profile:?}");
    assert!(rows == 1 || profile.horizontal[0] == 0.0 && profile.horizontal[rows - 1] == 360.0, "{profile:?}");
    assert!(profile.flux() >= 0.0 && (0.0..=180.0).contains(&profile.reach()), "{profile:?}");
    for (around, from_axis) in [(0.0, 0.0), (45.0, 30.0), (360.0, 180.0)] {
        let candela = luminaire::reference::profile::candela(profile, from_axis, around);
        assert!((0.0..=profile.largest() * 1.000001).contains(&candela), "{profile:?}: {candela}");
    }
    let table = LuminaireTable::new(&scene);
    assert!(table.choice.pdf.iter().all(|pdf| pdf.is_finite()), "{profile:?}");
});
