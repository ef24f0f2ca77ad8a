//! What a model file needs to become a picture, and does not say: a camera, and a sky and a ground if next to nothing in it emits, or not where it is looked at.

use super::choices::{Choices, SMOOTH, Sky, Up};
use super::format::Format;
use super::ground::{self, Ground};
use super::loader::{Loader, listed};
use super::model::{Model, Reading, said};
use super::{environment, footing, lamplight, reach};
use crate::scene::build::pinhole;
use crate::scene::{
    Camera, Estimator, Exposure, FilmSettings, Filter, FirstView, Integrator, Luminaire, Object, RenderSettings, Scene,
    Tone, widen,
};
use crate::{Error, Result};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::path::Path;

/// A scene whose emitting triangles have less than this share of its area is not meant to be lit by them alone: they glow, as
/// lava in a landscape does. The lamp of a Cornell box has seven times as much.
const LEAST_EMITTING: f64 = 1e-3;
/// But smaller ones are lamps if they are so bright that what they light has this radiance: half a percent of what is white in a PNG.
const LEAST_LEVEL: f64 = 5e-3;
/// The faint grey around a model that its lamps light, over the radiance of what they light.
const FAINT: f64 = 0.6;
/// A lamp that reaches less than this share of what is seen does not light it.
const LEAST_LIT: f64 = 0.2;
/// In a room of which lamps light less than this share, there is another one at the camera.
const WELL_LIT: f64 = 0.5;
/// Irradiance of the lamp at the camera on what faces it at the middle distance: grey has a radiance of a quarter of the studio sky's horizon there.
const FILL: f64 = 0.6;
/// How the note of where the camera stands begins; the place follows.
pub(super) const FIRST_VIEW: &str = "the camera stands ";
/// From z up to y up, to the last digit: x stays, z becomes y, y becomes -z.
pub(super) const Z_UP: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);

/// Size and filter of the picture where nothing is said.
pub(super) const FILM: FilmSettings = FilmSettings { width: 512, height: 512, filter: Filter::Box, filter_radius: 0.5 };

/// A bare model as a scene, and what was chosen for it.
#[derive(Debug)]
pub(super) struct BareMesh {
    pub scene: Scene,
    /// What the materials are made of.
    pub loader: Loader,
    /// The light from all around.
    pub sky: Sky,
    /// The height of the ground in the coordinates of the file, turned with it.
    pub ground: Option<f64>,
    /// The angle below which faces share normals, where that was chosen and makes a difference, or was asked for.
    pub smooth: Option<f32>,
    /// Which axis was up.
    pub up: Up,
    /// How many luminaires without an area the model brings, which are the first of the scene.
    pub lamps: usize,
    /// Whether there is a lamp at the camera, the last of the scene's luminaires.
    pub fill: bool,
}

/// Loads a bare model, as `choices` say or as suits it.
pub(super) fn load(path: &Path, format: Format, choices: &Choices) -> Result<BareMesh> {
    let mut loader = Loader::new(Vec::new());
    let how = Reading {
        smooth: Some(choices.smooth.unwrap_or(SMOOTH).to_bits()),
        smooth_if_unsaid: choices.smooth.is_none(),
        without_colours: false,
    };
    let model = loader.model(path, format, how)?;
    build(path, &model, loader, choices)
}

/// A scene of a model that the loader has read.
pub(super) fn build(path: &Path, model: &Model, mut loader: Loader, choices: &Choices) -> Result<BareMesh> {
    let is_smoothed = model.placed.iter().any(|placed| loader.smoothed[placed.mesh as usize]);
    let smooth = choices.smooth.or(is_smoothed.then_some(SMOOTH));
    let up = choices.up.unwrap_or(Up::Y);
    let to_world = match up {
        Up::Y => DAffine3::IDENTITY,
        Up::Z => DAffine3::from_mat3(Z_UP),
    };
    let (standing, flat) = model.standing(to_world);
    if !flat.is_empty() {
        let names = listed(flat.iter().map(|placed| &*placed.name));
        let why = "the transform cannot be inverted: it flattens the object";
        loader.warnings.push(format!("{}: {names} left out: {why}", path.display()));
    }
    if standing.is_empty() {
        let why = match flat.len() {
            0 => "no mesh with triangles stands anywhere in it".to_owned(),
            all => format!("the transforms of all of its {all} objects flatten them"),
        };
        return Err(Error::scene(path, format!("nothing to trace: {why}")));
    }
    let mut objects = Vec::new();
    let mut places = Vec::new();
    for (placed, place) in standing {
        let object_to_world = place.as_affine3a();
        objects.push(Object { name: placed.name.clone(), mesh: placed.mesh, object_to_world, material: None });
        places.push(place);
    }
    let origin = loader.settle(&mut objects, &places);
    let luminaires = model.luminaires(to_world, origin, &mut loader.warnings);
    let lamps = luminaires.len();
    let (materials, textures) = loader.finish_materials(&objects);
    let mut scene = Scene {
        path: path.to_owned(),
        origin,
        meshes: std::mem::take(&mut loader.meshes),
        objects,
        materials,
        textures,
        luminaires,
        environment: None,
        // Until the scene can be looked at.
        sensor: pinhole(Vec3::Z, Vec3::ZERO, Vec3::Y, 40.0),
        cameras: Vec::new(),
        film: FILM,
        integrator: Integrator::Path(Estimator::default()),
        settings: RenderSettings::automatic(),
        files: std::mem::take(&mut loader.files),
        warnings: std::mem::take(&mut loader.warnings),
        notes: Vec::new(),
        ground: None,
    };
    // Before a ground reaches further still.
    reach::check(&scene)?;
    let bounds = scene.model_bounds();
    let mut warnings = Vec::new();
    scene.cameras = model.cameras(to_world, origin, bounds, &mut warnings);
    scene.warnings.append(&mut warnings);
    // Who makes a file with cameras or lamps means its light to be all the light.
    let is_whole = lamps > 0 || !scene.cameras.is_empty();
    let FirstView { sensor, place, inside } = scene.view_from(Vec3::Y, choices.view);
    scene.sensor = sensor;
    // As a scene file can say it in the coordinates of the files.
    for point in [&mut scene.sensor.position, &mut scene.sensor.target] {
        *point = said(*point, origin);
    }
    let place = take_camera(&mut scene, choices).unwrap_or(place);
    let (emitting, level) = emitting_share(&scene);
    let may_light = emitting >= LEAST_EMITTING || level >= LEAST_LEVEL || lamps > 0;
    let lit_share = if may_light { lamplight::lit_share(&scene) } else { 0.0 };
    let lit = lit_share >= LEAST_LIT;
    let sky = choices.sky.clone().unwrap_or_else(|| match (lit, inside) {
        (false, _) => Sky::Studio,
        (true, true) => Sky::None,
        (true, false) if is_whole => Sky::None,
        (true, false) => faint(level),
    });
    scene.environment = environment::of(&sky, &mut scene.files, &mut scene.warnings)?;
    let height = ground::height(&scene);
    let ground = choices.ground.unwrap_or_else(|| {
        let above = f64::from(scene.sensor.position.y) + origin.y > height;
        let faint = lit && choices.sky.is_none();
        scene.environment.is_some() && !faint && above && !footing::brings_its_ground(&scene)
    });
    let ground = ground.then_some(height);
    if ground.is_some() {
        ground::add(&mut scene, &Ground { height: ground, ..Ground::default() });
    }
    let fill = choices.fill.unwrap_or(lamps == 0 && inside && (lit_share < WELL_LIT || level < LEAST_LEVEL));
    if fill {
        let distance = lamplight::distance_of_what_is_seen(&scene);
        let intensity = Vec3::splat(two_digits(FILL * distance * distance));
        scene.luminaires.push(Luminaire::Point { position: scene.sensor.position, intensity });
    }
    // From outside the studio sky is as bright as a studio is; elsewhere nobody knows.
    if sky == Sky::Studio && !inside && emitting == 0.0 && lamps == 0 {
        scene.settings.exposure = Exposure::Stops(0.0);
    } else {
        // Lamps are in the picture, and what is far from them.
        scene.settings.tone = Tone::Agx;
    }
    scene.warnings.extend(scene.dark_because());
    let mut bare = BareMesh { scene, loader, sky, ground, smooth, up, lamps, fill };
    let note = bare.note(emitting, choices);
    bare.scene.notes.extend([note, format!("{FIRST_VIEW}{place}")]);
    bare.scene.notes.append(&mut bare.loader.notes);
    Ok(bare)
}

/// Takes the first camera of a model that has any, and says where it stands; where a side was chosen, the view from there is the first one.
fn take_camera(scene: &mut Scene, choices: &Choices) -> Option<String> {
    let first = scene.cameras.first()?.clone();
    if let Some(side) = choices.view {
        let is_free = |name: &String| scene.cameras.iter().all(|camera| camera.name != *name);
        let name = std::iter::once(side.name().to_owned()).chain((2..).map(|n| format!("{} {n}", side.name())));
        let name = name.into_iter().find(is_free).unwrap_or_default();
        scene.cameras.insert(0, Camera { name, sensor: scene.sensor.clone() });
        return None;
    }
    scene.sensor = first.sensor;
    let others = match scene.cameras.len() {
        1 => String::new(),
        count => format!(", the first of {count}: --camera NAME takes another"),
    };
    Some(format!("where the file has its camera `{}`{others}", first.name))
}

impl BareMesh {
    /// What was chosen, in a line.
    fn note(&self, emitting: f64, choices: &Choices) -> String {
        let why = match emitting {
            0.0 => String::new(),
            few if few < LEAST_EMITTING && choices.sky.is_none() => {
                format!(" (only {} of its area emits)", percent(few))
            }
            _ => " beside what emits in it".into(),
        };
        let lamps = match self.lamps {
            0 => String::new(),
            1 => "lit by its luminaire".into(),
            count => format!("lit by its {count} luminaires"),
        };
        let light = match &self.sky {
            Sky::None if self.lamps > 0 && emitting > 0.0 => format!("{lamps} and by what emits in it"),
            Sky::None if self.lamps > 0 => lamps,
            Sky::Studio => format!("studio sky{why}"),
            Sky::Image(path) => format!("the sky of {}", path.display()),
            Sky::Even(radiance) if choices.sky.is_none() => {
                format!("lit by what emits in it, before a faint grey of radiance {}", radiance.x)
            }
            Sky::Even(radiance) => format!("a sky of radiance {} {} {}", radiance.x, radiance.y, radiance.z),
            Sky::None if emitting > 0.0 => "lit by what emits in it".into(),
            Sky::None => "no sky".into(),
        };
        let ground = self.ground.map_or("no ground".into(), |height| format!("ground at y = {height}"));
        let smooth = self.smooth.map_or(String::new(), |degrees| match degrees {
            0.0 => ", normals flat".into(),
            _ => format!(", normals smooth below {degrees} degrees"),
        });
        let fill = if self.fill { ", a lamp at the camera" } else { "" };
        let up = if self.up == Up::Z { ", turned from z up to y up" } else { "" };
        let name = for_a_shell(&self.scene.path.to_string_lossy());
        let stem = self.scene.path.file_stem().unwrap_or_default().to_string_lossy();
        let file = for_a_shell(&format!("{stem}.toml"));
        let command = format!("luminaire scene {name}{} -o {file}", options(choices));
        format!("bare model: {light}{fill}, {ground}{smooth}{up}; `{command}` writes that down, to be changed")
    }
}

/// Choices as options of the command line, each behind a blank.
fn options(choices: &Choices) -> String {
    let sky = choices.sky.as_ref().map(|sky| match sky {
        Sky::Studio => "studio".to_owned(),
        Sky::None => "none".into(),
        Sky::Even(radiance) => format!("{},{},{}", radiance.x, radiance.y, radiance.z),
        Sky::Image(path) => for_a_shell(&path.to_string_lossy()),
    });
    let on_or_off = |on: bool| if on { "on" } else { "off" }.to_owned();
    let ground = choices.ground.map(on_or_off);
    let smooth = choices.smooth.map(|degrees| degrees.to_string());
    let up = choices.up.map(|up| if up == Up::Z { "z" } else { "y" }.to_owned());
    let fill = choices.fill.map(on_or_off);
    let view = choices.view.map(|side| side.name().to_owned());
    let given = [("sky", sky), ("ground", ground), ("smooth", smooth), ("up", up), ("fill", fill), ("view", view)];
    given.into_iter().filter_map(|(name, value)| Some(format!(" --{name} {}", value?))).collect()
}

/// A word of a command as a shell reads it.
fn for_a_shell(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// The emitting triangles' share of the area of all triangles, from 0 to 1, and about the radiance of what they light: as if all surfaces were grey
/// and got the same light.
fn emitting_share(scene: &Scene) -> (f64, f64) {
    let (mut emitting, mut all, mut power) = (0.0, 0.0, 0.0);
    for object in &scene.objects {
        let to_world = widen(object.object_to_world);
        let mesh = &scene.meshes[object.mesh as usize];
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
            let area = 0.5 * (b - a).cross(c - a).length();
            all += area;
            let emission = scene.material_of(object, triangle).emission;
            if emission != Vec3::ZERO {
                emitting += area;
                power += area * f64::from(emission.element_sum() / 3.0);
            }
        }
    }
    if emitting > 0.0 { (emitting / all, 0.5 * power / all) } else { (0.0, 0.0) }
}

/// What is behind a model whose lamps give its surfaces about this radiance: not black, and no light to speak of.
fn faint(level: f64) -> Sky {
    match two_digits(FAINT * level) {
        0.0 => Sky::None,
        radiance => Sky::Even(Vec3::splat(radiance)),
    }
}

/// Rounded to two digits, for people.
fn two_digits(number: f64) -> f32 {
    let rounded: f32 = format!("{number:.1e}").parse().unwrap_or(0.0);
    if rounded.is_finite() { rounded } else { 0.0 }
}

/// A small share in words.
fn percent(share: f64) -> String {
    if share < 1e-6 { "less than 0.0001 %".into() } else { format!("{:.4} %", 100.0 * share) }
}
