//! What is refused, with what words: file, line, value, limit, unit; and that it is always exit code 2.
//!
//! `study`, `robot`: files; `place`: where results go; `flags`: options.

mod flags;
mod place;
mod robot;
mod study;

use crate::cell::{Cell, LEVER, SMALL, Said};

/// Output of `armill check` for [`SMALL`] with one change; `run` must refuse it too and write nothing.
fn check(from: &str, to: &str) -> Said {
    assert!(SMALL.contains(from), "the sample has no `{from}`");
    check_text(SMALL.replacen(from, to, 1))
}

fn check_text(text: impl AsRef<[u8]>) -> Said {
    let cell = Cell::new();
    cell.file("study.toml", text);
    let run = cell.armill(&["run", "study.toml"]).refused(&[]);
    let checked = cell.armill(&["check", "study.toml"]);
    assert_eq!(checked.err, run.err, "check and run do not say the same");
    assert!(
        !cell.at("out").exists(),
        "a folder was made for a study that cannot run"
    );
    assert_eq!(checked.out, "", "problems are talk, not a result");
    checked
}

/// What `armill pose` says to [`LEVER`] with one thing changed.
fn lever(from: &str, to: &str) -> Said {
    assert!(LEVER.contains(from), "the sample has no `{from}`");
    let cell = Cell::new();
    cell.file("lever.toml", LEVER.replacen(from, to, 1));
    cell.armill(&["pose", "lever.toml", "--joints-deg", "0,0"])
}

fn pose(arguments: &[&str]) -> Said {
    Cell::new().armill(&[&["pose", "yaskawa/mh12"], arguments].concat())
}
