//! Words that other renderers have for what a scene file says, and what stands for them here.

/// A table of a scene file and some words that are none of its keys, with what is meant instead. An empty name stands for every table.
type Words = (&'static str, &'static [&'static str], &'static str);

/// Keys in small letters with underscores. The first row that fits is taken.
pub(super) const KEYS: &[Words] = &[
    // Outside of every table, or a table of another name.
    (
        "",
        &["camera", "cameras", "view", "perspective"],
        "the camera is the table [sensor]; several are [[sensor]], each with a `name`",
    ),
    (
        "top",
        &["light", "lights", "lamp", "lamps", "emitter", "emitters", "luminaires", "sun", "point_light"],
        "a light without an area is a [[luminaire]]; a lamp with an area is a mesh whose material has `emission`",
    ),
    (
        "top",
        &[
            "mesh",
            "meshes",
            "shape",
            "shapes",
            "model",
            "models",
            "geometry",
            "objects",
            "instance",
            "instances",
            "node",
            "nodes",
        ],
        "what is seen is an [[object]] with `mesh = \"FILE.obj\"`",
    ),
    ("top", &["floor", "ground_plane", "shadow_catcher"], "a level sheet under the scene is the table [ground]"),
    (
        "top",
        &["sphere", "cube", "plane", "quad", "disk", "cylinder", "rectangle", "triangle"],
        "there are meshes alone: an [[object]] with `mesh = \"FILE.obj\"` (scenes/shapes has some)",
    ),
    ("top", &["bsdf", "bsdfs", "materials", "shader", "shaders", "brdf"], "a surface is a [[material]], by its name"),
    (
        "top",
        &["texture", "textures", "image", "images"],
        "an image is named by a [[material]]: `diffuse_map = \"FILE\"`",
    ),
    (
        "top",
        &["background", "world", "sky", "envmap", "environment_map", "hdri", "skybox", "ambient_light"],
        "light from all around is the table [environment]; `sky = \"studio\"` there is a built-in one",
    ),
    (
        "top",
        &["resolution", "size", "output", "picture", "screen"],
        "the picture's size is `width` and `height` in [film]",
    ),
    ("top", &["settings", "options", "renderer", "quality"], "samples, seed and exposure are in [render]"),
    (
        "top",
        &["scene", "include", "import"],
        "the tables stand for themselves, with nothing around them, and a scene is one file",
    ),
    // [film]
    (
        "film",
        &["resolution", "size", "res", "dimensions", "xresolution", "yresolution", "x", "y"],
        "write `width = 1920` and `height = 1080`",
    ),
    (
        "",
        &["file", "filename", "output", "file_format", "format"],
        "the picture is named on the command line: `luminaire render SCENE -o FILE.png`",
    ),
    (
        "film",
        &["gamma", "srgb", "brightness", "iso", "imaging_ratio"],
        "a PNG is sRGB by itself; how bright it is says `exposure` in [render], and by which curve `tone`",
    ),
    // [sensor]
    (
        "sensor",
        &["origin", "eye", "from", "location", "pos", "look_from", "lookfrom", "translate"],
        "the eye point is `position`",
    ),
    (
        "sensor",
        &["look_at", "lookat", "to", "direction", "at", "forward", "center", "centre", "look"],
        "the point in the middle of the picture is `target`",
    ),
    (
        "sensor",
        &["fov_x", "hfov", "horizontal_fov", "fovx", "fov_axis", "xfov", "angle_x"],
        "`fov` is the vertical field of view in degrees: 2 atan(tan(horizontal / 2) height / width)",
    ),
    (
        "sensor",
        &["fovy", "fov_y", "vfov", "yfov", "angle", "field_of_view", "vertical_fov"],
        "the vertical field of view in degrees is `fov`",
    ),
    (
        "sensor",
        &["focal_length", "lens", "sensor_width", "sensor_height", "film_size"],
        "`fov` is the vertical field of view in degrees: 2 atan(height of the sensor / (2 focal length))",
    ),
    (
        "sensor",
        &["fstop", "f_stop", "f_number", "aperture_radius", "lens_radius", "lensradius", "aperture_size", "dof"],
        "the radius of the opening is `aperture`, in the unit of the scene (focal length / (2 f-number))",
    ),
    (
        "sensor",
        &["focus", "focal_distance", "focaldistance", "focus_dist"],
        "the distance that is in focus is `focus_distance`",
    ),
    (
        "sensor",
        &[
            "shift_x",
            "shift_y",
            "lens_shift",
            "vertical_shift",
            "tilt_shift",
            "principal_point_offset",
            "principal_point_offset_x",
            "principal_point_offset_y",
            "screen_window",
            "offset",
        ],
        "`shift = [x, y]` shifts the picture, by so many of its widths to the right and of its heights upwards",
    ),
    ("sensor", &["id", "label", "camera", "title"], "what --camera calls it is its `name`"),
    (
        "sensor",
        &["near", "far", "near_clip", "far_clip", "clip_start", "clip_end", "znear", "zfar"],
        "nothing is clipped: leave it out",
    ),
    (
        "sensor",
        &["rotation", "rotate", "to_world", "transform", "matrix", "quaternion", "euler", "yaw", "pitch", "roll"],
        "the camera stands by `position`, `target` and `up`; `luminaire view` writes them with the key C",
    ),
    (
        "sensor",
        &["ortho_scale", "size", "zoom"],
        "with kind = \"orthographic\", `height` says how much of the scene the picture shows",
    ),
    ("", &["type"], "write `kind` where there are kinds"),
    (
        "",
        &[
            "tonemap",
            "tonemapping",
            "tone_map",
            "tone_mapping",
            "tonemapper",
            "tone_mapper",
            "tone_curve",
            "view_transform",
            "viewtransform",
            "filmic",
            "agx",
            "aces",
            "look",
            "color_management",
            "colour_management",
            "display_transform",
        ],
        "the tone curve is `tone` in [render]: \"srgb\" (none), \"agx\" or \"neutral\"",
    ),
    (
        "",
        &["auto_exposure", "autoexposure", "exposure_mode", "metering"],
        "the exposure is found with `exposure = \"auto\"` in [render]",
    ),
    // [render]
    (
        "",
        &[
            "samples",
            "sample_count",
            "samplecount",
            "samples_per_pixel",
            "num_samples",
            "pixelsamples",
            "pixel_samples",
            "aa",
            "aa_samples",
        ],
        "samples a pixel are `spp` in [render]",
    ),
    (
        "",
        &["max_depth", "maxdepth", "depth", "bounces", "max_path_depth", "max_ray_depth", "rr_depth"],
        "the limit of indirect bounces is `max_bounces` in [integrator]; 0 is direct light alone",
    ),
    (
        "render",
        &["engine", "device", "backend", "gpu", "cpu", "threads"],
        "what traces is said on the command line: --backend and --device",
    ),
    (
        "render",
        &["time", "time_limit", "max_time", "noise", "noise_threshold", "adaptive"],
        "what ends a render besides `spp` is said on the command line: --time or --noise",
    ),
    (
        "render",
        &["denoise", "denoiser", "denoised"],
        "that is said on the command line: --denoised, in a program that is built with it (`cargo build --release --features denoise`)",
    ),
    ("render", &["gamma", "brightness", "ev", "stops", "iso"], "brightness is `exposure`, in stops or \"auto\""),
    // [integrator]
    ("integrator", &["name", "method", "preset", "mode"], "a stage of the lecture by its name is `estimator`"),
    (
        "integrator",
        &["nee", "next_event_estimation", "direct_light", "mis", "light_strategy"],
        "how light is found is `light_sampling`: \"none\", \"direct\" or \"mis\"",
    ),
    (
        "integrator",
        &["russian_roulette", "rr", "roulette"],
        "how chance ends a path is `extinction`: \"throughput\" is Russian roulette",
    ),
    // [environment]
    (
        "environment",
        &["color", "colour", "strength", "intensity", "scale", "energy", "emission", "l", "power"],
        "how bright it is says `radiance`, three numbers",
    ),
    ("environment", &["map", "texture", "hdri", "path", "filename", "file", "envmap"], "the image is named by `image`"),
    ("environment", &["rotation", "angle", "to_world"], "degrees about +y are `rotate`"),
    (
        "environment",
        &["preset", "studio", "sun", "sunsky", "sun_sky", "sunlight", "day", "turbidity", "gradient"],
        "the built-in sky is `sky = \"studio\"`; others are an `image`",
    ),
    // [ground]
    (
        "ground",
        &["albedo", "color", "colour", "kd", "reflectance", "grey", "gray"],
        "the diffuse albedo is `diffuse`, three numbers from 0 to 1",
    ),
    ("ground", &["y", "z", "level", "position", "altitude", "elevation", "offset"], "its y is `height`"),
    ("ground", &["width", "scale", "extent", "radius", "edge", "length"], "the length of an edge is `size`"),
    (
        "ground",
        &["material", "bsdf", "texture", "diffuse_map", "glossy", "reflection"],
        "the ground is diffuse; one of another material is an [[object]] with a mesh of its own",
    ),
    // [[object]]
    ("object", &["obj", "model", "shape", "path", "geometry", "filename", "file"], "the OBJ file is named by `mesh`"),
    ("object", &["position", "location", "origin", "translation", "offset"], "where it stands is `translate`"),
    (
        "object",
        &["rotation", "rotation_euler", "angles", "euler", "orientation"],
        "degrees about x, y and z are `rotate`",
    ),
    ("object", &["size", "scaling"], "a number or [x, y, z] is `scale`"),
    ("object", &["transform", "to_world", "toworld", "transformation"], "three rows of four numbers are `matrix`"),
    (
        "object",
        &["bsdf", "shader", "materials", "brdf"],
        "the material that replaces all others is `material`, by its name",
    ),
    (
        "object",
        &["color", "colour", "diffuse", "emission", "emissive", "roughness"],
        "that is said of a material: a [[material]] with a `name`, and here `material = \"NAME\"`",
    ),
    (
        "object",
        &["smooth_angle", "auto_smooth", "smoothing", "shade_smooth"],
        "normals by angle are `smooth`, in degrees",
    ),
    ("object", &["visible", "hide", "hidden", "enabled"], "what is not to be seen is left out: put # before its lines"),
    // [[material]]
    (
        "material",
        &[
            "color",
            "colour",
            "base_color",
            "basecolor",
            "albedo",
            "kd",
            "reflectance",
            "diffuse_color",
            "diffuse_reflectance",
        ],
        "the diffuse albedo is `diffuse`, linear RGB",
    ),
    (
        "material",
        &["roughness", "alpha_x", "uroughness", "glossiness", "specular_roughness"],
        "a glossy lobe is `glossy` (its albedo) and `exponent` (of Blinn-Phong, about 2 / roughness^4 - 2 for a Principled BSDF's roughness)",
    ),
    (
        "material",
        &["metallic", "metalness", "metal", "conductor", "k"],
        "there are no microfacets: a polished metal is `reflection` of its colour, a rough one `glossy` with `exponent`, both with `diffuse = [0, 0, 0]`",
    ),
    (
        "material",
        &["specular", "ks", "specular_color", "specular_reflectance", "spec", "glossy_color"],
        "the glossy albedo is `glossy`, a mirror `reflection`",
    ),
    (
        "material",
        &["shininess", "ns", "phong_exponent", "specular_exponent", "hardness"],
        "the Blinn-Phong exponent is `exponent`",
    ),
    (
        "material",
        &["ior", "int_ior", "index_of_refraction", "refractive_index", "ni", "index"],
        "the index of refraction is `eta`",
    ),
    (
        "material",
        &["emissive", "ke", "emission_color", "emission_strength", "radiance", "emit", "emissive_factor", "light"],
        "emitted radiance is `emission`, three numbers",
    ),
    (
        "material",
        &["alpha", "d", "transparency", "tr", "dissolve"],
        "how much of the light meets the surface is `opacity`, from 0 (a hole) to 1; clear glass is `transmission` and `eta`",
    ),
    (
        "material",
        &["glass", "refraction", "dielectric", "transmittance", "specular_transmittance", "tf"],
        "glass is `transmission` (its colour) and `eta`",
    ),
    ("material", &["mirror", "kr", "reflectivity"], "a mirror is `reflection`, three numbers"),
    (
        "material",
        &["texture", "map_kd", "diffuse_texture", "base_color_texture", "color_map", "image", "map"],
        "an image that multiplies `diffuse` is `diffuse_map`",
    ),
    (
        "material",
        &["bump", "map_bump", "height", "height_map", "heightmap", "bumpmap", "bump_texture"],
        "an image of heights is `bump_map`, with the length of a height of 1 as `bump_scale`",
    ),
    (
        "material",
        &["normal", "norm", "normalmap", "normal_texture", "map_kn"],
        "an image of normals is `normal_map`, with its strength as `normal_scale`",
    ),
    (
        "material",
        &["displacement", "displacement_map", "disp"],
        "displacement is not modelled: `bump_map` bends the normals alone, or make the mesh finer",
    ),
    (
        "material",
        &["two_sided", "twosided", "double_sided", "doublesided", "backface_culling"],
        "surfaces have two sides; lamps that shine on one side alone are `one_sided = true`",
    ),
    (
        "material",
        &["kind", "bsdf", "illum", "model", "type", "shader"],
        "a material has no kind: its albedos say what it is (`diffuse`, `glossy`, `reflection`, `transmission`)",
    ),
    (
        "material",
        &["subsurface", "sheen", "clearcoat", "coat", "anisotropic", "anisotropy", "specular_tint"],
        "that is not modelled: leave it out",
    ),
    // [[luminaire]]
    (
        "luminaire",
        &[
            "power",
            "energy",
            "strength",
            "watts",
            "scale",
            "brightness",
            "emission",
            "radiance",
            "color",
            "colour",
            "intensities",
        ],
        "a point has `intensity` (power / (4 pi), three numbers), light at infinity `irradiance`",
    ),
    ("luminaire", &["location", "origin", "from", "translate", "pos"], "where a point is says `position`"),
    (
        "luminaire",
        &["to", "target", "rotation", "angle", "look_at"],
        "the direction in which light at infinity travels is `direction`",
    ),
    (
        "luminaire",
        &["radius", "size", "shape", "mesh"],
        "a lamp with an area is an [[object]] whose material has `emission`",
    ),
];

/// Names in small letters of what a key chooses from; the first word is one of the names that it has here.
pub(super) const NAMES: &[Words] = &[
    (
        "point",
        &[
            "area",
            "mesh",
            "rect",
            "rectangle",
            "quad",
            "disk",
            "sphere",
            "emitter",
            "emissive",
            "diffuse_area",
            "diffuse",
        ],
        "a lamp with an area is a mesh whose material emits: an [[object]], and `emission` in its [[material]]",
    ),
    (
        "point",
        &["spot", "spotlight", "projector", "goniometric", "ies", "cone"],
        "there is no such light: a small mesh whose material has `emission`, in a shade",
    ),
    (
        "point",
        &["sun", "directional", "distant", "directionallight", "parallel"],
        "light at infinity is \"infinite\", with `direction` and `irradiance`",
    ),
    (
        "point",
        &["environment", "envmap", "constant", "sky", "dome", "background", "hdri", "ambient"],
        "light from all around is the table [environment]",
    ),
    ("point", &["pointlight", "omni", "bulb"], "it is called \"point\", with `position` and `intensity`"),
    (
        "perspective",
        &["thinlens", "pinhole", "thin_lens", "realistic"],
        "it is \"perspective\", and with `aperture` it has a lens",
    ),
    ("perspective", &["ortho", "parallel"], "it is called \"orthographic\", with `height`"),
    (
        "perspective",
        &["panorama", "panoramic", "spherical", "fisheye", "equirectangular"],
        "there is no such camera: \"perspective\" or \"orthographic\"",
    ),
    (
        "path",
        &["pathtracer", "path_tracing", "pathtracing", "pt", "volpath", "cycles", "unidirectional"],
        "path tracing is \"path\"",
    ),
    (
        "path",
        &["bdpt", "mlt", "photon", "sppm", "vcm", "ptracer", "pssmlt"],
        "there is no such integrator: \"path\" or \"simple\"",
    ),
    (
        "path",
        &["direct", "whitted", "directlighting", "ao", "eevee"],
        "direct light alone is `max_bounces = 0`, or the simple ray tracer, \"simple\"",
    ),
    (
        "sobol",
        &[
            "halton",
            "paddedsobol",
            "zsobol",
            "stratified",
            "multijitter",
            "ldsampler",
            "low_discrepancy",
            "orthogonal",
            "blue_noise",
        ],
        "points that are spread evenly are \"sobol\" (Owen-scrambled)",
    ),
    ("sobol", &["random", "uniform", "pcg"], "plain random numbers are \"independent\""),
    (
        "box",
        &["mitchell", "lanczos", "catmullrom", "sinc"],
        "filters with negative parts are not sampled: \"gaussian\" or \"blackman-harris\"",
    ),
    ("box", &["triangle", "linear", "bilinear"], "it is called \"tent\""),
    (
        "srgb",
        &["standard", "none", "off", "linear", "raw", "gamma", "clamp", "default", "view", "display"],
        "a PNG without a curve is \"srgb\"",
    ),
    (
        "srgb",
        &[
            "filmic",
            "aces",
            "aces_filmic",
            "film",
            "hable",
            "uncharted2",
            "reinhard",
            "punchy",
            "log",
            "auto",
            "agx_base",
            "blender",
            "high_contrast",
        ],
        "the curve that is like film is \"agx\", as Blender has it",
    ),
    (
        "srgb",
        &["khronos", "pbr_neutral", "pbrneutral", "khronos_pbr_neutral", "commerce", "true_view"],
        "it is called \"neutral\"",
    ),
    ("simple", &["path", "pathtracer", "mis"], "the path tracer is \"default\""),
];
