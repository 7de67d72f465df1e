//! Disjoint sets.

/// Sets of the numbers from 0 to `n − 1`: each number is in one set, and sets can be merged (Tarjan 1975).
#[derive(Clone, Debug)]
pub struct DisjointSets {
    /// For each number, a smaller one of its set, or the number itself if it is the smallest one.
    above: Vec<u32>,
}

impl DisjointSets {
    /// Returns `n` sets of one number each.
    #[must_use]
    pub fn new(n: u32) -> Self {
        Self { above: (0..n).collect() }
    }

    /// Returns the smallest number in the set of a number below `n`.
    pub fn first(&mut self, number: u32) -> u32 {
        let mut at = number as usize;
        while self.above[at] as usize != at {
            // Halves the path for the next time.
            self.above[at] = self.above[self.above[at] as usize];
            at = self.above[at] as usize;
        }
        at as u32
    }

    /// Merges the sets of two numbers below `n`.
    pub fn merge(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.above[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merged_sets_have_one_first_number() {
        let mut sets = DisjointSets::new(7);
        for (a, b) in [(5, 3), (6, 4), (3, 6), (2, 2)] {
            sets.merge(a, b);
        }
        let firsts: Vec<u32> = (0..7).map(|number| sets.first(number)).collect();
        assert_eq!(firsts, [0, 1, 2, 3, 3, 3, 3]);
    }
}
