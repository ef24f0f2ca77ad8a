//! The options and the file name of an MTL texture statement.

use crate::scene::load::texture::{Channel, MapFile};
use std::path::Path;

/// What a texture statement says.
#[derive(Debug)]
pub(super) struct MapStatement {
    /// The map.
    pub map: MapFile,
    /// Options that would change the picture and are not modelled.
    pub ignored: Vec<&'static str>,
}

/// Reads what follows the keyword: options, then a file name that may hold blanks. `at` is `FILE:LINE`.
///
/// # Errors
/// In words: an option without its value, or no file name.
pub(super) fn parse(rest: &str, folder: &Path, at: String) -> Result<MapStatement, String> {
    let mut reader = Reader { rest: rest.trim() };
    let mut map = MapFile::plain(Vec::new(), folder, at);
    let mut ignored = Vec::new();
    let mut ignore = |option, changes: bool| {
        if changes && !ignored.contains(&option) {
            ignored.push(option);
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
            "-bm" | "-boost" => {
                reader.number().ok_or_else(|| format!("{option} needs a number"))?;
            }
            "-mm" => {
                let numbers = (reader.number(), reader.number());
                (map.base, map.gain) =
                    numbers.0.zip(numbers.1).ok_or_else(|| "-mm needs two numbers, base and gain".to_owned())?;
            }
            "-o" => ignore("-o", reader.numbers(&option)?.iter().any(|n| *n != 0.0)),
            "-s" => ignore("-s", reader.numbers(&option)?.iter().any(|n| *n != 1.0)),
            "-t" => ignore("-t", reader.numbers(&option)?.iter().any(|n| *n != 0.0)),
            "-imfchan" => match reader.word().to_ascii_lowercase().as_str() {
                "r" => map.channel = Channel::One(0),
                "g" => map.channel = Channel::One(1),
                "b" => map.channel = Channel::One(2),
                "m" => map.channel = Channel::One(3),
                "l" => map.channel = Channel::Luminance,
                _ => ignore("-imfchan", true),
            },
            // No option: a file name may begin like one.
            _ => {
                reader.rest = before;
                break;
            }
        }
    }
    let name = reader.rest;
    if name.is_empty() {
        return Err("no file name".into());
    }
    map.names.push(name.to_owned());
    // A comment at the end, or a number sign in the name? Quotes, or a part of it? Only the folder knows.
    if let Some((head, _)) = name.split_once(" #").or_else(|| name.split_once("\t#")) {
        map.names.push(head.trim().to_owned());
    }
    if let Some(inner) = name.strip_prefix('"').and_then(|name| name.strip_suffix('"')) {
        map.names.push(inner.to_owned());
    }
    map.names.retain(|name| !name.is_empty());
    Ok(MapStatement { map, ignored })
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
        let first = self.number().ok_or_else(|| format!("{option} needs one to three numbers"))?;
        let mut numbers = vec![first];
        while numbers.len() < 3 && self.rest.contains(char::is_whitespace) {
            match self.number() {
                Some(number) => numbers.push(number),
                None => break,
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(read(rest).map.names, [name], "{rest}");
        }
        assert_eq!(read("a.png # red").map.names, ["a.png # red", "a.png"]);
        assert_eq!(read("\"a b.png\"").map.names, ["\"a b.png\"", "a b.png"]);
    }

    #[test]
    fn options_are_kept_or_named() {
        let statement = read("-clamp on -mm 0.25 2 -imfchan g -o 0 0 0 -s 1 -t 0.1 a.png");
        let map = &statement.map;
        assert_eq!((map.clamp, map.base, map.gain, map.channel), (true, 0.25, 2.0, Channel::One(1)));
        assert_eq!(statement.ignored, ["-t"], "-o 0 and -s 1 change nothing");
        assert_eq!(read("-s 2 2 -o 0 1 -imfchan z a.png").ignored, ["-s", "-o", "-imfchan"]);
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
