//! Choosing one of many by weight, in constant time.

/// An alias table (Walker 1977, built by Vose's method) over integer thresholds, so that the CPU and the GPU choose the
/// same entry from the same 32 random bits.
#[derive(Debug, Clone, Default)]
pub struct AliasTable {
    /// `(threshold, alias)` of each slot.
    pub slots: Vec<(u32, u32)>,
    /// The probability of each entry; they add up to 1.
    pub pdf: Vec<f64>,
}

impl AliasTable {
    /// A table over `weights`, which are finite, not negative, and not all zero (unless empty).
    pub fn new(weights: &[f64]) -> Self {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        let pdf: Vec<f64> = weights.iter().map(|w| w / total).collect();
        let mut share: Vec<f64> = pdf.iter().map(|p| p * n as f64).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

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
