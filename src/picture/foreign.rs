//! Files that are no picture which can be read here: what they are, and what makes one of them.

use std::path::Path;

/// What a file is and how it becomes a picture, in words that can follow its name, by its first bytes and, where these say nothing, its
/// ending; none if neither is known.
pub(super) fn named(path: &Path, start: &[u8]) -> Option<String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let (what, how) = by_content(start).or_else(|| by_ending(&ending))?;
    Some(format!("it is {what}, which is not read here: {how}"))
}

/// Formats that are read, for messages.
const KNOWN: &str = "OpenEXR, Radiance, PFM, PNG, JPEG, TIFF, BMP, TGA, GIF, PNM, WebP";

/// That a file's first bytes are those of no picture, in words that can follow its name; none if they are.
pub(super) fn unknown(path: &Path, start: &[u8]) -> Option<String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if start.is_empty() {
        return Some("it is empty".into());
    }
    // A TGA says nothing of itself.
    if image::guess_format(start).is_ok() || ending == "tga" {
        return None;
    }
    let claimed = match ending.as_str() {
        "exr" => "OpenEXR",
        "hdr" | "pic" | "rgbe" => "Radiance",
        "png" => "PNG",
        "jpg" | "jpeg" => "JPEG",
        "tif" | "tiff" => "TIFF",
        "bmp" => "BMP",
        "gif" => "GIF",
        "webp" => "WebP",
        "pfm" | "ppm" | "pgm" | "pbm" | "pnm" => "PNM or PFM",
        _ => return Some(format!("it is no picture: its first bytes are those of none of {KNOWN}")),
    };
    Some(format!(
        "it is no {claimed} picture, which its name says, and none of another format: it is damaged, or something else"
    ))
}

const MAGICK: &str = "convert it, for example with `magick IN out.png`";
const OIIO: &str = "convert it, for example with `oiiotool IN -o out.png` (or out.exr)";

fn by_content(start: &[u8]) -> Option<(&'static str, &'static str)> {
    // An ISO base media file: a box of a size, then its brand.
    let brand = start.get(4..12).filter(|at| at.starts_with(b"ftyp")).map(|at| &at[4..8]);
    Some(match start {
        _ if matches!(brand, Some(b"avif" | b"avis")) => ("an AVIF picture", MAGICK),
        _ if matches!(brand, Some(b"heic" | b"heix" | b"hevc" | b"heim" | b"heis" | b"mif1" | b"msf1")) => {
            ("a HEIC picture", MAGICK)
        }
        _ if brand.is_some() => {
            ("a film", "write one of its frames to a PNG, for example with `ffmpeg -i IN -frames 1 out.png`")
        }
        [b'D', b'D', b'S', b' ', ..] => ("a DirectDraw surface (DDS)", MAGICK),
        [0xab, b'K', b'T', b'X', ..] => ("a KTX texture", "convert it, for example with `ktx extract IN out.png`"),
        [b's', b'B', ..] => ("a Basis texture", "unpack it with `basisu -unpack IN`"),
        [b'8', b'B', b'P', b'S', ..] => ("a Photoshop document", "export it as PNG, or `magick 'IN[0]' out.png`"),
        [b'g', b'i', b'm', b'p', b' ', b'x', b'c', b'f', ..] => ("a GIMP document", "export it as PNG"),
        [0, 0, 0, 12, b'j', b'P', ..] | [0xff, 0x4f, 0xff, 0x51, ..] => ("a JPEG 2000 picture", MAGICK),
        [0, 0, 0, 12, b'J', b'X', b'L', ..] | [0xff, 0x0a, ..] => {
            ("a JPEG XL picture", "convert it, for example with `djxl IN out.png`")
        }
        [b'q', b'o', b'i', b'f', ..] => ("a QOI picture", MAGICK),
        [b'f', b'a', b'r', b'b', b'f', b'e', b'l', b'd', ..] => ("a farbfeld picture", MAGICK),
        [0, 0, 1, 0, ..] => ("an icon", MAGICK),
        [b'S', b'D', b'P', b'X', ..] | [b'X', b'P', b'D', b'S', ..] => ("a DPX picture", OIIO),
        [0x80, 0x2a, 0x5f, 0xd7, ..] => ("a Cineon picture", OIIO),
        [0x01, 0xda, ..] => ("a picture of Silicon Graphics (.sgi, .rgb)", MAGICK),
        [b'%', b'P', b'D', b'F', ..] => {
            ("a PDF document", "convert it, for example with `magick -density 300 'IN[0]' out.png`")
        }
        _ if start.starts_with(b"version https://git-lfs") => {
            ("a pointer of Git LFS in place of the picture", "fetch it with `git lfs pull`")
        }
        _ if contains(start, b"<svg") => {
            ("an SVG drawing", "convert it, for example with `rsvg-convert IN -o out.png`")
        }
        _ if contains(start, b"<!doctype html") || contains(start, b"<html") => {
            ("a page of the web in place of the picture", "fetch the picture itself")
        }
        _ => return None,
    })
}

fn by_ending(ending: &str) -> Option<(&'static str, &'static str)> {
    Some(match ending {
        "dds" | "pcx" | "sgi" | "rgb" | "rgba" | "bw" | "ico" | "jp2" | "j2k" | "qoi" | "ff" | "pict" | "wbmp"
        | "xpm" | "xbm" | "jxr" | "wdp" => ("a picture of another format", MAGICK),
        "svg" | "svgz" => ("an SVG drawing", "convert it, for example with `rsvg-convert IN -o out.png`"),
        "psd" | "psb" | "kra" | "xcf" | "afphoto" | "clip" => ("a document of a painting program", "export it as PNG"),
        "tx" | "tex" | "ptx" | "rat" => ("a texture of another renderer", OIIO),
        "dpx" | "cin" | "iff" | "zfile" => ("a picture of another format", OIIO),
        "cr2" | "cr3" | "nef" | "arw" | "dng" | "raf" | "orf" | "rw2" => {
            ("a camera's raw picture", "develop it to a 16-bit PNG or TIFF")
        }
        "sbsar" | "sbs" => ("a procedural material of Substance", "export its maps as PNG"),
        "ies" => ("a table of a lamp's directions", "describe the lamp as a luminaire instead"),
        "mp4" | "mov" | "avi" | "mkv" | "webm" => {
            ("a film", "write one of its frames to a PNG, for example with `ffmpeg -i IN -frames 1 out.png`")
        }
        _ => return None,
    })
}

/// Whether these letters, of which case does not matter, are among the bytes.
fn contains(bytes: &[u8], letters: &[u8]) -> bool {
    bytes.windows(letters.len()).any(|at| at.eq_ignore_ascii_case(letters))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_counts_before_the_ending() {
        for (name, start, part) in [
            ("a.png", &b"DDS |\0\0\0"[..], "DDS"),
            ("a.png", b"\0\0\0\x1cftypavif\0\0\0\0", "AVIF"),
            ("a.png", b"\0\0\0\x18ftypheic", "HEIC"),
            ("a.png", b"\0\0\0\x18ftypisom", "film"),
            ("a.jpg", b"\xabKTX 20\xbb", "KTX"),
            ("a.jpg", b"8BPS\0\x01", "Photoshop"),
            ("a.jpg", b"\0\0\0\x0cjP  \r\n", "JPEG 2000"),
            ("a.jpg", b"\xff\x0a\xfa", "JPEG XL"),
            ("a.jpg", b"<?xml version=\"1.0\"?>\n<svg xmlns=", "SVG"),
            ("a.jpg", b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
            ("a.jpg", b"<!DOCTYPE HTML>", "web"),
            ("a.DDS", b"", "magick"),
            ("a.tx", b"\0", "oiiotool"),
            ("a.psd", b"?", "painting"),
        ] {
            let said = named(Path::new(name), start).unwrap_or_default();
            assert!(said.contains(part) && said.contains("not read here"), "{name}: {said}");
        }
        assert_eq!(named(Path::new("a.png"), b"hello"), None);
        for (name, part) in [("a.exr", "no OpenEXR"), ("a.HDR", "no Radiance"), ("a.png", "no PNG"), ("a.bin", "PFM")] {
            assert!(unknown(Path::new(name), b"hello").is_some_and(|said| said.contains(part)), "{name}");
        }
        assert_eq!(unknown(Path::new("a.png"), b"").as_deref(), Some("it is empty"));
        assert_eq!(unknown(Path::new("a.tga"), b"hello"), None);
        assert_eq!(unknown(Path::new("a.exr"), b"GIF89a"), None);
        assert_eq!(named(Path::new("a"), b""), None);
    }
}
