//! The cameras of a scene file, `[sensor]` or `[[sensor]]`, and of a file that holds nothing else.

use super::file::{File, read_text};
use super::tables::{SceneFile, SensorTable, Sensors};
use super::values::Finite;
use crate::scene::{Camera, Exposure, Tone};
use crate::{Error, Result};
use ::toml::Spanned;
use glam::DVec3;
use std::ops::Range;
use std::path::Path;

impl Sensors {
    /// The tables; `whole` is the place of all.
    fn tables(&self, whole: Range<usize>) -> Vec<(&SensorTable, Range<usize>)> {
        match self {
            Sensors::One(table) => vec![(table, whole)],
            Sensors::Several(tables) => tables.iter().map(|table| (table.get_ref(), table.span())).collect(),
        }
    }

    /// The first one's turn of its aperture.
    pub(super) fn blade_rotation(&self) -> Option<&Spanned<Finite>> {
        self.tables(0..0).into_iter().find_map(|(table, _)| table.blade_rotation.as_ref())
    }
}

impl File<'_> {
    /// The cameras, in a scene with this origin; before it is known, only to have them checked.
    pub(super) fn cameras(&self, sensors: Option<&Spanned<Sensors>>, origin: Option<DVec3>) -> Result<Vec<Camera>> {
        let Some(sensors) = sensors else { return Ok(Vec::new()) };
        let tables = sensors.get_ref().tables(sensors.span());
        let several = tables.len() > 1;
        let mut cameras: Vec<Camera> = Vec::new();
        for (table, span) in tables {
            let name = table.name.as_ref().map_or("", |name| name.get_ref().trim());
            let place = || table.name.as_ref().map_or(span.clone(), Spanned::span);
            if name.is_empty() && (several || table.name.is_some()) {
                let message = "a camera needs a `name` by which --camera can choose it, as name = \"front\"";
                return Err(self.error(place(), message));
            }
            if cameras.iter().any(|camera| !name.is_empty() && camera.name == name) {
                return Err(self.error(place(), format!("there are two cameras `{name}`: give each a name of its own")));
            }
            let origin = origin.unwrap_or_else(|| far_origin(table.position.0));
            cameras.push(Camera { name: name.to_owned(), sensor: self.sensor(table, span, origin)? });
        }
        Ok(cameras)
    }
}

/// Where the checks of a sensor at `position` take the origin to be, before it is known: at the sensor, if that is far away.
fn far_origin(position: DVec3) -> DVec3 {
    if position.abs().max_element() > 1e4 { position } else { DVec3::ZERO }
}

/// What a file tells of a camera alone.
pub(in crate::scene::load) struct CameraFile {
    /// Its cameras; never empty.
    pub cameras: Vec<Camera>,
    /// The exposure, if it is there.
    pub exposure: Option<Exposure>,
    /// The tone curve, if it is there.
    pub tone: Option<Tone>,
    /// Which of its tables, and keys of `[render]`, say nothing about a camera, as they are written.
    pub others: Vec<&'static str>,
}

/// Reads a file with a camera of a scene with this origin: what the window writes, or another scene file.
pub(in crate::scene::load) fn camera_file(path: &Path, origin: DVec3) -> Result<CameraFile> {
    let text = read_text(path)?;
    let file = File { path, text: &text };
    let tables = file.parse()?;
    let cameras = file.cameras(tables.sensor.as_ref(), Some(origin))?;
    if cameras.is_empty() {
        return Err(Error::scene(path, "no [sensor] in it: key C of `luminaire view` writes a file with one"));
    }
    let SceneFile { film, sensor: _, environment, integrator, render, object, material, luminaire, ground } = tables;
    let others = [
        (film.is_some(), "[film]"),
        (environment.is_some(), "[environment]"),
        (ground.is_some(), "[ground]"),
        (integrator.is_some(), "[integrator]"),
        (!object.is_empty(), "[[object]]"),
        (!material.is_empty(), "[[material]]"),
        (!luminaire.is_empty(), "[[luminaire]]"),
        (render.spp.is_some(), "`spp`"),
        (render.seed.is_some(), "`seed`"),
        (render.sampler.is_some(), "`sampler`"),
    ];
    let others = others.into_iter().filter(|(there, _)| *there).map(|(_, name)| name).collect();
    Ok(CameraFile { cameras, exposure: render.exposure.map(|exposure| exposure.0), tone: render.tone, others })
}
