//! Studies of the cases, run as a user's study is run.
//!
//! A case of this kind goes through the whole program but its command: the text is read and checked, points are
//! created and evaluated, and the answer is that of `result.json`. No file is read except the study itself,
//! none is written.

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::answer::{PathAnswer, StudyAnswer, answer};
use armill_study::file::resolve::read;
use armill_study::run::run;

/// The answer to the study in this text, which `path` names in messages. Not checked: that the study is sound;
/// a slip in the text of a case ends the program.
pub fn answer_to(path: &str, text: &str) -> StudyAnswer {
    let study = match read(path, Path::new("."), text.as_bytes()) {
        Ok(study) => study,
        Err(problems) => unreachable!("the study of a case is sound: {problems}"),
    };
    let found =
        run(&study, Watch::NONE).expect("the run is not cancelled and the arm has compliance and inverse");
    answer(&study, &found)
}

/// The path of this name; the study of the case has it.
pub fn path<'a>(answer: &'a StudyAnswer, name: &str) -> &'a PathAnswer {
    answer
        .paths
        .iter()
        .find(|path| path.name == name)
        .expect("the study has this path")
}
