//! The modal interpreter: lines in, canonical calls out, with all that is refused.
//!
//! Lines are done as they come. Only subroutines and loops are kept, within [`MOST_KEPT_BYTES`].
//!
//! ```text
//! line -> Clean -> o-word?  yes: kept to its end, gone through or called (`flow`, `walk`)
//!                           no:  comments, words (`block`), settings, execute (`execute`) -> canonical calls
//! ```
//!
//! A line that is refused is left out as a whole or from that word on; the next is done with the state as it then is,
//! and no line is given twice. After [`MOST_FAULTS`] faults, and after what may never end, the rest is not looked at.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::rc::Rc;

use super::block::{Block, Clean};
use super::canonical::Canonical;
use super::execute::Outcome;
use super::expression::{Name, Values};
use super::flow::{Body, Keyword, OWord, o_word};
use super::labels::Labels;
use super::lines::{Line, Lines};
use super::machine::Machine;
use super::messages;
use super::parameters::{self, Parameters};
use super::read_options::{GcodeReadOptions, Warning};
use super::refusal::{Excess, Fault, Refusal};
use crate::toolpath::notes::Notes;

/// Maximum number of problems reported for one program.
pub const MOST_FAULTS: usize = 100;
/// Text of subroutines and loops.
pub const MOST_KEPT_BYTES: usize = 256 << 20;
/// Subroutines that call each other.
pub const MOST_CALLS_DEEP: usize = 100;
/// Lines of subroutines and loops that are done, repetitions counted.
pub const MOST_REPEATED_LINES: usize = 20_000_000;
/// The same after the first line that was refused.
pub const MOST_REPEATED_AFTER_FAULT: usize = 10_000;
/// Canonical calls of one line: what cycles may expand to.
pub const MOST_CALLS_OF_A_LINE: usize = 5_000_000;

/// What is left to say after a program.
#[derive(Clone, Debug, Default)]
pub struct Interpreted {
    /// What was refused, in the order it was met.
    pub faults: Vec<Fault>,
    /// What has no part in the path, or was taken for granted.
    pub notes: Notes<Warning>,
}

/// Receiver of the canonical calls, each with its line; a refusal is reported at the line.
pub type Receiver<'a> = &'a mut dyn FnMut(Canonical, u32) -> Result<(), Refusal>;

/// Interprets a program; the calls go to `out` while it is read.
///
/// Ends at M2 or M30, at a return outside of subroutines, at a second `%` or at the end of the text.
pub fn interpret(
    reader: &mut dyn BufRead,
    requested: &GcodeReadOptions<'_>,
    out: Receiver<'_>,
) -> Interpreted {
    let mut interpreter = Interpreter {
        machine: Machine::new(requested),
        requested,
        out,
        block: Block::new(),
        clean: Clean::default(),
        subroutines: BTreeMap::new(),
        labels: Labels::default(),
        kept_bytes: 0,
        repeated: 0,
        repeated_until_fault: 0,
        depth: 0,
        faults: Vec::new(),
        refused: BTreeSet::new(),
        stopped: false,
    };
    interpreter.program(&mut Lines::new(reader, None));
    Interpreted {
        faults: interpreter.faults,
        notes: interpreter.machine.notes,
    }
}

/// A program as far as it was followed.
pub(super) struct Interpreter<'a> {
    /// Modes, offsets, position.
    pub machine: Machine,
    pub requested: &'a GcodeReadOptions<'a>,
    /// Takes the calls.
    out: Receiver<'a>,
    /// The words of the line at hand.
    block: Block,
    /// The text of the line that was cleaned last.
    pub clean: Clean,
    /// Those that are known, by label or name.
    pub subroutines: BTreeMap<String, Rc<Body>>,
    pub labels: Labels,
    /// Of lines kept so far.
    kept_bytes: usize,
    /// Executed lines of loops and subroutines, repetitions included.
    pub repeated: usize,
    /// The same when the first line was refused.
    pub repeated_until_fault: usize,
    /// Subroutines being called.
    pub depth: usize,
    pub faults: Vec<Fault>,
    /// Refused lines, which are not reported again in the next round of their loop.
    refused: BTreeSet<(Option<Rc<str>>, u32)>,
    /// Whether nothing more is looked at.
    pub stopped: bool,
}

/// How it goes on behind lines that were done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// With the next line.
    Next,
    /// Behind the call of this subroutine.
    Return,
    /// Not at all.
    End,
}

impl Interpreter<'_> {
    /// Goes through the program itself, from its first line.
    fn program(&mut self, lines: &mut Lines<'_>) {
        let mut line = Line::default();
        let mut begun = false;
        if let Err(refusal) = self.machine.begin(self.out) {
            self.fault(&line, refusal, 0..0);
        }
        while !self.stopped {
            match lines.next(&mut line) {
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => {
                    let end = line.text.len();
                    self.fault(&line, Refusal::Unreadable(error.to_string()), end..end);
                    break;
                }
            }
            if line.text.trim_ascii() == b"%" {
                // The first begins the program, the second ends it.
                if begun {
                    break;
                }
                begun = true;
                continue;
            }
            begun |= !line.text.trim_ascii().is_empty();
            let left = match self.o_word_of(&line) {
                Ok(Some(word)) => self.open(word, &mut line, lines),
                Ok(None) => self.execute_cleaned(&line, Some(lines)),
                Err(()) => Flow::Next,
            };
            if left != Flow::Next {
                break;
            }
        }
        let Interpreter { machine, out, .. } = self;
        if let Err(refusal) = machine.cutter.end(*out) {
            self.fault(&line, refusal, 0..0);
        }
    }

    /// Cleans a line; its o-word, if it is one.
    ///
    /// Problems are reported here; `Err` means that there was one. A line that is left out (`/`) is empty.
    pub fn o_word_of(&mut self, line: &Line) -> Result<Option<OWord>, ()> {
        if let Err(refused) = self.clean.read(&line.text) {
            self.fault(line, refused.refusal, refused.place);
            return Err(());
        }
        if self.clean.deleted && self.requested.block_delete {
            self.clean.text.clear();
        }
        match o_word(&self.clean, &self.machine) {
            Ok(word) => Ok(word),
            Err(refusal) => {
                self.fault(line, refusal, 0..line.text.len());
                Err(())
            }
        }
    }

    /// An o-word outside of what is kept.
    ///
    /// Branches and loops are kept to their end and gone through at once, subroutines kept for their calls.
    fn open(&mut self, word: OWord, line: &mut Line, lines: &mut Lines<'_>) -> Flow {
        match word.keyword {
            Keyword::Sub | Keyword::If | Keyword::While | Keyword::Do | Keyword::Repeat => {
                let label = word.label.clone();
                let sub = word.keyword == Keyword::Sub;
                let Some(body) = self.collect(word, line, lines) else {
                    return Flow::Next;
                };
                if sub {
                    self.subroutines.insert(label, body);
                    return Flow::Next;
                }
                self.run(&body)
            }
            Keyword::Call => self.call(&word, line),
            Keyword::Label => Flow::Next,
            _ => {
                self.fault(line, Refusal::FlowUnopened(word.label), 0..line.text.len());
                Flow::Next
            }
        }
    }

    /// Counts a stored line of what begins at `start`; `None` if there are too many, which is reported there.
    pub fn keep(&mut self, line: &Line, start: &Line) -> Option<()> {
        self.kept_bytes += line.text.len() + size_of::<Line>();
        if self.kept_bytes <= MOST_KEPT_BYTES {
            return Some(());
        }
        let refusal = Refusal::TooMuch {
            what: Excess::KeptBytes,
            limit: MOST_KEPT_BYTES,
        };
        self.fault(start, refusal, 0..start.text.len());
        self.stopped = true;
        None
    }

    /// Keeps lines from one that begins a subroutine, branch or loop to the one that ends it.
    ///
    /// Only the o-words of the lines between are checked. `None` if there is a problem, which is reported; of a
    /// subroutine its first line is not kept.
    pub fn collect(&mut self, first: OWord, line: &mut Line, lines: &mut Lines<'_>) -> Option<Rc<Body>> {
        let begins = first.keyword;
        let label = first.label.clone();
        let start = line.clone();
        let mut body = Body::default();
        let sub = begins == Keyword::Sub;
        if !sub {
            body.push(line.clone(), Some(first));
        }
        let mut sound = true;
        loop {
            match lines.next(line) {
                Ok(true) => {}
                Ok(false) | Err(_) => {
                    self.fault(&start, Refusal::FlowUnclosed(label), 0..start.text.len());
                    return None;
                }
            }
            self.keep(line, &start)?;
            let word = match self.o_word_of(line) {
                Ok(word) => word,
                Err(()) => {
                    sound = false;
                    None
                }
            };
            let keyword = word.as_ref().map(|word| word.keyword);
            let same = word.as_ref().is_some_and(|word| word.label == label);
            if keyword == Some(Keyword::Sub) {
                self.fault(line, Refusal::NestedSubroutine, 0..line.text.len());
                sound = false;
            }
            let ends = same
                && matches!(
                    (begins, keyword),
                    (Keyword::Sub, Some(Keyword::EndSub))
                        | (Keyword::If, Some(Keyword::EndIf))
                        | (Keyword::While, Some(Keyword::EndWhile))
                        | (Keyword::Do, Some(Keyword::While))
                        | (Keyword::Repeat, Some(Keyword::EndRepeat))
                );
            body.push(line.clone(), word);
            if ends {
                break;
            }
        }
        self.linked(body).filter(|_| sound)
    }

    /// Stored lines with their continuations; unmatched o-words are reported.
    pub fn linked(&mut self, mut body: Body) -> Option<Rc<Body>> {
        if let Err((index, refusal)) = body.link() {
            let line = body
                .lines
                .get(index)
                .map(|kept| kept.line.clone())
                .unwrap_or_default();
            let end = line.text.len();
            self.fault(&line, refusal, 0..end);
            return None;
        }
        Some(Rc::new(body))
    }

    /// Executes a stored line after cleaning it again.
    ///
    /// Reported faults are not reported again.
    pub fn execute_kept(&mut self, line: &Line) -> Flow {
        if self.clean.read(&line.text).is_err() {
            // Reported when it was stored.
            return Flow::Next;
        }
        if self.clean.deleted && self.requested.block_delete {
            return Flow::Next;
        }
        self.execute_cleaned(line, None)
    }

    /// Does the line that was cleaned last.
    ///
    /// Comments speak first, then parameters are set, then the block is done. `lines` are those still to come, where
    /// M98 may find its subroutine.
    fn execute_cleaned(&mut self, line: &Line, lines: Option<&mut Lines<'_>>) -> Flow {
        self.machine.line = line.number;
        self.machine.cutter.line = line.number;
        let mut calls = 0;
        let Interpreter {
            machine,
            block,
            clean,
            out,
            ..
        } = self;
        let mut counted = |call: Canonical, line: u32| {
            calls += 1;
            if calls > MOST_CALLS_OF_A_LINE {
                let limit = MOST_CALLS_OF_A_LINE;
                return Err(Refusal::TooMuch {
                    what: Excess::MovesOfALine,
                    limit,
                });
            }
            out(call, line)
        };
        let mut result = Ok(());
        for (start, end) in &clean.comments {
            let comment = line.text.get(*start..*end).unwrap_or_default();
            if let Some(text) = messages::message(comment, machine) {
                result = result.and_then(|()| machine.call(Canonical::Message(text), &mut counted));
            }
        }
        if let Err(refusal) = result {
            self.fault(line, refusal, 0..line.text.len());
            return Flow::Next;
        }
        if clean.text.is_empty() {
            return Flow::Next;
        }
        if let Err(refused) = block.read(clean, 0, machine) {
            self.fault(line, refused.refusal, refused.place);
            return Flow::Next;
        }
        let done = settings(machine, block).and_then(|()| machine.execute(block, &mut counted));
        match done {
            Ok(Outcome::Next) => Flow::Next,
            Ok(Outcome::End) => Flow::End,
            Ok(Outcome::Return) => Flow::Return,
            Ok(Outcome::Call(call)) => self.call_numbered(call, line, lines),
            Err(refusal) => {
                let place = self.block.place_of(&refusal).unwrap_or(0..self.clean.text.len());
                let place = self.clean.place(place);
                self.fault(line, refusal, place);
                Flow::Next
            }
        }
    }

    /// Stores a refusal with the bytes of its line. A refusal from an earlier round of a loop is not reported
    /// again.
    pub fn fault(&mut self, line: &Line, refusal: Refusal, place: std::ops::Range<usize>) {
        let never_ends = matches!(refusal, Refusal::TooMuch { .. });
        self.stopped |= never_ends;
        if !self.refused.insert((line.file.clone(), line.number)) && !never_ends {
            return;
        }
        // Bytes that are no UTF-8 take more of them in the text that is shown.
        let shown = |end: usize| String::from_utf8_lossy(line.text.get(..end).unwrap_or(&line.text)).len();
        self.faults.push(Fault {
            refusal,
            line: line.number.max(1),
            place: shown(place.start)..shown(place.end),
            text: String::from_utf8_lossy(&line.text).into_owned(),
            file: line.file.as_deref().map(str::to_owned),
            offset: line.offset,
        });
        self.stopped |= self.faults.len() >= MOST_FAULTS;
    }
}

/// Sets the parameters of a block.
///
/// # Errors
/// An invalid parameter, a read-only one, too many names.
fn settings(machine: &mut Machine, block: &Block) -> Result<(), Refusal> {
    for (name, value) in &block.settings {
        match name {
            Name::Numbered(number) => {
                let index = Parameters::index(*number)?;
                if parameters::READ_ONLY.contains(&index) {
                    return Err(Refusal::ParameterReadOnly(format!("#{index}")));
                }
                machine.parameters.set_numbered(index, *value);
            }
            Name::Named(name) => {
                let own = machine.parameters.named(name).is_some();
                if !own && machine.named(name).is_some() {
                    let shown = String::from_utf8_lossy(name).into_owned();
                    return Err(Refusal::ParameterReadOnly(format!("#<{shown}>")));
                }
                machine.parameters.set_named(name, *value)?;
            }
        }
    }
    Ok(())
}
