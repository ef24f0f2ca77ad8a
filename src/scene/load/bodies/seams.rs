//! Edges of glass that objects have in common: a lid may stand in another object than its glass.
//!
//! Only edges that a mesh does not close by itself are compared, in world space. Two of them are one where their ends lie as near to each other as
//! the numbers of files and the rounding of transforms can tell.

use super::glass::{Glass, Loose, SAME_INDEX, Use};
use super::near::Near;
use super::split::between;
use crate::scene::sets::Sets;
use crate::scene::{Mesh, Object, Scene, moved_box, widen};
use glam::{DAffine3, DVec3};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Edges that are compared. A mesh that has more, with all its instances, is judged by its first instance.
const MOST_EDGES: usize = 1 << 18;
/// Vertices of meshes that are looked at for other materials at which glass ends.
const MOST_OTHERS: usize = 1 << 24;
/// Ends are one where they lie nearer than this part of the size of the surface: numbers with six decimals, of a drinking glass in metres.
const PRECISION: f64 = 2e-5;
/// But no farther from each other than this part of its shortest open edge.
const OF_AN_EDGE: f64 = 0.1;
/// What positions and transforms are rounded by, for each unit of their numbers.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;
/// Planes whose unit normals have a cross product no longer than this are parallel.
const PARALLEL: f64 = 1e-3;

/// A surface of an object: the number of the object, and that of the surface in its glass.
pub(super) type Part = (usize, u32);

/// Surfaces of other objects: these, their uses, and the surfaces.
type Others = BTreeSet<(usize, usize, u32)>;

/// What all objects together leave open, and what they close.
#[derive(Default)]
pub(super) struct Seams {
    /// By use of glass.
    pub faults: Vec<Faults>,
    /// Closed bodies of surfaces that are not closed by themselves.
    pub joined: Vec<Vec<Part>>,
    /// The surfaces of these.
    pub closed: HashSet<Part>,
}

/// The objects of a use that have faults, and the faults of the first of them.
#[derive(Default)]
pub(super) struct Faults {
    pub objects: Vec<usize>,
    /// Edges that one face has alone, and those around which the indices do not multiply to 1 though several have them: a place on each, in object space,
    /// and the surface. Edges that other materials share are in neither.
    pub open: Vec<(u32, u32)>,
    pub wrong: Vec<(u32, u32)>,
    /// Surfaces of other objects at these edges.
    pub with: Others,
    /// Surfaces that are flat, with all that they are joined to.
    pub sheets: HashSet<u32>,
}

/// A loose edge of an object.
struct Candidate<'a> {
    of: usize,
    object: usize,
    loose: &'a Loose,
    /// The number of its surface among all that have loose edges.
    part: u32,
    /// Whether its object is mirrored: then the edge runs the other way around its faces.
    mirrored: bool,
    /// Its ends, as points that all objects have in common.
    ends: [u32; 2],
}

/// An edge, or a part of one, that objects may have in common: its ends in order, whether its candidate has them so, and the number of that.
type Edge = (u32, u32, bool, u32);

/// What becomes of a loose edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum State {
    Closed,
    Covered,
    /// Another object has it too, at which it is told.
    Elsewhere,
    Open,
    Wrong,
}

/// Of a surface that is flat, a point and the normal.
type Plane = Option<(DVec3, DVec3)>;

/// The surfaces with loose edges: those that have an edge in common are in one set.
#[derive(Default)]
struct Parts {
    list: Vec<Part>,
    numbers: HashMap<Part, u32>,
    sets: Sets,
}

impl Parts {
    fn number(&mut self, part: Part) -> u32 {
        let next = self.list.len() as u32;
        let number = *self.numbers.entry(part).or_insert(next);
        if number == next {
            self.list.push(part);
            self.sets.add();
        }
        number
    }

    fn join(&mut self, a: u32, b: u32) {
        self.sets.join(a as usize, b as usize);
    }

    /// The part that stands for a part and all that are joined with it.
    fn root(&mut self, part: u32) -> u32 {
        self.sets.of(part as usize) as u32
    }
}

impl Seams {
    /// Compares the loose edges of all objects.
    pub fn find(scene: &Scene, uses: &[Use]) -> Self {
        let (mut parts, mut near) = (Parts::default(), Near::default());
        let compared = compared(uses);
        let mut candidates = Vec::new();
        for &(of, object) in &compared {
            add_candidates(scene, (of, &uses[of].glass), object, &mut candidates, &mut parts, &mut near);
        }
        near.join();
        for candidate in &mut candidates {
            candidate.ends = candidate.ends.map(|end| near.one(end));
        }
        let (states, with) = close(scene, &candidates, &mut near, &mut parts);

        let mut seams = Self { faults: uses.iter().map(|_| Faults::default()).collect(), ..Self::default() };
        let mut open: HashSet<u32> = HashSet::new();
        for (candidate, state) in candidates.iter().zip(&states) {
            if *state != State::Closed {
                open.insert(parts.root(candidate.part));
            }
        }
        let planes: Vec<_> = uses.iter().map(|of| of.glass.planes()).collect();
        let flat = flat(scene, &planes, &candidates, &mut parts);
        let mut rest = &candidates[..];
        let mut first = 0;
        for (of, object) in compared {
            let count = rest.iter().take_while(|other| (other.of, other.object) == (of, object)).count();
            let (own, others) = rest.split_at(count);
            rest = others;
            let mut found = Faults::default();
            for (number, candidate) in (first..).zip(own) {
                let edge = (candidate.loose.ends[0], candidate.loose.surface);
                match states[number] {
                    State::Open => found.open.push(edge),
                    State::Wrong => found.wrong.push(edge),
                    State::Closed | State::Covered | State::Elsewhere => continue,
                }
                found.with.extend(with.get(&number).into_iter().flatten());
            }
            first += count;
            for (surface, _) in (0..).zip(&planes[of]).filter(|(_, plane)| plane.is_some()) {
                let alone = parts.numbers.get(&(object, surface)).copied().map(|part| parts.root(part));
                if alone.is_none_or(|root| flat.contains(&root)) {
                    found.sheets.insert(surface);
                }
            }
            let sound = found.open.is_empty() && found.wrong.is_empty() && found.sheets.is_empty();
            let of_use = &mut seams.faults[of];
            if sound && uses[of].glass.doubled == 0 {
                continue;
            }
            if of_use.objects.is_empty() {
                *of_use = found;
            }
            of_use.objects.push(object);
        }
        let mut bodies: HashMap<u32, Vec<Part>> = HashMap::new();
        for number in 0..parts.list.len() as u32 {
            let root = parts.root(number);
            if !open.contains(&root) {
                bodies.entry(root).or_default().push(parts.list[number as usize]);
            }
        }
        seams.joined = bodies.into_values().collect();
        seams.joined.sort_unstable();
        seams.closed = seams.joined.iter().flatten().copied().collect();
        seams
    }
}

/// The objects whose edges are compared, with the numbers of their uses.
fn compared(uses: &[Use]) -> Vec<(usize, usize)> {
    let count = |of: &Use| of.glass.loose.len() * of.objects.len();
    let mut order: Vec<usize> = (0..uses.len()).collect();
    order.sort_by_key(|of| count(&uses[*of]));
    let mut left = MOST_EDGES;
    let mut compared = Vec::new();
    for of in order {
        let objects = &uses[of].objects;
        let all = count(&uses[of]) <= left && objects.len() <= MOST_EDGES;
        left = left.saturating_sub(count(&uses[of]));
        compared.extend(objects[..if all { objects.len() } else { 1 }].iter().map(|object| (of, *object)));
    }
    compared.sort_unstable();
    compared
}

/// Adds the loose edges of an object.
fn add_candidates<'a>(
    scene: &Scene,
    (of, glass): (usize, &'a Glass),
    object: usize,
    candidates: &mut Vec<Candidate<'a>>,
    parts: &mut Parts,
    near: &mut Near,
) {
    if glass.loose.is_empty() {
        return;
    }
    let map = widen(scene.objects[object].object_to_world);
    let reaches = reaches(glass, &map);
    let mut points: HashMap<u32, u32> = HashMap::new();
    for loose in &glass.loose {
        let reach = reaches[&loose.surface];
        let ends = loose.ends.map(|place| {
            let at = || map.transform_point3(glass.places[place as usize].as_dvec3());
            *points.entry(place).or_insert_with(|| near.add(at(), reach))
        });
        let part = parts.number((object, loose.surface));
        candidates.push(Candidate { of, object, loose, part, mirrored: map.matrix3.determinant() < 0.0, ends });
    }
}

/// For each surface with loose edges, how far in world space points may lie apart that are meant to be one.
fn reaches(glass: &Glass, map: &DAffine3) -> HashMap<u32, f64> {
    let place = |place: u32| glass.places[place as usize].as_dvec3();
    let empty = ([DVec3::INFINITY, DVec3::NEG_INFINITY], f64::INFINITY);
    let mut sizes = HashMap::new();
    for loose in &glass.loose {
        let [a, b] = loose.ends.map(|end| map.transform_point3(place(end)));
        let (_, shortest) = sizes.entry(loose.surface).or_insert(empty);
        *shortest = shortest.min(a.distance(b));
    }
    for face in &glass.faces {
        if let Some(([low, high], _)) = sizes.get_mut(&face.surface) {
            for corner in face.corners {
                (*low, *high) = (low.min(place(corner)), high.max(place(corner)));
            }
        }
    }
    let columns = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis].map(DVec3::abs);
    let reach = |([low, high], shortest): ([DVec3; 2], f64)| {
        let most = low.abs().max(high.abs());
        let numbers = columns[0] * most.x + columns[1] * most.y + columns[2] * most.z + map.translation.abs();
        let [low, high] = moved_box([low, high], map);
        (PRECISION * low.distance(high)).min(OF_AN_EDGE * shortest).max(ROUNDING * numbers.max_element())
    };
    sizes.into_iter().map(|(surface, size)| (surface, reach(size))).collect()
}

/// What becomes of each candidate; and for those at which faults are told, the surfaces of other objects there.
fn close(
    scene: &Scene,
    candidates: &[Candidate],
    near: &mut Near,
    parts: &mut Parts,
) -> (Vec<State>, HashMap<usize, Others>) {
    let around = |edge: &[Edge]| -> f64 {
        let signed = |&(.., ahead, number): &Edge| {
            let candidate = &candidates[number as usize];
            if ahead != candidate.mirrored { candidate.loose.around } else { -candidate.loose.around }
        };
        edge.iter().map(signed).sum()
    };
    let ordered = |a: u32, b: u32, ahead: bool, number| (a.min(b), a.max(b), ahead == (a < b), number);
    let same = |a: &Edge, b: &Edge| (a.0, a.1) == (b.0, b.1);
    // What is shorter than can be told is closed.
    let edges = (0..).zip(candidates).filter(|(_, candidate)| candidate.ends[0] != candidate.ends[1]);
    let mut edges: Vec<Edge> = edges.map(|(number, of)| ordered(of.ends[0], of.ends[1], true, number)).collect();
    edges.sort_unstable();
    let lonely = edges.chunk_by(same).filter(|edge| around(edge).abs() > SAME_INDEX);
    let lonely: HashSet<(u32, u32)> = lonely.map(|edge| (edge[0].0, edge[0].1)).collect();
    let reach = |a: u32, b: u32| near.point(a).1.max(near.point(b).1);
    let between = between(&lonely, |vertex| near.point(vertex).0, reach);
    let mut pieces: Vec<Edge> = Vec::with_capacity(edges.len());
    for (a, b, ahead, number) in edges {
        let mut from = a;
        for &to in between.get(&(a, b)).into_iter().flatten().chain([&b]) {
            pieces.push(ordered(from, to, ahead, number));
            from = to;
        }
    }
    pieces.sort_unstable();

    let mut faulty: Vec<&[Edge]> = Vec::new();
    for edge in pieces.chunk_by(same) {
        let part = |edge: &Edge| candidates[edge.3 as usize].part;
        edge.windows(2).for_each(|pair| parts.join(part(&pair[0]), part(&pair[1])));
        if around(edge).abs() > SAME_INDEX {
            faulty.push(edge);
        }
    }
    let covered = covered(scene, &faulty, near);
    let mut states = vec![State::Closed; candidates.len()];
    let mut with: HashMap<usize, Others> = HashMap::new();
    for edge in faulty {
        let all = || edge.iter().map(|edge| (edge.3 as usize, &candidates[edge.3 as usize]));
        let is_covered = covered.contains(&(edge[0].0, edge[0].1)) || all().any(|(_, of)| of.loose.covered);
        let state = match all().map(|(_, of)| of.loose.faces).sum::<usize>() {
            _ if is_covered => State::Covered,
            1 => State::Open,
            _ => State::Wrong,
        };
        // Told once.
        let teller = all().map(|(number, _)| number).min().expect("an edge is of some candidate");
        for (number, other) in all() {
            let own = if number == teller { state } else { state.min(State::Elsewhere) };
            states[number] = states[number].max(own);
            if !is_covered && other.object != candidates[teller].object {
                with.entry(teller).or_default().insert((other.object, other.of, other.loose.surface));
            }
        }
    }
    (states, with)
}

/// Those of the edges that triangles of other materials share, in any object: what is there cannot be known, for a wall may close the body.
fn covered(scene: &Scene, edges: &[&[Edge]], near: &mut Near) -> HashSet<(u32, u32)> {
    let mut covered = HashSet::new();
    let ends: HashSet<(u32, u32)> = edges.iter().map(|edge| (edge[0].0, edge[0].1)).collect();
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for (at, reach) in ends.iter().flat_map(|&(a, b)| [near.point(a), near.point(b)]) {
        bounds = [bounds[0].min(at - reach), bounds[1].max(at + reach)];
    }
    let touches = |[low, high]: [DVec3; 2]| low.cmple(bounds[1]).all() && high.cmpge(bounds[0]).all();
    let bends: Vec<bool> = scene.materials.iter().map(|material| material.bends()).collect();
    let boxes: Vec<_> = scene.meshes.iter().map(|mesh| mesh.bounds()).collect();
    let mut looked_at = 0;
    for object in &scene.objects {
        let mesh: &Mesh = &scene.meshes[object.mesh as usize];
        let other = |material: u32| !bends[object.material.unwrap_or(material) as usize];
        if ends.is_empty() || object.material.is_some_and(|material| !other(material)) {
            continue;
        }
        let map = widen(object.object_to_world);
        let (low, high) = boxes[object.mesh as usize];
        if !touches(moved_box([low.as_dvec3(), high.as_dvec3()], &map)) {
            continue;
        }
        looked_at += mesh.positions.len();
        if looked_at > MOST_OTHERS {
            break;
        }
        let there = mesh.positions.iter().map(|position| {
            let place = map.transform_point3(position.as_dvec3());
            if touches([place, place]) { near.at(place) } else { None }
        });
        let there: Vec<Option<u32>> = there.collect();
        for triangle in mesh.triangles.iter().filter(|triangle| other(triangle.material)) {
            let [a, b, c] = triangle.vertices.map(|vertex| there[vertex as usize]);
            for (a, b) in [(a, b), (b, c), (c, a)] {
                if let (Some(a), Some(b)) = (a, b)
                    && ends.contains(&(a.min(b), a.max(b)))
                {
                    covered.insert((a.min(b), a.max(b)));
                }
            }
        }
    }
    covered
}

/// The roots of what is flat though several surfaces are joined: all lie in one plane.
fn flat(scene: &Scene, planes: &[Vec<Plane>], candidates: &[Candidate], parts: &mut Parts) -> HashSet<u32> {
    let mut first: HashMap<u32, (DVec3, DVec3)> = HashMap::new();
    let mut bent: HashSet<u32> = HashSet::new();
    let mut seen = HashSet::new();
    for candidate in candidates.iter().filter(|candidate| seen.insert(candidate.part)) {
        let root = parts.root(candidate.part);
        let Some((at, normal)) = planes[candidate.of][candidate.loose.surface as usize] else {
            bent.insert(root);
            continue;
        };
        let object: &Object = &scene.objects[candidate.object];
        let map = widen(object.object_to_world);
        let (at, normal) = (map.transform_point3(at), map.matrix3.inverse().transpose() * normal);
        let normal = normal.normalize_or_zero();
        let (origin, of_first) = *first.entry(root).or_insert((at, normal));
        let off = (at - origin).dot(of_first).abs();
        if normal.cross(of_first).length() > PARALLEL || off > PARALLEL * at.distance(origin) {
            bent.insert(root);
        }
    }
    first.into_keys().filter(|root| !bent.contains(root)).collect()
}
