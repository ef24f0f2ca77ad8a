//! Numbers as sentences have them.

use crate::chart::Series;

/// A share: `1.2 %`, and below a thousandth `3.1e-6`.
pub(super) fn share(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size < 1e-3 || !size.is_finite() => format!("{value:.1e}").replace(".0e", "e"),
        size if size < 0.1 || (size - 1.0).abs() < 0.05 => format!("{:.1} %", 100.0 * value),
        _ => format!("{:.0} %", 100.0 * value),
    }
}

/// A deviation with two standard errors: `-48 % +- 5.6 %`.
pub(super) fn deviation(value: f64, error: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{} +- {}", share(value), share(2.0 * error))
}

/// A count: `3`, `4200`, `1e6`.
pub(super) fn count(value: f64) -> String {
    if value.abs() < 1e5 { format!("{value:.0}") } else { format!("{value:.0e}") }
}

/// The first `x` from which on a series stays above a limit, or gives no number.
pub(super) fn above_from(series: &Series, limit: f64) -> Option<f64> {
    let last_good = series.points.iter().rposition(|p| p.y.abs() <= limit);
    series.points.get(last_good.map_or(0, |i| i + 1)).map(|p| p.x)
}

/// The largest value of a series, whatever its sign; infinite where it has a gap.
pub(super) fn largest(series: &Series) -> f64 {
    series.points.iter().map(|p| if p.y.is_nan() { f64::INFINITY } else { p.y.abs() }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Point;

    #[test]
    fn words() {
        assert_eq!(
            [0.0, 1.24e-5, 1e-4, 0.0125, 0.5, -0.998].map(share),
            ["0", "1.2e-5", "1e-4", "1.2 %", "50 %", "-99.8 %"]
        );
        assert_eq!(deviation(0.0125, 0.25), "+1.2 % +- 50 %");
        assert_eq!([3.0, 4200.0, 1e6].map(count), ["3", "4200", "1e6"]);
        let point = |(x, y)| Point { x, y, error: None };
        let series =
            |points: &[(f64, f64)]| Series { name: String::new(), points: points.iter().copied().map(point).collect() };
        let fails = series(&[(1.0, 0.5), (2.0, 0.1), (3.0, -0.4), (4.0, f64::NAN)]);
        assert_eq!((above_from(&fails, 0.2), above_from(&fails, 0.05)), (Some(3.0), Some(1.0)));
        assert_eq!(above_from(&series(&[(1.0, 0.1)]), 0.2), None);
        assert_eq!(largest(&fails), f64::INFINITY);
    }
}
