//! What is meant instead of a word, a type or a table that a scene file cannot have.

use super::foreign_words::{KEYS, NAMES};
use super::tables::{
    ConductorTable, EnvironmentTable, FilmTable, GroundTable, IntegratorTable, LuminaireEntry, MaterialTable,
    ObjectTable, PlacedMap, RenderTable, SceneFile, SensorTable,
};
use crate::picture::linear;
use crate::scene::load::near_name::near_name;
use crate::scene::load::text_file::shortened;
use ::toml::de::{DeTable, DeValue};
use serde::de::DeserializeOwned;
use std::ops::Range;

/// The tables, of which a file has one each or a list: name, whether it is a list, keys.
fn tables() -> [(&'static str, bool, Vec<String>); 10] {
    [
        ("top", false, keys::<SceneFile>()),
        ("film", false, keys::<FilmTable>()),
        ("sensor", false, keys::<SensorTable>()),
        ("environment", false, keys::<EnvironmentTable>()),
        ("ground", false, keys::<GroundTable>()),
        ("integrator", false, keys::<IntegratorTable>()),
        ("render", false, keys::<RenderTable>()),
        ("object", true, keys::<ObjectTable>()),
        ("material", true, keys::<MaterialTable>()),
        ("luminaire", true, keys::<LuminaireEntry>()),
    ]
}

/// The tables within a material, with a name for what they are.
fn inner_tables() -> [(&'static str, Vec<String>); 2] {
    [("map", keys::<PlacedMap>()), ("conductor", keys::<ConductorTable>())]
}

/// The keys of a table: those that its parser names to whoever writes another one.
fn keys<T: DeserializeOwned>() -> Vec<String> {
    let error = ::toml::from_str::<T>("'no key' = 0").err();
    error.map(|error| quoted(error.message()).into_iter().skip(1).collect()).unwrap_or_default()
}

/// The words between backticks.
fn quoted(message: &str) -> Vec<String> {
    message.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// How a table is written.
fn written(name: &str) -> String {
    let list = tables().iter().any(|(table, list, _)| *table == name && *list);
    if list { format!("[[{name}]]") } else { format!("[{name}]") }
}

/// As words are compared: small letters, underscores.
fn plain(word: &str) -> String {
    word.trim().to_lowercase().replace(['-', ' '], "_")
}

/// The advice of a row that has the word.
fn foreign(rows: &[(&str, &[&str], &'static str)], of: impl Fn(&str) -> bool, word: &str) -> Option<&'static str> {
    rows.iter().find(|(name, words, _)| of(name) && words.contains(&word)).map(|(.., advice)| *advice)
}

/// A table where a list of tables belongs, or the other way round: what to write, and where it stands.
pub(super) fn wrong_brackets(text: &str) -> Option<(Range<usize>, String)> {
    let root = DeTable::parse(text).ok()?;
    for (key, value) in root.get_ref() {
        let name: &str = key.get_ref();
        let Some((_, list, keys)) = tables().into_iter().find(|(table, ..)| *table == name) else { continue };
        let is_table = |value: &DeValue| matches!(value, DeValue::Table(_));
        let message = match (list, value.get_ref()) {
            (false, DeValue::Table(_)) => continue,
            // Of which there may be one or several.
            (false, DeValue::Array(tables))
                if name == "sensor" && tables.iter().all(|value| is_table(value.get_ref())) =>
            {
                continue;
            }
            (true, DeValue::Array(tables)) if tables.iter().all(|value| is_table(value.get_ref())) => continue,
            (true, DeValue::Table(_)) => {
                format!("one table, expected a list of them: write [[ ]] around its name: [[{name}]]")
            }
            (false, DeValue::Array(tables)) if tables.iter().any(|value| is_table(value.get_ref())) => {
                format!("a scene has one {name}: write [{name}] in single brackets, once")
            }
            _ => format!("`{name}` is a table: a line {}, and below it keys as `{} = ...`", written(name), keys[0]),
        };
        return Some((key.span(), message));
    }
    None
}

/// The parser's message in the words of a scene file, with what is meant instead where that can be guessed. `text` is the file, `span` the place.
pub(super) fn in_plain_words(message: &str, text: &str, span: Range<usize>) -> String {
    let words = quoted(message);
    if message.starts_with("unknown field") && words.len() > 1 {
        return unknown_key(&words[0], &words[1..]);
    }
    if message.starts_with("unknown variant") && words.len() > 1 {
        let hint = name_hint(&words[0], &words[1..]).map(|hint| format!("; {hint}")).unwrap_or_default();
        return format!("{message}{hint}");
    }
    let replaced = [
        ("invalid type: map, expected", "a table (or a list of tables), expected"),
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected i64", "expected a whole number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("wanted string or table", "expected a name between quotes"),
    ];
    let plain = replaced.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to));
    match advice(message, text, span) {
        Some(advice) => format!("{plain}: {advice}"),
        None => plain,
    }
}

/// What a key that a table has not could mean.
fn unknown_key(key: &str, expected: &[String]) -> String {
    let all = tables();
    let table = all.iter().find(|(.., keys)| keys == expected).map_or("", |(name, ..)| *name);
    let word = plain(key);
    let list = expected.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    if let Some((table, _)) = inner_tables().into_iter().find(|(_, keys)| keys == expected) {
        let near =
            || near_name(&word, expected.iter().map(String::as_str)).map(|name| format!("did you mean `{name}`?"));
        let hint = foreign(KEYS, |name| name == table, &word).map(str::to_owned).or_else(near);
        let hint = hint.map(|hint| format!("{hint}; ")).unwrap_or_default();
        return format!("unknown key `{}` of a {table}: {hint}there are {list}", shortened(key));
    }
    let place =
        |name: &str| if name == "top" { "outside of the tables".to_owned() } else { format!("in {}", written(name)) };
    let elsewhere = || {
        let others = all.iter().filter(|(name, _, keys)| *name != table && *name != "top" && keys.contains(&word));
        let names: Vec<String> = others.map(|(name, ..)| written(name)).collect();
        (!names.is_empty()).then(|| format!("it is a key of {}", names.join(" and of ")))
    };
    let near = || near_name(&word, expected.iter().map(String::as_str)).map(|name| format!("did you mean `{name}`?"));
    let same = expected.iter().find(|name| **name == word).map(|name| match table {
        "top" => format!("write {}", written(name)),
        _ => format!("write `{name}`"),
    });
    // As glTF names its textures.
    let texture = || {
        let map =
            format!("{}_map", word.strip_suffix("_texture").or(word.strip_suffix("texture"))?.trim_end_matches('_'));
        let map = map.replace("color", "colour");
        expected.contains(&map).then(|| format!("an image is named by `{map}`"))
    };
    let hint = same
        .or_else(|| foreign(KEYS, |name| name == table, &word).map(str::to_owned))
        .or_else(texture)
        .or_else(elsewhere)
        .or_else(|| foreign(KEYS, str::is_empty, &word).map(str::to_owned))
        .or_else(near);
    let hint = hint.map(|hint| format!("{hint}; ")).unwrap_or_default();
    let what = if table == "top" { "the tables are" } else { "there are" };
    format!("unknown key `{}` {}: {hint}{what} {list}", shortened(key), place(table))
}

/// What a name could mean where others are expected.
pub(super) fn name_hint(name: &str, expected: &[String]) -> Option<String> {
    let word = plain(name);
    let known = |first: &str| expected.iter().any(|name| name == first);
    expected
        .iter()
        .find(|known| plain(known) == word)
        .map(|known| format!("write \"{known}\""))
        .or_else(|| foreign(NAMES, known, &word).map(str::to_owned))
        .or_else(|| {
            near_name(&word, expected.iter().map(String::as_str)).map(|known| format!("did you mean \"{known}\"?"))
        })
}

/// What to write instead, by the parser's message.
fn advice(message: &str, text: &str, span: Range<usize>) -> Option<String> {
    let line = text[..span.start].rsplit('\n').next().unwrap_or_default().len();
    let line = text[span.start - line..].lines().next().unwrap_or_default().trim();
    if message.starts_with("duplicate key") {
        let name = line.trim_matches(['[', ']', ' ']);
        return Some(match tables().iter().find(|(table, ..)| *table == name && line.starts_with('[')) {
            Some((_, true, _)) => format!("write [[{name}]], with two brackets, each time"),
            Some(_) if name == "sensor" => {
                "of several cameras write each as [[sensor]], with two brackets and a `name` of its own".to_owned()
            }
            Some(_) => format!("a scene has one [{name}]: put all its keys below it"),
            None => "it stands in this table already; leave one of them out".to_owned(),
        });
    }
    let value = text.get(span.clone()).unwrap_or_default().trim_matches(['"', '\'']);
    if message.starts_with("invalid type: string") {
        if message.contains("three numbers") {
            if let Some(number) = value.trim().parse::<f64>().ok().filter(|_| message.contains("or one")) {
                return Some(format!("write it without quotes: {number}"));
            }
            let rgb = hex_colour(value).map(|[r, g, b]| format!("{value} is [{r:.4}, {g:.4}, {b:.4}] in linear RGB"));
            return rgb.or_else(|| Some("write them in brackets: [0, 0.5, 1]".to_owned()));
        }
        if value.trim().parse::<f64>().is_ok() {
            return Some(format!("write it without quotes: {}", value.trim()));
        }
        return (message.ends_with("expected a boolean")).then(|| "write true or false, without quotes".to_owned());
    }
    if message.contains("three numbers") && message.starts_with("invalid type: ") && value.parse::<f64>().is_ok() {
        return Some(format!("write [{value}, {value}, {value}] for the same in all of them"));
    }
    if message.contains("escape") {
        return Some(
            "in \"double quotes\" a backslash begins an escape: write the path with /, or in 'single quotes'"
                .to_owned(),
        );
    }
    let missing = quoted(message);
    if message.starts_with("missing field") && missing.len() == 1 {
        let what = match missing[0].as_str() {
            "position" => "the eye point [x, y, z]",
            "target" => "the point in the middle of the picture [x, y, z]",
            "mesh" => "the OBJ file, as \"FILE.obj\"",
            "name" => "which material it is, as `usemtl` or the `material` of an object calls it",
            "kind" => "\"point\", \"spot\" or \"infinite\"",
            "image" => "the name of the picture",
            "eta" => "the metal's index of refraction [r, g, b]",
            "k" => "the metal's extinction coefficient [r, g, b]",
            _ => return None,
        };
        return Some(what.to_owned());
    }
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if start.starts_with('<') {
        return Some(
            "this looks like XML (Mitsuba has such scenes), and a scene file is TOML: scenes/README.md has its tables"
                .to_owned(),
        );
    }
    if start.starts_with('{') {
        return Some("this looks like JSON, and a scene file is TOML: scenes/README.md has its tables".to_owned());
    }
    if ["LookAt", "Film ", "WorldBegin", "Camera \"", "Sampler \""].iter().any(|word| text.contains(word)) {
        return Some(
            "this looks like a scene of pbrt, and a scene file is TOML: scenes/README.md has its tables".to_owned(),
        );
    }
    (message.contains("expected `=`") && line.contains(':')).then(|| "TOML has `=` where YAML has `:`".to_owned())
}

/// The linear RGB of `#rrggbb`.
fn hex_colour(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let channel = |at: usize| {
        let byte = u8::from_str_radix(&digits[2 * at..2 * at + 2], 16).ok()?;
        Some(f64::from(linear(f32::from(byte) / 255.0)))
    };
    Some([channel(0)?, channel(1)?, channel(2)?])
}
