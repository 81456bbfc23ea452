//! Text as rows of cells that know their place.

use std::ops::Range;

use crate::document::Source;

/// One cell: what it says, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub text: String,
    pub span: Range<usize>,
}

/// A header and rows, not yet of equal length.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub separator: char,
    pub header: Vec<Cell>,
    pub rows: Vec<Vec<Cell>>,
}

impl Sheet {
    /// The table in this text; `None` if there is no line that is not empty or a remark.
    pub fn of(source: &Source) -> Option<Sheet> {
        let mut at = 0;
        let mut lines = Vec::new();
        for line in source.text().split_inclusive('\n') {
            let content = line.trim_end_matches(['\n', '\r']);
            if !content.trim().is_empty() && !content.trim_start().starts_with('#') {
                lines.push((at, content));
            }
            at += line.len();
        }
        let (first, rest) = lines.split_first()?;
        let separator = [';', '\t']
            .into_iter()
            .find(|c| first.1.contains(*c))
            .unwrap_or(',');
        Some(Sheet {
            separator,
            header: cells(*first, separator),
            // Spreadsheets leave lines of separators behind.
            rows: rest
                .iter()
                .filter(|(_, content)| content.chars().any(|c| c != separator && !c.is_whitespace()))
                .map(|line| cells(*line, separator))
                .collect(),
        })
    }

    /// The line of column names.
    pub fn header_span(&self) -> Range<usize> {
        let start = self.header.first().map_or(0, |cell| cell.span.start);
        start..self.header.last().map_or(start, |cell| cell.span.end)
    }
}

/// The cells of a line that begins at this byte; quotes around a cell are taken off.
pub(crate) fn cells((start, line): (usize, &str), separator: char) -> Vec<Cell> {
    let mut cells = Vec::new();
    let (mut from, mut quoted) = (0, false);
    for (at, c) in line.char_indices().chain([(line.len(), separator)]) {
        if c == '"' {
            quoted = !quoted;
        } else if (c == separator && !quoted) || at == line.len() {
            let content = &line[from..at];
            let blank = content.len() - content.trim_start().len();
            let trimmed = content.trim();
            cells.push(Cell {
                text: trimmed.trim_matches('"').replace("\"\"", "\""),
                span: start + from + blank..start + from + blank + trimmed.len(),
            });
            from = at + c.len_utf8();
        }
    }
    cells
}
