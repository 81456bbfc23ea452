//! Tables of numbers without names: text, or the first sheet of an Excel workbook.
//!
//! Cells of a text are separated by `;`, tab, `,` or blanks; with `;` or tab, decimal commas are read too. Lines before the first row of numbers are
//! titles; lines that begin with `#` and empty lines are ignored. Only the requested columns need to be numbers.

use super::workbook::{SheetCell, first_sheet, is_workbook};
use crate::document::lines::Lines;
use crate::document::{MOST_PROBLEMS, Problem, Problems};
use crate::table::sheet::{Cell, cells, number};

/// Maximum number of rows.
const MOST_ROWS: usize = 1_000_000;

/// Columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// The first of each row.
    First(usize),
    /// The last of each row.
    Last(usize),
}

impl Columns {
    fn count(self) -> usize {
        let (Columns::First(count) | Columns::Last(count)) = self;
        count
    }

    fn of<T>(self, row: &[T]) -> Option<&[T]> {
        match self {
            Columns::First(count) => row.get(..count),
            Columns::Last(count) => row.get(row.len().checked_sub(count)?..),
        }
    }
}

/// The numbers in these columns of each row; `path` is the file name shown in problems.
///
/// # Errors
/// No such rows; a row of numbers with too few cells, or with one that is not a finite number; a damaged workbook.
pub fn read(path: &str, bytes: &[u8], columns: Columns) -> Result<Vec<Vec<f64>>, Problems> {
    let rows = match is_workbook(bytes) {
        true => of_workbook(path, bytes, columns)?,
        false => of_text(path, bytes, columns)?,
    };
    match rows.is_empty() {
        true => Err(Problem::of_file(path, "the file has no rows of numbers", &hint(columns)).into()),
        false => Ok(rows),
    }
}

/// Whether this is a text whose first row is numbers: there are no titles. At least `columns` of them.
pub fn is_without_titles(bytes: &[u8], columns: usize) -> bool {
    if is_workbook(bytes) {
        return false;
    }
    let Ok(Some(line)) = Lines::new("", bytes).next_row() else {
        return false;
    };
    let (separator, found) = row_of(&line.text);
    let is_number = |cell: &Cell<'_>| number(&cell.text, separator).is_some();
    found.len() >= columns && found.iter().all(is_number)
}

/// The cells of a row, without empty ones at its end, and what separates them.
fn row_of(text: &str) -> (char, Vec<Cell<'_>>) {
    let separator = [';', '\t', ','].into_iter().find(|c| text.contains(*c));
    let mut found = match separator {
        Some(separator) => cells(text, separator),
        None => blank_separated(text),
    };
    // A comma that separates nothing is the end of the row.
    let end = found.iter().rposition(|cell| !cell.text.is_empty());
    found.truncate(end.map_or(0, |last| last + 1));
    (separator.unwrap_or(' '), found)
}

fn hint(columns: Columns) -> String {
    match columns {
        Columns::First(count) => format!("one row per pose; its first {count} cells are numbers"),
        Columns::Last(count) => format!("one row per pose; its last {count} cells are numbers"),
    }
}

fn of_text(path: &str, bytes: &[u8], columns: Columns) -> Result<Vec<Vec<f64>>, Problems> {
    let mut lines = Lines::new(path, bytes);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut problems = Vec::new();
    while problems.len() < MOST_PROBLEMS {
        let line = match lines.next_row() {
            Ok(None) => break,
            Err(wrong) => {
                problems.extend(wrong);
                break;
            }
            Ok(Some(line)) => line,
        };
        let whole = 0..line.text.len();
        if rows.len() == MOST_ROWS {
            let message = format!("more than {MOST_ROWS} rows");
            problems.push(line.problem(path, whole, message, "a few hundred poses are sufficient"));
            break;
        }
        let (separator, found) = row_of(&line.text);
        let value = |cell: &Cell<'_>| number(&cell.text, separator).filter(|value| value.is_finite());
        let Some(requested) = columns.of(&found) else {
            if rows.is_empty() {
                continue;
            }
            let message = format!("{} cells instead of at least {}", found.len(), columns.count());
            problems.push(line.problem(path, whole, message, &hint(columns)));
            continue;
        };
        let numbers: Vec<Option<f64>> = requested.iter().map(value).collect();
        if rows.is_empty() && problems.is_empty() && numbers.iter().all(Option::is_none) {
            continue;
        }
        for (cell, _) in requested
            .iter()
            .zip(&numbers)
            .filter(|(_, number)| number.is_none())
        {
            let message = format!("`{}` is not a number", cell.text);
            problems.push(line.problem(path, cell.span.clone(), message, &hint(columns)));
        }
        rows.push(numbers.into_iter().flatten().collect());
    }
    Problems::from(problems).into_result()?;
    Ok(rows)
}

/// The words of a line with their places.
pub(super) fn blank_separated(text: &str) -> Vec<Cell<'_>> {
    let start = |part: &str| part.as_ptr() as usize - text.as_ptr() as usize;
    text.split_whitespace()
        .map(|part| Cell {
            text: part.into(),
            span: start(part)..start(part) + part.len(),
        })
        .collect()
}

fn of_workbook(path: &str, bytes: &[u8], columns: Columns) -> Result<Vec<Vec<f64>>, Problems> {
    let value = |text: &str| number(text, ';').filter(|value| value.is_finite());
    let sparse = first_sheet(path, bytes, |cell| match cell {
        SheetCell::Number(number) => Some(number).filter(|number| number.is_finite()),
        SheetCell::Text(text) => value(text),
        SheetCell::Other => None,
    })?;
    // The table begins at its leftmost cell.
    let left = sparse
        .values()
        .flatten()
        .map(|(column, _)| *column)
        .min()
        .unwrap_or(0);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut problems = Vec::new();
    for (index, mut row) in sparse {
        if rows.len() == MOST_ROWS || problems.len() == MOST_PROBLEMS {
            break;
        }
        row.sort_by_key(|(column, _)| *column);
        row.dedup_by_key(|(column, _)| *column);
        match sheet_row(&row, left, columns) {
            Some(whole) => rows.push(whole),
            None if rows.is_empty() => {}
            None => {
                let message = format!(
                    "row {} of the sheet is not a row of numbers",
                    u64::from(index) + 1
                );
                problems.push(Problem::of_file(path, message, &hint(columns)));
            }
        }
    }
    Problems::from(problems).into_result()?;
    Ok(rows)
}

/// The requested numbers of a row of cells (column, number) that are sorted; `None` if one is missing or not a number.
fn sheet_row(row: &[(u32, Option<f64>)], left: u32, columns: Columns) -> Option<Vec<f64>> {
    let requested = match columns {
        Columns::First(_) => row,
        Columns::Last(_) => columns.of(row)?,
    };
    let first = match columns {
        Columns::First(_) => left,
        Columns::Last(count) => row
            .last()?
            .0
            .checked_sub(u32::try_from(count).ok()?.checked_sub(1)?)?,
    };
    let requested = requested.iter().take(columns.count()).enumerate();
    let numbers: Vec<f64> = requested
        .map(|(index, (column, number))| number.filter(|_| *column as usize == first as usize + index))
        .collect::<Option<_>>()?;
    (numbers.len() == columns.count()).then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::super::workbook::tests::workbook_of;
    use super::*;

    fn of(text: &str, columns: Columns) -> Result<Vec<Vec<f64>>, Problems> {
        read("joints.txt", text.as_bytes(), columns)
    }

    #[test]
    fn rows_are_read_whatever_separates_them() {
        for text in [
            "1 2.5 -3e0\n  4 5 6\n",
            "a,b,c\n1,2.5,-3\n\n# done\n4,5,6,\n",
            "1;2,5;-3\n4;5;6\n",
            "1\t2.5\t-3\n4\t5\t6\n",
        ] {
            assert_eq!(
                of(text, Columns::First(3)).unwrap(),
                [[1.0, 2.5, -3.0], [4.0, 5.0, 6.0]],
                "{text}"
            );
        }
        let named = "P1 1 2 3\nP2 4 5 6\n";
        assert_eq!(of(named, Columns::Last(2)).unwrap(), [[2.0, 3.0], [5.0, 6.0]]);
    }

    #[test]
    fn titles_are_recognised() {
        let without = |text: &str| is_without_titles(text.as_bytes(), 3);
        assert!(without("# robot\n\n1 2 3\n4 5 6\n") && without("1;2,5;3;\n"));
        assert!(!without("a b c\n1 2 3\n") && !without("1 2\n") && !without("") && !without("1,2,P1\n"));
    }

    #[test]
    fn problems_have_their_places() {
        for (text, parts) in [
            ("", &["no rows of numbers"][..]),
            ("only words\n", &["no rows of numbers", "first 3 cells"]),
            (
                "1 2 3\n4 x 6\n7 8\n1 2 inf\n",
                &["2:3", "`x`", "3:1", "2 cells instead of at least 3", "`inf`"],
            ),
        ] {
            let problems = of(text, Columns::First(3)).unwrap_err().to_string();
            for part in parts {
                assert!(problems.contains(part), "{part}: {problems}");
            }
        }
    }

    /// A workbook with one sheet: titles, two rows of numbers, as a spreadsheet writes it.
    fn workbook() -> Vec<u8> {
        workbook_of(SHEET)
    }

    const SHEET: &str = r#"<?xml version="1.0"?><worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData><row r="1"><c r="A1" t="inlineStr"><is><t>J1</t></is></c></row><row r="2"><c r="A2" t="inlineStr"><is><t>P1</t></is></c><c r="B2"><v>1.5</v></c><c r="C2"><v>-2</v></c></row><row r="3"><c r="A3" t="inlineStr"><is><t>P2</t></is></c><c r="B3"><v>3</v></c><c r="C3"><v>4</v></c></row></sheetData></worksheet>"#;

    #[test]
    fn the_first_sheet_of_a_workbook_is_read_and_damaged_ones_are_refused() {
        let whole = workbook();
        let rows = read("joints.xlsx", &whole, Columns::Last(2)).unwrap();
        assert_eq!(rows, [[1.5, -2.0], [3.0, 4.0]]);
        let problems = read("joints.xlsx", &whole, Columns::Last(4))
            .unwrap_err()
            .to_string();
        assert!(problems.contains("no rows of numbers"), "{problems}");
        for cut in (4..whole.len()).step_by(7) {
            let _ = read("joints.xlsx", &whole[..cut], Columns::Last(2));
            let mut damaged = whole.clone();
            damaged[cut] ^= 0x55;
            let _ = read("joints.xlsx", &damaged, Columns::Last(2));
        }
        let half = read("joints.xlsx", &whole[..whole.len() / 2], Columns::Last(2))
            .unwrap_err()
            .to_string();
        assert!(half.contains("save the sheet as CSV"), "{half}");
    }

    #[test]
    fn a_cell_at_the_far_corner_of_a_sheet_takes_no_memory_before_it() {
        // All cells up to this one would need 400 GB.
        let far = SHEET.replace(
            "</sheetData>",
            "<row r=\"1048576\"><c r=\"XFC1048576\"><v>5</v></c><c r=\"XFD1048576\"><v>6</v></c></row></sheetData>",
        );
        let rows = read("far.xlsx", &workbook_of(&far), Columns::Last(2)).unwrap();
        assert_eq!(rows, [[1.5, -2.0], [3.0, 4.0], [5.0, 6.0]]);
        let problems = read("far.xlsx", &workbook_of(&far), Columns::Last(3)).unwrap_err();
        assert!(problems.to_string().contains("no rows of numbers"), "{problems}");
        // A column with more letters than any sheet has: whatever it is taken for, nothing stops.
        let beyond = SHEET
            .replace("C3", "AAAAAAAAAA3")
            .replace("C2", "ZZZZZZZZZZZZ99999999999");
        let _ = read("beyond.xlsx", &workbook_of(&beyond), Columns::Last(2));
        // A row with a gap is not a row of numbers.
        let gap = SHEET.replace("B3", "AA3");
        let problems = read("gap.xlsx", &workbook_of(&gap), Columns::Last(2)).unwrap_err();
        assert!(problems.to_string().contains("row 3 of the sheet"), "{problems}");
        let first = SHEET.replace(
            "<c r=\"A2\" t=\"inlineStr\"><is><t>P1</t></is></c>",
            "<c r=\"A2\"><v>7</v></c>",
        );
        let problems = read("first.xlsx", &workbook_of(&first), Columns::First(2)).unwrap_err();
        assert!(problems.to_string().contains("row 3 of the sheet"), "{problems}");
    }
}
