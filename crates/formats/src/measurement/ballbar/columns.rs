//! Meaning of each column in a table of radii.
//!
//! Names and units: see [`super::csv`]. Names are not case-sensitive.

use crate::document::Problem;
use crate::document::lines::Line;
use crate::document::unit::suggestion;
use crate::table::sheet::cells;

/// The meaning of a column, with the factor to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Column {
    /// Angle of the sample.
    Angle(f64),
    /// Number of the sample, instead of its angle.
    Index,
    /// Radius minus the nominal radius.
    Deviation(f64),
    /// Radius.
    Radius(f64),
    /// Direction.
    Direction,
    /// Name of the run.
    Run,
    /// Notes; ignored.
    ForPeople,
}

/// All known names. The usual unit of each quantity comes first.
const KNOWN: [(&str, Column); 12] = [
    ("angle_deg", Column::Angle(std::f64::consts::PI / 180.0)),
    ("angle_rad", Column::Angle(1.0)),
    ("index", Column::Index),
    ("radius_dev_um", Column::Deviation(1e-6)),
    ("radius_dev_mm", Column::Deviation(1e-3)),
    ("radius_dev_m", Column::Deviation(1.0)),
    ("radius_mm", Column::Radius(1e-3)),
    ("radius_um", Column::Radius(1e-6)),
    ("radius_m", Column::Radius(1.0)),
    ("direction", Column::Direction),
    ("run", Column::Run),
    ("note", Column::ForPeople),
];

/// The columns of a table.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// One entry per name in the header; `None` is ignored.
    pub columns: Vec<Option<Column>>,
    /// Names of ignored columns.
    pub unused: Vec<String>,
}

impl Columns {
    /// Whether a column satisfies `of`.
    pub fn have(&self, of: impl Fn(Column) -> bool) -> bool {
        self.columns.iter().flatten().any(|column| of(*column))
    }

    /// The columns of a header line in the file `path`.
    ///
    /// # Errors
    /// Duplicate columns; no angle; no radius. A name that resembles a missing column is reported at its position.
    pub fn of(path: &str, header: &Line, separator: char) -> Result<Columns, Vec<Problem>> {
        let heads = cells(&header.text, separator);
        let known = |name: &str| {
            let name = name.to_lowercase();
            KNOWN
                .iter()
                .find(|(known, _)| *known == name)
                .map(|(_, column)| *column)
        };
        let columns: Vec<Option<Column>> = heads.iter().map(|cell| known(&cell.text)).collect();
        let mut problems = Vec::new();
        for (at, cell) in heads.iter().enumerate() {
            let before = columns[..at].iter().flatten();
            if columns[at].is_some_and(|column| before.clone().any(|other| same(*other, column))) {
                let message = format!("`{}` repeats an earlier column", cell.text);
                problems.push(header.problem(
                    path,
                    cell.span.clone(),
                    message,
                    "remove one of the two columns",
                ));
            }
        }
        let found = Columns {
            unused: (heads.iter().zip(&columns))
                .filter(|(_, column)| column.is_none())
                .map(|(cell, _)| cell.text.clone().into_owned())
                .collect(),
            columns,
        };
        let angle = found.have(|column| matches!(column, Column::Angle(_) | Column::Index));
        let radius = found.have(|column| matches!(column, Column::Deviation(_) | Column::Radius(_)));
        let whole = 0..header.text.len();
        for (there, what, usual) in [
            (angle, "no column gives the angle", "angle_deg"),
            (radius, "no column gives the radius", "radius_dev_um"),
        ] {
            if there {
                continue;
            }
            let near = heads.iter().zip(&found.columns).find_map(|(cell, column)| {
                let of_it: Vec<&str> = KNOWN
                    .iter()
                    .map(|(name, _)| *name)
                    .filter(|name| name.starts_with(&usual[..5]))
                    .collect();
                let (_, advice) = suggestion(&cell.text, &of_it).filter(|_| column.is_none())?;
                Some((cell.span.clone(), advice))
            });
            let (span, hint) = near.unwrap_or_else(|| (whole.clone(), HEADER_HINT.to_owned()));
            problems.push(header.problem(path, span, what, &hint));
        }
        if problems.is_empty() {
            Ok(found)
        } else {
            Err(problems)
        }
    }
}

/// Whether two columns have the same quantity, in any unit.
fn same(one: Column, other: Column) -> bool {
    let angle = |column| matches!(column, Column::Angle(_) | Column::Index);
    let radius = |column| matches!(column, Column::Deviation(_) | Column::Radius(_));
    (angle(one) && angle(other))
        || (radius(one) && radius(other))
        || (one == other && one != Column::ForPeople)
}

/// Form of the header.
pub(super) const HEADER_HINT: &str = "the first line names the columns with their units, such as \
                                      `angle_deg,radius_dev_um,direction,run`; see docs/guide/ballbar.md";
