//! Lines of a table written by a person, as cells that know their place: shared by all readers of tables.
//!
//! Cells are separated by `;`, tab or `,`: the first of these that the line of names contains. Where it is not `,`,
//! numbers may have a decimal comma. Lines that begin with `#` and empty ones are remarks.

use std::borrow::Cow;
use std::io::BufRead;
use std::ops::Range;

use super::csv::is_formula;
use crate::document::lines::{Line, Lines};
use crate::document::{MOST_PROBLEMS, Problem, Problems};

/// One cell: its text, and its position in the line, bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cell<'a> {
    /// Without blanks and quotes round it, and without the apostrophe that keeps a spreadsheet from running it.
    pub text: Cow<'a, str>,
    /// With its quotes, without the blanks.
    pub span: Range<usize>,
}

/// What separates the cells of a table whose names are on this line.
pub(crate) fn separator_of(names: &str) -> char {
    [';', '\t']
        .into_iter()
        .find(|c| names.contains(*c))
        .unwrap_or(',')
}

/// Whether a line is nothing but separators: spreadsheets leave such rows behind.
pub(crate) fn is_blank_row(line: &str, separator: char) -> bool {
    line.chars().all(|c| c == separator || c.is_whitespace())
}

/// The number in a cell, if it is one, infinite ones included; with a decimal comma where none separates cells.
///
/// `1.234,5` is none: it could be a thousand or a typing error.
pub(crate) fn number(text: &str, separator: char) -> Option<f64> {
    match separator != ',' && text.contains(',') {
        true => text.replace(',', ".").parse().ok(),
        false => text.parse().ok(),
    }
}

/// The cells of a line; quotes around a cell are taken off, and double ones inside are one.
///
/// A separator within quotes separates nothing. A line that ends with a separator has an empty last cell; a quote that
/// is never closed takes all to the end of the line.
pub(crate) fn cells(line: &str, separator: char) -> Vec<Cell<'_>> {
    let mut cells = Vec::new();
    let (mut from, mut quoted) = (0, false);
    for (at, c) in line.char_indices().chain([(line.len(), separator)]) {
        if c == '"' {
            quoted = !quoted;
        } else if (c == separator && !quoted) || at == line.len() {
            let content = &line[from..at];
            let start = from + content.len() - content.trim_start().len();
            let trimmed = content.trim();
            cells.push(Cell {
                text: without_apostrophe(without_quotes(trimmed)),
                span: start..start + trimmed.len(),
            });
            from = at + c.len_utf8();
        }
    }
    cells
}

/// The cells of a row of a table with this number of columns.
///
/// # Errors
/// Another number of cells; `path` is the file name shown in the problem.
pub(crate) fn row_cells<'l>(
    path: &str,
    line: &'l Line,
    separator: char,
    columns: usize,
) -> Result<Vec<Cell<'l>>, Problems> {
    let found = cells(&line.text, separator);
    if found.len() == columns {
        return Ok(found);
    }
    let message = format!("{} cells, but the table has {columns} columns", found.len());
    let hint = match separator {
        ',' => {
            "separate cells with `;` or a tab to use decimal commas; an empty cell is written as two separators in a \
             row"
        }
        _ => "every row needs one cell per column; an empty cell is written as two separators in a row",
    };
    Err(line.problem(path, 0..line.text.len(), message, hint).into())
}

/// Most rows of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowLimit {
    pub most: usize,
    /// What a row is, in the plural.
    pub rows: &'static str,
    /// What to do with a longer table.
    pub hint: &'static str,
}

impl RowLimit {
    /// The problem of the first line beyond the limit, of the file `path`.
    pub fn exceeded(self, path: &str, line: &Line) -> Problem {
        let message = format!("more than {} {}", self.most, self.rows);
        line.problem(path, 0..line.text.len(), message, self.hint)
    }
}

/// Calls `take` for each of the remaining rows that is not blank.
///
/// # Errors
/// All problems of the rows, at most 200 and those of the last row; a row beyond the limit.
pub(crate) fn each_row(
    lines: &mut Lines<impl BufRead>,
    separator: char,
    limit: RowLimit,
    mut take: impl FnMut(&Line) -> Result<(), Problems>,
) -> Result<(), Problems> {
    let (mut problems, mut count) = (Vec::new(), 0_usize);
    while problems.len() < MOST_PROBLEMS {
        let line = match lines.next_row() {
            Ok(None) => break,
            Ok(Some(line)) => line,
            Err(wrong) => {
                problems.extend(wrong);
                break;
            }
        };
        if is_blank_row(&line.text, separator) {
            continue;
        }
        if count == limit.most {
            problems.push(limit.exceeded(lines.name(), &line));
            break;
        }
        count += 1;
        problems.extend(take(&line).err().into_iter().flatten());
    }
    Problems::from(problems).into_result()
}

/// The meaning of the columns of a table.
pub(crate) struct NamedColumns<C> {
    /// One for each name of the header; `None` is ignored.
    pub columns: Vec<Option<C>>,
    /// The ignored names.
    pub unused: Vec<String>,
    /// Names with a problem, and repeated columns.
    pub problems: Vec<Problem>,
}

/// The columns that the header line names: `meaning` gives the meaning of a name (`None`: it is ignored), or a message
/// and a hint; `is_same` whether two columns give the same quantity.
pub(crate) fn named_columns<C: Copy>(
    path: &str,
    header: &Line,
    meaning: impl Fn(&str) -> Result<Option<C>, (String, String)>,
    is_same: impl Fn(C, C) -> bool,
) -> NamedColumns<C> {
    let found = cells(&header.text, separator_of(&header.text));
    named_cells(path, header, found, meaning, is_same)
}

/// The same of names that are already apart.
pub(crate) fn named_cells<C: Copy>(
    path: &str,
    header: &Line,
    names: Vec<Cell<'_>>,
    meaning: impl Fn(&str) -> Result<Option<C>, (String, String)>,
    is_same: impl Fn(C, C) -> bool,
) -> NamedColumns<C> {
    let mut found = NamedColumns {
        columns: Vec::new(),
        unused: Vec::new(),
        problems: Vec::new(),
    };
    for cell in names {
        let mut report = |message, hint: &str| {
            let problem = header.problem(path, cell.span.clone(), message, hint);
            found.problems.push(problem);
        };
        let column = meaning(&cell.text).unwrap_or_else(|(message, hint)| {
            report(message, &hint);
            None
        });
        let mut known = found.columns.iter().flatten();
        if column.is_some_and(|column| known.any(|earlier| is_same(*earlier, column))) {
            let message = format!("`{}` repeats an earlier column", cell.text);
            report(message, "remove one of the two columns");
        }
        if column.is_none() {
            found.unused.push(cell.text.into_owned());
        }
        found.columns.push(column);
    }
    found
}

/// A cell as it was meant.
fn without_quotes(cell: &str) -> Cow<'_, str> {
    if !cell.contains('"') {
        return Cow::Borrowed(cell);
    }
    let inner = cell.strip_prefix('"').unwrap_or(cell);
    let inner = inner.strip_suffix('"').unwrap_or(inner);
    Cow::Owned(inner.replace("\"\"", "\"").trim().to_owned())
}

/// A text as it was before `csv::write` put an apostrophe before it.
fn without_apostrophe(text: Cow<'_, str>) -> Cow<'_, str> {
    match text.strip_prefix('\'') {
        Some(rest) if is_formula(rest) => Cow::Owned(rest.to_owned()),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(line: &str, separator: char) -> Vec<String> {
        let cells = cells(line, separator).into_iter();
        cells.map(|cell| cell.text.into_owned()).collect()
    }

    #[test]
    fn the_separator_is_the_first_that_the_names_contain() {
        for (line, separator) in [
            ("a,b", ','),
            ("a,b;c", ';'),
            ("a\tb,c", '\t'),
            ("a;b\tc", ';'),
            ("a", ','),
        ] {
            assert_eq!(separator_of(line), separator, "{line}");
        }
    }

    #[test]
    fn rows_are_read_up_to_the_limit_and_their_problems_are_reported_together() {
        let limit = RowLimit {
            most: 3,
            rows: "points",
            hint: "divide it",
        };
        let read = |text: &str| {
            let mut taken = Vec::new();
            let read = each_row(&mut Lines::new("p.csv", text.as_bytes()), ',', limit, |line| {
                taken.push(line.text.clone());
                match line.text.contains('x') {
                    true => Err(line.problem("p.csv", 0..1, "bad", "hint").into()),
                    false => Ok(()),
                }
            });
            (taken, read.err().map(|problems| problems.to_string()))
        };
        assert_eq!(
            read("1\n,,\n2\n\n3\n"),
            (["1", "2", "3"].map(str::to_owned).to_vec(), None)
        );
        let (taken, problems) = read("1\nx2\n,,\nx3\n4\n5\n");
        let problems = problems.unwrap();
        assert_eq!(taken.len(), 3);
        for part in [
            "p.csv:2:1: bad",
            "p.csv:4:1: bad",
            "p.csv:5:1: more than 3 points",
        ] {
            assert!(problems.contains(part), "{part}: {problems}");
        }
    }

    #[test]
    fn quotes_are_taken_off_once_and_hide_separators() {
        assert_eq!(texts("\"a,b\", c ,\"\"", ','), ["a,b", "c", ""]);
        assert_eq!(texts("\"say \"\"no\"\"\"", ','), ["say \"no\""]);
        assert_eq!(texts("\"\"\"x\"\"\";2\"", ';'), ["\"x\"", "2"]);
    }

    #[test]
    fn an_open_quote_contains_the_rest_of_its_line() {
        assert_eq!(texts("a,\"b,c", ','), ["a", "b,c"]);
    }

    #[test]
    fn tabs_separate_and_blanks_around_cells_are_dropped() {
        assert_eq!(texts(" a \t b c\t", '\t'), ["a", "b c", ""]);
    }

    #[test]
    fn a_separator_at_the_end_makes_an_empty_cell() {
        assert_eq!(texts("1,2,", ','), ["1", "2", ""]);
        assert_eq!(texts("", ','), [""]);
        assert!(is_blank_row(" ; ;", ';') && !is_blank_row("; 0 ;", ';'));
    }

    #[test]
    fn spans_are_the_bytes_of_cells_without_blanks() {
        let spans: Vec<Range<usize>> = cells("\u{e4} , \"b\",c", ',')
            .into_iter()
            .map(|cell| cell.span)
            .collect();
        assert_eq!(spans, [0..2, 5..8, 9..10]);
    }

    #[test]
    fn a_decimal_comma_is_read_where_no_comma_separates() {
        assert_eq!(number("-0,5", ';'), Some(-0.5));
        assert_eq!(number("0.5", '\t'), Some(0.5));
        for (text, separator) in [
            ("0,5", ','),
            ("1.234,5", ';'),
            ("1,2,3", ';'),
            ("", ';'),
            ("1 N", ','),
        ] {
            assert_eq!(number(text, separator), None, "{text}");
        }
    }
}
