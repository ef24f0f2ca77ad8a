//! Sets of numbers that are joined with each other.

/// The numbers from 0 on in sets, as a forest (union and find, with path halving): each leads towards the least of its set, which stands for it.
#[derive(Debug, Clone, Default)]
pub(in crate::scene) struct Sets(Vec<u32>);

impl Sets {
    /// So many numbers, each a set of its own.
    pub fn new(count: usize) -> Self {
        Sets((0..count as u32).collect())
    }

    /// One more number, a set of its own.
    pub fn add(&mut self) {
        self.0.push(self.0.len() as u32);
    }

    /// The least number of the set that this one is in.
    pub fn of(&mut self, number: usize) -> usize {
        let mut number = number as u32;
        while self.0[number as usize] != number {
            let next = self.0[self.0[number as usize] as usize];
            self.0[number as usize] = next;
            number = next;
        }
        number as usize
    }

    /// Makes one set of those that two numbers are in.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b)] = a.min(b) as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_sets_are_known_by_their_least_number() {
        let mut sets = Sets::new(6);
        sets.join(4, 2);
        sets.join(5, 3);
        sets.join(3, 4);
        sets.add();
        sets.join(6, 0);
        let of: Vec<usize> = (0..7).map(|number| sets.of(number)).collect();
        assert_eq!(of, [0, 1, 2, 2, 2, 2, 0]);
    }
}
