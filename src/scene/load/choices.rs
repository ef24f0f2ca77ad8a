//! What is chosen for a scene in place of what its file says, or does not say.

use crate::scene::Side;
use crate::{Error, Result};
use glam::Vec3;
use std::path::{Path, PathBuf};

/// The angle in degrees below which the faces of a bare model share normals where nobody says anything: the facets of scans and of coarse
/// curved meshes meet at less, the edges of what is made of planes at more.
pub(super) const SMOOTH: f32 = 40.0;

/// Choices in place of what a file says. `None` is the file's own word; a bare model has none, and gets what suits it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Choices {
    /// Light from all around. A bare model gets the studio sky if nothing in it emits, or next to nothing; one that its own lamps light, a faint
    /// grey around it, unless the camera stands inside.
    pub sky: Option<Sky>,
    /// Whether there is a ground under the model. A bare model that has a sky gets one unless it brings its own.
    pub ground: Option<bool>,
    /// Bare models only: degrees from 0 to 180, as the key `smooth` of a scene file has them.
    pub smooth: Option<f32>,
    /// Bare models only: the axis that points up in the file; y if nothing is said.
    pub up: Option<Up>,
    /// Bare models only: whether there is a lamp at the camera. There is one where the camera stands in a room of which lamps light less than half, or little.
    pub fill: Option<bool>,
    /// Bare models only: the side that the camera looks at, from outside; none: the one that shows it best.
    pub view: Option<Side>,
}

/// Light from all around.
#[derive(Debug, Clone, PartialEq)]
pub enum Sky {
    /// The built-in sky, [`EnvironmentImage::studio`](crate::scene::EnvironmentImage::studio).
    Studio,
    /// A latitude-longitude image.
    Image(PathBuf),
    /// The same radiance from everywhere.
    Even(Vec3),
    /// None.
    None,
}

/// The axis that points up in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Up {
    /// As luminaire has it.
    Y,
    /// As programs for buildings, maps and printers have it: the model is turned by -90 degrees about x.
    Z,
}

impl Choices {
    /// Refuses what only a bare model can be told.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the key of the scene file.
    pub(super) fn check_for_scene_file(&self, path: &Path) -> Result<()> {
        let (option, instead) = match self {
            Choices { smooth: Some(_), .. } => ("--smooth", "an [[object]] of it has the key `smooth`, in degrees"),
            Choices { up: Some(_), .. } => {
                ("--up", "an [[object]] of it is turned from z up to y up by `rotate = [-90, 0, 0]`")
            }
            Choices { view: Some(_), .. } => ("--view", "its camera is the table [sensor]; or --camera takes another"),
            Choices { fill: Some(_), .. } => {
                ("--fill", "a lamp at the camera is a [[luminaire]] of it, kind = \"point\"")
            }
            _ => return Ok(()),
        };
        Err(Error::Usage(format!("{option} is for bare models, and {} is a scene file: {instead}", path.display())))
    }
}
