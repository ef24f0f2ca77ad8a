//! stub
use super::choices::Choices;
use super::bare_mesh;
use crate::Result;
use std::path::Path;
/// stub
pub fn scene_file(path: &Path, choices: &Choices, _folder: &Path) -> Result<String> {
    bare_mesh::load(path, choices)?;
    Ok(String::new())
}
