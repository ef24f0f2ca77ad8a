//! `luminaire inspect`.

mod integrator;
mod physical;
mod tables;

use self::tables::{luminaires, materials, meshes, objects, point, rgb, textures};
use crate::shared::camera::CameraOption;
use crate::shared::counts::pixels;
use crate::shared::film_size::FilmSize;
use crate::shared::foreseen::{Foreseen, foresee};
use crate::shared::printing::{Notes, print};
use crate::shared::scene_options::SceneOptions;
use crate::shared::table::table;
use luminaire::film::Demand;
use luminaire::glam::{DVec3, Vec2};
use luminaire::gpu::specialization::KernelModel;
use luminaire::scene::{self, Environment, FilmSettings, Mesh, Projection, Scene, Sensor};
use luminaire::{Error, Result};
use std::collections::HashSet;
use std::path::PathBuf;
use std::process::ExitCode;

/// The largest side of a film in pixels.
const LARGEST_SIDE: u32 = 65536;

/// What follows the options in `--help`.
const HELP: &str = "\
Examples:
  luminaire inspect scenes/textures/textures.toml
      objects, materials, textures and luminaires, what the kernel will model, the memory that this takes, and every warning
  luminaire inspect model.obj --width 3840
      what was chosen for it (camera, sky, ground), too, and what a picture of this size takes of memory and disk

Exit codes:
  0  the scene can be loaded, with or without warnings
  1  it cannot: a file is missing or wrong; `error:` on stderr says where and what to do
  2  wrong usage";

/// What to inspect.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Options {
    /// A scene file (.toml) or any OBJ file.
    scene: PathBuf,
    /// Width in pixels of the picture whose memory is told [default: the scene's, or from --height at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<1, LARGEST_SIDE>)]
    width: Option<u32>,
    /// Height in pixels [default: the scene's, or from --width at the scene's aspect ratio].
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true, value_parser = pixels::<1, LARGEST_SIDE>)]
    height: Option<u32>,
    #[command(flatten)]
    of_scene: SceneOptions,
    #[command(flatten)]
    camera: CameraOption,
}

/// Loads a scene and prints what is in it.
pub fn run(options: &Options) -> Result<ExitCode> {
    let mut scene = options.of_scene.load(&options.scene)?;
    // All cameras are listed, so that no note has to name them.
    options.camera.choose(&mut scene, Notes { quiet: true })?;
    let own_film = scene.film;
    FilmSize { width: options.width, height: options.height, largest: LARGEST_SIDE }.apply(&mut scene.film);
    let FilmSettings { width, height, .. } = scene.film;
    // What no memory of this machine holds is told, and what nothing can hold is refused as `render` does.
    if let Err(error @ Error::Usage(_)) = (Demand { width, height, ..Demand::default() }).check() {
        return Err(error);
    }
    let foreseen = foresee(&mut scene, &own_film);
    print(&describe(&scene, &foreseen))?;
    Ok(ExitCode::SUCCESS)
}

/// The whole report on a scene.
fn describe(scene: &Scene, foreseen: &Foreseen) -> String {
    let (low, high) = scene.tight_bounds();
    let (low, high) = (low + scene.origin, high + scene.origin);
    let stored: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut text = format!("{}\n\n", scene.path.display());
    text += &table(
        0,
        &[
            row(
                "triangles",
                format!(
                    "{} in {} {}; {stored} stored in {} {}",
                    scene.triangle_count(),
                    scene.objects.len(),
                    if scene.objects.len() == 1 { "object" } else { "objects" },
                    scene.meshes.len(),
                    if scene.meshes.len() == 1 { "mesh" } else { "meshes" }
                ),
            ),
            row("bounds", format!("{low:.4} to {high:.4}{}", moved(scene))),
            row("sensor", sensor(scene, &scene.sensor)),
            row(
                "film",
                format!(
                    "{} x {} pixels, {} filter of radius {}",
                    scene.film.width,
                    scene.film.height,
                    filter(scene.film.filter),
                    scene.film.filter_radius
                ),
            ),
            row("environment", scene.environment.as_ref().map_or("none".into(), environment)),
            row("integrator", integrator::describe(&scene.integrator)),
            row(
                "render",
                format!(
                    "{} samples a pixel, {:?} sampler, seed {}, {}, tone {}",
                    scene.settings.spp,
                    scene.settings.sampler,
                    scene.settings.seed,
                    foreseen.found.clone().unwrap_or_else(|| format!("exposure {}", foreseen.development.exposure)),
                    foreseen.development.tone.name()
                ),
            ),
            row("kernel", KernelModel::of(scene).to_string()),
            row("memory", memory(scene)),
            row("film takes", film_memory(scene)),
        ],
    );
    if scene.cameras.len() > 1 || scene.cameras.iter().any(|camera| !camera.name.is_empty()) {
        let rows = scene.cameras.iter().map(|camera| row(&camera.name, sensor(scene, &camera.sensor)));
        text += &format!("\ncameras\n{}", table(2, &rows.collect::<Vec<_>>()));
    }
    text += &format!("\nmeshes\n{}", table(2, &meshes(scene)));
    text += &format!("\nobjects\n{}", table(2, &objects(scene)));
    text += &format!("\nmaterials\n{}", table(2, &materials(scene)));
    if !scene.textures.is_empty() {
        text += &format!("\ntextures\n{}", table(2, &textures(scene)));
    }
    text += &format!("\nluminaires\n{}", table(2, &luminaires(scene)));
    if !scene.notes.is_empty() {
        text += "\nchosen\n";
    }
    scene.notes.iter().for_each(|note| text += &format!("  {note}\n"));
    text += "\nwarnings\n";
    if scene.warnings.is_empty() {
        text += "  none\n";
    }
    for warning in &scene.warnings {
        text += &format!("  {warning}\n");
    }
    text
}

/// By how much the scene was moved, if it was.
fn moved(scene: &Scene) -> String {
    if scene.origin == DVec3::ZERO {
        return String::new();
    }
    let DVec3 { x, y, z } = scene.origin;
    format!(" (rendered as if ({x} {y} {z}) were the origin: single precision holds more details there)")
}

fn row(name: &str, value: String) -> Vec<String> {
    vec![name.into(), value]
}

fn sensor(scene: &Scene, s: &Sensor) -> String {
    let projection = match s.projection {
        Projection::Perspective { fov } => format!("{fov} degrees high"),
        Projection::Orthographic { height } => format!("orthographic, {height} high"),
    };
    let lens = s.lens.map_or(String::new(), |lens| {
        let shape = match (lens.blades, lens.rotation) {
            (0, _) => "round".into(),
            (blades, 0.0) => format!("{blades} blades"),
            (blades, turn) => format!("{blades} blades, turned by {turn} degrees"),
        };
        format!(", aperture of radius {} ({shape}), in focus at distance {}", lens.radius, lens.focus_distance)
    });
    let (position, target) = (point(scene, s.position), point(scene, s.target));
    let shift = match s.shift {
        Vec2::ZERO => String::new(),
        Vec2 { x, y } => format!(", shifted by {x} widths to the right and {y} heights upwards"),
    };
    format!("at {position}, looking at {target}, up {}, {projection}{shift}{lens}", rgb(s.up))
}

/// A filter's name in scene files.
fn filter(filter: scene::Filter) -> &'static str {
    match filter {
        scene::Filter::Box => "box",
        scene::Filter::Tent => "tent",
        scene::Filter::Gaussian => "gaussian",
        scene::Filter::BlackmanHarris => "blackman-harris",
    }
}

fn environment(environment: &Environment) -> String {
    match &environment.image {
        None => format!("radiance {} from everywhere", rgb(environment.radiance)),
        Some(image) => format!(
            "{}, {} x {} texels, times {}, turned by {} degrees",
            image.name,
            image.width,
            image.height,
            rgb(environment.radiance),
            environment.rotation
        ),
    }
}

/// Bytes of the data itself; the acceleration structures depend on the backend.
fn memory(scene: &Scene) -> String {
    let mesh = |m: &Mesh| {
        size_of_val(&m.positions[..])
            + size_of_val(&m.normals[..])
            + size_of_val(&m.uvs[..])
            + size_of_val(&m.colours[..])
            + size_of_val(&m.triangles[..])
    };
    let geometry: usize = scene.meshes.iter().map(|m| mesh(m)).sum();
    // Maps that show one image in several places share it.
    let mut seen = HashSet::new();
    let own = scene.textures.iter().filter(|texture| seen.insert(texture.texels.as_ptr()));
    let images: usize = own.map(|texture| size_of_val(&texture.texels[..])).sum();
    let size = |bytes: f64| match bytes {
        b if b < f64::from(1 << 20) => format!("{:.1} KiB", b / f64::from(1 << 10)),
        b if b < f64::from(1 << 30) => format!("{:.1} MiB", b / f64::from(1 << 20)),
        b => format!("{:.2} GiB", b / f64::from(1 << 30)),
    };
    let images = if images > 0 { format!(", {} of textures", size(images as f64)) } else { String::new() };
    format!("{} of geometry{images}, besides about 100 bytes a stored triangle for the BVH", size(geometry as f64))
}

/// What rendering takes at most beside the scene, and what it writes.
fn film_memory(scene: &Scene) -> String {
    let FilmSettings { width, height, .. } = scene.film;
    let plain = Demand { width, height, ..Demand::default() };
    let size = |bytes: u64| {
        let mib = bytes as f64 / f64::from(1 << 20);
        if mib < 1024.0 { format!("{mib:.1} MiB") } else { format!("{:.2} GiB", mib / 1024.0) }
    };
    let with = Demand { sums: true, ..plain };
    format!(
        "{} for a picture, {} with layers (--aov), {} with --checkpoint or --samples, whose file takes up to {}; besides the scene, and about 120 MiB \
         for a Vulkan driver",
        size(plain.bytes()),
        size(Demand { aovs: true, exr: true, ..plain }.bytes()),
        size(with.bytes()),
        size(with.file_bytes())
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::glam::Vec3;
    use luminaire::scene::{
        Camera, Estimator, Filter, Integrator, Lens, Luminaire, Maps, Material, Object, Profile, RenderSettings,
        Texture, Triangle,
    };

    #[test]
    fn everything_is_named() {
        let emission = Vec3::new(1.0, 2.0, 3.0);
        let material = Material {
            name: "lamp".into(),
            lambert: Vec3::splat(0.5),
            emission,
            reflection: Vec3::splat(0.25),
            transmission: Vec3::splat(0.125),
            eta: Some(1.5),
            opacity: 0.75,
            maps: Maps { lambert: Some(0), ..Maps::default() },
            ..Material::default()
        };
        let estimator = Estimator { max_bounces: Some(4), ..Estimator::default() };
        let scene = Scene {
            path: "test.obj".into(),
            origin: DVec3::ZERO,
            meshes: vec![
                Mesh {
                    name: "one.obj".into(),
                    positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
                    uvs: vec![luminaire::glam::Vec2::ZERO; 3],
                    triangles: vec![Triangle { vertices: [0, 1, 2], material: 0 }],
                    ..Mesh::default()
                }
                .into(),
            ],
            objects: vec![
                Object {
                    name: "thing".into(),
                    mesh: 0,
                    object_to_world: luminaire::glam::Affine3A::from_scale(Vec3::new(-2.0, 1.0, 1.0)),
                    material: None,
                };
                22
            ],
            materials: vec![material],
            textures: vec![
                Texture {
                    name: "wood.png".into(),
                    width: 1,
                    height: 1,
                    texels: vec![Default::default()].into(),
                    clamp: true,
                    ..Texture::default()
                }
                .into(),
            ],
            luminaires: vec![
                Luminaire::Point { position: Vec3::Z, intensity: Vec3::ONE },
                Luminaire::Spot {
                    position: Vec3::Z,
                    direction: Vec3::X,
                    intensity: Vec3::ONE,
                    inner: 10.0,
                    outer: 25.5,
                },
                Luminaire::Photometric {
                    position: Vec3::Z,
                    direction: Vec3::NEG_Y,
                    up: Vec3::X,
                    intensity: Vec3::splat(0.5),
                    profile: Profile {
                        name: "lamp.ies".into(),
                        vertical: vec![0.0, 180.0],
                        horizontal: vec![0.0],
                        candela: vec![100.0; 2],
                    }
                    .into(),
                },
                Luminaire::Sun { direction: Vec3::NEG_Y, irradiance: Vec3::splat(2.0), angle: 0.5 },
            ],
            environment: Some(Environment { radiance: Vec3::splat(0.5), image: None, rotation: 0.0 }),
            sensor: Sensor {
                position: Vec3::Z,
                target: Vec3::ZERO,
                up: Vec3::Y,
                projection: Projection::Perspective { fov: 40.0 },
                lens: Some(Lens { radius: 0.25, focus_distance: 3.0, blades: 6, rotation: 10.0 }),
                shift: Vec2::ZERO,
            },
            cameras: vec![
                Camera {
                    name: "front".into(),
                    sensor: Sensor {
                        shift: Vec2::new(-0.5, 0.25),
                        ..luminaire::scene::build::pinhole(Vec3::Z, Vec3::ZERO, Vec3::Y, 30.0)
                    },
                };
                2
            ],
            film: FilmSettings { width: 64, height: 48, filter: Filter::BlackmanHarris, filter_radius: 1.5 },
            integrator: Integrator::Path(estimator),
            settings: RenderSettings::default(),
            warnings: vec!["one.obj:3: something odd".into()],
            notes: vec!["bare model: something chosen".into()],
            ground: None,
            files: vec![],
        };
        let foreseen = Foreseen { lacks_light: false, development: 1.5.into(), found: None };
        let text = describe(&scene, &foreseen);
        for part in [
            "22 in 22 objects; 1 stored in 1 mesh",
            "64 x 48 pixels, blackman-harris filter of radius 1.5",
            "40 degrees high, aperture of radius 0.25 (6 blades, turned by 10 degrees), in focus at distance 3",
            "front",
            "30 degrees high, shifted by -0.5 widths to the right and 0.25 heights upwards",
            "radiance (0.5 0.5 0.5) from everywhere",
            "estimator `default`",
            "at most 4 indirect bounces",
            "Sobol sampler",
            "glass of index 1.5, reflection (0.25 0.25 0.25), transmission (0.125 0.125 0.125); opacity 0.75; diffuse map wood.png",
            "wood.png  1 x 1",
            "mirrored, volume times 2.0000",
            "... and 2 more",
            "(1 2 3)",
            "point",
            "22 emissive triangles",
            "total area 22.0000",
            "at (0 0 1) towards (1 0 0), 10 to 25.5 degrees",
            "(0.5 0.5 0.5) times lamp.ies: 1257 lm, at most 100 cd",
            "towards (0 -1 0), 0.5000 degrees",
            "irradiance (2 2 2)",
            "  bare model: something chosen",
            "  one.obj:3: something odd",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
    }
}
