//! Materials from an MTL file.
//!
//! The geometry is worth more than a bad number in its materials, so whatever is wrong in an MTL file is a warning with its line.

mod map_options;
mod named_files;

pub(super) use named_files::named_files;

use super::material_draft::{DEFAULT_ETA, Draft, ETAS, LARGEST_EXPONENT, MapDraft};
use super::text_file::{Tally, logical_lines, read_text, shortened};
use crate::Result;
use glam::Vec3;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

/// A mirror-like `Ks` with at least this exponent, or with none, is a perfect mirror.
const MIRROR_EXPONENT: f32 = 1000.0;

/// So many warnings about one file are kept.
const MOST_WARNINGS: usize = 100;
/// So many features that nothing models are named for a material.
const MOST_IGNORED: usize = 32;

/// Reads an MTL file: `Ka Kd Ks Ns Ke Ni Tf d Tr illum`, the maps of the colours and of `d`, and those that bend normals (`map_Bump`, `bump`, `norm`). What `illum` makes of them is a
/// table in `scenes/README.md`.
///
/// # Errors
/// Only if the file cannot be read at all.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Vec<Draft>> {
    let text = read_text(path, warnings)?;
    let mut reader = Reader {
        path,
        warnings,
        line: 0,
        current: None,
        drafts: Vec::new(),
        by_name: HashMap::new(),
        said: 0,
        orphans: Tally::default(),
        unknown: Tally::default(),
        unknown_keyword: String::new(),
    };
    for (number, line) in logical_lines(&text) {
        reader.line = number;
        reader.statement(&line);
    }
    reader.close();
    reader.orphans.warn(path, "a statement before the first newmtl is ignored", reader.warnings);
    let unknown = format!("a statement with the unknown keyword `{}` is ignored", reader.unknown_keyword);
    reader.unknown.warn(path, &unknown, reader.warnings);
    if reader.said > MOST_WARNINGS {
        reader.warnings.push(format!("{}: and {} more warnings", path.display(), reader.said - MOST_WARNINGS));
    }
    Ok(reader.drafts)
}

/// The material between two `newmtl`.
#[derive(Default)]
struct Current {
    draft: Draft,
    illum: Option<u32>,
    /// `d`, and what follows from `Tr`.
    dissolve: Option<f32>,
    transparency: Option<f32>,
    /// `Tf`.
    filter: Option<Vec3>,
    /// `Ni`.
    refraction: Option<f32>,
    /// Keywords of features that nothing models.
    ignored: Vec<String>,
    /// What exporters write for many materials alike.
    shared: Vec<String>,
}

struct Reader<'a> {
    path: &'a Path,
    warnings: &'a mut Vec<String>,
    line: usize,
    current: Option<Current>,
    drafts: Vec<Draft>,
    /// Where in `drafts` the material of a name is.
    by_name: HashMap<String, usize>,
    /// Warnings of this file, those that were not kept included.
    said: usize,
    orphans: Tally,
    unknown: Tally,
    unknown_keyword: String,
}

impl Reader<'_> {
    fn warn(&mut self, message: &str) {
        self.say(format!("{}:{}: {message}", self.path.display(), self.line));
    }

    fn say(&mut self, warning: String) {
        self.said += 1;
        if self.said <= MOST_WARNINGS {
            self.warnings.push(warning);
        }
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
            "Ns" => draft.exponent = self.exponent(&words).or(draft.exponent),
            "d" => {
                let words = words.strip_prefix(&["-halo"]).map_or(&words[..], |rest| {
                    current.ignore("d -halo".into());
                    rest
                });
                current.dissolve = self.share(keyword, words).or(current.dissolve);
            }
            "Tr" => current.transparency = self.share(keyword, &words).or(current.transparency),
            "Tf" => current.filter = self.colour(keyword, &words).or(current.filter),
            "Ni" => current.refraction = self.refraction(&words),
            "illum" => match words.first().and_then(|word| word.parse().ok()).filter(|model| *model <= 10) {
                Some(model) => current.illum = Some(model),
                None => self.warn("illum needs a number from 0 to 10; ignored"),
            },
            "Km" | "Kt" | "sharpness" => {}
            "bump" | "norm" => self.map(keyword, rest, &mut current),
            "Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" | "anisor" | "disp" | "decal" | "refl" => {
                current.ignore(shortened(keyword).into_owned());
            }
            map if map.to_ascii_lowercase().starts_with("map_") => self.map(map, rest, &mut current),
            other => {
                if self.unknown_keyword.is_empty() {
                    self.unknown_keyword = shortened(other).into_owned();
                }
                self.unknown.add(self.line);
            }
        }
        self.current = Some(current);
    }

    /// Keeps a map, with its options.
    fn map(&mut self, keyword: &str, rest: &str, current: &mut Current) {
        let maps = &mut current.draft.maps;
        let map = match keyword.to_ascii_lowercase().as_str() {
            "map_ka" => &mut maps.ambient,
            "map_kd" => &mut maps.diffuse,
            "map_ks" => &mut maps.glossy,
            "map_ke" => &mut maps.emission,
            "map_d" => &mut maps.opacity,
            "map_bump" | "bump" => &mut maps.bump,
            "norm" | "map_kn" => &mut maps.normal,
            _ => return current.ignore(shortened(keyword).into_owned()),
        };
        let folder = self.path.parent().unwrap_or(Path::new(""));
        match map_options::parse(rest, folder, format!("{}:{}", self.path.display(), self.line)) {
            Ok(statement) => {
                *map = MapDraft::File(statement.map);
                match keyword.to_ascii_lowercase().as_str() {
                    "map_bump" | "bump" => {
                        current.draft.bump_scale = statement.multiplier;
                        current.draft.bump_or_normals = true;
                    }
                    "norm" | "map_kn" => current.draft.normal_scale = statement.multiplier,
                    _ => {}
                }
                for option in statement.ignored {
                    current.ignore(format!("{keyword} {option}"));
                }
                for note in statement.notes {
                    self.warn(&format!("{keyword}: {note}"));
                }
            }
            Err(message) => self.warn(&format!("{keyword}: {message}; ignored")),
        }
    }

    /// Finishes the current material.
    fn close(&mut self) {
        let Some(mut current) = self.current.take() else { return };
        let at = format!("{}: material `{}`", self.path.display(), current.draft.name);
        current.impulses(&at);
        current.multipliers_of_maps(&at);
        let Current { mut draft, ignored, shared, .. } = current;
        let ignored = (!ignored.is_empty()).then(|| format!("not modelled, ignored: {}", ignored.join(", ")));
        let file = self.path.display().to_string();
        draft.shared = shared.into_iter().chain(ignored).map(|said| (file.clone(), said)).collect();
        match self.by_name.entry(draft.name.clone()) {
            Entry::Vacant(place) => {
                place.insert(self.drafts.len());
                self.drafts.push(draft);
            }
            Entry::Occupied(place) => {
                self.drafts[*place.get()] = draft;
                self.say(format!("{at} is defined twice; the later one counts"));
            }
        }
    }

    /// One number for all channels, or three; none if it is wrong, which is a warning. What follows three numbers does not count.
    fn colour(&mut self, keyword: &str, words: &[&str]) -> Option<Vec3> {
        if let Some(kind @ (&"xyz" | &"spectral")) = words.first() {
            self.warn(&format!("{keyword} {kind} is not modelled, only {keyword} with three numbers; ignored"));
            return None;
        }
        let number = |word: &&str| word.parse().ok().filter(|n: &f32| n.is_finite());
        let numbers: Vec<f32> = words.iter().map_while(number).collect();
        let colour = match numbers[..] {
            [grey] if words.len() == 1 => Vec3::splat(grey),
            [r, g, b, ..] => Vec3::new(r, g, b),
            _ => {
                let found = words.join(" ");
                let hint = if found.contains(',') { " (with a decimal point, and blanks between them)" } else { "" };
                self.warn(&format!(
                    "{keyword} needs three finite numbers{hint}, found `{}`; ignored",
                    shortened(&found)
                ));
                return None;
            }
        };
        if let Some(rest) = words.get(3..).filter(|rest| !rest.is_empty()) {
            self.warn(&format!("{keyword} has more than three numbers; `{}` is ignored", shortened(&rest.join(" "))));
        }
        if colour.min_element() < 0.0 {
            self.warn(&format!("{keyword} is negative; 0 is used where it is"));
        }
        // Only what emits may have any number.
        if keyword != "Ke" && colour.max_element() > 1.001 {
            self.warn(&format!(
                "{keyword} {} is above 1, which is all light: numbers from 0 to 255 have to be divided by 255",
                colour.max_element()
            ));
        }
        Some(colour.max(Vec3::ZERO))
    }

    /// `d` or `Tr`, a share of 1; `Tr` of more is what [`Current::opacity`] speaks of.
    fn share(&mut self, keyword: &str, words: &[&str]) -> Option<f32> {
        let share = self.number(keyword, words, f32::NEG_INFINITY)?;
        if share < 0.0 || share > 1.0 && keyword == "d" {
            self.warn(&format!("{keyword} {share} is outside of 0 to 1; it is clamped"));
        }
        Some(share)
    }

    /// `Ns`; what is larger than any that is modelled becomes the largest one.
    fn exponent(&mut self, words: &[&str]) -> Option<f32> {
        let exponent = self.number("Ns", words, 0.0)?;
        if exponent > LARGEST_EXPONENT {
            self.warn(&format!("Ns {exponent} is above {LARGEST_EXPONENT:e}, the largest exponent; that is used"));
        }
        Some(exponent.min(LARGEST_EXPONENT))
    }

    /// `Ni`; none if it is 0, which some exporters write where they know none.
    fn refraction(&mut self, words: &[&str]) -> Option<f32> {
        let ni = self.number("Ni", words, 0.0).filter(|ni| *ni > 0.0)?;
        let (least, most) = (ETAS.start(), ETAS.end());
        if !ETAS.contains(&ni) {
            self.warn(&format!("Ni needs an index of refraction from {least} to {most}, found `{ni}`; ignored"));
            return None;
        }
        Some(ni)
    }

    /// A finite number of at least `least`; none if it is wrong, which is a warning.
    fn number(&mut self, keyword: &str, words: &[&str], least: f32) -> Option<f32> {
        let number = words.first().and_then(|word| word.parse().ok()).filter(|n: &f32| n.is_finite() && *n >= least);
        if number.is_none() {
            let least = if least.is_finite() { format!(" of at least {least}") } else { String::new() };
            self.warn(&format!(
                "{keyword} needs a finite number{least}, found `{}`; ignored",
                shortened(&words.join(" "))
            ));
        } else if words.len() > 1 {
            self.warn(&format!(
                "{keyword} has more than one number; `{}` is ignored",
                shortened(&words[1..].join(" "))
            ));
        }
        number
    }
}

impl Current {
    fn ignore(&mut self, what: String) {
        if self.ignored.len() < MOST_IGNORED && !self.ignored.contains(&what) {
            self.ignored.push(what);
        }
    }

    /// What `illum` makes of `Ks`, `Ns`, `Ni`, `Tf`, `d` and `Tr`.
    fn impulses(&mut self, at: &str) {
        let glass = self.illum.filter(|model| matches!(model, 4 | 6 | 7 | 9)).is_some_and(|model| self.is_glass(model));
        let draft = &mut self.draft;
        let black = |colour: Option<Vec3>| colour.is_none_or(|colour| colour == Vec3::ZERO);
        match self.illum {
            Some(0 | 1) => draft.glossy = None,
            Some(model @ (3 | 5 | 8))
                if draft.exponent.is_none_or(|ns| ns >= MIRROR_EXPONENT) && !black(draft.glossy) =>
            {
                draft.reflection = draft.glossy.take();
                draft.eta = self.refraction.filter(|ni| model == 5 && *ni > 1.0);
                self.unused_map(|draft| &mut draft.maps.glossy, "map_Ks of a mirror");
            }
            Some(4 | 6 | 7 | 9) if glass => {
                draft.reflection = Some(if black(draft.glossy) { Vec3::ONE } else { draft.glossy.unwrap_or_default() });
                draft.transmission = Some(if black(self.filter) { Vec3::ONE } else { self.filter.unwrap_or_default() });
                draft.glossy = None;
                draft.eta = self.refraction.or(Some(DEFAULT_ETA));
                if self.refraction.is_none() {
                    draft
                        .notes
                        .push(format!("{at} is glass without an index of refraction (Ni); {DEFAULT_ETA} is used"));
                }
                self.dissolve = None;
                self.transparency = None;
                self.unused_map(|draft| &mut draft.maps.glossy, "map_Ks of glass");
                self.unused_map(|draft| &mut draft.maps.opacity, "map_d of glass");
            }
            _ => {}
        }
        if matches!(self.illum, Some(0 | 1)) {
            self.draft.maps.glossy = MapDraft::Unstated;
        }
        self.opacity(at);
    }

    /// Whether `illum`, which is one of those of glass, makes glass. Many exporters write one of them for everything, so that a material with a
    /// colour is glass only if it has an index of refraction, too, and nothing says how much of it is there; and a black one is not if its index is 1.
    fn is_glass(&mut self, illum: u32) -> bool {
        let draft = &self.draft;
        let coloured = draft.maps.diffuse.file().is_some() || draft.diffuse.is_some_and(|kd| kd != Vec3::ZERO);
        if !coloured {
            // Clear glass that bends nothing cannot be seen, and nobody means that: black rubber, and lamps, are written so.
            let clear = self.filter.is_none_or(|tf| tf == Vec3::ZERO || tf == Vec3::ONE);
            let unseen = clear && self.refraction.is_some_and(|ni| (ni - 1.0).abs() <= 1e-3);
            if unseen {
                self.shared.push(format!(
                    "illum {illum} asks for glass, but with Ni 1 and without a tint (Tf) nothing could be seen of it: it is taken as opaque"
                ));
            }
            return !unseen;
        }
        let transparency = self.transparency.filter(|tr| *tr < 1.0).map_or(1.0, |tr| 1.0 - tr);
        let dissolves = self.dissolve.unwrap_or(transparency) < 1.0 || draft.maps.opacity.file().is_some();
        let refraction = self.refraction.filter(|ni| (ni - 1.0).abs() > 1e-3);
        let (glass, said) = match refraction {
            _ if dissolves => (
                false,
                "but with a colour (Kd): d, Tr or map_d is taken as the opacity, and nothing is refracted; `Kd 0 0 0` makes it glass".into(),
            ),
            _ if self.filter == Some(Vec3::ZERO) => (
                false,
                "but with a colour (Kd) and a Tf of 0, through which nothing goes: it is taken as opaque".to_owned(),
            ),
            None => (
                false,
                "but with a colour (Kd), without transparency (d) and without an index of refraction (Ni): it is taken as opaque; \
                 `Kd 0 0 0` makes it glass"
                    .into(),
            ),
            Some(ni) => (
                true,
                format!(
                    "with Ni {ni} and a colour (Kd): glass and diffuse share the light; without Ni, or with illum 2, it is opaque, and with \
                     `Kd 0 0 0` clear glass"
                ),
            ),
        };
        self.shared.push(format!("illum {illum} asks for glass, {said}"));
        glass
    }

    /// `d`, or 1 - `Tr`. They say the same in opposite ways, and exporters disagree on `Tr`: `d` wins where both are given, and what would be
    /// invisible by `Tr` alone is not meant to be.
    fn opacity(&mut self, at: &str) {
        if let (Some(d), Some(tr)) = (self.dissolve, self.transparency)
            && (d + tr - 1.0).abs() > 1e-3
        {
            self.draft.notes.push(format!("{at}: d {d} and Tr {tr} contradict each other; d counts"));
        }
        if let (None, Some(tr)) = (self.dissolve, self.transparency)
            && tr >= 1.0
        {
            self.shared.push(format!(
                "Tr {tr} alone would make it invisible (Tr is 1 - d), but programs that write this mean opaque, as which it is taken: write `d 1` \
                 in its place, or `d 0` if nothing is to be seen"
            ));
            self.transparency = None;
        }
        let opacity = self.dissolve.or(self.transparency.map(|tr| 1.0 - tr));
        self.draft.opacity = opacity.map(|d| d.clamp(0.0, 1.0));
    }

    /// Drops a map that nothing uses, and says so.
    fn unused_map(&mut self, map: fn(&mut Draft) -> &mut MapDraft, what: &str) {
        if std::mem::take(map(&mut self.draft)).file().is_some() {
            self.ignore(what.to_owned());
        }
    }

    /// Exporters write 0 beside a map and mean 1.
    fn multipliers_of_maps(&mut self, at: &str) {
        let draft = &mut self.draft;
        for (keyword, colour, map) in
            [("Kd", &mut draft.diffuse, &draft.maps.diffuse), ("Ke", &mut draft.emission, &draft.maps.emission)]
        {
            if *colour == Some(Vec3::ZERO) && map.file().is_some() {
                *colour = Some(Vec3::ONE);
                draft.notes.push(format!("{at}: {keyword} is black beside a map_{keyword}; 1 is used"));
            }
        }
        if draft.opacity == Some(0.0) && draft.maps.opacity.file().is_some() {
            draft.opacity = Some(1.0);
            draft.notes.push(format!("{at}: d is 0 beside a map_d; 1 is used"));
        }
    }
}
