//! The lines of a program as statements: `  12:L P[1] 100mm/sec FINE ;`, also over several lines.

use std::ops::Range;

use crate::spelling::{Line, Part, lines};

/// Maximum number of lines of a statement.
const MOST_LINES: usize = 50;

/// A statement. Positions are offsets in the whole text.
#[derive(Clone, Debug)]
pub(super) struct Statement<'a> {
    /// Its first line.
    pub line: u32,
    /// Its words; brackets do not end a word.
    pub words: Vec<Part<'a>>,
    /// Its bytes.
    pub span: Range<usize>,
}

impl<'a> Statement<'a> {
    /// Its word at `index`; empty after the last word.
    pub fn word(&self, index: usize) -> &'a str {
        self.words.get(index).map_or("", |part| part.text)
    }
}

/// The parts of a listing.
#[derive(Clone, Debug, Default)]
pub(super) struct Sections<'a> {
    pub name: &'a str,
    pub statements: Vec<Statement<'a>>,
    pub positions: Vec<Line<'a>>,
}

/// Splits a listing; `None` if no line begins with /PROG, /MN or /POS.
pub(super) fn sections(text: &str) -> Option<Sections<'_>> {
    let mut sections = Sections::default();
    let mut open: Option<Statement> = None;
    let mut seen = 0;
    let mut at = "";
    for line in lines(text) {
        let said = line.text.trim();
        if said.starts_with('/') {
            let word = said.split_whitespace().next().unwrap_or_default();
            match word {
                "/PROG" => {
                    seen += 1;
                    sections.name = said[word.len()..].split_whitespace().next().unwrap_or_default();
                    at = word;
                    continue;
                }
                "/MN" | "/POS" => {
                    seen += 1;
                    at = word;
                    continue;
                }
                "/ATTR" | "/APPL" | "/END" => {
                    at = word;
                    continue;
                }
                _ => {}
            }
        }
        match at {
            "/MN" => take(&mut sections.statements, &mut open, line),
            "/POS" => sections.positions.push(line),
            _ => {}
        }
    }
    sections.statements.extend(open);
    (seen > 0).then_some(sections)
}

fn take<'a>(done: &mut Vec<Statement<'a>>, open: &mut Option<Statement<'a>>, line: Line<'a>) {
    let digits = line
        .text
        .trim_start()
        .trim_start_matches(|c: char| c.is_ascii_digit());
    let numbered = !line.text.trim_start().starts_with(':') && digits.trim_start().starts_with(':');
    let colon = line
        .text
        .find(':')
        .filter(|_| digits.trim_start().starts_with(':'));
    let body = Part {
        at: line.start,
        text: line.text,
    }
    .from(colon.map_or(0, |at| at + 1))
    .trimmed();
    if numbered {
        done.extend(open.take());
    }
    if body.text.is_empty() {
        return;
    }
    let statement = open.get_or_insert_with(|| Statement {
        line: line.number,
        words: Vec::new(),
        span: body.at..body.at,
    });
    let (said, ends) = match body.text.strip_suffix(';') {
        Some(said) => (said, true),
        None => (body.text, false),
    };
    statement.span.end = body.range().end;
    words(
        Part {
            at: body.at,
            text: said,
        },
        &mut statement.words,
    );
    let lines = line.number - statement.line;
    if ends || lines as usize >= MOST_LINES {
        done.extend(open.take());
    }
}

fn words<'a>(said: Part<'a>, out: &mut Vec<Part<'a>>) {
    let mut depth = 0_usize;
    let mut start = None;
    for (at, c) in said.text.char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let blank = depth == 0 && c.is_whitespace();
        match (start, blank) {
            (None, false) => start = Some(at),
            (Some(begin), true) => {
                out.push(Part {
                    at: said.at + begin,
                    text: &said.text[begin..at],
                });
                start = None;
            }
            _ => {}
        }
    }
    if let Some(begin) = start {
        out.push(said.from(begin));
    }
}

/// The content of the brackets after a name, `PR[GP1:9,2:name]`, split at commas, without group and name.
pub(super) fn index<'a>(word: &'a str, name: &str) -> Option<(Vec<&'a str>, &'a str)> {
    let begin = word.get(..name.len())?;
    let inside = word.get(name.len()..)?.strip_prefix('[')?;
    if !begin.eq_ignore_ascii_case(name) {
        return None;
    }
    let mut depth = 1_usize;
    let close = inside.char_indices().find_map(|(at, c)| {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            _ => {}
        }
        (depth == 0).then_some(at)
    })?;
    let (inside, behind) = (&inside[..close], &inside[close + 1..]);
    let inside = match inside.split_once(':') {
        Some((group, rest))
            if group
                .get(..2)
                .is_some_and(|begin| begin.eq_ignore_ascii_case("gp")) =>
        {
            rest
        }
        _ => inside,
    };
    // The name of a register follows its number; a bracket with another register in it has no name here.
    let given = inside.split_once(':').map_or(inside, |(given, _)| given);
    Some((given.split(',').map(str::trim).collect(), behind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_can_span_lines_and_brackets_keep_words_together() {
        let text = "/PROG  A\n/MN\n   1:  !a ; b ;\n   2:C P[1]    \n    :  P[2:to the end] R[5:a b]mm/sec FINE    \
            ;\n  3:L P[3]\n4:   ;\n/POS\nP[1]{\n/END\n";
        let sections = sections(text).unwrap();
        assert_eq!((sections.name, sections.positions.len()), ("A", 1));
        let said: Vec<(u32, Vec<&str>)> = sections
            .statements
            .iter()
            .map(|one| (one.line, one.words.iter().map(|part| part.text).collect()))
            .collect();
        let arc = vec!["C", "P[1]", "P[2:to the end]", "R[5:a b]mm/sec", "FINE"];
        assert_eq!(
            said,
            [
                (3, vec!["!a", ";", "b"]),
                (4, arc),
                (6, vec!["L", "P[3]"]),
                (7, vec![])
            ]
        );
        for part in sections.statements.iter().flat_map(|one| &one.words) {
            assert_eq!(&text[part.range()], part.text);
        }
    }

    #[test]
    fn groups_and_names_in_brackets_are_left_out() {
        assert_eq!(index("PR[100,2:Offset]=0", "PR"), Some((vec!["100", "2"], "=0")));
        assert_eq!(index("P[GP1:3]", "P"), Some((vec!["3"], "")));
        assert_eq!(index("P[R[2:a]]", "P"), Some((vec!["R[2"], "")));
        assert_eq!(index("P[3", "P"), None);
        assert_eq!(index("PR[3]", "P"), None);
    }
}
