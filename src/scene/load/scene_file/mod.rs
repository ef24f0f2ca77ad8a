//! A bare model as a scene file, to be changed: what was chosen for it, and every key with what it means.

mod groups;
mod maps;
mod materials;
mod physical;
mod relief;
mod words;

use super::bare_mesh::{self, BareMesh, Z_UP};
use super::choices::{Choices, Sky, Up};
use super::{finish, ground, with_what_is_there};
use crate::scene::{Luminaire, Projection, Scene};
use crate::{Error, Result};
use glam::Vec3;
use std::path::Path;
use words::{exact, number, path as named, point, quoted, triple};

/// A bare model's scene file.
#[derive(Debug)]
pub struct SceneFile {
    /// The scene file.
    pub text: String,
    /// The scene that it describes.
    pub scene: Scene,
}

/// The scene file that says what [`load_with`](super::load_with) makes of a bare OBJ with these choices: loaded from `folder`, where its
/// names of files begin, it is the same scene to the last bit.
///
/// # Errors
/// [`Error::Usage`] for anything but an OBJ; otherwise as for [`load`](super::load).
pub fn scene_file(path: &Path, choices: &Choices, folder: &Path) -> Result<SceneFile> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
        let what = match path.extension() {
            Some(ending) if ending.eq_ignore_ascii_case("toml") => {
                ": it is a scene file already, and there is nothing to write down"
            }
            _ => "",
        };
        return Err(Error::Usage(format!(
            "{}: a scene file is made for a bare model, a mesh ending in .obj{what}",
            path.display()
        )));
    }
    let mut bare = bare_mesh::load(path, choices).map_err(with_what_is_there(path))?;
    finish(&mut bare.scene)?;
    let mut text = head(&bare);
    text += &film(&bare.scene);
    text += &sensor(&bare.scene);
    text += &environment(&bare, folder)?;
    text += &ground_table(&bare);
    text += INTEGRATOR;
    text += &render(&bare.scene);
    text += &object(&bare, path, folder)?;
    text += &groups::comments(path)?;
    text += "\n";
    text += &materials::tables(&bare.scene, &bare.loader.drafts, folder)?;
    text += &luminaires(&bare);
    Ok(SceneFile { text, scene: bare.scene })
}

/// Lines of keys with their meaning, the latter in one column.
fn keys(lines: &[(&str, String, &str)]) -> String {
    let lines = lines.iter().map(|(key, value, meaning)| {
        let said = format!("{key} = {value}");
        format!("{said:39}  # {meaning}").trim_end().trim_end_matches("  #").trim_end().to_owned() + "\n"
    });
    lines.collect()
}

fn head(bare: &BareMesh) -> String {
    let name = quoted(&bare.scene.path.to_string_lossy());
    format!(
        "# What `luminaire render` shows of {name}, written down by `luminaire scene`, to be changed.\n\
         # A key behind a `#` stands for what holds without it. Lengths are in the unit of the OBJ file, angles in degrees, colours linear RGB,\n\
         # and names of files relative to this one. y points up.\n"
    )
}

fn film(scene: &Scene) -> String {
    let film = &scene.film;
    "\n[film]\n".to_owned()
        + &keys(&[
            ("width", film.width.to_string(), "pixels, 1 to 65536"),
            ("height", film.height.to_string(), ""),
            (
                "# filter",
                "\"box\"".into(),
                "how a pixel weighs the light around it: \"box\", \"tent\", \"gaussian\", \"blackman-harris\"",
            ),
            ("# filter_radius", number(film.filter_radius), "half the filter's width in pixels, above 0, at most 64"),
        ])
}

fn sensor(scene: &Scene) -> String {
    let sensor = &scene.sensor;
    let (kind, extent) = match sensor.projection {
        Projection::Perspective { fov } => (
            (
                "# kind",
                "\"perspective\"".to_owned(),
                "or \"orthographic\": parallel rays, and `height`, how much is seen from bottom to top, in place of `fov`",
            ),
            ("fov", number(fov), "vertical field of view, between 0 and 180"),
        ),
        Projection::Orthographic { height } => (
            (
                "kind",
                "\"orthographic\"".to_owned(),
                "parallel rays; or \"perspective\", with `fov` in place of `height`",
            ),
            ("height", number(height), "how much of the scene is seen from bottom to top, above 0"),
        ),
    };
    let up = if sensor.up == Vec3::Y { "# up" } else { "up" };
    let distance = sensor.position.distance(sensor.target);
    "\n[sensor]\n".to_owned()
        + &keys(&[
            kind,
            ("position", point(sensor.position, scene.origin), "the eye point"),
            ("target", point(sensor.target, scene.origin), "the point in the middle of the picture"),
            (up, triple(sensor.up), "a direction that points up in the picture"),
            extent,
            (
                "# aperture",
                "0".into(),
                "radius of the opening of a lens; 0: everything is in focus. With one there may be:",
            ),
            ("# focus_distance", number(distance), "distance of the plane that is in focus, above 0"),
            ("# blades", "0".into(), "corners of the aperture, 3 to 64; 0 is a disk"),
            ("# blade_rotation", "0".into(), "by which the aperture is turned"),
            ("# shift", "[0, 0]".into(), "a shift lens: by so many widths to the right and heights up of the picture"),
            (
                "# name",
                "\"front\"".into(),
                "several cameras are several [[sensor]], each with a name, which --camera takes",
            ),
        ])
}

fn environment(bare: &BareMesh, folder: &Path) -> Result<String> {
    let studio = (
        "sky",
        "\"studio\"".to_owned(),
        "the built-in grey sky with a soft key light from the upper left; or in its place:",
    );
    let image = |name: String| {
        ("image", name, "a latitude-longitude image: its upper edge is +y, its middle -z, its right half +x")
    };
    let radiance =
        "from everywhere, or a factor to sky or image; 0 or more, in a unit of your choice: 1 is white in the PNG";
    let rotate = ("# rotate", "0".to_owned(), "turns sky or image about +y, counter-clockwise seen from above");
    let other_image = ("# image", "\"sky.hdr\"".to_owned(), image(String::new()).2);
    let one = ("# radiance", "[1, 1, 1]".to_owned(), radiance);
    Ok(match &bare.sky {
        Sky::Studio => "\n[environment]\n".to_owned() + &keys(&[studio, other_image, one, rotate]),
        Sky::Image(file) => {
            let file = image(quoted(&named(file, folder)?));
            "\n[environment]\n".to_owned() + &keys(&[file, one, rotate])
        }
        Sky::Even(colour) if *colour != Vec3::ZERO => {
            let even = ("radiance", triple(*colour), radiance);
            "\n[environment]\n".to_owned() + &keys(&[even, ("# sky", studio.1, studio.2), other_image, rotate])
        }
        Sky::None | Sky::Even(_) => {
            "\n# No light from all around.\n# [environment]\n".to_owned()
                + &keys(&[("# sky", studio.1, studio.2), other_image, one, rotate])
        }
    })
}

fn ground_table(bare: &BareMesh) -> String {
    let grey = triple(Vec3::splat(ground::ALBEDO));
    let size = exact(ground::size(&bare.scene));
    let rest = [
        ("# diffuse", grey, "its albedo, RGB from 0 to 1; this one is as bright as the horizon of the studio sky"),
        ("# size", size, "its diameter, above 0"),
    ];
    let meaning = "its y; without it a hair below the lowest point";
    match bare.ground {
        Some(height) => "\n[ground]\n".to_owned() + &keys(&[("height", exact(height), meaning)]) + &keys(&rest),
        None => {
            let height = exact(ground::height(&bare.scene));
            "\n# No ground.\n# [ground]\n".to_owned() + &keys(&[("# height", height, meaning)]) + &keys(&rest)
        }
    }
}

const INTEGRATOR: &str = "
[integrator]
# kind = \"path\"                          # or \"simple\": direct light, and `ambient = [r, g, b]`, a radiance, for the rest
# estimator = \"default\"                  # a stage of the lecture by its name, see `luminaire render --help`; what follows changes parts of it
# light_sampling = \"mis\"                 # \"none\", \"direct\", \"mis\"
# area_sampling = \"solid-angle\"          # \"area\", \"solid-angle\"
# light_choice = \"auto\"                # which of several luminaires: \"power\", \"tree\", \"auto\" (the tree where it pays)
# directions = \"bsdf\"                    # \"uniform\", \"cosine\", \"bsdf\"
# extinction = \"throughput\"              # how chance ends a path: \"off\", \"literal\", \"surface\", \"throughput\"
# albedo_threshold = 0                   # a path whose combined albedo falls below this ends, 0 to 1
# smooth_terminator = false              # true: coarse meshes with vertex normals are lit as the smooth surfaces that they stand for: a bias
# max_bounces = 1000000                  # at most so many indirect bounces, 0 to 1000000; without it no limit
";

/// `[render]`: a new key of it gets its line here.
fn render(scene: &Scene) -> String {
    let settings = &scene.settings;
    "\n[render]\n".to_owned()
        + &keys(&[
            ("spp", settings.spp.to_string(), "samples a pixel, at least 1: four times as many have half the noise"),
            (
                "exposure",
                settings.exposure.stops().map_or("\"auto\"".into(), number),
                "stops from -64 to 64: the PNG shows radiance times 2^exposure; \"auto\": found from the scene",
            ),
            (
                "tone",
                quoted(settings.tone.name()),
                "the curve of the PNG: \"srgb\", none, \"agx\" or \"neutral\", with soft highlights",
            ),
            (
                "# sampler",
                "\"sobol\"".into(),
                "where the random numbers come from: \"sobol\", less noise, or \"independent\"",
            ),
            ("# seed", settings.seed.to_string(), "of the random numbers, 0 to 4294967295"),
        ])
}

fn object(bare: &BareMesh, path: &Path, folder: &Path) -> Result<String> {
    let object = &bare.scene.objects[0];
    let smooth = match bare.smooth {
        Some(degrees) => ("smooth", number(degrees)),
        None => ("# smooth", "40".to_owned()),
    };
    let turned = bare.up == Up::Z;
    let row = |row: usize| {
        let [x, y, z] = Z_UP.row(row).to_array().map(|x| x as i64);
        format!("[{x}, {y}, {z}, 0]")
    };
    let matrix = format!("[{}, {}, {}]", row(0), row(1), row(2));
    let mut text = "\n# An instance of a mesh; there may be more of them, of this mesh and of others.\n[[object]]\n"
        .to_owned()
        + &keys(&[
            ("mesh", quoted(&named(path, folder)?), "an OBJ file"),
            ("name", quoted(&object.name), "for messages"),
            (
                smooth.0,
                smooth.1,
                "degrees, 0 to 180: without normals (vn), faces that meet at less share them; 0 is flat",
            ),
            ("# vertex_colours", "true".into(), "false: the colours that the OBJ gives its vertices are left out"),
            ("# material", "\"NAME\"".into(), "the material that replaces all others on this instance"),
        ]);
    let placed = [
        ("# scale", "1".to_owned(), "a number, or [x, y, z]; negative numbers mirror"),
        ("# rotate", "[0, 0, 0]".to_owned(), "about x first, then y, then z"),
        ("# translate", "[0, 0, 0]".to_owned(), "comes last"),
    ];
    text += &if turned {
        keys(&[("matrix", matrix, "z up to y up, as rotate = [-90, 0, 0], to the last digit; or in its place:")])
            + &keys(&placed)
    } else {
        keys(&placed) + &keys(&[("# matrix", IDENTITY.into(), "in place of these three")])
    };
    Ok(text)
}

const IDENTITY: &str = "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]";

/// The lamp at the camera, if there is one, and what others there may be.
fn luminaires(bare: &BareMesh) -> String {
    let mut text = String::new();
    for luminaire in &bare.scene.luminaires {
        if let Luminaire::Point { position, intensity } = luminaire {
            text += "\n# The lamp at the camera.\n[[luminaire]]\n";
            text += &keys(&[
                ("kind", "\"point\"".into(), ""),
                ("position", point(*position, bare.scene.origin), ""),
                ("intensity", triple(*intensity), "radiant intensity, RGB"),
            ]);
        }
    }
    text + LUMINAIRES
}

const LUMINAIRES: &str = "
# Luminaires without an area, as many as you like; one with an area is a mesh whose material emits.
# [[luminaire]]
# kind = \"point\"                         # intensity: radiant intensity, RGB
# position = [0, 1, 0]
# intensity = [1, 1, 1]
# [[luminaire]]
# kind = \"point\"                         # one that shines as a photometric file says
# position = [0, 3, 0]
# profile = \"lamp.ies\"                   # an IES file (LM-63), in candela
# direction = [0, -1, 0]                 # where its vertical angle of 0 looks; without it down
# up = [1, 0, 0]                         # the side to which its horizontal angle of 0 looks; without it up, or +x where `direction` is vertical
# intensity = [1, 1, 1]                  # a factor to it
# [[luminaire]]
# kind = \"spot\"                          # a point that shines into a cone: no light beyond outer_angle from direction, all of it within inner_angle
# position = [0, 3, 0]
# direction = [0, -1, 0]
# intensity = [1, 1, 1]
# inner_angle = 20                       # degrees from the axis, 0 to outer_angle; without it 0
# outer_angle = 30                       # degrees from the axis, 0.0001 to 90
# [[luminaire]]
# kind = \"infinite\"                      # direction in which the light travels; irradiance on a surface that faces it
# direction = [0.3, -0.8, -0.7]
# irradiance = [1, 1, 1]
# angle = 0                              # diameter of a disc that is seen and has soft shadows: 0.53 is the sun's, at most 180
";
