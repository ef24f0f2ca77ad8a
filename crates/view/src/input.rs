//! Keys and buttons that are held, and where they take the camera.

use super::camera;
use glam::{DVec2, DVec3};
use luminaire::scene::{Projection, Sensor};
use std::collections::HashSet;
use std::f64::consts::PI;
use std::time::{Duration, Instant};
use winit::dpi::PhysicalPosition;
use winit::event::{MouseButton, MouseScrollDelta};
use winit::keyboard::{KeyCode, ModifiersState};

/// The time between two steps of a flight.
pub const STEP: Duration = Duration::from_millis(16);
/// The speed of a flight, in radii of the scene a second.
const FLIGHT: f64 = 0.5;
/// With Shift a flight is so many times as fast.
const FAST: f64 = 5.0;
/// The most seconds that one step of a flight covers, so that the camera does not jump after the window has hung.
const LONGEST: f64 = 0.1;
/// One step of the wheel multiplies the distance by this.
const WHEEL: f64 = 0.9;
/// The pixels of a touchpad that count as one step of the wheel.
const WHEEL_PIXELS: f64 = 40.0;
/// The keys to fly with, by their place on the keyboard, and where each goes: right, up, forward.
const FLY: [(KeyCode, DVec3); 6] = [
    (KeyCode::KeyW, DVec3::Z),
    (KeyCode::KeyS, DVec3::NEG_Z),
    (KeyCode::KeyA, DVec3::NEG_X),
    (KeyCode::KeyD, DVec3::X),
    (KeyCode::KeyQ, DVec3::NEG_Y),
    (KeyCode::KeyE, DVec3::Y),
];

/// What is held down, and where the pointer is.
#[derive(Debug, Default)]
pub struct Input {
    /// The keys to fly with that are held.
    keys: HashSet<KeyCode>,
    buttons: HashSet<MouseButton>,
    modifiers: ModifiersState,
    pointer: Option<PhysicalPosition<f64>>,
    /// When the camera last flew a step.
    flown: Option<Instant>,
}

impl Input {
    /// Whether a key is one to fly with.
    pub fn is_to_fly(code: KeyCode) -> bool {
        FLY.iter().any(|(key, _)| *key == code)
    }

    /// A key to fly with was pressed or let go. One that is held counts from its first step.
    pub fn key(&mut self, code: KeyCode, pressed: bool) {
        if pressed {
            self.keys.insert(code);
        } else {
            self.keys.remove(&code);
        }
    }

    /// A button of the mouse was pressed or let go.
    pub fn button(&mut self, button: MouseButton, pressed: bool) {
        if pressed {
            self.buttons.insert(button);
        } else {
            self.buttons.remove(&button);
        }
    }

    /// Shift and its like are held, or not.
    pub fn modify(&mut self, modifiers: ModifiersState) {
        self.modifiers = modifiers;
    }

    /// Lets go of everything: when another window has the focus, releases are not reported here.
    pub fn let_go(&mut self) {
        self.keys.clear();
        self.buttons.clear();
    }

    /// The pointer has left the window. One with a button held is still followed.
    pub fn leave(&mut self) {
        if self.buttons.is_empty() {
            self.pointer = None;
        }
    }

    /// The pointer has moved: orbits, pans or looks around, depending on the buttons held. `height` is the picture's, in pixels.
    pub fn drag(&mut self, to: PhysicalPosition<f64>, sensor: &Sensor, height: u32) -> Option<Sensor> {
        let from = self.pointer.replace(to)?;
        // The move in heights of the picture.
        let by = DVec2::new(to.x - from.x, to.y - from.y) / f64::from(height);
        let held = |button| self.buttons.contains(&button);
        if held(MouseButton::Middle) || held(MouseButton::Left) && self.modifiers.shift_key() {
            Some(camera::pan(sensor, by))
        } else if held(MouseButton::Left) {
            Some(camera::orbit(sensor, PI * by))
        } else if held(MouseButton::Right) {
            // What was under the pointer stays under it.
            let fov = match sensor.projection {
                Projection::Perspective { fov } => f64::from(fov).to_radians(),
                Projection::Orthographic { .. } => 1.0,
            };
            Some(camera::look(sensor, -fov * by))
        } else {
            None
        }
    }

    /// Whether a key to fly with is held.
    pub fn flies(&self) -> bool {
        !self.keys.is_empty()
    }

    /// The camera after a step with the keys that are held, as long as the time since the last step, in a scene of this radius; none if no key is.
    pub fn fly(&mut self, sensor: &Sensor, radius: f64) -> Option<Sensor> {
        if !self.flies() {
            self.flown = None;
            return None;
        }
        let now = Instant::now();
        let last = self.flown.replace(now).unwrap_or(now - STEP);
        let seconds = (now - last).as_secs_f64().min(LONGEST);
        let direction: DVec3 = FLY.iter().filter(|(key, _)| self.keys.contains(key)).map(|(_, by)| *by).sum();
        let fast = if self.modifiers.shift_key() { FAST } else { 1.0 };
        Some(camera::fly(sensor, direction.normalize_or_zero() * FLIGHT * radius * fast * seconds))
    }
}

/// The wheel was turned: dollies.
pub fn wheel(delta: MouseScrollDelta, sensor: &Sensor) -> Sensor {
    let steps = match delta {
        MouseScrollDelta::LineDelta(_, y) => f64::from(y),
        MouseScrollDelta::PixelDelta(by) => by.y / WHEEL_PIXELS,
    };
    camera::dolly(sensor, WHEEL.powf(steps))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    #[test]
    fn only_a_held_button_or_key_moves_the_camera() {
        let sensor = Sensor {
            position: Vec3::new(0.0, 1.0, 5.0),
            target: Vec3::new(0.0, 1.0, 0.0),
            up: Vec3::Y,
            projection: Projection::Perspective { fov: 90.0 },
            lens: None,
            shift: Vec2::ZERO,
        };
        let mut input = Input::default();
        let at = |x| PhysicalPosition::new(x, 0.0);
        input.button(MouseButton::Left, true);
        assert_eq!(input.drag(at(10.0), &sensor, 100), None, "where it came from is not known");
        let orbit = input.drag(at(20.0), &sensor, 100).unwrap();
        assert_eq!(orbit.target, sensor.target);
        input.modify(ModifiersState::SHIFT);
        let pan = input.drag(at(30.0), &sensor, 100).unwrap();
        assert!((pan.target.x + 1.0).abs() < 1e-5, "a tenth of what is seen at the target: {}", pan.target);
        input.let_go();
        assert_eq!(input.drag(at(40.0), &sensor, 100), None);

        assert_eq!(input.fly(&sensor, 10.0), None);
        assert!(Input::is_to_fly(KeyCode::KeyW) && !Input::is_to_fly(KeyCode::KeyX));
        input.key(KeyCode::KeyW, true);
        let flown = input.fly(&sensor, 10.0).unwrap();
        // One step, with Shift.
        assert!((flown.position.z - (5.0 - 0.5 * 10.0 * 5.0 * 0.016)).abs() < 1e-5, "{}", flown.position);
        input.key(KeyCode::KeyW, false);
        assert!(!input.flies());
    }
}
