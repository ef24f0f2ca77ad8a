//! Views from outside: which side is the best.

use super::fit::{Eye, axes, fit};
use super::side::Side as Asked;
use super::solid::Solid;
use super::trial::Trial;
use glam::{DMat3, DVec3};

/// A view that shows nothing but smooth surfaces counts as one with this much content.
const SMOOTH: f64 = 0.1;
/// How many times as much another side has to show as the first.
const CLEARLY: f64 = 1.3;
/// And one from below, where there may be a ground.
const FROM_BELOW: f64 = 3.0;
/// Rays into each side of the bounds, along each side.
const PROBES: usize = 24;
/// An opening: so many of the rays into a side come further than half way, and so many into the sides around it are stopped at once.
const OPEN: f64 = 0.6;
const SHUT: f64 = 0.7;
/// A box is not so many times as deep as its opening is wide, but a pipe is.
const DEEP: f64 = 3.0;
/// Field of view, horizontal and vertical, the larger of them at most, in degrees.
const FOV: f64 = 38.0;

/// A direction from the scene to the camera, in degrees to the right of the front, and above the level.
#[derive(Debug, Clone, Copy)]
struct Side {
    azimuth: f64,
    /// Above what flat and tall things are seen from.
    above: f64,
    name: &'static str,
}

/// From in front, a little from the right and above: the custom of catalogues. The others only where they show clearly more.
const SIDES: [Side; 11] = [
    Side { azimuth: 30.0, above: 0.0, name: "in front, a little to the right and above" },
    Side { azimuth: -30.0, above: 0.0, name: "in front, a little to the left and above" },
    Side { azimuth: 0.0, above: -4.0, name: "in front and a little above" },
    Side { azimuth: 60.0, above: 0.0, name: "on the right and a little above" },
    Side { azimuth: -60.0, above: 0.0, name: "on the left and a little above" },
    Side { azimuth: 90.0, above: -4.0, name: "on the right and a little above" },
    Side { azimuth: -90.0, above: -4.0, name: "on the left and a little above" },
    Side { azimuth: 150.0, above: 0.0, name: "behind, a little to the right and above" },
    Side { azimuth: -150.0, above: 0.0, name: "behind, a little to the left and above" },
    Side { azimuth: 180.0, above: -4.0, name: "behind and a little above" },
    Side { azimuth: 30.0, above: f64::NEG_INFINITY, name: "in front and below" },
];
/// Degrees below the level, of the last of them.
const BELOW: f64 = 30.0;

/// What is to be shown, of all that is there.
pub(super) struct Subject<'a> {
    pub solid: &'a Solid,
    /// What has to be in the picture.
    pub points: &'a [DVec3],
    pub frame: DMat3,
    pub aspect: f64,
    pub margin: f64,
}

impl Subject<'_> {
    /// The camera towards which a direction points, with all of `points` in the picture.
    pub(super) fn eye(&self, towards: DVec3, points: &impl Fn(&mut dyn FnMut(DVec3))) -> Eye {
        let half = (0.5 * FOV).to_radians().tan();
        let tangents = if self.aspect >= 1.0 { [half * self.aspect, half] } else { [half, half / self.aspect] };
        fit(points, axes(-towards, self.frame.y_axis), tangents, self.margin)
    }

    /// A square trial picture from a direction.
    fn try_out(&self, towards: DVec3) -> Trial {
        let points = |visit: &mut dyn FnMut(DVec3)| self.points.iter().for_each(|p| visit(*p));
        Trial::new(self.solid, &Subject { aspect: 1.0, ..*self }.eye(towards, &points))
    }

    fn towards(&self, azimuth: f64, elevation: f64) -> DVec3 {
        let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
        self.frame * DVec3::new(elevation.cos() * azimuth.sin(), elevation.sin(), elevation.cos() * azimuth.cos())
    }

    /// The first of the sides.
    pub(super) fn usual_side(&self) -> (DVec3, &'static str) {
        (self.towards(SIDES[0].azimuth, self.elevation()), SIDES[0].name)
    }

    /// Where one stands who looks at this side.
    pub(super) fn side(&self, side: Asked) -> DVec3 {
        let azimuth = match side {
            Asked::Front | Asked::Top => 0.0,
            Asked::Back => 180.0,
            Asked::Left => -90.0,
            Asked::Right => 90.0,
        };
        // Not straight down, where nothing would be up in the picture.
        self.towards(azimuth, if side == Asked::Top { 85.0 } else { self.elevation() })
    }

    /// The side that shows the most, the first of them unless another is clearly better.
    pub(super) fn best_side(&self) -> (DVec3, &'static str) {
        let level = self.elevation();
        let mut best: Option<(f64, DVec3, &'static str)> = None;
        for side in SIDES {
            let towards = self.towards(side.azimuth, (level + side.above).max(-BELOW));
            let trial = self.try_out(towards);
            // Where no side is the outward one, all are alike.
            let score = trial.area() * (trial.front() + 0.1) * (SMOOTH + trial.content()).sqrt();
            let needed = if side.above.is_finite() { CLEARLY } else { FROM_BELOW };
            if best.as_ref().is_none_or(|(so_far, ..)| score > needed * so_far) {
                best = Some((score, towards, side.name));
            }
        }
        best.map(|(_, towards, name)| (towards, name)).expect("there are sides")
    }

    /// From how far above, in degrees: tall things from little above, flat ones and landscapes from where one sees their extent.
    fn elevation(&self) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for point in self.points {
            let p = self.frame.transpose() * *point;
            (low, high) = (low.min(p), high.max(p));
        }
        let extent = high - low;
        let flat = extent.y / (extent.x * extent.z).sqrt().max(1e-9);
        15.0 + 23.0 * ((0.7 - flat) / 0.6).clamp(0.0, 1.0)
    }

    /// Towards the camera, if this is a box with an open side.
    pub(super) fn open_side(&self) -> Option<(DVec3, &'static str)> {
        let half = self.frame.transpose().abs() * self.solid.half.as_dvec3();
        let sides: Vec<[f64; 2]> = (0..6).map(|side| self.openness(side)).collect();
        let shut = |side: usize| sides[side][1] >= SHUT;
        let open = |side: usize| sides[side][0] >= OPEN;
        // +z, +x, -x, -z.
        for side in [4, 0, 1, 5] {
            let axis = side / 2;
            let across = 2 - axis;
            let around = shut(2 * across) && shut(2 * across + 1) && shut(3);
            let opposite = side ^ 1;
            if !(open(side) && around && (shut(opposite) || open(opposite))) {
                continue;
            }
            let sign = if side.is_multiple_of(2) { 1.0 } else { -1.0 };
            let level = self.frame.col(axis) * sign;
            let straight = self.try_out(level);
            if half[axis] > DEEP * (half.y * half[across]).sqrt() {
                // A tunnel shows its inner side.
                let beside = self.try_out(self.towards(30.0, 15.0));
                if straight.front() < 0.5 || beside.front() > 0.5 {
                    continue;
                }
            }
            let towards = if open(2) { level + 0.3 * self.frame.y_axis } else { level };
            return Some((towards.normalize(), "in front of the open side"));
        }
        let walls = [0, 1, 4, 5].into_iter().all(shut);
        if open(2) && walls && shut(3) {
            let up = half.y / (half.x * half.z).sqrt();
            let elevation = (up.atan().to_degrees() + 20.0).clamp(30.0, 45.0);
            return Some((self.towards(30.0, elevation), "above the open side"));
        }
        None
    }

    /// How open a side of the bounds is, in the order +x, -x, +y, -y, +z, -z of the frame: the part of the rays straight into it that come further
    /// than half way, and the part that is stopped at once.
    fn openness(&self, side: usize) -> [f64; 2] {
        let (axis, sign) = (side / 2, if side.is_multiple_of(2) { 1.0 } else { -1.0 });
        let inward = self.frame.col(axis) * -sign;
        let (u, v) = (self.frame.col((axis + 1) % 3), self.frame.col((axis + 2) % 3));
        let extent = |direction: DVec3| direction.abs().dot(self.solid.half.as_dvec3());
        const BEFORE: f64 = 1e-3;
        let (mut deep, mut stopped) = (0, 0);
        for ray in 0..PROBES * PROBES {
            let at = |i: usize| (i as f64 + 0.513) / PROBES as f64 * 2.0 - 1.0;
            let across = u * at(ray % PROBES) * extent(u) + v * 0.998 * at(ray / PROBES) * extent(v);
            let hit = self.solid.meet(across - inward * (extent(inward) + BEFORE), inward);
            let depth =
                hit.map_or(f64::INFINITY, |hit| f64::from(hit.distance) - BEFORE) / (2.0 * extent(inward)).max(1e-9);
            deep += usize::from(depth > 0.5);
            stopped += usize::from(depth < 0.2);
        }
        [deep, stopped].map(|rays| rays as f64 / (PROBES * PROBES) as f64)
    }
}
