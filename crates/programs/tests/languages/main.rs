//! Programs of robots: one list of poses in the languages of many makers, what is written and read back, what is
//! rewritten, and what is refused.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod drafts;
mod followed;
mod hostile;
mod inform;
mod krl;
mod other_makers;
mod passages;
mod rapid;
mod refused_drafts;
mod rewriting;
mod same_poses;
#[path = "../../../formats/tests/samples_folder/mod.rs"]
mod samples_folder;
mod tp;
mod trials;
mod urscript;
mod val3;

use armill_formats::document::Problems;
use armill_programs::{ProgramText, RobotProgram, read};

/// The program that these files make.
fn program(files: &[(&str, &str)]) -> Result<RobotProgram, Problems> {
    let texts = files
        .iter()
        .map(|(name, text)| ProgramText::new(name, text.as_bytes()));
    read(texts.collect())
}

/// The problems of these files, each `line:column: message`.
fn problems(files: &[(&str, &str)]) -> Vec<String> {
    let given = program(files).expect_err("it is refused");
    given
        .as_slice()
        .iter()
        .map(|problem| format!("{}:{}: {}", problem.line(), problem.column(), problem.message()))
        .collect()
}

/// That these files have one problem, which says this, and gives a hint.
fn refused(files: &[(&str, &str)], part: &str) {
    let given = program(files).expect_err(part);
    let all = problems(files);
    assert_eq!(all.len(), 1, "{all:#?}");
    assert!(all[0].contains(part), "{} instead of {part}", all[0]);
    assert!(
        given.as_slice()[0].hint().is_some_and(|hint| !hint.is_empty()),
        "{part}"
    );
}
