//! Ranks that communicate by MPI.

use std::cell::RefCell;

use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, CommunicatorCollectives as _};

use crate::communicator::Communicator;

/// Largest number of words in one message: MPI counts in 32 bits, and a chunk of 512 kB stays in the cache.
const CHUNK: usize = 1 << 16;

/// All processes that were started together. Dropping it finalizes MPI.
pub(crate) struct World {
    world: SimpleCommunicator,
    chunk: RefCell<Vec<i64>>,
    _universe: Universe,
}

impl World {
    /// Initializes MPI. Only the calling thread may use it afterwards. Returns `None` if MPI was initialized before.
    pub(crate) fn new() -> Option<Self> {
        let (universe, _) = mpi::initialize_with_threading(Threading::Funneled)?;
        let world = universe.world();
        if world.size() > 1 {
            // Without this, the other ranks would wait forever for a rank that panics.
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
