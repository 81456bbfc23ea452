//! Going through kept lines: loops, branches and calls.
//!
//! | o-word | goes on at |
//! |---|---|
//! | `if` | the next line, or the first branch whose condition is true, or after `endif` |
//! | `elseif`, `else` (reached from above) | behind `endif` |
//! | `while` | the next line, or behind `endwhile`, which goes back to it |
//! | `while` of a `do` | behind the `do`, or the next line |
//! | `repeat` | the next line so many times, as `endrepeat` counts, or behind it |
//! | `break`, `continue` | behind the loop; at its next round |
//! | `call` | the subroutine, then the next line |
//! | `return`, `endsub` | behind the call |

use std::rc::Rc;

use super::expression::Reader;
use super::flow::{Body, Keyword, OWord};
use super::interpreter::{
    Flow, Interpreter, MOST_CALLS_DEEP, MOST_REPEATED_AFTER_FAULT, MOST_REPEATED_LINES,
};
use super::lines::Line;
use super::parameters;
use super::refusal::{Excess, Refusal};

/// A `repeat` that is open: its line, and the rounds still to go.
struct Repeat {
    /// Index in the body.
    at: usize,
    /// The one at hand included.
    rounds: u64,
}

impl Interpreter<'_> {
    /// Goes through kept lines.
    pub(super) fn run(&mut self, body: &Rc<Body>) -> Flow {
        let mut at = 0;
        let mut repeats = Vec::new();
        while let Some(kept) = body.lines.get(at) {
            if !self.may_go_on(&kept.line) {
                return Flow::End;
            }
            let line = &kept.line;
            let flow = match &kept.word {
                None => self.execute_kept(line),
                Some(word) => match word.keyword {
                    Keyword::Call => self.call(word, line),
                    Keyword::Return | Keyword::EndSub => {
                        self.returns(line, word);
                        Flow::Return
                    }
                    _ => {
                        at = self.next_after(body, at, &mut repeats);
                        continue;
                    }
                },
            };
            match flow {
                Flow::Next => at += 1,
                left => return left,
            }
        }
        Flow::Next
    }

    /// Counts an executed line; false if there were too many, which is reported there, or if the program has stopped.
    ///
    /// After a fault only 10000 lines more are done, so that a loop whose end was refused ends.
    fn may_go_on(&mut self, line: &Line) -> bool {
        self.repeated += 1;
        let limit = if self.faults.is_empty() {
            self.repeated_until_fault = self.repeated;
            self.requested.most_repeated_lines.unwrap_or(MOST_REPEATED_LINES)
        } else {
            // A loop whose end was refused may have none.
            self.repeated_until_fault
                .saturating_add(MOST_REPEATED_AFTER_FAULT)
        };
        if self.repeated > limit {
            let refusal = Refusal::TooMuch {
                what: Excess::RepeatedLines,
                limit,
            };
            self.fault(line, refusal, 0..line.text.len());
            self.stopped = true;
        }
        !self.stopped
    }

    /// The line that follows the o-word at `at`; see the table above.
    fn next_after(&mut self, body: &Rc<Body>, at: usize, repeats: &mut Vec<Repeat>) -> usize {
        let Some((kept, word)) = body
            .lines
            .get(at)
            .and_then(|kept| Some((kept, kept.word.as_ref()?)))
        else {
            return at + 1;
        };
        let (line, partner) = (&kept.line, kept.partner);
        match word.keyword {
            Keyword::If if !self.is_true(line, word) => self.branch(body, partner),
            Keyword::ElseIf | Keyword::Else => kept.end + 1,
            Keyword::While if !self.is_true(line, word) => partner + 1,
            Keyword::EndWhile => partner,
            Keyword::DoWhile if self.is_true(line, word) => partner + 1,
            Keyword::Repeat => {
                // Counts below one give no round at all.
                let rounds = self.value(line, word).unwrap_or_default().round().max(0.0) as u64;
                if rounds == 0 {
                    return partner + 1;
                }
                repeats.push(Repeat { at, rounds });
                at + 1
            }
            Keyword::EndRepeat => match repeats.last_mut() {
                Some(open) if open.rounds > 1 => {
                    open.rounds -= 1;
                    open.at + 1
                }
                _ => {
                    repeats.pop();
                    at + 1
                }
            },
            Keyword::Break => {
                // The loop itself is left, and every `repeat` inside of it.
                repeats.retain(|open| open.at < partner);
                body.lines.get(partner).map_or(at, |first| first.end) + 1
            }
            Keyword::Continue => {
                // The loop stays open; every `repeat` inside of it is left.
                repeats.retain(|open| open.at <= partner);
                body.lines.get(partner).map_or(at, |first| {
                    match first.word.as_ref().map(|word| word.keyword) {
                        Some(Keyword::While) => partner,
                        _ => first.end,
                    }
                })
            }
            _ => at + 1,
        }
    }

    /// The branch whose condition is true after a condition that is false.
    ///
    /// `at` is the next branch; returns the line after the true one, or after `endif`.
    fn branch(&mut self, body: &Rc<Body>, mut at: usize) -> usize {
        while let Some(kept) = body.lines.get(at) {
            match &kept.word {
                Some(word) if word.keyword == Keyword::ElseIf && !self.is_true(&kept.line, word) => {
                    at = kept.partner;
                }
                _ => break,
            }
        }
        at + 1
    }

    /// Whether a condition is not zero; a refused one is false.
    fn is_true(&mut self, line: &Line, word: &OWord) -> bool {
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

    /// `return` and `endsub`: their value goes to `#<_value>`, and whether there is one to `#<_value_returned>`.
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

    /// `o1 call [1] [2]`: arguments are #1, #2, ... of the subroutine, its other locals are zero.
    pub(super) fn call(&mut self, word: &OWord, line: &Line) -> Flow {
        let Some(arguments) = self.values_behind(line, word) else {
            return Flow::Next;
        };
        let Some(body) = self.subroutine(&word.label) else {
            self.fault(
                line,
                Refusal::SubroutineUnknown(word.label.clone()),
                0..line.text.len(),
            );
            return Flow::Next;
        };
        self.machine.parameters.enter(&arguments);
        let left = self.called(&body, line);
        self.machine.parameters.leave();
        left
    }

    /// Goes through a subroutine; what calls itself without end stops the program.
    pub(super) fn called(&mut self, body: &Rc<Body>, line: &Line) -> Flow {
        if self.depth >= MOST_CALLS_DEEP {
            self.fault(
                line,
                Refusal::CallsTooDeep {
                    limit: MOST_CALLS_DEEP,
                },
                0..line.text.len(),
            );
            self.stopped = true;
            return Flow::End;
        }
        self.depth += 1;
        let left = self.run(body);
        self.depth -= 1;
        match left {
            Flow::End => Flow::End,
            _ => Flow::Next,
        }
    }
}
