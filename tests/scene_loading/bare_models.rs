//! What a bare model gets, what may be chosen in its place, and `[ground]` and `sky` of scene files.

use super::*;
use glam::{DVec3, Vec3};
use luminaire::scene::{Choices, EnvironmentImage, Exposure, Luminaire, Side, Sky, Up, load_with};
use std::f64::consts::PI;

/// A box from (0, 0, 0) to (x, y, z) as six quads, the corners numbered from `first`.
fn block([x, y, z]: [f64; 3], first: usize) -> String {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let corner = |c: [u32; 3]| format!("v {} {} {}\n", x * f64::from(c[0]), y * f64::from(c[1]), z * f64::from(c[2]));
    let faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [3, 7, 6, 2], [0, 4, 7, 3], [1, 2, 6, 5]];
    let face = |f: [usize; 4]| "f".to_owned() + &f.map(|i| format!(" {}", i + first)).concat() + "\n";
    corners.map(corner).concat() + &faces.map(face).concat()
}

fn with(folder: &Folder, file: &str, choices: &Choices) -> Scene {
    load_with(&folder.path(file), choices).unwrap_or_else(|error| panic!("{error}"))
}

/// The y of the ground, in the coordinates of the files.
fn ground(scene: &Scene) -> Option<f64> {
    let object = &scene.objects[scene.ground? as usize];
    let mesh = &scene.meshes[object.mesh as usize];
    assert!(mesh.positions.iter().all(|p| p.y == mesh.positions[0].y), "it is level");
    Some(f64::from(mesh.positions[0].y) + scene.origin.y)
}

/// Grey, as bright below the horizon as level ground of albedo 0.45 under it, and brightest towards the upper left behind the camera.
#[test]
fn the_studio_sky_is_what_its_formula_says() {
    let image = EnvironmentImage::studio();
    assert_eq!((image.width, image.height, image.texels.len()), (256, 128, 256 * 128));
    let (mut irradiance, mut brightest) = (0.0, (0.0, DVec3::ZERO));
    for (i, texel) in image.texels.iter().enumerate() {
        assert!(texel.x == texel.y && texel.y == texel.z, "white light: {texel}");
        let theta = PI * ((i / 256) as f64 + 0.5) / 128.0;
        let phi = 2.0 * PI * ((i % 256) as f64 + 0.5) / 256.0;
        let direction = DVec3::new(-theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos());
        let radiance = f64::from(texel.x);
        if direction.y < 0.0 {
            assert!((radiance - 0.4).abs() < 1e-5, "{direction}: {radiance}");
        } else {
            irradiance += radiance * direction.y * theta.sin() * PI / 128.0 * 2.0 * PI / 256.0;
        }
        if radiance > brightest.0 {
            brightest = (radiance, direction);
        }
    }
    let ground = 0.45 * irradiance / PI;
    assert!((ground - 0.4).abs() < 1e-3 * 0.4, "{ground}");
    let key = DVec3::new(-0.3, 0.8, 0.7).normalize();
    assert!(brightest.1.dot(key) > 0.999, "{brightest:?}");
    let peak = 0.4 + 0.1 * key.y + 5.982;
    assert!((brightest.0 - peak).abs() < 0.01 * peak, "{brightest:?} {peak}");
}

#[test]
fn a_bare_model_stands_on_a_ground_under_the_studio_sky() {
    for (text, low) in [
        (block([2.0, 1.0, 1.0], 1), 0.0),
        // Far from the origin the ground is near the model all the same.
        ("v 500000.25 7000.5 0\nv 500003 7000.5 1\nv 500000 7003 1\nf 1 2 3\n".into(), 7000.5),
        // A standing sheet has no footprint.
        (TRIANGLE.into(), 0.0),
    ] {
        let scene = obj(&text).load("mesh.obj");
        let sky = scene.environment.as_ref().and_then(|sky| sky.image.as_ref()).expect("a sky");
        assert_eq!(**sky, EnvironmentImage::studio());
        let y = ground(&scene).expect("a ground");
        let (a, b) = scene.model_bounds();
        let size = a.distance(b);
        assert!(y < low && low - y < 3e-4 * size.max(0.1 * low), "{y} below {low}");
        let (a, b) = scene.world_bounds();
        assert!(
            (b.x - a.x) > 10.0 * size && (b.x - a.x) < 100.0 * size,
            "it is large, but not so that precision suffers"
        );
        assert_eq!(scene.warnings, Vec::<String>::new());
        let [note, place] = &scene.notes[..] else { panic!("{:?}", scene.notes) };
        assert!(place.starts_with("the camera stands "), "{place}");
        assert_eq!(scene.settings.exposure, Exposure::Stops(0.0));
        assert!(note.contains("studio sky") && note.contains(&format!("ground at y = {y:.4}")[..16]), "{note} {y}");
        assert!(note.contains("luminaire scene"), "{note}");
    }
}

/// The text of a grid of 12 x 12 quads over the unit square, at heights that a function says.
fn sheet(height: impl Fn(f64, f64) -> f64) -> String {
    let mut text = String::new();
    for i in 0..13 * 13 {
        let (x, z) = (f64::from(i % 13) / 12.0, f64::from(i / 13) / 12.0);
        text += &format!("v {x} {} {z}\n", height(x, z));
    }
    for i in 0..12 * 12 {
        let a = i / 12 * 13 + i % 12 + 1;
        text += &format!("f {a} {} {} {}\n", a + 13, a + 14, a + 1);
    }
    text
}

#[test]
fn what_brings_its_own_ground_gets_none() {
    let quad =
        |corners: [[f64; 3]; 4]| corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat() + "f -4 -3 -2 -1\n";
    let floor = quad([[0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, 0.0]]);
    let wall = quad([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0]]);
    let roof = floor.replace(" 0 ", " 3 ").replace(" 0.0 ", " 3 ");
    assert!(roof != floor);
    for (what, text, expected) in [
        ("a floor", floor.clone(), false),
        ("a thing on a floor", floor.clone() + &block([1.0, 2.0, 1.0], 5), false),
        ("much on a floor", floor.clone() + &block([3.0, 2.0, 2.5], 5), false),
        ("a backdrop", floor.clone() + &wall, false),
        ("a landscape", sheet(|x, z| (7.0 * x).sin() * (5.0 * z).cos() * 0.3), false),
        ("a landscape with a house", sheet(|x, z| 0.4 * x * z) + &block([0.1, 0.8, 0.1], 170), false),
        ("a cube", block([1.0; 3], 1), true),
        ("a slab", block([10.0, 0.3, 10.0], 1), true),
        (
            "a roof on a post",
            quad([[0.0, 3.0, 0.0], [0.0, 3.0, 4.0], [4.0, 3.0, 4.0], [4.0, 3.0, 0.0]]) + &block([0.2, 3.0, 0.2], 5),
            true,
        ),
        ("a floor that covers a part", floor + &block([9.0, 2.0, 1.0], 5), true),
        ("a wall", wall, true),
    ] {
        let scene = obj(text).load("mesh.obj");
        assert_eq!(scene.ground.is_some(), expected, "{what}");
        assert!(scene.environment.is_some(), "{what}");
    }
}

#[test]
fn each_choice_can_be_another() {
    let folder = obj(block([1.0; 3], 1));
    let none = Choices::default();
    let scene = with(&folder, "mesh.obj", &Choices { sky: Some(Sky::None), ..none.clone() });
    assert!(scene.environment.is_none() && scene.ground.is_none());
    warned(&scene, &["mesh.obj", "the picture will be black"]);
    let even = Some(Sky::Even(Vec3::new(1.0, 0.5, 0.25)));
    let scene = with(&folder, "mesh.obj", &Choices { sky: even.clone(), ..none.clone() });
    let sky = scene.environment.as_ref().unwrap();
    assert!(sky.image.is_none() && sky.radiance == Vec3::new(1.0, 0.5, 0.25) && scene.ground.is_some());
    let scene = with(&folder, "mesh.obj", &Choices { ground: Some(false), ..none.clone() });
    assert!(scene.environment.is_some() && scene.ground.is_none() && scene.notes[0].contains("no ground"));
    let folder = folder.with("sky.pfm", [b"PF\n2 1\n-1.0\n".as_slice(), &[0, 0, 128, 63].repeat(6)].concat());
    let sky = Some(Sky::Image(folder.path("sky.pfm")));
    match load_with(&folder.path("mesh.obj"), &Choices { sky, ..none.clone() }) {
        Ok(scene) => assert!(scene.files.contains(&folder.path("sky.pfm"))),
        Err(error) => assert!(error.to_string().contains("sky.pfm"), "{error}"),
    }
    let error =
        load_with(&folder.path("mesh.obj"), &Choices { sky: Some(Sky::Image("no.hdr".into())), ..none.clone() });
    assert_eq!(error.as_ref().unwrap_err().exit_code(), 1);
    assert!(error.unwrap_err().to_string().contains("no.hdr"));

    // A lamp alone lights its model, and may have a sky and a ground.
    let lamp = with_mtl("newmtl m\nKe 1 1 1\n");
    let scene = with(&lamp, "mesh.obj", &Choices { ground: Some(true), ..none.clone() });
    assert!(scene.environment.is_some_and(|sky| sky.image.is_none()) && scene.ground.is_some());
    let scene = with(&lamp, "mesh.obj", &Choices { sky: Some(Sky::None), ..none.clone() });
    assert!(scene.environment.is_none() && scene.ground.is_none());
    let scene = with(&lamp, "mesh.obj", &Choices { sky: Some(Sky::Studio), ..none });
    assert!(scene.environment.is_some() && scene.ground.is_some());
}

#[test]
fn z_up_is_turned_to_y_up_to_the_last_digit() {
    let folder = obj(block([1.0, 2.0, 3.0], 1));
    let scene = with(&folder, "mesh.obj", &Choices { up: Some(Up::Z), ..Choices::default() });
    let turned = scene.objects[0].object_to_world;
    assert_eq!(turned.transform_point3(Vec3::new(0.1, 0.2, 0.3)), Vec3::new(0.1, 0.3, -0.2));
    let (low, high) = scene.model_bounds();
    assert_eq!((low, high), (DVec3::new(0.0, 0.0, -2.0), DVec3::new(1.0, 3.0, 0.0)));
    assert!(scene.notes[0].contains("z up"), "{:?}", scene.notes);
    let y = ground(&scene).unwrap();
    assert!(y < 0.0 && y > -0.01, "{y}");
}

/// Two quads that share an edge, with so many degrees between their normals.
fn fold(degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    format!("v -1 0 0\nv 0 0 0\nv 0 0 -1\nv -1 0 -1\nv {cos} {} 0\nv {cos} {0} -1\nf 1 2 3 4\nf 2 5 6 3\n", -sin)
}

#[test]
fn faces_share_normals_where_the_file_says_nothing() {
    let smooth = |text: String, smooth: Option<f32>| {
        let scene = with(&obj(text), "mesh.obj", &Choices { smooth, ..Choices::default() });
        let noted = scene.notes[0].contains("smooth below");
        assert_eq!(noted, smooth.unwrap_or(40.0) > 0.0 && !scene.meshes[0].normals.is_empty(), "{:?}", scene.notes);
        !scene.meshes[0].normals.is_empty()
    };
    assert!(smooth(fold(30.0), None) && smooth(fold(39.0), None));
    assert!(!smooth(fold(41.0), None) && !smooth(fold(90.0), None));
    assert!(!smooth(block([1.0; 3], 1), None), "a cube is sharp, and costs no normals");
    assert!(!smooth(sheet(|_, _| 0.0), None), "what is flat needs none either");
    // What a file says counts.
    assert!(!smooth(format!("s off\n{}", fold(30.0)), None) && !smooth(format!("s 0\n{}", fold(30.0)), None));
    // But not against who asks.
    assert!(smooth(format!("s off\n{}", fold(30.0)), Some(31.0)) && !smooth(fold(30.0), Some(0.0)));
    assert!(smooth(fold(60.0), Some(61.0)));
    let grouped = with(&obj(format!("s 1\n{}", fold(90.0))), "mesh.obj", &Choices::default());
    assert!(!grouped.meshes[0].normals.is_empty() && !grouped.notes[0].contains("smooth"), "{:?}", grouped.notes);
}

#[test]
fn a_scene_file_asks_for_sky_and_ground() {
    let file = |more: &str| format!("{SENSOR}{more}\n[[object]]\nmesh = \"mesh.obj\"\n");
    let read = |more: &str| obj(TRIANGLE).with("scene.toml", file(more)).load("scene.toml");
    let scene = read("[environment]\nsky = \"studio\"\nradiance = [1, 2, 3]\nrotate = 90");
    let sky = scene.environment.as_ref().unwrap();
    assert_eq!((sky.radiance, sky.rotation), (Vec3::new(1.0, 2.0, 3.0), 90.0));
    assert_eq!(**sky.image.as_ref().unwrap(), EnvironmentImage::studio());
    assert!(scene.ground.is_none() && scene.notes.is_empty());
    let light = "[environment]\nsky = \"studio\"\n";
    let scene = read(&format!("{light}[ground]"));
    let y = ground(&scene).unwrap();
    assert!(y < 0.0 && y > -0.001, "{y}");
    let scene = read(&format!("{light}[ground]\nheight = -2.5\nsize = 30\ndiffuse = [0.1, 0.2, 0.3]"));
    assert_eq!(ground(&scene), Some(-2.5));
    let (low, high) = scene.world_bounds();
    assert!((high.x - low.x - 30.0).abs() < 1e-4 && (high.z - low.z - 30.0).abs() < 1e-4);
    let object = &scene.objects[scene.ground.unwrap() as usize];
    let triangle = &scene.meshes[object.mesh as usize].triangles[0];
    assert_eq!(scene.material_of(object, triangle).lambert, Vec3::new(0.1, 0.2, 0.3));
    assert_eq!(scene.warnings, Vec::<String>::new());
    // The camera that is found frames what stands on the ground.
    let without = obj(TRIANGLE).with("s.toml", format!("{light}[[object]]\nmesh = \"mesh.obj\"\n")).load("s.toml");
    let on_it =
        obj(TRIANGLE).with("s.toml", format!("{light}[ground]\n[[object]]\nmesh = \"mesh.obj\"\n")).load("s.toml");
    assert_eq!(without.sensor, on_it.sensor);

    for (more, at, words) in [
        ("[environment]\nsky = \"night\"", (6, 7), &["night", "studio"][..]),
        ("[environment]\nsky = \"studio\"\nimage = \"a.hdr\"", (6, 7), &["sky", "image"]),
        ("[environment]\nrotate = 3", (5, 1), &["radiance", "sky"]),
        ("[environment]\nsun = 3", (6, 1), &["sun", "studio"]),
        ("[ground]\nsize = 0", (6, 8), &["above 0"]),
        ("[ground]\ndiffuse = [0.5, 0.5, 1.5]", (6, 11), &["0 to 1"]),
        ("[ground]\ndiffuse = 0.5", (6, 11), &["three numbers"]),
        ("[ground]\nheight = inf", (6, 10), &["finite"]),
        ("[ground]\nalbedo = [0.5, 0.5, 0.5]", (6, 1), &["`diffuse`"]),
        ("[grund]", (5, 2), &["grund", "ground"]),
        ("[sky]", (5, 2), &["[environment]", "studio"]),
        ("[[ground]]", (5, 1), &["ground"]),
    ] {
        let error = obj(TRIANGLE).with("scene.toml", file(more)).error("scene.toml");
        let Error::Parse { line, column, message, .. } = &error else { panic!("{error}") };
        assert!(words.iter().all(|word| message.contains(word)), "{more}: {error}");
        assert_eq!((*line, at.1 > 0 && *column > 0), (at.0, true), "{more}: {error}");
    }
}

#[test]
fn choices_change_a_scene_file() {
    let text =
        format!("{SENSOR}[environment]\nimage = \"sky.hdr\"\n[ground]\nheight = -3\n[[object]]\nmesh = \"mesh.obj\"\n");
    let folder = obj(TRIANGLE).with("scene.toml", text);
    let none = Choices::default();
    // The image that is not there is not asked for where another sky is.
    let scene = with(&folder, "scene.toml", &Choices { sky: Some(Sky::Studio), ..none.clone() });
    assert!(scene.environment.unwrap().image.is_some() && scene.ground.is_some());
    let off = Choices { sky: Some(Sky::None), ground: Some(false), ..none.clone() };
    let scene = with(&folder, "scene.toml", &off);
    assert!(scene.environment.is_none() && scene.ground.is_none());
    warned(&scene, &["the picture will be black"]);
    let on = Choices { sky: Some(Sky::Studio), ground: Some(true), ..none.clone() };
    assert_eq!(ground(&with(&folder, "scene.toml", &on)), Some(-3.0));
    let plain = scene_without_ground();
    assert!(ground(&with(&plain, "scene.toml", &on)).is_some());
    for (choices, key) in [
        (Choices { smooth: Some(30.0), ..none.clone() }, "`smooth`"),
        (Choices { up: Some(Up::Z), ..none.clone() }, "`rotate = [-90, 0, 0]`"),
        (Choices { fill: Some(true), ..none.clone() }, "[[luminaire]]"),
        (Choices { view: Some(Side::Back), ..none.clone() }, "[sensor]"),
    ] {
        let error = load_with(&folder.path("scene.toml"), &choices).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(key), "{error}");
    }
}

fn scene_without_ground() -> Folder {
    scene("")
}

/// A closed room with a lamp is black from outside, and gets the sky there; where the lamp is in sight, it lights its model alone.
#[test]
fn a_lamp_that_lights_nothing_that_is_seen_is_not_enough() {
    let mtl = "newmtl lamp\nKe 5 5 5\nnewmtl wall\nKd .5 .5 .5\n";
    let lamp = "usemtl lamp\nv 1 2.9 1\nv 2 2.9 1\nv 2 2.9 2\nv 1 2.9 2\nf -4 -3 -2 -1\nusemtl wall\n";
    let walls = block([3.0; 3], 5);
    let front = "f 9 10 11 12\n";
    assert!(walls.contains(front));
    let room = |walls: &str| obj(format!("mtllib mesh.mtl\n{lamp}{walls}")).with("mesh.mtl", mtl).load("mesh.obj");
    let closed = room(&walls);
    assert!(closed.environment.is_some() && closed.notes[0].contains("beside what emits in it"), "{:?}", closed.notes);
    let open = room(&walls.replace(front, ""));
    // Not on black: a faint grey, of 0.6 times half the lamp's radiance by its share of all areas (1 in 46), to two digits.
    let faint = |scene: &Scene| scene.environment.as_ref().map(|sky| (sky.radiance, sky.image.is_some()));
    assert_eq!(faint(&open), Some((Vec3::splat(0.033), false)), "{:?}", open.notes);
    assert!(open.notes[0].contains("before a faint grey of radiance 0.033, no ground"), "{:?}", open.notes);
    assert!(open.luminaires.is_empty() && open.settings.exposure == Exposure::Auto);
    // Off the room, beside a wall.
    let beside = room("v -1 0 0\nv 4 0 0\nv 4 0 3\nv -1 0 3\nf -4 -1 -2 -3\n");
    assert!(faint(&beside).is_some_and(|(_, image)| !image), "{:?}", beside.notes);
}

/// Models at the limit of what coordinates may be load as they did without a ground, which is smaller then; beyond it is an error, and no panic.
#[test]
fn the_ground_reaches_no_further_than_coordinates_may() {
    let scene =
        obj("v 0 0 0\nv 5e17 0 0\nv 0 5e17 0\nv 0 0 5e17\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n").load("mesh.obj");
    let (low, high) = scene.world_bounds();
    assert!(scene.ground.is_some() && low.abs().max(high.abs()).max_element() < 1e18, "{low} {high}");
    for far in ["2e37", "3e38"] {
        let folder =
            obj(format!("v 0 0 0\nv {far} 0 0\nv 0 {far} 0\nv 0 0 {far}\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"));
        let error = load(&folder.path("mesh.obj")).unwrap_err();
        assert!(error.to_string().contains("is too large; scale the scene"), "{error}");
    }
}

/// The camera goes to the side that is asked for, of a room as well.
#[test]
fn each_side_may_be_looked_at() {
    let folder = obj(block([1.0, 2.0, 3.0], 1));
    for side in Side::ALL {
        let scene = with(&folder, "mesh.obj", &Choices { view: Some(side), ..Choices::default() });
        let towards = (scene.sensor.position - scene.sensor.target).normalize();
        let expected = match side {
            Side::Front => Vec3::Z,
            Side::Back => Vec3::NEG_Z,
            Side::Left => Vec3::NEG_X,
            Side::Right => Vec3::X,
            Side::Top => Vec3::Y,
        };
        assert!(towards.dot(expected) > 0.9, "{side:?}: {towards}");
        assert!(scene.notes[1].contains(side.name()) && scene.notes[0].contains(&format!("--view {}", side.name())));
    }
}

/// A room that no lamp lights gets a lamp at the camera, which stands inside; with lamps it has none, and no sky either.
#[test]
fn a_dark_room_gets_a_lamp_at_the_camera() {
    let corners = |low: [f32; 3], high: [f32; 3]| {
        let mut text = String::new();
        for i in 0..8 {
            let at = |axis: usize| if i >> axis & 1 == 1 { high[axis] } else { low[axis] };
            text += &format!("v {} {} {}\n", at(0), at(1), at(2));
        }
        text
    };
    // Seen from inside: walls face inwards.
    let walls = "f 1 3 7 5\nf 2 6 8 4\nf 1 5 6 2\nf 3 4 8 7\nf 1 2 4 3\nf 5 7 8 6\n";
    let table = "f -8 -4 -2 -6\nf -7 -5 -1 -3\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -6 -5 -7\nf -4 -3 -1 -2\n";
    let room = corners([0.0; 3], [6.0, 3.0, 5.0]) + walls + &corners([1.0, 0.0, 1.0], [2.0, 0.8, 2.0]) + table;
    let dark = obj(&room).load("mesh.obj");
    let Some(Luminaire::Point { position, intensity }) = dark.luminaires.first().cloned() else {
        panic!("{:?}", dark.notes)
    };
    assert_eq!(position, dark.sensor.position);
    // 0.6 of irradiance a few units away.
    assert!((2.0..30.0).contains(&intensity.x) && intensity == Vec3::splat(intensity.x), "{intensity}");
    assert!(dark.notes[0].contains("a lamp at the camera") && dark.notes[1].contains("inside"), "{:?}", dark.notes);
    assert_eq!(dark.settings.exposure, Exposure::Auto);
    let off = with(&obj(&room), "mesh.obj", &Choices { fill: Some(false), ..Choices::default() });
    assert!(off.luminaires.is_empty());
    let lamp = "usemtl lamp\nv 2 2.9 2\nv 4 2.9 2\nv 4 2.9 3\nv 2 2.9 3\nf -4 -3 -2 -1\n";
    let lit = format!("mtllib mesh.mtl\n{room}{lamp}");
    let lit = obj(lit).with("mesh.mtl", "newmtl lamp\nKe 5 5 5\n").load("mesh.obj");
    assert!(
        lit.luminaires.is_empty() && lit.environment.is_none() && lit.notes[1].contains("inside"),
        "{:?}",
        lit.notes
    );
}

/// An object that is a lamp twice goes, and the ground behind it keeps its name.
#[test]
fn the_ground_is_known_after_objects_are_dropped() {
    let lamp = "[[object]]\nmesh = \"mesh.obj\"\n";
    let folder = with_mtl("newmtl m\nKe 1 1 1\n").with("scene.toml", format!("{SENSOR}[ground]\n{lamp}{lamp}"));
    let scene = folder.load("scene.toml");
    warned(&scene, &["dropped"]);
    assert_eq!(scene.objects.len(), 2, "a lamp and the ground");
    assert!(ground(&scene).is_some() && scene.objects[1].name == "ground");
}
