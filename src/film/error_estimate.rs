//! How far a picture as a whole is from the truth, and how that is said.

/// How far a picture as a whole is from the truth, without its fireflies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorEstimate {
    /// Root of the mean square of the error, over pixels and channels.
    pub rmse: f64,
    /// relMSE as [`REL_MSE`](crate::film::REL_MSE) defines it: it does not depend on the unit of the radiance.
    pub rel_mse: f64,
    /// What `rel_mse` is taken for where a promise depends on it, as a limit of the noise does: larger than `rel_mse`, and by more where that is less sure. The mean
    /// (geometric) of `rel_mse` and of what it would be if samples were independent, times what chance may do where few pixels hold the error.
    pub careful_rel_mse: f64,
    /// Pixels that are left out because they stand out of their neighbours by what few samples hold.
    pub fireflies: u64,
    /// Pixels that are left out because they have samples in fewer than two blocks, which tells nothing.
    pub unknown: u64,
    /// `rel_mse` with the fireflies, as if their neighbours showed what they should look like. Where it is much larger, the picture either has fireflies or
    /// has not seen enough of its light.
    pub rel_mse_with_fireflies: f64,
}

impl ErrorEstimate {
    /// The relative error: the root of [`ErrorEstimate::rel_mse`].
    pub fn relative(&self) -> f64 {
        self.rel_mse.sqrt()
    }

    /// What is promised of it: the root of [`ErrorEstimate::careful_rel_mse`].
    pub fn careful(&self) -> f64 {
        self.careful_rel_mse.sqrt()
    }

    /// The same with the fireflies.
    pub fn relative_with_fireflies(&self) -> f64 {
        self.rel_mse_with_fireflies.sqrt()
    }

    /// Whether the fireflies hold more than half of the squared error: then [`ErrorEstimate::relative`] is not the whole truth.
    pub fn is_mostly_fireflies(&self) -> bool {
        self.rel_mse_with_fireflies > 2.0 * self.rel_mse
    }

    /// The relative error as people read it: `2.3 %`, or `2.3 % (55 % with fireflies)` where they hold most of it.
    pub fn in_words(&self) -> String {
        let words = relative_in_words(self.relative());
        if self.is_mostly_fireflies() {
            format!("{words} ({} with fireflies)", relative_in_words(self.relative_with_fireflies()))
        } else {
            words
        }
    }
}

/// A relative error in per cent with two digits that count. It is never `0 %`: that all samples agree is no proof that they are right.
pub fn relative_in_words(relative: f64) -> String {
    let percent = 100.0 * relative;
    match percent {
        0.0 => "no noise".into(),
        ..0.001 => "below 0.001 %".into(),
        1000.0.. => "above 1000 %".into(),
        _ => format!("{percent:.*} %", (1.0 - percent.log10().floor()).clamp(0.0, 4.0) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_said_with_its_fireflies_and_never_as_nothing() {
        let words = [0.0, 1e-9, 1.23e-5, 0.000_123, 0.0123, 0.123, 4.56, 1e9].map(relative_in_words);
        let expected = ["no noise", "below 0.001 %", "0.0012 %", "0.012 %", "1.2 %", "12 %", "456 %", "above 1000 %"];
        assert_eq!(words, expected);
        let error = ErrorEstimate {
            rmse: 1.0,
            rel_mse: 0.0004,
            careful_rel_mse: 0.0005,
            fireflies: 1,
            unknown: 0,
            rel_mse_with_fireflies: 0.0007,
        };
        assert_eq!(error.in_words(), "2.0 %");
        let fireflies = ErrorEstimate { rel_mse_with_fireflies: 0.25, ..error };
        assert_eq!(fireflies.in_words(), "2.0 % (50 % with fireflies)");
        assert_eq!(ErrorEstimate { rel_mse: 0.0, ..fireflies }.in_words(), "no noise (50 % with fireflies)");
    }
}
