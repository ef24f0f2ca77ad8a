//! What somebody does who comes from Blender, Mitsuba or pbrt, or types in a hurry: each is answered with what is meant.

mod common;

use common::{Folder, stderr};

/// A folder with scenes to be wrong about.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("room.toml", "[[object]]\nmesh = \"good.obj\"\n");
    std::fs::create_dir_all(folder.path().join("scenes")).unwrap();
    folder.write("scenes/box.toml", "[[object]]\nmesh = \"../good.obj\"\n");
    folder
}

/// Runs a command line that must fail with `code`, say every one of `parts`, and leave no file behind.
fn answered(folder: &Folder, line: &str, code: i32, parts: &[&str]) {
    let before = folder.names();
    let words: Vec<&str> = line.split(' ').collect();
    let output = folder.luminaire(&words).output().unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "luminaire {line} said:\n{said}");
    assert!(said.starts_with("error: ") || said.contains("\nerror: "), "luminaire {line} said:\n{said}");
    for part in parts {
        assert!(said.contains(part), "luminaire {line} does not say {part:?}, but:\n{said}");
    }
    assert!(!said.contains("panicked") && !said.contains("to pass '-"), "{line}: {said}");
    assert_eq!(folder.names(), before, "luminaire {line} left files behind");
}

#[test]
fn command_lines() {
    let folder = folder();
    let rows: &[(&str, i32, &[&str])] = &[
        // Subcommands.
        ("room.toml", 2, &["luminaire render room.toml"]),
        ("good.obj -o a.png", 2, &["luminaire render good.obj"]),
        ("--render room.toml", 2, &["has no dashes: luminaire render"]),
        ("--spp 4 render room.toml", 2, &["the subcommand comes first", "--spp"]),
        ("-o a.png room.toml", 2, &["the subcommand comes first: luminaire render"]),
        ("show room.toml", 2, &["luminaire view"]),
        ("rendr room.toml", 2, &["render"]),
        // Arguments.
        ("render room.toml good.obj", 2, &["one scene a run", "luminaire render good.obj"]),
        ("render room.toml out.png", 2, &["luminaire render room.toml -o out.png"]),
        ("render out.png room.toml", 2, &["luminaire render room.toml -o out.png"]),
        ("render -o room.toml out.png", 2, &["room.toml", ".png, .exr or .hdr"]),
        ("render out.png", 2, &["not a scene", "behind -o"]),
        ("render rom.toml", 1, &["there is room.toml"]),
        ("render Room.toml", 1, &["there is room.toml"]),
        ("render scene/box.toml", 1, &["there is no folder scene"]),
        ("render scenes\\box.toml", 1, &["scenes/box.toml", "with /"]),
        ("render scenes", 2, &["folder", "scenes/box.toml"]),
        ("render room", 2, &["there is room.toml"]),
        ("render room.toml -spp 4", 2, &["two dashes: --spp"]),
        ("render room.toml spp=4", 2, &["--spp 4"]),
        ("render room.toml --max_bounces 4", 2, &["--max-bounces"]),
        // Values.
        ("render room.toml --width 1920x1080", 2, &["--width 1920 --height 1080"]),
        ("view room.toml --width 1920,1080", 2, &["--width 1920 --height 1080"]),
        ("render room.toml --height 50%", 2, &["whole number of pixels from 1 to 65536"]),
        ("render room.toml --spp 0", 2, &["from 1"]),
        ("render room.toml --spp 1e3", 2, &["1000"]),
        ("render room.toml --spp 4k", 2, &["4000"]),
        ("render room.toml --samples 64", 2, &["--spp 64", "0..64"]),
        ("render room.toml --samples 0-64", 2, &["say 0..64"]),
        ("render room.toml --seed random", 2, &["from 0 to 4294967295"]),
        ("render room.toml --time 5m", 2, &["300"]),
        ("render room.toml --backend vulkan", 2, &["auto", "luminaire devices"]),
        ("render room.toml --backend gpu", 2, &["auto", "--device"]),
        ("render room.toml --backend cuda", 2, &["through Vulkan"]),
        ("render room.toml --backend optix", 2, &["through Vulkan"]),
        ("render room.toml --backend metal", 2, &["through Vulkan"]),
        ("render room.toml --backend CPU", 2, &["small letters: cpu"]),
        ("view room.toml --backend rtx", 2, &["ray-query"]),
        ("render room.toml --backend llvm_ad_rgb", 2, &["is cpu"]),
        ("render room.toml --device nothing-like-it", 1, &["nothing-like-it"]),
        ("render room.toml --estimator path", 2, &["default"]),
        // Outputs.
        ("render room.toml -o out", 2, &[".png, .exr or .hdr"]),
        ("render room.toml -o out/", 2, &["out/", ".png, .exr or .hdr"]),
        ("render room.toml --output", 2, &["--output <FILE>"]),
        ("render room.toml -o good.obj", 2, &["good.obj", ".png, .exr or .hdr"]),
        // Options of other renderers, and of features that are not built in.
        ("render room.toml --resolution 640x480", 2, &["--width 1920 --height 1080"]),
        ("render room.toml --samples-per-pixel 4", 2, &["--spp 64"]),
        ("render room.toml --threads 4", 2, &["RAYON_NUM_THREADS"]),
        ("render room.toml --gpu", 2, &["--device", "luminaire devices"]),
        ("render room.toml --cpu", 2, &["--backend cpu"]),
        ("render room.toml --max-depth 4", 2, &["--max-bounces"]),
        ("render room.toml --integrator path", 2, &["--estimator"]),
        ("render room.toml --mode scalar", 2, &["--backend"]),
        ("render room.toml --out a.png", 2, &["-o FILE.png"]),
        ("render room.toml --camera main", 2, &["--camera main", "no camera with a name", ".toml"]),
        ("render room.toml --camera none.toml", 1, &["none.toml"]),
        ("render room.toml --fov 40", 2, &["[sensor]", "--camera FILE.toml"]),
        ("bench room.toml --camera main", 2, &["--camera"]),
        ("render room.toml --envmap sky.hdr", 2, &["--sky FILE.hdr", "[[luminaire]]"]),
        ("render room.toml --gamma 2.2", 2, &["--exposure"]),
        ("render room.toml --view-transform AgX", 2, &["--tone", "agx"]),
        ("view room.toml --tonemap filmic", 2, &["--tone", "neutral"]),
        ("render room.toml --tone filmic", 2, &["srgb, agx, neutral"]),
        ("render room.toml --exposure automatic", 2, &["or auto"]),
        ("render room.toml --auto-exposure", 2, &["--exposure auto"]),
        ("render room.toml --format png", 2, &["ending of -o"]),
        ("render room.toml --verbose", 2, &["--stats", "luminaire inspect"]),
        ("render room.toml --frame 3", 2, &["one picture"]),
        ("render room.toml --scene room.toml", 2, &["luminaire render SCENE"]),
        ("render room.toml --noise-threshold 0.1", 2, &["--noise 0.02"]),
        // Options that another subcommand has, and what this one has in their place.
        ("compare a.exr b.exr --threshold 0.1", 2, &["--max-relmse"]),
        ("compare a.exr b.exr --error 0.1", 2, &["--max-relmse"]),
        ("compare a.exr b.exr -o c.png", 2, &["--heatmap FILE.png"]),
        ("compare a.exr b.exr --output c.png", 2, &["--heatmap FILE.png"]),
        ("compare a.exr b.exr --verbose", 2, &["--worst"]),
        ("compare a.exr b.exr --spp 4", 2, &["--spp is an option of `luminaire render`"]),
        ("inspect room.toml --verbose", 2, &["all is said"]),
        ("inspect room.toml --spp 4", 2, &["an option of `luminaire render`"]),
        ("inspect room.toml -o a.png", 2, &["it is printed"]),
        ("stability --seconds 3", 2, &["--list"]),
        ("stability --dir out", 2, &["--out DIR"]),
        ("stability -o out", 2, &["--out DIR"]),
        ("bench -o out", 2, &["--out DIR"]),
        ("bench --time 3", 2, &["--quick"]),
        ("man --out man", 2, &["luminaire man DIR"]),
        ("devices -x", 2, &["-x"]),
        ("view room.toml -o a.png", 2, &["luminaire render SCENE -o FILE.png"]),
        ("view room.toml --time 3", 2, &["--spp N stops it"]),
        ("merge a.exr -o b.exr --quiet", 2, &["an option of `luminaire render`"]),
        // What another subcommand says of the same mistake.
        ("inspect nothere", 1, &["cannot read nothere", "No such file"]),
        ("inspect room.toml --width 999999", 2, &["whole number of pixels from 1 to 65536"]),
        ("inspect room.toml --width 1920x1080", 2, &["--width 1920 --height 1080"]),
        ("inspect room.toml --width 65536 --height 65536", 2, &["2^32"]),
        ("render room.toml --pixel 1,1 --sample 0 --resume", 2, &["cannot be used with", "--resume"]),
        ("render room.toml --samples 0..1 --error-map e.png -o a.exr", 2, &["two samples"]),
        #[cfg(not(feature = "shaderc"))]
        ("render room.toml --watch", 2, &["--features shaderc"]),
        #[cfg(not(feature = "denoise"))]
        ("render room.toml --denoised a.png", 2, &["--features denoise"]),
        #[cfg(not(feature = "denoise"))]
        ("render room.toml --denoise", 2, &["--features denoise", "--aov"]),
    ];
    for (line, code, parts) in rows {
        answered(&folder, line, *code, parts);
    }
}

const SENSOR: &str = "[sensor]\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n";
const OBJECT: &str = "[[object]]\nmesh = \"good.obj\"\n";
const MATERIAL: &str = "[[material]]\nname = \"lamp\"\n";

#[test]
fn scene_files() {
    let folder = folder();
    folder.write("Mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let rows: &[(&str, &str, &[&str])] = &[
        // Tables.
        ("", "[camera]\nfov = 45\n", &["[sensor]"]),
        ("", "[Sensor]\nfov = 45\n", &["write [sensor]"]),
        ("", "[[light]]\ntype = \"area\"\n", &["[[luminaire]]", "`emission`"]),
        ("", "[[mesh]]\nfile = \"good.obj\"\n", &["[[object]]", "mesh ="]),
        ("", "[[sphere]]\nradius = 1\n", &["[[object]]", "meshes alone"]),
        ("", "[[bsdf]]\n", &["[[material]]"]),
        ("", "[world]\ncolor = [1, 1, 1]\n", &["[environment]"]),
        ("", "[[materail]]\nname = \"x\"\n", &["`material`"]),
        ("", "spp = 64\n", &["key of [render]"]),
        ("", "resolution = [640, 480]\n", &["[film]", "`width`"]),
        (
            "",
            "[[sensor]]\nfov = 45\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n[[sensor]]\nfov = 45\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n",
            &["`name`", "--camera"],
        ),
        (
            "",
            "[[sensor]]\nname = \"a\"\nfovy = 45\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n",
            &["in [sensor]", "`fov`"],
        ),
        ("", "[[sensor]]\nname = \"a\"\nfov = 45\ntarget = [0, 0, 0]\n", &["`position`", "the eye point"]),
        (SENSOR, "fov = 45\nname = \" \"\n", &["needs a `name`"]),
        (SENSOR, "fov = 45\nname = 3\n", &["string"]),
        (SENSOR, "fov = 45\n[sensor]\nfov = 30\n", &["duplicate", "[[sensor]]", "`name`"]),
        (SENSOR, "fov = 45\n[[sensor]]\nfov = 30\n", &["duplicate", "[[sensor]]", "`name`"]),
        ("", "sensor = [3]\n", &["a line [sensor]"]),
        (SENSOR, "fov = 45\nshift_y = 0.2\n", &["`shift = [x, y]`"]),
        (SENSOR, "fov = 45\nprincipal_point_offset_x = 0.2\n", &["`shift = [x, y]`"]),
        (SENSOR, "fov = 45\nshift = 0.2\n", &["two numbers [x, y]"]),
        (SENSOR, "fov = 45\nshift = [0.2, 0.1, 0]\n", &["expected two numbers, found 3"]),
        (SENSOR, "fov = 45\nshift = [0, 101]\n", &["from -100 to 100"]),
        (SENSOR, "fov = 45\nshift = [0, nan]\n", &["from -100 to 100"]),
        ("", "[material]\nname = \"x\"\n", &["[[material]]"]),
        ("", "film = [640, 480]\n", &["a line [film]"]),
        ("", "object = \"good.obj\"\n", &["a line [[object]]"]),
        ("", "<scene version=\"3.0.0\">\n</scene>\n", &["XML", "TOML"]),
        ("", "{ \"film\": {} }\n", &["JSON", "TOML"]),
        ("", "LookAt 0 0 1  0 0 0  0 1 0\n", &["pbrt", "TOML"]),
        ("", "[film]\nwidth: 512\n", &["YAML"]),
        ("", "[environment]\nimage = \"\"\n", &["names no file"]),
        // Keys.
        ("", "[film]\nresolution = [640, 480]\n", &["`width = 1920`", "`height = 1080`"]),
        ("", "[film]\nspp = 64\n", &["key of [render]"]),
        ("", "[film]\nWidth = 64\n", &["write `width`"]),
        ("", "[film]\nwidht = 64\n", &["did you mean `width`?"]),
        ("", "[film]\nfilename = \"a.png\"\n", &["-o FILE.png"]),
        ("", "[render]\nsamples = 64\n", &["`spp`"]),
        ("", "[render]\nmax_depth = 4\n", &["`max_bounces`", "[integrator]"]),
        ("", "[render]\nwidth = 64\n", &["key of [film]"]),
        ("", "[render]\nengine = \"cycles\"\n", &["--backend"]),
        ("", "[integrator]\ntype = \"path\"\n", &["`kind`"]),
        ("", "[integrator]\nmax-bounces = 3\n", &["write `max_bounces`"]),
        (SENSOR, "fov = 45\norigin = [0, 0, 3]\n", &["`position`"]),
        (SENSOR, "fov = 45\nlook_at = [0, 0, 3]\n", &["`target`"]),
        (SENSOR, "fov_x = 45\n", &["vertical"]),
        (SENSOR, "focal_length = 50\n", &["`fov`", "vertical"]),
        (SENSOR, "fov = 45\nfstop = 2.8\n", &["`aperture`"]),
        (SENSOR, "fov = 45\nwidth = 640\n", &["key of [film]"]),
        (SENSOR, "fov = 45\nclip_start = 0.1\n", &["nothing is clipped"]),
        (MATERIAL, "specular_roughness = 0.5\n", &["`roughness`", "GGX"]),
        (MATERIAL, "metalness = 1.0\n", &["`metallic`", "`conductor`"]),
        (MATERIAL, "base_color = [1, 0, 0]\n", &["write `base_colour`"]),
        (MATERIAL, "baseColorFactor = [1, 0, 0, 1]\n", &["write `base_colour`"]),
        (MATERIAL, "transmission_weight = 1\n", &["write `transmission`"]),
        (MATERIAL, "coat = 1\n", &["`clearcoat`"]),
        (MATERIAL, "sheen = 1\n", &["`sheen_colour`"]),
        (MATERIAL, "orm = \"a.png\"\n", &["channel = \"g\""]),
        (MATERIAL, "subsurface = 1\n", &["not modelled"]),
        (MATERIAL, "roughnes = 1\n", &["did you mean `roughness`?"]),
        (MATERIAL, "base_colour_texture = \"a.png\"\n", &["`base_colour_map`;"]),
        (MATERIAL, "roughness_texture = \"a.png\"\n", &["`roughness_map`;"]),
        (MATERIAL, "clearcoat_ior = 1.5\n", &["of index 1.5", "leave it out"]),
        (MATERIAL, "coat_tint = [1, 1, 1]\n", &["leave it out"]),
        (MATERIAL, "clearcoat_normal_map = \"a.png\"\n", &["its normals are those of the surface"]),
        (MATERIAL, "iridescence_thickness_minimum = 100\n", &["`iridescence_thickness = [least, greatest]`"]),
        (MATERIAL, "normal_strength = 1\n", &["`normal_scale`"]),
        (MATERIAL, "bump_strength = 1\n", &["`bump_scale`"]),
        (MATERIAL, "bump_distance = 1\n", &["`bump_scale`"]),
        (MATERIAL, "alpha_map = \"a.png\"\n", &["`opacity_map`"]),
        (MATERIAL, "occlusion_map = \"a.png\"\n", &["not modelled"]),
        // Within a map and a metal.
        (
            MATERIAL,
            "roughness_map = { image = \"a.png\", chanel = \"g\" }\n",
            &["`chanel` of a map", "mean `channel`?"],
        ),
        (MATERIAL, "roughness_map = { image = \"a.png\", channel = \"green\" }\n", &["it is called \"g\""]),
        (MATERIAL, "roughness_map = { image = \"a.png\", channel = \"G\" }\n", &["write \"g\""]),
        (MATERIAL, "roughness_map = { file = \"a.png\" }\n", &["`file` of a map", "named by `image`"]),
        (MATERIAL, "roughness_map = { channel = \"g\" }\n", &["`image`", "the name of the picture"]),
        (MATERIAL, "roughness_map = { image = \"a.png\", scale = 2 }\n", &["two numbers [x, y]"]),
        (MATERIAL, "roughness_map = { image = \"a.png\", scale = [0, 2] }\n", &["other than 0"]),
        (MATERIAL, "roughness_map = { image = \"a.png\", offset = [1, 2, 3] }\n", &["two numbers, found 3"]),
        (MATERIAL, "roughness_map = 3\n", &["the name of an image, or { image ="]),
        (MATERIAL, "conductor = { eta = [1, 1, 1] }\n", &["`k`", "extinction coefficient"]),
        (MATERIAL, "conductor = { ior = [1, 1, 1] }\n", &["`ior` of a conductor", "is `eta`"]),
        (MATERIAL, "conductor = { eta = [1, 1, 1], k = [-1, 0, 0] }\n", &["negative"]),
        (MATERIAL, "conductor = { eta = [1, 1, 1], k = 2 }\n", &["[2, 2, 2]"]),
        (MATERIAL, "conductor = 3\n", &["the name of a metal, or { eta ="]),
        (MATERIAL, "iridescence_thickness = [1, 2, 3]\n", &["two numbers, found 3"]),
        (MATERIAL, "iridescence_thickness = [1, -2]\n", &["nanometres of at least 0"]),
        (MATERIAL, "iridescence_thickness = \"thin\"\n", &["nanometres, or two of them"]),
        (MATERIAL, "transmission = \"1\"\n", &["without quotes: 1"]),
        (MATERIAL, "model = 1\n", &["a name between quotes"]),
        (MATERIAL, "conductor = \"Au\"\n", &["it is called \"gold\""]),
        (MATERIAL, "conductor = \"Gold\"\n", &["write \"gold\""]),
        (MATERIAL, "model = \"pbr\"\n", &["\"metallic-roughness\""]),
        (MATERIAL, "model = \"phong\"\n", &["\"blinn-phong\""]),
        (MATERIAL, "Kd = [1, 0, 0]\n", &["`diffuse`"]),
        (MATERIAL, "Ks = [1, 1, 1]\n", &["`glossy`", "`specular`"]),
        (MATERIAL, "Ni = 1.5\n", &["`eta`", "`ior`"]),
        (MATERIAL, "alpha = 0.5\n", &["`opacity`"]),
        (MATERIAL, "emission_strength = 5\n", &["`emission`"]),
        (MATERIAL, "texture = \"wood.png\"\n", &["`diffuse_map`"]),
        (MATERIAL, "displacement_map = \"n.png\"\n", &["not modelled"]),
        (MATERIAL, "type = \"diffuse\"\n", &["no kind"]),
        (OBJECT, "position = [0, 1, 0]\n", &["`translate`"]),
        (OBJECT, "rotation = [0, 90, 0]\n", &["`rotate`"]),
        (OBJECT, "emission = [1, 1, 1]\n", &["[[material]]"]),
        ("", "[[object]]\nfile = \"good.obj\"\n", &["`mesh`"]),
        ("", "[environment]\ncolor = [1, 1, 1]\n", &["`radiance`"]),
        ("", "[environment]\nfilename = \"sky.hdr\"\n", &["`image`"]),
        // Names.
        ("", "[[luminaire]]\nkind = \"area\"\n", &["a mesh whose material emits"]),
        ("", "[[luminaire]]\nkind = \"spotlight\"\n", &["\"spot\"", "`outer_angle`"]),
        ("", "[[luminaire]]\nkind = \"projector\"\n", &["no such light"]),
        ("", "[[luminaire]]\nkind = \"ies\"\n", &["`profile`"]),
        ("", "[[luminaire]]\nkind = \"sun\"\n", &["\"infinite\""]),
        ("", "[[luminaire]]\nkind = \"envmap\"\n", &["[environment]"]),
        ("", "[[luminaire]]\nkind = 1\n", &["a name between quotes"]),
        ("", "[[luminaire]]\nposition = [0, 1, 0]\n", &["`kind`", "\"spot\""]),
        ("", "[[luminaire]]\nkind = \"spot\"\nspot_angle = 30\n", &["`outer_angle`"]),
        ("", "[[luminaire]]\nkind = \"Point\"\n", &["write \"point\""]),
        ("", "[[luminaire]]\nkind = \"point\"\nposition = [0, 1, 0]\npower = 60\n", &["`intensity`", "4 pi"]),
        (SENSOR, "fov = 45\nkind = \"thinlens\"\n", &["`aperture`"]),
        (SENSOR, "height = 2\nkind = \"ortho\"\n", &["\"orthographic\""]),
        ("", "[integrator]\nkind = \"bdpt\"\n", &["no such integrator"]),
        ("", "[integrator]\nestimator = \"mis\"\n", &["\"default\""]),
        ("", "[render]\nsampler = \"Sobol\"\n", &["write \"sobol\""]),
        ("", "[render]\nsampler = \"halton\"\n", &["\"sobol\""]),
        ("", "[film]\nfilter = \"mitchell\"\n", &["\"gaussian\""]),
        // Values.
        (SENSOR, "fov = \"45\"\n", &["without quotes: 45"]),
        ("", "[film]\nwidth = \"640\"\n", &["without quotes: 640"]),
        ("", "[film]\nwidth = -640\n", &["1 to 65536 pixels"]),
        ("", "[film]\nwidth = 640.5\n", &["whole number"]),
        ("", "[render]\nspp = 0\n", &["1 to 4294967295"]),
        ("", "[sensor]\nposition = [0, 0, 3]\nfov = 45\n", &["`target`", "the middle of the picture"]),
        ("", "[sensor]\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\nfov = 45\n", &["parallel", "another up"]),
        ("", "[sensor]\nposition = [0, 3, 0]\ntarget = [0, 3, 0]\nfov = 45\n", &["the same point"]),
        ("", "[sensor]\nposition = \"0 0 3\"\ntarget = [0, 0, 0]\nfov = 45\n", &["in brackets"]),
        (SENSOR, "", &["`fov`", "degrees"]),
        (MATERIAL, "diffuse = 0.5\n", &["[0.5, 0.5, 0.5]"]),
        (MATERIAL, "diffuse = \"#ff8000\"\n", &["[1.0000, 0.2159, 0.0000]"]),
        (MATERIAL, "diffuse = [0.5, 0.5, 0.5, 1]\n", &["three numbers, found 4"]),
        (MATERIAL, "diffuse = [-1, 0, 0]\n", &["negative"]),
        ("", "[[object]]\nmesh = \"C:\\models\\good.obj\"\n", &["'single quotes'"]),
        ("", "[[object]]\nmesh = '.\\good.obj'\n", &["./good.obj", "with /"]),
        ("", "[[object]]\nmesh = \"\"\n", &["empty name", "an OBJ file"]),
        ("", "[[object]]\nmesh = \"goood.obj\"\n", &["there is good.obj"]),
        ("", "[[object]]\nmesh = \"mesh.obj\"\n", &["there is Mesh.obj"]),
        ("", "[[object]]\nmesh = good.obj\n", &["quoted"]),
        (OBJECT, "scale = [1, 2]\n", &["three numbers"]),
        (OBJECT, "matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n", &["rows of four"]),
        (OBJECT, "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]\n", &["[0, 0, 0, 1]"]),
    ];
    for (before, text, parts) in rows {
        let scene = format!("{before}{text}{}", if text.contains("object") || *before == OBJECT { "" } else { OBJECT });
        folder.write("wrong.toml", &scene);
        // With file and line.
        let at = format!("error: {}", "wrong.toml:");
        answered(&folder, "inspect wrong.toml", 1, &[&[at.as_str()][..], parts].concat());
    }
}

/// What is a guess is a warning, and the scene loads.
#[test]
fn angles_in_radians_are_warned_of() {
    let folder = folder();
    let said = |text: String| {
        folder.write("angle.toml", &text);
        let output = folder.luminaire(&["inspect", "angle.toml"]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stderr(&output) + &String::from_utf8_lossy(&output.stdout)
    };
    assert!(said(format!("{SENSOR}fov = 0.7854\n{OBJECT}")).contains("if radians are meant, write 45.0"));
    let turned = said(format!("{SENSOR}fov = 45\n{OBJECT}rotate = [0, 1.5708, 0]\n"));
    assert!(turned.contains("angle.toml:5: ") && turned.contains("if radians are meant, write [0, 90, 0]"), "{turned}");
    assert!(!said(format!("{SENSOR}fov = 45\n{OBJECT}rotate = [0, 90, 0]\n")).contains("radians"));
    let lamp = format!("{OBJECT}material = \"lamp\"\n{MATERIAL}anisotropy = 0.5\n");
    for (text, words) in [
        (
            format!("{lamp}anisotropy_rotation = 1.5708\n"),
            "`anisotropy_rotation` is in degrees; if radians are meant, write 90",
        ),
        (
            format!("[environment]\nsky = \"studio\"\nrotate = 1.5708\n{OBJECT}"),
            "`rotate` is in degrees; if radians are meant, write 90",
        ),
        (format!("{OBJECT}smooth = 0.698\n"), "if radians are meant, write 40"),
        (
            format!("{SENSOR}fov = 45\naperture = 0.1\nblades = 6\nblade_rotation = 0.5236\n{OBJECT}"),
            "`blade_rotation` is in degrees; if radians are meant, write 30",
        ),
    ] {
        let found = said(text.clone());
        assert!(found.contains("angle.toml:") && found.contains(words), "{text}: {found}");
    }
    assert!(!said(format!("{lamp}anisotropy_rotation = 90\n")).contains("radians"));
    // Four rows as others write them are three.
    let matrix = "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
    assert!(!said(format!("{SENSOR}fov = 45\n{OBJECT}{matrix}")).contains("error"));
}
