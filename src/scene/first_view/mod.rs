//! The camera of a scene that brings none: where somebody would stand to take a picture of it.
//!
//! Rays into a coarse copy of the scene say what it is: a box with an open side is looked into; in a room the camera stands inside; a thing on a
//! ground or before a backdrop is looked at from near; all else from outside, from where most of it shows its outward side. Whatever it is, it
//! fills the picture. The answer depends on the scene, the picture's aspect and the direction that is up alone, not on threads or time.

mod fit;
mod inside;
mod lattice;
mod outside;
mod side;
mod solid;
mod strays;
mod surroundings;
mod trial;
mod visit;

pub use self::side::Side;

use self::fit::Eye;
use self::outside::Subject;
use self::solid::Solid;
use self::surroundings::Bounds;
use self::trial::Trial;
use self::visit::{for_points, for_some_points};
use super::build::pinhole;
use super::{Scene, Sensor};
use glam::{DMat3, DVec3, Vec3};

/// Points that a trial picture is fitted to.
const TRIAL_POINTS: usize = 4000;
/// The part of the picture's width or height that stays free on each side,
const MARGIN: f64 = 0.06;
/// and around what has surroundings that belong to the picture.
const WIDE_MARGIN: f64 = 0.14;
/// In a room, or under a dome, what is not larger than this is looked at from near; the scene is 2 large.
const TINY: f32 = 0.24;
/// What fills less of the picture is hidden.
const SEEN: f64 = 0.02;
/// Eye point and target are kept apart by this part of their largest coordinate, so that they stay distinct in single precision.
const NEAREST: f64 = 2e-6;

/// A camera, and why it stands where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstView {
    /// The camera.
    pub sensor: Sensor,
    /// Where it stands, to follow "the camera stands": "in front, a little to the right and above".
    pub place: String,
    /// Whether it stands inside of the scene, as of a room: walls keep out what is around.
    pub inside: bool,
}

impl Scene {
    /// A camera for the scene as it is, whatever its sensor: in front of the open side of a box, inside a room, near what stands on a ground or
    /// before a backdrop, else outside, a little from the right and from above, unless another side shows clearly more. The scene fills the
    /// picture of [`Scene::film`]'s aspect. `up` is the direction that is up, of any length but 0; +z is the front where +y is up, and -y where +z
    /// is.
    pub fn first_view(&self, up: Vec3) -> FirstView {
        self.view_from(up, None)
    }

    /// The same, or from outside from this side.
    pub fn view_from(&self, up: Vec3, side: Option<Side>) -> FirstView {
        let aspect = f64::from(self.film.width) / f64::from(self.film.height);
        let frame = frame(up.as_dvec3());
        let (eye, place, middle, unit) = match Solid::new(self, strays::bounds_without(self)) {
            Some(solid) => {
                let (eye, place) = find(self, &solid, frame, aspect, side);
                (eye, place, solid.middle, solid.unit)
            }
            // Nothing has any extent in single precision.
            None => {
                let (low, high) = self.world_bounds();
                let axes = DMat3::from_cols(frame.x_axis, frame.y_axis, -frame.z_axis);
                let eye = Eye { position: frame.z_axis, axes, tangents: [0.35 * aspect, 0.35], depth: 1.0 };
                (eye, "in front".into(), 0.5 * (low + high), (high - low).max_element().max(f64::MIN_POSITIVE))
            }
        };
        let forward = eye.axes.z_axis;
        let target = middle + unit * (eye.position + eye.depth * forward);
        let distance = (unit * eye.depth).max(NEAREST * target.abs().max_element()).max(f64::from(f32::MIN_POSITIVE));
        let fov = (2.0 * eye.tangents[1].atan()).to_degrees() as f32;
        let sensor = pinhole((target - distance * forward).as_vec3(), target.as_vec3(), up, fov);
        FirstView { sensor, inside: place == INSIDE, place }
    }
}

/// Where a camera inside stands.
const INSIDE: &str = "inside, as of a room";

/// Right, up and front.
fn frame(up: DVec3) -> DMat3 {
    let up = up.normalize();
    let right = if up.x.abs() < 0.9 { DVec3::X } else { -DVec3::Z };
    let right = right.reject_from_normalized(up).normalize();
    DMat3::from_cols(right, up, right.cross(up))
}

/// The camera, in the solid's coordinates, and where it stands.
fn find(scene: &Scene, solid: &Solid, frame: DMat3, aspect: f64, side: Option<Side>) -> (Eye, String) {
    let here = |p: DVec3| (p - solid.middle) / solid.unit;
    let points = |bounds: Bounds| {
        move |visit: &mut dyn FnMut(DVec3)| {
            for_points(scene, &mut |p| {
                if bounds.contains(here(p)) {
                    visit(here(p))
                }
            })
        }
    };
    let bounds = Bounds { low: -solid.half, high: solid.half };
    let all = points(bounds);
    let mut trial_points = Vec::new();
    let step = visit::points(scene).div_ceil(TRIAL_POINTS).max(1);
    for_some_points(scene, step, &mut |p| {
        if bounds.contains(here(p)) {
            trial_points.push(here(p))
        }
    });
    let whole = Subject { solid, points: &trial_points, frame, aspect, margin: MARGIN };
    if let Some(side) = side {
        let towards = whole.side(side);
        return (whole.eye(towards, &all), format!("as asked: {}", side.name()));
    }
    let found = search(&whole, &points, &all);
    if solid.is_exhausted() {
        let (towards, place) = whole.usual_side();
        return (whole.eye(towards, &all), place.into());
    }
    found
}

/// The camera for a whole scene, and where it stands; `points` gives the points within bounds, and `all` are those of the whole.
fn search<P: Fn(&mut dyn FnMut(DVec3))>(whole: &Subject, points: &impl Fn(Bounds) -> P, all: &P) -> (Eye, String) {
    let Subject { solid, frame, aspect, .. } = *whole;
    if let Some((towards, place)) = whole.open_side() {
        return (whole.eye(towards, all), place.into());
    }
    let room = || inside::view(solid, frame, aspect).map(|eye| (eye, INSIDE.into()));
    let things = surroundings::within(solid);
    let is_tiny = things.is_some_and(|bounds| bounds.extent() < TINY);
    if let Some(room) = (!is_tiny).then(room).flatten() {
        return room;
    }
    if let Some(bounds) = things {
        let part = points(bounds);
        let trial_points = thinned(&part);
        let subject = Subject { solid, points: &trial_points, frame, aspect, margin: WIDE_MARGIN };
        let (towards, place) = subject.best_side();
        let eye = subject.eye(towards, &part);
        if Trial::new(solid, &eye).shows(&bounds) >= SEEN {
            return (eye, format!("{place}, near what stands on a ground or before a backdrop"));
        }
    }
    if let Some(room) = is_tiny.then(room).flatten() {
        return room;
    }
    let (towards, place) = whole.best_side();
    (whole.eye(towards, all), place.into())
}

/// Some of the points, evenly chosen.
fn thinned(points: &impl Fn(&mut dyn FnMut(DVec3))) -> Vec<DVec3> {
    let mut count = 0;
    points(&mut |_| count += 1);
    let step = usize::div_ceil(count, TRIAL_POINTS).max(1);
    let (mut thinned, mut number) = (Vec::new(), 0);
    points(&mut |p| {
        if usize::is_multiple_of(number, step) {
            thinned.push(p);
        }
        number += 1;
    });
    thinned
}
