//! Joint logs: joint positions over time, as a controller or its interface for external control records them.
//!
//! | column | names, in any case | unit |
//! |---|---|---|
//! | time | `t`, `time`, `timestamp`, `IPOC` | `_s`, `_ms`, `_us`, `_ns`; `IPOC` (RSI) ms |
//! | actual position | `J1`, `A1`, `q1`, `joint_1`; `actual_q_0` (RTDE); `AIPos.A1` (RSI); `fb_j1` (EGM) | `_deg`, `_rad`; RTDE rad, RSI and EGM deg |
//! | commanded position | `target_q_0` (RTDE); `ASPos.A1` (RSI); `planned_j1` (EGM); `cmd_j1`, `set_j1` | the same |
//! | position of the link encoder | `link_j1`, `link_A1`; the motor encoder, reduced to the joint, is the actual position (`motor_j1`) | the same |
//! | torque of the motor | `torque_j1`, `torque_A1` | N m, `_nm` |
//! | move | `cmd_num`, `move`, `segment` | whole number |
//!
//! One row per instant. Cells are separated by `;`, tab, `,` or blanks. Units may also be in brackets: `J1 [deg]`. Joints are numbered
//! from 0 or from 1. A unit that the header does not give is taken from [`LogReadOptions`], or from the values where only one unit is possible; the
//! [notes](JointLog::notes) say so. Other columns are ignored and listed. Times are returned in s, positions in rad.
//!
//! `unit`: units. `log`: the log. `columns`: meaning of the names. `convert`: units that the header does not give, and SI.

use std::io::BufRead;

use crate::document::lines::{Line, Lines};
use crate::document::{Problem, Problems};
use crate::table::sheet::{Cell, RowLimit, cells, each_row, number, separator_of};

mod columns;
mod convert;
mod log;
mod unit;

pub use log::{JointLog, LogReadOptions};
pub use unit::{AngleUnit, TimeUnit};

use columns::{Columns, Meaning};
use log::HINT;

const LIMIT: RowLimit = RowLimit {
    most: 2_000_000,
    rows: "instants",
    hint: "divide the log",
};
/// Maximum absolute value of a cell, in its own unit.
const LARGEST: f64 = 1e19;

/// Reads the log in `reader` of an arm with `joints` joints; `None`: as many as the log has. `path` is the file name shown in problems.
///
/// # Errors
/// All problems of the file, at most 200: missing or duplicate columns, units that are not known, cells that are not finite numbers, rows of
/// another length, times that go back.
pub fn read(
    path: &str,
    reader: impl BufRead,
    joints: impl Into<Option<usize>>,
    given: LogReadOptions,
) -> Result<JointLog, Problems> {
    let mut lines = Lines::new(path, reader);
    let Some(header) = lines.next_row()? else {
        return Err(Problem::of_file(path, "the file has no instants", HINT).into());
    };
    let separator = separator(&header.text);
    let columns = Columns::of(path, &header, split(&header.text, separator), joints.into())?;
    let mut log = JointLog {
        joints: columns.joints,
        unused: columns.unused.clone(),
        commanded: columns.has_both().then(Vec::new),
        link: columns.has(Meaning::Link(0)).then(Vec::new),
        torque: columns.has(Meaning::Torque(0)).then(Vec::new),
        moves: columns.has(Meaning::Move).then(Vec::new),
        ..JointLog::default()
    };
    let (mut before, mut repeated) = (None::<f64>, 0_usize);
    each_row(&mut lines, separator, LIMIT, |line| {
        let (row, mut problems) = read_row(path, line, separator, &columns);
        let is_complete = problems.is_empty();
        // The time of a row with other problems is compared too, so that all rows that go back are reported at once.
        let Some((time, cell)) = row.time.clone() else {
            return Problems::from(problems).into_result();
        };
        match before {
            Some(before) if time < before => {
                let message = format!("time goes back: {time} after {before}");
                let hint = "sort the rows by time, or divide the log where the clock was reset";
                problems.push(line.problem(path, cell, message, hint));
            }
            Some(before) if time == before => repeated += 1,
            _ => {
                before = Some(time);
                if is_complete {
                    log.take(time, row, line.number);
                }
            }
        }
        Problems::from(problems).into_result()
    })?;
    if log.times.len() < 2 {
        let message = format!("a log of {} instants", log.times.len());
        return Err(Problem::of_file(path, message, HINT).into());
    }
    if repeated > 0 {
        let rows = if repeated == 1 {
            "row repeats"
        } else {
            "rows repeat"
        };
        log.notes
            .push(format!("{repeated} {rows} the time of the row before: left out"));
    }
    convert::convert(path, &header, &columns, given, &mut log)?;
    log.note_gaps();
    Ok(log)
}

/// What is read of a row, in the units of the file.
struct Row {
    /// With the place of its cell.
    time: Option<(f64, std::ops::Range<usize>)>,
    actual: Vec<f64>,
    commanded: Vec<f64>,
    link: Vec<f64>,
    torque: Vec<f64>,
    number: Option<i64>,
}

impl JointLog {
    fn take(&mut self, time: f64, row: Row, line: usize) {
        self.times.push(time);
        self.lines.push(line);
        match &mut self.commanded {
            Some(commanded) => {
                commanded.extend(row.commanded);
                self.positions.extend(row.actual);
            }
            // A log of one of them.
            None => self.positions.extend(row.actual.into_iter().chain(row.commanded)),
        }
        for (values, own) in [(&mut self.link, row.link), (&mut self.torque, row.torque)] {
            if let Some(values) = values {
                values.extend(own);
            }
        }
        if let Some((moves, number)) = self.moves.as_mut().zip(row.number) {
            moves.push(number);
        }
    }
}

/// The separator of a table with this header: a blank where it contains no other.
fn separator(header: &str) -> char {
    match separator_of(header) {
        ',' if !header.contains(',') => ' ',
        other => other,
    }
}

/// The cells of a line; any number of blanks separates as one.
fn split(line: &str, separator: char) -> Vec<Cell<'_>> {
    if separator != ' ' {
        return cells(line, separator);
    }
    let words = line.split_ascii_whitespace();
    words
        .map(|word| {
            let start = word.as_ptr() as usize - line.as_ptr() as usize;
            Cell {
                text: word.into(),
                span: start..start + word.len(),
            }
        })
        .collect()
}

/// What a row has, and its problems.
fn read_row(path: &str, line: &Line, separator: char, columns: &Columns) -> (Row, Vec<Problem>) {
    let found = split(&line.text, separator);
    let empty = |first: Meaning| vec![0.0; if columns.has(first) { columns.joints } else { 0 }];
    let mut row = Row {
        time: None,
        actual: empty(Meaning::Actual(0)),
        commanded: empty(Meaning::Commanded(0)),
        link: empty(Meaning::Link(0)),
        torque: empty(Meaning::Torque(0)),
        number: None,
    };
    if found.len() != columns.meanings.len() {
        let message = format!(
            "{} cells, but the table has {} columns",
            found.len(),
            columns.meanings.len()
        );
        let hint = "every row needs one cell per column";
        return (row, vec![line.problem(path, 0..line.text.len(), message, hint)]);
    }
    let mut problems = Vec::new();
    for (cell, meaning) in found.iter().zip(&columns.meanings) {
        let Some(meaning) = meaning else { continue };
        let value = number(&cell.text, separator);
        let Some(value) = value.filter(|value| value.abs() <= LARGEST) else {
            let message = format!("`{}` is not a finite number", cell.text);
            let hint = "remove rows that were not recorded completely";
            problems.push(line.problem(path, cell.span.clone(), message, hint));
            continue;
        };
        match meaning {
            Meaning::Time => row.time = Some((value, cell.span.clone())),
            Meaning::Actual(joint) => row.actual[*joint] = value,
            Meaning::Commanded(joint) => row.commanded[*joint] = value,
            Meaning::Link(joint) => row.link[*joint] = value,
            Meaning::Torque(joint) => row.torque[*joint] = value,
            Meaning::Move if value.fract() == 0.0 && value.abs() < 1e15 => row.number = Some(value as i64),
            Meaning::Move => {
                let message = format!("`{}` is not the number of a move", cell.text);
                let hint = "a whole number is required";
                problems.push(line.problem(path, cell.span.clone(), message, hint));
            }
        }
    }
    (row, problems)
}

#[cfg(test)]
mod tests;
