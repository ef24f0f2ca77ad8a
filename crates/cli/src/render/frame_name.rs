//! The names of a sequence's files: `frame-%04d.png`.

use luminaire::{Error, Result};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The digits of a number where the name does not say how many.
const DIGITS: usize = 4;

/// A name with a place for the number of the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameName {
    before: OsString,
    after: OsString,
    /// The least length of the number.
    digits: usize,
}

impl FrameName {
    /// The name that `-o` gives: `%d` is the number, `%04d` one of four digits, and `%%` a percent sign. Without a number it is
    /// put before the ending.
    ///
    /// # Errors
    /// A usage error if there is anything else behind a percent sign, or a second number.
    pub fn of(path: &Path) -> Result<Self> {
        let Some(text) = path.to_str().filter(|text| text.contains('%')) else { return Ok(Self::plain(path)) };
        let wrong = |what: &str| {
            Error::Usage(format!(
                "-o {text}: {what}; the number of the frame is %04d (four digits) or %d, and a percent sign %%"
            ))
        };
        let mut parts = [String::new(), String::new()];
        let mut number: Option<usize> = None;
        let mut rest = text;
        while let Some((before, behind)) = rest.split_once('%') {
            let part = &mut parts[usize::from(number.is_some())];
            *part += before;
            if let Some(behind) = behind.strip_prefix('%') {
                part.push('%');
                rest = behind;
                continue;
            }
            let digits = behind.len() - behind.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let (length, behind) = behind.split_at(digits);
            let Some(behind) = behind.strip_prefix(['d', 'i', 'u']) else {
                let found: String = rest[before.len()..].chars().take(digits + 2).collect();
                return Err(wrong(&format!("`{found}` is no number of a frame")));
            };
            if number.is_some() {
                return Err(wrong("it has two numbers of a frame"));
            }
            // No digits: as many as the number has.
            number = match length.parse().or(if digits == 0 { Ok(0) } else { Err(()) }) {
                Ok(2..=9) if !length.starts_with('0') => {
                    return Err(wrong(&format!("`%{length}d` puts blanks before the number: say %0{length}d")));
                }
                Ok(length @ 0..=9) => Some(length),
                _ => return Err(wrong("that many digits have no number")),
            };
            rest = behind;
        }
        parts[usize::from(number.is_some())] += rest;
        let [before, after] = parts;
        Ok(match number {
            Some(digits) => FrameName { before: before.into(), after: after.into(), digits },
            None => Self::plain(before.as_ref()),
        })
    }

    /// A name in which a percent sign is nothing special: `frame.png` stands for `frame-0000.png` and so on.
    pub fn plain(path: &Path) -> Self {
        let mut before = path.with_extension("").into_os_string();
        before.push("-");
        let mut after = OsString::new();
        if let Some(ending) = path.extension() {
            after.push(".");
            after.push(ending);
        }
        FrameName { before, after, digits: DIGITS }
    }

    /// Whether a name has a place for a number, as one of a frame would have it.
    pub fn is_one(path: &Path) -> bool {
        let plain = path.to_str().is_none_or(|text| !text.replace("%%", "").contains('%'));
        !plain && Self::of(path).is_ok()
    }

    /// The name of a frame's file.
    pub fn file(&self, frame: u32) -> PathBuf {
        let mut name = self.before.clone();
        name.push(format!("{frame:0digits$}", digits = self.digits));
        name.push(&self.after);
        name.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_printf() {
        for (name, frame, file) in [
            ("frame-%04d.png", 7, "frame-0007.png"),
            ("frame-%04d.png", 12_345, "frame-12345.png"),
            ("%d.exr", 0, "0.exr"),
            ("a/%03d/x.png", 42, "a/042/x.png"),
            ("a%1d.png", 42, "a42.png"),
            ("a%0d.png", 42, "a42.png"),
            ("a%02i%%b.png", 3, "a03%b.png"),
            ("50%%.png", 3, "50%-0003.png"),
            ("frame.png", 0, "frame-0000.png"),
            ("folder.d/frame.v2.exr", 9, "folder.d/frame.v2-0009.exr"),
            ("none", 1, "none-0001"),
        ] {
            assert_eq!(FrameName::of(Path::new(name)).unwrap().file(frame), Path::new(file), "{name}");
        }
        for (name, is_one) in
            [("a%d.png", true), ("a%03i.png", true), ("50%%d.png", false), ("100%.png", false), ("a.png", false)]
        {
            assert_eq!(FrameName::is_one(Path::new(name)), is_one, "{name}");
        }
        assert_eq!(FrameName::plain(Path::new("50%d.png")).file(1), Path::new("50%d-0001.png"));
    }

    #[test]
    fn what_else_a_percent_sign_may_mean_is_answered() {
        for (name, part) in [
            ("frame-%s.png", "`%s` is no number"),
            ("frame-%.png", "`%.` is no number"),
            ("50%", "`%` is no number"),
            ("%04x.png", "`%04x` is no number"),
            ("%-4d.png", "`%-` is no number"),
            ("%d-%04d.png", "two numbers"),
            ("%0100d.png", "that many digits"),
            ("x%4d.png", "blanks before the number: say %04d"),
            ("%i-%2i.png", "two numbers"),
            ("%99999999999999999999d.png", "that many digits"),
        ] {
            let error = FrameName::of(Path::new(name)).unwrap_err();
            let said = error.to_string();
            assert!(error.exit_code() == 2 && said.contains(part) && said.contains("%04d"), "{name}: {said}");
        }
    }
}
