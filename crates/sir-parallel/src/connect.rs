//! Connection to the other processes of a run.

use thiserror::Error;

use crate::communicator::Communicator;

/// Error while connecting to the other processes of a run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ConnectError {
    /// Several processes were started, but this program was built without MPI.
    #[error(
        "{size} processes were started together, but this program was built without MPI; build it \
         with `cargo build --release --features mpi`, or start it without mpirun (one process uses all cores)"
    )]
    NoMpi {
        /// Number of processes.
        size: u32,
    },
    /// MPI cannot be initialized.
    #[error("cannot initialize MPI; check that no other copy of MPI is active in this process")]
    Initialise,
}

/// True if this program was built with MPI, so that several processes can work on one run.
pub const HAS_MPI: bool = cfg!(feature = "mpi");

/// Environment variables that Open MPI, MPICH and its derivatives, PMIx and Slurm set for the processes that they
/// start.
#[cfg(feature = "mpi")]
const STARTED_BY_MPI: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "SLURM_PROCID"];

/// Connects to the other processes that were started together with this one. Call this only once. MPI is not
/// initialized in a process that was started alone.
///
/// # Errors
///
/// If there are other processes and this program was built without the feature `mpi`, or if MPI cannot be initialized.
#[cfg(feature = "mpi")]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    if STARTED_BY_MPI.iter().all(|variable| std::env::var_os(variable).is_none()) {
        return Ok(Box::new(crate::communicator::SingleProcess));
    }
    crate::mpi::World::new().map(|world| Box::new(world) as _).ok_or(ConnectError::Initialise)
}

/// Connects to the other processes that were started together with this one. Call this only once.
///
/// # Errors
///
/// If there are other processes, because this program was built without the feature `mpi`.
#[cfg(not(feature = "mpi"))]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    // Set by Open MPI, and by MPICH and its derivatives, for the processes that they start.
    for variable in ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"] {
        let size = std::env::var(variable).ok().and_then(|size| size.parse().ok());
        if let Some(size) = size.filter(|&size| size > 1) {
            return Err(ConnectError::NoMpi { size });
        }
    }
    Ok(Box::new(crate::communicator::SingleProcess))
}
