//! `luminaire view`: a window that shows the picture while it gets better, and lets the camera move.
//!
//! ```text
//! window (events, camera) ── Wanted, Order ─► worker thread: Tracer, Film, develop
//!        ▲                                            │
//!        └─ presenter ◄── 8-bit picture, figures ─────┘
//! ```
//!
//! The worker traces with any backend into a [`Film`](luminaire::film::Film), by the schedule of [`luminaire::render`]: at equal samples, size, camera and seed the
//! window shows what a PNG of `luminaire render` holds. The window's own Vulkan device only copies; it need not be the one that traces.

mod camera;
mod chain;
mod files;
mod first_hit;
mod lane;
mod overlay;
mod picture;
mod present;
mod window;
mod worker;

pub use overlay::HELP;
pub use window::run;

use luminaire::backend::Request;
use luminaire::scene::Scene;

/// What is viewed, and how.
#[derive(Debug, Clone)]
pub struct Options {
    /// The scene; its film has the size of the window.
    pub scene: Scene,
    /// What traces it.
    pub request: Request,
    /// Samples a pixel after which the picture is left as it is; `u32::MAX`: none.
    pub spp: u32,
}
