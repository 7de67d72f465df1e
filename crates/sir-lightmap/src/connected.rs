//! Connected sets, and vertices at equal places.

use std::collections::HashMap;
use std::hash::Hash;

/// Sets of numbers that are joined step by step (union–find).
pub(crate) struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    /// Creates a set for each of `count` numbers.
    pub(crate) fn new(count: u32) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// Returns the number that stands for the set of a number.
    pub(crate) fn root(&mut self, mut of: u32) -> u32 {
        while self.parents[of as usize] != of {
            self.parents[of as usize] = self.parents[self.parents[of as usize] as usize];
            of = self.parents[of as usize];
        }
        of
    }

    /// Joins the sets of three numbers.
    pub(crate) fn join(&mut self, numbers: [u32; 3]) {
        let roots = numbers.map(|number| self.root(number));
        let least = roots[0].min(roots[1]).min(roots[2]);
        roots.iter().for_each(|&root| self.parents[root as usize] = least);
    }
}

/// Returns a number for each key, in the order of their first occurrence; equal keys have the same. Also returns how many
/// there are.
pub(crate) fn numbers<K: Eq + Hash>(keys: impl Iterator<Item = K>) -> (Vec<u32>, u32) {
    let mut known: HashMap<K, u32> = HashMap::new();
    let number = |key| {
        let next = known.len() as u32;
        *known.entry(key).or_insert(next)
    };
    let all: Vec<u32> = keys.map(number).collect();
    (all, known.len() as u32)
}
