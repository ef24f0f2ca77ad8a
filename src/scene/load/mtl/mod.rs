//! Materials from an MTL file.
//!
//! The geometry is worth more than a bad number in its materials, so whatever is wrong in an MTL file is a warning with its line.

mod blender;
mod current;
mod keywords;
mod map_options;
mod named_files;
mod physical;
mod words;

pub(super) use named_files::named_files;

use super::map_file::Channel;
use super::material_draft::{BumpWord, Draft, ETAS, LARGEST_EXPONENT, MapDraft};
use super::text_file::{Tally, logical_lines, read_text, shortened};
use crate::Result;
use blender::Blender;
use current::{Current, MOST_IGNORED};
use glam::Vec3;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

/// So many warnings about one file are kept.
const MOST_WARNINGS: usize = 100;
/// So many keywords that nobody knows are named.
const MOST_KEYWORDS: usize = 8;
/// The materials of an MTL file.
#[derive(Debug)]
pub(super) struct Library {
    /// In the order of the file.
    pub drafts: Vec<Draft>,
    /// How they were read, where that is a choice.
    pub note: Option<String>,
}

/// Reads an MTL file: `Ka Kd Ks Ns Ke Ni Tf d Tr illum` with the maps of the colours and of `d`, those that bend normals (`map_Bump`, `bump`, `norm`), and
/// `Pr Pm Ps Pc Pcr aniso anisor` with their maps. What `illum` makes of the first, and what makes a metallic-roughness surface of a material, are tables in
/// `scenes/README.md`.
///
/// # Errors
/// Only if the file cannot be read at all.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Library> {
    let text = read_text(path, warnings)?;
    let blender = Blender::of(&text);
    let mut reader = Reader {
        path,
        warnings,
        blender,
        principled: 0,
        line: 0,
        current: None,
        drafts: Vec::new(),
        by_name: HashMap::new(),
        said: 0,
        orphans: Tally::default(),
        unknown: Vec::new(),
    };
    for (number, line) in logical_lines(&text) {
        reader.line = number;
        reader.statement(&line);
    }
    reader.close();
    reader.orphans.warn(path, "a statement before the first newmtl is ignored", reader.warnings);
    for (keyword, tally) in reader.unknown.iter().take(MOST_KEYWORDS) {
        let hint = keywords::instead_of(keyword).map(|word| format!("; did you mean `{word}`?")).unwrap_or_default();
        let unknown = format!("a statement with the unknown keyword `{keyword}` is ignored{hint}");
        tally.warn(path, &unknown, reader.warnings);
    }
    if let Some((keyword, tally)) = reader.unknown.get(MOST_KEYWORDS) {
        let more = reader.unknown.len() - MOST_KEYWORDS;
        tally.warn(
            path,
            &format!("`{keyword}` and others, {more} more unknown keywords, are ignored"),
            reader.warnings,
        );
    }
    if reader.said > MOST_WARNINGS {
        reader.warnings.push(format!("{}: and {} more warnings", path.display(), reader.said - MOST_WARNINGS));
    }
    let note = blender.filter(|_| reader.principled > 0).map(|blender| blender.note(path));
    Ok(Library { drafts: reader.drafts, note })
}

struct Reader<'a> {
    path: &'a Path,
    warnings: &'a mut Vec<String>,
    /// The program that wrote the file, if it was Blender.
    blender: Option<Blender>,
    /// How many materials were read as Blender means them.
    principled: usize,
    line: usize,
    current: Option<Current>,
    drafts: Vec<Draft>,
    /// Where in `drafts` the material of a name is.
    by_name: HashMap<String, usize>,
    /// Warnings of this file, those that were not kept included.
    said: usize,
    orphans: Tally,
    /// Keywords that nobody knows, in the order of the file.
    unknown: Vec<(String, Tally)>,
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
            // A rotation in turns: whole ones do not count.
            "anisor" => {
                let turns = self.number(keyword, &words, f32::NEG_INFINITY);
                let turns = turns.map(|turns| if (0.0..=1.0).contains(&turns) { turns } else { turns.rem_euclid(1.0) });
                current.words.state(keyword, turns);
            }
            "Pr" | "Pm" | "Ps" | "Pc" | "Pcr" | "aniso" => {
                // Blender's coat of 4 is one of 1.
                let most = if keyword == "Pc" && self.blender.is_some() { 4.0 } else { 1.0 };
                let number = self.bounded(keyword, &words, most);
                current.words.state(keyword, number);
            }
            // Images, in letters of any size.
            map => match map.to_ascii_lowercase().as_str() {
                "bump" | "norm" => self.map(keyword, rest, &mut current),
                "refl" if self.blender.is_some() => self.map("map_refl", rest, &mut current),
                "disp" | "decal" | "refl" => current.ignore(shortened(keyword).into_owned()),
                name if name.starts_with("map_") => self.map(map, rest, &mut current),
                _ => self.unknown(keyword),
            },
        }
        self.current = Some(current);
    }

    fn unknown(&mut self, keyword: &str) {
        let keyword = shortened(keyword);
        let place = self.unknown.iter().position(|(known, _)| *known == keyword).unwrap_or(self.unknown.len());
        // Of a file that is none there would be many.
        if place == self.unknown.len() && place < MOST_IGNORED {
            self.unknown.push((keyword.into_owned(), Tally::default()));
        }
        if let Some((_, tally)) = self.unknown.get_mut(place.min(MOST_IGNORED - 1)) {
            tally.add(self.line);
        }
    }

    /// Keeps a map, with its options.
    fn map(&mut self, keyword: &str, rest: &str, current: &mut Current) {
        let maps = &mut current.draft.maps;
        let name = keyword.to_ascii_lowercase();
        let map = match name.as_str() {
            "map_ka" => &mut maps.ambient,
            "map_kd" => &mut maps.diffuse,
            "map_ks" => &mut maps.glossy,
            "map_ke" => &mut maps.emission,
            "map_d" => &mut maps.opacity,
            "map_bump" | "bump" => &mut maps.bump,
            "norm" | "map_kn" => &mut maps.normal,
            _ => match current.words.map(&name, self.blender.is_some()) {
                Some(map) => map,
                None => {
                    let meant = keywords::map_instead_of(&name).map(|word| format!(" (write {word})"));
                    return current.ignore(shortened(keyword).into_owned() + &meant.unwrap_or_default());
                }
            },
        };
        let folder = self.path.parent().unwrap_or(Path::new(""));
        match map_options::parse(rest, folder, format!("{}:{}", self.path.display(), self.line)) {
            Ok(statement) => {
                // Of colours and of normals all channels count.
                let chosen = !keywords::of_a_number(&name) && statement.map.channel != Channel::Any;
                *map = MapDraft::File(statement.map);
                match name.as_str() {
                    "map_bump" | "bump" => {
                        current.draft.bump_scale = statement.multiplier;
                        let blender = self.blender.is_some();
                        current.draft.bump_word = if blender { BumpWord::Blender } else { BumpWord::Mtl };
                    }
                    "norm" | "map_kn" => {
                        current.draft.normal_scale = statement.multiplier;
                        current.draft.normal_word = true;
                    }
                    _ if statement.multiplier.is_some() => current.ignore(format!("{keyword} -bm")),
                    _ => {}
                }
                if chosen {
                    current.ignore(format!("{keyword} -imfchan"));
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
        let Some(current) = self.current.take() else { return };
        let file = self.path.display().to_string();
        let at = format!("{file}: material `{}`", current.draft.name);
        let not_blenders = self.blender.and_then(|blender| blender.is_another_hand(&current));
        let blender = self.blender.filter(|_| not_blenders.is_none() || current.words.any());
        let mut by_the_letter = current.clone().by_the_letter(&file, &at);
        let physical = physical::draft(current.clone(), blender, &file, &at);
        let draft = if current.words.any() || blender.is_some() {
            self.principled += usize::from(blender.is_some());
            Draft { otherwise: Some(by_the_letter.into()), ..physical }
        } else {
            by_the_letter.shared.extend(not_blenders.map(|why| (file, why)));
            Draft { otherwise: Some(physical.into()), ..by_the_letter }
        };
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

    /// A number from 0 to `most`; one outside of it is clamped, with a warning.
    fn bounded(&mut self, keyword: &str, words: &[&str], most: f32) -> Option<f32> {
        let number = self.number(keyword, words, f32::NEG_INFINITY)?;
        if !(0.0..=most).contains(&number) {
            self.warn(&format!("{keyword} {number} is outside of 0 to {most}; it is clamped"));
        }
        Some(number.clamp(0.0, most))
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
