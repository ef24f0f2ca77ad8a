//! About what the camera of a turn turns: its target, or, where it stands in a room, itself.
//!
//! Rays of the double-precision reference tell. The positions that are looked at do not depend on the number of frames, nor on which of them are rendered, so
//! that machines that share a turn come to the same.

use luminaire::glam::{DQuat, DVec3};
use luminaire::reference::Reference;
use luminaire::scene::{Pivot, Scene, Sensor};
use std::f64::consts::TAU;
use std::ops::Range;

/// So many positions of a turn are looked at.
const POSITIONS: usize = 64;
/// More than this share of them has to be bad for a word.
const MANY: f64 = 1.0 / 3.0;
/// A camera stands in a room if it sees the model at its own height in at least this share of all directions, ...
const WALLED: f64 = 0.6;
/// ... that is along two of three rays which are so many degrees apart.
const APART: f64 = 10.0;
/// The circle on which the camera moves, and others beside it (radius as a share of it, height in units of the radius): walls cut all of them, a pillar or a lamp on
/// its stand some.
const CIRCLES: [(f64, f64); 6] = [(1.0, 0.0), (0.8, 0.0), (1.0, 0.1), (1.0, -0.1), (0.9, 0.15), (1.1, 0.0)];
/// Rays across and down to the surroundings of the target, ...
const BUNDLE: u32 = 8;
/// ... which are so wide, as a share of the distance.
const SURROUNDINGS: f64 = 0.4;
/// What stands before the target by more than this share of the distance hides it, unless the model itself reaches that far from the target.
const BEFORE: f64 = 0.15;
/// A model reaches up to so many times as far on other sides as on the one that the first frame sees.
const UNEVEN: f64 = 1.5;
/// The most ranges of frames in a warning.
const MOST_RANGES: usize = 6;

/// `--pivot`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PivotName {
    /// Around the target, but on the spot where the camera stands in a room.
    Auto,
    /// Around the target.
    Target,
    /// On the spot: the camera looks around.
    Camera,
}

/// A turn.
#[derive(Debug, PartialEq)]
pub struct Turn {
    /// About what the camera turns.
    pub pivot: Pivot,
    /// Why, if that is worth a note.
    pub note: Option<String>,
    /// The positions from which something stands before the target, if those are many and nobody asked for it.
    hidden: Option<Vec<bool>>,
}

impl Turn {
    /// The turn that is asked for; `tracer` is one of the scene, which is made and left there if one is needed.
    pub fn of(scene: &Scene, wanted: PivotName, tracer: &mut Option<Reference>) -> Self {
        let turn = |pivot| Turn { pivot, note: None, hidden: None };
        match wanted {
            PivotName::Target => return turn(Pivot::Target),
            PivotName::Camera => return turn(Pivot::Position),
            PivotName::Auto => {}
        }
        if tracer.is_none() && !Reference::fits(scene) {
            let why = "there is too little memory to find out whether the camera stands in a room: it turns around its target; if it does, say --pivot camera";
            return Turn { note: Some(why.into()), ..turn(Pivot::Target) };
        }
        let outlook = Outlook::new(scene, tracer.get_or_insert_with(|| Reference::new(scene)));
        if outlook.is_in_a_room() && many(&outlook.behind_walls()) {
            let why = "the camera stands in a room: it turns on the spot (--pivot target: around its target)";
            return Turn { note: Some(why.into()), ..turn(Pivot::Position) };
        }
        let hidden = outlook.hidden();
        Turn { hidden: many(&hidden).then_some(hidden), ..turn(Pivot::Target) }
    }

    /// What is said of these frames of a turn of so many, if from many positions something stands before the target.
    pub fn warning(&self, frames: &[u32], turn: u32) -> Option<String> {
        let hidden = self.hidden.as_ref()?;
        let nearest = |frame: u32| (f64::from(frame) / f64::from(turn) * POSITIONS as f64).round() as usize % POSITIONS;
        let mut ranges: Vec<Range<u32>> = vec![];
        for frame in frames.iter().copied().filter(|frame| hidden[nearest(*frame)]) {
            match ranges.last_mut() {
                Some(range) if range.end == frame => range.end += 1,
                _ => ranges.push(frame..frame + 1),
            }
        }
        let words = ranges.iter().take(MOST_RANGES).map(|range| match range.len() {
            1 => range.start.to_string(),
            _ => format!("{} to {}", range.start, range.end - 1),
        });
        let list = words.collect::<Vec<_>>().join(", ");
        let more = if ranges.len() > MOST_RANGES { ", ..." } else { "" };
        (!ranges.is_empty()).then(|| {
            format!(
                "on its turn the camera comes to where something stands before its target, walls that it sees from outside perhaps: about frames {list}{more} of 0 to {}; \
                 --pivot camera turns it on the spot, and --pivot target takes it as it is",
                turn - 1
            )
        })
    }
}

/// Whether many positions are bad.
fn many(bad: &[bool]) -> bool {
    bad.iter().filter(|bad| **bad).count() as f64 > MANY * bad.len() as f64
}

/// What there is around the camera, and around its turn about the target.
struct Outlook<'a> {
    reference: &'a Reference,
    /// The ground that the loader made is none of the model.
    ground: Option<u32>,
    /// Along the turn.
    sensors: Vec<Sensor>,
    target: DVec3,
    vertical: DVec3,
    /// From the camera to its target.
    distance: f64,
}

impl<'a> Outlook<'a> {
    fn new(scene: &Scene, reference: &'a Reference) -> Self {
        let sensor = &scene.sensor;
        let turns = (0..POSITIONS).map(|k| k as f64 / POSITIONS as f64);
        Outlook {
            reference,
            ground: scene.ground,
            sensors: turns.map(|turns| sensor.turned(turns, Pivot::Target)).collect(),
            target: sensor.target.as_dvec3(),
            vertical: sensor.vertical(),
            distance: sensor.position.as_dvec3().distance(sensor.target.as_dvec3()),
        }
    }

    fn position(&self, k: usize) -> DVec3 {
        self.sensors[k].position.as_dvec3()
    }

    /// How far along a ray the model is, in multiples of the direction.
    fn model_along(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let hit = self.reference.closest_hit(origin, direction, f64::INFINITY, 0)?;
        (self.ground != Some(hit.object)).then_some(hit.t)
    }

    /// Whether nothing is between two points.
    fn is_free(&self, from: DVec3, to: DVec3) -> bool {
        !self.reference.occluded(from, to - from, 1.0, 0)
    }

    /// Whether the model stands around the camera, at its height.
    fn is_in_a_room(&self) -> bool {
        let position = self.position(0);
        let level = |v: DVec3| v - self.vertical * self.vertical.dot(v);
        // One that looks straight down has a level up.
        let sight = level(self.target - position) / self.distance;
        let ahead = if sight.length() > 1e-3 { sight } else { level(self.sensors[0].up.as_dvec3()) };
        let walls = (0..POSITIONS).filter(|k| {
            let turn = DQuat::from_axis_angle(self.vertical, *k as f64 / POSITIONS as f64 * TAU);
            let ahead = turn * ahead.normalize_or(self.vertical.any_orthonormal_vector());
            let rays = [-APART, 0.0, APART].map(|pitch| {
                let (sin, cos) = pitch.to_radians().sin_cos();
                self.model_along(position, ahead * cos + self.vertical * sin)
            });
            rays.iter().flatten().count() >= 2
        });
        walls.count() as f64 >= WALLED * POSITIONS as f64
    }

    /// Which positions of the turn lie behind walls: nothing leads there from the camera along its circle, or beside it, and what the camera sees in
    /// the middle of its picture is not to be seen from there.
    fn behind_walls(&self) -> Vec<bool> {
        let mut reached = [false; POSITIONS];
        for (radius, lift) in CIRCLES {
            let point = |k: usize| {
                let k = k % POSITIONS;
                self.target + radius * (self.position(k) - self.target) + lift * self.distance * self.vertical
            };
            let leads_to = |k: usize| radius == 1.0 && lift == 0.0 || self.is_free(point(k), self.position(k));
            if !leads_to(0) {
                continue;
            }
            for way in [1, POSITIONS - 1] {
                let mut k = 0;
                loop {
                    reached[k] = reached[k] || leads_to(k);
                    let next = (k + way) % POSITIONS;
                    if next == 0 || !self.is_free(point(k), point(next)) {
                        break;
                    }
                    k = next;
                }
            }
        }
        let (camera, sight) = (self.position(0), self.target - self.position(0));
        let surface = self.reference.closest_hit(camera, sight, f64::INFINITY, 0).map_or(f64::INFINITY, |hit| hit.t);
        let seen = camera + sight * (0.98 * surface).min(1.0);
        (0..POSITIONS).map(|k| !reached[k] && !self.is_free(self.position(k), seen)).collect()
    }

    /// By how much the model stands before the target along rays from a position to the target's surroundings, in units of the distance; not sorted.
    fn before(&self, k: usize) -> Vec<f64> {
        let position = self.position(k);
        let ahead = (self.target - position).normalize();
        let right = ahead.cross(self.sensors[k].up.as_dvec3()).normalize();
        let up = right.cross(ahead);
        let offset = |i: u32| ((f64::from(i) + 0.5) / f64::from(BUNDLE) - 0.5) * SURROUNDINGS * self.distance;
        let rays = (0..BUNDLE * BUNDLE).map(|ray| {
            let to = self.target + right * offset(ray % BUNDLE) + up * offset(ray / BUNDLE);
            self.model_along(position, to - position).map_or(0.0, |t| (1.0 - t).max(0.0))
        });
        rays.collect()
    }

    /// From which positions of the turn something stands before the target that does not belong to its surroundings, as the camera sees them.
    fn hidden(&self) -> Vec<bool> {
        let mut reach = self.before(0);
        reach.sort_by(f64::total_cmp);
        let reach = reach[reach.len() / 2];
        let enough = BEFORE + UNEVEN * reach;
        let most = (BUNDLE * BUNDLE / 2) as usize;
        (0..POSITIONS).map(|k| self.before(k).into_iter().filter(|before| *before > enough).count() > most).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::glam::{Affine3A, Quat, Vec3};
    use luminaire::scene::build::{add, cube, empty, icosphere, matte, pinhole, quad};

    fn scene(position: Vec3, target: Vec3) -> Scene {
        let mut scene = empty(16, 12);
        scene.sensor = pinhole(position, target, Vec3::Y, 50.0);
        scene
    }

    /// Adds a box with these half edges.
    fn block(scene: &mut Scene, middle: Vec3, half: Vec3) {
        add(scene, cube(), matte(Vec3::ONE), Affine3A::from_scale_rotation_translation(half, Quat::IDENTITY, middle));
    }

    fn turn(scene: &Scene) -> Turn {
        Turn::of(scene, PivotName::Auto, &mut None)
    }

    fn is_around_and_silent(scene: &Scene) -> bool {
        turn(scene) == Turn { pivot: Pivot::Target, note: None, hidden: None }
    }

    /// A room of 8 x 3 x 4 that stands on y = 0, around the origin.
    fn room(position: Vec3, target: Vec3) -> Scene {
        let mut scene = scene(position, target);
        block(&mut scene, Vec3::Y * 1.5, Vec3::new(4.0, 1.5, 2.0));
        scene
    }

    #[test]
    fn in_a_room_it_turns_on_the_spot() {
        let table = |scene: &mut Scene| block(scene, Vec3::Y * 0.4, Vec3::new(0.7, 0.4, 0.7));
        // At one end; to the table, above it, to the other end, into a corner; a room on its side, where z is up.
        for target in [Vec3::new(0.0, 0.6, 0.0), Vec3::Y, Vec3::new(-3.9, 1.5, 0.0), Vec3::new(-3.5, 1.0, 1.5)] {
            let mut scene = room(Vec3::new(3.5, 1.6, 0.2), target);
            table(&mut scene);
            let decided = turn(&scene);
            assert!(decided.pivot == Pivot::Position && decided.note.is_some(), "{target}: {decided:?}");
            assert_eq!(decided.warning(&[0, 1, 2, 3], 4), None);
            assert_eq!(Turn::of(&scene, PivotName::Target, &mut None).pivot, Pivot::Target);
            let on_its_side = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
            scene.objects.iter_mut().for_each(|o| o.object_to_world = on_its_side * o.object_to_world);
            let [position, target] =
                [scene.sensor.position, scene.sensor.target].map(|p| on_its_side.transform_point3(p));
            scene.sensor = pinhole(position, target, Vec3::Z, 50.0);
            assert_eq!(turn(&scene).pivot, Pivot::Position, "{target}");
        }
        // Where the circle stays within the room, it goes around.
        let mut scene = room(Vec3::new(1.4, 1.6, 0.9), Vec3::new(0.0, 0.6, 0.0));
        table(&mut scene);
        assert!(is_around_and_silent(&scene));
        // And so it does in a studio, between two lamps on stands, and under a dome.
        let mut scene = self::scene(Vec3::new(0.0, 1.5, 5.0), Vec3::Y);
        block(&mut scene, Vec3::ZERO, Vec3::splat(9.0));
        block(&mut scene, Vec3::Y, Vec3::splat(0.8));
        for x in [-3.0, 3.0] {
            block(&mut scene, Vec3::new(x, 1.3, 4.0), Vec3::new(0.3, 0.7, 0.3));
        }
        assert!(is_around_and_silent(&scene));
    }

    #[test]
    fn around_an_object_it_turns_around() {
        // A ball that floats, a long thing from its long side and from its end, a sheet from in front: on a ground.
        for half in [Vec3::ONE, Vec3::new(2.5, 0.5, 0.6), Vec3::new(0.6, 0.5, 2.5), Vec3::new(1.0, 1.0, 0.01)] {
            let mut scene = scene(Vec3::new(0.0, 2.0, 6.0), Vec3::Y);
            let place = Affine3A::from_scale_rotation_translation(half, Quat::IDENTITY, Vec3::Y);
            add(&mut scene, icosphere(2), matte(Vec3::ONE), place);
            let ground = quad(Vec3::new(-50.0, 0.0, -50.0), Vec3::Z * 100.0, Vec3::X * 100.0);
            add(&mut scene, ground, matte(Vec3::ONE), Affine3A::IDENTITY);
            assert!(is_around_and_silent(&scene), "{half}");
        }
        // Straight from above.
        let mut scene = scene(Vec3::Y * 6.0, Vec3::ZERO);
        scene.sensor.up = -Vec3::Z;
        block(&mut scene, Vec3::ZERO, Vec3::ONE);
        assert!(is_around_and_silent(&scene));
    }

    /// A box that is open towards the camera, which stands before it.
    #[test]
    fn walls_that_are_seen_from_outside_are_named() {
        let mut scene = scene(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO);
        block(&mut scene, Vec3::ZERO, Vec3::ONE);
        let cube = std::sync::Arc::make_mut(&mut scene.meshes[0]);
        let open = |corner: &u32| cube.positions[*corner as usize].z > 0.0;
        cube.triangles = cube.triangles.iter().filter(|t| !t.vertices.iter().all(open)).copied().collect();
        let decided = turn(&scene);
        assert!(decided.pivot == Pivot::Target && decided.note.is_none(), "{decided:?}");
        let all: Vec<u32> = (0..12).collect();
        let said = decided.warning(&all, 12).unwrap();
        assert!(said.contains("about frames 2 to 10 of 0 to 11; --pivot camera"), "{said}");
        assert!(decided.warning(&all[4..5], 12).unwrap().contains("frames 4 of"));
        assert_eq!(decided.warning(&all[..2], 12), None);
        assert_eq!(Turn::of(&scene, PivotName::Target, &mut None).warning(&all, 12), None);
    }
}
