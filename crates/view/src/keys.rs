//! The keys that do something when they are pressed; those that are held to fly are an [`Input`](super::input::Input).
//!
//! A new key has four places: [`Action`] and [`action`] here, what it does in `App::act` (`app.rs`), its line in [`HELP`](super::overlay::HELP)
//! (`overlay.rs`), and its row in `docs/view.md`.

use super::first_hit::FirstHit;
use super::shown::Shown;
use super::wanted::{Order, Saved};
use winit::keyboard::{Key, NamedKey};

/// A step of the exposure in stops.
const EXPOSURE: f32 = 1.0 / 3.0;

/// What a key does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Adds so many stops to the exposure.
    Expose(f32),
    /// Develops the picture by the next tone curve.
    NextTone,
    /// Shows something else of the film.
    Show(Shown),
    /// Puts the camera where the scene has it.
    Return,
    /// Brings the whole scene into the picture.
    Frame,
    /// Has the worker do something.
    Order(Order),
    /// Stops tracing, or goes on.
    Pause,
    /// Shows the help, or hides it.
    Help,
    /// Closes the window.
    Quit,
}

/// What a key does when it is pressed, or again and again while it is held (`repeat`).
pub fn action(key: Key<&str>, repeat: bool) -> Option<Action> {
    Some(match key {
        Key::Character("+" | "=") => Action::Expose(EXPOSURE),
        Key::Character("-" | "_") => Action::Expose(-EXPOSURE),
        // A key that is held repeats only those above.
        _ if repeat => return None,
        Key::Named(NamedKey::Escape) => Action::Quit,
        Key::Named(NamedKey::Home) | Key::Character("r" | "R") => Action::Return,
        Key::Character("f" | "F") => Action::Frame,
        Key::Character("1") => Action::Show(Shown::Picture),
        Key::Character("2") => Action::Show(Shown::Error),
        Key::Character("3") => Action::Show(Shown::First(FirstHit::Albedo)),
        Key::Character("4") => Action::Show(Shown::First(FirstHit::Normal)),
        Key::Character("5") => Action::Show(Shown::First(FirstHit::Depth)),
        Key::Character("t" | "T") => Action::NextTone,
        Key::Character("x" | "X") => Action::Order(Order::Expose),
        Key::Character("b" | "B") => Action::Order(Order::NextBackend),
        Key::Character("n" | "N") => Action::Order(Order::NextEstimator),
        Key::Character("p" | "P") => Action::Order(Order::Save(Saved::Png)),
        Key::Character("o" | "O") => Action::Order(Order::Save(Saved::Exr)),
        Key::Character("c" | "C") => Action::Order(Order::SaveCamera),
        Key::Named(NamedKey::Space) => Action::Pause,
        Key::Character("h" | "H" | "?") => Action::Help,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_exposure_repeats() {
        let keys = "+=-_rRfF12345tTxXbBnNpPoOcChH?";
        for key in keys.split("").filter(|key| !key.is_empty()) {
            assert!(action(Key::Character(key), false).is_some(), "{key}");
            assert_eq!(action(Key::Character(key), true).is_some(), "+=-_".contains(key), "{key}");
        }
        assert_eq!(action(Key::Named(NamedKey::Escape), false), Some(Action::Quit));
        assert_eq!(action(Key::Character("y"), false), None);
    }
}
