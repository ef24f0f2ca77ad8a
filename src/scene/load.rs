//! From a path to a [`Scene`].

use super::Scene;
use crate::{Error, Result};
use std::path::Path;

/// Loads a scene file, or any OBJ.
///
/// # Errors
/// If a file cannot be read or is wrong; the error names file and line.
pub fn load(path: &Path) -> Result<Scene> {
    Err(Error::scene(path, "not loaded yet"))
}
