//! Memory that this process can still use.
//!
//! Linux states four kinds of limits: the memory of the machine, those of the control groups that the process is in
//! (each limits all processes in it and in the groups below, so the least of them counts), and those of the process
//! itself, which the shell sets with `ulimit`. Other systems state none.

use std::fs::read_to_string;
use std::path::Path;

/// Mount point of control groups.
const GROUPS: &str = "/sys/fs/cgroup";

/// Returns the memory that this process can still use without swapping \[bytes\], or `None` if the operating system does
/// not tell.
pub(crate) fn available() -> Option<u64> {
    let machine = kilobytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    let read = |name: &str| read_to_string(Path::new("/proc/self").join(name)).ok();
    let groups = read("cgroup").and_then(|membership| left_in_groups(Path::new(GROUPS), &membership));
    let process =
        read("limits").zip(read("status")).and_then(|(limits, status)| left_in_process(&limits, &status));
    [groups, process].into_iter().flatten().chain([machine]).min()
}

/// Returns the value \[bytes\] of a line such as `VmHWM:  1234 kB` in a status text of Linux.
pub(crate) fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Returns the memory left within the limits of all control groups of a process \[bytes\], or `None` without a limit.
/// `membership` is the content of `/proc/self/cgroup`: lines `number:controllers:path`, with number 0 and no
/// controllers in version 2. In a container, the path may be that on the host, of which only the last groups exist
/// under `root`; the groups that exist are those that limit the process.
fn left_in_groups(root: &Path, membership: &str) -> Option<u64> {
    let mut left = None;
    for line in membership.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (root, files) = match controllers {
            "" => (root.to_owned(), &VERSION_2),
            list if list.split(',').any(|name| name == "memory") => (root.join("memory"), &VERSION_1),
            _ => continue,
        };
        for group in Path::new(path.trim_start_matches('/')).ancestors() {
            left = [left, files.left(&root.join(group))].into_iter().flatten().min();
        }
    }
    left
}

/// Names of the files of a memory control group.
struct GroupFiles {
    /// Limits. The first one ends the process, the second one slows it down until it hardly moves.
    limits: &'static [&'static str],
    used: &'static str,
    /// Labels, in `memory.stat`, of the page cache and of the part of it that cannot be evicted, because it belongs to
    /// files in memory.
    cached: [&'static str; 2],
}

const VERSION_1: GroupFiles = GroupFiles {
    limits: &["memory.limit_in_bytes"],
    used: "memory.usage_in_bytes",
    cached: ["total_cache ", "total_shmem "],
};

const VERSION_2: GroupFiles = GroupFiles {
    limits: &["memory.max", "memory.high"],
    used: "memory.current",
    cached: ["file ", "shmem "],
};

impl GroupFiles {
    /// Returns the memory left within the limit of a group \[bytes\], or `None` without a limit. The page cache counts as
    /// free, because it can be evicted.
    fn left(&self, group: &Path) -> Option<u64> {
        let read = |name: &str| read_to_string(group.join(name)).ok();
        let limits = self.limits.iter().filter_map(|name| read(name)?.trim().parse::<u64>().ok());
        let limit = limits.min()?;
        let used: u64 = read(self.used)?.trim().parse().ok()?;
        let stat = read("memory.stat").unwrap_or_default();
        let [cached, kept] = self.cached.map(|label| {
            stat.lines().find_map(|line| line.strip_prefix(label)?.trim().parse::<u64>().ok()).unwrap_or(0)
        });
        Some(limit.saturating_sub(used.saturating_sub(cached.saturating_sub(kept))))
    }
}

/// Returns the memory left within the limits of the process itself \[bytes\], or `None` without a limit. The arguments
/// are the contents of `/proc/self/limits` and `/proc/self/status`.
fn left_in_process(limits: &str, status: &str) -> Option<u64> {
    let left = |limit: &str, used: &str| {
        let line = limits.lines().find_map(|line| line.strip_prefix(limit))?;
        let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
        Some(limit.saturating_sub(kilobytes(status, used)?))
    };
    [left("Max address space", "VmSize:"), left("Max data size", "VmData:")].into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const SHARE: &str = "anon 400\nfile 300\nshmem 100\n";

    /// Writes files of a group, and creates its folder.
    fn group(folder: &Path, files: &[(&str, &str)]) {
        fs::create_dir_all(folder).unwrap();
        files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    }

    #[test]
    fn values_are_read_from_the_status() {
        let status = "Name:\tsir\nVmHWM:\t    2048 kB\nVmRSS:\t 1 kB\n";
        assert_eq!(kilobytes(status, "VmHWM:"), Some(2 << 20));
        assert_eq!(kilobytes("Name:\tsir\n", "VmHWM:"), None);
    }

    #[test]
    fn a_group_leaves_its_limit_less_what_is_used_for_good() {
        let root = tempfile::tempdir().unwrap();
        let left = || left_in_groups(root.path(), "0::/\n");
        assert_eq!(left(), None);
        group(root.path(), &[("memory.current", "700\n"), ("memory.stat", SHARE), ("memory.max", "max\n")]);
        assert_eq!(left(), None);
        group(root.path(), &[("memory.max", "1000\n")]);
        assert_eq!(left(), Some(500), "200 of 700 bytes can be evicted");
        group(root.path(), &[("memory.high", "900\n")]);
        assert_eq!(left(), Some(400));
        group(root.path(), &[("memory.high", "0\n")]);
        assert_eq!(left(), Some(0));
    }

    #[test]
    fn the_least_of_all_groups_above_counts() {
        let root = tempfile::tempdir().unwrap();
        let of = |limit: &'static str, used: &'static str| [("memory.max", limit), ("memory.current", used)];
        group(&root.path().join("user.slice/job.scope"), &of("max\n", "10\n"));
        group(&root.path().join("user.slice"), &of("900\n", "200\n"));
        let left = |membership: &str| left_in_groups(root.path(), membership);
        assert_eq!(left("0::/user.slice/job.scope\n"), Some(700));
        group(&root.path().join("user.slice/job.scope"), &of("500\n", "10\n"));
        assert_eq!(left("0::/user.slice/job.scope\n"), Some(490));
        group(root.path(), &of("300\n", "250\n"));
        assert_eq!(left("0::/user.slice/job.scope\n"), Some(50));
        // In a container, only the groups below its own root exist.
        assert_eq!(left("0::/kubepods/pod-1\n"), Some(50));
        assert_eq!(left("0::/user.slice/with:colon\n"), Some(50));
    }

    #[test]
    fn groups_of_version_1_are_read() {
        let root = tempfile::tempdir().unwrap();
        let job = root.path().join("memory/slurm/job_1");
        let unlimited = ("memory.limit_in_bytes", "9223372036854771712\n");
        let stat = ("memory.stat", "cache 0\ntotal_cache 300\ntotal_shmem 100\n");
        group(&job, &[unlimited, ("memory.usage_in_bytes", "700\n"), stat]);
        group(&root.path().join("memory"), &[unlimited, ("memory.usage_in_bytes", "9000\n")]);
        let membership =
            "11:cpu,cpuacct:/slurm/job_1\n4:cpuset,memory:/slurm/job_1/step_0\n1:name=systemd:/\n0::/\n";
        let left = || left_in_groups(root.path(), membership).unwrap();
        assert!(left() > 1 << 60, "practically without a limit");
        group(&job, &[("memory.limit_in_bytes", "1000\n")]);
        assert_eq!(left(), 500);
    }

    #[test]
    fn limits_of_the_process_count() {
        let limits = |data: &str, space: &str| {
            format!(
                "Limit                     Soft Limit           Hard Limit           Units     \n\
                 Max data size             {data:<20} unlimited            bytes     \n\
                 Max address space         {space:<20} unlimited            bytes     \n"
            )
        };
        let status = "VmSize:\t       4 kB\nVmData:\t       2 kB\n";
        let left = |data: &str, space: &str| left_in_process(&limits(data, space), status);
        assert_eq!(left("unlimited", "unlimited"), None);
        assert_eq!(left("unlimited", "10240"), Some(6 << 10));
        assert_eq!(left("5120", "10240"), Some(3 << 10));
        assert_eq!(left("unlimited", "1024"), Some(0));
    }
}
