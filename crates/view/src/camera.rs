//! Moving a sensor as programs for modelling do: it orbits around its target, pans, dollies and flies.

use super::ball::{Ball, NEAREST};
use glam::{DQuat, DVec2, DVec3};
use luminaire::scene::{Projection, Sensor};
use std::f64::consts::PI;

/// The smallest angle between the line of sight and straight up or down, in radians.
const POLE: f64 = 0.01;
/// The largest coordinate: its square is still far below the largest `f32`.
const FARTHEST: f64 = 1e15;

/// The axes of a sensor's picture.
struct Axes {
    /// Unit line of sight.
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// From the eye point to the target.
    distance: f64,
}

impl Axes {
    fn of(sensor: &Sensor) -> Self {
        let view = sensor.target.as_dvec3() - sensor.position.as_dvec3();
        let forward = view.normalize();
        let right = forward.cross(sensor.up.as_dvec3()).normalize();
        Axes { forward, right, up: right.cross(forward), distance: view.length() }
    }

    /// The line of sight turned by `angles` to the right and upwards, in radians, about the sensor's own up; it never tips over.
    fn turned(&self, up: DVec3, angles: DVec2) -> DVec3 {
        let from_up = self.forward.angle_between(up);
        let upwards = (from_up - angles.y).clamp(POLE, PI - POLE) - from_up;
        let tilted = DQuat::from_axis_angle(self.right, -upwards) * self.forward;
        (DQuat::from_axis_angle(up, -angles.x) * tilted).normalize()
    }
}

/// A sensor with another eye point and target. It stays as it was if the two would be the same point in single precision, or too far away.
fn placed(sensor: &Sensor, position: DVec3, target: DVec3) -> Sensor {
    let reach = position.abs().max(target.abs()).max_element();
    let nearest = (NEAREST * reach).max(f64::from(f32::MIN_POSITIVE));
    // Also false if a coordinate is NaN.
    if reach <= FARTHEST && position.distance(target) > nearest {
        Sensor { position: position.as_vec3(), target: target.as_vec3(), ..sensor.clone() }
    } else {
        sensor.clone()
    }
}

/// Moves the eye point around the target, so that the scene turns with a pointer that goes `angles` radians to the right and down.
pub fn orbit(sensor: &Sensor, angles: DVec2) -> Sensor {
    let axes = Axes::of(sensor);
    let forward = axes.turned(sensor.up.as_dvec3().normalize(), DVec2::new(angles.x, -angles.y));
    let target = sensor.target.as_dvec3();
    placed(sensor, target - forward * axes.distance, target)
}

/// Turns the line of sight about the eye point, `angles` radians to the right and down.
pub fn look(sensor: &Sensor, angles: DVec2) -> Sensor {
    let axes = Axes::of(sensor);
    let forward = axes.turned(sensor.up.as_dvec3().normalize(), DVec2::new(angles.x, -angles.y));
    let position = sensor.position.as_dvec3();
    placed(sensor, position, position + forward * axes.distance)
}

/// Moves eye point and target so that what is at the target's distance follows a pointer; `by` is to the right and down, in heights of the
/// picture.
pub fn pan(sensor: &Sensor, by: DVec2) -> Sensor {
    let axes = Axes::of(sensor);
    let height = match sensor.projection {
        Projection::Perspective { fov } => 2.0 * axes.distance * (f64::from(fov).to_radians() / 2.0).tan(),
        Projection::Orthographic { height } => f64::from(height),
    };
    let shift = height * (axes.up * by.y - axes.right * by.x);
    placed(sensor, sensor.position.as_dvec3() + shift, sensor.target.as_dvec3() + shift)
}

/// Moves the eye point to `factor` times its distance from the target; an orthographic picture also becomes `factor` times as high.
pub fn dolly(sensor: &Sensor, factor: f64) -> Sensor {
    let axes = Axes::of(sensor);
    let target = sensor.target.as_dvec3();
    let mut moved = placed(sensor, target - axes.forward * axes.distance * factor, target);
    if let Projection::Orthographic { height } = sensor.projection {
        let scaled = (f64::from(height) * factor) as f32;
        let height = if scaled.is_normal() { scaled } else { height };
        moved.projection = Projection::Orthographic { height };
    }
    moved
}

/// Moves eye point and target `by` to the right, up (the sensor's own) and forward, in the scene's unit.
pub fn fly(sensor: &Sensor, by: DVec3) -> Sensor {
    let axes = Axes::of(sensor);
    let shift = axes.right * by.x + sensor.up.as_dvec3().normalize() * by.y + axes.forward * by.z;
    placed(sensor, sensor.position.as_dvec3() + shift, sensor.target.as_dvec3() + shift)
}

/// Brings all of a ball into a picture of `aspect` (width over height), without turning.
pub fn frame(sensor: &Sensor, ball: Ball, aspect: f64) -> Sensor {
    let Ball { center, radius } = ball;
    let Axes { forward, right, up, .. } = Axes::of(sensor);
    let shift = sensor.shift.as_dvec2();
    match sensor.projection {
        Projection::Perspective { fov } => {
            let half_height = (f64::from(fov).to_radians() / 2.0).tan();
            let half = DVec2::new(half_height * aspect, half_height);
            // What the middle of the picture shows at distance 1, from the line of sight.
            let middle = 2.0 * shift * half;
            // As far as the ball touches one of the four planes through the eye point and an edge of the picture.
            let edge = middle.abs() + half;
            let distance = radius * ((DVec2::ONE + edge * edge).powf(0.5) / half).max_element();
            let target = center - distance * (right * middle.x + up * middle.y);
            placed(sensor, target - forward * distance, target)
        }
        Projection::Orthographic { .. } => {
            let height = 2.0 * radius / aspect.min(1.0);
            let target = center - height * (right * shift.x * aspect + up * shift.y);
            let mut framed = placed(sensor, target - forward * 2.0 * radius, target);
            framed.projection = Projection::Orthographic { height: height as f32 };
            framed
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};
    use luminaire::scene::load;

    fn sensor() -> Sensor {
        Sensor {
            position: Vec3::new(0.0, 1.0, 5.0),
            target: Vec3::new(0.0, 1.0, 0.0),
            up: Vec3::Y,
            projection: Projection::Perspective { fov: 90.0 },
            lens: None,
            shift: Vec2::ZERO,
        }
    }

    fn near(found: Vec3, expected: [f32; 3]) {
        assert!(found.distance(expected.into()) < 1e-5, "{found} for {expected:?}");
    }

    #[test]
    fn a_pointer_to_the_right_turns_the_scene_to_the_right() {
        // A quarter turn: the camera goes to the left side of the scene, which then faces it.
        let turned = orbit(&sensor(), DVec2::new(PI / 2.0, 0.0));
        near(turned.position, [-5.0, 1.0, 0.0]);
        near(turned.target, [0.0, 1.0, 0.0]);
        // A pointer that goes down shows the scene from above.
        let above = orbit(&sensor(), DVec2::new(0.0, PI / 4.0));
        near(above.position, [0.0, 1.0 + 12.5f32.sqrt(), 12.5f32.sqrt()]);
        // It never tips over.
        for pitch in [10.0, -10.0] {
            let pole = orbit(&sensor(), DVec2::new(0.3, pitch));
            let line = (pole.target - pole.position).normalize();
            assert!(line.y.abs() < 1.0 - 1e-5 && line.y.abs() > 0.999, "{line}");
        }
    }

    #[test]
    fn looking_panning_and_dollying_go_where_the_pointer_goes() {
        near(look(&sensor(), DVec2::new(PI / 2.0, 0.0)).target, [5.0, 1.0, 5.0]);
        assert!(look(&sensor(), DVec2::new(0.0, 0.1)).target.y < 1.0);
        // The whole height of the picture is 10 at the target.
        let panned = pan(&sensor(), DVec2::new(0.1, 0.0));
        near(panned.position, [-1.0, 1.0, 5.0]);
        near(pan(&sensor(), DVec2::new(0.0, 0.1)).target, [0.0, 2.0, 0.0]);
        near(dolly(&sensor(), 0.5).position, [0.0, 1.0, 2.5]);
        near(fly(&sensor(), DVec3::new(1.0, 2.0, 3.0)).position, [1.0, 3.0, 2.0]);
    }

    #[test]
    fn no_movement_makes_a_sensor_that_cannot_be_rendered() {
        let mut moved = sensor();
        (0..1000).for_each(|_| moved = dolly(&moved, 0.5));
        assert!(moved.position.distance(moved.target) > 0.0, "{moved:?}");
        (0..1000).for_each(|_| moved = dolly(&moved, 2.0));
        assert!(moved.position.is_finite() && moved.target.is_finite(), "{moved:?}");
        moved.projection = Projection::Orthographic { height: 3.0 };
        (0..1000).for_each(|_| moved = dolly(&moved, 0.5));
        assert!(matches!(moved.projection, Projection::Orthographic { height } if height > 0.0), "{moved:?}");
    }

    #[test]
    fn a_framed_scene_is_in_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.obj");
        std::fs::write(&path, "v 10 0 0\nv 11 0 0\nv 10 1 0\nf 1 2 3\n").unwrap();
        let scene = load(&path).unwrap();
        for aspect in [0.5, 2.0] {
            let projections = [Projection::Perspective { fov: 30.0 }, Projection::Orthographic { height: 1.0 }];
            let shifts = [Vec2::ZERO, Vec2::new(0.5, -2.0), Vec2::new(-0.25, 0.0)];
            for (projection, shift) in projections.into_iter().flat_map(|p| shifts.map(|shift| (p, shift))) {
                let framed = frame(&Sensor { projection, shift, ..sensor() }, Ball::around(&scene), aspect);
                let shift = 2.0 * shift.as_dvec2();
                let axes = Axes::of(&framed);
                for point in [DVec3::new(10.0, 0.0, 0.0), DVec3::new(11.0, 0.0, 0.0), DVec3::new(10.0, 1.0, 0.0)] {
                    let to = point - framed.position.as_dvec3();
                    let half = match framed.projection {
                        Projection::Perspective { fov } => {
                            to.dot(axes.forward) * (f64::from(fov).to_radians() / 2.0).tan()
                        }
                        Projection::Orthographic { height } => f64::from(height) / 2.0,
                    };
                    assert!(
                        (to.dot(axes.up) - shift.y * half).abs() <= half * 1.0001
                            && (to.dot(axes.right) - shift.x * half * aspect).abs() <= half * aspect * 1.0001
                    );
                }
            }
        }
    }
}
