//! Scene files in TOML; `scenes/README.md` describes the format.

mod advice;
mod contents;
mod file;
mod foreign_words;
mod radians;
mod settings;
mod tables;
mod values;

use super::choices::Choices;
use super::environment;
use super::ground::{self, Ground};
use super::loader::Loader;
use super::text_file::read_bytes;
use crate::scene::{FirstView, Projection, RenderSettings, Scene, Sensor};
use crate::{Error, Result};
use advice::{in_plain_words, wrong_brackets};
use file::File;
use glam::{DVec3, Vec3};
use std::path::Path;
use tables::{GroundTable, SceneFile};

/// Loads a scene file.
pub(super) fn load(path: &Path, choices: &Choices) -> Result<Scene> {
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes)).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        Error::Parse { path: path.to_owned(), line, column: 0, message: "a scene file has to be UTF-8 text".into() }
    })?;
    let file = File { path, text };
    if let Some((span, message)) = wrong_brackets(text) {
        return Err(file.error(span, message));
    }
    let scene: SceneFile = ::toml::from_str(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        file.error(span.clone(), in_plain_words(error.message().trim(), text, span))
    })?;
    file.build(scene, choices)
}

impl File<'_> {
    fn build(&self, mut file: SceneFile, choices: &Choices) -> Result<Scene> {
        let Choices { sky, ground, smooth: _, up: _ } = choices;
        if sky.is_some() {
            file.environment = None;
        }
        let ground = match (ground, file.ground) {
            (None | Some(true), Some(table)) => Some(table),
            (None | Some(false), _) => None,
            (Some(true), None) => Some(GroundTable::default()),
        };
        let film = self.film(file.film)?;
        let integrator = self.integrator(&file.integrator)?;
        // What is wrong in this file is said before any other file is read; where the origin is, only those know.
        let near = file.sensor.as_ref().map_or(DVec3::ZERO, |table| far_origin(table.get_ref().position.0));
        let mut fov = None;
        if let Some(table) = &file.sensor
            && let Projection::Perspective { fov: degrees } = self.sensor(table, near)?.projection
        {
            fov = Some(degrees);
        }
        for table in &file.luminaire {
            self.luminaire(table, near)?;
        }
        let mut loader = Loader::new(self.materials(&file.material)?);
        loader.files.push(self.path.to_owned());
        if let Some(image) = file.environment.as_ref().and_then(|table| table.get_ref().image.as_ref()) {
            loader.files.extend(Some(self.beside(image.get_ref())).filter(|path| path.is_file()));
        }
        if let Some(warning) = fov.and_then(radians::field_of_view) {
            loader.warnings.push(self.warning(&warning));
        }
        let environment = match (sky, &file.environment) {
            (Some(sky), _) => environment::of(sky, &mut loader.files, &mut loader.warnings)?,
            (None, Some(table)) => self.environment(table, &mut loader.warnings)?,
            (None, None) => None,
        };
        let (mut objects, mut to_world) = (Vec::new(), Vec::new());
        for table in &file.object {
            let (object, place) = self.object(table, &mut loader)?;
            objects.push(object);
            to_world.push(place);
        }
        if objects.is_empty() {
            return Err(Error::scene(self.path, "nothing to trace: the scene file has no [[object]]"));
        }
        let origin = loader.settle(&mut objects, &to_world);
        let sensor = file.sensor.map(|table| self.sensor(&table, origin)).transpose()?;
        let luminaires: Result<Vec<_>> = file.luminaire.iter().map(|table| self.luminaire(table, origin)).collect();
        let luminaires = luminaires?;
        let defaults = RenderSettings::default();
        let settings = RenderSettings {
            spp: file.render.spp.map_or(defaults.spp, |spp| spp.0),
            seed: file.render.seed.unwrap_or(defaults.seed),
            exposure: file.render.exposure.map_or(defaults.exposure, |exposure| exposure.0),
            tone: file.render.tone.unwrap_or(defaults.tone),
            sampler: file.render.sampler.unwrap_or(defaults.sampler),
        };
        let (materials, textures) = loader.finish_materials(&objects);
        let mut scene = Scene {
            path: self.path.to_owned(),
            origin,
            meshes: loader.meshes,
            objects,
            materials,
            textures,
            luminaires,
            environment,
            sensor: Sensor {
                position: Vec3::Z,
                target: Vec3::ZERO,
                up: Vec3::Y,
                projection: Projection::Perspective { fov: 40.0 },
                lens: None,
            },
            film,
            integrator,
            settings,
            files: loader.files,
            warnings: loader.warnings,
            notes: Vec::new(),
            ground: None,
        };
        scene.sensor = sensor.unwrap_or_else(|| {
            let FirstView { sensor, place } = scene.first_view(Vec3::Y);
            scene.warnings.push(self.warning(&format!("no [sensor]; the camera stands {place}")));
            sensor
        });
        // The camera frames what stands on the ground.
        if let Some(GroundTable { height, diffuse, size }) = ground {
            let ground = Ground {
                height: height.map(|height| height.0),
                albedo: diffuse.map(|albedo| albedo.0),
                size: size.map(|size| size.0.into()),
            };
            ground::add(&mut scene, &ground);
        }
        scene.warnings.extend(scene.dark_because());
        Ok(scene)
    }
}

/// Where the checks of a sensor at `position` take the origin to be, before it is known: at the sensor, if that is far away.
fn far_origin(position: DVec3) -> DVec3 {
    if position.abs().max_element() > 1e4 { position } else { DVec3::ZERO }
}
