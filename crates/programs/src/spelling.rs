//! Lines and numbers of a text, and the replacement of numbers.

use std::ops::Range;

use super::number::{decimals, fixed};

/// A line of a text, without its line ending.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// From 1.
    pub number: u32,
    /// Its offset in the text.
    pub start: usize,
    /// Its content.
    pub text: &'a str,
}

impl<'a> Line<'a> {
    /// Its bytes in the text.
    pub fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// The bytes of a part of it in the text.
    pub fn span_of(&self, part: &Part) -> Range<usize> {
        self.start + part.at..self.start + part.at + part.text.len()
    }

    /// The whole line, without surrounding blanks.
    pub fn trimmed(&self) -> Part<'a> {
        Part {
            at: 0,
            text: self.text,
        }
        .trimmed()
    }
}

/// A part of a line, and its offset there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part<'a> {
    pub at: usize,
    pub text: &'a str,
}

impl<'a> Part<'a> {
    /// Its bytes in the line or in the text that it is a part of.
    pub fn range(&self) -> Range<usize> {
        self.at..self.at + self.text.len()
    }

    /// Without surrounding blanks.
    pub fn trimmed(self) -> Part<'a> {
        let text = self.text.trim_start();
        Part {
            at: self.at + self.text.len() - text.len(),
            text: text.trim_end(),
        }
    }

    /// From this byte on; empty if there are fewer bytes.
    pub fn from(self, bytes: usize) -> Part<'a> {
        Part {
            at: self.at + bytes.min(self.text.len()),
            text: self.text.get(bytes..).unwrap_or_default(),
        }
    }

    /// Its words, separated by blanks.
    pub fn words(self) -> impl Iterator<Item = Part<'a>> {
        self.split(char::is_whitespace)
            .filter(|part| !part.text.is_empty())
    }

    /// Its pieces between separators, blanks included.
    pub fn split(self, separator: impl Fn(char) -> bool) -> impl Iterator<Item = Part<'a>> {
        let mut rest = Some(self);
        std::iter::from_fn(move || {
            let part = rest?;
            match part.text.char_indices().find(|(_, c)| separator(*c)) {
                Some((at, c)) => {
                    rest = Some(part.from(at + c.len_utf8()));
                    Some(Part {
                        at: part.at,
                        text: &part.text[..at],
                    })
                }
                None => rest.take(),
            }
        })
    }
}

/// The lines of a text.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut start = 0;
    text.split_inclusive('\n').zip(1..).map(move |(line, number)| {
        let begin = start;
        start += line.len();
        let text = line.strip_suffix('\n').unwrap_or(line);
        Line {
            number,
            start: begin,
            text: text.strip_suffix('\r').unwrap_or(text),
        }
    })
}

/// The number in a text: digits with a point, with or without an exponent; neither `inf` nor `nan`.
pub(super) fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let plain = text
        .bytes()
        .all(|byte| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
    text.parse::<f64>()
        .ok()
        .filter(|value| plain && value.is_finite())
}

/// Maximum number of decimals: further ones exceed the resolution of controllers.
const MOST_DECIMALS: usize = 9;

/// The part of a target that is rewritten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Respelling {
    /// Position and orientation.
    Pose,
    /// Only the position: the orientation is kept as written.
    Place,
}

impl Respelling {
    /// Whether this number of a pose is rewritten: x, y, z, then those of the orientation.
    pub fn includes(self, index: usize) -> bool {
        self == Respelling::Pose || index < 3
    }
}

/// `before` with its numbers replaced: byte ranges in the order of the text, new values, and minimum numbers of
/// decimals. Each keeps its number of decimals if that is larger, and its width including the blanks before it.
pub(super) fn respelled(before: &str, numbers: &[(Range<usize>, f64, usize)], out: &mut String) {
    let mut done = 0;
    for (place, value, least_decimals) in numbers {
        let (Some(between), Some(old)) = (before.get(done..place.start), before.get(place.clone())) else {
            continue;
        };
        let new = fixed(*value, decimals(old, *least_decimals, MOST_DECIMALS));
        let blanks = between.len() - between.trim_end_matches(' ').len();
        let longer = new.len().saturating_sub(old.len());
        // One blank is kept if there was one.
        let fewer = longer.min(blanks.saturating_sub(1));
        out.push_str(&between[..between.len() - fewer]);
        if blanks > 0 {
            out.extend(std::iter::repeat_n(' ', old.len().saturating_sub(new.len())));
        }
        out.push_str(&new);
        done = place.end;
    }
    out.push_str(before.get(done..).unwrap_or_default());
}

/// A text as ASCII, with other characters as question marks, in pieces of at most this length: for remarks.
pub(super) fn in_pieces(text: &str, longest: usize) -> Vec<String> {
    let plain: String = text
        .split_whitespace()
        .flat_map(|word| word.chars().chain([' ']))
        .map(|c| {
            if c.is_ascii() && !c.is_ascii_control() {
                c
            } else {
                '?'
            }
        })
        .collect();
    let mut pieces = Vec::new();
    let mut rest = plain.trim_end();
    while !rest.is_empty() {
        let most = longest.max(1).min(rest.len());
        let end = match rest.as_bytes().get(most) {
            // Between words, if possible.
            Some(next) if *next != b' ' => rest[..most].rfind(' ').unwrap_or(most),
            _ => most,
        };
        pieces.push(rest[..end].to_owned());
        rest = rest[end..].trim_start();
    }
    pieces
}

/// A text in pieces for quoted texts: without quotation marks and without backslashes, which begin escapes.
pub(super) fn in_quoted_pieces(text: &str, longest: usize) -> Vec<String> {
    in_pieces(&text.replace('"', "'").replace('\\', "/"), longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_line_endings_are_read_and_parts_have_their_offsets() {
        let text = "MOVL C1\r\n\n V=2 \n";
        let found: Vec<(u32, usize, &str)> = lines(text)
            .map(|line| (line.number, line.start, line.text))
            .collect();
        assert_eq!(found, [(1, 0, "MOVL C1"), (2, 9, ""), (3, 10, " V=2 ")]);
        let line = lines(text).nth(2).unwrap();
        assert_eq!(&text[line.span_of(&line.trimmed())], "V=2");
        let words: Vec<&str> = Part {
            at: 0,
            text: " a  b,c ",
        }
        .words()
        .map(|part| part.text)
        .collect();
        assert_eq!(words, ["a", "b,c"]);
    }

    #[test]
    fn refuses_text_that_is_not_a_number() {
        for (text, value) in [
            ("-.858", Some(-0.858)),
            (" 5. ", Some(5.0)),
            ("1e3", Some(1000.0)),
        ] {
            assert_eq!(number(text), value);
        }
        for text in ["", "inf", "nan", "********", "0x1", "1,5", "1e999"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn replaced_numbers_keep_their_positions_widths_and_decimals() {
        let mut out = String::new();
        respelled("X =   200.000  mm", &[(6..13, -1234.5, 3)], &mut out);
        respelled("|X =     .5", &[(9..11, -1.25, 0)], &mut out);
        respelled(
            "|1.0,2.00000",
            &[(1..4, 10.0, 3), (5..12, -0.000_001, 3)],
            &mut out,
        );
        assert_eq!(out, "X = -1234.500  mm|X =   -1.2|10.000,0.00000");
    }

    #[test]
    fn remarks_are_split_and_reduced_to_ascii() {
        assert_eq!(
            in_pieces("gr\u{fc}n  und\tblau gelb", 8),
            ["gr?n und", "blau", "gelb"]
        );
        assert_eq!(in_pieces("dunkelblau", 4), ["dunk", "elbl", "au"]);
        assert!(in_pieces("", 8).is_empty());
        assert_eq!(in_quoted_pieces("say \"go\\\"", 40), ["say 'go/'"]);
    }
}
