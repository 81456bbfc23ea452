//! Mistakes that are easily made, and what armill says of each: one table, by kind of input.
//!
//! Each is done in a folder of its own: the exit code and a distinctive part of the message are compared. The page
//! `docs/guide/common-mistakes.md` has the same rows.

mod measured;
mod studies;

use std::fmt::Write;

use crate::cell::Cell;
use crate::documents::repository;

/// A mistake.
pub struct Slip {
    /// What is done.
    pub done: &'static str,
    /// Makes the files.
    pub files: Box<dyn Fn(&Cell)>,
    /// The command.
    pub command: Vec<&'static str>,
    /// Exit code.
    pub code: i32,
    /// Part of the message.
    pub said: &'static str,
}

/// All mistakes, each kind with its title.
fn all() -> [(&'static str, Vec<Slip>); 6] {
    [
        ("Studies and programs", studies::all()),
        ("Robots", studies::of_robots()),
        ("Load tests (`identify`)", measured::load_tests()),
        ("Measured poses (`calibrate`, `pose-accuracy`)", measured::poses()),
        ("Circular tests (`backlash`)", measured::circles()),
        ("Force records (`forces`)", measured::forces()),
    ]
}

#[test]
fn every_slip_is_noticed() {
    let mut count = 0;
    let mut missed = String::new();
    for slip in all().iter().flat_map(|(_, slips)| slips) {
        let cell = Cell::new();
        (slip.files)(&cell);
        let said = cell.armill(&slip.command);
        let text = format!("{}{}", said.out, said.err);
        count += 1;
        if said.code != slip.code || !text.contains(slip.said) {
            let _ = writeln!(
                missed,
                "{}: exit code {} for {}, no `{}` in:\n{text}",
                slip.done, said.code, slip.code, slip.said
            );
        }
    }
    assert!(missed.is_empty(), "{missed}");
    assert!(count >= 60, "{count}");
}

#[test]
fn the_page_has_the_same_mistakes() {
    let path = repository().join("docs/guide/common-mistakes.md");
    let page = std::fs::read_to_string(path).unwrap_or_default();
    let mut rows = String::new();
    for (title, slips) in all() {
        let _ = write!(
            rows,
            "\n## {title}\n\n| mistake | message | exit code |\n|---|---|---|\n"
        );
        for slip in slips {
            let said = slip.said.replace('|', "\\|");
            let _ = writeln!(rows, "| {} | {said} | {} |", slip.done, slip.code);
        }
    }
    assert!(page.ends_with(&rows), "the page must end with:\n{rows}");
    assert_eq!(page.matches("\n## ").count(), all().len(), "each kind once");
}
