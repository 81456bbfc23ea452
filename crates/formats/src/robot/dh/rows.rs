//! The rows of a table in SI, each column with the unit of its name.
//!
//! | column | unit in its name | needed |
//! |---|---|---|
//! | `a`, `d` | `_mm`, `_m` | yes |
//! | `alpha`, `theta` | `_deg`, `_rad` | yes |
//! | `beta` | `_deg`, `_rad` | in the convention `hayati`, and only there |
//! | `lower`, `upper` | any of the four, as the joint moves; empty: no limit | both or none |
//! | `joint`, `type`, `sign` | - | no: `joint_1`, ...; revolute; 1 |
//!
//! Capitals do not count. Lengths up to 1000 m, angles up to two turns: more is a number under the wrong unit.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use armill_core::robot::chain::LONGEST;
use armill_core::robot::joint::Sign;
use armill_core::units::{from_deg, from_mm};

use super::super::{MOST_JOINTS, TWO_TURNS};
use super::table::{Cell, Convention, Table};
use crate::document::{Problems, Source};

/// Which part of a row a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moves {
    /// theta.
    Turns,
    /// d.
    Slides,
    /// Nothing.
    Not,
}

/// One row; m and rad.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Name of the joint.
    pub joint: String,
    /// Of a joint that turns `theta` is the value at the controller's zero, of one that slides `d`.
    pub moves: Moves,
    pub a: f64,
    pub alpha: f64,
    /// 0 but in the convention `hayati`.
    pub beta: f64,
    pub d: f64,
    pub theta: f64,
    /// Counting direction of the controller.
    pub sign: Sign,
    /// Lower and upper, in the controller's counting.
    pub limits: Option<[f64; 2]>,
}

/// What a column measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// mm or m.
    Length,
    /// deg or rad.
    Angle,
    /// That of the joint.
    OfJoint,
}

/// What a column contains.
const QUANTITIES: [(&str, Kind); 7] = [
    ("a", Kind::Length),
    ("alpha", Kind::Angle),
    ("beta", Kind::Angle),
    ("d", Kind::Length),
    ("theta", Kind::Angle),
    ("lower", Kind::OfJoint),
    ("upper", Kind::OfJoint),
];
/// Columns of text.
const WORDS: [&str; 3] = ["joint", "type", "sign"];

/// A unit by its ending, with the kind that it measures.
const UNITS: [(&str, Kind); 4] = [
    ("_mm", Kind::Length),
    ("_m", Kind::Length),
    ("_deg", Kind::Angle),
    ("_rad", Kind::Angle),
];

/// Rows of a table, fixed ones included.
const MOST_ROWS: usize = MOST_JOINTS;

/// What an unknown column might have been.
const COLUMNS: &str = "columns: a_mm, alpha_deg, d_mm, theta_deg (or _m, _rad); optional: joint, type, sign, lower_deg, upper_deg";

/// The rows of the table.
///
/// # Errors
/// Every column that is unknown, missing or without unit; then every cell that contains something else.
pub(super) fn read(file: &Source, table: &Table) -> Result<Vec<Row>, Problems> {
    let mut problems = Vec::new();
    let mut seen = BTreeSet::new();
    for cell in &table.header {
        let name = cell.text.to_lowercase();
        if let Some((message, hint)) = column_problem(&name) {
            problems.push(file.problem(cell.place.clone(), message, Some(hint)));
        }
        if !seen.insert(quantity(&name).to_owned()) {
            let message = format!("two columns contain `{}`", quantity(&name));
            problems.push(file.problem(cell.place.clone(), message, None));
        }
    }
    let hayati = table.convention == Convention::Hayati;
    if let Some(cell) = table
        .header
        .iter()
        .find(|cell| !hayati && quantity(&cell.text.to_lowercase()) == "beta")
    {
        let hint = "only rows of `convention = hayati` end with Ry(beta)".to_owned();
        problems.push(file.problem(
            cell.place.clone(),
            "a column `beta` in another convention",
            Some(hint),
        ));
    }
    let needed = ["a", "alpha", "d", "theta"]
        .into_iter()
        .chain(hayati.then_some("beta"));
    for needed in needed {
        if !seen.contains(needed) {
            let place = table.header.first().map_or(0..0, |cell| cell.place.clone());
            let message = format!("no column contains `{needed}`");
            problems.push(file.problem(place, message, Some(COLUMNS.to_owned())));
        }
    }
    Problems::from(problems).into_result()?;

    if let Some(row) = table.rows.get(MOST_ROWS) {
        let place = row.first().map_or(0..0, |cell| cell.place.clone());
        let message = format!("the table has more than {MOST_ROWS} rows");
        return Err(file.problem(place, message, None).into());
    }
    let mut problems = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    for (index, cells) in table.rows.iter().enumerate() {
        let reader = RowReader { file, table, cells };
        match reader.row(index) {
            Ok(row)
                if rows.iter().any(|other| {
                    other.moves != Moves::Not && other.joint == row.joint && row.moves != Moves::Not
                }) =>
            {
                let place = cells.first().map_or(0..0, |cell| cell.place.clone());
                problems.push(file.problem(place, format!("another joint is called `{}`", row.joint), None));
            }
            Ok(row) => rows.push(row),
            Err(found) => problems.extend(found),
        }
    }
    Problems::from(problems).into_result().map(|()| rows)
}

/// The name of a column without its unit.
fn quantity(name: &str) -> &str {
    UNITS
        .iter()
        .find_map(|(unit, _)| name.strip_suffix(unit))
        .unwrap_or(name)
}

/// What is wrong with the name of a column, and a hint.
fn column_problem(name: &str) -> Option<(String, String)> {
    if WORDS.contains(&name) {
        return None;
    }
    let bare = quantity(name);
    let Some((_, kind)) = QUANTITIES.iter().find(|(known, _)| *known == bare) else {
        return Some((format!("unknown column `{name}`"), COLUMNS.to_owned()));
    };
    let fitting: Vec<String> = UNITS
        .iter()
        .filter(|(_, of)| *kind == Kind::OfJoint || of == kind)
        .map(|(unit, _)| format!("{bare}{unit}"))
        .collect();
    let hint = format!("write one of {}", fitting.join(", "));
    if bare == name {
        return Some((format!("column `{name}` names no unit"), hint));
    }
    let fits = fitting.iter().any(|known| known == name);
    (!fits).then(|| {
        (
            format!("column `{name}` has a unit that does not fit `{bare}`"),
            hint,
        )
    })
}

/// Reads one row of a table.
struct RowReader<'a> {
    file: &'a Source,
    table: &'a Table,
    cells: &'a [Cell],
}

impl RowReader<'_> {
    /// The row, which is the one with this index from 0: a joint without name is called by it.
    ///
    /// Of a row that is fixed the columns of the joint are not looked at.
    ///
    /// # Errors
    /// The first word or limit that is wrong, else all numbers that are.
    fn row(&self, index: usize) -> Result<Row, Problems> {
        let moves = match self
            .cell("type")
            .map(|(_, cell)| (cell, cell.text.to_lowercase()))
        {
            None => Moves::Turns,
            Some((cell, word)) => match word.as_str() {
                "r" | "revolute" => Moves::Turns,
                "p" | "prismatic" => Moves::Slides,
                "f" | "fixed" => Moves::Not,
                _ => return Err(self.refused(cell, "is not revolute, prismatic or fixed")),
            },
        };
        let sign = match self.cell("sign") {
            Some((_, cell)) if moves != Moves::Not => match cell.text.as_str() {
                "1" | "+1" => Sign::Positive,
                "-1" => Sign::Negative,
                _ => return Err(self.refused(cell, "is not 1 or -1")),
            },
            _ => Sign::Positive,
        };
        let joint = match self.cell("joint") {
            Some((_, cell)) if moves != Moves::Not && cell.text.is_empty() => {
                return Err(self.refused(cell, "is not a valid joint name"));
            }
            Some((_, cell)) => cell.text.clone(),
            None => format!("joint_{}", index + 1),
        };
        let limits = match (self.limit("lower", moves)?, self.limit("upper", moves)?) {
            (Some((lower, _)), Some((upper, _))) if lower < upper => Some([lower, upper]),
            (Some(_), Some((_, cell))) => {
                return Err(self.refused(cell, "is an upper limit not above the lower one"));
            }
            (Some((_, cell)), None) => {
                return Err(self.refused(cell, "is a lower limit without an upper one"));
            }
            (None, Some((_, cell))) => {
                return Err(self.refused(cell, "is an upper limit without a lower one"));
            }
            (None, None) => None,
        };
        let values = ["a", "alpha", "beta", "d", "theta"].map(|of| self.value(of));
        match values {
            [Ok(a), Ok(alpha), Ok(beta), Ok(d), Ok(theta)] => Ok(Row {
                joint,
                moves,
                a,
                alpha,
                beta,
                d,
                theta,
                sign,
                limits,
            }),
            values => {
                let refused = values.into_iter().filter_map(Result::err);
                Err(refused.flatten().collect())
            }
        }
    }

    /// The cell below the column of `quantity`, with the column's name.
    fn cell(&self, of: &str) -> Option<(&Cell, &Cell)> {
        let names = self.table.header.iter();
        names
            .zip(self.cells)
            .find(|(name, _)| quantity(&name.text.to_lowercase()) == of)
    }

    /// The number below the column of a quantity, in SI; zero where there is no such column.
    ///
    /// # Errors
    /// As of [`Self::si`]; an angle beyond a turn, which no robot file may contain.
    fn value(&self, of: &str) -> Result<f64, Problems> {
        let Some((name, cell)) = self.cell(of) else {
            return Ok(0.0);
        };
        let si = self.si(name, cell)?;
        if !name.text.to_lowercase().ends_with('m') && si.abs() > TAU {
            return Err(self.refused(cell, "is an angle beyond a turn"));
        }
        Ok(si)
    }

    /// A limit in SI; `None` where the column or the cell is empty.
    ///
    /// # Errors
    /// An angle for a joint that slides, a length for one that turns, a cell that contains no number.
    fn limit(&self, of: &str, moves: Moves) -> Result<Option<(f64, &Cell)>, Problems> {
        let Some((name, cell)) = self.cell(of).filter(|(_, cell)| !cell.text.is_empty()) else {
            return Ok(None);
        };
        let length = name.text.to_lowercase().ends_with('m');
        match moves {
            Moves::Not => Ok(None),
            Moves::Slides if !length => {
                Err(self.refused(cell, "is an angle, but the joint slides: leave it empty"))
            }
            Moves::Turns if length => {
                Err(self.refused(cell, "is a length, but the joint turns: leave it empty"))
            }
            _ => Ok(Some((self.si(name, cell)?, cell))),
        }
    }

    /// The number in a cell, m or rad by the unit in the column's name.
    ///
    /// # Errors
    /// No finite number, an angle beyond two turns, a length beyond 1000 m.
    fn si(&self, name: &Cell, cell: &Cell) -> Result<f64, Problems> {
        let text = match self.table.decimal_comma {
            true => cell.text.replace(',', "."),
            false => cell.text.clone(),
        };
        let Some(value) = text.parse::<f64>().ok().filter(|value| value.is_finite()) else {
            return Err(self.refused(cell, "is not a number"));
        };
        let name = name.text.to_lowercase();
        let si = match UNITS.iter().find(|(unit, _)| name.ends_with(unit)) {
            Some(("_mm", _)) => from_mm(value),
            Some(("_deg", _)) => from_deg(value),
            _ => value,
        };
        let angle = name.ends_with("deg") || name.ends_with("rad");
        match si.abs() <= if angle { TWO_TURNS } else { LONGEST } {
            true => Ok(si),
            false if angle => Err(self.refused(cell, "is an angle beyond two turns")),
            false => Err(self.refused(cell, "is beyond 1000 m")),
        }
    }

    /// The problem that a cell `what`.
    fn refused(&self, cell: &Cell, what: &str) -> Problems {
        self.file
            .problem(cell.place.clone(), format!("`{}` {what}", cell.text), None)
            .into()
    }
}
