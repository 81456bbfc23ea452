//! The language of a program: recognised from its lines, otherwise from its file name.

use armill_core::frame::Isometry;

use super::program::RobotProgram;
use super::spelling::Respelling;
use super::text::ProgramText;
use super::{inform, krl, rapid, tp, urscript, val3};
use crate::document::{Problem, Problems};

/// A language of robot controllers that is read and written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// KUKA KRL.
    Krl,
    /// ABB RAPID.
    Rapid,
    /// Yaskawa INFORM.
    Inform,
    /// FANUC TP.
    Tp,
    /// URScript.
    UrScript,
    /// Staubli VAL3.
    Val3,
}

/// Number of lines that are searched.
const MOST_LINES: usize = 2000;

impl Language {
    /// Every language.
    pub const ALL: [Language; 6] = [
        Language::Krl,
        Language::Rapid,
        Language::Inform,
        Language::Tp,
        Language::UrScript,
        Language::Val3,
    ];

    /// Its name in options and results.
    pub fn name(self) -> &'static str {
        match self {
            Language::Krl => "krl",
            Language::Rapid => "rapid",
            Language::Inform => "inform",
            Language::Tp => "tp",
            Language::UrScript => "urscript",
            Language::Val3 => "val3",
        }
    }

    /// Its name with the manufacturer, for messages.
    pub fn title(self) -> &'static str {
        match self {
            Language::Krl => "KUKA KRL",
            Language::Rapid => "ABB RAPID",
            Language::Inform => "Yaskawa INFORM",
            Language::Tp => "FANUC TP",
            Language::UrScript => "URScript",
            Language::Val3 => "Staubli VAL3",
        }
    }

    /// Endings of its file names, the main file's first; lower case.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Language::Krl => &["src", "dat"],
            Language::Rapid => &["mod", "prg"],
            Language::Inform => &["jbi"],
            Language::Tp => &["ls"],
            Language::UrScript => &["script", "urscript"],
            Language::Val3 => &["pjx", "pgx", "dtx"],
        }
    }

    /// Line beginnings of this language only; upper case.
    fn beginnings(self) -> &'static [&'static str] {
        match self {
            Language::Krl => &[
                "&ACCESS", "&REL", "PTP {", "LIN {", "PTP_REL", "LIN_REL", "DEFDAT ", "PTP $", "$VEL.CP",
            ],
            Language::Rapid => &[
                "%%%",
                "MODULE ",
                "MOVEL ",
                "MOVEJ ",
                "MOVEABSJ ",
                "PERS ",
                "CONST ROBTARGET",
                "CONST JOINTTARGET",
            ],
            Language::Inform => &["/JOB", "//NAME", "//POS", "//INST", "///"],
            Language::Tp => &["/PROG", "/ATTR", "/MN", "/POS"],
            Language::UrScript => &["MOVEL(", "MOVEJ(", "MOVEP(", "MOVEC(", "SET_TCP("],
            Language::Val3 => &[
                "<PROGRAM XMLNS",
                "<PROGRAMS XMLNS",
                "<PROJECT XMLNS",
                "<DATABASE XMLNS",
            ],
        }
    }

    /// The language of a line, if it belongs to only one.
    pub fn of_line(line: &str) -> Option<Language> {
        let begin: String = line
            .trim_start()
            .chars()
            .take(24)
            .collect::<String>()
            .to_uppercase();
        Language::ALL
            .into_iter()
            .find(|language| language.beginnings().iter().any(|known| begin.starts_with(known)))
    }

    /// The language of this file ending; lower case.
    pub fn of_ending(ending: &str) -> Option<Language> {
        Language::ALL
            .into_iter()
            .find(|language| language.endings().contains(&ending))
    }

    /// The language of these files, from the lines of the first file or its ending.
    ///
    /// # Errors
    /// Neither content nor name identifies the language.
    pub fn of(texts: &[ProgramText]) -> Result<Language, Problems> {
        let of_lines = texts
            .iter()
            .flat_map(|text| text.text().lines().take(MOST_LINES))
            .find_map(Language::of_line);
        let ending = |text: &ProgramText| {
            let (_, ending) = text.name().rsplit_once('.')?;
            Some(ending.to_lowercase())
        };
        let of_name = || {
            let ending = texts.first().and_then(ending)?;
            Language::of_ending(&ending)
        };
        // VAL3 and URScript have the same names of moves; the file endings of VAL3 are unique.
        let val3 = of_name().filter(|language| *language == Language::Val3);
        val3.or(of_lines).or_else(of_name).ok_or_else(|| {
            let name = texts.first().map_or("", ProgramText::name);
            let message = "neither content nor file name identifies the language of this robot program";
            Problems::from(Problem::of_file(
                name,
                message,
                "supported: KUKA KRL (.src, .dat), ABB RAPID (.mod), Yaskawa INFORM (.jbi), FANUC TP (.ls), URScript \
                 (.script) and \
                 Staubli VAL3 (.pjx, .dtx, .pgx)",
            ))
        })
    }

    /// Reads the program in these files, which is in this language.
    ///
    /// # Errors
    /// Every problem of the files.
    pub fn read(self, texts: Vec<ProgramText>) -> Result<RobotProgram, Problems> {
        match self {
            Language::Krl => krl::read(texts),
            Language::Rapid => rapid::read(texts),
            Language::Inform => inform::read(texts),
            Language::Tp => tp::read(texts),
            Language::UrScript => urscript::read(texts),
            Language::Val3 => val3::read(texts),
        }
    }

    /// Writes a pose (frame to tool) in place of `before`, which is another target of the same program. Other parts of
    /// the target are kept, and also its orientation if only the position is new.
    pub(super) fn spell(self, pose: (&Isometry, Respelling), before: &str, out: &mut String) {
        match self {
            Language::Krl => krl::spell(pose, before, out),
            Language::Rapid => rapid::spell(pose, before, out),
            Language::Inform => inform::spell(pose, before, out),
            Language::Tp => tp::spell(pose, before, out),
            Language::UrScript => urscript::spell(pose, before, out),
            Language::Val3 => val3::spell(pose, before, out),
        }
    }
}
