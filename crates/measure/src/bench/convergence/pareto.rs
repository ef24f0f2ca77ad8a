//! The Pareto front: those renders that no other one beats in both time and error.

/// By what part an error has to be smaller to be worth a higher cost: less is noise, or the rounding of another backend.
pub(super) const LEAST_GAIN: f64 = 0.05;

/// A render that may be on the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// What it costs: seconds.
    pub cost: f64,
    /// How far off it is: relMSE.
    pub error: f64,
}

/// The Pareto front: the indices of those candidates that no other one equals or surpasses in both cost and error, in ascending order of the
/// cost. An error counts as smaller if it is 5 % smaller. A candidate whose error is not above zero, or not finite, is no measurement and
/// never on the front.
pub fn front(candidates: &[Candidate]) -> Vec<usize> {
    let sound = |&i: &usize| {
        let Candidate { cost, error } = candidates[i];
        cost.is_finite() && error.is_finite() && error > 0.0
    };
    let mut order: Vec<usize> = (0..candidates.len()).filter(sound).collect();
    let by_cost = |a: &Candidate, b: &Candidate| a.cost.total_cmp(&b.cost).then(a.error.total_cmp(&b.error));
    order.sort_by(|&a, &b| by_cost(&candidates[a], &candidates[b]));
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = candidates[i].error < (1.0 - LEAST_GAIN) * best;
        if better {
            best = candidates[i].error;
        }
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_beats_the_front_and_something_beats_the_rest() {
        let candidate = |(cost, error): (f64, f64)| Candidate { cost, error };
        let front = |points: &[(f64, f64)]| front(&points.iter().copied().map(candidate).collect::<Vec<_>>());
        let points = [
            (4.0, 1.0),
            (1.0, 10.0),
            (2.0, 12.0), // dearer and worse than the second
            (2.0, 5.0),
            (2.0, 6.0), // as dear as the one before, and worse
            (3.0, 5.0), // as wrong, and dearer
            (2.0, 5.0), // the same again
            (0.5, f64::NAN),
            (0.5, 0.0),
            (f64::INFINITY, 0.1),
        ];
        assert_eq!(front(&points), [1, 3, 0]);
        assert!(front(&[]).is_empty() && front(&[(1.0, f64::NAN)]).is_empty());
        // Slightly better is not worth more; slightly better again and again is.
        assert_eq!(front(&[(1.0, 1.0), (2.0, 0.97), (3.0, 0.94), (4.0, 0.92)]), [0, 2]);
        // Against the definition, on many points that share costs and errors.
        let random = |i: u32| luminaire::sampling::random4(i, 0, 0, 0).map(|v| f64::from(v % 8));
        let many: Vec<_> = (0..200).map(|i| (random(i)[0], 1.0 + random(i)[1] + random(i)[2])).collect();
        let dominated = |a: (f64, f64)| many.iter().any(|b| b.0 <= a.0 && b.1 <= a.1 && *b != a);
        let found: Vec<_> = front(&many).into_iter().map(|i| many[i]).collect();
        assert!(found.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1));
        for point in &many {
            assert_eq!(found.contains(point), !dominated(*point), "{point:?}");
        }
    }
}
