//! Each language with its reader and its writer. A new language is a module, and a line in each list here.

use armill_core::frame::Isometry;
use armill_formats::document::{Problem, Problems};
use armill_formats::language::Language;

use crate::draft::{Draft, Written};
use crate::draft_check::DraftError;
use crate::program::RobotProgram;
use crate::spelling::Respelling;
use crate::text::ProgramText;
use crate::{inform, krl, rapid, tp, urscript, val3};

/// Number of lines of each file that are searched for the language.
const MOST_LINES: usize = 2000;

/// The language of these files, from the lines of the first file or its ending.
///
/// # Errors
/// Neither content nor name identifies the language.
pub fn language_of(texts: &[ProgramText]) -> Result<Language, Problems> {
    let of_lines = texts
        .iter()
        .flat_map(|text| text.text().lines().take(MOST_LINES))
        .find_map(Language::of_line);
    let of_name = || Language::of_ending(&texts.first()?.ending()?);
    // VAL3 and URScript have the same names of moves; the file endings of VAL3 are unique.
    let val3 = of_name().filter(|language| *language == Language::Val3);
    val3.or(of_lines).or_else(of_name).ok_or_else(|| {
        let name = texts.first().map_or("", ProgramText::name);
        Problems::from(Problem::of_file(
            name,
            "neither content nor file name identifies the language of this robot program",
            "supported: KUKA KRL (.src, .dat), ABB RAPID (.mod), Yaskawa INFORM (.jbi), FANUC TP (.ls), URScript \
             (.script) and Staubli VAL3 (.pjx, .dtx, .pgx)",
        ))
    })
}

/// Reads the program in these files, the main file first, in the language that their content or name shows.
///
/// # Errors
/// A language that is not recognised; all problems of the files.
pub fn read(texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    read_as(language_of(&texts)?, texts)
}

/// Reads the program in these files, the main file first, in this language.
///
/// # Errors
/// All problems of the files.
pub fn read_as(language: Language, texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
    match language {
        Language::Krl => krl::read(texts),
        Language::Rapid => rapid::read(texts),
        Language::Inform => inform::read(texts),
        Language::Tp => tp::read(texts),
        Language::UrScript => urscript::read(texts),
        Language::Val3 => val3::read(texts),
    }
}

/// Writes `draft` as a program in this language.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(language: Language, draft: &Draft) -> Result<Written, DraftError> {
    match language {
        Language::Krl => krl::write(draft),
        Language::Rapid => rapid::write(draft),
        Language::Inform => inform::write(draft),
        Language::Tp => tp::write(draft),
        Language::UrScript => urscript::write(draft),
        Language::Val3 => val3::write(draft),
    }
}

/// Writes a pose (frame to tool) in place of `before`, a target of a program as its text gives it. Other parts of the
/// target are kept, and also its orientation if only the position is rewritten.
pub(crate) fn spell(
    language: Language,
    pose: &Isometry,
    respelling: Respelling,
    before: &str,
    out: &mut String,
) {
    match language {
        Language::Krl => krl::spell(pose, respelling, before, out),
        Language::Rapid => rapid::spell(pose, respelling, before, out),
        Language::Inform => inform::spell(pose, respelling, before, out),
        Language::Tp => tp::spell(pose, respelling, before, out),
        Language::UrScript => urscript::spell(pose, respelling, before, out),
        Language::Val3 => val3::spell(pose, respelling, before, out),
    }
}
