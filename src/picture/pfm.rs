//! PFM, the portable float map: a line each for kind, size and scale, then 32-bit floats, rows from the bottom.

use super::pixels::{MOST_PIXELS, Picture, too_large};
use std::io::Read;
use std::path::Path;

/// Longest head that is looked at; real ones have about 20 bytes.
const LONGEST_HEAD: u64 = 1024;

/// Reads a file: `PF` is RGB, `Pf` grey; a negative scale says little-endian. What follows the last pixel is ignored.
///
/// # Errors
/// In words that can follow the file's name.
pub(super) fn open(path: &Path) -> Result<Picture, String> {
    let file = std::fs::File::open(path).map_err(|e| e.to_string())?;
    let length = file.metadata().map_err(|e| e.to_string())?.len();
    let mut file = std::io::BufReader::new(file);
    let mut read = 0;
    let mut word = || -> Result<String, String> {
        let mut word = String::new();
        loop {
            let mut byte = [0];
            file.read_exact(&mut byte).map_err(|_| "it ends within its head")?;
            read += 1;
            match byte[0] {
                // One white space ends a word; the pixels may begin with what looks like another.
                b if b.is_ascii_whitespace() && !word.is_empty() => return Ok(word),
                b if b.is_ascii_whitespace() => {}
                b if b.is_ascii_graphic() && read < LONGEST_HEAD => word.push(char::from(b)),
                _ => return Err("its head is not that of a PFM file: PF or Pf, width, height, scale".into()),
            }
        }
    };
    let channels = if word()? == "PF" { 3 } else { 1 };
    let mut side = || -> Result<u64, String> {
        let word = word()?;
        word.parse()
            .ok()
            .filter(|side| *side > 0)
            .ok_or_else(|| format!("`{word}` is no size: expected a whole number above 0"))
    };
    let (width, height) = (side()?, side()?);
    let scale = word()?;
    let little = match scale.parse::<f32>() {
        Ok(-1.0) => true,
        Ok(1.0) => false,
        _ => {
            return Err(format!(
                "its scale is `{scale}`: expected 1 (big-endian) or -1 (little-endian); programs disagree on what others mean"
            ));
        }
    };
    let pixels =
        width.checked_mul(height).filter(|pixels| *pixels <= MOST_PIXELS).ok_or_else(|| too_large(width, height))?;
    let (needed, there) = (pixels * channels * 4, length.saturating_sub(read));
    if there < needed {
        return Err(format!("it is truncated: {width} x {height} pixels take {needed} bytes, and {there} are there"));
    }
    let mut bytes = vec![0; needed as usize];
    file.read_exact(&mut bytes).map_err(|e| e.to_string())?;
    let value = |at: &[u8]| {
        let bytes = [at[0], at[1], at[2], at[3]];
        if little { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) }
    };
    let row = (width * channels * 4) as usize;
    let rgb = bytes
        .chunks_exact(row)
        .rev()
        .flat_map(|row| row.chunks_exact(channels as usize * 4))
        .map(
            |pixel| {
                if channels == 3 { [value(pixel), value(&pixel[4..]), value(&pixel[8..])] } else { [value(pixel); 3] }
            },
        )
        .collect();
    Ok(Picture { width: width as u32, height: height as u32, rgb, error: None, clamped: false, warnings: vec![] })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(head: &str, pixels: &[u8]) -> Result<Picture, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        std::fs::write(&path, [head.as_bytes(), pixels].concat()).unwrap();
        open(&path)
    }

    #[test]
    fn colour_and_grey_in_both_orders_of_bytes() {
        let values: Vec<f32> = (0..12).map(|v| v as f32 * 0.1 - 0.3).collect();
        let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        let pixel = |i: usize| [values[i], values[i + 1], values[i + 2]];
        for picture in [opened("PF\n2 2\n-1.0\n", &little), opened("PF 2\t2\r1 ", &[&big[..], b"rest"].concat())] {
            let picture = picture.unwrap();
            assert_eq!((picture.width, picture.height), (2, 2));
            // The lower row comes first.
            assert_eq!(picture.rgb, [pixel(6), pixel(9), pixel(0), pixel(3)]);
        }
        let grey = opened("Pf\n3 4\n-1\n", &little).unwrap();
        assert_eq!((grey.width, grey.height, grey.rgb[0], grey.rgb[11]), (3, 4, [values[9]; 3], [values[2]; 3]));
        // A pixel that begins like white space.
        assert_eq!(opened("Pf\n1 1\n-1\n", b"\n\n\n\n").unwrap().rgb[0], [f32::from_le_bytes([10; 4]); 3]);
    }

    #[test]
    fn what_is_odd_is_an_error() {
        for (head, part) in [
            ("PF\n", "ends within its head"),
            ("PF\n2 2\n-1.0", "ends within its head"),
            ("PF\n0 2\n-1\n", "`0` is no size"),
            ("PF\n-2 2\n-1\n", "`-2` is no size"),
            ("PF\n2 x\n-1\n", "`x` is no size"),
            ("PF\n2 2\n0\n", "scale is `0`"),
            ("PF\n2 2\n-0.5\n", "scale is `-0.5`"),
            ("PF\n2 2\nnan\n", "scale is `nan`"),
            ("PF\n2 2\n-1\n1234", "48 bytes, and 4 are there"),
            ("PF\n16384 16384\n-1\n1234", "truncated"),
            ("PF\n16385 16384\n-1\n1234", "at most 268435456"),
            ("PF\n4294967296 4294967296\n-1\n1234", "at most 268435456"),
            ("PF\n2\u{1} 2\n-1\n", "not that of a PFM"),
        ] {
            let error = opened(head, b"").unwrap_err();
            assert!(error.contains(part), "{head:?}: {error}");
        }
        assert!(opened(&format!("PF\n{} 2\n-1\n", "1".repeat(2000)), b"").unwrap_err().contains("not that of a PFM"));
    }
}
