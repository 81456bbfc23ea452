//! The modal interpreter: lines in, canonical calls out, with all that is refused.
//!
//! Lines are done as they come. Only subroutines and loops are kept, within [`MOST_KEPT_BYTES`].

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::rc::Rc;

use super::block::{Block, Clean};
use super::canonical::Canonical;
use super::execute::Outcome;
use super::expression::{Name, Reader, Values};
use super::flow::{Body, Keyword, OWord, o_word};
use super::lines::{Line, Lines};
use super::machine::Machine;
use super::messages;
use super::options::{Options, Warnings};
use super::parameters::{self, Parameters};
use super::refusal::{Fault, Refusal};

/// Problems told of one program.
pub const MOST_FAULTS: usize = 100;
/// Text of subroutines and loops.
pub const MOST_KEPT_BYTES: usize = 256 << 20;
/// Subroutines that call each other.
pub const MOST_CALLS_DEEP: usize = 100;
/// Lines of subroutines and loops that are done, repetitions counted.
pub const MOST_REPEATED_LINES: usize = 20_000_000;
/// Canonical calls of one line: what cycles may expand to.
pub const MOST_CALLS_OF_A_LINE: usize = 5_000_000;

/// What is left to say after a program.
#[derive(Clone, Debug, Default)]
pub struct Told {
    /// What was refused, in the order it was met.
    pub faults: Vec<Fault>,
    /// What has no part in the path, or was taken for granted.
    pub warnings: Warnings,
    /// Lines of the program that were read.
    pub lines: u32,
}

/// What receives the canonical calls, each with its line; what it refuses is told at the line.
pub type Receiver<'a> = &'a mut dyn FnMut(Canonical, u32) -> Result<(), Refusal>;

/// Interprets a program; the calls go to `out` while it is read.
pub fn interpret(reader: &mut dyn BufRead, options: &Options<'_>, out: Receiver<'_>) -> Told {
    let mut interpreter = Interpreter {
        machine: Machine::new(options),
        options,
        out,
        block: Block::new(),
        clean: Clean::default(),
        subroutines: BTreeMap::new(),
        kept_bytes: 0,
        repeated: 0,
        depth: 0,
        faults: Vec::new(),
        refused: BTreeSet::new(),
        stopped: false,
    };
    let lines = interpreter.program(&mut Lines::new(reader));
    Told {
        faults: interpreter.faults,
        warnings: interpreter.machine.warnings,
        lines,
    }
}

struct Interpreter<'a> {
    machine: Machine,
    options: &'a Options<'a>,
    out: Receiver<'a>,
    block: Block,
    clean: Clean,
    subroutines: BTreeMap<String, Rc<Body>>,
    kept_bytes: usize,
    repeated: usize,
    /// Subroutines being called.
    depth: usize,
    faults: Vec<Fault>,
    /// Lines refused once are not told again in the next round of their loop.
    refused: BTreeSet<(Option<Rc<str>>, u32)>,
    stopped: bool,
}

/// How lines were left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Left {
    AtEnd,
    Returning,
    Finished,
}

impl Interpreter<'_> {
    fn program(&mut self, lines: &mut Lines<'_>) -> u32 {
        let mut line = Line::default();
        let mut begun = false;
        let mut count = 0;
        if let Err(refusal) = self.machine.begin(self.out) {
            self.fault(&line, refusal, 0..0);
        }
        while !self.stopped {
            match lines.next(&mut line) {
                Ok(true) => count = line.number,
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
                Ok(Some(word)) => self.begins(word, &mut line, lines),
                Ok(None) => self.one(&line, Some(lines)),
                Err(()) => Left::AtEnd,
            };
            if left != Left::AtEnd {
                break;
            }
        }
        let Interpreter { machine, out, .. } = self;
        if let Err(refusal) = machine.cutter.end(*out) {
            self.fault(&line, refusal, 0..0);
        }
        count
    }

    /// Cleans a line; its o-word, if it is one.
    fn o_word_of(&mut self, line: &Line) -> Result<Option<OWord>, ()> {
        if let Err(refused) = self.clean.read(&line.text) {
            self.fault(line, refused.refusal, refused.place);
            return Err(());
        }
        if self.clean.deleted && self.options.block_delete {
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
    fn begins(&mut self, word: OWord, line: &mut Line, lines: &mut Lines<'_>) -> Left {
        match word.keyword {
            Keyword::Sub | Keyword::If | Keyword::While | Keyword::Do | Keyword::Repeat => {
                let label = word.label.clone();
                let sub = word.keyword == Keyword::Sub;
                let Some(body) = self.collect(word, line, lines) else {
                    return Left::AtEnd;
                };
                if sub {
                    self.subroutines.insert(label, body);
                    return Left::AtEnd;
                }
                self.run(&body)
            }
            Keyword::Call => self.call(&word, line),
            Keyword::Label => Left::AtEnd,
            _ => {
                self.fault(line, Refusal::FlowUnopened(word.label), 0..line.text.len());
                Left::AtEnd
            }
        }
    }

    /// Keeps lines from one that begins a subroutine, branch or loop to the one that ends it.
    fn collect(&mut self, first: OWord, line: &mut Line, lines: &mut Lines<'_>) -> Option<Rc<Body>> {
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
            self.kept_bytes += line.text.len() + size_of::<Line>();
            if self.kept_bytes > MOST_KEPT_BYTES {
                let limit = MOST_KEPT_BYTES;
                let refusal = Refusal::TooMuch {
                    what: "bytes of subroutines and loops",
                    limit,
                };
                self.fault(&start, refusal, 0..start.text.len());
                self.stopped = true;
                return None;
            }
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

    fn linked(&mut self, mut body: Body) -> Option<Rc<Body>> {
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

    /// Goes through kept lines.
    fn run(&mut self, body: &Rc<Body>) -> Left {
        let mut at = 0;
        // Repeats that are open, with the rounds still to go.
        let mut repeats: Vec<(usize, u64)> = Vec::new();
        while let Some(kept) = body.lines.get(at) {
            self.repeated += 1;
            if self.repeated > MOST_REPEATED_LINES {
                let limit = MOST_REPEATED_LINES;
                let refusal = Refusal::TooMuch {
                    what: "lines of loops and subroutines to be done",
                    limit,
                };
                self.fault(&kept.line, refusal, 0..kept.line.text.len());
                self.stopped = true;
            }
            if self.stopped {
                return Left::Finished;
            }
            let line = &kept.line;
            let Some(word) = &kept.word else {
                match self.again(line) {
                    Left::AtEnd => at += 1,
                    left => return left,
                }
                continue;
            };
            let skip_to = kept.partner;
            at = match word.keyword {
                Keyword::If => match self.holds(line, word) {
                    true => at + 1,
                    false => self.branch(body, skip_to),
                },
                Keyword::ElseIf | Keyword::Else => kept.end + 1,
                Keyword::While => match self.holds(line, word) {
                    true => at + 1,
                    false => skip_to + 1,
                },
                Keyword::EndWhile => skip_to,
                Keyword::DoWhile => match self.holds(line, word) {
                    true => skip_to + 1,
                    false => at + 1,
                },
                Keyword::Repeat => {
                    // Counts below one give no round at all.
                    let rounds = self.value(line, word).unwrap_or_default().round().max(0.0) as u64;
                    if rounds == 0 {
                        skip_to + 1
                    } else {
                        repeats.push((at, rounds));
                        at + 1
                    }
                }
                Keyword::EndRepeat => match repeats.last_mut() {
                    Some((first, left)) if *left > 1 => {
                        *left -= 1;
                        *first + 1
                    }
                    _ => {
                        repeats.pop();
                        at + 1
                    }
                },
                Keyword::Break => {
                    repeats.retain(|(first, _)| *first < skip_to);
                    body.lines.get(skip_to).map_or(at, |first| first.end) + 1
                }
                Keyword::Continue => {
                    repeats.retain(|(first, _)| *first <= skip_to);
                    body.lines.get(skip_to).map_or(at, |first| {
                        match first.word.as_ref().map(|word| word.keyword) {
                            Some(Keyword::While) => skip_to,
                            _ => first.end,
                        }
                    })
                }
                Keyword::Return | Keyword::EndSub => {
                    self.returns(line, word);
                    return Left::Returning;
                }
                Keyword::Call => match self.call(word, line) {
                    Left::AtEnd => at + 1,
                    left => return left,
                },
                _ => at + 1,
            };
        }
        Left::AtEnd
    }

    /// The branch that holds after a condition that does not.
    fn branch(&mut self, body: &Rc<Body>, mut at: usize) -> usize {
        while let Some(kept) = body.lines.get(at) {
            match &kept.word {
                Some(word) if word.keyword == Keyword::ElseIf && !self.holds(&kept.line, word) => {
                    at = kept.partner
                }
                _ => break,
            }
        }
        at + 1
    }

    fn holds(&mut self, line: &Line, word: &OWord) -> bool {
        self.value(line, word).is_some_and(|value| value != 0.0)
    }

    /// The bracketed value behind an o-word.
    fn value(&mut self, line: &Line, word: &OWord) -> Option<f64> {
        let mut values = self.values_behind(line, word)?;
        if values.len() != 1 {
            self.fault(line, Refusal::Expected('['), 0..line.text.len());
        }
        values.pop()
    }

    /// All bracketed values behind an o-word.
    fn values_behind(&mut self, line: &Line, word: &OWord) -> Option<Vec<f64>> {
        // Lines kept were cleaned without fault when they came.
        self.clean.read(&line.text).ok()?;
        self.machine.line = line.number;
        let mut reader = Reader::new(&self.clean.text, word.rest, &self.machine);
        let mut values = Vec::new();
        let mut refusal = None;
        while reader.at < self.clean.text.len() {
            if values.len() >= parameters::LOCALS {
                refusal = Some(Refusal::TooManyArguments {
                    limit: parameters::LOCALS,
                });
                break;
            }
            match reader.bracketed() {
                Ok(value) => values.push(value),
                Err(Refusal::Expected('[')) => {
                    refusal = Some(Refusal::FlowTrailing);
                    break;
                }
                Err(found) => {
                    refusal = Some(found);
                    break;
                }
            }
        }
        if let Some(refusal) = refusal {
            let place = self.clean.place(word.rest..self.clean.text.len());
            self.fault(line, refusal, place);
            return None;
        }
        Some(values)
    }

    fn returns(&mut self, line: &Line, word: &OWord) {
        let value = self
            .values_behind(line, word)
            .and_then(|values| values.first().copied());
        let given = f64::from(u8::from(value.is_some()));
        let set = self
            .machine
            .parameters
            .set_named(b"_value", value.unwrap_or_default())
            .and_then(|()| self.machine.parameters.set_named(b"_value_returned", given));
        if let Err(refusal) = set {
            self.fault(line, refusal, 0..line.text.len());
        }
    }

    fn call(&mut self, word: &OWord, line: &Line) -> Left {
        let Some(arguments) = self.values_behind(line, word) else {
            return Left::AtEnd;
        };
        let Some(body) = self.subroutine(&word.label) else {
            self.fault(
                line,
                Refusal::SubroutineUnknown(word.label.clone()),
                0..line.text.len(),
            );
            return Left::AtEnd;
        };
        self.machine.parameters.enter(&arguments);
        let left = self.called(&body, line);
        self.machine.parameters.leave();
        left
    }

    fn called(&mut self, body: &Rc<Body>, line: &Line) -> Left {
        if self.depth >= MOST_CALLS_DEEP {
            self.fault(
                line,
                Refusal::CallsTooDeep {
                    limit: MOST_CALLS_DEEP,
                },
                0..line.text.len(),
            );
            self.stopped = true;
            return Left::Finished;
        }
        self.depth += 1;
        let left = self.run(body);
        self.depth -= 1;
        match left {
            Left::Finished => Left::Finished,
            _ => Left::AtEnd,
        }
    }

    /// A subroutine of the program or of another file.
    fn subroutine(&mut self, name: &str) -> Option<Rc<Body>> {
        if let Some(body) = self.subroutines.get(name) {
            return Some(body.clone());
        }
        let text = self.options.subroutines.and_then(|lookup| lookup(name))?;
        let file: Rc<str> = Rc::from(name);
        let mut reader = text.as_bytes();
        let mut lines = Lines::new(&mut reader);
        let mut line = Line::default();
        let mut whole = Body::default();
        while let Ok(true) = lines.next(&mut line) {
            line.file = Some(file.clone());
            let word = self.o_word_of(&line).ok().flatten();
            match word {
                Some(word) if word.keyword == Keyword::Sub => {
                    let label = word.label.clone();
                    let body = self.collect(word, &mut line, &mut lines)?;
                    self.subroutines.insert(label, body);
                }
                word => whole.push(line.clone(), word),
            }
        }
        if !self.subroutines.contains_key(name) {
            let body = self.linked(whole)?;
            self.subroutines.insert(name.to_owned(), body);
        }
        self.subroutines.get(name).cloned()
    }

    /// A subroutine of M98 that stands farther on, behind the end of the program.
    fn ahead(&mut self, name: &str, lines: &mut Lines<'_>) -> Option<Rc<Body>> {
        let coming: Vec<Line> = lines.look_ahead(MOST_KEPT_BYTES).ok()?.iter().cloned().collect();
        let mut body: Option<Body> = None;
        for line in coming {
            let word = self.o_word_of(&line).ok().flatten();
            let begins = word
                .as_ref()
                .is_some_and(|word| word.keyword == Keyword::Label && word.label == name);
            let ends = self.clean.text.windows(3).any(|three| three == b"m99");
            if let Some(body) = &mut body {
                body.push(line, word);
                if ends {
                    break;
                }
            } else if begins {
                body = Some(Body::default());
            }
        }
        let body = self.linked(body?)?;
        self.subroutines.insert(name.to_owned(), body.clone());
        Some(body)
    }

    /// A line kept, cleaned anew.
    fn again(&mut self, line: &Line) -> Left {
        if self.clean.read(&line.text).is_err() {
            // Told when it was kept.
            return Left::AtEnd;
        }
        if self.clean.deleted && self.options.block_delete {
            return Left::AtEnd;
        }
        self.one(line, None)
    }

    /// Does the line that was cleaned last.
    fn one(&mut self, line: &Line, lines: Option<&mut Lines<'_>>) -> Left {
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
                    what: "moves of one line",
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
            return Left::AtEnd;
        }
        if clean.text.is_empty() {
            return Left::AtEnd;
        }
        if let Err(refused) = block.read(clean, 0, machine) {
            self.fault(line, refused.refusal, refused.place);
            return Left::AtEnd;
        }
        let done = settings(machine, block).and_then(|()| machine.execute(block, &mut counted));
        match done {
            Ok(Outcome::Next) => Left::AtEnd,
            Ok(Outcome::End) => Left::Finished,
            Ok(Outcome::Return) => Left::Returning,
            Ok(Outcome::Call { number, times }) => self.call_numbered(number, times, (line, lines)),
            Err(refusal) => {
                let place = self.block.place_of(&refusal).unwrap_or(0..self.clean.text.len());
                let place = self.clean.place(place);
                self.fault(line, refusal, place);
                Left::AtEnd
            }
        }
    }

    fn call_numbered(
        &mut self,
        number: u32,
        times: u32,
        (line, lines): (&Line, Option<&mut Lines<'_>>),
    ) -> Left {
        let name = number.to_string();
        let body = match (self.subroutine(&name), lines) {
            (None, Some(lines)) => self.ahead(&name, lines),
            (body, _) => body,
        };
        let Some(body) = body else {
            self.fault(line, Refusal::SubroutineUnknown(name), 0..line.text.len());
            return Left::AtEnd;
        };
        for _ in 0..times {
            match self.called(&body, line) {
                Left::AtEnd => {}
                left => return left,
            }
        }
        Left::AtEnd
    }

    fn fault(&mut self, line: &Line, refusal: Refusal, place: std::ops::Range<usize>) {
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
