//! Free disk space: compilers and linkers report a full disk in a hundred lines, none of which names it.

use std::process::Command;

/// What a run from nothing fills, in GiB: libraries, tests and examples of two profiles, the Python environment,
/// the browser. Rounded up from a run on a fresh clone, which filled 6.
const NEEDED_GIB: f64 = 10.0;

/// Warns where less is free than a first run needs; with an earlier run in `target` it may still be enough.
pub fn warn_if_little() {
    if let Some(line) = free_gib().and_then(warning) {
        eprintln!("{line}");
    }
}

/// The warning for `free` GiB, if any.
fn warning(free: f64) -> Option<String> {
    (free < NEEDED_GIB).then(|| {
        format!(
            "{free:.1} GiB free on this disk, a first run needs up to {NEEDED_GIB:.0}: if it ends with \
             \"No space left on device\", free some space (`cargo clean` empties target)"
        )
    })
}

/// The GiB that are free in the current folder, as `df` reports them; nothing where there is no `df`.
fn free_gib() -> Option<f64> {
    let output = Command::new("df").args(["-P", "-k", "."]).output().ok()?;
    available_gib(&String::from_utf8(output.stdout).ok()?)
}

/// The fourth column of the second line: available, in KiB.
fn available_gib(table: &str) -> Option<f64> {
    let kib: f64 = table.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()?;
    Some(kib / (1024.0 * 1024.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_column_of_df_is_read() {
        let table = "Filesystem     1024-blocks     Used Available Capacity Mounted on\n\
                     /dev/vda         263713216 91937792   3774873      97% /\n";
        let free = available_gib(table).unwrap();
        assert!((free - 3.6).abs() < 0.001, "{free}");
        assert_eq!(available_gib("df: no such file\n"), None);
    }

    #[test]
    fn little_room_is_reported_and_enough_is_not() {
        assert!(warning(3.6).unwrap().starts_with("3.6 GiB free"));
        assert_eq!(warning(40.0), None);
    }
}
