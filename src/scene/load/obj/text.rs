//! The text of an OBJ file, checked line by line and rewritten to what `tobj` reads without a quirk.
//!
//! `tobj` stops a whole file without naming the line, mixes up the normals of a mesh in which only some corners have one,
//! takes `l` lines for faces, and wants every vertex coloured if one is. So each line is checked here first, and `tobj` receives
//! plain `v`, `vt`, `vn`, `usemtl` and `f` lines with absolute, valid indices.

use super::faces::{Faces, Faults};
use super::polygon::MOST_CORNERS;
use crate::scene::load::text::{Tally, shortened};
use crate::{Error, Result};
use glam::Vec3;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt::Write;
use std::path::Path;

/// What an OBJ file says, without its errors.
#[derive(Debug, Default)]
pub(super) struct ObjText {
    /// `v`, `vt` and `vn` lines.
    pub vertices: String,
    /// `f` and `usemtl` lines; `usemtl` carries an index into `materials`.
    pub faces: String,
    /// Materials (0 for none, else 1 + an index into `materials`) of faces that lack a texture coordinate, with the line of the
    /// first.
    pub without_uv: Vec<(usize, usize)>,
    /// Material names in the order of their first use, with the line of it.
    pub materials: Vec<(String, usize)>,
    /// What follows `mtllib`, with its line.
    pub libraries: Vec<(String, usize)>,
    /// What was skipped.
    pub warnings: Vec<String>,
}

/// What an index can point to, in the order of `v/vt/vn`.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Checks and rewrites an OBJ file. `smooth` (degrees) replaces smoothing groups where no face has normals.
///
/// # Errors
/// [`Error::Parse`] for the first line that holds a bad number, a vertex that is not finite, or a bad index.
pub(super) fn normalise(path: &Path, text: &str, smooth: Option<f32>) -> Result<ObjText> {
    let mut totals = [0; 3];
    for (_, line) in logical_lines(text) {
        if let Some(kind) = line.split_ascii_whitespace().next().and_then(element_kind) {
            totals[kind] += 1;
        }
    }
    let mut scan = Scan::new(path, totals);
    for (number, line) in logical_lines(text) {
        scan.line(number, &line)?;
    }
    Ok(scan.finish(smooth))
}

/// Lines with their number, where a backslash at the end joins the next one.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (line, number) = lines.next()?;
        let line = line.trim();
        let Some(head) = line.strip_suffix('\\').filter(|head| !head.starts_with('#')) else {
            return Some((number, Cow::Borrowed(line)));
        };
        let mut joined = head.to_owned();
        for (line, _) in lines.by_ref() {
            joined.push(' ');
            match line.trim().strip_suffix('\\') {
                Some(head) => joined.push_str(head),
                None => {
                    joined.push_str(line.trim());
                    break;
                }
            }
        }
        // A line of nothing but a backslash leaves a blank in front.
        Some((number, Cow::Owned(joined.trim().to_owned())))
    })
}

/// Index into [`KINDS`] of a keyword that defines something.
fn element_kind(keyword: &str) -> Option<usize> {
    match keyword {
        "v" => Some(0),
        "vt" => Some(1),
        "vn" => Some(2),
        _ => None,
    }
}

struct Scan<'a> {
    path: &'a Path,
    /// How many of each of [`KINDS`] the file has.
    totals: [usize; 3],
    /// How many precede the current line.
    counts: [usize; 3],
    /// Positions, for normals that are made from the faces.
    positions: Vec<Vec3>,
    faces: Faces,
    /// 0 for none, else 1 + an index into `out.materials`.
    material: usize,
    smoothing_group: u32,
    by_name: HashMap<String, usize>,
    /// The materials of `out.without_uv`.
    without_uv: HashSet<usize>,
    out: ObjText,
    short_faces: Tally,
    unknown: Tally,
    unknown_keyword: String,
    dangling: [Tally; 3],
    bad_normals: Tally,
    bad_uvs: Tally,
    bad_groups: Tally,
}

impl<'a> Scan<'a> {
    fn new(path: &'a Path, totals: [usize; 3]) -> Self {
        Scan {
            path,
            totals,
            counts: [0; 3],
            positions: Vec::new(),
            faces: Faces::default(),
            material: 0,
            smoothing_group: 0,
            by_name: HashMap::new(),
            without_uv: HashSet::new(),
            out: ObjText::default(),
            short_faces: Tally::default(),
            unknown: Tally::default(),
            unknown_keyword: String::new(),
            dangling: Default::default(),
            bad_normals: Tally::default(),
            bad_uvs: Tally::default(),
            bad_groups: Tally::default(),
        }
    }

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
            "f" => self.face(number, words)?,
            "usemtl" => self.material(number, rest),
            "mtllib" => self.out.libraries.push((rest.to_owned(), number)),
            "s" => self.smoothing(number, rest),
            "o" | "g" | "l" | "p" => {}
            comment if comment.starts_with('#') => {}
            other => {
                if self.unknown_keyword.is_empty() {
                    self.unknown_keyword = shortened(other).into_owned();
                }
                self.unknown.add(number);
            }
        }
        if let Some(kind) = element_kind(keyword) {
            self.counts[kind] += 1;
        }
        Ok(())
    }

    fn number(&self, line: usize, word: &str) -> Result<f32> {
        match word.parse() {
            Ok(number) => Ok(number),
            Err(_) => self.error(line, format!("`{}` is not a number", shortened(word))),
        }
    }

    fn vertex<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut kept = [""; 4];
        let mut count = 0;
        for word in words {
            if let Some(slot) = kept.get_mut(count) {
                *slot = word;
            }
            count += 1;
        }
        // Beyond four numbers they are a vertex colour, which no material uses.
        let used = match count {
            3 | 4 => count,
            6.. => 3,
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
        let position = Vec3::new(x / w, y / w, z / w);
        if !position.is_finite() {
            return self.error(line, format!("the vertex {} is not finite", shortened(&kept[..used].join(" "))));
        }
        self.positions.push(position);
        self.out.vertices.push_str("v ");
        for word in &kept[..used] {
            self.out.vertices.push_str(word);
            self.out.vertices.push(' ');
        }
        self.out.vertices.push('\n');
        Ok(())
    }

    fn texture_coordinate<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut uv = [0.0; 2];
        let mut count = 0;
        for word in words {
            let number = self.number(line, word)?;
            if let Some(slot) = uv.get_mut(count) {
                *slot = number;
            }
            count += 1;
        }
        if count == 0 {
            return self.error(line, "a texture coordinate needs 1 to 3 numbers, found none".into());
        }
        if !uv.iter().all(|n| n.is_finite()) {
            self.bad_uvs.add(line);
            uv = [0.0; 2];
        }
        writeln!(self.out.vertices, "vt {} {}", uv[0], uv[1]).expect("writing to a string");
        Ok(())
    }

    fn normal<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let mut numbers = [0.0; 3];
        let mut count = 0;
        for word in words {
            let number = self.number(line, word)?;
            if let Some(slot) = numbers.get_mut(count) {
                *slot = number;
            }
            count += 1;
        }
        if count < 3 {
            return self.error(line, format!("a normal needs 3 numbers, found {count}"));
        }
        if !numbers.iter().all(|n| n.is_finite()) {
            self.bad_normals.add(line);
            numbers = [0.0; 3];
        }
        let [x, y, z] = numbers;
        writeln!(self.out.vertices, "vn {x} {y} {z}").expect("writing to a string");
        Ok(())
    }

    fn smoothing(&mut self, line: usize, rest: &str) {
        let word = rest.split_ascii_whitespace().next().unwrap_or("off");
        self.smoothing_group = match word.to_ascii_lowercase().as_str() {
            "off" => 0,
            "on" => 1,
            number => number.parse().unwrap_or_else(|_| {
                self.bad_groups.add(line);
                0
            }),
        };
    }

    fn material(&mut self, line: usize, name: &str) {
        let next = self.out.materials.len();
        let index = *self.by_name.entry(name.to_owned()).or_insert(next);
        if index == next {
            self.out.materials.push((name.to_owned(), line));
        }
        self.material = index + 1;
    }

    fn face<'w>(&mut self, line: usize, words: impl Iterator<Item = &'w str>) -> Result<()> {
        let first = self.faces.corners.len();
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
            self.faces.corners.push(indices.map(|index| index as u32));
        }
        if self.faces.corners.len() < first + 3 {
            self.faces.corners.truncate(first);
            self.short_faces.add(line);
            return Ok(());
        }
        let lacks_uv = self.faces.corners[first..].iter().any(|[_, uv, _]| *uv == 0);
        if lacks_uv && self.without_uv.insert(self.material) {
            self.out.without_uv.push((self.material, line));
        }
        self.faces.end_face(self.material as u32, self.smoothing_group, line);
        Ok(())
    }

    /// The absolute index, from 1, that `part` of the corner `word` stands for; 0 where the file has nothing of that kind.
    fn index(&mut self, line: usize, word: &str, kind: usize, part: &str) -> Result<usize> {
        let name = KINDS[kind];
        let (total, count) = (self.totals[kind], self.counts[kind]);
        let shown = shortened(word);
        let Ok(index) = part.parse::<i64>() else {
            let part = shortened(part);
            return self
                .error(line, format!("`{shown}`: the {name} index `{part}` is not a whole number within 64 bits"));
        };
        if index == 0 {
            return self.error(line, format!("`{shown}`: the {name} index is 0, but OBJ files count from 1"));
        }
        if kind > 0 && total == 0 {
            self.dangling[kind].add(line);
            return Ok(0);
        }
        let absolute = if index < 0 { count as i64 + 1 + index } else { index };
        if absolute < 1 {
            return self.error(
                line,
                format!(
                    "`{shown}`: the relative {name} index {index} is out of range, {count} {name} lines precede it"
                ),
            );
        }
        if absolute > total as i64 {
            return self.error(
                line,
                format!("`{shown}`: the {name} index {index} is out of range, the file has {total} {name} lines"),
            );
        }
        Ok(absolute as usize)
    }

    fn finish(mut self, smooth: Option<f32>) -> ObjText {
        // What corners without a texture coordinate or a normal refer to, in a file that has some.
        if self.totals[1] > 0 {
            self.out.vertices.push_str("vt 0 0\n");
        }
        let has_normals = self.faces.corners.iter().any(|[_, _, normal]| *normal > 0);
        let made = match smooth {
            Some(degrees) if !has_normals => self.faces.normals_by_angle(&self.positions, degrees),
            _ => self.faces.normals_by_group(&self.positions),
        };
        let mut faults = Faults::default();
        self.out.faces = self.faces.text(&self.positions, self.totals, &made, &mut self.out.vertices, &mut faults);
        let warnings = &mut self.out.warnings;
        if smooth.is_some() && has_normals {
            let path = self.path.display();
            warnings.push(format!("{path}: `smooth` is ignored: the file has vertex normals of its own (vn)"));
        }
        self.short_faces.warn(self.path, "a face with fewer than 3 corners is skipped", warnings);
        let Faults { tangled, not_flat, too_large } = faults;
        tangled.warn(
            self.path,
            "a polygon whose outline crosses or covers itself; its triangles are a guess",
            warnings,
        );
        not_flat.warn(self.path, "a polygon whose corners do not lie in a plane; its triangles are a guess", warnings);
        let too_large_what =
            format!("a polygon of more than {MOST_CORNERS} corners that is not convex; it is cut as if it were");
        too_large.warn(self.path, &too_large_what, warnings);
        let unknown = format!("a line with the keyword `{}`, which is not modelled, is skipped", self.unknown_keyword);
        self.unknown.warn(self.path, &unknown, warnings);
        self.dangling[1].warn(self.path, "a texture coordinate index, but the file has none; ignored", warnings);
        self.dangling[2].warn(self.path, "a normal index, but the file has no normals; ignored", warnings);
        self.bad_normals.warn(self.path, "a normal that is not finite is ignored", warnings);
        self.bad_uvs.warn(self.path, "a texture coordinate that is not finite counts as 0", warnings);
        self.bad_groups.warn(self.path, "a smoothing group that is no number counts as off", warnings);
        self.out
    }
}
