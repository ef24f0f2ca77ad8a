//! Where a line of a chart leaves a limit, and how far.

use crate::chart::Series;

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
    fn lines_leave_their_limits() {
        let point = |(x, y)| Point { x, y, error: None };
        let series =
            |points: &[(f64, f64)]| Series { name: String::new(), points: points.iter().copied().map(point).collect() };
        let fails = series(&[(1.0, 0.5), (2.0, 0.1), (3.0, -0.4), (4.0, f64::NAN)]);
        assert_eq!((above_from(&fails, 0.2), above_from(&fails, 0.05)), (Some(3.0), Some(1.0)));
        assert_eq!(above_from(&series(&[(1.0, 0.1)]), 0.2), None);
        assert_eq!(largest(&fails), f64::INFINITY);
    }
}
