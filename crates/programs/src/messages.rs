//! Messages on the texts of a program: problems, and notes on ignored statements and assumptions.

use std::collections::HashMap;
use std::ops::Range;

use armill_formats::document::{MOST_PROBLEMS, Problem, Problems};

use super::text::ProgramText;

/// Maximum number of different notes.
const MOST_NOTES: usize = 200;

/// Hint for brackets that do not match.
pub(super) const CLOSE_BRACKETS: &str = "close every bracket, in the order in which they were opened";

/// Problems and notes, in order, and the text that is being read: messages are on this text.
pub(super) struct ProgramMessages<'a> {
    texts: &'a [ProgramText],
    index: usize,
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

impl<'a> ProgramMessages<'a> {
    /// No messages; reading begins with the first of these texts.
    pub fn new(texts: &'a [ProgramText]) -> ProgramMessages<'a> {
        ProgramMessages {
            texts,
            index: 0,
            problems: Vec::new(),
            notes: Vec::new(),
            known: HashMap::new(),
            more: 0,
        }
    }

    /// All texts.
    pub fn texts(&self) -> &'a [ProgramText] {
        self.texts
    }

    /// The text that is being read.
    pub fn text(&self) -> &'a ProgramText {
        &self.texts[self.index]
    }

    /// The index of the text that is being read.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Reading continues in the text with this index. Returns the index of the text before.
    pub fn go_to(&mut self, index: usize) -> usize {
        std::mem::replace(&mut self.index, index)
    }

    /// Adds a problem of these bytes; at most 200 are stored.
    pub fn problem(&mut self, span: Range<usize>, message: impl Into<String>, hint: &str) {
        if self.problems.len() < MOST_PROBLEMS {
            let problem = self
                .text()
                .source()
                .problem(span, message.into(), Some(hint.to_owned()));
            self.problems.push(problem);
        }
    }

    /// Adds the problem that this mark, which closes a bracket, is missing here.
    pub fn unclosed(&mut self, place: Range<usize>, mark: char) {
        self.problem(place, format!("`{mark}` is missing here"), CLOSE_BRACKETS);
    }

    /// Whether the maximum number of problems is reached.
    pub fn is_full(&self) -> bool {
        self.problems.len() >= MOST_PROBLEMS
    }

    /// Number of problems.
    pub fn count(&self) -> usize {
        self.problems.len()
    }

    /// Adds a note on this line. The same sentence is stored once, with its first line and the number of occurrences.
    pub fn note(&mut self, line: u32, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if let Some(index) = self.known.get(&sentence) {
            self.notes[*index].times += 1;
        } else if self.notes.len() >= MOST_NOTES {
            self.more += 1;
        } else {
            self.known.insert(sentence.clone(), self.notes.len());
            self.notes.push(Note {
                sentence,
                place: format!("{}, line {line}", self.text().name()),
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
