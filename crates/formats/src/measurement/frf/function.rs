//! One function of a universal file: dataset 58.
//!
//! | record | format | content |
//! |---|---|---|
//! | 1 to 5 | 80A1 | remarks |
//! | 6 | 2(I5,I10),2(1X,10A1,I10,I4) | type of function (4: FRF, 6: coherence), ..., response: name, node, direction; reference: the same |
//! | 7 | 3I10,3E13.5 | type of data (2, 4: real; 5, 6: complex; 4, 6: double precision), count, spacing (1: even), first, step |
//! | 8 to 11 | I10,3I5,2(1X,20A1) | abscissa, numerator, denominator, z: specific type, exponents, label, unit |
//! | 12 | 6E13.5, 4E20.12, or with double and uneven spacing E13.5 before each value; `binary` in dataset 58b | data |
//!
//! Source: universal file formats of the SDRC, dataset 58, University of Cincinnati (recalled, compared with the files of pyuff 2.5.8).

use std::io::BufRead;
use std::ops::Range;

use super::binary::BinaryForm;
use super::layout::Shape;
use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};

/// Hint of problems in the layout.
const HINT: &str = "dataset 58 of a universal file has fixed columns: export the FRFs again, as ASCII";

/// A function as in the file.
#[derive(Clone, Debug)]
pub(super) struct Function {
    /// The line of record 6.
    pub line: Line,
    /// Type of the function.
    pub kind: i64,
    /// Node and direction of the response, then of the reference.
    pub dofs: [[i64; 2]; 2],
    /// Abscissa, numerator and denominator.
    pub axes: [Axis; 3],
    /// Abscissa.
    pub abscissa: Vec<f64>,
    /// Ordinate: real and imaginary part.
    pub values: Vec<[f64; 2]>,
    /// What to know of it.
    pub note: Option<String>,
}

/// An axis.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Its line.
    pub line: Line,
    /// Specific data type.
    pub kind: i64,
    /// Label of the unit; empty if there is none.
    pub unit: String,
}

/// A whole number in fixed columns; blanks are 0.
fn whole(path: &str, line: &Line, columns: Range<usize>, problems: &mut Vec<Problem>) -> i64 {
    let text = columns_of(&line.text, &columns).trim();
    match text.parse() {
        _ if text.is_empty() => 0,
        Ok(value) => value,
        Err(_) => {
            let message = format!("`{text}` is not a whole number");
            problems.push(line.problem(path, columns, message, HINT));
            0
        }
    }
}

/// Fixed columns of a line; a line may end before them.
fn columns_of<'l>(text: &'l str, columns: &Range<usize>) -> &'l str {
    let end = text.floor_char_boundary(columns.end.min(text.len()));
    let start = text.floor_char_boundary(columns.start.min(end));
    &text[start..end]
}

/// A number of Fortran: `1.5E+01`, `1.5D+01`.
pub(super) fn fortran(text: &str) -> Option<f64> {
    let text = text.trim().replace(['d', 'D'], "E");
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// Reads a function, after the line with its number and up to its last value; its data are text, or of a binary form.
///
/// # Errors
/// Its problems.
pub(super) fn read(
    lines: &mut Lines<impl BufRead>,
    most: usize,
    binary: Option<&BinaryForm>,
) -> Result<Function, Problems> {
    let path = lines.name().to_owned();
    for _ in 0..5 {
        next(lines)?;
    }
    let mut problems = Vec::new();
    let line = next(lines)?;
    let kind = whole(&path, &line, 0..5, &mut problems);
    let dofs = [[41..51, 51..55], [66..76, 76..80]]
        .map(|columns| columns.map(|columns| whole(&path, &line, columns, &mut problems)));
    let form = next(lines)?;
    let [data, count, spacing] =
        [0..10, 10..20, 20..30].map(|columns| whole(&path, &form, columns, &mut problems));
    if !matches!(data, 2 | 4 | 5 | 6) {
        let message = format!("{data} is not a type of data");
        problems.push(form.problem(&path, 0..10, message, "2 and 4 are real, 5 and 6 complex"));
    }
    if !(1..=most as i64).contains(&count) {
        let message = format!("{count} values; the limit is 1 to {most}");
        problems.push(form.problem(&path, 10..20, message, "divide the file"));
    }
    let mut real = |columns: Range<usize>| {
        let text = columns_of(&form.text, &columns).trim();
        fortran(text).unwrap_or_else(|| {
            if spacing == 1 {
                let message = format!("`{text}` is not a number");
                problems.push(form.problem(&path, columns, message, HINT));
            }
            0.0
        })
    };
    let [first, step] = [real(30..43), real(43..56)];
    let mut axis = || -> Result<Axis, Problems> {
        let line = next(lines)?;
        let unit = columns_of(&line.text, &(46..67)).trim().to_owned();
        Ok(Axis {
            kind: whole(&path, &line, 0..10, &mut problems),
            unit: if unit == "NONE" { String::new() } else { unit },
            line,
        })
    };
    let axes = [axis()?, axis()?, axis()?];
    axis()?;
    Problems::from(problems).into_result()?;
    let shape = Shape {
        is_double: data == 4 || data == 6,
        parts: if data >= 5 { 2 } else { 1 },
        is_uneven: spacing != 1,
        count: count as usize,
    };
    let (numbers, note) = match binary {
        None => (numbers(lines, &shape)?, None),
        Some(form) => form.numbers(lines, &shape)?,
    };
    let per_value = shape.per_value();
    let parts = numbers.chunks_exact(per_value);
    let abscissa = parts
        .clone()
        .enumerate()
        .map(|(index, value)| match shape.is_uneven {
            true => value[0],
            false => first + step * index as f64,
        });
    Ok(Function {
        line,
        kind,
        dofs,
        axes,
        abscissa: abscissa.collect(),
        values: parts
            .map(|value| match shape.parts {
                2 => [value[per_value - 2], value[per_value - 1]],
                _ => [value[per_value - 1], 0.0],
            })
            .collect(),
        note,
    })
}

/// The numbers of the data.
fn numbers(lines: &mut Lines<impl BufRead>, shape: &Shape) -> Result<Vec<f64>, Problems> {
    let needed = shape.count * shape.per_value();
    let mut found: Vec<f64> = Vec::new();
    while found.len() < needed {
        let line = next(lines)?;
        if is_delimiter(&line.text) {
            let message = format!("the dataset ends after {} of {needed} numbers", found.len());
            let hint = "the file is not complete: export it again";
            return Err(line
                .problem(lines.name(), 0..line.text.len(), message, hint)
                .into());
        }
        let words: Option<Vec<f64>> = line.text.split_ascii_whitespace().map(fortran).collect();
        match words {
            Some(words) => found.extend(words),
            // Numbers without a blank between them.
            None => {
                let mut start = 0;
                while start < line.text.trim_end().len() {
                    let columns = start..start + shape.width(found.len());
                    let text = columns_of(&line.text, &columns);
                    let Some(value) = fortran(text) else {
                        let message = format!("`{}` is not a finite number", text.trim());
                        return Err(line.problem(lines.name(), columns, message, HINT).into());
                    };
                    found.push(value);
                    start = columns.end;
                }
            }
        }
        if found.len() > needed {
            let message = format!("more than {needed} numbers");
            return Err(line
                .problem(lines.name(), 0..line.text.len(), message, HINT)
                .into());
        }
    }
    Ok(found)
}

/// Whether a line begins or ends a dataset.
pub(super) fn is_delimiter(text: &str) -> bool {
    text.trim() == "-1"
}

fn next(lines: &mut Lines<impl BufRead>) -> Result<Line, Problems> {
    let found = lines.next()?;
    found.ok_or_else(|| {
        let hint = "the file is not complete: export it again";
        Problem::of_file(lines.name(), "the file ends within a dataset", hint).into()
    })
}
