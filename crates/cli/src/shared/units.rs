//! Numbers with their units, as people read them: shares in per cent, durations.

/// A share in per cent, with two digits that count.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent > 0.0 { (1.0 - percent.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    format!("{percent:.digits$} %")
}

/// Seconds in words: `0.42 s`, `42 s`, `3 min 5 s`, `2 h 10 min`.
pub fn duration(seconds: f64) -> String {
    if seconds < 9.95 {
        return format!("{seconds:.2} s");
    }
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_and_shares_are_short() {
        assert_eq!([0.42, 42.4, 185.0, 7800.0].map(duration), ["0.42 s", "42 s", "3 min 5 s", "2 h 10 min"]);
        let words = [0.0, 0.000_123, 0.0123, 0.0999, 0.123, 4.56].map(percent);
        assert_eq!(words, ["0 %", "0.012 %", "1.2 %", "10.0 %", "12 %", "456 %"]);
    }
}
