//! What a model file has: meshes where they stand, and perhaps cameras and luminaires.

use super::reach::LARGEST_COORDINATE;
use crate::scene::{Camera, Luminaire, Sensor};
use glam::{DAffine3, DVec3, Vec3};
use std::collections::HashSet;

/// Eye point and target are kept apart by this part of their largest coordinate, so that they stay distinct in single precision.
const NEAREST: f64 = 2e-6;
/// A camera's `up` is none if its sine to the line of sight is less.
const PARALLEL: f64 = 1e-6;
/// The volume of a transformed cube against the box of the same edges: below it single precision loses all of it.
const FLAT: f64 = 1e-6;

/// What a model file has; an OBJ file one mesh and nothing else.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// Its meshes, each as often as it stands somewhere.
    pub placed: Vec<Placed>,
    /// Its cameras, and from their spaces to the file's: a camera stands at the origin of its own, looks along -z, and y is up in its picture. Of the sensor only what it
    /// has by itself counts: projection, lens and shift.
    pub cameras: Vec<(Camera, DAffine3)>,
    /// Its luminaires without an area, each in its own space, and from there to the file's. What they send is what they send, whatever scales their spaces.
    pub luminaires: Vec<(Luminaire, DAffine3)>,
}

/// A mesh where it stands.
#[derive(Debug)]
pub(super) struct Placed {
    /// Its number among those of the loader; it has triangles.
    pub mesh: u32,
    /// From its space to the file's. May mirror and scale unevenly; where it flattens, the mesh is left out.
    pub matrix: DAffine3,
    /// For messages.
    pub name: String,
}

/// How a model is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(super) struct Reading {
    /// Bits of an angle in degrees: vertex normals are made where the file has none; faces share them that differ by less.
    pub smooth: Option<u32>,
    /// `smooth` counts only where the file says nothing of smoothness: of an OBJ, that it has neither normals (`vn`) nor groups (`s`, `s off` included).
    pub smooth_if_unsaid: bool,
    /// The colours of its vertices are left out.
    pub without_colours: bool,
}

impl Model {
    /// Where its meshes stand if its own space stands at `to_world`; those come second that cannot be shown there.
    pub(super) fn standing(&self, to_world: DAffine3) -> (Vec<(&Placed, DAffine3)>, Vec<&Placed>) {
        let mut standing = Vec::new();
        let mut flat = Vec::new();
        for placed in &self.placed {
            let map = product(to_world, placed.matrix);
            if can_be_inverted(&map) { standing.push((placed, map)) } else { flat.push(placed) }
        }
        (standing, flat)
    }

    /// Its cameras in a scene with this origin, the model's space standing at `to_world`; each looks at a point about as far away as the middle of these bounds. Each has a
    /// name of its own. What cannot be a camera is a warning.
    pub(super) fn cameras(
        &self,
        to_world: DAffine3,
        origin: DVec3,
        bounds: (DVec3, DVec3),
        warnings: &mut Vec<String>,
    ) -> Vec<Camera> {
        let mut names = HashSet::new();
        let mut cameras = Vec::new();
        for (Camera { name, sensor }, matrix) in &self.cameras {
            let Some(sensor) = standing(sensor, product(to_world, *matrix), origin, bounds) else {
                warnings
                    .push(format!("the camera `{name}` is left out: its transform flattens it, or takes it too far"));
                continue;
            };
            cameras.push(Camera { name: own_name(name, &mut names), sensor });
        }
        cameras
    }

    /// Its luminaires in a scene with this origin, the model's space standing at `to_world`. What cannot be one is a warning.
    pub(super) fn luminaires(&self, to_world: DAffine3, origin: DVec3, warnings: &mut Vec<String>) -> Vec<Luminaire> {
        let mut left_out = 0;
        let luminaires = self.luminaires.iter().filter_map(|(luminaire, matrix)| {
            let stood = shining(luminaire, product(to_world, *matrix), origin);
            left_out += usize::from(stood.is_none());
            stood
        });
        let luminaires = luminaires.collect();
        if left_out > 0 {
            let what = "their transforms flatten them, or take them too far";
            warnings.push(format!("{left_out} luminaire(s) of the model are left out: {what}"));
        }
        luminaires
    }
}

/// The one map after the other; `b` first. What stands in the file where it stands in its own space keeps every bit of `a`.
fn product(a: DAffine3, b: DAffine3) -> DAffine3 {
    if b == DAffine3::IDENTITY { a } else { a * b }
}

/// Whether single precision can take an object to the world and back.
pub(super) fn can_be_inverted(to_world: &DAffine3) -> bool {
    let rounded = to_world.as_affine3a();
    let m = to_world.matrix3;
    let edges = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    m.determinant().abs() > FLAT * edges && rounded.is_finite() && rounded.inverse().is_finite()
}

/// A sensor at a place.
fn standing(sensor: &Sensor, map: DAffine3, origin: DVec3, (low, high): (DVec3, DVec3)) -> Option<Sensor> {
    let forward = map.transform_vector3(DVec3::NEG_Z).try_normalize()?;
    let up = map.transform_vector3(DVec3::Y).try_normalize()?;
    let position = place(map.translation, origin)?;
    if up.cross(forward).length() < PARALLEL {
        return None;
    }
    let eye = position.as_dvec3();
    let ahead = (0.5 * (low + high) - eye).dot(forward);
    // What looks past everything.
    let distance = if ahead > 0.0 { ahead } else { 0.5 * low.distance(high) };
    let reach = eye.abs().max_element() + origin.abs().max_element();
    let distance = distance.max(NEAREST * reach).max(f64::from(f32::MIN_POSITIVE));
    let target = place(eye + distance * forward + origin, origin)?;
    Some(Sensor { position, target, up: up.as_vec3(), ..sensor.clone() })
}

/// A luminaire at a place.
fn shining(luminaire: &Luminaire, map: DAffine3, origin: DVec3) -> Option<Luminaire> {
    let mut luminaire = luminaire.clone();
    let towards = |direction: Vec3| unit(map.transform_vector3(direction.as_dvec3()));
    let at = |position: Vec3| place(map.transform_point3(position.as_dvec3()), origin);
    match &mut luminaire {
        Luminaire::Point { position, .. } => *position = at(*position)?,
        Luminaire::Spot { position, direction, .. } => {
            (*position, *direction) = (at(*position)?, towards(*direction)?);
        }
        Luminaire::Photometric { position, direction, up, .. } => {
            (*position, *direction, *up) = (at(*position)?, towards(*direction)?, towards(*up)?);
        }
        Luminaire::Infinite { direction, .. } | Luminaire::Sun { direction, .. } => *direction = towards(*direction)?,
    }
    Some(luminaire)
}

/// A point in the coordinates of the files, in a scene with this origin, as a scene file can say it.
fn place(point: DVec3, origin: DVec3) -> Option<Vec3> {
    let is_near = point.is_finite() && point.abs().max_element() <= LARGEST_COORDINATE;
    is_near.then(|| said((point - origin).as_vec3(), origin))
}

/// A point of a scene with this origin, as a scene file can say it in the coordinates of the files.
pub(super) fn said(point: Vec3, origin: DVec3) -> Vec3 {
    (point.as_dvec3() + origin - origin).as_vec3()
}

/// A unit vector in single precision; who makes it one again, as a scene file does, gets the same. Of a hundredth of those that are merely rounded that is not true, but of one
/// beside them.
fn unit(direction: DVec3) -> Option<Vec3> {
    let rounded = direction.try_normalize()?.as_vec3();
    let beside = (0..3).rev().flat_map(|axis| {
        [1, u32::MAX].map(|step| {
            let mut next = rounded;
            next[axis] = f32::from_bits(next[axis].to_bits().wrapping_add(step));
            next
        })
    });
    let stays = |unit: &Vec3| unit.as_dvec3().normalize().as_vec3() == *unit;
    std::iter::once(rounded).chain(beside).find(stays).or(Some(rounded))
}

/// A name that is not taken, and is from now on.
fn own_name(name: &str, taken: &mut HashSet<String>) -> String {
    let name = if name.trim().is_empty() { "camera" } else { name.trim() };
    let others = (2..).map(|number| format!("{name} {number}"));
    let own = std::iter::once(name.to_owned()).chain(others).find(|name| !taken.contains(name)).unwrap_or_default();
    taken.insert(own.clone());
    own
}

#[cfg(test)]
mod tests;
