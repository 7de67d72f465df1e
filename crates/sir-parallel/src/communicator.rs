//! Communication between the processes of a run.

/// Processes, or *ranks*, that work on one run together.
///
/// The only collective operation is the integer sum over all ranks. A broadcast is a sum to which all other ranks
/// contribute zeros; a logical or is a count that is not zero.
pub trait Communicator {
    /// Returns the number of this process, from 0.
    fn rank(&self) -> usize;

    /// Returns the number of processes.
    fn size(&self) -> usize;

    /// Replaces every number by its sum over all ranks. All ranks must call this with the same number of words.
    fn sum(&self, words: &mut [i64]);

    /// Returns true for the rank that prints and writes files.
    fn is_first(&self) -> bool {
        self.rank() == 0
    }

    /// Returns the first rank for which `failed` is true, so that all ranks learn that one of them cannot continue.
    fn first_failed(&self, failed: bool) -> Option<usize> {
        let mut who = vec![0; self.size()];
        who[self.rank()] = i64::from(failed);
        self.sum(&mut who);
        who.iter().position(|&failed| failed != 0)
    }

    /// Replaces the numbers of all ranks by those of the first rank.
    fn broadcast(&self, words: &mut [i64]) {
        if !self.is_first() {
            words.fill(0);
        }
        self.sum(words);
    }
}

/// Run of a single process.
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
