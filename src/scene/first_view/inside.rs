//! Views from within: whether the scene is a room, and where in it the camera stands.

use super::fit::{Eye, axes};
use super::solid::Solid;
use super::trial::Trial;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Points that are looked at along a side of the bounds of length 1 (half the longest).
const GRID: f64 = 4.5;
/// Directions around each point.
const AROUND: usize = 48;
/// A point is enclosed if so many of the directions around it meet something, those up left out: an atrium is a room.
const ENCLOSED: f64 = 0.9;
/// Of these hits, as many must be on outward sides where the point is in the air, not within a body.
const AIR: f64 = 0.7;
/// The cosine between a level floor's normal and the vertical, at least.
const LEVEL: f64 = 0.97;
/// Part of the bounds that is enclosed air in a room: a house of several rooms has less in each, and a body none.
const ROOM: f64 = 0.5;
/// Where the winding says nothing, the points that are enclosed, and the triangles that nobody sees from outside.
const SHELL: f64 = 0.8;
const HIDDEN: f64 = 0.6;
/// Places that are tried, and directions around each, and at how many heights.
const PLACES: usize = 120;
const TURNS: usize = 48;
const TILTS: [f64; 5] = [-24.0, -10.0, 0.0, 10.0, 24.0];
/// What is nearer than this part of the room's height, or of its width if it is narrow, is too near.
const NEAR: f64 = 0.35;
/// Directions that are kept of each place, and views of all places, to be looked at more closely; and how much it counts what they show.
const TURNS_KEPT: usize = 6;
const VIEWS: usize = 80;
const CONTENT: f64 = 2.0;
/// The eye's part of the height between floor and ceiling.
const EYE: f64 = 0.4;
/// Half the horizontal field of view, if the picture is as wide as it is high or wider, and the most of half the vertical one; in degrees.
const HALF_WIDTH: f64 = 36.0;
const HALF_HEIGHT: f64 = 33.0;

/// A point that is enclosed.
struct Place {
    point: DVec3,
    /// How far down a floor is.
    floor: f64,
    /// Whether what surrounds it turns its outward sides to it.
    is_air: bool,
}

/// One of evenly spread directions.
fn spread(index: usize, count: usize) -> DVec3 {
    let y = 1.0 - (2.0 * index as f64 + 1.0) / count as f64;
    let (sin, cos) = (index as f64 * 2.399_963_229_728_653).sin_cos();
    let radius = (1.0 - y * y).sqrt();
    DVec3::new(radius * cos, y, radius * sin)
}

/// Enclosed places, over a level floor, of a grid in the bounds; and of how many.
fn survey(solid: &Solid, frame: DMat3) -> (Vec<Place>, usize) {
    let half = frame.transpose().abs() * solid.half.as_dvec3();
    let counts = half.to_array().map(|h| ((2.0 * GRID * h).round() as usize).max(3));
    let directions: Vec<(DVec3, bool)> =
        (0..AROUND).map(|n| spread(n, AROUND)).map(|d| (frame * d, d.y < 0.5)).collect();
    let level = directions.iter().filter(|(_, level)| *level).count() as f64;
    let down = -frame.y_axis;
    let of = counts.iter().product();
    let mut places = Vec::new();
    for n in 0..of {
        let cell = [n % counts[0], n / counts[0] % counts[1], n / (counts[0] * counts[1])];
        // A little off the middle, where models have edges.
        let at = DVec3::from_array(std::array::from_fn(|i| (cell[i] as f64 + 0.513) / counts[i] as f64 * 2.0 - 1.0));
        let point = frame * (half * at);
        let floor = solid.meet_opaque(point, down);
        let Some(floor) = floor.filter(|hit| hit.normal.as_dvec3().dot(down).abs() > LEVEL) else { continue };
        let (mut hits, mut missed, mut front) = (0, 0, 0);
        for (direction, is_level) in &directions {
            if let Some(hit) = solid.meet_opaque(point, *direction) {
                hits += 1;
                front += usize::from(hit.front);
            } else if *is_level {
                missed += 1;
                if f64::from(missed) > (1.0 - ENCLOSED) * level {
                    break;
                }
            }
        }
        if f64::from(missed) <= (1.0 - ENCLOSED) * level {
            let is_air = front as f64 >= AIR * f64::from(hits);
            places.push(Place { point, floor: f64::from(floor.distance), is_air });
        }
    }
    (places, of)
}

/// The part of the triangles that are seen from nowhere outside.
fn hidden(solid: &Solid) -> f64 {
    let step = solid.len().div_ceil(500);
    let (mut all, mut hidden) = (0, 0);
    for [a, b, c] in solid.corners().step_by(step) {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let middle = (a + b + c) / 3.0;
        all += 1;
        let seen = (0..24).any(|n| {
            let direction = spread(n, 24).as_vec3();
            let side = if normal.dot(direction.into()) > 0.0 { 1e-4 } else { -1e-4 };
            solid.meet_opaque((middle + normal * side).as_dvec3(), direction.as_dvec3()).is_none()
        });
        hidden += usize::from(!seen);
    }
    hidden as f64 / all as f64
}

/// The camera in a room; none if the scene is not one: most of its bounds would be air that is enclosed, over a level floor.
pub(super) fn view(solid: &Solid, frame: DMat3, aspect: f64) -> Option<Eye> {
    let (places, of) = survey(solid, frame);
    let part = |n: usize| n as f64 / of as f64;
    let mut air: Vec<&Place> = places.iter().filter(|place| place.is_air).collect();
    if part(air.len()) < ROOM {
        if part(places.len()) < SHELL || hidden(solid) < HIDDEN {
            return None;
        }
        air = places.iter().collect();
    }
    best(solid, frame, aspect, &air)
}

/// The camera with the widest view: at eye height over one of the floors, level.
fn best(solid: &Solid, frame: DMat3, aspect: f64, air: &[&Place]) -> Option<Eye> {
    let half_height = (HALF_WIDTH.to_radians().tan() / aspect).min(HALF_HEIGHT.to_radians().tan());
    let tangents = [half_height * aspect, half_height];
    let eyes = eyes(solid, frame, air);
    let step = eyes.len().div_ceil(PLACES).max(1);
    let mut views: Vec<(f64, Eye)> = Vec::new();
    for (position, height) in eyes.into_iter().step_by(step) {
        let mut scores: Vec<_> = outlook(solid, frame, position, height, tangents[0]).into_iter().enumerate().collect();
        scores.sort_by(|a, b| b.1.total_cmp(&a.1));
        for (turn, score) in scores.into_iter().take(TURNS_KEPT) {
            let forward = direction(frame, turn, 0.0);
            let depth = solid.meet_opaque(position, forward).map_or(1.0, |hit| f64::from(hit.distance));
            views.push((score, Eye { position, axes: axes(forward, frame.y_axis), tangents, depth }));
        }
    }
    views.sort_by(|a, b| b.0.total_cmp(&a.0));
    views.truncate(VIEWS);
    let mut found: Option<(f64, Eye)> = None;
    for (score, eye) in views {
        let score = score * (1.0 + CONTENT * Trial::new(solid, &eye).content());
        if found.as_ref().is_none_or(|(best, _)| score > *best) {
            found = Some((score, eye));
        }
    }
    found.map(|(_, eye)| eye)
}

/// Eye points over the floors below places, and the height of the room there.
fn eyes(solid: &Solid, frame: DMat3, air: &[&Place]) -> Vec<(DVec3, f64)> {
    let up = frame.y_axis;
    let top = up.abs().dot(solid.half.as_dvec3());
    let mut eyes: Vec<(DVec3, f64)> = Vec::new();
    for place in air {
        let floor = place.point - up * place.floor;
        let height =
            solid.meet_opaque(place.point, up).map_or(top - floor.dot(up), |hit| f64::from(hit.distance) + place.floor);
        let eye = floor + up * EYE * height;
        // Points above each other stand on one floor, or on several.
        let is_known = |other: DVec3| (other - eye).reject_from(up).length() < 1e-6 && other.distance(eye) < 0.05;
        if !eyes.iter().any(|(other, _)| is_known(*other)) {
            eyes.push((eye, height));
        }
    }
    eyes
}

/// For each turn, how far one sees in a picture of this width on average, less if much of it is too near.
fn outlook(solid: &Solid, frame: DMat3, position: DVec3, height: f64, tangent: f64) -> Vec<f64> {
    let seen: Vec<[f64; TILTS.len()]> = (0..TURNS)
        .map(|turn| {
            TILTS.map(|tilt| {
                let hit = solid.meet_opaque(position, direction(frame, turn, tilt.to_radians()));
                hit.map_or(1.0, |hit| f64::from(hit.distance))
            })
        })
        .collect();
    let level = TILTS.len() / 2;
    let widths = (0..TURNS / 2).map(|turn| seen[turn][level] + seen[turn + TURNS / 2][level]);
    let near = NEAR * widths.fold(height, f64::min);
    let reach = (tangent.atan() / TAU * TURNS as f64).floor() as usize;
    (0..TURNS)
        .map(|turn| {
            let window = (0..=2 * reach).flat_map(|i| seen[(turn + TURNS + i - reach) % TURNS]);
            let [far, too_near] =
                window.fold([0.0; 2], |[sum, n], far| [sum + far, n + f64::from(u8::from(far < near))]);
            let rays = ((2 * reach + 1) * TILTS.len()) as f64;
            far / rays * (1.0 - 2.0 * too_near / rays).max(0.0)
        })
        .collect()
}

/// A direction, so many turns from the front to the right, and tilted upwards.
fn direction(frame: DMat3, turn: usize, tilt: f64) -> DVec3 {
    let (sin, cos) = (turn as f64 / TURNS as f64 * TAU).sin_cos();
    frame * DVec3::new(tilt.cos() * sin, tilt.sin(), tilt.cos() * cos)
}
