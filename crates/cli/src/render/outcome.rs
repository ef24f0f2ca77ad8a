//! [`Outcome`]: everything that is known when tracing has ended, in memory.

use super::options::Options;
use super::seconds::Seconds;
use crate::shared::foreseen::Foreseen;
use luminaire::Result;
use luminaire::backend::Renderer;
use luminaire::film::Aovs;
use luminaire::render::Rendered;
use luminaire::scene::Scene;

/// What is known when tracing has ended and the checkpoint is saved, before any picture is written.
pub struct Outcome<'a> {
    /// What was asked for.
    pub options: &'a Options,
    /// What was rendered.
    pub scene: &'a Scene,
    /// What rendered it.
    pub renderer: &'a Renderer,
    /// The film, and how the render ended.
    pub rendered: Rendered,
    /// What the camera sees first, where a file holds it.
    pub aovs: Option<Aovs>,
    /// Whether the checkpoint could be saved; none: there is no `--checkpoint`, or nothing to save.
    pub saved: Option<Result<()>>,
    /// What was foreseen of the picture.
    pub foreseen: &'a Foreseen,
    /// What there is to warn of, besides the scene's own warnings.
    pub warnings: Vec<String>,
    /// How long everything took until now.
    pub seconds: Seconds,
}
