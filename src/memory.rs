//! Memory of this machine that is free, so that what cannot fit is refused before it is begun.

use std::path::Path;

/// Bytes that a process may still take without swapping; known on Linux only. Counts the limit of the control group, which
/// containers and batch systems set.
pub(crate) fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let machine = kib(&text, "MemAvailable:")?;
    Some(group_available().map_or(machine, |group| group.min(machine)))
}

/// What the control group (version 2) of this process leaves.
fn group_available() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let group = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let mut folder = Path::new("/sys/fs/cgroup").join(group);
    let mut least = None;
    // The limits of all groups above count too.
    while folder.starts_with("/sys/fs/cgroup") {
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
        let left = || {
            let limit: u64 = read("memory.max")?.trim().parse().ok()?;
            let used: u64 = read("memory.current")?.trim().parse().ok()?;
            // The cache of files is given back when memory is short.
            let cache = read("memory.stat")?.lines().find_map(|line| line.strip_prefix("file ")?.parse().ok())?;
            Some(limit.saturating_sub(used.saturating_sub(cache)))
        };
        least = [least, left()].into_iter().flatten().min();
        folder.pop();
    }
    least
}

/// A line of `/proc/meminfo`, in bytes.
fn kib(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib * 1024)
}

/// Bytes for a message.
pub(crate) fn gib(bytes: u64) -> String {
    match bytes as f64 / f64::from(1 << 30) {
        gib if gib < 0.1 => format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20)),
        gib => format!("{gib:.1} GiB"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_the_systems_table_is_read() {
        let text = "MemTotal:       24689836 kB\nMemFree:           100 kB\nMemAvailable:   23068672 kB\n";
        assert_eq!(kib(text, "MemAvailable:"), Some(22 << 30));
        assert_eq!(kib(text, "MemNone:"), None);
        assert_eq!([gib(22 << 30), gib(3 << 19)], ["22.0 GiB", "1.5 MiB"]);
    }
}
