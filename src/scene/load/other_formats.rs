//! Scenes and meshes in formats that are not read: what they are, and what makes an OBJ of them.

use std::io::Read;
use std::path::Path;

pub(super) const BLENDER: &str = "import it in Blender (File > Import) and export it with File > Export > Wavefront (.obj), `Triangulated Mesh` and `Materials` on";
pub(super) const MESHLAB: &str =
    "convert it, for example with MeshLab (File > Export Mesh As > .obj), Blender, or `assimp export IN out.obj`";
const BY_HAND: &str =
    "export its meshes as .obj, and write sensor, luminaires and materials into a .toml (scenes/README.md)";

/// What a file is and how it becomes an OBJ, by its content and, where that says nothing, its ending; none if neither is known.
pub(super) fn named(path: &Path) -> Option<String> {
    let start = first_bytes(path, 512);
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let (what, how) = by_content(&start).or_else(|| by_ending(&ending))?;
    Some(format!("{what} is not read here: {how}"))
}

/// The first bytes of a regular file, at most so many; none of what is not there or cannot be read.
pub(super) fn first_bytes(path: &Path, most: u64) -> Vec<u8> {
    let mut start = Vec::new();
    // A pipe or a device may never end.
    if path.is_file()
        && let Ok(file) = std::fs::File::open(path)
    {
        // What cannot be read has its ending still.
        let _ = file.take(most).read_to_end(&mut start);
    }
    start
}

/// Whether this begins a file of another format, which nobody could take for an OBJ or a scene file, whatever such a text may hold.
pub(super) fn is_no_text(start: &[u8]) -> bool {
    binary(start).is_some()
}

/// Formats that are known by bytes which no OBJ and no scene file begins with.
fn binary(start: &[u8]) -> Option<(&'static str, &'static str)> {
    Some(match start {
        _ if start.starts_with(b"Kaydara FBX Binary") => ("FBX", BLENDER),
        _ if start.starts_with(b"PXR-USDC") => ("USD", BLENDER),
        _ if start.starts_with(b"Ogawa") => ("Alembic", BLENDER),
        _ if start.starts_with(b"BLENDER") => {
            ("Blender's own format", "open it in Blender and export it with File > Export > Wavefront (.obj)")
        }
        [0x1f, 0x8b, ..] => ("a compressed file", "unpack it first, for example with `gunzip`"),
        _ if start.starts_with(b"version https://git-lfs") => {
            ("a pointer of Git LFS in place of the file", "fetch it with `git lfs pull`")
        }
        _ => return None,
    })
}

/// Formats that are known by how they begin, and how one of them becomes an OBJ.
pub(super) fn by_content(start: &[u8]) -> Option<(&'static str, &'static str)> {
    let text = String::from_utf8_lossy(&start[..start.len().min(512)]);
    let has = |part: &str| text.contains(part);
    binary(start).or_else(|| {
        Some(match start {
            _ if text.starts_with("; FBX ") => ("FBX", BLENDER),
            _ if text.starts_with("#usda") => ("USD", BLENDER),
            _ if text.starts_with("solid ") && has("facet") => ("STL", MESHLAB),
            _ if text.starts_with("OFF\n") || text.starts_with("COFF\n") || text.starts_with("NOFF\n") => {
                ("OFF", MESHLAB)
            }
            _ if text.starts_with("#VRML") || has("<X3D") => ("VRML or X3D", BLENDER),
            _ if has("<COLLADA") => ("COLLADA", BLENDER),
            _ if has("<scene version") => ("a scene of Mitsuba", BY_HAND),
            _ if has("WorldBegin") || has("LookAt ") && has("Camera ") => ("a scene of pbrt", BY_HAND),
            _ => return None,
        })
    })
}

fn by_ending(ending: &str) -> Option<(&'static str, &'static str)> {
    Some(match ending {
        "fbx" => ("FBX", BLENDER),
        "usd" | "usda" | "usdc" | "usdz" => ("USD", BLENDER),
        "abc" => ("Alembic", BLENDER),
        "dae" => ("COLLADA", BLENDER),
        "x3d" | "wrl" | "vrml" => ("VRML or X3D", BLENDER),
        "blend" => ("Blender's own format", "open it in Blender and export it with File > Export > Wavefront (.obj)"),
        "3ds" | "max" | "ma" | "mb" | "c4d" | "lwo" | "lws" | "skp" | "hip" | "3dm" | "ztl" => {
            ("a format of a modelling program", "open it there (or in Blender) and export it as .obj")
        }
        "stl" => ("STL", MESHLAB),
        "off" => ("OFF", MESHLAB),
        "3mf" | "amf" => ("a format of 3D printers", MESHLAB),
        "step" | "stp" | "iges" | "igs" | "ifc" | "dxf" | "dwg" => {
            ("a format of constructions", "mesh it, for example with FreeCAD (File > Export > .obj)")
        }
        "las" | "laz" | "e57" | "xyz" | "pcd" | "pts" => {
            ("a cloud of points", "make a mesh of it, for example with MeshLab, and export that as .obj")
        }
        "pbrt" => ("a scene of pbrt", BY_HAND),
        "xml" => ("a scene of Mitsuba or another program", BY_HAND),
        "mtl" => ("a library of materials without its mesh", "name the .obj that uses it"),
        "json" | "yaml" | "yml" => ("a scene in this language", "write it as .toml (scenes/README.md)"),
        "zip" | "gz" | "7z" | "rar" | "tar" | "xz" | "zst" | "bz2" => ("an archive", "unpack it first"),
        "exr" | "png" | "hdr" | "jpg" | "jpeg" | "pfm" => (
            "a picture",
            "`luminaire compare` and `luminaire merge` take pictures, or name it in a scene file as a texture or an environment",
        ),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_counts_before_the_ending() {
        let folder = tempfile::tempdir().unwrap();
        for (name, content, parts) in [
            ("a.glb", &b"Ogawa\xff"[..], ["Alembic", "Wavefront"]),
            ("a.gltf", b"version https://git-lfs.github.com/spec/v1\n", ["Git LFS", "git lfs pull"]),
            ("a.obj", b"\x1f\x8b\x08\0", ["compressed", "gunzip"]),
            ("a.x", b"Kaydara FBX Binary  \0", ["FBX", "Blender"]),
            ("a.stl", b"\0\0\0\0", ["STL", "MeshLab"]),
            ("a.dae", b"<?xml version=\"1.0\"?><COLLADA>", ["COLLADA", "Blender"]),
            ("a.xml", b"<scene version=\"2.0.0\">", ["Mitsuba", ".toml"]),
            ("a.pbrt", b"", ["pbrt", ".toml"]),
            ("a.BLEND", b"BLENDER-v300", ["Blender", "Export"]),
            ("a.usdz", b"PK", ["USD", "Blender"]),
            ("a.3ds", b"MM", ["modelling", ".obj"]),
        ] {
            std::fs::write(folder.path().join(name), content).unwrap();
            let said = named(&folder.path().join(name)).unwrap_or_default();
            assert!(parts.iter().all(|part| said.contains(part)), "{name}: {said}");
            assert!(said.contains("is not read here"), "{said}");
        }
        assert!(named(&folder.path().join("none.fbx")).is_some_and(|said| said.contains("FBX")), "it need not exist");
        assert_eq!(named(&folder.path().join("none")), None);
    }
}
