//! What is wrong in a file and where, shown as rustc shows it.
//!
//! ```text
//! error: study.toml:10:1: unknown field `plane.step`
//!   --> study.toml:10:1
//!    |
//! 10 | step = 5
//!    | ^^^^
//!    |
//!    = help: lengths carry their unit: write `step_mm`
//! ```
//!
//! The first line alone is what `Display` of one [`Problem`] gives, without the word before it.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use schemars::JsonSchema;
use serde::Serialize;

use crate::visible::visible;

/// More problems of one file than this are not looked for, where a file of any length is read.
pub const MOST_PROBLEMS: usize = 200;

/// More problems than this are counted, not shown; `--json` has them all.
const MOST_SHOWN: usize = 100;

/// Of more problems than this that differ in numbers alone the first is shown, and the rest is counted.
const MOST_ALIKE: usize = 3;

/// The columns a line of source may take before it is cut around its problem.
const SHOWN_WIDTH: usize = 140;

/// One problem, with its place in the file.
///
/// Serialised it has `file`, `line`, `column`, `span` (bytes), `message` and `hint`.
/// `Display` gives one line: `path:line:column: message`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Problem {
    /// The path of the file, as it was given.
    pub(super) file: String,
    /// The line, from 1.
    pub(super) line: usize,
    /// The column, from 1, in characters.
    pub(super) column: usize,
    /// The offending bytes of the text.
    pub(super) span: Range<usize>,
    /// The key, its value, the limit and the unit.
    pub(super) message: String,
    /// What to do about it, where that is known.
    pub(super) hint: Option<String>,
    /// `None` where there is no line to show: a file as a whole, or a line that is too long to be read on a screen.
    #[serde(skip)]
    pub(super) excerpt: Option<Excerpt>,
}

/// The line a problem begins on; `span` is in bytes of `text`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Excerpt {
    pub(super) text: String,
    pub(super) span: Range<usize>,
}

impl Problem {
    /// A problem of the file `name` as a whole, of which no line can be shown.
    pub fn of_file(name: &str, message: impl Into<String>, hint: &str) -> Problem {
        Problem {
            file: name.to_owned(),
            line: 1,
            column: 1,
            span: 0..0,
            message: message.into(),
            hint: Some(hint.to_owned()),
            excerpt: None,
        }
    }

    /// A problem found in one separate line, moved to its position in the file: on line `line`, after `bytes_before`.
    pub(crate) fn in_file(mut self, line: usize, bytes_before: usize) -> Self {
        self.line = line;
        self.span = self.span.start + bytes_before..self.span.end + bytes_before;
        self
    }

    /// The message for a file that may not be quoted and has `count` problems, of which this is the first.
    fn unquoted(self, count: usize) -> Problem {
        let message = match count {
            1 => "the file is not valid here".to_owned(),
            _ => format!("the file has {count} problems, the first one here"),
        };
        let hint = "files outside the folder of the study are not quoted: name the file on the command line to see more";
        Problem {
            span: 0..0,
            message,
            hint: Some(hint.to_owned()),
            excerpt: None,
            ..self
        }
    }

    /// The path of the file, as it was given.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The line, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The column, from 1, in characters.
    pub fn column(&self) -> usize {
        self.column
    }

    /// The offending bytes of the text.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The key, its value, the limit and the unit.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What to do about it, where that is known.
    pub fn hint(&self) -> Option<&str> {
        self.hint.as_deref()
    }

    /// The title, the line with its caret, the hint; where no line can be shown, its place alone.
    ///
    /// Characters that would control a terminal are escaped before colours are added.
    fn rendered(&self, renderer: &Renderer) -> String {
        let title = Level::ERROR.primary_title(visible(&self.to_string()).into_owned());
        let file = visible(&self.file);
        let excerpt = self.excerpt.as_ref().map(Excerpt::visible);
        let mut group = match &excerpt {
            Some(excerpt) => Group::with_title(title).element(
                Snippet::source(excerpt.text.as_str())
                    .line_start(self.line)
                    .path(&*file)
                    .annotation(AnnotationKind::Primary.span(excerpt.span.clone())),
            ),
            None => Group::with_title(title)
                .element(Origin::path(&*file).line(self.line).char_column(self.column)),
        };
        let hint = self.hint.as_deref().map(visible);
        if let Some(hint) = &hint {
            group = group.element(Level::HELP.message(&**hint));
        }
        renderer.render(&[group])
    }
}

impl Excerpt {
    /// The same with escapes for characters that would control a terminal; the span moves with its text.
    fn visible(&self) -> Excerpt {
        let shown = |text: Option<&str>| visible(text.unwrap_or_default()).into_owned();
        let before = shown(self.text.get(..self.span.start));
        let marked = shown(self.text.get(self.span.clone()));
        let after = shown(self.text.get(self.span.end..));
        Excerpt {
            span: before.len()..before.len() + marked.len(),
            text: before + &marked + &after,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{}:{}:{}: {}",
            self.file, self.line, self.column, self.message
        )
    }
}

/// Everything that is wrong in a file, in the order of the text.
///
/// `Display` is the plain text for a terminal: source, caret and hint of the first 100 problems; of many that differ in
/// numbers alone those of the first.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[serde(transparent)]
pub struct Problems(Vec<Problem>);

impl Problems {
    /// The problems, in the order of the text.
    pub fn as_slice(&self) -> &[Problem] {
        &self.0
    }

    /// Success if nothing is wrong.
    ///
    /// # Errors
    /// The problems themselves, if there is one.
    pub fn into_result(self) -> Result<(), Self> {
        if self.0.is_empty() { Ok(()) } else { Err(self) }
    }

    /// The same problems; of each file that may not be quoted one problem alone, which says how many there are and
    /// where the first one is, and nothing of the content of the file.
    #[must_use]
    pub fn quoting_only(self, may_be_quoted: impl Fn(&str) -> bool) -> Problems {
        let mut kept: Vec<Problem> = Vec::new();
        let mut unquoted: Option<(Problem, usize)> = None;
        // Problems are sorted by file: those of one file follow each other.
        for problem in self.0 {
            match &mut unquoted {
                Some((first, count)) if first.file == problem.file => *count += 1,
                _ => {
                    kept.extend(unquoted.take().map(|(first, count)| first.unquoted(count)));
                    match may_be_quoted(&problem.file) {
                        true => kept.push(problem),
                        false => unquoted = Some((problem, 1)),
                    }
                }
            }
        }
        kept.extend(unquoted.map(|(first, count)| first.unquoted(count)));
        Problems(kept)
    }

    /// The text of `Display` with terminal colours.
    pub fn in_colour(&self) -> String {
        self.rendered(&Renderer::styled())
    }

    /// A list of objects with `file`, `line`, `column`, `span`, `message` and `hint`: all problems, for `--json`.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("strings, numbers and lists of them always serialise")
    }

    /// The first 100 problems with an empty line between, and how many more there are; of many that differ in numbers
    /// alone the first.
    fn rendered(&self, renderer: &Renderer) -> String {
        let renderer = renderer
            .clone()
            .decor_style(DecorStyle::Ascii)
            .term_width(SHOWN_WIDTH);
        let mut alike: BTreeMap<(&str, String), Vec<&Problem>> = BTreeMap::new();
        for problem in &self.0 {
            let group = alike.entry((problem.file(), pattern(problem.message())));
            group.or_default().push(problem);
        }
        let mut parts = Vec::new();
        let (mut shown, mut hidden) = (0, 0);
        for problem in &self.0 {
            let pattern = pattern(problem.message());
            let group = &alike[&(problem.file(), pattern.clone())];
            let more = if group.len() > MOST_ALIKE {
                group.len() - 1
            } else {
                0
            };
            if more > 0 && !std::ptr::eq(group[0], problem) {
                continue;
            }
            if shown == MOST_SHOWN {
                hidden += 1 + more;
                continue;
            }
            parts.push(problem.rendered(&renderer));
            shown += 1;
            if more > 0 {
                let last = group[more].line;
                let is_one = group.iter().all(|other| other.message() == problem.message());
                let message = if is_one { problem.message() } else { &pattern };
                parts.push(format!(
                    "... and {more} more up to line {last}: {}",
                    visible(message)
                ));
            }
        }
        if hidden > 0 {
            parts.push(format!("... and {hidden} more problems in this file"));
        }
        parts.join("\n\n")
    }
}

/// A message with `...` in place of its numbers, except in names between backquotes.
fn pattern(message: &str) -> String {
    let in_number = |c: char| c.is_ascii_digit() || c == '.';
    let mut pattern = String::new();
    for (index, part) in message.split('`').enumerate() {
        if index > 0 {
            pattern.push('`');
        }
        if index % 2 == 1 {
            pattern.push_str(part);
            continue;
        }
        let mut rest = part;
        while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
            let end = rest[start..]
                .find(|c| !in_number(c))
                .map_or(rest.len(), |length| start + length);
            pattern.push_str(rest[..start].strip_suffix('-').unwrap_or(&rest[..start]));
            pattern.push_str("...");
            rest = &rest[end..];
        }
        pattern.push_str(rest);
    }
    pattern
}

impl fmt::Display for Problems {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.rendered(&Renderer::plain()))
    }
}

impl std::error::Error for Problems {}

impl From<Vec<Problem>> for Problems {
    /// Sorted by file, then by place; problems at one place keep their order.
    fn from(mut problems: Vec<Problem>) -> Self {
        let place = |problem: &Problem| (problem.file.clone(), problem.span.start, problem.span.end);
        problems.sort_by_cached_key(place);
        Self(problems)
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

impl FromIterator<Problem> for Problems {
    fn from_iter<I: IntoIterator<Item = Problem>>(problems: I) -> Self {
        Self::from(problems.into_iter().collect::<Vec<_>>())
    }
}

impl IntoIterator for Problems {
    type Item = Problem;
    type IntoIter = std::vec::IntoIter<Problem>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}
/// A file that cannot be read, from its beginning or from somewhere on.
pub(crate) fn unreadable(path: &str, error: &std::io::Error) -> Problem {
    Problem::of_file(
        path,
        format!("cannot read it: {error}"),
        "check that the disk is connected",
    )
}
