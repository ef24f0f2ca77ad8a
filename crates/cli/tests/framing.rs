//! `--camera`, `--crop` and `--transparent`: whose picture, which part of it, and with what behind.

mod common;

use common::{Folder, stderr};
use luminaire::picture;
use std::path::PathBuf;
use std::process::Output;

/// What follows a camera in a scene file: a lamp of two triangles from -1 to 1, with a hole in the upper left, before a sky.
const REST: &str = "[film]\nwidth = 24\nheight = 16\n[render]\nspp = 5\n[environment]\nradiance = [0.25, 0.5, 1]\n[[object]]\nmesh = \"good.obj\"\n";

fn camera(name: &str, x: f64) -> String {
    let name = if name.is_empty() { String::new() } else { format!("name = \"{name}\"\n") };
    format!("[[sensor]]\n{name}position = [{x}, 0.25, 3]\ntarget = [{x}, 0.25, 0]\nfov = 40\n")
}

struct Runs(Folder);

impl Runs {
    /// With `room.toml`, whose only camera has no name.
    fn new() -> Self {
        let folder = Folder::new();
        folder.write("room.toml", &(camera("", 0.5).replace("[[sensor]]", "[sensor]") + REST));
        Runs(folder)
    }

    fn run(&self, words: &str) -> Output {
        let words: Vec<&str> = words.split_whitespace().collect();
        self.0.luminaire(&words).output().unwrap()
    }

    /// Runs `render` on the reference and returns what it said.
    fn render(&self, words: &str) -> String {
        let output = self.run(&format!("render {words} --backend cpu"));
        assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
        stderr(&output)
    }

    /// What is said by a run that ends with this code.
    fn refused(&self, words: &str, code: i32) -> String {
        let output = self.run(words);
        assert_eq!(output.status.code(), Some(code), "{words}: {}", stderr(&output));
        stderr(&output)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn pixels(&self, name: &str) -> ((u32, u32), Vec<[f32; 3]>) {
        let picture = picture::read(&self.path(name)).unwrap();
        ((picture.width, picture.height), picture.rgb)
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }
}

#[test]
fn one_of_several_cameras() {
    let runs = Runs::new();
    runs.0.write("several.toml", &(camera("front", 0.5) + &camera("Side", 0.0) + &camera("side door", 0.75) + REST));
    runs.0.write("one.toml", &(camera("", 0.0) + REST));
    let said = runs.render("several.toml -o first.png");
    assert!(said.contains("camera `front`, the first of 3") && said.contains("`Side`, `side door`"), "{said}");
    let said = runs.render("several.toml --camera front -o front.png");
    assert!(!said.contains("first of 3"), "{said}");
    runs.render("several.toml --camera Side -o side.png");
    runs.render("one.toml -o one.png");
    runs.render("room.toml -o room.png");
    assert!(runs.bytes("first.png") == runs.bytes("front.png") && runs.bytes("front.png") == runs.bytes("room.png"));
    assert!(runs.bytes("side.png") == runs.bytes("one.png") && runs.bytes("side.png") != runs.bytes("front.png"));
    // What is not there is refused before anything is rendered, also by the others that know cameras.
    for command in ["render", "inspect", "view"] {
        let said = runs.refused(&format!("{command} several.toml --camera side"), 2);
        assert!(said.contains("`front`, `Side`, `side door`") && said.contains("did you mean `Side`?"), "{said}");
    }
    let said = runs.refused("render several.toml --camera frnt", 2);
    assert!(said.contains("did you mean `front`?"), "{said}");
    let listed = runs.run("inspect several.toml --camera Side");
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let chosen = listed.lines().find(|line| line.starts_with("sensor")).unwrap();
    assert!(chosen.contains("(0 0.25 3)") || chosen.contains("0.0000"), "{listed}");
    assert!(["front", "Side", "side door"].iter().all(|name| listed.contains(&format!("\n  {name} "))), "{listed}");
    // A part of the samples through one camera does not go on through another.
    runs.render("several.toml --camera front --checkpoint c.exr -o front.png");
    let said = runs.refused("render several.toml --camera Side --checkpoint c.exr --resume --backend cpu -o s.png", 1);
    assert!(said.contains("differs in camera"), "{said}");
    runs.render("room.toml --checkpoint c.exr --resume -o room.png");
}

#[test]
fn a_camera_from_a_file() {
    let runs = Runs::new();
    let table = camera("", 0.0).replace("[[sensor]]", "[sensor]");
    runs.0.write("window.toml", &(table.clone() + "shift = [0.125, -0.25]\n[render]\nexposure = -1\n"));
    runs.0
        .write("same.toml", &(table.clone() + "shift = [0.125, -0.25]\n" + &REST.replace("spp", "exposure = -1\nspp")));
    runs.render("room.toml --camera window.toml -o a.png");
    runs.render("same.toml -o b.png");
    assert!(runs.bytes("a.png") == runs.bytes("b.png"));
    runs.render("room.toml --camera window.toml --exposure 1 -o a.png");
    runs.render("same.toml --exposure 1 -o c.png");
    assert!(runs.bytes("a.png") == runs.bytes("c.png") && runs.bytes("b.png") != runs.bytes("c.png"));
    // The camera of another scene, of which nothing else counts; and no picture in its place.
    let said = runs.render("room.toml --camera same.toml -o a.png");
    assert!(
        said.contains("only its camera and how its pictures are shown count here")
            && said.contains("not its [film], [environment], [[object]], `spp`"),
        "{said}"
    );
    let more = "[integrator]\nmax_bounces = 1\n[render]\nseed = 3\nsampler = \"independent\"\ntone = \"agx\"\n";
    runs.0.write("more.toml", &(table.clone() + more));
    let said = runs.render("room.toml --camera more.toml -o more.png");
    assert!(said.contains("not its [integrator], `seed`, `sampler`") && !said.contains("`spp`"), "{said}");
    assert!(runs.bytes("a.png") == runs.bytes("b.png"));
    // A scene without a camera, and a bare mesh.
    runs.0.write("none.toml", REST);
    let said = runs.render("none.toml --camera window.toml -o a.png");
    assert!(!said.contains("no [sensor]") && runs.bytes("a.png") == runs.bytes("b.png"), "{said}");
    runs.render("good.obj --camera window.toml --width 24 --spp 2 -o near.exr");
    runs.render("good.obj --width 24 --spp 2 -o framed.exr");
    assert!(runs.pixels("near.exr") != runs.pixels("framed.exr"));
    // In the coordinates of the files, also where the scene is moved before it is rounded.
    let far = |text: &str| {
        text.replace("v 0 0 0", "v 4000000 0 0").replace("v 1 0 0", "v 4000001 0 0").replace("v 0 1 0", "v 4000000 1 0")
    };
    let mesh = std::fs::read_to_string(runs.path("good.obj")).unwrap();
    runs.0.write("far.obj", &far(&mesh));
    runs.0.write("far.toml", &(camera("", 0.5) + &REST.replace("good.obj", "far.obj")));
    runs.0.write("far-camera.toml", &table.replace("[0,", "[4000000,"));
    runs.0.write("near-camera.toml", &table);
    runs.render("far.toml --camera far-camera.toml -o far.png");
    runs.render("room.toml --camera near-camera.toml -o near.png");
    assert!(runs.bytes("far.png") == runs.bytes("near.png"));
    // Mistakes.
    runs.0.write("empty.toml", "[render]\nexposure = 1\n");
    assert!(runs.refused("render room.toml --camera empty.toml", 1).contains("no [sensor] in it"));
    runs.0.write("wrong.toml", "[sensor]\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\nfvo = 40\n");
    assert!(runs.refused("render room.toml --camera wrong.toml", 1).contains("wrong.toml:4:1"));
    assert!(runs.refused("render room.toml --camera windw.toml", 1).contains("there is window.toml"));
    assert!(runs.refused("render good.obj --camera window", 2).contains("ends in .toml"));
}

#[test]
fn a_crop_is_the_whole_s_own_pixels() {
    let runs = Runs::new();
    runs.render("room.toml -o whole.png -o whole.exr --aov");
    let said =
        runs.render("room.toml --crop 6,3,11,7 -o piece.png -o piece.exr --aov --error-map error.png --stats s.json");
    assert!(!said.contains("warning"), "{said}");
    let cut = |pixels: &[[f32; 3]]| -> Vec<[f32; 3]> {
        (3..10).flat_map(|y| pixels[y * 24 + 6..y * 24 + 17].to_vec()).collect()
    };
    for ending in ["png", "exr"] {
        let (_, whole) = runs.pixels(&format!("whole.{ending}"));
        let (size, piece) = runs.pixels(&format!("piece.{ending}"));
        assert!(size == (11, 7) && piece == cut(&whole), "{ending}");
    }
    let stats: serde_json::Value = serde_json::from_slice(&runs.bytes("s.json")).unwrap();
    assert_eq!((&stats["width"], &stats["samples"], &stats["crop"]["x"]), (&11.into(), &385.into(), &6.into()));
    // With its scale below.
    assert_eq!(image::open(runs.path("error.png")).unwrap().height(), 7 + 40);
    // By another reader: where it lies, and its layers.
    use exr::prelude::*;
    let file = read_all_flat_layers_from_file(runs.path("piece.exr")).unwrap();
    let layer = &file.layer_data[0];
    assert_eq!(file.attributes.display_window, IntegerBounds::new((0, 0), (24, 16)));
    assert_eq!((layer.attributes.layer_position, layer.size), (Vec2(6, 3), Vec2(11, 7)));
    assert!(layer.channel_data.list.iter().any(|channel| channel.name.eq("Z")));
    // `compare` takes it as a picture, and says that it is a piece.
    let output = runs.run("compare piece.exr piece.png --max-rmse 2");
    assert!(
        output.status.success() && stderr(&output).contains("at 6 3 of a picture of 24 x 16"),
        "{}",
        stderr(&output)
    );
    assert!(runs.refused("compare piece.exr whole.exr", 2).contains("24 x 16"));

    // Divided, interrupted, with more samples: the same.
    runs.render("room.toml --crop 6,3,11,7 --samples 0..2 -o 1.exr");
    runs.render("room.toml --crop 6,3,11,7 --samples 2..5 -o 2.exr");
    let merged = runs.run("merge 1.exr 2.exr -o merged.png");
    assert!(merged.status.success() && runs.bytes("merged.png") == runs.bytes("piece.png"), "{}", stderr(&merged));
    runs.render("room.toml --crop 6,3,11,7 --spp 3 --checkpoint c.exr -o 3.png");
    runs.render("room.toml --crop 6,3,11,7 --spp 5 --checkpoint c.exr --resume -o 5.png");
    assert!(runs.bytes("5.png") == runs.bytes("piece.png"));
    let said = runs.refused("render room.toml --crop 6,3,11,8 --checkpoint c.exr --resume --backend cpu -o 6.png", 1);
    assert!(said.contains("crop (6,3,11,7 there, 6,3,11,8 here)"), "{said}");
    runs.render("room.toml --crop 6,3,11,9 --samples 2..5 -o 3.exr");
    assert!(runs.refused("merge 1.exr 3.exr -o merged.exr", 2).contains("differ in crop"));

    for beyond in ["14,0,11,1", "0,10,1,7", "24,0,1,1", "4294967295,0,4294967295,1"] {
        let said = runs.refused(&format!("render room.toml --crop {beyond}"), 2);
        assert!(said.contains("24 x 16 pixels"), "{said}");
    }
    for wrong in ["1,2,3", "0,0,0,4", "0,0,4,-1", "a,b,c,d", "0.5,0,1,1"] {
        let said = runs.refused(&format!("render room.toml --crop {wrong}"), 2);
        assert!(said.contains("320,180,640,360"), "{said}");
    }
    assert!(runs.refused("render room.toml --crop 0,0,1,1 --pixel 0,0 --sample 1", 2).contains("--crop"));
    // What a whole picture of this size would take is not asked for.
    runs.render("room.toml --width 60000 --height 40000 --crop 30000,20000,2,2 --spp 1 -o tiny.png");
}

#[test]
fn a_transparent_picture_goes_over_any_other() {
    let runs = Runs::new();
    runs.render("room.toml --spp 64 -o opaque.exr");
    let said = runs.render("room.toml --spp 64 --transparent -o a.png -o a.exr --aov");
    assert!(!said.contains("warning"), "{said}");
    let opaque = runs.pixels("opaque.exr").1;
    use exr::prelude::*;
    let read = |name: &str| {
        read_first_rgba_layer_from_file(
            runs.path(name),
            |size, _| vec![[-1.0f32; 4]; size.area()],
            |pixels, at, (r, g, b, a): (f32, f32, f32, f32)| pixels[at.y() * 24 + at.x()] = [r, g, b, a],
        )
        .unwrap()
        .layer_data
        .channel_data
        .pixels
    };
    let exr = read("a.exr");
    let png = image::open(runs.path("a.png")).unwrap();
    assert_eq!(png.color(), image::ColorType::Rgba8);
    let png = png.into_rgba8();
    let mut between = 0;
    for (pixel, [r, g, b, a]) in exr.iter().copied().enumerate() {
        // The colours of an EXR are multiplied by alpha: over a sky they are added to what it leaves of it.
        for (found, (sky, opaque)) in [r, g, b].into_iter().zip([0.25, 0.5, 1.0].into_iter().zip(opaque[pixel])) {
            assert!((found + (1.0 - a) * sky - opaque).abs() < 1e-6, "pixel {pixel}");
        }
        let rgba = png.as_raw().chunks_exact(4).nth(pixel).unwrap();
        assert_eq!(rgba[3], (255.0 * a).round() as u8, "pixel {pixel}");
        // Those of a PNG are not: the lamp is white up to its edge.
        assert_eq!(rgba[..3], if a > 0.0 { [255; 3] } else { [0; 3] }, "pixel {pixel}");
        between += usize::from(a > 0.0 && a < 1.0);
    }
    assert!(between > 8 && exr.iter().any(|p| p[3] == 0.0) && exr.iter().any(|p| p[3] == 1.0), "{between}");

    // Divided and gone on with, also until an error is reached.
    runs.render("room.toml --transparent --samples 0..40 -o 1.exr");
    runs.render("room.toml --transparent --samples 40..64 -o 2.exr");
    let merged = runs.run("merge 1.exr 2.exr -o merged.png");
    assert!(merged.status.success() && runs.bytes("merged.png") == runs.bytes("a.png"), "{}", stderr(&merged));
    assert!(runs.refused("merge 1.exr 2.exr -o merged.hdr", 2).contains("no alpha"));
    runs.render("room.toml --transparent --spp 20 --checkpoint c.exr -o b.png");
    runs.render("room.toml --transparent --spp 64 --checkpoint c.exr --resume -o b.png");
    assert!(runs.bytes("b.png") == runs.bytes("a.png") && read("c.exr") == exr);
    let said = runs.refused("render room.toml --checkpoint c.exr --resume --backend cpu -o b.png", 1);
    assert!(said.contains("background (transparent there, opaque here)"), "{said}");
    runs.render("room.toml --transparent --noise 0.2 --time 60 --crop 4,4,8,8 -o noise.png");
    assert_eq!(image::open(runs.path("noise.png")).unwrap().color(), image::ColorType::Rgba8);

    let said = runs.refused("render room.toml --transparent -o a.png -o a.hdr", 2);
    assert!(said.contains("a.hdr") && said.contains("no alpha") && !runs.path("a.hdr").exists(), "{said}");
    // All of it covered: alpha is 1, and there.
    runs.render("room.toml --transparent --crop 10,8,2,1 -o inside.png");
    let inside = image::open(runs.path("inside.png")).unwrap();
    assert!(inside.color() == image::ColorType::Rgba8 && inside.into_rgba8().pixels().all(|p| p[3] == 255));
}

#[test]
fn a_camera_below_the_ground_is_warned_of() {
    let runs = Runs::new();
    let scene = |height: &str| {
        let sensor = "[sensor]\nposition = [0.5, -0.5, 3]\ntarget = [0.5, 0.25, 0]\nfov = 40\n";
        format!("{sensor}{REST}[ground]\nheight = {height}\n")
    };
    runs.0.write("below.toml", &scene("-0.25"));
    runs.0.write("above.toml", &scene("-0.75"));
    let words = "the camera stands below the ground (at a height of -0.5, the ground at -0.25)";
    for command in ["render below.toml --backend cpu --width 4 -o a.png", "inspect below.toml"] {
        let output = runs.run(command);
        let said = stderr(&output) + &String::from_utf8(output.stdout).unwrap();
        assert_eq!(said.matches(words).count(), 1, "{said}");
    }
    for words in ["above.toml", "below.toml --ground off"] {
        assert!(!runs.render(&format!("{words} --width 4 -o a.png")).contains("below the ground"), "{words}");
    }
}

#[test]
fn a_negative_piece_is_answered_by_what_is_expected() {
    let runs = Runs::new();
    for words in ["--crop -1,0,10,10", "--crop=-1,0,10,10", "--crop -1", "--crop 1,-2,3,4"] {
        assert!(runs.refused(&format!("render room.toml {words}"), 2).contains("expected the left column"), "{words}");
    }
    let said = runs.refused("render room.toml --crop --aov", 2);
    assert!(said.contains("a value is required for '--crop"), "{said}");
    assert!(runs.refused("render room.toml --pixel -1,2 --sample 0", 2).contains("expected column and row"));
    assert!(runs.refused("render room.toml --samples -1..2", 2).contains("0..64 or 64..128"));
    assert!(runs.refused("render room.toml --aov -1,2", 2).contains("--aov"));
}
