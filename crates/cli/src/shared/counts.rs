//! Parsers for whole numbers of things; their errors say what is expected, and what other ways of writing mean.

/// A width or a height in pixels, from `LEAST` to `MOST`.
pub fn pixels<const LEAST: u32, const MOST: u32>(text: &str) -> Result<u32, String> {
    if let Ok(pixels) = text.parse::<u32>()
        && (LEAST..=MOST).contains(&pixels)
    {
        return Ok(pixels);
    }
    let sides: Vec<&str> = text.split(['x', 'X', '*', ',', ':', '\u{d7}']).map(str::trim).collect();
    Err(match sides[..] {
        [width, height] if [width, height].iter().all(|side| side.parse::<u32>().is_ok()) => {
            format!("that is two numbers: say --width {width} --height {height}")
        }
        _ => format!("expected a whole number of pixels from {LEAST} to {MOST}, for example 640"),
    })
}

/// Samples a pixel, at least 1.
pub fn samples(text: &str) -> Result<u32, String> {
    if let Ok(samples @ 1..) = text.parse::<u32>() {
        return Ok(samples);
    }
    let thousands =
        text.strip_suffix(['k', 'K']).and_then(|text| text.parse::<f64>().ok()).map(|number| 1000.0 * number);
    let whole = text.parse::<f64>().ok().or(thousands);
    let whole = whole.filter(|number| number.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(number));
    Err(match whole {
        Some(number) => format!("write it as a whole number: {number}"),
        None => "expected a whole number of samples from 1 to 4294967295, for example 64".into(),
    })
}

/// The seed of the random numbers.
pub fn seed(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "expected a whole number from 0 to 4294967295".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_ways_of_writing_are_answered_in_this_one() {
        let size = pixels::<16, 1000>;
        assert_eq!((size("16"), size("1000")), (Ok(16), Ok(1000)));
        for (text, says) in [
            ("1920x1080", "--width 1920 --height 1080"),
            ("1920 x 1080", "--width 1920 --height 1080"),
            ("640,480", "--width 640 --height 480"),
            ("15", "from 16 to 1000"),
            ("50%", "whole number of pixels"),
            ("-4", "from 16"),
            ("x", "whole number"),
        ] {
            assert!(size(text).unwrap_err().contains(says), "{text}: {:?}", size(text));
        }
        assert_eq!((samples("1"), samples("4294967295")), (Ok(1), Ok(u32::MAX)));
        for (text, says) in
            [("1e3", "1000"), ("64.0", "64"), ("4k", "4000"), ("0", "from 1"), ("0.5", "from 1"), ("many", "from 1")]
        {
            assert!(samples(text).unwrap_err().contains(says), "{text}: {:?}", samples(text));
        }
        assert!(seed("-1").is_err() && seed("4294967295") == Ok(u32::MAX));
    }
}
