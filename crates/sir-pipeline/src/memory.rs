//! Peak memory of a run, and refusal of runs that do not fit the memory.

use std::fs::read_to_string;

use sir_parallel::Communicator;

use crate::available_memory::{available, kilobytes};
use crate::error::Error;
use crate::format::bytes;

/// Returns the peak memory use of this process \[bytes\], or `None` if the operating system does not report it.
fn peak() -> Option<u64> {
    let status = read_to_string("/proc/self/status").ok()?;
    kilobytes(&status, "VmHWM:")
}

/// Returns the largest peak memory use of all ranks \[bytes\]. All ranks must call this.
pub(crate) fn largest_peak(comm: &dyn Communicator) -> Option<u64> {
    let mut peaks = vec![0; comm.size()];
    peaks[comm.rank()] = peak().and_then(|bytes| i64::try_from(bytes).ok()).unwrap_or(0);
    comm.sum(&mut peaks);
    peaks.into_iter().max().and_then(|bytes| u64::try_from(bytes).ok()).filter(|&bytes| bytes > 0)
}

/// Returns an error if `needed` bytes exceed the available memory, as far as the operating system reports it. (Linux
/// overcommits memory: without this check the allocation would succeed, and Linux would kill the program when it uses
/// the memory.)
pub(crate) fn refuse_more_than_available(needed: usize) -> Result<(), Error> {
    let available = available().and_then(|bytes| usize::try_from(bytes).ok());
    match available.filter(|&available| available < needed) {
        Some(available) => Err(Error::Memory { needed: bytes(needed), available: bytes(available) }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_parallel::SingleProcess;

    #[test]
    fn the_peak_is_known_on_linux() {
        assert_eq!(largest_peak(&SingleProcess).is_some(), cfg!(target_os = "linux"));
    }

    #[test]
    fn more_than_there_is_is_refused() {
        assert!(refuse_more_than_available(1 << 10).is_ok());
        let refused = refuse_more_than_available(usize::MAX / 2);
        assert_eq!(matches!(refused, Err(Error::Memory { .. })), cfg!(target_os = "linux"), "{refused:?}");
    }
}
