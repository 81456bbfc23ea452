//! What a reader has to say of a program: problems, at most 200, and notes, each thing once with its first line.

use std::collections::HashMap;
use std::ops::Range;

use super::text::ProgramText;
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// So many different notes are kept; what comes behind says nothing new.
const MOST_NOTES: usize = 200;

/// Problems and notes of the files of one program.
#[derive(Default)]
pub(super) struct Findings {
    problems: Vec<Problem>,
    notes: Vec<Note>,
    known: HashMap<String, usize>,
}

struct Note {
    place: String,
    times: u32,
    what: String,
}

impl Findings {
    /// Something is wrong at these bytes.
    pub fn problem(&mut self, text: &ProgramText, span: Range<usize>, message: String, hint: &str) {
        if !self.is_full() {
            self.problems
                .push(text.source().problem(span, message, Some(hint.to_owned())));
        }
    }

    /// Whether more problems are not looked for.
    pub fn is_full(&self) -> bool {
        self.problems.len() >= MOST_PROBLEMS
    }

    /// Something was passed over or taken for granted: a clause that begins in lower case, without its line.
    pub fn note(&mut self, text: &ProgramText, line: u32, what: impl Into<String>) {
        let what = what.into();
        if let Some(known) = self.known.get(&what).and_then(|at| self.notes.get_mut(*at)) {
            known.times += 1;
        } else if self.notes.len() < MOST_NOTES {
            self.known.insert(what.clone(), self.notes.len());
            self.notes.push(Note {
                place: format!("{}:{line}", text.name()),
                times: 1,
                what,
            });
        }
    }

    /// The notes, if nothing is wrong.
    ///
    /// # Errors
    /// What is wrong.
    pub fn finish(self) -> Result<Vec<String>, Problems> {
        if !self.problems.is_empty() {
            return Err(self.problems.into());
        }
        let told = self.notes.into_iter().map(|note| match note.times {
            1 => format!("{}: {}", note.place, note.what),
            more => format!("{} and {} more: {}", note.place, more - 1, note.what),
        });
        Ok(told.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_is_noted_once_with_its_first_line_and_how_often_it_came() {
        let text = ProgramText::new("a.jbi", b"x\ny\n");
        let mut findings = Findings::default();
        findings.note(&text, 1, "a call is passed over");
        findings.note(&text, 2, "a call is passed over");
        findings.note(&text, 2, "a loop runs once");
        let told = findings.finish().unwrap();
        assert_eq!(
            told,
            [
                "a.jbi:1 and 1 more: a call is passed over",
                "a.jbi:2: a loop runs once"
            ]
        );
    }

    #[test]
    fn no_more_than_200_problems_are_told() {
        let text = ProgramText::new("a.jbi", b"x");
        let mut findings = Findings::default();
        for _ in 0..300 {
            findings.problem(&text, 0..1, "wrong".to_owned(), "");
        }
        assert!(findings.is_full());
        assert_eq!(findings.finish().unwrap_err().as_slice().len(), MOST_PROBLEMS);
    }
}
