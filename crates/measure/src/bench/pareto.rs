//! What nothing else beats.

/// By what part an error has to be smaller to be worth a higher cost: less is noise, or the rounding of another backend.
pub(super) const LEAST_GAIN: f64 = 0.05;

/// The Pareto front of points of a cost and an error: the numbers of those for which no other point is at most as dear and as exact, in
/// ascending order of the cost. An error counts as smaller if it is 5 % smaller. Points whose error is not above zero, or not finite, are no
/// measurement and never on the front.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let sound = |&i: &usize| points[i].0.is_finite() && points[i].1.is_finite() && points[i].1 > 0.0;
    let mut order: Vec<usize> = (0..points.len()).filter(sound).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].1 < (1.0 - LEAST_GAIN) * best;
        if better {
            best = points[i].1;
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
