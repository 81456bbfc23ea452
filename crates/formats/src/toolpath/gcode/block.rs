//! A line as the words it has: letters with their values, codes by group, settings of parameters.
//!
//! Blanks and case are ignored outside comments. Values are computed while the line is read; parameters set in a
//! line get their values after it, as the standard wants it.
//!
//! ```text
//! /N10 G1 (fast) X[#1+2] #2=5 M8 ; rest
//! n10g1x[#1+2]#2=5m8                     the clean text; each of its bytes knows its place in the line
//! ```
//!
//! Each modal group has at most one code G or M; other letters occur once each. A letter that no code of the block
//! uses is refused, so that no word is silently ignored.
//!
//! Source: NISTIR 6556, sections 3.3 and 3.4.

use super::expression::{Name, Reader, Values};
use super::groups::{self, GROUPS};
use super::refusal::{Refusal, Refused};
use crate::toolpath::direction::LARGEST;

/// Longest line, bytes: the controls known take 256.
pub(super) const LONGEST_LINE: usize = 4096;

/// A line without comments, blanks and capitals, and what it was.
#[derive(Clone, Debug, Default)]
pub(super) struct Clean {
    /// Lower case, no blanks.
    pub text: Vec<u8>,
    /// Original position of each byte of `text` in the line.
    at: Vec<u16>,
    /// Comments in parentheses, bytes of the line.
    pub comments: Vec<(usize, usize)>,
    /// Whether a `/` begins it.
    pub deleted: bool,
}

impl Clean {
    /// Reads a new line.
    ///
    /// # Errors
    /// A line that is too long, a comment that is not closed.
    pub fn read(&mut self, line: &[u8]) -> Result<(), Refused> {
        self.text.clear();
        self.at.clear();
        self.comments.clear();
        self.deleted = false;
        if line.len() > LONGEST_LINE {
            return Err(Refused {
                refusal: Refusal::LineTooLong { limit: LONGEST_LINE },
                place: 0..1,
            });
        }
        let mut index = 0;
        while let Some(byte) = line.get(index).copied() {
            match byte {
                b' ' | b'\t' => {}
                b';' => break,
                b'(' => {
                    let rest = line.get(index + 1..).unwrap_or_default();
                    let Some(length) = rest.iter().position(|byte| *byte == b')') else {
                        return Err(Refused {
                            refusal: Refusal::CommentOpen,
                            place: index..line.len(),
                        });
                    };
                    self.comments.push((index + 1, index + 1 + length));
                    index += length + 1;
                }
                b'/' if self.text.is_empty() && !self.deleted => self.deleted = true,
                _ => {
                    self.text.push(byte.to_ascii_lowercase());
                    // The line is shorter than 2^16: checked above.
                    self.at.push(index as u16);
                }
            }
            index += 1;
        }
        Ok(())
    }

    /// The bytes of the line that a range of the text came from.
    ///
    /// A range past the end of the text is reported at its end.
    pub fn place(&self, range: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let last = self.at.last().map_or(0, |at| usize::from(*at) + 1);
        let of = |index: usize| self.at.get(index).map(|at| usize::from(*at));
        let start = of(range.start).unwrap_or(last);
        let end = range.end.checked_sub(1).and_then(of).map_or(last, |at| at + 1);
        start..end.max(start)
    }
}

/// Codes by group, each with its position in the clean text.
pub(super) type Codes = [Option<(u16, (u16, u16))>; GROUPS];

/// The words of a line.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// By letter, a to z; of meaning only where `present` has its bit.
    values: [f64; 26],
    /// By letter: from and to in the clean text.
    places: [(u16, u16); 26],
    /// A bit for each letter of the block; a is bit 0.
    present: u32,
    /// The same for letters that some code has taken.
    used: u32,
    /// Codes G by group, in tenths: 921 is G92.1; and their positions.
    pub g: Codes,
    /// Codes M by group.
    pub m: Codes,
    /// Parameters that the line sets, with their values.
    pub settings: Vec<(Name, f64)>,
}

/// Words that are no letters.
const WHOLE_WORDS: [(&[u8], u16); 2] = [(b"traori", groups::TRAORI), (b"trafoof", groups::TRAFOOF)];

impl Block {
    /// Without any word; the same block is filled for every line.
    pub fn new() -> Block {
        Block {
            values: [0.0; 26],
            places: [(0, 0); 26],
            present: 0,
            used: 0,
            g: [None; GROUPS],
            m: [None; GROUPS],
            settings: Vec::new(),
        }
    }

    /// Reads the words of a clean line from this byte on.
    ///
    /// # Errors
    /// The first word that is invalid, repeated, beyond 1e9, or a code that is unknown, unsupported, or of a group
    /// that is taken.
    pub fn read(&mut self, clean: &Clean, from: usize, values: &dyn Values) -> Result<(), Refused> {
        self.present = 0;
        self.used = 0;
        self.g = [None; GROUPS];
        self.m = [None; GROUPS];
        self.settings.clear();
        let mut reader = Reader::new(&clean.text, from, values);
        while reader.at < clean.text.len() {
            let start = reader.at;
            self.word(&mut reader).map_err(|refusal| {
                let end = reader.at.max(start + 1);
                Refused {
                    refusal,
                    place: clean.place(start..end),
                }
            })?;
        }
        Ok(())
    }

    /// The next word: a setting `#n=value`, a word of its own such as TRAORI, or a letter with its value.
    fn word(&mut self, reader: &mut Reader<'_>) -> Result<(), Refusal> {
        let start = reader.at;
        let Some(letter) = reader.peek() else {
            return Ok(());
        };
        if letter == b'#' {
            let name = reader.parameter()?;
            if !reader.take(b'=') {
                return Err(Refusal::Expected('='));
            }
            let value = reader.value()?;
            self.settings.push((name, value));
            return Ok(());
        }
        let rest = reader.text.get(start..).unwrap_or_default();
        if let Some((word, code)) = WHOLE_WORDS.iter().find(|(word, _)| rest.starts_with(word)) {
            reader.at += word.len();
            return self.code(b'm', *code, (start as u16, reader.at as u16));
        }
        if matches!(letter, b'@' | b'^' | b'$') {
            return Err(Refusal::Unsupported {
                code: char::from(letter).to_string(),
                reason: "polar words and spindle numbers are not understood",
            });
        }
        if !letter.is_ascii_lowercase() {
            let follows_digit = start > 0 && reader.text.get(start - 1).is_some_and(u8::is_ascii_digit);
            return Err(match letter {
                b',' if follows_digit => Refusal::DecimalComma,
                _ => Refusal::NotAWord(char::from(letter)),
            });
        }
        reader.at += 1;
        let value = reader.value()?;
        let place = (start as u16, reader.at as u16);
        match letter {
            b'n' => Ok(()),
            b'g' => {
                let code = tenths(value).ok_or_else(|| unknown('G', value))?;
                self.code(b'g', code, place)
            }
            b'm' => {
                let code = tenths(value)
                    .filter(|code| code.is_multiple_of(10))
                    .map(|code| code / 10);
                let code = code.ok_or_else(|| unknown('M', value))?;
                self.code(b'm', code, place)
            }
            _ => {
                let index = usize::from(letter - b'a');
                if self.present & (1 << index) != 0 {
                    return Err(Refusal::WordTwice(shown(letter)));
                }
                within(shown(letter), value)?;
                self.present |= 1 << index;
                self.values[index] = value;
                self.places[index] = place;
                Ok(())
            }
        }
    }

    /// Keeps a code under its group.
    fn code(&mut self, letter: u8, code: u16, place: (u16, u16)) -> Result<(), Refusal> {
        let (group, codes) = match letter {
            b'g' => (groups::of_g(code), &mut self.g),
            _ => (groups::of_m(code), &mut self.m),
        };
        let name = |code| groups::name(letter, code);
        let Some(group) = group else {
            return Err(match groups::unsupported(letter, code) {
                Some(reason) => Refusal::Unsupported {
                    code: name(code),
                    reason,
                },
                None => Refusal::UnknownCode(name(code)),
            });
        };
        match codes[group] {
            // Mist and flood may run together, and the same code twice says nothing new.
            Some((other, _))
                if other != code && !(letter == b'm' && matches!((other, code), (7, 8) | (8, 7))) =>
            {
                Err(Refusal::SameGroup(name(other), name(code)))
            }
            _ => {
                codes[group] = Some((code, place));
                Ok(())
            }
        }
    }

    /// The bit of a small letter.
    fn bit(letter: u8) -> u32 {
        1 << u32::from(letter.wrapping_sub(b'a') % 26)
    }

    /// Whether the block has this letter, used or not.
    pub fn has(&self, letter: u8) -> bool {
        self.present & Block::bit(letter) != 0
    }

    /// The value of a word, which is used with that.
    pub fn take(&mut self, letter: u8) -> Option<f64> {
        let value = self.peek(letter)?;
        self.used |= Block::bit(letter);
        Some(value)
    }

    /// The value of a word, which is not used with that.
    pub fn peek(&self, letter: u8) -> Option<f64> {
        self.has(letter)
            .then(|| self.values[usize::from(letter.wrapping_sub(b'a') % 26)])
    }

    /// Values of X, Y, Z, A, B, C.
    ///
    /// All of them are used with that.
    pub fn axes(&mut self) -> [Option<f64>; 6] {
        b"xyzabc".map(|letter| self.take(letter))
    }

    /// Whether one of X, Y, Z, A, B, C is here.
    pub fn has_axes(&self) -> bool {
        b"xyzabc".iter().any(|letter| self.has(*letter))
    }

    /// Whether one of I, J, K is here: under G43.5 the tool axis.
    pub fn has_vector(&self) -> bool {
        b"ijk".iter().any(|letter| self.has(*letter))
    }

    /// A word that no code uses.
    ///
    /// The first in the alphabet.
    pub fn unused(&self) -> Option<u8> {
        let left = self.present & !self.used;
        // At most bit 25 is set.
        (left != 0).then(|| b'a' + left.trailing_zeros() as u8)
    }

    /// Position of a word in the clean text.
    pub fn place(&self, letter: u8) -> std::ops::Range<usize> {
        let (start, end) = self.places[usize::from(letter.wrapping_sub(b'a') % 26)];
        usize::from(start)..usize::from(end)
    }

    /// Position in the clean text of the subject of a refusal.
    ///
    /// The word or code that it speaks of; else the code of cutter compensation, or that of motion.
    pub fn place_of(&self, refusal: &Refusal) -> Option<std::ops::Range<usize>> {
        let letter = match refusal {
            Refusal::WordTwice(word)
            | Refusal::WordUnused(word)
            | Refusal::WordAmbiguous(word)
            | Refusal::WordValue { word, .. }
            | Refusal::RotaryInCycle { word }
            | Refusal::RotariesUnknown { axis: word }
            | Refusal::RotaryAbsent { axis: word }
            | Refusal::RotaryCut { axis: word, .. } => Some(word.to_ascii_lowercase()),
            Refusal::ClearBelowBottom { .. } => Some('r'),
            Refusal::DiameterUnknown(_) | Refusal::TurningTool(..) if self.has(b'd') => Some('d'),
            Refusal::ToolUnknown(_) => ['t', 'h', 'd', 'p', 'q']
                .into_iter()
                .find(|letter| self.has(*letter as u8)),
            _ => None,
        };
        if let Some(letter) = letter.filter(|letter| letter.is_ascii_lowercase() && self.has(*letter as u8)) {
            return Some(self.place(letter as u8));
        }
        let code = match refusal {
            Refusal::Unsupported { code, .. } => Some(code),
            Refusal::AxesMissing(code) | Refusal::NoFeed(code) | Refusal::NoInverseTime(code) => Some(code),
            Refusal::WordMissing(code, _) | Refusal::NotUnderCompensation(code) => Some(code),
            _ => None,
        };
        let named = |(letter, codes): (u8, &Codes)| {
            codes
                .iter()
                .flatten()
                .find(|(found, _)| code.is_some_and(|code| *code == groups::name(letter, *found)))
                .map(|(_, place)| *place)
        };
        let found = named((b'g', &self.g)).or_else(|| named((b'm', &self.m)));
        let place = found.or_else(|| {
            self.g[groups::CUTTER]
                .filter(|_| code.is_none())
                .map(|(_, place)| place)
        });
        let place = place.or_else(|| self.g[groups::MOTION].map(|(_, place)| place));
        place.map(|(start, end)| usize::from(start)..usize::from(end))
    }

    /// Whether the block has a G code, in tenths: 640 is G64.
    pub fn has_g(&self, code: u16) -> bool {
        groups::of_g(code).is_some_and(|group| self.g[group].is_some_and(|(found, _)| found == code))
    }
}

/// Refuses a value beyond [`LARGEST`] and anything that is not a number.
pub(super) fn within(word: char, value: f64) -> Result<(), Refusal> {
    if value.abs() <= LARGEST {
        return Ok(());
    }
    let requested = "within 1e9";
    Err(Refusal::WordValue {
        word,
        value,
        requested,
    })
}

/// A letter as people write it.
pub(super) fn shown(letter: u8) -> char {
    char::from(letter.to_ascii_uppercase())
}

/// Refusal of a code that is not valid in tenths.
fn unknown(letter: char, value: f64) -> Refusal {
    Refusal::UnknownCode(format!("{letter}{value}"))
}

/// A code in tenths: 92.1 as 921.
///
/// `None` for what has more decimals, is below zero or above 6553.4.
fn tenths(value: f64) -> Option<u16> {
    let code = (value * 10.0).round();
    // Codes may be computed: as far as rounding goes.
    let whole = (value * 10.0 - code).abs() < 1e-6 && (0.0..f64::from(u16::MAX)).contains(&code);
    whole.then_some(code as u16)
}
