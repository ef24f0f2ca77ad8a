//! The text of an OBJ file, line by line.
//!
//! Read here and not by a crate: `tobj` stops a whole file without naming the line, takes `l` lines for faces, leaves out what a
//! corner lacks so that the normals of a mesh no longer belong to its vertices, and wants every vertex coloured if one is.

use super::colours::Colours;
use super::contents::Contents;
use super::faces::Faces;
use super::positions::Positions;
use crate::scene::load::polygon::{Fault, MOST_CORNERS};
use crate::scene::load::text_file::{Tally, logical_lines, parse_number, shortened};
use crate::{Error, Result};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::path::Path;

/// What an OBJ file says.
#[derive(Debug, Default)]
pub(super) struct ObjText {
    /// `v` lines.
    pub positions: Positions,
    /// Colours of vertices.
    pub colours: Colours,
    /// `vt` lines: the first two numbers, 0 for what is not there or not finite.
    pub uvs: Vec<Vec2>,
    /// `vn` lines, of any length; zero for what is not finite.
    pub normals: Vec<Vec3>,
    /// `f` lines; a material is 0 for none, else 1 + an index into `materials`.
    pub faces: Faces,
    /// Materials, numbered as in `faces`, of faces that lack a texture coordinate, with the line of the first.
    pub without_uv: Vec<(usize, usize)>,
    /// Material names in the order of their first use, with the line of it.
    pub materials: Vec<(String, usize)>,
    /// What follows `mtllib`, with its line.
    pub libraries: Vec<(String, usize)>,
    /// There is an `s` line.
    pub says_smoothing: bool,
    /// What is worth a warning.
    pub faults: Faults,
    /// What else the file has.
    pub contents: Contents,
}

/// What is wrong with an OBJ file and does not keep it from being loaded.
#[derive(Debug, Default)]
pub(super) struct Faults {
    short_faces: Tally,
    tangled: Tally,
    not_flat: Tally,
    too_large: Tally,
    /// Indices into what the file has none of; in the order of [`KINDS`].
    dangling: [Tally; 3],
    bad_normals: Tally,
    bad_uvs: Tally,
    bad_groups: Tally,
}

impl Faults {
    /// Counts a polygon on line `line` that cannot be cut as it should be.
    pub(super) fn polygon(&mut self, fault: Fault, line: usize) {
        match fault {
            Fault::Tangled => self.tangled.add(line),
            Fault::NotFlat => self.not_flat.add(line),
            Fault::TooLarge => self.too_large.add(line),
        }
    }

    /// One warning for each kind that was met.
    pub(super) fn warn(&self, path: &Path, warnings: &mut Vec<String>) {
        let too_large =
            format!("a polygon of more than {MOST_CORNERS} corners that is not convex; it is cut as if it were");
        for (tally, what) in [
            (&self.short_faces, "a face with fewer than 3 corners is skipped"),
            (&self.tangled, "a polygon whose outline crosses or covers itself; its triangles are a guess"),
            (&self.not_flat, "a polygon whose corners do not lie in a plane; its triangles are a guess"),
            (&self.too_large, &too_large),
            (&self.dangling[1], "a texture coordinate index, but the file has none; ignored"),
            (&self.dangling[2], "a normal index, but the file has no normals; ignored"),
            (&self.bad_normals, "a normal that is not finite is ignored"),
            (&self.bad_uvs, "a texture coordinate that is not finite counts as 0"),
            (&self.bad_groups, "a smoothing group that is no number counts as off"),
        ] {
            tally.warn(path, what, warnings);
        }
    }
}

/// What an index can point to, in the order of `v/vt/vn`.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Reads the text of an OBJ file.
///
/// # Errors
/// [`Error::Parse`] for the first line that holds a bad number, a vertex that is not finite, or a bad index.
pub(super) fn read(path: &Path, text: &str) -> Result<ObjText> {
    let mut scan = Scan {
        path,
        text,
        totals: None,
        material: 0,
        smoothing_group: 0,
        by_name: HashMap::new(),
        without_uv: vec![false],
        out: ObjText::default(),
    };
    for (number, line) in logical_lines(text) {
        scan.line(number, &line)?;
    }
    let ObjText { positions, faces, .. } = &mut scan.out;
    positions.settle(faces.corners.iter().map(|[vertex, ..]| *vertex as usize - 1));
    Ok(scan.out)
}

struct Scan<'a> {
    path: &'a Path,
    text: &'a str,
    /// How many of each of [`KINDS`] the whole file has, once something has asked.
    totals: Option<[usize; 3]>,
    /// 0 for none, else 1 + an index into `out.materials`.
    material: usize,
    smoothing_group: u32,
    by_name: HashMap<String, usize>,
    /// For each material, whether `out.without_uv` has it.
    without_uv: Vec<bool>,
    out: ObjText,
}

impl Scan<'_> {
    fn error<T>(&self, line: usize, message: String) -> Result<T> {
        Err(Error::Parse { path: self.path.to_owned(), line, column: 0, message })
    }

    fn line(&mut self, number: usize, line: &str) -> Result<()> {
        let Some(keyword) = line.split_ascii_whitespace().next() else { return Ok(()) };
        let rest = line[keyword.len()..].trim();
        let words = rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#'));
        match keyword {
            "v" => self.vertex(number, words)?,
            "vt" => self.texture_coordinate(number, words)?,
            "vn" => self.normal(number, words)?,
            // The older of the two words for a face.
            "f" | "fo" => self.face(number, words)?,
            "usemtl" => self.material(number, rest),
            "mtllib" => self.out.libraries.push((rest.to_owned(), number)),
            "s" => self.smoothing(number, rest),
            "o" | "g" => {}
            "#MRGB" => self.out.colours.paint(rest, number),
            comment if comment.starts_with('#') => {}
            other => self.out.contents.add(other, number),
        }
        Ok(())
    }

    fn number(&self, line: usize, word: &str) -> Result<f64> {
        match parse_number(word) {
            Some(number) => Ok(number),
            None => self.error(line, format!("`{}` is not a number", shortened(word))),
        }
    }

    fn vertex<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut kept = [""; 8];
        let mut count = 0;
        for word in words {
            if let Some(slot) = kept.get_mut(count) {
                *slot = word;
            }
            count += 1;
        }
        // How many numbers are the place, and where among the others a colour is. Whether the fourth of seven is a weight the whole file tells.
        let (used, colour) = match count {
            3 | 4 => (count, 0..0),
            6 => (3, 3..6),
            7 => (3, 3..7),
            8 => (4, 4..7),
            9.. => (3, 3..6),
            _ => {
                return self.error(
                    line,
                    format!("a vertex needs 3 numbers (4 with a weight, 6 with a colour), found {count}"),
                );
            }
        };
        let mut numbers = [1.0; 4];
        for (number, word) in numbers.iter_mut().zip(&kept[..used]) {
            *number = self.number(line, word)?;
        }
        let [x, y, z, w] = numbers;
        let position = DVec3::new(x / w, y / w, z / w);
        if !position.as_vec3().is_finite() {
            return self.error(line, format!("the vertex {} is not finite", shortened(&kept[..used].join(" "))));
        }
        let vertex = self.out.positions.len();
        self.out.colours.end_block(vertex);
        if !colour.is_empty() {
            let mut numbers = [None; 4];
            let words = &kept[colour];
            for (number, word) in numbers.iter_mut().zip(words) {
                *number = parse_number(word);
            }
            self.out.colours.write(vertex, &numbers[..words.len()], line);
        }
        self.out.positions.exact.push(position);
        Ok(())
    }

    fn texture_coordinate<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut uv = [0.0; 2];
        let mut count = 0;
        for word in words {
            let number = self.number(line, word)?;
            if let Some(slot) = uv.get_mut(count) {
                *slot = number as f32;
            }
            count += 1;
        }
        if count == 0 {
            return self.error(line, "a texture coordinate needs 1 to 3 numbers, found none".into());
        }
        if !uv.iter().all(|n| n.is_finite()) {
            self.out.faults.bad_uvs.add(line);
            uv = [0.0; 2];
        }
        self.out.uvs.push(Vec2::from(uv));
        Ok(())
    }

    fn normal<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut numbers = [0.0; 3];
        let mut count = 0;
        for word in words {
            let number = self.number(line, word)?;
            if let Some(slot) = numbers.get_mut(count) {
                *slot = number as f32;
            }
            count += 1;
        }
        if count < 3 {
            return self.error(line, format!("a normal needs 3 numbers, found {count}"));
        }
        if !numbers.iter().all(|n| n.is_finite()) {
            self.out.faults.bad_normals.add(line);
            numbers = [0.0; 3];
        }
        self.out.normals.push(Vec3::from(numbers));
        Ok(())
    }

    fn smoothing(&mut self, line: usize, rest: &str) {
        self.out.says_smoothing = true;
        let word = rest.split_ascii_whitespace().next().unwrap_or("off");
        self.smoothing_group = match word.to_ascii_lowercase().as_str() {
            "off" => 0,
            "on" => 1,
            number => number.parse().unwrap_or_else(|_| {
                self.out.faults.bad_groups.add(line);
                0
            }),
        };
    }

    fn material(&mut self, line: usize, name: &str) {
        let next = self.out.materials.len();
        let index = *self.by_name.entry(name.to_owned()).or_insert(next);
        if index == next {
            self.out.materials.push((name.to_owned(), line));
            self.without_uv.push(false);
        }
        self.material = index + 1;
    }

    fn face<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let first = self.out.faces.corners.len();
        self.out.colours.end_block(self.out.positions.len());
        for word in words {
            let mut indices = [0; 3];
            let mut parts = word.split('/');
            for (kind, index) in indices.iter_mut().enumerate() {
                match parts.next() {
                    None => break,
                    Some("") if kind > 0 => {}
                    Some(part) => *index = self.index(line, word, kind, part)?,
                }
            }
            if parts.next().is_some() {
                return self
                    .error(line, format!("`{}` is not a corner; expected v, v/vt, v//vn or v/vt/vn", shortened(word)));
            }
            self.out.faces.corners.push(indices);
        }
        if self.out.faces.corners.len() < first + 3 {
            self.out.faces.corners.truncate(first);
            self.out.faults.short_faces.add(line);
            return Ok(());
        }
        let lacks_uv = self.out.faces.corners[first..].iter().any(|[_, uv, _]| *uv == 0);
        if lacks_uv && !std::mem::replace(&mut self.without_uv[self.material], true) {
            self.out.without_uv.push((self.material, line));
        }
        self.out.faces.end_face(self.material as u32, self.smoothing_group, line);
        Ok(())
    }

    /// The absolute index, from 1, that `part` of the corner `word` stands for; 0 where the file has nothing of that kind.
    fn index(&mut self, line: usize, word: &str, kind: usize, part: &str) -> Result<u32> {
        let name = KINDS[kind];
        let shown = || shortened(word);
        let Ok(index) = part.parse::<i64>() else {
            let (shown, part) = (shown(), shortened(part));
            return self
                .error(line, format!("`{shown}`: the {name} index `{part}` is not a whole number within 64 bits"));
        };
        if index == 0 {
            return self.error(line, format!("`{}`: the {name} index is 0, but OBJ files count from 1", shown()));
        }
        let count = [self.out.positions.len(), self.out.uvs.len(), self.out.normals.len()][kind];
        let absolute = if index < 0 { count as i64 + 1 + index } else { index };
        // Only what does not point back makes it matter how much of its kind is still to come.
        if absolute < 1 || absolute > count as i64 {
            let total = self.totals.get_or_insert_with(|| totals(self.text))[kind];
            if kind > 0 && total == 0 {
                self.out.faults.dangling[kind].add(line);
                return Ok(0);
            }
            let why = match absolute {
                ..1 => format!("the relative {name} index {index} is out of range, {count} {name} lines precede it"),
                _ if absolute > total as i64 => {
                    format!("the {name} index {index} is out of range, the file has {total} {name} lines")
                }
                _ => return Ok(absolute as u32),
            };
            return self.error(line, format!("`{}`: {why}", shown()));
        }
        Ok(absolute as u32)
    }
}

/// How many of each of [`KINDS`] a file has.
fn totals(text: &str) -> [usize; 3] {
    let mut totals = [0; 3];
    for (_, line) in logical_lines(text) {
        match line.split_ascii_whitespace().next() {
            Some("v") => totals[0] += 1,
            Some("vt") => totals[1] += 1,
            Some("vn") => totals[2] += 1,
            _ => {}
        }
    }
    totals
}
