//! The processes that work on one run.

/// The processes, or *ranks*, that work on one run together.
///
/// All that they ever need is the sum of whole numbers over all ranks: a number that only one of them knows reaches the others
/// by being added to their zeros, and what is true of some rank is true if a count of them is not zero.
pub trait Communicator {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;

    /// How many processes there are.
    fn size(&self) -> usize;

    /// Replaces every number by its sum over all ranks. All ranks must call this with equally many numbers.
    fn sum(&self, words: &mut [i64]);

    /// Whether this is the rank that prints and writes.
    fn is_first(&self) -> bool {
        self.rank() == 0
    }

    /// The first of the ranks for which `failed` is true. This is how all of them learn that one cannot go on.
    fn first_failed(&self, failed: bool) -> Option<usize> {
        let mut who = vec![0; self.size()];
        who[self.rank()] = i64::from(failed);
        self.sum(&mut who);
        who.iter().position(|&failed| failed != 0)
    }

    /// Replaces the numbers of all ranks by those of the first.
    fn broadcast(&self, words: &mut [i64]) {
        if !self.is_first() {
            words.fill(0);
        }
        self.sum(words);
    }
}

/// One process by itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct SingleProcess;

impl Communicator for SingleProcess {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn sum(&self, _words: &mut [i64]) {}
}
