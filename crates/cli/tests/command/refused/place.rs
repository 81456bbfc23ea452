//! Places where nothing can be written.

use std::time::Instant;

use crate::cell::{Cell, SMALL};

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_any_work() {
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.5"));
    cell.file("in the way", "a file");
    let start = Instant::now();
    cell.armill(&["run", "study.toml"]).fine();
    let worked = start.elapsed();
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
    // The work, 160 000 points, takes far longer than four starts of a program, on any machine.
    assert!(start.elapsed() < worked, "{:?} of {worked:?}", start.elapsed());
    assert_eq!(std::fs::read(cell.at("in the way")).unwrap(), b"a file");
}
