//! Subroutines: of the program, of other files, and those of M98 behind the end of the program.
//!
//! A name is looked for among those that the program has defined so far, then in a file of that name
//! (`GcodeReadOptions`), then, for M98, among labels in the following lines. A file may contain `o<name> sub` as a
//! program does, or be the body itself.

use std::rc::Rc;

use super::execute::NumberedCall;
use super::flow::{Body, Keyword};
use super::interpreter::{Flow, Interpreter, MOST_KEPT_BYTES};
use super::lines::{Line, Lines};
use super::refusal::Refusal;

impl Interpreter<'_> {
    /// A subroutine of the program or of another file.
    ///
    /// `None` where there is none, or where what there is has been refused; all that a file defines is kept.
    pub(super) fn subroutine(&mut self, name: &str) -> Option<Rc<Body>> {
        if let Some(body) = self.subroutines.get(name) {
            return Some(body.clone());
        }
        let text = self.requested.subroutines.and_then(|lookup| lookup(name))?;
        let mut reader = text.as_bytes();
        let mut lines = Lines::new(&mut reader, Some(Rc::from(name)));
        let mut line = Line::default();
        let mut whole = Body::default();
        while let Ok(true) = lines.next(&mut line) {
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

    /// A subroutine of M98 after the end of the program; `call` is the line that calls it.
    ///
    /// From the line behind its label `O1234` to the first M99, or to the end of the text.
    fn ahead(&mut self, name: &str, call: &Line, lines: &mut Lines<'_>) -> Option<Rc<Body>> {
        let coming = lines.look_ahead(MOST_KEPT_BYTES).ok()?;
        let next = coming.front()?.number;
        for line in coming.range(self.labels.unseen(next)..) {
            let word = self.o_word_of(line).ok().flatten();
            let label = word.filter(|word| word.keyword == Keyword::Label);
            self.labels.see(line.number, label.map(|word| word.label));
        }
        let label = self.labels.first(name, next)?;
        let mut body = Body::default();
        for line in coming.range((label - next) as usize + 1..) {
            self.keep(line, call)?;
            let word = self.o_word_of(line).ok().flatten();
            let ends = self.clean.text.windows(3).any(|three| three == b"m99");
            body.push(line.clone(), word);
            if ends {
                break;
            }
        }
        let body = self.linked(body)?;
        self.subroutines.insert(name.to_owned(), body.clone());
        Some(body)
    }

    /// M98.
    ///
    /// It works on the parameters of its caller.
    pub(super) fn call_numbered(
        &mut self,
        call: NumberedCall,
        line: &Line,
        lines: Option<&mut Lines<'_>>,
    ) -> Flow {
        let name = call.number.to_string();
        let body = match (self.subroutine(&name), lines) {
            (None, Some(lines)) => self.ahead(&name, line, lines),
            (body, _) => body,
        };
        let Some(body) = body else {
            if !self.stopped {
                self.fault(line, Refusal::SubroutineUnknown(name), 0..line.text.len());
            }
            return Flow::Next;
        };
        for _ in 0..call.times {
            match self.called(&body, line) {
                Flow::Next => {}
                left => return left,
            }
        }
        Flow::Next
    }
}
