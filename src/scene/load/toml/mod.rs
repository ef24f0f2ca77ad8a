//! Scene files in TOML; `scenes/README.md` describes the format.

mod advice;
mod contents;
mod file;
mod foreign_words;
mod radians;
mod settings;
mod tables;
mod values;

use super::bare_mesh;
use super::loader::Loader;
use super::text_file::read_bytes;
use crate::scene::{Projection, RenderSettings, Scene, Sensor};
use crate::{Error, Result};
use advice::{in_plain_words, wrong_brackets};
use file::File;
use glam::Vec3;
use std::path::Path;
use tables::SceneFile;

/// Loads a scene file.
pub(super) fn load(path: &Path) -> Result<Scene> {
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
    file.build(scene)
}

impl File<'_> {
    fn build(&self, file: SceneFile) -> Result<Scene> {
        let film = self.film(file.film)?;
        let integrator = self.integrator(&file.integrator)?;
        let mut luminaires = Vec::new();
        for table in file.luminaire {
            luminaires.push(self.luminaire(&table)?);
        }
        let sensor = file.sensor.map(|table| self.sensor(&table)).transpose()?;
        let mut loader = Loader::new(self.materials(&file.material)?);
        if let Some(Projection::Perspective { fov }) = sensor.as_ref().map(|sensor| sensor.projection)
            && let Some(warning) = radians::field_of_view(fov)
        {
            loader.warnings.push(self.warning(&warning));
        }
        let environment = match &file.environment {
            None => None,
            Some(table) => self.environment(table, &mut loader.warnings)?,
        };
        let mut objects = Vec::new();
        for table in &file.object {
            objects.push(self.object(table, &mut loader)?);
        }
        if objects.is_empty() {
            return Err(Error::scene(self.path, "nothing to trace: the scene file has no [[object]]"));
        }
        let defaults = RenderSettings::default();
        let settings = RenderSettings {
            spp: file.render.spp.map_or(defaults.spp, |spp| spp.0),
            seed: file.render.seed.unwrap_or(defaults.seed),
            exposure: file.render.exposure.map_or(defaults.exposure, |exposure| exposure.0),
            sampler: file.render.sampler.unwrap_or(defaults.sampler),
        };
        let (materials, textures) = loader.finish_materials(&objects);
        let mut scene = Scene {
            path: self.path.to_owned(),
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
            warnings: loader.warnings,
        };
        scene.sensor = sensor.unwrap_or_else(|| {
            let sensor = bare_mesh::framing_sensor(&scene);
            scene.warnings.push(self.warning("no [sensor]; the camera is placed to frame the scene"));
            sensor
        });
        scene.warnings.extend(scene.dark_because());
        Ok(scene)
    }
}
