//! A bare model as a scene file, to be changed: what was chosen for it, and every key with what it means.

mod groups;
mod luminaires;
mod maps;
mod materials;
mod physical;
mod relief;
mod words;

use super::bare_mesh::{self, BareMesh, Z_UP};
use super::choices::{Choices, Sky, Up};
use super::format::Format;
use super::obj::file_name;
use super::{finish, ground, with_what_is_there};
use crate::scene::{Camera, Projection, Scene, Sensor};
use crate::{Error, Result};
use glam::{Vec2, Vec3};
use std::path::Path;
use words::{exact, keys, number, path as named, point, quoted, triple};

/// A bare model's scene file.
#[derive(Debug)]
pub struct SceneFile {
    /// The scene file.
    pub text: String,
    /// The scene that it describes.
    pub scene: Scene,
}

/// The scene file that says what [`load_with`](super::load_with) makes of a bare model with these choices: loaded from `folder`, where its
/// names of files begin, it is the same scene to the last bit.
///
/// # Errors
/// [`Error::Usage`] for anything but a model; otherwise as for [`load`](super::load).
pub fn scene_file(path: &Path, choices: &Choices, folder: &Path) -> Result<SceneFile> {
    let Some(format) = Format::of(path).filter(|format| *format != Format::SceneFile) else {
        let what = match Format::of(path) {
            Some(_) => ": it is a scene file already, and there is nothing to write down",
            None => "",
        };
        return Err(Error::Usage(format!(
            "{}: a scene file is made for a bare model, a mesh ending in .obj{what}",
            path.display()
        )));
    };
    let mut bare = bare_mesh::load(path, format, choices).map_err(with_what_is_there(path))?;
    finish(&mut bare.scene)?;
    let parts = match format {
        Format::Obj => groups::of_obj(path)?,
        _ => groups::of_objects(&bare.scene),
    };
    Ok(SceneFile { text: text(&bare, &parts, folder)?, scene: bare.scene })
}

/// The scene file of a model; `parts` are comments of what it consists of.
pub(super) fn text(bare: &BareMesh, parts: &str, folder: &Path) -> Result<String> {
    let mut text = head(bare);
    text += &film(&bare.scene);
    text += &sensors(&bare.scene);
    text += &environment(bare, folder)?;
    text += &ground_table(bare);
    text += INTEGRATOR;
    text += &render(&bare.scene);
    text += &object(bare, folder)?;
    text += parts;
    text += "\n";
    text += &materials::tables(&bare.scene, &bare.loader.drafts, folder)?;
    text += &luminaires::tables(bare);
    Ok(text)
}

fn head(bare: &BareMesh) -> String {
    let name = quoted(&bare.scene.path.to_string_lossy());
    format!(
        "# What `luminaire render` shows of {name}, written down by `luminaire scene`, to be changed.\n\
         # A key behind a `#` stands for what holds without it. Lengths are in the unit of the model's file, angles in degrees, colours linear RGB,\n\
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

/// The cameras: the model's own, or the one that was found for it.
fn sensors(scene: &Scene) -> String {
    match &scene.cameras[..] {
        [] => sensor(scene, &scene.sensor, None),
        own => own.iter().map(|Camera { name, sensor: own }| sensor(scene, own, Some(name))).collect(),
    }
}

fn sensor(scene: &Scene, sensor: &Sensor, name: Option<&str>) -> String {
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
    let several = name.is_some();
    let name = match name {
        None => ("# name", "\"front\"".into()),
        Some(name) => ("name", quoted(name)),
    };
    let shift = match sensor.shift {
        Vec2::ZERO => ("# shift", "[0, 0]".to_owned()),
        Vec2 { x, y } => ("shift", format!("[{}, {}]", number(x), number(y))),
    };
    if several { "\n[[sensor]]\n" } else { "\n[sensor]\n" }.to_owned()
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
            (shift.0, shift.1, "a shift lens: by so many widths to the right and heights up of the picture"),
            (name.0, name.1, "several cameras are several [[sensor]], each with a name, which --camera takes"),
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

fn object(bare: &BareMesh, folder: &Path) -> Result<String> {
    let path = &bare.scene.path;
    let own = bare.scene.objects.len() - usize::from(bare.scene.ground.is_some());
    // All of a model's objects have one table.
    let name = if own == 1 { bare.scene.objects[0].name.clone() } else { file_name(path) };
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
            ("mesh", quoted(&named(path, folder)?), "the file of a model"),
            ("name", quoted(&name), "for messages"),
            (
                smooth.0,
                smooth.1,
                "degrees, 0 to 180: without normals (vn), faces that meet at less share them; 0 is flat",
            ),
            ("# vertex_colours", "true".into(), "false: the colours that the file gives its vertices are left out"),
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
