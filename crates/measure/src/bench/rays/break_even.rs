//! From how many rays on a structure that takes longer to build, and is faster to trace, is worth it.

use crate::report::words::number;

/// What an intersector takes: to build, and by the ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Seconds before the first ray.
    pub build: f64,
    /// Seconds a ray.
    pub ray: f64,
}

/// Which of two intersectors is done first, building and tracing together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BreakEven {
    /// The first, for any number of rays.
    First,
    /// The second, for any number of rays.
    Second,
    /// The first below this number of rays, and the second above.
    SecondFrom(f64),
    /// The second below this number of rays, and the first above.
    FirstFrom(f64),
    /// A cost is not a number.
    Unknown,
}

impl BreakEven {
    /// Compares two intersectors.
    pub fn of(first: Cost, second: Cost) -> Self {
        // Both take the same for this many rays.
        let rays = (second.build - first.build) / (first.ray - second.ray);
        let numbers = [first.build, first.ray, second.build, second.ray];
        match (first.build <= second.build, first.ray <= second.ray) {
            _ if numbers.iter().any(|n| !n.is_finite()) => BreakEven::Unknown,
            (true, true) => BreakEven::First,
            (false, false) => BreakEven::Second,
            (true, false) => BreakEven::SecondFrom(rays),
            (false, true) => BreakEven::FirstFrom(rays),
        }
    }

    /// In words, by the names of the two.
    pub(super) fn words(self, first: &str, second: &str) -> String {
        match self {
            BreakEven::First => format!("{first} always"),
            BreakEven::Second => format!("{second} always"),
            BreakEven::SecondFrom(rays) => format!("{second} from {} rays on", number(rays)),
            BreakEven::FirstFrom(rays) => format!("{first} from {} rays on", number(rays)),
            BreakEven::Unknown => "-".into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_later_lines_cross_or_do_not() {
        let cost = |build, ray| Cost { build, ray };
        assert_eq!(BreakEven::of(cost(1.0, 1.0), cost(2.0, 2.0)), BreakEven::First);
        assert_eq!(BreakEven::of(cost(3.0, 3.0), cost(2.0, 2.0)), BreakEven::Second);
        assert_eq!(BreakEven::of(cost(1.0, 0.5), cost(2.0, 0.25)), BreakEven::SecondFrom(4.0));
        assert_eq!(BreakEven::of(cost(2.0, 0.25), cost(1.0, 0.5)), BreakEven::FirstFrom(4.0));
        assert_eq!(BreakEven::of(cost(2.0, f64::NAN), cost(1.0, 0.5)), BreakEven::Unknown);
        let words = BreakEven::of(cost(1.0, 1e-6), cost(2.0, 0.5e-6)).words("one", "other");
        assert_eq!(words, "other from 2.00e6 rays on");
    }
}
