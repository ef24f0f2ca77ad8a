//! Scene files in TOML; `scenes/README.md` describes the format.

mod advice;
mod cameras;
mod contents;
mod file;
mod foreign_words;
mod luminaires;
mod materials;
mod radians;
mod settings;
mod tables;
mod values;

use super::choices::Choices;
use super::ground::{self, Ground};
use super::loader::Loader;
use super::text_file::line_and_column;
use super::{environment, reach};
use crate::scene::build::pinhole;
use crate::scene::{Camera, FirstView, Projection, RenderSettings, Scene};
use crate::{Error, Result};
use advice::{in_plain_words, wrong_brackets};
pub(super) use cameras::camera_file;
use file::{File, read_text};
use glam::Vec3;
use std::path::Path;
use tables::{GroundTable, SceneFile};

/// How the warning of a scene file without a camera begins; where the camera stands follows.
pub(super) const NO_SENSOR: &str = "no [sensor]; the camera stands ";

/// Loads a scene file.
pub(super) fn load(path: &Path, choices: &Choices) -> Result<Scene> {
    let text = read_text(path)?;
    let file = File { path, text: &text };
    file.build(file.parse()?, choices)
}

impl File<'_> {
    /// The tables of the file.
    fn parse(&self) -> Result<SceneFile> {
        if let Some((span, message)) = wrong_brackets(self.text) {
            return Err(self.error(span, message));
        }
        ::toml::from_str(self.text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            self.error(span.clone(), in_plain_words(error.message().trim(), self.text, span))
        })
    }

    fn build(&self, mut file: SceneFile, choices: &Choices) -> Result<Scene> {
        let Choices { sky, ground, smooth: _, up: _, fill: _, view: _ } = choices;
        if sky.is_some() {
            file.environment = None;
        }
        let ground = match (ground, file.ground) {
            (None | Some(true), Some(table)) => Some(table),
            (None | Some(false), _) => None,
            (Some(true), None) => Some(GroundTable::default()),
        };
        let film = self.film(file.film)?;
        let mut warnings = Vec::new();
        let integrator = self.integrator(&file.integrator.take().unwrap_or_default(), &mut warnings)?;
        // What is wrong in this file is said before any other file is read.
        let cameras = self.cameras(file.sensor.as_ref(), None)?;
        for table in &file.luminaire {
            self.check_luminaire(table)?;
        }
        let mut loader = Loader::new(self.materials(&file.material)?);
        loader.files.push(self.path.to_owned());
        loader.warnings.append(&mut warnings);
        if let Some(image) = file.environment.as_ref().and_then(|table| table.get_ref().image.as_ref()) {
            loader.files.extend(Some(self.beside(image.get_ref())).filter(|path| path.is_file()));
        }
        for camera in &cameras {
            if let Projection::Perspective { fov } = camera.sensor.projection
                && let Some(warning) = radians::field_of_view(fov)
            {
                loader.warnings.push(self.warning(&warning));
            }
        }
        let turns = [
            ("rotate", file.environment.as_ref().and_then(|table| table.get_ref().rotate.as_ref())),
            ("blade_rotation", file.sensor.as_ref().and_then(|sensors| sensors.get_ref().blade_rotation())),
        ];
        for (key, turn) in turns {
            if let Some(turn) = turn
                && let Some(warning) = radians::turn(key, turn.get_ref().0)
            {
                let (line, _) = line_and_column(self.text, turn.span().start);
                loader.warnings.push(format!("{}:{line}: {warning}", self.path.display()));
            }
        }
        let environment = match (sky, &file.environment) {
            (Some(sky), _) => environment::of(sky, &mut loader.files, &mut loader.warnings)?,
            (None, Some(table)) => self.environment(table, &mut loader.warnings)?,
            (None, None) => None,
        };
        let (mut objects, mut to_world) = (Vec::new(), Vec::new());
        for table in &file.object {
            for (object, place) in self.objects(table, &mut loader)? {
                objects.push(object);
                to_world.push(place);
            }
        }
        if objects.is_empty() {
            return Err(Error::scene(self.path, "nothing to trace: the scene file has no [[object]]"));
        }
        let origin = loader.settle(&mut objects, &to_world);
        let cameras: Vec<Camera> = self.cameras(file.sensor.as_ref(), Some(origin))?;
        let mut luminaires = Vec::new();
        for table in &file.luminaire {
            luminaires.push(self.luminaire(table, origin, &mut loader)?);
        }
        let defaults = RenderSettings::default();
        let settings = RenderSettings {
            spp: file.render.spp.map_or(defaults.spp, |spp| spp.0),
            seed: file.render.seed.unwrap_or(defaults.seed),
            exposure: file.render.exposure.map_or(defaults.exposure, |exposure| exposure.0),
            tone: file.render.tone.unwrap_or(defaults.tone),
            sampler: file.render.sampler.unwrap_or(defaults.sampler),
            transparent: defaults.transparent,
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
            // Until the scene can be looked at.
            sensor: pinhole(Vec3::Z, Vec3::ZERO, Vec3::Y, 40.0),
            cameras,
            film,
            integrator,
            settings,
            files: loader.files,
            warnings: loader.warnings,
            notes: loader.notes,
            ground: None,
        };
        reach::check(&scene)?;
        scene.sensor = match scene.cameras.first() {
            Some(camera) => camera.sensor.clone(),
            None => {
                let FirstView { sensor, place, inside: _ } = scene.first_view(Vec3::Y);
                scene.warnings.push(self.warning(&format!("{NO_SENSOR}{place}")));
                sensor
            }
        };
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
