//! A map of a material while it is still being read.

use super::map_file::MapFile;

/// What is said about a map.
#[derive(Debug, Clone, Default)]
pub(super) enum MapDraft {
    /// Nothing.
    #[default]
    Unstated,
    /// That there shall be none.
    Removed,
    /// Where it is.
    File(MapFile),
}

impl MapDraft {
    /// Replaces it by what `other` states.
    pub(super) fn overlay(&mut self, other: &MapDraft) {
        if !matches!(other, MapDraft::Unstated) {
            *self = other.clone();
        }
    }

    /// The file, if there is one.
    pub(super) fn file(&self) -> Option<&MapFile> {
        if let MapDraft::File(map) = self { Some(map) } else { None }
    }
}
