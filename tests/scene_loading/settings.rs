//! Scene files: how the scene is seen and rendered.

use super::*;
use glam::Vec3;
use luminaire::scene::{
    AreaSampling, Directions, Environment, Estimator, Exposure, Extinction, Filter, Integrator, Lens, LightChoice,
    LightSampling, PRESETS, Projection, Sampler, Tone,
};

const OBJECT: &str = "[[object]]\nmesh = \"mesh.obj\"\n";

/// A scene file of these tables and the triangle.
fn tables(text: &str) -> Scene {
    obj(TRIANGLE).with("scene.toml", format!("{OBJECT}{LIGHT}{text}")).load("scene.toml")
}

#[test]
fn sensors_are_perspective_or_orthographic() {
    let sensor = |rest: &str| tables(&format!("[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 1]\n{rest}")).sensor;
    assert_eq!(sensor("fov = 33\n").projection, Projection::Perspective { fov: 33.0 });
    assert_eq!(sensor("kind = \"perspective\"\nfov = 33\n").projection, Projection::Perspective { fov: 33.0 });
    let orthographic = sensor("kind = \"orthographic\"\nheight = 2.5\n");
    assert_eq!((orthographic.projection, orthographic.lens), (Projection::Orthographic { height: 2.5 }, None));
    let telecentric = sensor("kind = \"orthographic\"\nheight = 2.5\naperture = 0.5\nblades = 5\n");
    let lens = Lens { radius: 0.5, focus_distance: 4.0, blades: 5, rotation: 0.0 };
    assert_eq!((telecentric.projection, telecentric.lens), (Projection::Orthographic { height: 2.5 }, Some(lens)));
    let lens = sensor("fov = 33\naperture = 0.5\n").lens;
    assert_eq!(
        lens,
        Some(Lens { radius: 0.5, focus_distance: 4.0, blades: 0, rotation: 0.0 }),
        "focused on the target"
    );
    let lens = sensor("fov = 33\naperture = 0.5\nfocus_distance = 7\nblades = 6\nblade_rotation = -15\n").lens;
    assert_eq!(lens, Some(Lens { radius: 0.5, focus_distance: 7.0, blades: 6, rotation: -15.0 }));
    assert_eq!(sensor("fov = 33\naperture = 0\nblades = 6\n").lens, None, "a closed aperture is a pinhole");
}

#[test]
fn sensors_that_make_no_sense() {
    let at = |rest: &str| format!("[sensor]\nposition = [0, 0, 5]\ntarget = [0, 0, 1]\n{rest}");
    toml_fails(&at(""), (1, 1), &["`fov`"]);
    toml_fails(&at("kind = \"orthographic\"\n"), (1, 1), &["`height`"]);
    toml_fails(&at("fov = 3\nheight = 2\n"), (5, 10), &["orthographic"]);
    toml_fails(&at("kind = \"orthographic\"\nheight = 2\nfov = 3\n"), (6, 7), &["perspective"]);
    toml_fails(&at("kind = \"fisheye\"\n"), (4, 8), &["fisheye", "orthographic"]);
    toml_fails(&at("kind = \"orthographic\"\nheight = 0\n"), (5, 10), &["above 0"]);
    toml_fails(&at("kind = \"orthographic\"\nheight = 1\nblades = 5\n"), (6, 10), &["aperture"]);
    toml_fails(&at("fov = 3\naperture = -1\n"), (5, 12), &["at least 0"]);
    toml_fails(&at("fov = 3\naperture = 1\nfocus_distance = 0\n"), (6, 18), &["above 0"]);
    toml_fails(&at("fov = 3\naperture = 1\nblades = 2\n"), (6, 10), &["3 to 64"]);
    for key in ["focus_distance = 1", "blades = 5", "blade_rotation = 5"] {
        let column = key.find('=').expect("a key and a value") + 3;
        toml_fails(&at(&format!("fov = 3\n{key}\n")), (5, column), &["aperture"]);
    }
}

#[test]
fn filters_have_a_radius() {
    for (text, filter, radius) in [
        ("", Filter::Box, 0.5),
        ("filter = \"box\"\n", Filter::Box, 0.5),
        ("filter = \"tent\"\n", Filter::Tent, 1.0),
        ("filter = \"gaussian\"\nfilter_radius = 2.5\n", Filter::Gaussian, 2.5),
        ("filter = \"blackman-harris\"\n", Filter::BlackmanHarris, 1.5),
    ] {
        let film = tables(&format!("[film]\n{text}")).film;
        assert_eq!((film.filter, film.filter_radius), (filter, radius), "{text}");
    }
    toml_fails("[film]\nfilter_radius = 0\n", (2, 17), &["above 0"]);
    toml_fails("[film]\nfilter_radius = 65\n", (2, 17), &["at most 64"]);
}

#[test]
fn estimators_by_name_and_by_parts() {
    let integrator = |text: &str| tables(&format!("[integrator]\n{text}")).integrator;
    let path = |text: &str| match integrator(text) {
        Integrator::Path(estimator) => estimator,
        simple => panic!("{simple:?}"),
    };
    assert_eq!(path(""), Estimator::default());
    assert_eq!(path("kind = \"path\"\nestimator = \"default\"\n"), Estimator::default());
    for (name, estimator) in PRESETS {
        assert_eq!(path(&format!("estimator = \"{name}\"\n")), estimator, "{name}");
    }
    let parts = "light_sampling = \"direct\"\narea_sampling = \"area\"\nlight_choice = \"tree\"\ndirections = \"uniform\"\nextinction = \"off\"\n\
                 albedo_threshold = 0.01\nmax_bounces = 3\nsmooth_terminator = true\n";
    let expected = Estimator {
        light_sampling: LightSampling::Direct,
        area_sampling: AreaSampling::Area,
        light_choice: LightChoice::Tree,
        directions: Directions::Uniform,
        extinction: Extinction::Off,
        albedo_threshold: Some(0.01),
        smooth_terminator: true,
        max_bounces: Some(3),
    };
    assert_eq!(path(parts), expected);
    let cosine = Estimator::preset("cosine").expect("a preset");
    let mixed = path("estimator = \"cosine\"\nlight_sampling = \"mis\"\n");
    assert_eq!(mixed, Estimator { light_sampling: LightSampling::Mis, ..cosine });
    for simple in ["kind = \"simple\"\n", "estimator = \"simple\"\n", "kind = \"simple\"\nestimator = \"simple\"\n"] {
        let ambient = integrator(&format!("{simple}ambient = [1, 2, 3]\n"));
        assert_eq!(ambient, Integrator::Simple { ambient: Vec3::new(1.0, 2.0, 3.0) }, "{simple}");
    }
}

#[test]
fn what_an_estimator_ignores_is_named() {
    let warnings = |lines: &str| {
        let warnings = tables(&format!("[integrator]\n{lines}")).warnings;
        warnings.iter().filter(|warning| warning.contains("does not sample luminaires")).count()
    };
    assert_eq!(warnings("light_sampling = \"none\"\nlight_choice = \"tree\"\narea_sampling = \"area\"\n"), 2);
    assert_eq!(warnings("estimator = \"no-light-sampling\"\nlight_choice = \"auto\"\n"), 1);
    assert_eq!(warnings("estimator = \"no-light-sampling\"\n"), 0);
    assert_eq!(warnings("light_choice = \"tree\"\narea_sampling = \"area\"\n"), 0);
}

#[test]
fn estimators_that_make_no_sense() {
    let fails = |text: &str, at, words: &[&str]| toml_fails(&format!("[integrator]\n{text}\n"), at, words);
    fails("estimator = \"photon\"", (2, 13), &["`photon`", "`simple`, `default`", "`literal-extinction`"]);
    fails("light_sampling = \"some\"", (2, 18), &["some", "mis"]);
    fails("extinction = \"off\"", (2, 14), &["max_bounces"]);
    fails("albedo_threshold = 2", (2, 20), &["from 0 to 1"]);
    fails("kind = \"simple\"\nestimator = \"cosine\"", (3, 13), &["contradicts"]);
    fails("kind = \"path\"\nestimator = \"simple\"", (3, 13), &["contradicts"]);
    fails("estimator = \"simple\"\ndirections = \"uniform\"", (3, 14), &["`directions`", "simple"]);
    fails("ambient = [1, 1, 1]", (2, 11), &["simple"]);
}

#[test]
fn samplers_are_named() {
    assert_eq!(tables("[render]\nsampler = \"independent\"\n").settings.sampler, Sampler::Independent);
    toml_fails("[render]\nsampler = \"dice\"\n", (2, 11), &["dice", "independent"]);
}

#[test]
fn how_a_picture_is_shown() {
    let settings = |text: &str| tables(&format!("[render]\n{text}")).settings;
    assert_eq!((settings("").exposure, settings("").tone), (Exposure::Stops(0.0), Tone::Srgb));
    for tone in Tone::ALL {
        assert_eq!(settings(&format!("tone = \"{}\"\n", tone.name())).tone, tone);
    }
    assert_eq!(settings("exposure = \"auto\"\n").exposure, Exposure::Auto);
    assert_eq!(settings("exposure = -2\n").exposure, Exposure::Stops(-2.0));
    assert_eq!(settings("exposure = 0.5\n").exposure, Exposure::Stops(0.5));
    toml_fails("[render]\nexposure = \"bright\"\n", (2, 12), &["-64 to 64", "\"auto\""]);
    toml_fails("[render]\nexposure = 65\n", (2, 12), &["-64 to 64"]);
    toml_fails("[render]\nexposure = true\n", (2, 12), &["-64 to 64", "\"auto\""]);
    toml_fails("[render]\ntone = \"filmic\"\n", (2, 8), &["filmic", "\"agx\""]);
    toml_fails("[render]\ntone = \"Standard\"\n", (2, 8), &["Standard", "\"srgb\""]);
    toml_fails("[render]\ntone = \"khronos\"\n", (2, 8), &["\"neutral\""]);
    toml_fails("[render]\ntone = \"agcs\"\n", (2, 8), &["agx", "neutral"]);
    toml_fails("[render]\nview_transform = \"AgX\"\n", (2, 1), &["`tone`", "\"agx\""]);
    toml_fails("[film]\ntone_mapping = true\n", (2, 1), &["`tone` in [render]"]);
    toml_fails("[film]\ngamma = 2.2\n", (2, 1), &["`exposure`", "`tone`"]);
    toml_fails("[render]\nauto_exposure = true\n", (2, 1), &["exposure = \"auto\""]);
}

/// A scene without luminaires but with these tables.
fn dark(text: &str) -> Folder {
    obj(TRIANGLE).with("scene.toml", format!("{SENSOR}{OBJECT}{text}"))
}

fn exr(path: &Path, texels: &[[f32; 3]], width: u32) {
    luminaire::picture::save_linear(path, width, texels.len() as u32 / width, &texels.concat(), 0.0).expect("an EXR");
}

#[test]
fn an_environment_lights_a_scene() {
    let constant = dark("[environment]\nradiance = [1, 2, 3]\n").load("scene.toml");
    let expected = Environment { radiance: Vec3::new(1.0, 2.0, 3.0), image: None, rotation: 0.0 };
    assert_eq!((constant.environment, constant.warnings), (Some(expected), vec![]), "no warning that it is black");

    let folder = dark("[environment]\nimage = \"sub/sky.exr\"\nrotate = -90\n").with("sub/x", "");
    exr(&folder.path("sub/sky.exr"), &[[1.0, 2.0, 3.0], [0.0, 7e6, 0.5]], 2);
    let scene = folder.load("scene.toml");
    assert_eq!(scene.warnings, Vec::<String>::new());
    let environment = scene.environment.expect("an environment");
    assert_eq!((environment.radiance, environment.rotation), (Vec3::ONE, -90.0));
    let image = environment.image.expect("an image");
    assert_eq!((image.name.as_str(), image.width, image.height), ("sky.exr", 2, 1));
    assert_eq!(image.texels, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 7e6, 0.5)], "beyond half precision");
}

#[test]
fn an_environment_of_eight_bits_is_srgb() {
    let folder = dark("[environment]\nradiance = [2, 2, 2]\nimage = \"sky.png\"\n");
    image::RgbImage::from_raw(1, 1, vec![255, 188, 0]).expect("a size").save(folder.path("sky.png")).expect("a PNG");
    let environment = folder.load("scene.toml").environment.expect("an environment");
    let texel = environment.image.expect("an image").texels[0];
    assert!(texel.distance(Vec3::new(1.0, 0.502_886, 0.0)) < 1e-5, "{texel}");
    assert_eq!(environment.radiance, Vec3::splat(2.0));
}

#[test]
fn odd_environments_are_repaired_or_dropped() {
    let sky = |texels: &[[f32; 3]]| {
        let folder = dark("[environment]\nimage = \"sky.exr\"\n");
        exr(&folder.path("sky.exr"), texels, 1);
        folder.load("scene.toml")
    };
    let odd = sky(&[[f32::NAN, 1.0, -2.0], [4.0, f32::INFINITY, 0.0]]);
    let texels = odd.environment.clone().expect("an environment").image.expect("an image").texels.clone();
    assert_eq!(texels, [Vec3::new(0.0, 1.0, 0.0), Vec3::new(4.0, 4.0, 0.0)]);
    warned(&odd, &["sky.exr", "1 texels", "negative or NaN"]);
    warned(&odd, &["sky.exr", "infinite"]);
    let black = sky(&[[0.0; 3], [-1.0; 3]]);
    assert_eq!(black.environment, None);
    warned(&black, &["sky.exr", "black"]);
    warned(&black, &["picture will be black"]);
    let off = dark("[environment]\nradiance = [0, 0, 0]\n").load("scene.toml");
    assert_eq!(off.environment, None);
    warned(&off, &["radiance is 0"]);
}

#[test]
fn environments_that_make_no_sense() {
    toml_fails("[environment]\n", (1, 1), &["`radiance`", "`image`"]);
    toml_fails("[environment]\nradiance = [1, 1, 1]\nrotate = 3\n", (3, 10), &["`image`"]);
    toml_fails("[environment]\nradiance = [1, -1, 1]\n", (2, 12), &["negative"]);
    toml_fails(&format!("{OBJECT}[environment]\nimage = \"no.exr\"\n"), (4, 9), &["no.exr", "No such file"]);
    let damaged = format!("{OBJECT}[environment]\nimage = \"sky.hdr\"\n");
    let folder = obj(TRIANGLE).with("scene.toml", damaged).with("sky.hdr", "#?RADIANCE\nnothing");
    folder.fails_at("scene.toml", "scene.toml", (4, 9), &["sky.hdr"]);
}

/// The header alone decides: nothing follows it here.
#[test]
fn an_environment_has_only_so_many_texels() {
    let sky = |width: u32, height: u32| {
        let scene = format!("{OBJECT}[environment]\nimage = \"sky.ppm\"\n");
        obj(TRIANGLE).with("scene.toml", scene).with("sky.ppm", format!("P6 {width} {height} 255\n"))
    };
    sky(16_384, 8193).fails_at("scene.toml", "scene.toml", (4, 9), &["sky.ppm", "134234112 texels", "134217728"]);
    let error = sky(16_384, 16).error("scene.toml").to_string();
    assert!(!error.contains("texels"), "damaged, but not too large: {error}");
}

#[test]
fn luminaires_that_are_never_met_are_dark() {
    let scene = tables("[integrator]\nestimator = \"no-light-sampling\"\n");
    warned(&scene, &["ever meets", "will be black"]);
    let lit = tables("[integrator]\nestimator = \"no-light-sampling\"\n[environment]\nradiance = [1, 1, 1]\n");
    assert!(!lit.warnings.iter().any(|warning| warning.contains("black")), "{:?}", lit.warnings);
}

/// What single precision cannot draw is said: a telescope with something beside it, or a picture of coordinates that have no digits left.
#[test]
fn cameras_beyond_single_precision_are_named() {
    let with = |sensor: &str, object: &str| {
        let text = format!("{sensor}{LIGHT}[[object]]\nmesh = \"mesh.obj\"\n[[object]]\nmesh = \"mesh.obj\"\n{object}");
        obj(TRIANGLE).with("scene.toml", text).load("scene.toml").blurred_because()
    };
    let far = "[sensor]\nposition = [0, 0, 7e5]\ntarget = [0.2, 0.2, 0]\nfov = 5e-5\n";
    assert_eq!(with(far, ""), None);
    let beside = with(far, "translate = [1, 0, 7e5]\n").expect("a warning");
    assert!(beside.contains("single precision"), "{beside}");
    let away = "[sensor]\nkind = \"orthographic\"\nposition = [5e6, 0, 5]\ntarget = [5e6, 0, 0]\nheight = 2\n";
    let moved = with(away, "translate = [5e6, 0, 0]\n");
    assert!(moved.is_some(), "no digits are left");
    for near in [
        SENSOR,
        "[sensor]\nposition = [0.5, 0.5, 0]\ntarget = [0.5, 0.5, -1]\nfov = 90\n",
        "[sensor]\nposition = [0.5, 0.5, 3000]\ntarget = [0.5, 0.5, 0]\nfov = 0.05\n",
        "[sensor]\nkind = \"orthographic\"\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nheight = 0.001\n",
    ] {
        assert_eq!(with(near, "translate = [30, 0, 20]\n"), None, "{near}");
    }
}
