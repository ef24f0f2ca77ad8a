//! Radiance pictures (.hdr, .pic): the head says by what the pixels were multiplied, which colours they are and where the first one lies.
//! The `image` crate decodes the scanlines.

use super::primaries::Primaries;
use super::source::{Source, Stream};
use glam::{DMat3, DVec2, DVec3};
use image::codecs::hdr::HdrDecoder;
use image::{ImageDecoder, ImageError};
use std::io::{BufRead, Cursor, Read};

/// Longest head that is read: programs write the history of a picture into it.
const LONGEST_HEAD: u64 = 1 << 20;

/// A file of which the head was read.
#[derive(Debug)]
pub(super) struct Radiance<'a> {
    file: Box<dyn Stream + 'a>,
    /// Its bytes, the head included.
    bytes: u64,
    /// Columns and rows of the picture.
    pub width: u32,
    /// See `width`.
    pub height: u32,
    scanlines: Scanlines,
    /// Radiance is a pixel divided by this.
    multiplied: DVec3,
    /// To linear sRGB.
    pub matrix: Option<DMat3>,
}

/// How the scanlines lie in the picture: length and number of them, and which way they and their pixels go.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scanlines {
    length: u32,
    number: u32,
    /// They are columns.
    columns: bool,
    /// The first pixel of a row is the right one.
    leftward: bool,
    /// The first pixel of a column is the lowest one.
    upward: bool,
}

/// Whether a file is such a picture, by its first bytes: after `#?` comes the name of the program or the format, for example RADIANCE or RGBE.
pub(super) fn begins(start: &[u8]) -> bool {
    start.starts_with(b"#?")
}

impl<'a> Radiance<'a> {
    /// Reads the head of a file. What it says and is not followed is a warning.
    ///
    /// # Errors
    /// In words that can follow the file's name.
    pub(super) fn open(source: impl Into<Source<'a>>, warnings: &mut Vec<String>) -> Result<Self, String> {
        let source = source.into();
        let mut file = source.open().map_err(|e| e.to_string())?;
        let bytes = source.len().map_err(|e| e.to_string())?;
        let mut left = LONGEST_HEAD;
        let mut multiplied = DVec3::ONE;
        let mut matrix = None;
        while let Some(line) = Some(next_line(&mut file, &mut left)?).filter(|line| !line.is_empty()) {
            // A comment, a command, or a picture within a picture's history, which stands behind a tab: none of these counts.
            let Some((key, value)) = line.split_once('=').filter(|_| !line.starts_with(['#', '\t', ' '])) else {
                continue;
            };
            let value = value.trim();
            let numbers: Vec<f64> = value.split_whitespace().map_while(|word| word.parse().ok()).collect();
            match key.trim() {
                "FORMAT" if value == "32-bit_rle_rgbe" => {}
                "FORMAT" if value == "32-bit_rle_xyze" => {
                    return Err(
                        "its FORMAT is 32-bit_rle_xyze, CIE XYZ: convert it, for example with `ra_xyze -r in.hdr out.hdr`"
                            .into(),
                    );
                }
                "FORMAT" => {
                    return Err(format!("its FORMAT is `{}`: only 32-bit_rle_rgbe is read", short(value)));
                }
                "EXPOSURE" => match numbers[..] {
                    [exposure, ..] if is_factor(exposure) => multiplied *= exposure,
                    _ => warnings.push(format!("its EXPOSURE `{}` is no number above 0; ignored", short(value))),
                },
                "COLORCORR" => match numbers[..] {
                    [r, g, b, ..] if [r, g, b].into_iter().all(is_factor) => multiplied *= DVec3::new(r, g, b),
                    _ => {
                        warnings.push(format!("its COLORCORR `{}` is not three numbers above 0; ignored", short(value)))
                    }
                },
                "PRIMARIES" => match numbers[..] {
                    // What one well-known program writes where it means nothing.
                    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] => {}
                    [rx, ry, gx, gy, bx, by, wx, wy] => {
                        let rgb = [DVec2::new(rx, ry), DVec2::new(gx, gy), DVec2::new(bx, by)];
                        let primaries = Primaries { rgb, white: DVec2::new(wx, wy) };
                        match primaries.to_srgb() {
                            Ok(to_srgb) => matrix = to_srgb,
                            Err(why) => warnings.push(format!("its PRIMARIES {why}; they are taken as those of sRGB")),
                        }
                    }
                    _ => warnings.push(format!("its PRIMARIES `{}` are not eight numbers; ignored", short(value))),
                },
                "GAMMA" if !matches!(numbers[..], [1.0]) => {
                    warnings.push(format!("its GAMMA `{}` is ignored: the format is linear", short(value)));
                }
                _ => {}
            }
        }
        let size = next_line(&mut file, &mut left)?;
        let scanlines = Scanlines::parse(&size)
            .ok_or_else(|| format!("its size is `{}`: expected for example -Y 512 +X 1024", short(&size)))?;
        if !multiplied.to_array().into_iter().all(is_factor) {
            return Err("its EXPOSURE and COLORCORR multiply to no number that can be divided by".into());
        }
        let Scanlines { length, number, columns, .. } = scanlines;
        let (width, height) = if columns { (number, length) } else { (length, number) };
        Ok(Radiance { file, bytes, width, height, scanlines, multiplied, matrix })
    }

    /// Whether the file is long enough for its scanlines, none of which has fewer bytes than its first pixel: a small file never asks for much
    /// memory.
    pub(super) fn is_long_enough(&self) -> bool {
        self.bytes >= 4 * u64::from(self.scanlines.number)
    }

    /// Radiance, and alpha of 1, of every pixel, rows from the top.
    ///
    /// # Errors
    /// As the decoder has it.
    pub(super) fn rgba(self) -> Result<Vec<f32>, ImageError> {
        let Radiance { file, width, height, scanlines, multiplied, .. } = self;
        let Scanlines { length, number, columns, leftward, upward } = scanlines;
        // The decoder knows no other head.
        let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {number} +X {length}\n");
        let decoder = HdrDecoder::new(Cursor::new(head).chain(file))?;
        let pixels = length as usize * number as usize;
        let mut stored = vec![[0f32; 3]; pixels];
        decoder.read_image(bytemuck::cast_slice_mut(&mut stored))?;
        let mut rgba = vec![1f32; 4 * pixels];
        let (width, height) = (width as usize, height as usize);
        for (at, pixel) in stored.into_iter().enumerate() {
            let (line, along) = (at / length as usize, at % length as usize);
            let (x, y) = if columns { (line, along) } else { (along, line) };
            let x = if leftward { width - 1 - x } else { x };
            let y = if upward { height - 1 - y } else { y };
            let radiance = if multiplied == DVec3::ONE {
                pixel
            } else {
                (DVec3::from(pixel.map(f64::from)) / multiplied).as_vec3().to_array()
            };
            rgba[4 * (y * width + x)..][..3].copy_from_slice(&radiance);
        }
        Ok(rgba)
    }
}

impl Scanlines {
    /// A line like `-Y 512 +X 1024`: first how the scanlines follow each other, then how pixels do within one. -Y is downward, +X is rightward.
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [outer, number, inner, length] = words[..] else { return None };
        let columns = match (outer.get(1..)?, inner.get(1..)?) {
            ("Y", "X") => false,
            ("X", "Y") => true,
            _ => return None,
        };
        let [x, y] = if columns { [outer, inner] } else { [inner, outer] };
        let direction = |word: &str| match word.as_bytes()[0] {
            b'+' => Some(true),
            b'-' => Some(false),
            _ => None,
        };
        let side = |word: &str| word.parse().ok().filter(|side: &u32| *side > 0);
        Some(Scanlines {
            length: side(length)?,
            number: side(number)?,
            columns,
            leftward: !direction(x)?,
            upward: direction(y)?,
        })
    }
}

/// The next line without its end, of which a head with Windows line ends has two bytes.
fn next_line(file: &mut impl BufRead, left: &mut u64) -> Result<String, String> {
    let mut line = Vec::new();
    let read = file.take(*left).read_until(b'\n', &mut line).map_err(|e| e.to_string())?;
    *left -= read as u64;
    if line.pop() != Some(b'\n') {
        return Err("it ends within its head".into());
    }
    if line.last() == Some(&b'\r') {
        line.pop();
    }
    Ok(String::from_utf8_lossy(&line).into_owned())
}

/// Whether pixels can be divided by it.
fn is_factor(number: f64) -> bool {
    number.is_finite() && number > 0.0 && number.recip().is_finite()
}

/// A part of a head for a message.
fn short(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(60).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels, width and height, warnings.
    type Read = (Vec<[f32; 3]>, (u32, u32), Vec<String>);

    fn opened(head: &str, size: &str, pixels: &[u8]) -> Result<Read, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        std::fs::write(&path, [format!("{head}\n\n{size}\n").as_bytes(), pixels].concat()).unwrap();
        let mut warnings = Vec::new();
        let file = Radiance::open(&path, &mut warnings)?;
        let size = (file.width, file.height);
        let rgba = file.rgba().map_err(|e| e.to_string())?;
        Ok((rgba.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect(), size, warnings))
    }

    /// Pixels of red 1, 2, ... (exponent 136 is a factor of 1).
    fn counted(n: u8) -> Vec<u8> {
        (1..=n).flat_map(|red| [red, 0, 0, 136]).collect()
    }

    #[test]
    fn exposure_and_colour_correction_are_divided_out() {
        for (head, expected) in [
            ("#?RADIANCE\nFORMAT=32-bit_rle_rgbe", [8.0, 16.0, 32.0]),
            ("#?RGBE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4", [2.0, 4.0, 8.0]),
            ("#?RADIANCE\nEXPOSURE= 4.0\nEXPOSURE =0.5\r\nFORMAT=32-bit_rle_rgbe", [4.0, 8.0, 16.0]),
            ("#?AUTOPANO\nCOLORCORR= 1 2 4\nCOLORCORR=1 1 2\nEXPOSURE=2", [4.0, 4.0, 2.0]),
            // Commands, comments and the history of other pictures do not count.
            ("#?RADIANCE\n#EXPOSURE=8\n\tEXPOSURE=8\npfilt -e 8\nVIEW= -vtv\nGAMMA=1\nPIXASPECT=2", [8.0, 16.0, 32.0]),
            ("#?RADIANCE\nPRIMARIES=0 0 0 0 0 0 0 0", [8.0, 16.0, 32.0]),
            ("#?RADIANCE\nPRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .329", [8.0, 16.0, 32.0]),
        ] {
            let (pixels, size, warnings) = opened(head, "-Y 1 +X 1", &[8, 16, 32, 136]).unwrap();
            assert_eq!((pixels[0], size, warnings), (expected, (1, 1), vec![]), "{head}");
        }
    }

    #[test]
    fn what_is_not_followed_is_said() {
        for (line, part) in [
            ("EXPOSURE=0", "EXPOSURE `0`"),
            ("EXPOSURE=-2", "EXPOSURE `-2`"),
            ("EXPOSURE=bright", "EXPOSURE `bright`"),
            ("COLORCORR=1 2", "COLORCORR `1 2`"),
            ("GAMMA=2.2", "GAMMA `2.2`"),
            ("PRIMARIES=1 2 3", "PRIMARIES `1 2 3`"),
            ("PRIMARIES=1 1 1 1 1 1 1 1", "PRIMARIES are no colours"),
        ] {
            let (pixels, _, warnings) = opened(&format!("#?RADIANCE\n{line}"), "-Y 1 +X 1", &[8, 0, 0, 136]).unwrap();
            assert!(pixels[0] == [8.0, 0.0, 0.0] && warnings.len() == 1 && warnings[0].contains(part), "{warnings:?}");
        }
        for (head, size, part) in [
            ("#?RADIANCE\nFORMAT=32-bit_rle_xyze", "-Y 1 +X 1", "ra_xyze"),
            ("#?RADIANCE\nFORMAT=64-bit", "-Y 1 +X 1", "`64-bit`"),
            ("#?RADIANCE\nEXPOSURE=1e300\nEXPOSURE=1e300", "-Y 1 +X 1", "EXPOSURE and COLORCORR"),
            ("#?RADIANCE", "-Y 1 +Y 1", "`-Y 1 +Y 1`"),
            ("#?RADIANCE", "-Y 0 +X 1", "`-Y 0 +X 1`"),
            ("#?RADIANCE", "Y 1 X 1", "`Y 1 X 1`"),
            ("#?RADIANCE", "\u{e9} 1 \u{e9} 1", "expected"),
            ("#?RADIANCE", "1 1", "`1 1`"),
        ] {
            let error = opened(head, size, &[8, 0, 0, 136]).unwrap_err();
            assert!(error.contains(part), "{head} {size}: {error}");
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        std::fs::write(&path, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n").unwrap();
        assert!(Radiance::open(&path, &mut Vec::new()).is_err_and(|error| error.contains("ends within its head")));
    }

    /// Two rows of three, or three columns of two, from every corner.
    #[test]
    fn every_orientation() {
        for (size, expected) in [
            ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
            ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
            ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
            ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
            ("+X 3 -Y 2", [1, 3, 5, 2, 4, 6]),
            ("+X 3 +Y 2", [2, 4, 6, 1, 3, 5]),
            ("-X 3 -Y 2", [5, 3, 1, 6, 4, 2]),
            ("-X 3 +Y 2", [6, 4, 2, 5, 3, 1]),
        ] {
            let (pixels, sides, _) = opened("#?RADIANCE", size, &counted(6)).unwrap();
            let red: Vec<u8> = pixels.iter().map(|pixel| pixel[0] as u8).collect();
            assert_eq!((&red[..], sides), (&expected[..], (3, 2)), "{size}");
        }
    }

    /// Flat pixels, runs as before 1991, and runs of each component.
    #[test]
    fn every_kind_of_scanline() {
        let red = |pixels: Vec<[f32; 3]>| pixels.iter().map(|pixel| pixel[0] as u8).collect::<Vec<_>>();
        let read = |size: &str, bytes: &[u8]| red(opened("#?RADIANCE", size, bytes).unwrap().0);
        assert_eq!(read("-Y 1 +X 9", &counted(9)), [1, 2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(read("-Y 1 +X 5", &[7, 0, 0, 136, 1, 1, 1, 3, 9, 0, 0, 136]), [7, 7, 7, 7, 9]);
        let runs = [&[2, 2, 0, 9][..], &[128 + 8, 5, 1, 6], &[128 + 9, 0], &[128 + 9, 0], &[128 + 9, 136]].concat();
        assert_eq!(read("-Y 1 +X 9", &runs), [5, 5, 5, 5, 5, 5, 5, 5, 6]);
    }

    /// The primaries that Radiance itself means by default, written out: red of a wider green.
    #[test]
    fn primaries_become_a_matrix() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hdr");
        let head = "#?RADIANCE\nPRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .329\n\n-Y 1 +X 1\n";
        std::fs::write(&path, head).unwrap();
        let matrix = Radiance::open(&path, &mut Vec::new()).unwrap().matrix.unwrap();
        assert!((matrix.x_axis - DVec3::new(1.6605, -0.1246, -0.0182)).abs().max_element() < 1e-3, "{matrix}");
    }
}
