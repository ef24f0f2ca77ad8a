//! The options and the file name of an MTL texture statement.

use crate::scene::load::map_file::{Channel, LARGEST_TRANSFORM, MapFile, MapSource, scaled_and_moved};
use glam::Vec2;
use std::path::Path;

/// Behind an option that nobody knows a name is looked for from so many words on.
const MOST_WORDS: usize = 16;

/// What a texture statement says.
#[derive(Debug)]
pub(super) struct MapStatement {
    /// The map.
    pub map: MapFile,
    /// `-bm`.
    pub multiplier: Option<f32>,
    /// Options that would change the picture and are not modelled.
    pub ignored: Vec<String>,
    /// What else is to be said of the options, in words.
    pub notes: Vec<String>,
}

/// Reads what follows the keyword: options, then a file name that may hold blanks. `at` is `FILE:LINE`.
///
/// # Errors
/// In words: an option without its value, or no file name.
pub(super) fn parse(rest: &str, folder: &Path, at: String) -> Result<MapStatement, String> {
    let rest = rest.trim();
    let mut reader = Reader { rest };
    let mut map = MapFile::plain(Vec::new(), folder, at);
    let (mut ignored, mut notes, mut multiplier) = (Vec::new(), Vec::new(), None);
    let (mut scale, mut offset) = (Vec2::ONE, Vec2::ZERO);
    let mut ignore = |option: &str, changes: bool| {
        if changes && !ignored.iter().any(|ignored| ignored == option) {
            ignored.push(option.to_owned());
        }
    };
    while reader.rest.starts_with('-') {
        let before = reader.rest;
        let option = reader.word().to_ascii_lowercase();
        match option.as_str() {
            "-clamp" => map.clamp = reader.word().eq_ignore_ascii_case("on"),
            "-blendu" | "-blendv" | "-cc" | "-texres" => {
                reader.word();
            }
            "-bm" => multiplier = Some(reader.number().ok_or("-bm needs a number")?),
            "-boost" => {
                reader.number().ok_or("-boost needs a number")?;
            }
            "-mm" => {
                let numbers = (reader.number(), reader.number());
                (map.base, map.gain) =
                    numbers.0.zip(numbers.1).ok_or_else(|| "-mm needs two numbers, base and gain".to_owned())?;
            }
            // A third number is for solid textures. The specification's words for `-s` ("expanding or shrinking") leave open which is which: all
            // who read it repeat the picture that often.
            "-o" => match pair(&reader.numbers(&option)?, 0.0) {
                Some(read) => offset = read,
                None => notes.push(beyond("-o")),
            },
            "-s" => match pair(&reader.numbers(&option)?, 1.0) {
                Some(read) => {
                    if read.min_element() == 0.0 || read.max_element() == 0.0 {
                        notes.push("-s 0 shows one row or column of the picture everywhere".into());
                    }
                    scale = read;
                }
                None => notes.push(beyond("-s")),
            },
            "-t" => ignore("-t", reader.numbers(&option)?.iter().any(|n| *n != 0.0)),
            "-imfchan" => match reader.word().to_ascii_lowercase().as_str() {
                "r" => map.channel = Channel::One(0),
                "g" => map.channel = Channel::One(1),
                "b" => map.channel = Channel::One(2),
                "m" => map.channel = Channel::One(3),
                "l" => map.channel = Channel::Luminance,
                _ => ignore("-imfchan", true),
            },
            // A file name may begin like an option. If there is none of this name, it is an option that nobody knows, with or without values.
            _ => match behind_unknown(before, folder) {
                Some(behind) => {
                    ignore(before.split_whitespace().next().unwrap_or_default(), true);
                    reader.rest = behind;
                }
                None => {
                    reader.rest = before;
                    break;
                }
            },
        }
    }
    let name = reader.rest;
    if name.is_empty() {
        return Err("no file name".into());
    }
    if name.contains(" -") && !there(name, folder) {
        // Options belong before the name, and some write them behind it.
        let options = &rest[..rest.len() - name.len()];
        let tails = name.match_indices(" -").filter(|(at, _)| there(&name[..*at], folder));
        if let Some((at, _)) = tails.last() {
            return parse(&format!("{options} {} {}", &name[at..], &name[..at]), folder, map.at);
        }
    }
    map.source = MapSource::File { names: meanings(name), folder: folder.to_owned() };
    map.transform = scaled_and_moved(scale, offset);
    Ok(MapStatement { map, multiplier, ignored, notes })
}

/// What a name may mean. A comment at the end, or a number sign in the name? Quotes, or a part of it? Only the folder knows.
fn meanings(name: &str) -> Vec<String> {
    let comments = name.match_indices(" #").chain(name.match_indices("\t#"));
    let mut heads: Vec<&str> = comments.map(|(at, _)| name[..at].trim()).collect();
    heads.sort_by_key(|head| std::cmp::Reverse(head.len()));
    let unquoted = |name: &str| Some(name.strip_prefix('"')?.strip_suffix('"')?.to_owned());
    let all = std::iter::once(name).chain(heads);
    let mut names: Vec<String> = all.flat_map(|name| [Some(name.to_owned()), unquoted(name)]).flatten().collect();
    names.retain(|name| !name.is_empty());
    names
}

/// Whether there is a file of this name.
fn there(name: &str, folder: &Path) -> bool {
    let names = meanings(name);
    !names.is_empty() && MapFile::plain(names, folder, String::new()).path().is_some_and(|path| path.is_file())
}

/// What follows an option that nobody knows and its values: another option, or the name of a file that is there. None if there is no such file.
fn behind_unknown<'a>(rest: &'a str, folder: &Path) -> Option<&'a str> {
    if there(rest, folder) {
        return None;
    }
    let blanks = rest.match_indices(char::is_whitespace).map(|(at, blank)| at + blank.len());
    let words = blanks.map(|at| &rest[at..]).filter(|word| !word.starts_with(char::is_whitespace));
    // Each is looked for in the folder.
    let words: Vec<&str> = words.take(MOST_WORDS).collect();
    let is_option =
        |word: &str| word.starts_with('-') && !word[1..].starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let begins = words.iter().position(|word| there(word, folder))?;
    words[..=begins].iter().find(|word| is_option(word)).or(words.get(begins)).copied()
}

/// The first two of one to three numbers, the second being `missing` if there is none; none if one is too large.
fn pair(numbers: &[f32], missing: f32) -> Option<Vec2> {
    let pair = Vec2::new(numbers[0], numbers.get(1).copied().unwrap_or(missing));
    // Written so that what is no number fails.
    pair.abs().cmple(Vec2::splat(LARGEST_TRANSFORM)).all().then_some(pair)
}

fn beyond(option: &str) -> String {
    format!("{option} needs numbers from -{LARGEST_TRANSFORM:e} to {LARGEST_TRANSFORM:e}; it is ignored")
}

struct Reader<'a> {
    rest: &'a str,
}

impl<'a> Reader<'a> {
    fn word(&mut self) -> &'a str {
        let end = self.rest.find(char::is_whitespace).unwrap_or(self.rest.len());
        let word = &self.rest[..end];
        self.rest = self.rest[end..].trim_start();
        word
    }

    /// The next word, if it is a finite number.
    fn number(&mut self) -> Option<f32> {
        let before = self.rest;
        let number = self.word().parse().ok().filter(|n: &f32| n.is_finite());
        if number.is_none() {
            self.rest = before;
        }
        number
    }

    /// One to three numbers: the second and the third may be left out. The last word of all is the file name, even if it is a
    /// number.
    fn numbers(&mut self, option: &str) -> Result<Vec<f32>, String> {
        let mut numbers = Vec::new();
        while numbers.is_empty() || numbers.len() < 3 && self.rest.contains(char::is_whitespace) {
            let before = self.rest;
            // Not only finite ones, so that one that is not is taken for what it is and not for a file name.
            match self.word().parse() {
                Ok(number) => numbers.push(number),
                Err(_) if numbers.is_empty() => return Err(format!("{option} needs one to three numbers")),
                Err(_) => {
                    self.rest = before;
                    break;
                }
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(statement: &MapStatement) -> &[String] {
        let MapSource::File { names, .. } = &statement.map.source else { panic!("no file") };
        names
    }

    fn read(rest: &str) -> MapStatement {
        parse(rest, Path::new(""), String::new()).unwrap_or_else(|error| panic!("{rest}: {error}"))
    }

    #[test]
    fn options_and_names_are_told_apart() {
        for (rest, name) in [
            ("a.png", "a.png"),
            ("  my wood 01.png ", "my wood 01.png"),
            ("-o 0.1 0.2 0.3 -s 2 3 4 a.png", "a.png"),
            ("-s 2 a.png", "a.png"),
            ("-o 1 2 3", "3"),
            ("-bm 2 bump 01.png", "bump 01.png"),
            ("-blendu on -blendv off -texres 512 -cc off -boost 2 a.png", "a.png"),
            ("-wall.png", "-wall.png"),
            ("-clamp on -wall-2.png", "-wall-2.png"),
            ("2 wood.png", "2 wood.png"),
        ] {
            assert_eq!(names(&read(rest)), [name], "{rest}");
        }
        assert_eq!(names(&read("a.png # red")), ["a.png # red", "a.png"]);
        assert_eq!(names(&read("\"a b.png\"")), ["\"a b.png\"", "a b.png"]);
        assert!(names(&read("\"a #1.png\" # red")).contains(&"a #1.png".to_owned()));
    }

    #[test]
    fn options_are_kept_or_named() {
        let statement = read("-clamp on -mm 0.25 2 -imfchan g -o 0 0 0 -s 1 -t 0.1 a.png");
        let map = &statement.map;
        assert_eq!((map.clamp, map.base, map.gain, map.channel), (true, 0.25, 2.0, Channel::One(1)));
        assert_eq!(map.scale_and_offset().unwrap(), (Vec2::ONE, Vec2::ZERO));
        assert_eq!(statement.ignored, ["-t"]);
        assert_eq!(read("-t 0 0 0 -imfchan z a.png").ignored, ["-imfchan"], "-t 0 changes nothing");
    }

    /// One to three numbers, of which the third is for what has a depth; a second scale that is missing is 1, a second offset 0.
    #[test]
    fn places_are_read() {
        for (rest, scale, offset) in [
            ("-s 2 2 1 -o 0.5 0 0 a.png", (2.0, 2.0), (0.5, 0.0)),
            ("-o 0.5 -s 2 a.png", (2.0, 1.0), (0.5, 0.0)),
            ("-s 2 -3 a.png", (2.0, -3.0), (0.0, 0.0)),
            ("-s 1 2 3 4.png", (1.0, 2.0), (0.0, 0.0)),
            ("-o 0 1e3 2 wood.png", (1.0, 1.0), (0.0, 1e3)),
        ] {
            let statement = read(rest);
            assert_eq!(statement.map.scale_and_offset().unwrap(), (scale.into(), offset.into()), "{rest}");
            assert!(statement.ignored.is_empty() && statement.notes.is_empty(), "{rest}: {statement:?}");
        }
        let zero = read("-s 0 2 a.png");
        assert_eq!((zero.map.scale_and_offset(), zero.notes.len()), (Some((Vec2::new(0.0, 2.0), Vec2::ZERO)), 1));
        let huge = read("-s 1e7 1 -o 0 -1e9 a.png");
        assert_eq!((huge.map.scale_and_offset(), huge.notes.len()), (Some((Vec2::ONE, Vec2::ZERO)), 2));
        for rest in ["-s inf 1 a.png", "-s 1 nan a.png", "-o -inf 0 nan a.png"] {
            let bad = read(rest);
            assert_eq!((bad.map.written(), bad.notes.len()), ("a.png", 1), "{rest}");
            assert_eq!(bad.map.scale_and_offset().unwrap(), (Vec2::ONE, Vec2::ZERO), "{rest}");
        }
    }

    #[test]
    fn what_is_missing_is_said() {
        for (rest, words) in
            [("", "file name"), ("-clamp on", "file name"), ("-mm 1 a.png", "two numbers"), ("-o a.png", "-o")]
        {
            let error = parse(rest, Path::new(""), String::new()).expect_err(rest);
            assert!(error.contains(words), "{rest}: {error}");
        }
    }
}
