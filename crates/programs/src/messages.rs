//! Messages on a program: problems, and notes on ignored statements and assumptions.

use std::collections::HashMap;
use std::ops::Range;

use armill_formats::document::{MOST_PROBLEMS, Problem, Problems};

use super::text::ProgramText;

/// Maximum number of different notes.
const MOST_NOTES: usize = 200;

/// Problems and notes, in order.
#[derive(Default)]
pub(super) struct ProgramMessages {
    problems: Vec<Problem>,
    notes: Vec<Note>,
    known: HashMap<String, usize>,
    more: usize,
}

struct Note {
    sentence: String,
    place: String,
    times: usize,
}

impl ProgramMessages {
    /// Adds a problem of these bytes; at most 200 are stored.
    pub fn problem(&mut self, text: &ProgramText, span: Range<usize>, message: String, hint: &str) {
        if self.problems.len() < MOST_PROBLEMS {
            self.problems
                .push(text.source().problem(span, message, Some(hint.to_owned())));
        }
    }

    /// Whether the maximum number of problems is reached.
    pub fn is_full(&self) -> bool {
        self.problems.len() >= MOST_PROBLEMS
    }

    /// Number of problems.
    pub fn count(&self) -> usize {
        self.problems.len()
    }

    /// Adds a note. The same sentence is stored once, with its first line and the number of occurrences.
    pub fn note(&mut self, (text, line): (&ProgramText, u32), sentence: impl Into<String>) {
        let sentence = sentence.into();
        if let Some(index) = self.known.get(&sentence) {
            self.notes[*index].times += 1;
        } else if self.notes.len() >= MOST_NOTES {
            self.more += 1;
        } else {
            self.known.insert(sentence.clone(), self.notes.len());
            self.notes.push(Note {
                sentence,
                place: format!("{}, line {line}", text.name()),
                times: 1,
            });
        }
    }

    /// The notes, or the problems if there are any.
    pub fn finish(self) -> Result<Vec<String>, Problems> {
        Problems::from(self.problems).into_result()?;
        let more = (self.more > 0).then(|| format!("{} more notes of other kinds", self.more));
        let notes = self.notes.into_iter().map(|note| match note.times {
            1 => format!("{}: {}", note.place, note.sentence),
            times => format!("{}: {} ({times} times, first here)", note.place, note.sentence),
        });
        Ok(notes.chain(more).collect())
    }
}

/// The beginning of `text`, for messages.
pub(super) fn shown(text: &str) -> &str {
    let end = text.char_indices().nth(40).map_or(text.len(), |(at, _)| at);
    &text[..end]
}
