//! Ranks that talk to each other by MPI.

use std::cell::RefCell;

use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, CommunicatorCollectives as _};

use crate::communicator::Communicator;

/// Numbers in one message: MPI counts in 32 bits, and a chunk of 512 kB stays in the cache.
const CHUNK: usize = 1 << 16;

/// All processes that were started together. When it is dropped, MPI ends.
pub(crate) struct World {
    world: SimpleCommunicator,
    chunk: RefCell<Vec<i64>>,
    _universe: Universe,
}

impl World {
    /// Starts MPI. Only the calling thread will use it.
    pub(crate) fn new() -> Option<Self> {
        let (universe, _) = mpi::initialize_with_threading(Threading::Funneled)?;
        let world = universe.world();
        if world.size() > 1 {
            // A rank that panics would leave the others waiting for it.
            let report = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                report(panic);
                SimpleCommunicator::world().abort(1);
            }));
        }
        Some(Self { world, chunk: RefCell::new(Vec::with_capacity(CHUNK)), _universe: universe })
    }
}

impl Communicator for World {
    fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    fn size(&self) -> usize {
        self.world.size() as usize
    }

    fn sum(&self, words: &mut [i64]) {
        let mut mine = self.chunk.borrow_mut();
        for words in words.chunks_mut(CHUNK) {
            mine.clear();
            mine.extend_from_slice(words);
            self.world.all_reduce_into(&mine[..], words, SystemOperation::sum());
        }
    }
}
