//! Parsers for the values of options; their errors say what is expected.

use std::ops::Range;

/// Seconds above 0.
pub fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        // A clock's time plus more than about a thousand years may overflow.
        Ok(seconds) if seconds > 0.0 && seconds < 3.2e10 => Ok(seconds),
        _ => Err(match in_seconds(text) {
            Some(seconds) => format!("seconds are written alone: {seconds}"),
            None => "expected a number of seconds above 0, for example 30 or 0.5".into(),
        }),
    }
}

/// Seconds that are written with a unit: `90s`, `5m`, `5min`, `2h`.
fn in_seconds(text: &str) -> Option<f64> {
    let number = text.trim_end_matches(char::is_alphabetic);
    let factor = match text[number.len()..].to_lowercase().as_str() {
        "s" | "sec" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return None,
    };
    number.trim().parse::<f64>().ok().filter(|number| *number > 0.0).map(|number| number * factor)
}

/// A relative error above 0, and no more than 1: nobody wants 200 %, but many mean 2 %.
pub fn noise(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(noise) if noise > 0.0 && noise <= 1.0 => Ok(noise),
        Ok(noise) if noise > 1.0 && noise <= 100.0 => {
            Err(format!("expected a relative error of at most 1; if {noise} % is meant, that is {}", noise / 100.0))
        }
        _ => Err("expected a relative error above 0 and at most 1, for example 0.02 for 2 %".into()),
    }
}

/// A pixel of the film: column and row, counted from 0 at the upper left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pixel {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
}

/// A pixel, as `X,Y`.
pub fn pixel(text: &str) -> Result<Pixel, String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
        Some((Some(x), Some(y))) => Ok(Pixel { x, y }),
        _ => Err("expected column and row of a pixel, counted from 0 at the upper left, for example 12,40".into()),
    }
}

/// A rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    /// Column of the left pixels, counted from 0.
    pub x: u32,
    /// Row of the upper pixels, counted from 0 at the top.
    pub y: u32,
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
}

/// A rectangle of pixels, as `X,Y,W,H`.
pub fn rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Rectangle { x, y, width, height }),
        _ => Err("expected the left column and the upper row of a rectangle of pixels, counted from 0 at the upper left of the picture, and its width \
                  and height, at least 1, for example 320,180,640,360"
            .into()),
    }
}

/// A number from 0.
pub fn limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(limit) if limit >= 0.0 && limit.is_finite() => Ok(limit),
        _ => Err("expected a number from 0, for example 0.01".into()),
    }
}

/// An exposure in stops.
pub fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(stops) if stops.abs() <= 64.0 => Ok(stops),
        _ => Err("expected a number of stops from -64 to 64, for example 1.5".into()),
    }
}

/// Numbers of frames, as `A..B`.
pub fn frames(text: &str) -> Result<Range<u32>, String> {
    let expected =
        "expected the numbers of the first frame and of the one after the last, for example 0..60 or 60..120";
    range(text).map_err(|_| expected.to_owned())
}

/// How many frames a turn has.
pub fn turntable(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(frames) if (1..=MOST_FRAMES).contains(&frames) => Ok(frames),
        _ => Err(format!("expected the number of frames of a whole turn, from 1 to {MOST_FRAMES}, for example 120")),
    }
}

/// Five minutes and a half at 30 frames a second.
const MOST_FRAMES: u32 = 10_000;

/// Numbers of samples, as `A..B`.
pub fn range(text: &str) -> Result<Range<u32>, String> {
    let pair = |between: &str| {
        let (a, b) = text.split_once(between)?;
        Some(a.trim().parse().ok()?..b.trim().parse().ok()?).filter(|range: &Range<u32>| range.start < range.end)
    };
    if let Some(range) = pair("..") {
        return Ok(range);
    }
    let advice = match ["-", ":", ","].into_iter().find_map(pair) {
        Some(Range { start, end }) => format!("; say {start}..{end}"),
        None if text.parse::<u32>().is_ok() => format!("; for {text} samples of every pixel say --spp {text}"),
        None => String::new(),
    };
    Err(format!(
        "expected the numbers of the first sample and of the one after the last, for example 0..64 or 64..128{advice}"
    ))
}
