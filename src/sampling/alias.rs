//! Choosing one of many by weight, in constant time.

/// An alias table (Walker 1977, built by Vose's method) over integer thresholds, so that the CPU and the GPU choose the
/// same entry from the same 32 random bits.
#[derive(Debug, Clone, Default)]
pub struct AliasTable {
    /// `(threshold, alias)` of each slot.
    pub slots: Vec<(u32, u32)>,
    /// The probability with which 32 random bits choose each entry: what is in the slots, to the last number, so that it is exact even where
    /// there are so many slots that rounding matters. They add up to 1.
    pub pdf: Vec<f64>,
}

impl AliasTable {
    /// A table over `weights`, which are finite, not negative, and not all zero (unless empty).
    pub fn new(weights: &[f64]) -> Self {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        let mut share: Vec<f64> = weights.iter().map(|w| w / total * n as f64).collect();
        let mut slots: Vec<(u32, u32)> = (0..n as u32).map(|i| (u32::MAX, i)).collect();
        let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| share[i] < 1.0);
        while let (Some(&s), Some(&l)) = (small.last(), large.last()) {
            small.pop();
            slots[s] = ((share[s] * 4_294_967_296.0) as u32, l as u32);
            share[l] -= 1.0 - share[s];
            if share[l] < 1.0 {
                large.pop();
                small.push(l);
            }
        }
        let pdf = realised(&slots);
        AliasTable { slots, pdf }
    }

    /// The entry that 32 random bits stand for: the upper half of `random * n` is the slot, the lower half decides.
    ///
    /// # Panics
    /// If the table is empty.
    pub fn choose(&self, random: u32) -> usize {
        let product = u64::from(random) * self.slots.len() as u64;
        let slot = (product >> 32) as usize;
        let (threshold, alias) = self.slots[slot];
        if (product as u32) < threshold { slot } else { alias as usize }
    }
}

/// Counts the numbers for which [`AliasTable::choose`] gives each entry. Of `2^32 / n` numbers a slot can keep only whole ones, which for
/// millions of slots is not what it asked for.
fn realised(slots: &[(u32, u32)]) -> Vec<f64> {
    let n = slots.len() as u64;
    let mut counts = vec![0u64; slots.len()];
    for (slot, (threshold, alias)) in slots.iter().enumerate() {
        let start = (slot as u64) << 32;
        let first = start.div_ceil(n);
        let cut = (start + u64::from(*threshold)).div_ceil(n);
        let next = (start + (1 << 32)).div_ceil(n);
        counts[slot] += cut - first;
        counts[*alias as usize] += next - cut;
    }
    counts.into_iter().map(|count| count as f64 / 4_294_967_296.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With millions of slots the probabilities are those of the numbers there are: a sun and a sky of 2^22 texels that has 1 % of the light.
    #[test]
    fn probabilities_are_exact_with_many_slots() {
        let n = (1usize << 22) + 1;
        let mut weights = vec![0.01 / (n - 1) as f64; n];
        weights[n / 3] = 0.99;
        let table = AliasTable::new(&weights);
        assert!((table.pdf.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let tried = 1u32 << 22;
        // Even steps through all numbers, not a divisor of the slots.
        let suns = (0..tried).filter(|i| table.choose(i << 10 | 0x155) == n / 3).count();
        let found = suns as f64 / f64::from(tried);
        let expected = table.pdf[n / 3];
        let error = (expected * (1.0 - expected) / f64::from(tried)).sqrt();
        assert!((found - expected).abs() < 5.0 * error, "{found}, expected {expected}");
    }

    #[test]
    fn frequencies_match_the_weights() {
        let weights = [1.0, 0.0, 5.0, 0.25, 3.75];
        let table = AliasTable::new(&weights);
        let n = 1_000_000u32;
        let mut count = [0u32; 5];
        for i in 0..n {
            // A full period of evenly spaced bits: the counts are exact up to one step a slot boundary.
            count[table.choose((u64::from(i) * (1 << 32) / u64::from(n)) as u32)] += 1;
        }
        for (c, w) in count.iter().zip(weights) {
            let expected = w / 10.0 * f64::from(n);
            assert!((f64::from(*c) - expected).abs() <= 5.0, "{count:?}");
        }
    }
}
