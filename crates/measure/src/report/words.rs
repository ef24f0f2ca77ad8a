//! Numbers as tables and sentences have them.

use crate::statistics::Estimate;

/// Three digits, with an exponent where there would be many zeros; `-` for what is no number.
pub fn number(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "-".into(),
        0.0 => "0".into(),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.2e}"),
        size => format!("{value:.*}", (2 - size.log10().floor() as i32).max(0) as usize),
    }
}

/// Bytes in binary units.
pub fn bytes(count: f64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB"];
    let step = (0..units.len() - 1).take_while(|step| count >= 1024f64.powi(*step as i32 + 1)).count();
    if step == 0 {
        format!("{count:.0} bytes")
    } else {
        format!("{} {}", number(count / 1024f64.powi(step as i32)), units[step])
    }
}

/// A share: `1.2 %`, and below a thousandth `3.1e-6`.
pub fn share(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size < 1e-3 || !size.is_finite() => format!("{value:.1e}").replace(".0e", "e"),
        size if size < 0.1 || (size - 1.0).abs() < 0.05 => format!("{:.1} %", 100.0 * value),
        _ => format!("{:.0} %", 100.0 * value),
    }
}

/// A deviation with two standard errors: `-48 % +- 5.6 %`.
pub fn deviation(value: f64, error: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{} +- {}", share(value), share(2.0 * error))
}

/// A count: `3`, `4200`, `1e6`.
pub fn count(value: f64) -> String {
    if value.abs() < 1e5 { format!("{value:.0}") } else { format!("{value:.0e}") }
}

/// A mean with its standard error in units of the last digit: `0.2003(12)`.
pub fn with_error(Estimate { mean, error }: Estimate) -> String {
    let digits = decimals(error);
    format!("{mean:.digits$}({:.0})", error * 10f64.powi(digits as i32))
}

/// Decimals that show two digits of an error.
pub fn decimals(error: f64) -> usize {
    if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize } else { 6 }
}

/// A sentence or a heading begins with a capital.
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// A text without line breaks, and with one space where it has more.
pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_bytes() {
        assert_eq!(
            [0.0, 1.234, 12.34, 1234.5, 1e-5, -2e6].map(number),
            ["0", "1.23", "12.3", "1234", "1.00e-5", "-2.00e6"]
        );
        assert_eq!([f64::NAN, f64::INFINITY].map(number), ["-", "-"]);
        assert_eq!([10.0, 2048.0, 3.5 * 1048576.0].map(bytes), ["10 bytes", "2.00 KiB", "3.50 MiB"]);
    }

    #[test]
    fn shares_and_counts() {
        assert_eq!(
            [0.0, 1.24e-5, 1e-4, 0.0125, 0.5, -0.998].map(share),
            ["0", "1.2e-5", "1e-4", "1.2 %", "50 %", "-99.8 %"]
        );
        assert_eq!(deviation(0.0125, 0.25), "+1.2 % +- 50 %");
        assert_eq!([3.0, 4200.0, 1e6].map(count), ["3", "4200", "1e6"]);
    }

    #[test]
    fn errors_in_units_of_the_last_digit() {
        assert_eq!(with_error(Estimate { mean: 0.20034, error: 0.0012 }), "0.2003(12)");
        assert_eq!(with_error(Estimate { mean: 19.98, error: 0.25 }), "19.98(25)");
        assert_eq!(with_error(Estimate { mean: 1.0, error: 0.0 }), "1.000000(0)");
    }

    #[test]
    fn sentences_begin_with_a_capital() {
        assert_eq!(["", "by rounding", "CPU"].map(capital), ["", "By rounding", "CPU"]);
        assert_eq!(one_line(" a\n b  c "), "a b c");
    }
}
