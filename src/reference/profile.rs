//! Photometric profiles: the intensity of a lamp in a direction.

use crate::scene::{Profile, photometric_frame};
use glam::{DVec3, Vec3};

/// Which two of some rising angles a number lies between, as the index of the lower, and how far it is from there to the upper: 0 to 1, also beyond the ends.
pub fn interval(angles: &[f32], x: f64) -> (usize, f64) {
    let (mut low, mut high) = (0, angles.len() - 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if f64::from(angles[middle]) <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [a, b] = [low, low + 1].map(|index| f64::from(angles[index]));
    (low, ((x - a) / (b - a)).clamp(0.0, 1.0))
}

/// Candelas at these angles in degrees: bilinear, and 0 beyond the vertical ones.
pub fn candela(profile: &Profile, vertical: f64, horizontal: f64) -> f64 {
    let rows = profile.vertical.len();
    let [first, last] = [0, rows - 1].map(|index| f64::from(profile.vertical[index]));
    if vertical < first || vertical > last {
        return 0.0;
    }
    let (lower, v) = interval(&profile.vertical, vertical);
    let at = |row: usize| {
        let [a, b] = [lower, lower + 1].map(|column| f64::from(profile.candela[row * rows + column]));
        a + v * (b - a)
    };
    if profile.horizontal.len() == 1 {
        return at(0);
    }
    let (left, h) = interval(&profile.horizontal, horizontal);
    let [a, b] = [at(left), at(left + 1)];
    a + h * (b - a)
}

/// Candelas in which a luminaire that looks along `direction` sends along `out`, both of unit length.
pub fn photometric_intensity(profile: &Profile, direction: Vec3, up: Vec3, out: DVec3) -> f64 {
    let [zero, quarter] = photometric_frame(direction, up);
    let (x, y) = (out.dot(zero), out.dot(quarter));
    let vertical = x.hypot(y).atan2(out.dot(direction.as_dvec3())).to_degrees();
    candela(profile, vertical, y.atan2(x).to_degrees().rem_euclid(360.0))
}
