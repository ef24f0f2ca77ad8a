//! Which format a scene or a model is in: by its content, and by its ending where the content says nothing.

use super::other_formats::{self, BLENDER, MESHLAB};
use std::path::Path;

/// So much of a file is looked at: a glTF says what it is before its first large table, but may say much else before.
const HEAD: u64 = 64 << 10;

/// Endings of what is read, scene files first.
pub(super) const ENDINGS: [&str; 2] = ["toml", "obj"];

/// A format of scenes or models that has a name here, whether or not it is read already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// Luminaire's own scene file, TOML.
    SceneFile,
    /// Wavefront's OBJ.
    Obj,
    /// glTF as JSON.
    Gltf,
    /// glTF as one binary file.
    Glb,
    /// The polygon file format, "Stanford triangles".
    Ply,
}

impl Format {
    /// The format of a file; none if it is of another format, which [`other_formats::named`] may know, or of none.
    ///
    /// What begins as a glTF, a GLB or a PLY is one, whatever its name. An OBJ and a scene file are any text, so that their endings decide, unless the content is binary and
    /// known. A file that is not there, or cannot be read, is what its ending says.
    pub(super) fn of(path: &Path) -> Option<Format> {
        let start = other_formats::first_bytes(path, HEAD);
        if let Some(format) = Self::by_content(&start) {
            return Some(format);
        }
        let format = Self::by_ending(path)?;
        let is_text = matches!(format, Format::SceneFile | Format::Obj);
        let foreign =
            if is_text { other_formats::is_no_text(&start) } else { other_formats::by_content(&start).is_some() };
        (!foreign).then_some(format)
    }

    /// That there is no reader of models in this format, as a sentence.
    pub(super) fn not_yet(self) -> String {
        let (what, how) = match self {
            Format::SceneFile => ("a scene file", "name a model"),
            Format::Obj => ("OBJ", MESHLAB),
            Format::Gltf => ("glTF (.gltf)", BLENDER),
            Format::Glb => ("glTF (.glb)", BLENDER),
            Format::Ply => ("PLY", MESHLAB),
        };
        format!("this is {what}, which is not read yet: {how}")
    }

    fn by_content(start: &[u8]) -> Option<Format> {
        let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
        if start.starts_with(b"glTF") {
            return Some(Format::Glb);
        }
        if text.strip_prefix(b"ply").is_some_and(|rest| rest.starts_with(b"\n") || rest.starts_with(b"\r")) {
            return Some(Format::Ply);
        }
        let is_object = text.trim_ascii_start().starts_with(b"{");
        let asset = b"\"asset\"";
        (is_object && text.windows(asset.len()).any(|part| part == asset)).then_some(Format::Gltf)
    }

    fn by_ending(path: &Path) -> Option<Format> {
        Some(match path.extension()?.to_string_lossy().to_ascii_lowercase().as_str() {
            "toml" => Format::SceneFile,
            "obj" => Format::Obj,
            "gltf" => Format::Gltf,
            "glb" => Format::Glb,
            "ply" => Format::Ply,
            _ => return None,
        })
    }
}

/// Whether a file is a model by itself, which gets what it does not say, and no scene file: by its content, or by its ending where the content says nothing or it is
/// not there.
pub fn is_bare(path: &Path) -> bool {
    Format::of(path).is_some_and(|format| format != Format::SceneFile)
}

/// Whether a file is a scene file or a model, as [`is_bare`] knows it.
pub fn is_scene(path: &Path) -> bool {
    Format::of(path).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_counts_before_the_ending() {
        let folder = tempfile::tempdir().unwrap();
        let gltf = "{ \"scenes\": [], \"asset\": { \"version\": \"2.0\" } }";
        let late = format!("{{ \"extras\": \"{}\", \"asset\": {{}} }}", "x".repeat(HEAD as usize));
        for (name, content, expected) in [
            ("a.toml", &b"[film]\n"[..], Some(Format::SceneFile)),
            ("a.OBJ", b"v 0 0 0\n", Some(Format::Obj)),
            ("a.obj", b"", Some(Format::Obj)),
            ("a.obj", b"\xef\xbb\xbfv 0 0 0\n", Some(Format::Obj)),
            // Wrong endings, and none.
            ("a.glb", b"glTF\x02\0\0\0", Some(Format::Glb)),
            ("a.gltf", b"glTF\x02\0\0\0", Some(Format::Glb)),
            ("a.obj", b"glTF", Some(Format::Glb)),
            ("a.toml", b"glTF\x01\0\0\0", Some(Format::Glb)),
            ("a", b"glTF\x02\0\0\0", Some(Format::Glb)),
            ("a.glb", gltf.as_bytes(), Some(Format::Gltf)),
            ("a.json", gltf.as_bytes(), Some(Format::Gltf)),
            ("a.obj", gltf.as_bytes(), Some(Format::Gltf)),
            ("a.txt", &[b"\xef\xbb\xbf \n\t", gltf.as_bytes()].concat(), Some(Format::Gltf)),
            ("a.obj", b"ply\nformat ascii 1.0\n", Some(Format::Ply)),
            ("a.mesh", b"ply\r\nformat ascii 1.0\r\n", Some(Format::Ply)),
            ("a.mesh", b"ply\rformat ascii 1.0\r", Some(Format::Ply)),
            ("a.mesh", b"\xef\xbb\xbfply\nformat ascii 1.0\n", Some(Format::Ply)),
            // Cut off: only the ending is left.
            ("a.glb", b"glT", Some(Format::Glb)),
            ("a.glb", b"", Some(Format::Glb)),
            ("a.gltf", b"{}", Some(Format::Gltf)),
            ("a.gltf", b"", Some(Format::Gltf)),
            ("a.GLTF", late.as_bytes(), Some(Format::Gltf)),
            ("a.ply", b"pl", Some(Format::Ply)),
            ("a.bin", b"glT", None),
            ("a.bin", b"ply", None),
            ("a.bin", b"plywood\n", None),
            ("a.json", b"{ \"scene\": {} }", None),
            ("a.json", late.as_bytes(), None),
            // Others.
            ("a.fbx", b"Kaydara FBX Binary  \0", None),
            ("a.obj", b"Kaydara FBX Binary  \0", None),
            ("a.toml", b"PXR-USDC", None),
            ("a.glb", b"Kaydara FBX Binary  \0", None),
            ("a.gltf", b"<?xml version=\"1.0\"?><COLLADA>", None),
            ("a.glb", b"version https://git-lfs.github.com/spec/v1\n", None),
            ("a.obj", b"version https://git-lfs.github.com/spec/v1\n", None),
            ("a.obj", b"\x1f\x8b\x08", None),
            // What a text may hold is none of these.
            ("a.obj", b"# made from a.dae, <COLLADA>\nv 0 0 0\n", Some(Format::Obj)),
            ("a.toml", b"# LookAt the Camera of pbrt\n", Some(Format::SceneFile)),
            ("a.png", b"\x89PNG\r\n\x1a\n", None),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            assert_eq!(Format::of(&path), expected, "{name}: {}", String::from_utf8_lossy(content));
            assert_eq!(is_scene(&path), expected.is_some());
            assert_eq!(is_bare(&path), expected.is_some_and(|format| format != Format::SceneFile));
        }
        assert_eq!(Format::of(&folder.path().join("none.glb")), Some(Format::Glb), "it need not exist");
        assert_eq!(Format::of(folder.path()), None);
    }
}
