//! The languages of robot controllers: their names, file endings, and lines that only one of them has.
//!
//! The crate `armill-programs` reads and writes the programs.

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
}
