//! O-words: subroutines, loops and branches, as lines that know where to go on.
//!
//! | begins | goes on at | ends |
//! |---|---|---|
//! | `o1 sub` | | `o1 endsub` |
//! | `o1 if [..]` | `o1 elseif [..]`, `o1 else` | `o1 endif` |
//! | `o1 while [..]` | | `o1 endwhile` |
//! | `o1 do` | | `o1 while [..]` |
//! | `o1 repeat [..]` | | `o1 endrepeat` |
//!
//! Also: `o1 call [..]..`, `o1 return`, `o1 break`, `o1 continue`; `O1234` alone begins a subroutine of M98.
//!
//! Source: LinuxCNC documentation, O codes.

use super::block::Clean;
use super::expression::{Reader, Values};
use super::lines::Line;
use super::refusal::Refusal;

/// What an o-word does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    /// Begins a subroutine, which is kept and not done.
    Sub,
    /// Ends it.
    EndSub,
    /// Does a subroutine, with its arguments.
    Call,
    /// Leaves it, with a value if one follows.
    Return,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    /// `while` that ends `do`.
    DoWhile,
    Repeat,
    EndRepeat,
    Break,
    Continue,
    /// A number alone.
    Label,
}

/// Words behind the label.
const KEYWORDS: [(&str, Keyword); 15] = [
    ("endsub", Keyword::EndSub),
    ("sub", Keyword::Sub),
    ("call", Keyword::Call),
    ("return", Keyword::Return),
    ("if", Keyword::If),
    ("elseif", Keyword::ElseIf),
    ("else", Keyword::Else),
    ("endif", Keyword::EndIf),
    ("while", Keyword::While),
    ("endwhile", Keyword::EndWhile),
    ("do", Keyword::Do),
    ("repeat", Keyword::Repeat),
    ("endrepeat", Keyword::EndRepeat),
    ("break", Keyword::Break),
    ("continue", Keyword::Continue),
];

/// An o-word.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OWord {
    /// Number or name.
    pub label: String,
    /// What it does.
    pub keyword: Keyword,
    /// Where in the clean text its values begin.
    pub rest: usize,
}

/// The o-word that a line is, if it is one.
///
/// A label may be a number, a value that is computed (`o#1 call`) or a name (`o<drill> sub`); numbers are compared as
/// they are written without needless digits.
///
/// # Errors
/// An unclosed name, an invalid number, an unknown keyword.
pub(super) fn o_word(clean: &Clean, values: &dyn Values) -> Result<Option<OWord>, Refusal> {
    let text = clean.text.as_slice();
    let mut at = 0;
    if text.first() == Some(&b'n') {
        let digits = |byte: &&u8| byte.is_ascii_digit() || **byte == b'.';
        at = 1 + text.iter().skip(1).take_while(digits).count();
    }
    if text.get(at) != Some(&b'o') {
        return Ok(None);
    }
    at += 1;
    let rest = text.get(at..).unwrap_or_default();
    let label = if rest.first() == Some(&b'<') {
        let Some(length) = rest.iter().position(|byte| *byte == b'>') else {
            return Err(Refusal::NameOpen);
        };
        at += length + 1;
        String::from_utf8_lossy(rest.get(1..length).unwrap_or_default()).into_owned()
    } else {
        let mut reader = Reader::new(text, at, values);
        let number = reader.value()?;
        at = reader.at;
        format!("{number}")
    };
    let word: String = text
        .get(at..)
        .unwrap_or_default()
        .iter()
        .take_while(|byte| byte.is_ascii_lowercase())
        .map(|byte| char::from(*byte))
        .collect();
    let keyword = match KEYWORDS.iter().find(|(name, _)| *name == word) {
        Some((_, keyword)) => *keyword,
        None if word.is_empty() && at == text.len() => Keyword::Label,
        None => return Err(Refusal::FlowUnknown(word)),
    };
    Ok(Some(OWord {
        label,
        keyword,
        rest: at + word.len(),
    }))
}

/// A line kept, with its o-word.
#[derive(Clone, Debug)]
pub(super) struct StoredLine {
    /// The line as it came.
    pub line: Line,
    /// `None` for a line of words.
    pub word: Option<OWord>,
    /// Where a loop or branch goes on: the line that ends or begins it, or its next branch.
    pub partner: usize,
    /// The line that ends a branch.
    pub end: usize,
}

/// Lines kept to be gone through more than once.
#[derive(Clone, Debug, Default)]
pub(super) struct Body {
    /// In the order of the text.
    pub lines: Vec<StoredLine>,
}

impl Body {
    /// Keeps a line; until it is linked it belongs to itself.
    pub fn push(&mut self, line: Line, word: Option<OWord>) {
        let at = self.lines.len();
        self.lines.push(StoredLine {
            line,
            word,
            partner: at,
            end: at,
        });
    }

    /// Finds what belongs together; gives the line and reason where something does not.
    ///
    /// A loop or branch ends with its own label, and what is opened last is closed first. `while` is the end of a `do`
    /// where the innermost open one is a `do` of its label.
    pub fn link(&mut self) -> Result<(), (usize, Refusal)> {
        // Open branches and loops, with the lines of their branches so far.
        let mut open: Vec<(String, Keyword, Vec<usize>)> = Vec::new();
        for index in 0..self.lines.len() {
            let Some(word) = self.lines[index].word.clone() else {
                continue;
            };
            let matches = |open: &[(String, Keyword, Vec<usize>)], of: &[Keyword]| {
                open.last()
                    .is_some_and(|(label, keyword, _)| *label == word.label && of.contains(keyword))
            };
            let requested: &[Keyword] = match word.keyword {
                Keyword::While if matches(&open, &[Keyword::Do]) => {
                    if let Some(word) = &mut self.lines[index].word {
                        word.keyword = Keyword::DoWhile;
                    }
                    &[Keyword::Do]
                }
                Keyword::If | Keyword::While | Keyword::Do | Keyword::Repeat => {
                    open.push((word.label, word.keyword, vec![index]));
                    continue;
                }
                Keyword::ElseIf | Keyword::Else | Keyword::EndIf => &[Keyword::If],
                Keyword::EndWhile => &[Keyword::While],
                Keyword::EndRepeat => &[Keyword::Repeat],
                Keyword::Break | Keyword::Continue => {
                    let begun = open
                        .iter()
                        .rev()
                        .find(|(label, keyword, _)| *label == word.label && *keyword != Keyword::If);
                    match begun.and_then(|(.., lines)| lines.first()) {
                        Some(first) => self.lines[index].partner = *first,
                        None => return Err((index, Refusal::FlowUnopened(word.label))),
                    }
                    continue;
                }
                _ => continue,
            };
            if !matches(&open, requested) {
                return Err((index, Refusal::FlowUnopened(word.label)));
            }
            if matches!(word.keyword, Keyword::ElseIf | Keyword::Else) {
                if let Some((.., branches)) = open.last_mut() {
                    branches.push(index);
                }
                continue;
            }
            let Some((.., branches)) = open.pop() else {
                continue;
            };
            let next = branches.iter().skip(1).copied().chain([index]);
            for (branch, next) in branches.iter().zip(next) {
                self.lines[*branch].partner = next;
                self.lines[*branch].end = index;
            }
            if let Some(first) = branches.first() {
                self.lines[index].partner = *first;
            }
        }
        match open.pop() {
            Some((label, _, lines)) => Err((
                lines.first().copied().unwrap_or_default(),
                Refusal::FlowUnclosed(label),
            )),
            None => Ok(()),
        }
    }
}
