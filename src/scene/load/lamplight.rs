//! Whether the lamps of a model, with an area and without, light what its camera sees (from outside, a closed room with a lamp is black), and how far away that is.

use crate::scene::{Luminaire, Projection, Scene, one_minus_cos, widen};
use glam::DVec3;
use rayon::prelude::*;

/// The camera looks along so many rays each way, and at least so many.
const RAYS: u32 = 16;
const LEAST_RAYS: u32 = 4;
/// From what it sees, so many points on lamps are looked for.
const LAMP_POINTS: usize = 8;
/// Larger models are not looked at: each ray is held against each triangle.
const MOST_TRIANGLES: u64 = 1 << 21;
/// Of many triangles fewer rays: so many pairs of a ray and a triangle.
const PAIRS: u64 = 1 << 24;
/// Rays begin and end off surfaces by this share of their length.
const OFF: f64 = 1e-4;

/// A triangle in world space.
struct Face {
    corners: [DVec3; 3],
    emits: bool,
}

/// The share of what the camera sees, lamps left out, that has a lamp in sight; 1 also where nothing else is seen, and where it is not found out.
pub(super) fn lit_share(scene: &Scene) -> f64 {
    let Some(faces) = faces(scene) else { return 1.0 };
    let lamps = lamp_points(&faces);
    let seen: Vec<bool> = seen(scene, &faces)
        .into_par_iter()
        .filter(|seen| !seen.emits)
        .map(|seen| {
            lamps.iter().any(|lamp| is_free(&faces, seen.point, *lamp))
                || scene.luminaires.iter().any(|luminaire| reaches(&faces, luminaire, seen.point))
        })
        .collect();
    let lit = seen.iter().filter(|lit| **lit).count();
    if seen.is_empty() { 1.0 } else { lit as f64 / seen.len() as f64 }
}

/// The middle one of the distances of what the camera sees; that of its target where nothing is seen, or it is not found out.
pub(super) fn distance_of_what_is_seen(scene: &Scene) -> f64 {
    let eye = scene.sensor.position.as_dvec3();
    let mut distances: Vec<f64> = faces(scene)
        .map(|faces| seen(scene, &faces).iter().map(|seen| seen.point.distance(eye)).collect())
        .unwrap_or_default();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(scene.sensor.target.as_dvec3().distance(eye))
}

/// What one ray of the camera meets.
struct Seen {
    /// Off the surface, towards the eye.
    point: DVec3,
    emits: bool,
}

/// What the camera sees, in some of its directions.
fn seen(scene: &Scene, faces: &[Face]) -> Vec<Seen> {
    let Projection::Perspective { fov } = scene.sensor.projection else { return Vec::new() };
    let eye = scene.sensor.position.as_dvec3();
    let forward = (scene.sensor.target.as_dvec3() - eye).normalize_or_zero();
    let right = forward.cross(scene.sensor.up.as_dvec3()).normalize_or_zero();
    let up = right.cross(forward);
    let half = (0.5 * f64::from(fov)).to_radians().tan();
    let aspect = f64::from(scene.film.width) / f64::from(scene.film.height);
    let rays = ((PAIRS / faces.len().max(1) as u64).isqrt() as u32).clamp(LEAST_RAYS, RAYS);
    let seen = (0..rays * rays).into_par_iter().filter_map(|ray| {
        let share = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(rays) - 1.0;
        let direction = forward + half * (aspect * share(ray % rays) * right + share(ray / rays) * up);
        let (face, distance) = nearest(faces, eye, direction)?;
        Some(Seen { point: eye + distance * (1.0 - OFF) * direction, emits: face.emits })
    });
    seen.collect()
}

/// What stops light, and what emits it; none of models that are too large to find it out.
fn faces(scene: &Scene) -> Option<Vec<Face>> {
    if scene.triangle_count() > MOST_TRIANGLES {
        return None;
    }
    let mut faces = Vec::new();
    for object in &scene.objects {
        let to_world = widen(object.object_to_world);
        let mesh = &scene.meshes[object.mesh as usize];
        for triangle in &mesh.triangles {
            let material = scene.material_of(object, triangle);
            let emits = material.emission != glam::Vec3::ZERO;
            if emits || material.opacity >= 0.5 && !material.transmits() {
                let corners =
                    triangle.vertices.map(|v| to_world.transform_point3(mesh.positions[v as usize].as_dvec3()));
                faces.push(Face { corners, emits });
            }
        }
    }
    Some(faces)
}

/// Points on lamps, evenly over their area.
fn lamp_points(faces: &[Face]) -> Vec<DVec3> {
    let area = |face: &Face| {
        let [a, b, c] = face.corners;
        0.5 * (b - a).cross(c - a).length()
    };
    let lamps: Vec<&Face> = faces.iter().filter(|face| face.emits).collect();
    let whole: f64 = lamps.iter().map(|lamp| area(lamp)).sum();
    let (mut points, mut passed) = (Vec::new(), 0.0);
    for lamp in lamps {
        passed += area(lamp);
        while points.len() < LAMP_POINTS && (points.len() as f64 + 0.5) / LAMP_POINTS as f64 * whole <= passed {
            let [a, b, c] = lamp.corners;
            // Not all at one place of a lamp of few triangles.
            let turn = (0.5 + points.len() as f64 * 0.618_033_988_749_895).fract();
            let (u, v) = (0.8 * turn + 0.1, 0.8 * (1.0 - turn) * 0.5 + 0.05);
            points.push(a + u * (b - a) + v * (c - a));
        }
    }
    points
}

/// How many times `direction` it is from `origin` to a triangle (Möller and Trumbore 1997).
fn distance(face: &Face, origin: DVec3, direction: DVec3) -> Option<f64> {
    let [a, b, c] = face.corners;
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let scale = 1.0 / ab.dot(p);
    let from = origin - a;
    let u = from.dot(p) * scale;
    let q = from.cross(ab);
    let v = direction.dot(q) * scale;
    // A ray along the plane has no number here, and meets nothing.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) * scale).filter(|distance| *distance > 0.0)
}

fn nearest(faces: &[Face], origin: DVec3, direction: DVec3) -> Option<(&Face, f64)> {
    let met = faces.iter().filter_map(|face| Some((face, distance(face, origin, direction)?)));
    met.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether a luminaire without an area has a point in sight, and sends light there.
fn reaches(faces: &[Face], luminaire: &Luminaire, point: DVec3) -> bool {
    if !luminaire.emits() {
        return false;
    }
    match luminaire {
        Luminaire::Point { position, .. } | Luminaire::Photometric { position, .. } => {
            is_free(faces, point, position.as_dvec3())
        }
        Luminaire::Spot { position, direction, outer, .. } => {
            let position = position.as_dvec3();
            let cosine = (point - position).normalize_or_zero().dot(direction.as_dvec3());
            1.0 - cosine < one_minus_cos((*outer).into()) && is_free(faces, point, position)
        }
        Luminaire::Infinite { direction, .. } | Luminaire::Sun { direction, .. } => {
            !faces.iter().any(|face| distance(face, point, -direction.as_dvec3()).is_some())
        }
    }
}

/// Whether nothing is between two points but at their ends.
fn is_free(faces: &[Face], from: DVec3, to: DVec3) -> bool {
    !faces.iter().any(|face| distance(face, from, to - from).is_some_and(|d| d < 1.0 - OFF))
}
