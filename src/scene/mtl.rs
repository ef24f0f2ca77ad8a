//! Materials from an MTL file.
//!
//! Read here and not by `tobj`, which gives up a whole file at the first bad number: the geometry is worth more than that, so
//! whatever is wrong in an MTL file is a warning with its line.

use super::material::Draft;
use super::text::{Tally, read_text};
use crate::Result;
use glam::Vec3;
use std::path::Path;

/// Reads an MTL file. What `Ka Kd Ks Ns Ke illum` say is modelled; `Ks` only for `illum` 2 and above (0 and 1 have no
/// highlight) or without `illum`.
///
/// # Errors
/// Only if the file cannot be read at all.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Vec<Draft>> {
    let text = read_text(path)?;
    let mut reader = Reader {
        path,
        warnings,
        line: 0,
        current: None,
        drafts: Vec::new(),
        orphans: Tally::default(),
        unknown: Tally::default(),
        unknown_keyword: String::new(),
    };
    for (line, number) in text.lines().zip(1..) {
        reader.line = number;
        reader.statement(line.trim());
    }
    reader.close();
    reader.orphans.warn(path, "a statement before the first newmtl is ignored", reader.warnings);
    let unknown = format!("a statement with the unknown keyword `{}` is ignored", reader.unknown_keyword);
    reader.unknown.warn(path, &unknown, reader.warnings);
    Ok(reader.drafts)
}

/// The material between two `newmtl`.
#[derive(Default)]
struct Current {
    draft: Draft,
    illum: Option<u32>,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    /// Keywords of features that nothing models.
    ignored: Vec<String>,
}

struct Reader<'a> {
    path: &'a Path,
    warnings: &'a mut Vec<String>,
    line: usize,
    current: Option<Current>,
    drafts: Vec<Draft>,
    orphans: Tally,
    unknown: Tally,
    unknown_keyword: String,
}

impl Reader<'_> {
    fn warn(&mut self, message: &str) {
        self.warnings.push(format!("{}:{}: {message}", self.path.display(), self.line));
    }

    fn statement(&mut self, line: &str) {
        let Some(keyword) = line.split_ascii_whitespace().next().filter(|keyword| !keyword.starts_with('#')) else {
            return;
        };
        let rest = line[keyword.len()..].trim();
        let words: Vec<&str> = rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#')).collect();
        if keyword == "newmtl" {
            self.close();
            if rest.is_empty() {
                self.warn("newmtl without a name; it is taken as the material with the empty name");
            }
            self.current = Some(Current { draft: Draft::named(rest), ..Current::default() });
            return;
        }
        let Some(mut current) = self.current.take() else {
            self.orphans.add(self.line);
            return;
        };
        let draft = &mut current.draft;
        match keyword {
            "Ka" => draft.ambient = self.colour(keyword, &words).or(draft.ambient),
            "Kd" => draft.diffuse = self.colour(keyword, &words).or(draft.diffuse),
            "Ks" => draft.glossy = self.colour(keyword, &words).or(draft.glossy),
            "Ke" => draft.emission = self.colour(keyword, &words).or(draft.emission),
            "Ns" => draft.exponent = self.number(keyword, &words, 0.0).or(draft.exponent),
            "d" => {
                let words = words.strip_prefix(&["-halo"]).unwrap_or(&words);
                current.dissolve = self.number(keyword, words, f32::NEG_INFINITY);
            }
            "Tr" => current.transparency = self.number(keyword, &words, f32::NEG_INFINITY),
            "illum" => match words.first().and_then(|word| word.parse().ok()) {
                Some(model) => current.illum = Some(model),
                None => self.warn("illum needs a number from 0 to 10; ignored"),
            },
            // Refraction, transmission filter and the like act only together with illum 4 and above or d, reported there.
            "Ni" | "Tf" | "Km" | "Kt" | "sharpness" => {}
            "Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor" | "bump" | "disp" | "decal" | "refl" | "norm" => {
                current.ignore(keyword.to_owned());
            }
            map if map.to_ascii_lowercase().starts_with("map_") => current.ignore(keyword.to_owned()),
            other => {
                if self.unknown_keyword.is_empty() {
                    self.unknown_keyword = other.to_owned();
                }
                self.unknown.add(self.line);
            }
        }
        self.current = Some(current);
    }

    /// Finishes the current material.
    fn close(&mut self) {
        let Some(mut current) = self.current.take() else { return };
        match current.illum {
            Some(0 | 1) => current.draft.glossy = None,
            Some(model @ 3..) => current.ignore(format!("illum {model} (mirror or glass)")),
            Some(2) | None => {}
        }
        // `d` and `Tr` say the same in opposite ways, and exporters disagree on `Tr`: `d` wins where both are given.
        match (current.dissolve, current.transparency) {
            (Some(d), _) if d < 1.0 => current.ignore(format!("d {d} (transparency)")),
            (None, Some(tr)) if tr > 0.0 => current.ignore(format!("Tr {tr} (transparency)")),
            _ => {}
        }
        let Current { mut draft, ignored, .. } = current;
        if !ignored.is_empty() {
            let (file, name, ignored) = (self.path.display(), &draft.name, ignored.join(", "));
            draft.not_modelled = Some(format!("{file}: material `{name}`: not modelled, ignored: {ignored}"));
        }
        if self.drafts.iter().any(|other| other.name == draft.name) {
            let (file, name) = (self.path.display(), &draft.name);
            self.warnings.push(format!("{file}: material `{name}` is defined twice; the later one counts"));
            self.drafts.retain(|other| other.name != draft.name);
        }
        self.drafts.push(draft);
    }

    /// One number for all channels, or three; none if it is wrong, which is a warning.
    fn colour(&mut self, keyword: &str, words: &[&str]) -> Option<Vec3> {
        let numbers: Option<Vec<f32>> =
            words.iter().map(|word| word.parse().ok().filter(|n: &f32| n.is_finite())).collect();
        let colour = match numbers.as_deref() {
            Some([grey]) => Vec3::splat(*grey),
            Some([r, g, b]) => Vec3::new(*r, *g, *b),
            _ => {
                self.warn(&format!("{keyword} needs three finite numbers, found `{}`; ignored", words.join(" ")));
                return None;
            }
        };
        if colour.min_element() < 0.0 {
            self.warn(&format!("{keyword} is negative; 0 is used where it is"));
        }
        Some(colour.max(Vec3::ZERO))
    }

    /// A finite number of at least `least`; none if it is wrong, which is a warning.
    fn number(&mut self, keyword: &str, words: &[&str], least: f32) -> Option<f32> {
        let number = words.first().and_then(|word| word.parse().ok()).filter(|n: &f32| n.is_finite() && *n >= least);
        if number.is_none() {
            let least = if least.is_finite() { format!(" of at least {least}") } else { String::new() };
            self.warn(&format!("{keyword} needs a finite number{least}, found `{}`; ignored", words.join(" ")));
        }
        number
    }
}

impl Current {
    fn ignore(&mut self, what: String) {
        if !self.ignored.contains(&what) {
            self.ignored.push(what);
        }
    }
}
