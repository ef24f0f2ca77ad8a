//! What the benchmark is asked to run.

use super::effort::Effort;
use super::scene::BenchScene;
use luminaire::backend::Backend;
use luminaire::picture::Picture;

/// What to run.
#[derive(Debug, Clone)]
pub struct Settings {
    /// How long it may take.
    pub effort: Effort,
    /// How often everything is measured.
    pub rounds: usize,
    /// The scenes, where a part measures scenes.
    pub scenes: Vec<BenchScene>,
    /// The backends, all of them there.
    pub backends: Vec<Backend>,
    /// Names of estimators ([`check_estimator`](super::check_estimator)).
    pub estimators: Vec<String>,
    /// What the only scene really looks like; none: it is rendered.
    pub reference: Option<Picture>,
}
