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

/// The outer angle of a spot that is usual in radians, as glTF has it.
pub(super) fn cone(outer: f32) -> Option<String> {
    let usual = (0.2..=FRAC_PI_2 + 0.01).contains(&outer);
    usual.then(|| {
        format!(
            "outer_angle = {outer} is in degrees, a narrow beam; if radians are meant, write {:.1}",
            outer.to_degrees()
        )
    })
}

/// Turns that are all multiples of a twelfth of pi, to the digits that people write.
pub(super) fn rotation(angles: Vec3) -> Option<String> {
    let twelfth = |angle: f32| {
        let steps = (angle / (PI / 12.0)).round();
        angle.abs() <= TAU + 0.01 && steps != 0.0 && (angle - steps * (PI / 12.0)).abs() < 0.002
    };
    let turned: Vec<f32> = angles.to_array().into_iter().filter(|angle| *angle != 0.0).collect();
    let looks_so = !turned.is_empty() && turned.iter().all(|angle| twelfth(*angle));
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
    }
}
