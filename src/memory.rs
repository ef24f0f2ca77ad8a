//! Memory of this machine that is free, so that what cannot fit is refused before it is begun.

use crate::{Error, Result};
use std::path::Path;

/// Address space that a software device takes besides a scene, the driver's code and compiler included: 1.2 GiB were measured with two threads ...
const DRIVER: u64 = 1 << 30;
/// ... of which each takes a stack and room to allocate from, in the driver and here.
const DRIVER_THREAD: u64 = 160 << 20;
/// Address space of a thread of the reference: its stack, and room to allocate from.
const THREAD: u64 = ARENA + (2 << 20);
/// What the C library reserves for a thread that begins to allocate.
const ARENA: u64 = 64 << 20;

/// Bytes that a process may still take without swapping; known on Linux only. Counts the limit of the control group, which
/// containers and batch systems set, and those of the process itself (`ulimit -v`, `ulimit -d`).
pub fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let machine = kib(&text, "MemAvailable:")?;
    [Some(machine), group_available(), address_space()].into_iter().flatten().min()
}

/// Address space that threads will still take when they begin to allocate; none where nothing limits it.
pub(crate) fn threads_demand() -> u64 {
    if address_space().is_none() {
        return 0;
    }
    // Those of the reference, and the one that waits for Ctrl-C.
    let threads = rayon::current_num_threads() as u64 + 1;
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    ARENA * threads.saturating_sub(arenas(&maps))
}

/// How many arenas `/proc/self/maps` shows: glibc has them begin at multiples of their size, where other mappings hardly do.
fn arenas(maps: &str) -> u64 {
    let begin = |line: &str| u64::from_str_radix(line.split('-').next()?, 16).ok();
    maps.lines().filter_map(begin).filter(|address| *address != 0 && address % ARENA == 0).count() as u64
}

/// Bytes that this process may still map; none if nothing limits them, or that is not known.
fn address_space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let left = |name, used| Some(limit(&limits, name)?.saturating_sub(kib(&status, used)?));
    [left("Max address space", "VmSize:"), left("Max data size", "VmData:")].into_iter().flatten().min()
}

/// The soft limit of a line of `/proc/self/limits`, in bytes; none if there is no limit.
fn limit(text: &str, name: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

/// How many threads can run at once.
fn processors() -> u64 {
    std::thread::available_parallelism().map_or(1, |n| n.get() as u64)
}

/// Refuses to load a driver where it would not have the address space that it wants: drivers do not ask whether they got it, and bring the process down.
/// Whatever opens a device asks this first.
///
/// # Errors
/// [`Error::NoDevice`].
pub fn check_driver() -> Result<()> {
    let wanted = DRIVER + DRIVER_THREAD * processors();
    match address_space().filter(|left| *left < wanted) {
        None => Ok(()),
        Some(left) => Err(Error::NoDevice(format!(
            "this process may take {} more of address space, and a Vulkan driver wants {} to be safe: raise the limit (ulimit -v, ulimit -d), or run with \
             --backend cpu",
            gib(left),
            gib(wanted)
        ))),
    }
}

/// Lets fewer threads run where a limit of the process leaves no room for one on every processor; does nothing where none does. To be called before anything else.
pub fn fit_threads() {
    let Some(left) = address_space() else { return };
    // Half of it is the scene's and the film's.
    let threads = (left / 2 / THREAD).clamp(1, processors());
    // If there are threads already, they fit.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build_global();
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
pub fn gib(bytes: u64) -> String {
    match bytes as f64 / f64::from(1 << 30) {
        // So that numbers that are nearly the same differ.
        gib if gib < 10.0 => format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20)),
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
        let maps = "55d0c0000000-55d0c0021000 r--p 00000000 08:01 1 /a\n7f0004000000-7f0004021000 rw-p 00000000 00:00 0\n\
                    7f0004021000-7f0008000000 ---p 00000000 00:00 0\n";
        assert_eq!(arenas(&maps.replace("55d0c0000000", "55d0c0001000")), 1);
        let limits = "Limit                     Soft Limit           Hard Limit           Units     \n\
                      Max data size             unlimited            unlimited            bytes     \n\
                      Max address space         1024000              unlimited            bytes     \n";
        assert_eq!([limit(limits, "Max address space"), limit(limits, "Max data size")], [Some(1_024_000), None]);
        assert_eq!([gib(22 << 30), gib(3 << 19), gib(5 << 28)], ["22.0 GiB", "1.5 MiB", "1280.0 MiB"]);
    }
}
