//! Joining the other processes of a run.

use thiserror::Error;

use crate::communicator::Communicator;

/// Why the processes of a run cannot work together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ConnectError {
    /// Several processes were started, but this program cannot talk to the others.
    #[error(
        "this is one of {size} processes that were started together, but the program was built without MPI; build it \
         with `cargo build --release --features mpi`, or start it without mpirun: it uses all cores by itself"
    )]
    NoMpi {
        /// How many there are.
        size: u32,
    },
    /// MPI does not start.
    #[error("MPI cannot be initialized; is another copy of MPI active in this process?")]
    Initialise,
}

/// Whether this program can be run by several processes together.
pub const HAS_MPI: bool = cfg!(feature = "mpi");

/// What Open MPI, MPICH and its relatives, PMIx and Slurm set for the processes that they start.
#[cfg(feature = "mpi")]
const STARTED_BY_MPI: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "SLURM_PROCID"];

/// The other processes that were started together with this one; call this once. A process that was started by itself does
/// not start MPI.
///
/// # Errors
///
/// If there are some, and this program was built without the feature `mpi`, or MPI does not start.
#[cfg(feature = "mpi")]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    if STARTED_BY_MPI.iter().all(|variable| std::env::var_os(variable).is_none()) {
        return Ok(Box::new(crate::communicator::SingleProcess));
    }
    crate::mpi::World::new().map(|world| Box::new(world) as _).ok_or(ConnectError::Initialise)
}

/// The other processes that were started together with this one; call this once.
///
/// # Errors
///
/// If there are some, and this program was built without the feature `mpi`.
#[cfg(not(feature = "mpi"))]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    // What Open MPI, and MPICH and its relatives tell the processes that they start.
    for variable in ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"] {
        let size = std::env::var(variable).ok().and_then(|size| size.parse().ok());
        if let Some(size) = size.filter(|&size| size > 1) {
            return Err(ConnectError::NoMpi { size });
        }
    }
    Ok(Box::new(crate::communicator::SingleProcess))
}
