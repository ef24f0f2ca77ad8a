//! Scene files.

use super::*;
use glam::{Affine3A, Vec3};
use luminaire::scene::{Estimator, Exposure, Integrator, Luminaire, Projection};

#[test]
fn a_minimal_scene_file_has_the_documented_defaults() {
    let scene = scene("").load("scene.toml");
    assert_eq!((scene.film.width, scene.film.height), (512, 512));
    assert_eq!((scene.settings.spp, scene.settings.seed, scene.settings.exposure), (64, 0, Exposure::Stops(0.0)));
    assert_eq!(scene.integrator, Integrator::Path(Estimator::default()));
    assert_eq!((scene.environment.clone(), scene.sensor.lens), (None, None));
    assert_eq!((scene.sensor.up, scene.objects[0].name.as_str()), (Vec3::Y, "mesh"));
    assert_eq!(scene.objects[0].object_to_world, Affine3A::IDENTITY);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn every_key_is_read() {
    let text = "\u{feff}[film]\r\nwidth = 30\r\nheight = 20\r\nfilter = \"box\"\r\n[sensor]\r\nposition = [0, 1, 5.5]\r\n\
                target = [0, 0, 0]\r\nup = [1, 0, 0]\r\nfov = 33\r\n[integrator]\r\nkind = \"path\"\r\nmax_bounces = 7\r\n\
                [render]\r\nspp = 9\r\nseed = 4294967295\r\nexposure = -1.5\r\n[[object]]\r\nmesh = \"sub/mesh.obj\"\r\n\
                name = \"x\"\r\nmaterial = \"y\"\r\n[[material]]\r\nname = \"y\"\r\nambient = [0.1, 0.1, 0.1]\r\n\
                diffuse = [0.2, 0.2, 0.2]\r\nglossy = [0.3, 0.3, 0.3]\r\nexponent = 40\r\nemission = [1, 2, 3]\r\n\
                reflection = [0.125, 0.125, 0.125]\r\ntransmission = [0.25, 0.25, 0.25]\r\neta = 1.25\r\nthin = true\r\n\
                impulse_probability = 0.75\r\nopacity = 0.5\r\none_sided = true\r\n\
                [[luminaire]]\r\nkind = \"infinite\"\r\ndirection = [0, -2, 0]\r\nirradiance = [1, 2, 3]\r\n";
    let scene = Folder::new().with("sub/mesh.obj", TRIANGLE).with("scene.toml", text).load("scene.toml");
    assert_eq!((scene.film.width, scene.film.height), (30, 20));
    assert_eq!((scene.sensor.position, scene.sensor.up), (Vec3::new(0.0, 1.0, 5.5), Vec3::X));
    assert_eq!(scene.sensor.projection, Projection::Perspective { fov: 33.0 });
    assert_eq!(scene.integrator, Integrator::Path(Estimator { max_bounces: Some(7), ..Estimator::default() }));
    assert_eq!(
        (scene.settings.spp, scene.settings.seed, scene.settings.exposure),
        (9, u32::MAX, Exposure::Stops(-1.5))
    );
    assert_eq!(scene.objects[0].name, "x");
    let y = &scene.materials[scene.objects[0].material.expect("y") as usize];
    assert_eq!((y.ambient.x, y.lambert.x, y.glossy.x, y.exponent), (0.1, 0.2, 0.3, 40.0));
    assert_eq!((y.reflection.x, y.transmission.x, y.eta, y.thin), (0.125, 0.25, Some(1.25), true));
    assert_eq!((y.impulse_probability, y.opacity, y.one_sided), (Some(0.75), 0.5, true));
    let light = Luminaire::Infinite { direction: Vec3::NEG_Y, irradiance: Vec3::new(1.0, 2.0, 3.0) };
    assert_eq!(scene.luminaires, [light]);
    assert_eq!(scene.warnings, Vec::<String>::new());
}

#[test]
fn a_mesh_named_twice_is_loaded_once() {
    let scene = scene("[[object]]\nmesh = \"./mesh.obj\"\nscale = [-1, 1, 1]\n").load("scene.toml");
    assert_eq!((scene.meshes.len(), scene.objects.len()), (1, 2));
    assert_eq!(scene.triangle_count(), 2);
    assert!(scene.objects[1].object_to_world.matrix3.determinant() < 0.0, "mirrored");
}

#[test]
fn transforms_scale_then_rotate_about_x_y_z_then_translate() {
    let scene = scene("scale = [2, 3, 4]\nrotate = [90, 90, 0]\ntranslate = [10, 0, 0]\n").load("scene.toml");
    let to_world = scene.objects[0].object_to_world;
    // x is left alone by the turn about x and goes to -z about y; y goes to z about x and then to x about y.
    for (from, to) in [
        (Vec3::X, Vec3::new(10.0, 0.0, -2.0)),
        (Vec3::Y, Vec3::new(13.0, 0.0, 0.0)),
        (Vec3::Z, Vec3::new(10.0, -4.0, 0.0)),
    ] {
        assert!(to_world.transform_point3(from).distance(to) < 1e-5, "{from} -> {}", to_world.transform_point3(from));
    }
}

#[test]
fn a_matrix_is_three_rows() {
    let scene = scene("matrix = [[0, -1, 0, 5], [2, 0, 0, 6], [0, 0, 1, 7]]\n").load("scene.toml");
    let to_world = scene.objects[0].object_to_world;
    assert_eq!(to_world.transform_point3(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(3.0, 8.0, 10.0));
}

#[test]
fn materials_are_overridden_by_name() {
    let folder = Folder::new()
        .with("a.obj", format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}usemtl lost\nv 1 1 0\nf 2 3 4\n"))
        .with("a.mtl", "newmtl m\nKd .5 .4 .3\nKe 0 0 0\n")
        .with("b.obj", format!("mtllib b.mtl\nusemtl m\n{TRIANGLE}"))
        .with("b.mtl", "newmtl m\nKd .1 .1 .1\n")
        .with("c.obj", TRIANGLE)
        .with(
            "scene.toml",
            format!(
                "{SENSOR}[[object]]\nmesh = \"a.obj\"\n[[object]]\nmesh = \"b.obj\"\ntranslate = [0, 0, 1]\n\
                 [[object]]\nmesh = \"c.obj\"\ntranslate = [0, 0, 2]\n[[material]]\nname = \"m\"\nemission = [5, 5, 5]\n[[material]]\nname = \"lost\"\ndiffuse = [0.25, 0.0, 0.0]\n\
                 [[material]]\nname = \"default\"\ndiffuse = [0.3, 0.3, 0.3]\n[[material]]\nname = \"typo\"\n"
            ),
        );
    let scene = folder.load("scene.toml");
    let of = |object: usize, triangle: usize| {
        let object = &scene.objects[object];
        scene.material_of(object, &scene.meshes[object.mesh as usize].triangles[triangle])
    };
    assert_eq!((of(0, 0).lambert, of(0, 0).emission), (Vec3::new(0.5, 0.4, 0.3), Vec3::splat(5.0)));
    assert_eq!(
        (of(1, 0).lambert, of(1, 0).emission),
        (Vec3::splat(0.1), Vec3::splat(5.0)),
        "every material of that name"
    );
    assert_eq!(
        (of(0, 1).name.as_str(), of(0, 1).lambert.x),
        ("lost", 0.25),
        "the scene file defines what the MTL lacks"
    );
    assert_eq!((of(2, 0).name.as_str(), of(2, 0).lambert.x), ("default", 0.3));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    warned(&scene, &["`typo`", "not used"]);
}

#[test]
fn what_changes_the_fallback_is_unused_where_nothing_shows_it() {
    let change = "[[material]]\nname = \"default\"\ndiffuse = [0.3, 0.3, 0.3]\n";
    let scene_file = format!("{SENSOR}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n{change}");
    let warnings = |mtl: &str| with_mtl(mtl).with("scene.toml", &scene_file).load("scene.toml").warnings;
    let said = warnings("newmtl m\nKd .5 .5 .5\n");
    assert!(said.len() == 1 && said[0].contains("`default`") && said[0].contains("not used"), "{said:?}");
    assert_eq!(warnings("newmtl m\nKd .5 .5 .5\nnewmtl default\nKd 1 0 0\n"), Vec::<String>::new());
    assert_eq!(scene(change).load("scene.toml").warnings, Vec::<String>::new());
}

#[test]
fn an_object_takes_the_material_of_its_own_mtl_first() {
    let folder = Folder::new()
        .with("a.obj", format!("mtllib a.mtl\n{TRIANGLE}"))
        .with("a.mtl", "newmtl m\nKd .5 .5 .5\n")
        .with("b.obj", format!("mtllib b.mtl\n{TRIANGLE}"))
        .with("b.mtl", "newmtl m\nKd .1 .1 .1\n")
        .with(
            "scene.toml",
            format!(
                "{SENSOR}{LIGHT}[[object]]\nmesh = \"a.obj\"\nmaterial = \"m\"\n[[object]]\nmesh = \"b.obj\"\nmaterial = \"m\"\n"
            ),
        );
    let scene = folder.load("scene.toml");
    let albedo = |object: usize| scene.materials[scene.objects[object].material.expect("m") as usize].lambert.x;
    assert_eq!((albedo(0), albedo(1)), (0.5, 0.1));
}

#[test]
fn what_is_missing_from_a_scene_file_is_said() {
    let text = "[[object]]\nmesh = \"mesh.obj\"\n";
    let scene = obj(TRIANGLE).with("scene.toml", text).load("scene.toml");
    warned(&scene, &["no [sensor]"]);
    warned(&scene, &["will be black"]);
    let ambient = format!("{SENSOR}[integrator]\nkind = \"simple\"\nambient = [1, 1, 1]\n{text}");
    let scene = obj(TRIANGLE).with("scene.toml", ambient).load("scene.toml");
    assert_eq!(scene.warnings, Vec::<String>::new(), "ambient light shows something");
}

#[test]
fn unknown_keys_are_found_with_line_and_column() {
    toml_fails("[film]\nwidth = 3\n  heigth = 4\n", (3, 3), &["heigth", "height"]);
    toml_fails("[cameras]\n", (1, 2), &["cameras"]);
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nscales = 3\n", (3, 1), &["scales"]);
    toml_fails("[[luminaire]]\nkind = \"area\"\n", (2, 8), &["area", "point", "infinite"]);
    toml_fails("[film]\nfilter = \"gauss\"\n", (2, 10), &["gauss", "box"]);
    toml_fails("[integrator]\nkind = \"bidirectional\"\n", (2, 8), &["bidirectional"]);
}

#[test]
fn wrong_toml_is_found_with_line_and_column() {
    toml_fails("[film]\nwidth = = 3\n", (2, 9), &[]);
    toml_fails("[film]\nwidth = 3\nwidth = 4\n", (3, 1), &["duplicate"]);
    toml_fails("[[object]]\nname = \"x\"\n", (1, 1), &["missing field", "mesh"]);
    toml_fails("[film]\nwidth = \"wide\"\n", (2, 9), &["expected"]);
    toml_fails("# \u{e9}\u{e9}\n[film]\nwidth = 1.5\n", (3, 9), &[]);
    let mut bytes = b"[film]\nwidth = 3 # ".to_vec();
    bytes.extend([0xe9, b'\n']);
    Folder::new().with("scene.toml", bytes).fails_at("scene.toml", "scene.toml", (2, 0), &["UTF-8"]);
}

#[test]
fn numbers_out_of_range_are_found_with_line_and_column() {
    let sensor = |key: &str, value: &str| {
        let text = "[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n";
        let line = text.lines().find(|line| line.starts_with(key)).expect("a line with the key");
        text.replace(line, &format!("{key} = {value}"))
    };
    toml_fails("[film]\nwidth = 0\n", (2, 9), &["1 to 65536"]);
    toml_fails("[film]\nheight = 65537\n", (2, 10), &["1 to 65536"]);
    toml_fails("[film]\nwidth = -1\n", (2, 9), &["1 to 65536"]);
    toml_fails("[film]\nwidth = 65536\nheight = 65536\n", (1, 1), &["2^32"]);
    toml_fails("[render]\nspp = 0\n", (2, 7), &["1 to"]);
    toml_fails("[render]\nseed = -1\n", (2, 8), &["from 0 to 4294967295"]);
    toml_fails("[render]\nexposure = nan\n", (2, 12), &["-64 to 64"]);
    toml_fails(&sensor("fov", "0"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("fov", "180"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("fov", "nan"), (5, 7), &["between 0 and 180"]);
    toml_fails(&sensor("position", "[0, inf, 0]"), (2, 12), &["finite"]);
    toml_fails(&sensor("position", "[0, 1e300, 0]"), (2, 12), &["finite"]);
    toml_fails(&sensor("position", "[0, 1]"), (2, 12), &["three numbers, found 2"]);
    toml_fails(&sensor("position", "[0, 1, 2, 3]"), (2, 12), &["three numbers, found 4"]);
    toml_fails("[[material]]\nname = \"m\"\ndiffuse = [0.5, -0.1, 0]\n", (3, 11), &["negative"]);
    toml_fails("[[material]]\nname = \"m\"\nexponent = -1\n", (3, 12), &["at least 0"]);
    toml_fails("[[material]]\nname = \"m\"\neta = 0\n", (3, 7), &["from 0.01 to 100"]);
    toml_fails("[[material]]\nname = \"m\"\neta = 0.0099\n", (3, 7), &["from 0.01 to 100"]);
    toml_fails("[[material]]\nname = \"m\"\neta = 100.1\n", (3, 7), &["from 0.01 to 100"]);
    toml_fails("[[material]]\nname = \"m\"\neta = inf\n", (3, 7), &["from 0.01 to 100"]);
    toml_fails("[[material]]\nname = \"m\"\nexponent = 1.1e8\n", (3, 12), &["at most 1e8"]);
    toml_fails("[[material]]\nname = \"m\"\nexponent = nan\n", (3, 12), &["at most 1e8"]);
    toml_fails("[[material]]\nname = \"m\"\nopacity = 1.5\n", (3, 11), &["from 0 to 1"]);
    toml_fails("[[material]]\nname = \"m\"\nimpulse_probability = -0.1\n", (3, 23), &["above 0 and below 1"]);
    toml_fails("[[material]]\nname = \"m\"\nimpulse_probability = 1\n", (3, 23), &["above 0 and below 1"]);
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nsmooth = 181\n", (3, 10), &["0 to 180"]);
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nscale = \"big\"\n", (3, 9), &["a number or three numbers"]);
    toml_fails("[integrator]\nkind = \"path\"\nmax_bounces = -1\n", (3, 15), &["0 to 1000000"]);
    toml_fails("[integrator]\nextinction = \"off\"\nmax_bounces = 4294967295\n", (3, 15), &["0 to 1000000"]);
}

#[test]
fn the_extremes_of_material_numbers_are_accepted() {
    for (eta, exponent) in [(0.01, 0.0), (100.0, 1e8)] {
        let material =
            format!("material = \"m\"\n[[material]]\nname = \"m\"\neta = {eta:?}\nexponent = {exponent:?}\n");
        let loaded = scene(&material).load("scene.toml");
        let m = loaded.materials.iter().find(|m| m.name == "m").expect("the material");
        assert_eq!((m.eta, m.exponent), (Some(eta), exponent));
    }
}

#[test]
fn impossible_cameras() {
    let object = "[[object]]\nmesh = \"mesh.obj\"\n";
    let camera = |rest: &str| format!("{object}[sensor]\nposition = [0, 0, 5]\nfov = 40\n{rest}");
    toml_fails(&camera("target = [0, 0, 5]\n"), (3, 1), &["same point"]);
    toml_fails(&camera("target = [0, 3, 5]\n"), (3, 1), &["parallel"]);
    toml_fails(&camera("target = [0, 0, 0]\nup = [0, 0, -2]\n"), (3, 1), &["parallel"]);
    toml_fails(&camera("target = [0, 0, 0]\nup = [0, 0, 0]\n"), (3, 1), &["zero vector"]);
}

#[test]
fn transforms_that_cannot_be_inverted() {
    for transform in [
        "scale = 0",
        "scale = [1, 0, 1]",
        "scale = 1e-30",
        "matrix = [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]]",
        "matrix = [[0.1, 0.2, 0.3, 0], [0.3, 0.6, 0.9, 0], [0.7, 0.1, 0.4, 0]]",
    ] {
        toml_fails(&format!("[[object]]\nmesh = \"mesh.obj\"\n{transform}\n"), (1, 1), &["cannot be inverted"]);
    }
    let both = "[[object]]\nmesh = \"mesh.obj\"\nscale = 2\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n";
    toml_fails(both, (1, 1), &["either"]);
}

#[test]
fn small_and_large_transforms_are_fine() {
    for transform in ["scale = 1e-9", "scale = 1e9", "scale = [1e-6, 1e6, 1]"] {
        assert_eq!(scene(&format!("{transform}\n")).load("scene.toml").objects.len(), 1, "{transform}");
    }
}

#[test]
fn a_mesh_that_is_missing_or_wrong_is_named() {
    toml_fails("\n[[object]]\nmesh = \"no.obj\"\n", (3, 8), &["no.obj", "No such file"]);
    toml_fails("[[object]]\nmesh = \"mesh.off\"\n", (2, 8), &["mesh.off", ".obj"]);
    toml_fails("[[object]]\nmesh = \"no.glb\"\n", (2, 8), &["no.glb", "No such file"]);
    toml_fails("[[object]]\nmesh = \"scene.toml\"\n", (2, 8), &["scene.toml", ".obj"]);
    let folder = obj("v 0 0 0\nv 0 0 nan\n").with("scene.toml", "[[object]]\nmesh = \"mesh.obj\"\n");
    folder.fails_at("scene.toml", "mesh.obj", (2, 0), &["not finite"]);
}

#[test]
fn a_scene_without_objects() {
    let error = Folder::new().with("scene.toml", SENSOR).error("scene.toml");
    assert!(matches!(&error, Error::Scene { message, .. } if message.contains("[[object]]")), "{error}");
    assert!(matches!(Folder::new().with("scene.toml", "").error("scene.toml"), Error::Scene { .. }));
}

#[test]
fn materials_and_luminaires_that_make_no_sense() {
    toml_fails("[[object]]\nmesh = \"mesh.obj\"\nmaterial = \"gold\"\n", (3, 12), &["`gold`"]);
    toml_fails("[[material]]\nname = \"m\"\n[[material]]\nname = \"m\"\n", (4, 8), &["second", "`m`"]);
    toml_fails("[[luminaire]]\nkind = \"point\"\nposition = [0, 0, 0]\n", (1, 1), &["`position` and `intensity`"]);
    let mixed =
        "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, 1, 0]\nirradiance = [1, 1, 1]\nposition = [0, 0, 0]\n";
    toml_fails(mixed, (5, 1), &["`position` is too much", "`direction` and `irradiance`"]);
    let zero = "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, 0, 0]\nirradiance = [1, 1, 1]\n";
    toml_fails(zero, (1, 1), &["zero vector"]);
    toml_fails("[integrator]\nkind = \"path\"\nambient = [1, 1, 1]\n", (3, 11), &["simple"]);
    toml_fails("[integrator]\nkind = \"simple\"\nmax_bounces = 1\n", (3, 15), &["path"]);
}
