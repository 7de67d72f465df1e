//! How much memory a run needs.

use sir_parallel::Communicator;

/// Most memory that this process has had in use \[bytes\]; `None` if the operating system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    from_status(&status)
}

/// The line `VmHWM:  1234 kB` of a process's status in Linux.
fn from_status(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Most memory that any of the ranks has had in use \[bytes\]. All ranks must call this.
pub(crate) fn largest_peak(comm: &dyn Communicator) -> Option<u64> {
    let mut peaks = vec![0; comm.size()];
    peaks[comm.rank()] = peak().and_then(|bytes| i64::try_from(bytes).ok()).unwrap_or(0);
    comm.sum(&mut peaks);
    peaks.into_iter().max().and_then(|bytes| u64::try_from(bytes).ok()).filter(|&bytes| bytes > 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_parallel::Alone;

    #[test]
    fn the_peak_is_read_from_the_status() {
        assert_eq!(from_status("Name:\tsir\nVmHWM:\t    2048 kB\nVmRSS:\t 1 kB\n"), Some(2 << 20));
        assert_eq!(from_status("Name:\tsir\n"), None);
        assert_eq!(largest_peak(&Alone).is_some(), cfg!(target_os = "linux"));
    }
}
