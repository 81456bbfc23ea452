//! Subroutines: of the program, of other files, and those of M98 behind the end of the program.

use std::rc::Rc;

use super::flow::{Body, Keyword};
use super::interpreter::{Interpreter, Left, MOST_KEPT_BYTES};
use super::lines::{Line, Lines};
use super::refusal::Refusal;

impl Interpreter<'_> {
    /// A subroutine of the program or of another file.
    pub(super) fn subroutine(&mut self, name: &str) -> Option<Rc<Body>> {
        if let Some(body) = self.subroutines.get(name) {
            return Some(body.clone());
        }
        let text = self.options.subroutines.and_then(|lookup| lookup(name))?;
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

    /// M98.
    pub(super) fn call_numbered(
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
}
