//! Whether there is memory for what is about to be made.
//!
//! Where memory ends, a program is ended by the system, or ends itself, and takes a notebook with it. So what grows with the
//! input is estimated beforehand and compared with what is free: of the machine, of the container, and of the limit that
//! the process has. On systems that do not tell, only the allocation itself can fail.

use std::fs;
use std::path::Path;

/// Smaller things are not asked for: looking takes some microseconds.
const SMALL: u64 = 64 << 20;

/// There is less memory than is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("about {} of memory are needed, and {} are free", gigabytes(*needed), gigabytes(*free))]
pub struct TooLittleMemory {
    /// Bytes, about.
    pub needed: u64,
    /// Bytes; 0 where the system does not tell.
    pub free: u64,
}

/// Whether so many bytes (an estimate) can be had.
///
/// # Errors
/// They cannot.
pub fn check(needed: u64) -> Result<(), TooLittleMemory> {
    match free().filter(|_| needed > SMALL) {
        Some(free) if free < needed => Err(TooLittleMemory { needed, free }),
        _ => Ok(()),
    }
}

/// So many equal values.
///
/// # Errors
/// There is no memory for them.
pub fn filled<T: Clone>(value: T, count: usize) -> Result<Vec<T>, TooLittleMemory> {
    let mut values = reserved(count)?;
    values.resize(count, value);
    Ok(values)
}

/// An empty list with room for so many values.
///
/// # Errors
/// There is no memory for them.
pub fn reserved<T>(count: usize) -> Result<Vec<T>, TooLittleMemory> {
    let needed = (count as u64).saturating_mul(size_of::<T>() as u64);
    check(needed)?;
    let mut values = Vec::new();
    let reserved = values.try_reserve_exact(count);
    let free = 0;
    reserved.map_err(|_| TooLittleMemory { needed, free })?;
    Ok(values)
}

/// Bytes that are free for this process; none where the system does not tell.
pub fn free() -> Option<u64> {
    let of_machine = field(Path::new("/proc/meminfo"), "MemAvailable:").map(|kib| kib * 1024);
    let all = [of_machine, of_container(), of_limit()];
    all.into_iter().flatten().min()
}

/// What the container leaves, by cgroups of version 2 or 1. Files that the system keeps in memory can be given back.
fn of_container() -> Option<u64> {
    let two = Path::new("/sys/fs/cgroup");
    let one = Path::new("/sys/fs/cgroup/memory");
    let read = |folder: &Path, [most, used]: [&str; 2], kept: &str| {
        let most = number(&folder.join(most))?;
        let used = number(&folder.join(used))?;
        let kept = field(&folder.join("memory.stat"), kept).unwrap_or(0);
        Some(most.saturating_sub(used.saturating_sub(kept)))
    };
    read(two, ["memory.max", "memory.current"], "inactive_file").or_else(|| {
        let names = ["memory.limit_in_bytes", "memory.usage_in_bytes"];
        read(one, names, "total_inactive_file")
    })
}

/// What `ulimit -v` leaves.
fn of_limit() -> Option<u64> {
    let limit = field(Path::new("/proc/self/limits"), "Max address space")?;
    let used = field(Path::new("/proc/self/status"), "VmSize:")? * 1024;
    Some(limit.saturating_sub(used))
}

/// The first number after a name in a file of lines; none for `unlimited`.
fn field(path: &Path, name: &str) -> Option<u64> {
    let text = fs::read_to_string(path).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

/// The number that a file holds; none for `max`.
fn number(path: &Path) -> Option<u64> {
    fs::read_to_string(path).ok()?.trim().parse().ok()
}

fn gigabytes(bytes: u64) -> String {
    match bytes {
        0 => "less".into(),
        bytes => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_had_is_an_error_before_it_is_asked_for() {
        assert!(check(1).is_ok());
        assert_eq!(filled(7_u8, 3).expect("three bytes"), [7; 3]);
        // More than any machine has addresses for.
        let error = reserved::<u64>(1 << 58).expect_err("too much");
        assert!(
            error
                .to_string()
                .starts_with("about 2305843009.2 GB of memory are needed"),
            "{error}"
        );
        if cfg!(target_os = "linux") {
            let free = free().expect("Linux tells");
            assert_eq!(check(free.saturating_mul(4)).is_err(), free > SMALL / 4);
        }
    }
}
