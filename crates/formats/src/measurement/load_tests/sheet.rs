//! A table as lines: the header and the rows below it.
//!
//! The first line that is not a comment names the columns. Blank rows and comments are left out. Lines are split into
//! cells on demand, so that a table is stored only as its text.

use std::io::BufRead;

use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{Cell, cells, is_blank_row, row_cells, separator_of};

/// A header and rows that may differ in length.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    /// The file name shown in problems.
    name: String,
    /// Separator in the header.
    pub separator: char,
    /// The names.
    pub header: Line,
    /// Rows that are not blank.
    pub rows: Vec<Line>,
}

impl Sheet {
    /// The table in this text; `None` if it has only comments.
    ///
    /// # Errors
    /// A file that is not text.
    pub fn read(name: &str, reader: impl BufRead) -> Result<Option<Sheet>, Problems> {
        let mut lines = Lines::new(name, reader);
        let mut sheet: Option<Sheet> = None;
        while let Some(line) = lines.next_row()? {
            match &mut sheet {
                Some(sheet) if is_blank_row(&line.text, sheet.separator) => {}
                Some(sheet) => sheet.rows.push(line),
                None => {
                    sheet = Some(Sheet {
                        name: name.to_owned(),
                        separator: separator_of(&line.text),
                        header: line,
                        rows: Vec::new(),
                    });
                }
            }
        }
        Ok(sheet)
    }

    /// The names of the columns.
    pub fn heads(&self) -> Vec<Cell<'_>> {
        self.cells(&self.header)
    }

    /// The cells of a line.
    pub fn cells<'a>(&self, line: &'a Line) -> Vec<Cell<'a>> {
        cells(&line.text, self.separator)
    }

    /// The cells of a row of this number of columns.
    ///
    /// # Errors
    /// Another number of cells.
    pub fn row<'a>(&self, row: &'a Line, columns: usize) -> Result<Vec<Cell<'a>>, Problems> {
        row_cells(&self.name, row, self.separator, columns)
    }

    /// A problem of a cell of this line.
    pub fn problem(&self, line: &Line, cell: &Cell<'_>, message: impl Into<String>, hint: &str) -> Problem {
        line.problem(&self.name, cell.span.clone(), message, hint)
    }

    /// A problem of a line from its first cell to its last.
    pub fn problem_of_line(&self, line: &Line, message: impl Into<String>, hint: &str) -> Problem {
        let start = line.text.len() - line.text.trim_start().len();
        line.problem(&self.name, start..line.text.trim_end().len(), message, hint)
    }
}
