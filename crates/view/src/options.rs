//! [`Options`]: the scene that a window shows, and what traces it.

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
