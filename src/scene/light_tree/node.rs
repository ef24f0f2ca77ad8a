//! What a node knows of its children.

use super::source::Source;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// The bit of a link that says that it is an index into the luminaire table, not of a node.
pub const LEAF: u32 = 1 << 31;
/// Children of a node, at most.
pub const CHILDREN: usize = 4;

/// Four children, number by number, as the kernel reads them: eight texels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LightNode {
    /// Centre of the ball around each.
    pub x: [f32; CHILDREN],
    /// The same.
    pub y: [f32; CHILDREN],
    /// The same.
    pub z: [f32; CHILDREN],
    /// Its radius; negative, and then not 0, where all light stays within a cone ([`Child::cone`]).
    pub radius: [f32; CHILDREN],
    /// Intensity towards where most goes, over the largest of the four, negative where the light of inner sides counts less
    /// ([`Child::closed`]); 0: there is no such child.
    pub strength: [f32; CHILDREN],
    /// The axis of the normals' cone, x and y in 16 bits each.
    pub axis_xy: [u32; CHILDREN],
    /// Its z, and [`Spread`], in 16 bits each.
    pub axis_z_spread: [u32; CHILDREN],
    /// Index of a node, or that of a luminaire with [`LEAF`]; `u32::MAX`: there is no such child.
    pub link: [u32; CHILDREN],
}

/// How far the normals may be from the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// At least the sine of the angle; 1: anywhere.
    pub sine: f64,
    /// Whether the light of both sides counts.
    pub two_sided: bool,
}

/// One child.
#[derive(Debug, Clone, Copy)]
pub struct Child {
    /// Centre of the ball.
    pub center: Vec3,
    /// Radius of the ball.
    pub radius: f32,
    /// Relative intensity.
    pub strength: f32,
    /// Unit axis of the normals; where they may be anywhere, shorter: their light is one and the scalar product with this of the mean.
    pub axis: DVec3,
    /// Around it.
    pub spread: Spread,
    /// Some of it are sides of closed lamps.
    pub closed: bool,
    /// All of it are spots and the like: no light leaves the cone around the axis of which [`Spread::sine`] is the cosine, here; the axis is of unit length.
    pub cone: bool,
}

/// What is added to the sine of a cone's angle: 16 bits of an axis round by 3e-5, and so do the tracers' cosines.
const CONE_MARGIN: f64 = 1e-3;
/// From this sine on a cone says nothing.
const WIDE: f64 = 0.95;
/// A relative margin of radii, far above the rounding of distances in `f32`.
const RADIUS_MARGIN: f64 = 1e-5;
/// How much more than the mean light may go one way where normals look everywhere.
const MOST_LEANING: f64 = 0.9;
/// What is left of the weakest next to the strongest, so that `f32` still has it.
const LEAST_STRENGTH: f64 = 1e-20;

/// A number from -1 to 1 in 16 bits.
fn snorm(value: f64) -> u32 {
    let steps = (value * 32767.0).round().clamp(-32767.0, 32767.0) as i16;
    u32::from(steps as u16)
}

/// What [`snorm`] made.
fn from_snorm(bits: u32) -> f64 {
    (f64::from(bits as u16 as i16) / 32767.0).max(-1.0)
}

impl LightNode {
    /// Puts a child into its place.
    pub(super) fn set(&mut self, number: usize, child: &Child, link: u32) {
        let Spread { sine, two_sided } = child.spread;
        // Towards the wider cone.
        let wider = if child.cone { (sine * 32767.0).floor() } else { (sine * 32767.0).ceil() };
        let sine = (wider / 32767.0).clamp(-1.0, 1.0);
        self.x[number] = child.center.x;
        self.y[number] = child.center.y;
        self.z[number] = child.center.z;
        self.radius[number] = if child.cone { -child.radius.max(f32::MIN_POSITIVE) } else { child.radius };
        self.strength[number] = if child.closed { -child.strength } else { child.strength };
        self.axis_xy[number] = snorm(child.axis.x) | snorm(child.axis.y) << 16;
        self.axis_z_spread[number] = snorm(child.axis.z) | snorm(if two_sided { -sine } else { sine }) << 16;
        self.link[number] = link;
    }

    /// What was put there, up to 16 bits.
    pub fn child(&self, number: usize) -> Child {
        let [xy, z_spread] = [self.axis_xy[number], self.axis_z_spread[number]];
        let spread = from_snorm(z_spread >> 16);
        let cone = self.radius[number] < 0.0;
        Child {
            center: Vec3::new(self.x[number], self.y[number], self.z[number]),
            radius: self.radius[number].abs(),
            strength: self.strength[number].abs(),
            axis: DVec3::new(from_snorm(xy), from_snorm(xy >> 16), from_snorm(z_spread)),
            spread: Spread { sine: if cone { spread } else { spread.abs() }, two_sided: !cone && spread < 0.0 },
            closed: self.strength[number] < 0.0,
            cone,
        }
    }
}

/// Intensity of all of a group.
pub(super) fn strength(group: &[Source]) -> f64 {
    group.iter().map(|source| source.strength).sum()
}

/// The sum of the normals, those of two-sided lamps turned so that they add up.
pub(super) fn axis_sum(group: &[Source]) -> DVec3 {
    group.iter().fold(DVec3::ZERO, |sum, source| {
        let normal = source.strength * source.normal;
        if source.turns() && normal.dot(sum) < 0.0 { sum - normal } else { sum + normal }
    })
}

/// Bounds of a group, as a child of a node whose strongest child has this intensity.
pub(super) fn child(group: &[Source], strongest: f64) -> Child {
    let corners = || group.iter().flat_map(|source| source.corners);
    let (low, high) = corners().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
    let center = (0.5 * (low.as_dvec3() + high.as_dvec3())).as_vec3();
    let from_center = center.as_dvec3();
    let radius = corners().map(|corner| corner.as_dvec3().distance_squared(from_center)).fold(0.0, f64::max).sqrt();
    let radius = (radius * (1.0 + RADIUS_MARGIN)) as f32;

    let two_sided = group.iter().any(Source::turns);
    let axis = axis_sum(group).normalize_or_zero();
    if axis != DVec3::ZERO
        && let Some(widest) = cone_around(group, axis)
    {
        let strength = (strength(group) / strongest).max(LEAST_STRENGTH) as f32;
        let spread = Spread { sine: widest.min(PI).cos(), two_sided: false };
        return Child { center, radius, strength, axis, spread, closed: false, cone: true };
    }
    let cosine = |source: &Source| {
        let cosine = if source.shines_back() { -1.0 } else { axis.dot(source.normal) };
        if source.turns() { cosine.abs() } else { cosine }
    };
    let least = group.iter().map(cosine).fold(1.0, f64::min);
    let sine = if least > 0.0 { (1.0 - least * least).max(0.0).sqrt() + CONE_MARGIN } else { 1.0 };
    let wide = axis == DVec3::ZERO || sine >= WIDE;
    // All around, a triangle sends a quarter of what it sends along its normal, one with two sides half.
    let share = |source: &Source| match (source.normal == DVec3::ZERO, source.turns()) {
        (true, _) => 1.0,
        _ if source.shines_back() => 1.0,
        (_, true) => 0.5,
        (_, false) => 0.25,
    };
    let intensity: f64 = if wide { group.iter().map(|s| s.strength * share(s)).sum() } else { strength(group) };
    // The mean of a cosine's positive part over normals that look everywhere, to first order: a quarter, and half the cosine with their mean.
    let one_way = group.iter().filter(|source| !source.turns()).map(|source| source.strength * source.normal);
    let mean = one_way.fold(DVec3::ZERO, |sum, normal| sum + normal);
    let axis = if wide { mean.normalize_or_zero() * (0.5 * mean.length() / intensity).min(MOST_LEANING) } else { axis };
    Child {
        center,
        radius,
        strength: (intensity / strongest).max(LEAST_STRENGTH) as f32,
        axis,
        spread: Spread { sine: if wide { 1.0 } else { sine }, two_sided: two_sided && !wide },
        closed: group.iter().any(|source| source.closed),
        cone: false,
    }
}

/// The angle from `axis` within which all light of a group of cones stays, in radians; none if not all of them are cones.
fn cone_around(group: &[Source], axis: DVec3) -> Option<f64> {
    group.iter().try_fold(0.0, |widest: f64, source| {
        let aside = axis.dot(source.normal).clamp(-1.0, 1.0).acos();
        Some(widest.max(aside + source.cone?.to_radians()))
    })
}
