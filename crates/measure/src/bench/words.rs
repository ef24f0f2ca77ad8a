//! Numbers as tables and sentences have them.

/// Three digits, with an exponent where there would be many zeros; `-` for what is no number.
pub(super) fn number(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "-".into(),
        0.0 => "0".into(),
        size if !(1e-3..1e5).contains(&size) => format!("{value:.2e}"),
        size => format!("{value:.*}", (2 - size.log10().floor() as i32).max(0) as usize),
    }
}

/// `1.20 (1.10 to 1.31)`; the number alone where there is only one.
pub(super) fn with_spread([median, least, most]: [f64; 3]) -> String {
    if least == most { number(median) } else { format!("{} ({} to {})", number(median), number(least), number(most)) }
}

/// Bytes in binary units.
pub(super) fn bytes(count: f64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB"];
    let step = (0..units.len() - 1).take_while(|step| count >= 1024f64.powi(*step as i32 + 1)).count();
    if step == 0 {
        format!("{count:.0} bytes")
    } else {
        format!("{} {}", number(count / 1024f64.powi(step as i32)), units[step])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words() {
        assert_eq!(
            [0.0, 1.234, 12.34, 1234.5, 1e-5, -2e6].map(number),
            ["0", "1.23", "12.3", "1234", "1.00e-5", "-2.00e6"]
        );
        assert_eq!([f64::NAN, f64::INFINITY].map(number), ["-", "-"]);
        assert_eq!(with_spread([2.0, 1.0, 3.0]), "2.00 (1.00 to 3.00)");
        assert_eq!(with_spread([2.0; 3]), "2.00");
        assert_eq!([10.0, 2048.0, 3.5 * 1048576.0].map(bytes), ["10 bytes", "2.00 KiB", "3.50 MiB"]);
    }
}
