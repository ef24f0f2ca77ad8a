//! Angles that are degrees, and look as if radians were meant: a warning says so.

use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// A vertical field of view that is usual in radians, 11 degrees to a right angle. What is narrower is meant for a telescope.
pub(super) fn field_of_view(fov: f32) -> Option<String> {
    let usual = (0.2..=FRAC_PI_2 + 0.01).contains(&fov);
    usual.then(|| {
        format!(
            "fov = {fov} is in degrees, as narrow as a telescope's; if radians are meant, write {:.1}",
            fov.to_degrees()
        )
    })
}

/// Angles of a spot that are usual in radians, as glTF has them: the outer one, or the inner one beside an outer one in degrees.
pub(super) fn cone(inner: f32, outer: f32) -> Option<String> {
    let usual = |angle: f32| (0.2..=FRAC_PI_2 + 0.01).contains(&angle);
    if usual(outer) {
        let meant = outer.to_degrees();
        return Some(format!(
            "outer_angle = {outer} is in degrees, a narrow beam; if radians are meant, write {meant:.1}"
        ));
    }
    // Half degrees are what people write in degrees, and an inner angle within the outer one is what there is.
    let meant = inner.to_degrees();
    let within = usual(inner) && (2.0 * inner).fract() != 0.0 && meant <= outer + 0.5;
    within.then(|| {
        format!(
            "inner_angle = {inner} is in degrees, as outer_angle = {outer} is; if radians are meant, write {meant:.1}"
        )
    })
}

/// The diameter of a disc at infinity that is about the sun's or the moon's in radians.
pub(super) fn sun(angle: f32) -> Option<String> {
    let usual = (0.0085..=0.0098).contains(&angle);
    usual.then(|| {
        format!(
            "angle = {angle} is in degrees, a sixtieth of the sun's; if radians are meant, write {:.2}",
            angle.to_degrees()
        )
    })
}

/// Normals of faces that meet at less: an angle that is usual in radians, and in degrees hardly any.
pub(super) fn smooth(angle: f32) -> Option<String> {
    let usual = (0.2..=PI + 0.01).contains(&angle) && (2.0 * angle).fract() != 0.0;
    usual.then(|| {
        format!(
            "`smooth` is in degrees, and {angle} is hardly any; if radians are meant, write {:.0}",
            angle.to_degrees()
        )
    })
}

/// Whether it is a multiple of a twelfth of pi, to the digits that people write, within a whole turn.
fn is_twelfth(angle: f32) -> bool {
    let steps = (angle / (PI / 12.0)).round();
    angle.abs() <= TAU + 0.01 && steps != 0.0 && (angle - steps * (PI / 12.0)).abs() < 0.002
}

/// A turn by a multiple of a twelfth of pi; `key` is what says so.
pub(super) fn turn(key: &str, angle: f32) -> Option<String> {
    let meant = (angle.to_degrees() * 10.0).round() / 10.0;
    is_twelfth(angle).then(|| format!("`{key}` is in degrees; if radians are meant, write {meant}"))
}

/// Turns that are all multiples of a twelfth of pi.
pub(super) fn rotation(angles: Vec3) -> Option<String> {
    let turned: Vec<f32> = angles.to_array().into_iter().filter(|angle| *angle != 0.0).collect();
    let looks_so = !turned.is_empty() && turned.iter().all(|angle| is_twelfth(*angle));
    looks_so.then(|| {
        let [x, y, z] = angles.to_array().map(|angle| (angle.to_degrees() * 10.0).round() / 10.0);
        format!("`rotate` is in degrees; if radians are meant, write [{x}, {y}, {z}]")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::approx_constant, reason = "to the digits that people write")]
    fn radians_are_seen_and_degrees_left_alone() {
        assert!(field_of_view(0.785).is_some_and(|text| text.contains("write 45.0")));
        assert_eq!([2.0, 45.0, 0.1, 5e-5].map(field_of_view), [const { None }; 4]);
        assert!(rotation(Vec3::new(0.0, 1.5708, -3.14)).is_some_and(|text| text.contains("[0, 90, -179.9]")));
        for degrees in [[0.0; 3], [0.0, 90.0, 0.0], [1.0, 2.0, 3.0], [1.5708, 30.0, 0.0], [0.5, 0.0, 0.0]] {
            assert_eq!(rotation(Vec3::from(degrees)), None, "{degrees:?}");
        }
        assert!(turn("rotate", 1.5708).is_some_and(|text| text.contains("`rotate`") && text.contains("write 90")));
        assert_eq!([0.0, 1.0, 90.0, 30.0, -45.0].map(|angle| turn("rotate", angle)), [const { None }; 5]);
        assert!(cone(0.35, 20.0).is_some_and(|text| text.contains("inner_angle") && text.contains("write 20.1")));
        assert!(cone(0.35, 0.5).is_some_and(|text| text.contains("outer_angle")));
        for [inner, outer] in [[0.0, 20.0], [1.0, 20.0], [0.5, 20.0], [15.0, 20.0], [0.35, 5.0]] {
            assert_eq!(cone(inner, outer), None, "{inner} {outer}");
        }
        assert!(sun(0.00925).is_some_and(|text| text.contains("write 0.53")));
        assert_eq!([0.0, 0.53, 0.25, 1.0, 0.001].map(sun), [const { None }; 5]);
        assert!(smooth(0.698).is_some_and(|text| text.contains("write 40")));
        assert_eq!([0.0, 1.0, 0.5, 30.0, 180.0].map(smooth), [const { None }; 5]);
    }
}
