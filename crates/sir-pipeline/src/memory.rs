//! Available memory of the machine, and peak memory of a run.

use std::fs::read_to_string;
use std::path::Path;

use sir_parallel::Communicator;

use crate::error::Error;
use crate::format::bytes;

/// Returns the peak memory use of this process \[bytes\], or `None` if the operating system does not report it.
fn peak() -> Option<u64> {
    let status = read_to_string("/proc/self/status").ok()?;
    kilobytes(&status, "VmHWM:")
}

/// Returns the value \[bytes\] of a line such as `VmHWM:  1234 kB` in a status text of Linux.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
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

/// Returns the memory that this process can still use without swapping \[bytes\]: that of the machine, limited by the
/// control group of the process.
fn available() -> Option<u64> {
    let machine = kilobytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    let group = read_to_string("/proc/self/cgroup").ok().and_then(|text| {
        let name = text.lines().find_map(|line| line.strip_prefix("0::/"))?;
        left_in_group(&Path::new("/sys/fs/cgroup").join(name))
    });
    Some(group.map_or(machine, |left| left.min(machine)))
}

/// Returns the memory that is left within the limit of a control group (Linux cgroup v2) \[bytes\], or `None` without a
/// limit. The page cache counts as free, because it can be evicted.
fn left_in_group(group: &Path) -> Option<u64> {
    let read = |name: &str| read_to_string(group.join(name)).ok();
    let limit: u64 = read("memory.max")?.trim().parse().ok()?;
    let used: u64 = read("memory.current")?.trim().parse().ok()?;
    let cached = read("memory.stat")?.lines().find_map(|line| line.strip_prefix("file ")?.parse().ok());
    Some(limit.saturating_sub(used.saturating_sub(cached.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sir_parallel::SingleProcess;

    #[test]
    fn the_peak_is_read_from_the_status() {
        let status = "Name:\tsir\nVmHWM:\t    2048 kB\nVmRSS:\t 1 kB\n";
        assert_eq!(kilobytes(status, "VmHWM:"), Some(2 << 20));
        assert_eq!(kilobytes("Name:\tsir\n", "VmHWM:"), None);
        assert_eq!(largest_peak(&SingleProcess).is_some(), cfg!(target_os = "linux"));
    }
    #[test]
    fn more_than_there_is_is_refused() {
        assert!(refuse_more_than_available(1 << 10).is_ok());
        let refused = refuse_more_than_available(usize::MAX / 2);
        assert_eq!(matches!(refused, Err(Error::Memory { .. })), cfg!(target_os = "linux"), "{refused:?}");
    }

    #[test]
    fn a_group_leaves_its_limit_less_what_is_used_for_good() {
        let group = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(group.path().join(name), text).unwrap();
        assert_eq!(left_in_group(group.path()), None);
        write("memory.current", "700\n");
        write("memory.stat", "anon 400\nfile 300\n");
        write("memory.max", "max\n");
        assert_eq!(left_in_group(group.path()), None);
        write("memory.max", "1000\n");
        assert_eq!(left_in_group(group.path()), Some(600));
    }
}
