//! Places where nothing can be written.

use std::time::{Duration, Instant};

use crate::cell::{Cell, SMALL};

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_any_work() {
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.2"));
    cell.file("in the way", "a file");
    let start = Instant::now();
    cell.armill(&["run", "study.toml", "--out", "in the way"])
        .refused(&["`in the way`", "is a file"]);
    cell.armill(&["run", "study.toml", "--out", "in the way/deeper"])
        .refused(&["`in the way`", "is a file"]);
    #[cfg(target_os = "linux")]
    for folder in ["/proc/armill", "/proc"] {
        cell.armill(&["run", "study.toml", "--out", folder])
            .refused(&["cannot write", folder]);
    }
    // A million points take several seconds in a debug build; four starts of a program do not.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    assert_eq!(std::fs::read(cell.at("in the way")).unwrap(), b"a file");
}
