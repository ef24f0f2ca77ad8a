//! `luminaire view`: a window that shows the picture while it gets better, and lets the camera move.
//!
//! ```text
//! window (events, camera) ── Wanted, Order ─► worker thread: Tracer, Film, develop
//!        ▲                                            │
//!        └─ presenter ◄── 8-bit picture, figures ─────┘
//! ```
//!
//! The worker traces with any backend into a [`Film`](luminaire::film::Film), by the steps of a [`Run`](luminaire::render::Run): at equal samples, size, camera and
//! seed the window shows what a PNG of `luminaire render` holds. The window's own Vulkan device only copies; it need not be the one that traces.
//!
//! | where | what |
//! |---|---|
//! | `window`, `events`, `app` | the window's life; what the window system reports; what that changes |
//! | `keys`, `input`, `camera`, `ball` | what keys do, what is held down, and where it takes the camera |
//! | `overlay`, `message` | text over the picture |
//! | `present`, `chain`, `device`, `surface` | pictures into the window |
//! | `link`, `wanted`, `news`, `sight`, `shown` | what goes between window and worker |
//! | `worker`, `lane`, `estimators`, `first_hit` | tracing |
//! | `develop`, `title`, `files`, `sensor_table` | the picture and the figures that are shown, the files that are saved |

mod app;
mod ball;
mod camera;
mod chain;
mod develop;
mod device;
mod estimators;
mod events;
mod files;
mod first_hit;
mod input;
mod keys;
mod lane;
mod link;
mod message;
mod news;
mod options;
mod overlay;
mod present;
mod sensor_table;
mod shown;
mod sight;
mod surface;
mod title;
mod wanted;
mod window;
mod worker;

pub use options::Options;
pub use overlay::HELP;
pub use window::run;
