//! Scenes that lie far from the origin, as those of surveyors do: they are moved before their numbers are rounded to single precision.
//!
//! Ordinary scenes are not touched: moving begins where coordinates are [`FAR`] times as large as what they describe, which costs single precision
//! more than four of its twenty-four bits.

use crate::scene::{Mesh, Object, moved_box};
use glam::{DAffine3, DVec3, Vec3};
use std::sync::Arc;

/// Coordinates this many times as large as the extent are far away.
const FAR: f64 = 16.0;
/// Half a unit in the last place of single precision.
const ROUNDOFF: f64 = f32::EPSILON as f64 * 0.5;
/// Where an object is known no better than to this part of its size, somebody has to hear of it.
const BLURRED: f64 = 1.0 / 64.0;

/// Where a mesh lies in the coordinates of its file.
#[derive(Debug, Default)]
pub(super) struct FilePlace {
    /// What was subtracted from the vertices.
    pub origin: DVec3,
    /// The vertices of a mesh with an origin, as its file has them; empty for others.
    pub exact: Vec<DVec3>,
}

/// What is subtracted from the coordinates within these bounds: zero unless they are far away, else about their middle, a multiple of a power of
/// two, so that it has few digits.
pub(super) fn origin_of(low: DVec3, high: DVec3) -> DVec3 {
    let (reach, extent) = (low.abs().max(high.abs()).max_element(), (high - low).length());
    if !(reach > FAR * extent && extent > 0.0 && reach.is_finite()) {
        return DVec3::ZERO;
    }
    let step = extent.log2().floor().exp2();
    (0.5 * (low + high) / step).round() * step
}

/// Moves the scene to where single precision can hold it: meshes, and the objects that stand at `to_world` in the coordinates of the files. Gives
/// the scene's origin in these.
pub(super) fn settle(
    meshes: &mut [Arc<Mesh>],
    places: &mut [FilePlace],
    objects: &mut [Object],
    to_world: &[DAffine3],
    warnings: &mut Vec<String>,
) -> DVec3 {
    let bounds: Vec<[DVec3; 2]> = meshes
        .iter()
        .zip(&*places)
        .map(|(mesh, place)| {
            let (low, high) = mesh.bounds();
            [low, high].map(|corner| corner.as_dvec3() + place.origin)
        })
        .collect();
    let boxes: Vec<[DVec3; 2]> =
        objects.iter().zip(to_world).map(|(object, map)| moved_box(bounds[object.mesh as usize], map)).collect();
    let (low, high) =
        boxes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), b| (low.min(b[0]), high.max(b[1])));
    let origin = origin_of(low, high);
    if origin != DVec3::ZERO {
        // What stands where its file says shares the scene's origin: then nothing is left to move.
        for (object, _) in objects.iter().zip(to_world).filter(|(_, map)| **map == DAffine3::IDENTITY) {
            let place = &mut places[object.mesh as usize];
            if !place.exact.is_empty() && place.origin != origin {
                place.origin = origin;
                recentre(Arc::make_mut(&mut meshes[object.mesh as usize]), &place.exact, origin, warnings);
            }
        }
    }
    for (object, map) in objects.iter_mut().zip(to_world) {
        let from = places[object.mesh as usize].origin;
        if from != DVec3::ZERO || origin != DVec3::ZERO {
            let translation = map.matrix3 * from + (map.translation - origin);
            object.object_to_world = DAffine3 { translation, ..*map }.as_affine3a();
        }
    }
    warn_of_blur(objects, &boxes, origin, warnings);
    origin
}

/// Gives a mesh another origin. Triangles that single precision flattens there are dropped.
fn recentre(mesh: &mut Mesh, exact: &[DVec3], origin: DVec3, warnings: &mut Vec<String>) {
    mesh.positions = exact.iter().map(|p| (*p - origin).as_vec3()).collect();
    let positions: &[Vec3] = &mesh.positions;
    let before = mesh.triangles.len();
    mesh.triangles.retain(|triangle| {
        let [a, b, c] = triangle.vertices.map(|v| positions[v as usize].as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    });
    let lost = before - mesh.triangles.len();
    if lost > 0 {
        warnings.push(format!(
            "{}: {lost} triangle(s) are lost: they are too small for single precision, so far from the middle of the scene",
            mesh.name
        ));
    }
}

/// Objects so far from the scene's origin that single precision cannot say where they are.
fn warn_of_blur(objects: &[Object], boxes: &[[DVec3; 2]], origin: DVec3, warnings: &mut Vec<String>) {
    let error = |[low, high]: &[DVec3; 2]| ROUNDOFF * (*low - origin).abs().max((*high - origin).abs()).max_element();
    let blurred: Vec<usize> = (0..objects.len())
        .filter(|index| {
            let [low, high] = &boxes[*index];
            error(&boxes[*index]) > BLURRED * (*high - *low).length()
        })
        .collect();
    let Some(first) = blurred.first() else { return };
    let [low, high] = boxes[*first];
    let distance = (0.5 * (low + high) - origin).length();
    let more = if blurred.len() > 1 { format!(" (and {} more like it)", blurred.len() - 1) } else { String::new() };
    warnings.push(format!(
        "the object `{}` is {:.3e} large and {distance:.3e} away from the middle of the scene: single precision knows its points only to \
         {:.1e}, and details below that are lost{more}; render what is so far apart in scenes of its own",
        objects[*first].name,
        (high - low).length(),
        2.0 * error(&boxes[*first]),
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_far_away_is_moved() {
        let at = |x: f64, size: f64| origin_of(DVec3::splat(x), DVec3::splat(x) + DVec3::X * size);
        assert_eq!([at(0.0, 1.0), at(5.0, 1.0), at(-9.0, 2.0), at(1e6, 0.0), at(1e6, 1e5)], [DVec3::ZERO; 5]);
        let origin = at(5_654_321.234, 20.0);
        assert_eq!(origin, DVec3::new(5_654_336.0, 5_654_320.0, 5_654_320.0));
    }
}
