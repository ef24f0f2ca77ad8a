//! Choosing one of many by weight, in their order: neighbouring numbers choose neighbours, so that numbers that are spread out evenly choose
//! what is spread out, too.

/// As many numbers are told apart: the upper 31 of 32 random bits, so that the end of the last entry fits into 32.
pub const CDF_NUMBERS: u32 = 1 << 31;

/// A cumulative distribution over integers, so that the CPU and the GPU choose the same entry from the same random bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cdf {
    /// The first number of each entry, and [`CDF_NUMBERS`]. An entry without any begins where the next one does.
    pub starts: Vec<u32>,
}

impl Cdf {
    /// A distribution over `weights`, which are finite and not negative, and at least one. Every weight above zero gets a number at least. Where
    /// all are zero the last entry has all numbers.
    pub fn new(weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let mut starts = Vec::with_capacity(weights.len() + 1);
        let (mut sum, mut start) = (0.0, 0);
        for weight in weights {
            // What lies before; rounded, but behind the number that the entry before it has at least.
            start = start.max((sum / total * f64::from(CDF_NUMBERS)).round() as u32);
            starts.push(start);
            start += u32::from(*weight > 0.0);
            sum += weight;
        }
        let mut end = CDF_NUMBERS;
        starts.push(end);
        // And so that those at the end have one.
        for (start, weight) in starts.iter_mut().zip(weights).rev() {
            end = (*start).min(end - u32::from(*weight > 0.0));
            *start = end;
        }
        Cdf { starts }
    }

    /// The probability with which a random number chooses an entry: as many as there are, to the last one. They add up to 1.
    pub fn probability(&self, entry: usize) -> f64 {
        f64::from(self.starts[entry + 1] - self.starts[entry]) / f64::from(CDF_NUMBERS)
    }

    /// The entry that 32 random bits choose, and how far into it they fall: in (0, 1), evenly, and with the number.
    pub fn choose(&self, random: u32) -> (usize, f64) {
        let number = random >> 1;
        let entry = self.starts.partition_point(|start| *start <= number) - 1;
        let (start, end) = (self.starts[entry], self.starts[entry + 1]);
        (entry, (f64::from(number - start) + 0.5) / f64::from(end - start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::random4;

    /// Of all numbers each entry has those that its probability counts, in order, whatever the weights: a sun and a sky of 2^22 entries that has
    /// 1 % of the light, or so little of it that no number stood for it; black ones at both ends.
    #[test]
    fn probabilities_are_exact_with_many_entries() {
        let n = (1usize << 22) + 1;
        for sky in [1e-2, 1e-12, 1e-300] {
            let mut weights = vec![sky / (n - 1) as f64; n];
            weights[n / 3] = 1.0 - sky;
            weights[..1000].fill(0.0);
            weights[n - 1000..].fill(0.0);
            let cdf = Cdf::new(&weights);
            assert_eq!((cdf.starts.len(), cdf.starts[0], cdf.starts[n]), (n + 1, 0, CDF_NUMBERS));
            let mut sum = 0.0;
            for (entry, weight) in weights.iter().enumerate() {
                let probability = cdf.probability(entry);
                sum += probability;
                // Each end is rounded; and of those that would have none each takes one from the sun.
                let lost = if entry == n / 3 { n as f64 } else { 1.0 };
                assert!((probability > 0.0) == (*weight > 0.0), "{entry}: {probability} of {weight}");
                assert!(
                    (probability - weight).abs() * f64::from(CDF_NUMBERS) <= lost + 1e-6 * probability,
                    "{entry}: {probability} of {weight}"
                );
                let (first, last) = (cdf.starts[entry] << 1, (cdf.starts[entry + 1] - 1) << 1 | 1);
                if probability > 0.0 && (entry % 4096 == 0 || entry == n / 3) {
                    assert_eq!((cdf.choose(first).0, cdf.choose(last).0), (entry, entry));
                }
            }
            assert_eq!(sum, 1.0);
        }
    }

    /// The place goes evenly from one end of an entry to the other; and entries have their share of random numbers.
    #[test]
    fn numbers_go_through_the_entries_in_order() {
        let weights = [0.0, 1.0, 0.0, 5.0, 0.25, 3.75, 0.0];
        let cdf = Cdf::new(&weights);
        let mut counts = [0.0; 7];
        for i in 0..100_000 {
            let number = random4(i, 0, 0, 0)[0];
            let (entry, place) = cdf.choose(number);
            assert!(place > 0.0 && place < 1.0);
            let before: f64 = weights[..entry].iter().sum();
            let expected = f64::from(number) / 4_294_967_296.0 * 10.0;
            assert!((before + place * weights[entry] - expected).abs() < 1e-7, "{number}: {entry}, {place}");
            counts[entry] += 1.0;
        }
        assert!(
            counts.iter().zip(weights).all(|(count, w)| (count - w * 1e4).abs() <= 5.0 * (w * 1e4).sqrt()),
            "{counts:?}"
        );
    }

    /// One entry has all numbers, and so has the last one where nothing weighs anything: that nobody chooses, but it is a distribution.
    #[test]
    fn one_entry_and_none() {
        assert_eq!(Cdf::new(&[3.0]).starts, [0, CDF_NUMBERS]);
        assert_eq!(Cdf::new(&[0.0; 3]).starts, [0, 0, 0, CDF_NUMBERS]);
        let (entry, place) = Cdf::new(&[3.0]).choose(u32::MAX);
        assert!(entry == 0 && place < 1.0);
    }
}
