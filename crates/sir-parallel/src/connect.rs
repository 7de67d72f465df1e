//! Connection to the other processes of a run.

use thiserror::Error;

use crate::communicator::Communicator;

/// Error while connecting to the other processes of a run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ConnectError {
    /// Several processes were started, but this program was built without MPI.
    #[error(
        "{size} processes were started together ({variable} says so), but this program was built without MPI; build it with \
         `cargo build --release --features mpi`, or start one process without mpirun or srun, which uses all cores (for \
         separate runs, start it with `env -u {variable}`)"
    )]
    NoMpi {
        /// Number of processes.
        size: u32,
        /// Environment variable with this number.
        variable: &'static str,
    },
    /// Several processes were started, but MPI does not connect them.
    #[error(
        "{size} processes were started together ({variable} says so), but MPI knows only one; use the mpirun of the MPI \
         library that this program was built with, or the option of srun for that library, such as `--mpi=pmix` (for \
         separate runs, start it with `env -u {variable}`)"
    )]
    Alone {
        /// Number of processes.
        size: u32,
        /// Environment variable with this number.
        variable: &'static str,
    },
    /// MPI cannot be initialized.
    #[error("cannot initialize MPI; check that no other copy of MPI is active in this process")]
    Initialise,
}

/// True if this program was built with MPI, so that several processes can work on one run.
pub const HAS_MPI: bool = cfg!(feature = "mpi");

/// Environment variables with the number of processes that were started together: of Open MPI; of MPICH and its
/// derivatives; of MVAPICH; of IBM's jsrun; of Slurm's srun. Slurm's other numbers, such as `SLURM_NTASKS`, are also set
/// in a batch script, which is a single process. A launcher of MPI comes before srun, with which it may start its own
/// helpers.
const SIZES: [&str; 5] =
    ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "JSM_NAMESPACE_SIZE", "SLURM_STEP_NUM_TASKS"];

/// Environment variables without a number of processes that PMIx and Slurm set for the processes that they start.
#[cfg(feature = "mpi")]
const STARTED: [&str; 2] = ["PMIX_RANK", "SLURM_PROCID"];

/// Connects to the other processes that were started together with this one. Call this only once. MPI is not
/// initialized in a process that was started alone.
///
/// # Errors
///
/// If there are other processes and this program was built without the feature `mpi`, or if MPI cannot be initialized
/// or does not know the other processes.
#[cfg(feature = "mpi")]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    if SIZES.iter().chain(&STARTED).all(|variable| std::env::var_os(variable).is_none()) {
        return Ok(Box::new(crate::communicator::SingleProcess));
    }
    let world = crate::mpi::World::new().ok_or(ConnectError::Initialise)?;
    match started_together(|variable| std::env::var(variable).ok()) {
        Some((variable, size)) if world.size() == 1 => Err(ConnectError::Alone { size, variable }),
        _ => Ok(Box::new(world)),
    }
}

/// Connects to the other processes that were started together with this one. Call this only once.
///
/// # Errors
///
/// If there are other processes, because this program was built without the feature `mpi`.
#[cfg(not(feature = "mpi"))]
pub fn connect() -> Result<Box<dyn Communicator>, ConnectError> {
    match started_together(|variable| std::env::var(variable).ok()) {
        Some((variable, size)) => Err(ConnectError::NoMpi { size, variable }),
        None => Ok(Box::new(crate::communicator::SingleProcess)),
    }
}

/// Returns the number of processes that were started together, if there are several, and the environment variable that
/// states it. `value` returns the value of an environment variable.
fn started_together(value: impl Fn(&str) -> Option<String>) -> Option<(&'static str, u32)> {
    let sizes = SIZES.iter().filter_map(|&variable| Some((variable, value(variable)?.trim().parse().ok()?)));
    // Only the first launcher counts.
    sizes.take(1).find(|&(_, size)| size > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn started(variables: &[(&str, &str)]) -> Option<(&'static str, u32)> {
        let find = |name: &str| variables.iter().find(|(variable, _)| *variable == name);
        started_together(|name| find(name).map(|(_, value)| (*value).to_owned()))
    }

    #[test]
    fn processes_that_are_started_together_are_counted() {
        for variable in SIZES {
            assert_eq!(started(&[(variable, "4")]), Some((variable, 4)));
            for one in ["1", "0", "", "four"] {
                assert_eq!(started(&[(variable, one)]), None, "{variable}={one}");
            }
        }
    }

    #[test]
    fn a_batch_script_is_one_process() {
        assert_eq!(started(&[("SLURM_NTASKS", "4"), ("SLURM_NPROCS", "4"), ("SLURM_PROCID", "0")]), None);
        // mpirun starts one process, with helpers that srun starts on four machines.
        assert_eq!(started(&[("OMPI_COMM_WORLD_SIZE", "1"), ("SLURM_STEP_NUM_TASKS", "4")]), None);
    }
}
