//! Colours of vertices: numbers behind the coordinates of a `v` line, as scanners and Blender write them, and ZBrush's `#MRGB` comments.
//!
//! All of these programs write sRGB (MeshLab and CloudCompare the bytes of their pictures over 255, Blender converts), and so Blender and three.js
//! read them.

use crate::picture::linear;
use crate::scene::load::text_file::Tally;
use glam::Vec3;
use std::path::Path;

/// Above 1 only by rounding.
const ROUNDED_ONE: f32 = 1.001;

/// The colours of an OBJ file as it writes them.
#[derive(Debug, Default)]
pub(super) struct Colours {
    /// Vertex, counted from 0, and the numbers behind its coordinates: three, or four whose meaning the rest of the file tells.
    written: Vec<(u32, [f32; 4])>,
    /// How many of `written` have four numbers.
    of_four: usize,
    /// From which vertex on, and the colours of it and its followers.
    painted: Vec<(usize, Vec<[u8; 3]>)>,
    /// The `#MRGB` lines since the last vertex or face.
    block: Vec<[u8; 3]>,
    /// One past the last vertex that a block is for.
    painted_end: usize,
    bad: Tally,
}

impl Colours {
    /// The numbers on line `line` behind the coordinates of a vertex; anything that is no colour is white.
    pub(super) fn write(&mut self, vertex: usize, numbers: &[Option<f64>], line: usize) {
        let mut kept = [f32::NAN; 4];
        for (kept, number) in kept.iter_mut().zip(numbers) {
            *kept = number.map_or(f32::NAN, |number| number as f32);
        }
        if kept[..numbers.len().min(4)].iter().any(|number| !number.is_finite()) {
            self.bad.add(line);
            return;
        }
        self.of_four += usize::from(numbers.len() == 4);
        self.written.push((vertex as u32, kept));
    }

    /// A line `#MRGB MMRRGGBB...`: eight hexadecimal digits for each vertex, of which the first two are a mask.
    pub(super) fn paint(&mut self, digits: &str, line: usize) {
        let digits = digits.as_bytes();
        for entry in digits.chunks(8) {
            let number = std::str::from_utf8(entry).ok().filter(|entry| entry.len() == 8);
            match number.and_then(|entry| u32::from_str_radix(entry, 16).ok()) {
                Some(number) => {
                    let [_, r, g, b] = number.to_be_bytes();
                    self.block.push([r, g, b]);
                }
                None => self.bad.add(line),
            }
        }
    }

    /// Ends a block of `#MRGB` lines that stands behind so many vertices: it is for the last of them, or for those to come if there are not
    /// enough that have none yet.
    pub(super) fn end_block(&mut self, vertices: usize) {
        if self.block.is_empty() {
            return;
        }
        let block = std::mem::take(&mut self.block);
        let bare = vertices.saturating_sub(self.painted_end);
        let first = if bare >= block.len() { vertices - block.len() } else { self.painted_end };
        self.painted_end = first + block.len();
        self.painted.push((first, block));
    }

    /// A linear colour for each of so many vertices, white where the file has none; empty if all are white. What had to be guessed is a warning.
    pub(super) fn resolve(mut self, vertices: usize, path: &Path, warnings: &mut Vec<String>) -> Vec<Vec3> {
        self.end_block(vertices);
        self.bad.warn(path, "a vertex colour that is no colour counts as white", warnings);
        if self.written.is_empty() && self.painted.is_empty() {
            return Vec::new();
        }
        let mut colours = vec![Vec3::ONE; vertices];
        let skip = self.skipped(path, warnings);
        let colour = |numbers: &[f32; 4]| {
            let from = if numbers[3].is_nan() { 0 } else { skip };
            Vec3::new(numbers[from], numbers[from + 1], numbers[from + 2])
        };
        let scale = self.scale(colour, path, warnings);
        let mut outside = 0;
        for (vertex, numbers) in &self.written {
            let code = colour(numbers) / scale;
            outside += usize::from(code.min_element() < 0.0 || code.max_element() > ROUNDED_ONE);
            let code = code.clamp(Vec3::ZERO, Vec3::ONE);
            colours[*vertex as usize] = Vec3::from(code.to_array().map(linear));
        }
        let mut warn = |what: String| warnings.push(format!("{}: {what}", path.display()));
        if outside > 0 {
            warn(format!("{outside} vertex colour(s) outside of what a colour can be; the nearest one is used"));
        }
        let mut left_over = 0;
        for (first, block) in &self.painted {
            for (vertex, code) in (*first..).zip(block) {
                match colours.get_mut(vertex) {
                    Some(place) => *place = Vec3::from(code.map(|code| linear(f32::from(code) / 255.0))),
                    None => left_over += 1,
                }
            }
        }
        if left_over > 0 {
            warn(format!("{left_over} colour(s) of `#MRGB` lines more than there are vertices; ignored"));
        }
        if colours.iter().all(|colour| *colour == Vec3::ONE) {
            return Vec::new();
        }
        colours
    }

    /// Of four numbers, how many stand before the colour: a weight (1) or none (0), with an opacity behind it.
    fn skipped(&self, path: &Path, warnings: &mut Vec<String>) -> usize {
        if self.of_four == 0 {
            return 0;
        }
        let all = |test: &dyn Fn(&[f32; 4]) -> bool| {
            self.written.iter().filter(|(_, n)| !n[3].is_nan()).all(|(_, numbers)| test(numbers))
        };
        let weight = all(&|n| n[0] == 1.0);
        let opacity = all(&|n| n[3] == 1.0) || all(&|n| n[3] == 255.0);
        if weight == opacity {
            warnings.push(format!(
                "{}: vertices with 7 numbers may have a weight and a colour, or a colour and an opacity; taken as x y z r g b a",
                path.display()
            ));
        }
        usize::from(weight && !opacity)
    }

    /// What stands for full intensity.
    fn scale(&self, colour: impl Fn(&[f32; 4]) -> Vec3, path: &Path, warnings: &mut Vec<String>) -> f32 {
        let most = self.written.iter().map(|(_, numbers)| colour(numbers).max_element()).fold(0.0, f32::max);
        let whole = || self.written.iter().all(|(_, numbers)| colour(numbers).fract() == Vec3::ZERO);
        let scale = match most {
            ..=ROUNDED_ONE => return 1.0,
            ..=2.0 if !whole() => return 1.0,
            ..=255.0 => 255.0,
            ..=65535.0 => 65535.0,
            _ => return 1.0,
        };
        warnings.push(format!(
            "{}: vertex colours reach {most}; they are taken as numbers from 0 to {scale}: if 1 was to be full intensity, divide them so that none is larger",
            path.display()
        ));
        scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(lines: &[&[f64]]) -> (Vec<Vec3>, Vec<String>) {
        let mut colours = Colours::default();
        for (vertex, numbers) in lines.iter().enumerate() {
            let numbers: Vec<_> = numbers.iter().copied().map(Some).collect();
            colours.write(vertex, &numbers, vertex + 1);
        }
        let mut warnings = Vec::new();
        (colours.resolve(lines.len(), Path::new("a.obj"), &mut warnings), warnings)
    }

    #[test]
    fn the_scale_is_told_by_the_whole_file() {
        let (colours, warnings) = resolved(&[&[1.0, 0.0, 0.5], &[0.0, 1.0, 1.0]]);
        assert!((colours[0] - Vec3::new(1.0, 0.0, 0.214_041)).abs().max_element() < 1e-5, "{colours:?}");
        assert!(warnings.is_empty(), "{warnings:?}");
        let (colours, warnings) = resolved(&[&[255.0, 0.0, 10.0], &[1.0, 2.0, 3.0]]);
        assert!((colours[0].z - 0.003_035_27).abs() < 1e-7 && colours[0].x == 1.0, "{colours:?}");
        assert!(warnings[0].contains("0 to 255"), "{warnings:?}");
        assert!(resolved(&[&[1.0, 1.0, 1.0]]).0.is_empty(), "all white is nothing");
        // Whatever is guessed of numbers above 1 is said.
        for (most, guess) in [
            (2.0, "from 0 to 255"),
            (3.5, "from 0 to 255"),
            (300.0, "from 0 to 65535"),
            (1.5, "outside"),
            (1e6, "outside"),
        ] {
            let warnings = resolved(&[&[most, 0.0, 1.0]]).1;
            assert!(warnings.len() == 1 && warnings[0].contains(guess), "{most}: {warnings:?}");
        }
        let (colours, warnings) = resolved(&[&[1.5, 0.25, -1.0]]);
        assert!(colours[0].x == 1.0 && colours[0].z == 0.0 && warnings[0].contains("1 vertex colour"), "{warnings:?}");
    }

    #[test]
    fn four_numbers_are_a_weight_or_an_opacity() {
        let weight = resolved(&[&[1.0, 1.0, 0.0, 0.0], &[1.0, 0.0, 1.0, 1.0]]);
        assert_eq!(weight.0, [Vec3::X, Vec3::Y + Vec3::Z]);
        let opacity = resolved(&[&[0.0, 1.0, 0.0, 1.0], &[1.0, 0.0, 1.0, 1.0]]);
        assert_eq!((opacity.0, opacity.1.len()), (vec![Vec3::Y, Vec3::X + Vec3::Z], 0));
        let either = resolved(&[&[1.0, 0.0, 0.0, 1.0]]);
        assert_eq!((either.0, either.1.len()), (vec![Vec3::X], 1));
    }

    #[test]
    fn painted_blocks_may_stand_before_or_behind_their_vertices() {
        for before in [false, true] {
            let mut colours = Colours::default();
            let mut vertices = 0;
            for block in ["ffff000000ff0000", "ff00ff00"] {
                if before {
                    colours.paint(block, 1);
                    colours.end_block(vertices);
                }
                vertices += block.len() / 8;
                if !before {
                    colours.paint(block, 1);
                    colours.end_block(vertices);
                }
            }
            let found = colours.resolve(3, Path::new("a.obj"), &mut Vec::new());
            assert_eq!(found, [Vec3::X, Vec3::X, Vec3::Y], "before: {before}");
        }
    }
}
