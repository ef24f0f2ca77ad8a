//! Opens a window and runs its event loop until it is closed.

use super::app::App;
use super::news::News;
use super::options::Options;
use luminaire::{Error, Result};
use winit::event_loop::EventLoop;

/// Shows a scene in a window until it is closed.
///
/// # Errors
/// If there is no display or no device that presents to it, the window is too large for a film, or the tracer or the device fails.
pub fn run(options: Options) -> Result<()> {
    let event_loop = EventLoop::<News>::with_user_event().build().map_err(|e| {
        let text = e.to_string();
        // winit's text begins with a place in its own source, which is cut off.
        let reason = text.rsplit_once(": ").filter(|_| text.starts_with("os error at ")).map_or(&text[..], |(_, r)| r);
        Error::NoDevice(format!(
            "no window can be opened here ({}): run it where there is a display (DISPLAY or WAYLAND_DISPLAY is set), \
             or use `luminaire render`, which needs none",
            reason.trim().trim_end_matches('.')
        ))
    })?;
    let mut app = App::new(options, event_loop.create_proxy());
    let ran = event_loop.run_app(&mut app);
    app.close()?;
    ran.map_err(|e| Error::NoDevice(format!("the window system failed: {e}")))
}
