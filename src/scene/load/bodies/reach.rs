//! Bodies of glass that reach through each other's surface. Each face knows the index behind it over that in front, and no more; so where two bodies overlap
//! their indices multiply.
//!
//! What lies wholly within another body, or touches it, is none of these. Points of the surfaces are tested, so that an overlap of a small part may be missed.

use super::around::solid_angle;
use super::glass::Use;
use super::seams::{Part, Seams};
use crate::scene::load::loader::listed;
use crate::scene::{Scene, moved_box, widen};
use glam::DVec3;
use std::f64::consts::PI;

/// Bodies that are compared, with all instances; of more none is.
const MOST_BODIES: usize = 1 << 16;
/// Pairs of bodies whose boxes overlap that are compared.
const MOST_PAIRS: usize = 1 << 10;
/// Faces of a body that is compared with others.
const MOST_FACES: usize = 1 << 19;
/// Solid angles of triangles for a pair of bodies, and for all of them, before the last pair.
const ANGLES_OF_A_PAIR: usize = 1 << 18;
const MOST_ANGLES: usize = 1 << 25;
/// Points of a body that are tested against another: at least and at most.
const POINTS: [usize; 2] = [16, 256];
/// Bodies that reach less far into each other, as a part of the size of the smaller one, touch.
const TOUCHING: f64 = 1e-4;

/// A closed body.
struct Body {
    /// By use.
    parts: Vec<(usize, Part)>,
    low: DVec3,
    high: DVec3,
}

/// The triangles of a body in world space, counter-clockwise from outside, and the index of refraction of the first.
struct Faces {
    corners: Vec<[DVec3; 3]>,
    index: f64,
}

/// Where a point of a body's surface is as another body sees it.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Inside,
    Outside,
    /// On its surface, which faces the same way.
    SameSurface,
    Unknown,
}

/// A warning of the first two bodies that reach through each other, with the number of others.
pub(super) fn sentence(scene: &Scene, uses: &[Use], seams: &Seams) -> Option<String> {
    let bodies = bodies(scene, uses, seams);
    let by_surface: Vec<_> = uses.iter().map(by_surface).collect();
    let pairs = pairs(&bodies);
    let (mut angles, mut complete) = (0, pairs.len() < MOST_PAIRS);
    let mut found: Vec<(usize, usize, [f64; 2], Option<DVec3>)> = Vec::new();
    for (a, b) in pairs {
        if is_one_object(scene, &bodies[a], &bodies[b]) {
            continue;
        }
        let count =
            |body: &Body| body.parts.iter().map(|(of, part)| by_surface[*of][part.1 as usize].len()).sum::<usize>();
        if angles > MOST_ANGLES {
            complete = false;
            break;
        }
        if [a, b].iter().any(|body| count(&bodies[*body]) > MOST_FACES) {
            continue;
        }
        let [of_a, of_b] = [&bodies[a], &bodies[b]].map(|body| faces(scene, uses, &by_surface, body));
        angles += of_a.corners.len() + of_b.corners.len();
        if let Some(place) = overlap((&bodies[a], &of_a), (&bodies[b], &of_b), &mut angles) {
            found.push((a, b, [of_a.index, of_b.index], place));
        }
    }
    let (a, b, indices, place) = *found.first()?;
    let mut names = Vec::new();
    let mut materials = Vec::new();
    for (of, (object, surface)) in bodies[a].parts.iter().chain(&bodies[b].parts) {
        let glass = &uses[*of].glass;
        let name = scene.objects[*object].name.as_str();
        let material = glass.faces[by_surface[*of][*surface as usize][0] as usize].material;
        let material = scene.materials[material as usize].name.as_str();
        for (word, said) in [(name, &mut names), (material, &mut materials)] {
            if !said.contains(&word) {
                said.push(word);
            }
        }
    }
    let who = match names.len() {
        1 => format!("object {}: two bodies", listed(names.into_iter())),
        _ => format!("objects {}: bodies", listed(names.into_iter())),
    };
    let how = match place {
        Some(p) => {
            let p = p + scene.origin;
            format!("reach through each other's surface, for example at {:.6} {:.6} {:.6}", p.x, p.y, p.z)
        }
        None => "lie on each other with all of their surface".into(),
    };
    let at_least = if complete { "" } else { "at least " };
    let more = match found.len() {
        1 => String::new(),
        2 => format!(" (and {at_least}1 more pair)"),
        n => format!(" (and {at_least}{} more pairs)", n - 1),
    };
    Some(format!(
        "{who} of glass ({}) {how}{more}: where they overlap, their indices of refraction multiply ({:.3} times {:.3}); take them apart, put one \
         wholly into the other, or let them share faces that have the index behind them over that in front",
        listed(materials.into_iter()),
        indices[0],
        indices[1]
    ))
}

/// The closed bodies of the scene; none if there are too many.
fn bodies(scene: &Scene, uses: &[Use], seams: &Seams) -> Vec<Body> {
    let mut bodies = Vec::new();
    let surfaces =
        |of: &Use| if of.glass.doubled > 0 { 0 } else { of.glass.is_loose.iter().filter(|loose| !**loose).count() };
    if uses.iter().map(|of| surfaces(of) * of.objects.len()).sum::<usize>() > MOST_BODIES {
        return bodies;
    }
    let bounds: Vec<_> = uses.iter().map(bounds).collect();
    let moved = |of: usize, (object, surface): Part| {
        moved_box(bounds[of][surface as usize], &widen(scene.objects[object].object_to_world))
    };
    for (of, index) in uses.iter().zip(0..).filter(|(of, _)| surfaces(of) > 0) {
        for object in &of.objects {
            for (surface, _) in (0..).zip(&of.glass.is_loose).filter(|(_, loose)| !**loose) {
                let [low, high] = moved(index, (*object, surface));
                bodies.push(Body { parts: vec![(index, (*object, surface))], low, high });
            }
        }
    }
    for body in &seams.joined {
        let of = |object: usize| uses.iter().position(|of| of.objects.binary_search(&object).is_ok());
        let parts: Vec<_> = body.iter().filter_map(|part| Some((of(part.0)?, *part))).collect();
        let boxes = parts.iter().map(|(of, part)| moved(*of, *part));
        let [low, high] = boxes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        bodies.push(Body { parts, low, high });
    }
    bodies
}

/// The boxes of the surfaces in object space.
fn bounds(of: &Use) -> Vec<[DVec3; 2]> {
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; of.glass.is_loose.len()];
    for face in &of.glass.faces {
        let [low, high] = &mut boxes[face.surface as usize];
        for corner in of.glass.corners(face) {
            (*low, *high) = (low.min(corner), high.max(corner));
        }
    }
    boxes
}

/// The faces of each surface.
fn by_surface(of: &Use) -> Vec<Vec<u32>> {
    let mut faces = vec![Vec::new(); of.glass.is_loose.len()];
    (0..).zip(&of.glass.faces).for_each(|(number, face)| faces[face.surface as usize].push(number));
    faces
}

/// Bodies whose boxes have room in common.
fn pairs(bodies: &[Body]) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by(|a, b| bodies[*a].low.x.total_cmp(&bodies[*b].low.x));
    let (mut pairs, mut compared) = (Vec::new(), 0);
    for (place, &a) in order.iter().enumerate() {
        for &b in order[place + 1..].iter().take_while(|b| bodies[**b].low.x < bodies[a].high.x) {
            compared += 1;
            if pairs.len() == MOST_PAIRS || compared > MOST_BODIES * 16 {
                return pairs;
            }
            let (a, b) = (a.min(b), a.max(b));
            let room = bodies[a].high.min(bodies[b].high) - bodies[a].low.max(bodies[b].low);
            if room.min_element() > touching(&bodies[a], &bodies[b]) {
                pairs.push((a, b));
            }
        }
    }
    pairs
}

/// Whether both are the same mesh in the same place, which is told for itself.
fn is_one_object(scene: &Scene, a: &Body, b: &Body) -> bool {
    let [a, b] = [a, b].map(|body| body.parts[0].1.0);
    let (one, other) = (&scene.objects[a], &scene.objects[b]);
    a != b && one.mesh == other.mesh && one.object_to_world == other.object_to_world
}

/// How far bodies may reach into each other that are taken to touch.
fn touching(a: &Body, b: &Body) -> f64 {
    let reach = [a, b].map(|body| body.low.abs().max(body.high.abs()).max_element());
    let rounding = 8.0 * f64::from(f32::EPSILON) * reach[0].max(reach[1]);
    (TOUCHING * a.low.distance(a.high).min(b.low.distance(b.high))).max(rounding)
}

fn faces(scene: &Scene, uses: &[Use], by_surface: &[Vec<Vec<u32>>], body: &Body) -> Faces {
    let mut corners = Vec::new();
    let mut index = 1.0;
    for (of, (object, surface)) in &body.parts {
        let map = widen(scene.objects[*object].object_to_world);
        let mirrored = map.matrix3.determinant() < 0.0;
        for number in &by_surface[*of][*surface as usize] {
            let face = &uses[*of].glass.faces[*number as usize];
            let [a, b, c] = uses[*of].glass.corners(face).map(|corner| map.transform_point3(corner));
            corners.push(if mirrored { [a, c, b] } else { [a, b, c] });
            index = face.index.exp();
        }
    }
    Faces { corners, index }
}

/// Whether two bodies reach through each other's surface, and where; nowhere in particular if they are the same.
fn overlap(a: (&Body, &Faces), b: (&Body, &Faces), angles: &mut usize) -> Option<Option<DVec3>> {
    let margin = touching(a.0, b.0);
    for (one, other) in [(a, b), (b, a)] {
        let sticks_out = one
            .1
            .corners
            .iter()
            .flatten()
            .any(|corner| corner.cmplt(other.0.low - margin).any() || corner.cmpgt(other.0.high + margin).any());
        let mut inside = None;
        let (mut outside, mut same, mut count) = (sticks_out, true, 0);
        for (point, normal) in samples(&one.1.corners, [other.0.low, other.0.high], points(other.1.corners.len())) {
            let side = side(point, normal * margin, &other.1.corners);
            *angles += 2 * other.1.corners.len();
            count += 1;
            same &= side == Side::SameSurface;
            outside |= side == Side::Outside;
            if side == Side::Inside {
                inside = inside.or(Some(point));
            }
            if inside.is_some() && outside {
                return Some(inside);
            }
        }
        if same && !sticks_out && count >= POINTS[0] {
            return Some(None);
        }
    }
    None
}

/// How many points are held against a body of so many faces.
fn points(faces: usize) -> usize {
    (ANGLES_OF_A_PAIR / (4 * faces.max(1))).clamp(POINTS[0], POINTS[1])
}

/// Where the places are that lie on either side of a point by the margin. One that is nearer to the surface than that is on it.
fn side(point: DVec3, margin: DVec3, corners: &[[DVec3; 3]]) -> Side {
    let around = |point: DVec3| corners.iter().map(|corners| solid_angle(*corners, point)).sum::<f64>() / (4.0 * PI);
    let [before, behind] = [point + margin, point - margin].map(around);
    let is = |around: f64, wanted: f64| (around - wanted).abs() < 0.01;
    if is(before.abs(), 1.0) && is(behind, before) {
        Side::Inside
    } else if is(before, 0.0) && is(behind, 0.0) {
        Side::Outside
    } else if is(before, 0.0) && is(behind, 1.0) {
        Side::SameSurface
    } else {
        Side::Unknown
    }
}

/// Points of triangles within a box, with the normals there: half of them spread over the area, the others over the triangles.
fn samples(triangles: &[[DVec3; 3]], within: [DVec3; 2], count: usize) -> Vec<(DVec3, DVec3)> {
    let mut pieces: Vec<(Vec<DVec3>, DVec3, f64)> = Vec::new();
    let mut all = 0.0;
    for &[a, b, c] in triangles {
        let piece = clipped(vec![a, b, c], within);
        let area: f64 = (2..piece.len()).map(|k| (piece[k - 1] - piece[0]).cross(piece[k] - piece[0]).length()).sum();
        if area > 0.0 {
            all += area;
            pieces.push((piece, (b - a).cross(c - a).normalize_or_zero(), all));
        }
    }
    let fraction = |i: usize, step: f64| (0.5 + step * i as f64).fract();
    let sample = |i: usize| {
        let share = fraction(i, 1.0 / count as f64);
        let number = match i % 2 {
            0 => pieces.partition_point(|(.., until)| *until < share * all),
            _ => (share * pieces.len() as f64) as usize,
        };
        let (piece, normal, _) = &pieces[number.min(pieces.len() - 1)];
        // Steps that fill the square evenly (Roberts 2018, R2).
        (point_of(piece, [fraction(i, 0.754_877_666_246_7), fraction(i, 0.569_840_290_998)]), *normal)
    };
    if pieces.is_empty() { Vec::new() } else { (0..count).map(sample).collect() }
}

/// A point of a convex polygon by two numbers in [0, 1), evenly over its area.
fn point_of(polygon: &[DVec3], [u, v]: [f64; 2]) -> DVec3 {
    let area = |k: usize| (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]).length();
    let mut left = u * (2..polygon.len()).map(area).sum::<f64>();
    let mut k = 2;
    while k + 1 < polygon.len() && left > area(k) {
        left -= area(k);
        k += 1;
    }
    let root = (left / area(k)).clamp(0.0, 1.0).sqrt();
    polygon[0] + root * ((polygon[k - 1] - polygon[0]) * (1.0 - v) + (polygon[k] - polygon[0]) * v)
}

/// The part of a polygon within a box (Sutherland and Hodgman 1974).
fn clipped(mut polygon: Vec<DVec3>, [low, high]: [DVec3; 2]) -> Vec<DVec3> {
    for axis in 0..3 {
        for (bound, sign) in [(low[axis], 1.0), (high[axis], -1.0)] {
            let inside = |p: DVec3| sign * (p[axis] - bound);
            let mut kept = Vec::with_capacity(polygon.len() + 1);
            for (k, &p) in polygon.iter().enumerate() {
                let next = polygon[(k + 1) % polygon.len()];
                if inside(p) >= 0.0 {
                    kept.push(p);
                }
                if (inside(p) >= 0.0) != (inside(next) >= 0.0) {
                    kept.push(p.lerp(next, inside(p) / (inside(p) - inside(next))));
                }
            }
            polygon = kept;
        }
    }
    polygon
}
