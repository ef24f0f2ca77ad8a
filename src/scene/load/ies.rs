//! Photometric files of IES LM-63 (1986, 1991, 1995, 2002, 2019): what a lamp sends in which direction.
//!
//! Free text down to the line `TILT=`, then numbers with blanks, commas or ends of lines between. Read are type C (of nearly all files) and every symmetry of it;
//! the size of what shines is not, as the luminaire is a point.

use super::text_file::{parse_number, read_text, shortened};
use crate::scene::Profile;
use crate::{Error, Result};
use std::path::Path;

/// What begins the line before the numbers.
const TILT: &str = "TILT=";

/// Reads a photometric file. What is guessed or left out is a warning.
///
/// # Errors
/// If it cannot be read, or is wrong, with its line; and if its angles are of type A or B.
pub(super) fn read(path: &Path, warnings: &mut Vec<String>) -> Result<Profile> {
    let text = read_text(path, warnings)?;
    let mut lines = text.lines().zip(1..);
    let first = text.lines().next().unwrap_or_default().trim();
    let error = |line, message: String| Error::Parse { path: path.to_owned(), line, column: 0, message };
    let Some((tilt, line)) = lines.find_map(|(text, line)| Some((in_capitals(text, TILT)?, line))) else {
        let message = "no line begins with `TILT=`: expected a photometric file of IES LM-63 (EULUMDAT, .ldt, is not read: convert it)";
        return Err(error(1, message.into()));
    };
    let mut numbers = Numbers::behind(path, &text, line);
    let mut warn = |line: usize, message: String| warnings.push(format!("{}:{line}: {message}", path.display()));
    match tilt.to_ascii_uppercase().as_str() {
        "NONE" => {}
        "INCLUDE" => {
            numbers.next("how the lamp lies in the luminaire")?;
            let pairs = numbers.count("the number of tilt angles", 0)?;
            for _ in 0..2 * pairs {
                numbers.next("an angle or a factor of TILT=INCLUDE")?;
            }
            warn(
                line,
                "TILT=INCLUDE: its factors are left out: the lamp shines as in the position in which it was measured"
                    .into(),
            );
        }
        "" => {
            return Err(error(
                line,
                "expected `TILT=NONE`, `TILT=INCLUDE` or the name of a file behind `TILT=`".into(),
            ));
        }
        _ => {
            let message = format!(
                "`TILT={}` names a file, which is left out: the lamp shines as in the position in which it was measured",
                shortened(tilt)
            );
            warn(line, message);
        }
    }
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let multiplier = numbers.above_0("the candela multiplier")?;
    let vertical_count = numbers.count("the number of vertical angles", 2)?;
    let horizontal_count = numbers.count("the number of horizontal angles", 1)?;
    numbers.photometric_type()?;
    for what in ["the unit of length", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    let ballast = numbers.above_0("the ballast factor")?;
    let further = numbers.next("the ballast-lamp factor (or 1)")?;
    // Two revisions have a factor here, the next two a 1, the last one the kind of file.
    let factor = match revision(first) {
        1986 | 1991 if further > 0.0 => further,
        1986 | 1991 => return Err(numbers.error("expected a ballast-lamp factor above 0".into())),
        2019 => 1.0,
        _ if further != 1.0 => {
            warn(
                numbers.line,
                format!(
                    "{} behind the ballast factor, where LM-63 of 1995 and later wants 1, is left out",
                    digits(further)
                ),
            );
            1.0
        }
        _ => 1.0,
    };
    numbers.next("the input watts")?;
    let vertical = numbers.angles("vertical", vertical_count, 180.0)?;
    let horizontal = numbers.angles("horizontal", horizontal_count, 360.0)?;
    let around = Around::of(&horizontal).map_err(|message| numbers.error(message))?;
    let scale = multiplier * ballast * factor;
    let mut rows = Vec::new();
    for _ in 0..horizontal_count {
        let mut row = Vec::new();
        for _ in 0..vertical_count {
            let candela = numbers.next("a candela value")?;
            if candela < 0.0 {
                return Err(numbers.error(format!("expected candelas of at least 0, found {}", digits(candela))));
            }
            let scaled = (scale * candela) as f32;
            if !scaled.is_finite() {
                return Err(numbers.error(format!(
                    "{} candelas, times {}, are too many",
                    digits(candela),
                    digits(scale)
                )));
            }
            row.push(scaled);
        }
        rows.push(row);
    }
    if let Some((word, line)) = numbers.peek() {
        warn(line, format!("`{}` and whatever follows the last candela is left out", shortened(word)));
    }
    let ends = [vertical[0], vertical[vertical.len() - 1]];
    if ![[0.0, 90.0], [90.0, 180.0], [0.0, 180.0]].contains(&ends) {
        let message =
            format!("the vertical angles go from {} to {} degrees; beyond there is no light", ends[0], ends[1]);
        warn(line, message);
    }
    if matches!(around, Around::Unclosed) {
        warn(
            line,
            format!("the horizontal angles end at {} degrees; the first ones follow", horizontal[horizontal.len() - 1]),
        );
    }
    if rows.iter().flatten().all(|candela| *candela == 0.0) {
        warn(line, "all candelas are 0: the lamp is dark".into());
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (horizontal, candela) = around.unfolded(&horizontal, &rows);
    Ok(Profile { name, vertical, horizontal, candela })
}

/// What follows `start` in a line, whatever the case of its letters.
fn in_capitals<'a>(line: &'a str, start: &str) -> Option<&'a str> {
    let line = line.trim();
    let begins = line.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start));
    begins.then(|| line[start.len()..].trim())
}

/// The year of the revision that the first line names; without a name it is the first one.
fn revision(first: &str) -> u32 {
    let first = first.to_ascii_uppercase();
    match first.as_str() {
        line if line.starts_with("IESNA91") => 1991,
        line if !line.starts_with("IES") => 1986,
        line => {
            [1986, 1991, 1995, 2002, 2019].into_iter().find(|year| line.contains(&year.to_string())).unwrap_or(2002)
        }
    }
}

/// How the horizontal angles of a file go around the lamp.
enum Around {
    /// One: the same all around.
    Even,
    /// 0 to 90: the same in each quadrant.
    Quadrants,
    /// 0 to 180: mirrored at the plane of 0 and 180.
    Halves,
    /// 90 to 270: mirrored at the plane of 90 and 270.
    TurnedHalves,
    /// 0 to 360.
    Whole,
    /// 0 to less than 360, by one step.
    Unclosed,
}

impl Around {
    fn of(angles: &[f32]) -> std::result::Result<Around, String> {
        let [first, last] = [angles[0], angles[angles.len() - 1]];
        let step = last - angles[angles.len().saturating_sub(2)];
        Ok(match (first, last) {
            _ if angles.len() == 1 => Around::Even,
            (0.0, 90.0) => Around::Quadrants,
            (0.0, 180.0) => Around::Halves,
            (90.0, 270.0) => Around::TurnedHalves,
            (0.0, 360.0) => Around::Whole,
            (0.0, last) if last > 180.0 && (last + step - 360.0).abs() < 0.01 => Around::Unclosed,
            _ => {
                return Err(format!(
                    "horizontal angles from {first} to {last} degrees; expected 0 alone, 0 to 90, 0 to 180, 90 to 270, or 0 to 360"
                ));
            }
        })
    }

    /// Angles from 0 to 360, or 0 alone, and the candelas of each.
    fn unfolded(&self, angles: &[f32], rows: &[Vec<f32>]) -> (Vec<f32>, Vec<f32>) {
        // Each angle of the whole turn, with the row that is the same.
        let own = || angles.iter().copied().zip(0..rows.len());
        let back = |sum: f32| own().rev().map(move |(angle, row)| (sum - angle, row));
        let turn: Vec<(f32, usize)> = match self {
            Around::Even => vec![(0.0, 0)],
            Around::Whole => own().collect(),
            Around::Unclosed => own().chain([(360.0, 0)]).collect(),
            Around::Halves => own().chain(back(360.0)).collect(),
            Around::Quadrants => {
                let half: Vec<(f32, usize)> = own().chain(back(180.0)).collect();
                let other: Vec<(f32, usize)> = half.iter().rev().map(|(angle, row)| (360.0 - angle, *row)).collect();
                [half, other].concat()
            }
            Around::TurnedHalves => {
                let before = back(180.0).filter(|(angle, _)| *angle >= 0.0);
                let behind = back(540.0).filter(|(angle, _)| *angle <= 360.0);
                before.chain(own()).chain(behind).collect()
            }
        };
        let mut angles = Vec::new();
        let mut candela = Vec::new();
        for (angle, row) in turn {
            // Where two mirror images meet there is one row twice.
            if angles.last() != Some(&angle) {
                angles.push(angle);
                candela.extend_from_slice(&rows[row]);
            }
        }
        (angles, candela)
    }
}

/// The numbers of a file, one after the other.
struct Numbers<'a> {
    path: &'a Path,
    /// Words that are left, with their line.
    words: Box<dyn Iterator<Item = (&'a str, usize)> + 'a>,
    /// That of the last number.
    line: usize,
}

impl<'a> Numbers<'a> {
    /// Those behind a line.
    fn behind(path: &'a Path, text: &'a str, line: usize) -> Self {
        let lines = text.lines().zip(1..).skip(line);
        let separates = |c: char| c.is_whitespace() || c == ',';
        let words = lines.flat_map(move |(text, line)| {
            text.split(separates).filter(|word| !word.is_empty()).map(move |word| (word, line))
        });
        Numbers { path, words: Box::new(words), line }
    }

    /// An error at the last number.
    fn error(&self, message: String) -> Error {
        Error::Parse { path: self.path.to_owned(), line: self.line, column: 0, message }
    }

    /// The next word, which no number is made of.
    fn peek(&mut self) -> Option<(&'a str, usize)> {
        self.words.next()
    }

    fn next(&mut self, what: &str) -> Result<f64> {
        let Some((word, line)) = self.words.next() else {
            return Err(self.error(format!("expected {what} behind this, and the file ends")));
        };
        self.line = line;
        let number = parse_number(word).filter(|number| number.is_finite());
        number.ok_or_else(|| self.error(format!("expected {what}, a number, found `{}`", shortened(word))))
    }

    fn above_0(&mut self, what: &str) -> Result<f64> {
        let number = self.next(what)?;
        if number > 0.0 {
            Ok(number)
        } else {
            Err(self.error(format!("expected {what}, above 0, found {}", digits(number))))
        }
    }

    fn count(&mut self, what: &str, least: u32) -> Result<u32> {
        let number = self.next(what)?;
        let whole = number.fract() == 0.0 && (f64::from(least)..=f64::from(u32::MAX / 4)).contains(&number);
        if whole {
            Ok(number as u32)
        } else {
            Err(self.error(format!("expected {what}, at least {least}, found {}", digits(number))))
        }
    }

    /// Type C.
    fn photometric_type(&mut self) -> Result<()> {
        let number = self.next("the photometric type")?;
        let what = match number {
            1.0 => return Ok(()),
            2.0 => "type B (2), of floodlights",
            3.0 => "type A (3), of headlights",
            _ => return Err(self.error(format!("expected the photometric type, 1, 2 or 3, found {}", digits(number)))),
        };
        Err(self.error(format!("the photometric type is {what}, which is not read: convert the file to type C (1)")))
    }

    /// Rising angles.
    fn angles(&mut self, which: &str, count: u32, most: f64) -> Result<Vec<f32>> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let angle = self.next(&format!("a {which} angle"))?;
            if !(0.0..=most).contains(&angle) {
                return Err(
                    self.error(format!("expected a {which} angle from 0 to {most} degrees, found {}", digits(angle)))
                );
            }
            if let Some(last) = angles.last().filter(|last| angle as f32 <= **last) {
                return Err(
                    self.error(format!("expected a {which} angle above {last}, found {angle}: they have to rise"))
                );
            }
            angles.push(angle as f32);
        }
        Ok(angles)
    }
}

/// A number for a message: one that would have many zeros by its exponent.
fn digits(number: f64) -> String {
    let short = number == 0.0 || (1e-5..1e9).contains(&number.abs());
    if short { number.to_string() } else { format!("{number:e}") }
}
