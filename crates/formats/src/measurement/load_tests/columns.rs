//! Meaning of each column in a table of load tests.
//!
//! Names and units: see `load_tests`. Names are not case-sensitive. The usual unit of each quantity comes first in the
//! lists below, so that a misspelled name gets it as a suggestion.

use armill_core::robot::Robot;

use super::sheet::Sheet;
use crate::document::Problem;
use crate::document::unit::suggestion;

/// The meaning of a column. Numbers are the axis or joint, then the factor to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Column {
    /// Name of the test.
    Name,
    /// Notes and expected values of a plan; ignored.
    ForPeople,
    /// Position of a joint.
    Joint(usize, f64),
    /// Force on the tool, base axes.
    Force(usize, f64),
    /// Moment about the force point, base axes, N m.
    Moment(usize),
    /// Displacement of the gauge point, base axes.
    Displacement(usize, f64),
    /// Its standard uncertainty.
    DisplacementU(f64),
    /// Force point, flange frame.
    ForcePoint(usize, f64),
    /// Gauge point, flange frame.
    GaugePoint(usize, f64),
    /// Name of the joint that rotated.
    TurnedJoint,
    /// Its rotation.
    Turn(f64),
    /// Its standard uncertainty.
    TurnU(f64),
    /// Number of ordinary tests that it is equivalent to.
    Weight,
}

/// The columns of a sheet; `None` where a name is unknown.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// One entry per name in the header.
    pub columns: Vec<Option<Column>>,
}

/// Units of length by the ending of a name, with their factor to m.
const LENGTHS: [(&str, f64); 3] = [("mm", 1e-3), ("um", 1e-6), ("m", 1.0)];
/// Units of forces, with their factor to N.
const FORCES: [(&str, f64); 2] = [("n", 1.0), ("kn", 1e3)];
/// One degree in rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// Units of joint positions, with their factor to rad.
const ANGLES: [(&str, f64); 2] = [("deg", DEGREE), ("rad", 1.0)];
/// Units of rotations, which are small, with their factor to rad.
const TURNS: [(&str, f64); 4] = [("urad", 1e-6), ("mrad", 1e-3), ("rad", 1.0), ("deg", DEGREE)];

/// All known names. The usual unit of each quantity comes first.
///
/// A joint is known by its own name and as `q1`, `q2`, ...; in degrees or radians if revolute, in lengths if prismatic.
fn known(robot: &Robot) -> Vec<(String, Column)> {
    let mut known = vec![
        ("test".to_owned(), Column::Name),
        ("note".to_owned(), Column::ForPeople),
        ("joint".to_owned(), Column::TurnedJoint),
        ("weight".to_owned(), Column::Weight),
    ];
    for (joint, described) in robot.joints().iter().enumerate() {
        let units: &[(&str, f64)] = if robot.slides(joint) { &LENGTHS } else { &ANGLES };
        for (unit, scale) in units {
            for name in [described.name.to_lowercase(), format!("q{}", joint + 1)] {
                known.push((format!("{name}_{unit}"), Column::Joint(joint, *scale)));
            }
        }
    }
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        known.push((format!("m{letter}_n_m"), Column::Moment(axis)));
        for (unit, scale) in FORCES {
            known.push((format!("f{letter}_{unit}"), Column::Force(axis, scale)));
        }
        for (unit, scale) in LENGTHS {
            known.push((format!("d{letter}_{unit}"), Column::Displacement(axis, scale)));
            known.push((format!("force_{letter}_{unit}"), Column::ForcePoint(axis, scale)));
            known.push((format!("gauge_{letter}_{unit}"), Column::GaugePoint(axis, scale)));
        }
    }
    for (unit, scale) in LENGTHS {
        known.push((format!("d_u_{unit}"), Column::DisplacementU(scale)));
    }
    for (unit, scale) in TURNS {
        known.push((format!("turn_{unit}"), Column::Turn(scale)));
        known.push((format!("turn_u_{unit}"), Column::TurnU(scale)));
    }
    known
}

impl Columns {
    /// The columns of `sheet`. Unknown, duplicate and missing columns are added to `problems`.
    ///
    /// Every problem is reported at the header: an unknown name with the nearest known one, a duplicate with the first.
    pub fn of(sheet: &Sheet, robot: &Robot, problems: &mut Vec<Problem>) -> Columns {
        let known = known(robot);
        let mut columns: Vec<Option<Column>> = Vec::new();
        let heads = sheet.heads();
        for cell in &heads {
            let name = cell.text.to_lowercase();
            let found = if name.starts_with("expected_") {
                Some(Column::ForPeople)
            } else {
                known
                    .iter()
                    .find(|(known, _)| *known == name)
                    .map(|(_, column)| *column)
            };
            if found.is_none() {
                let names: Vec<&str> = known.iter().map(|(known, _)| known.as_str()).collect();
                let hint = suggestion(&name, &names).map_or_else(
                    || {
                        "remove it, or name it `note`; the columns are listed in \
                        docs/guide/measure-stiffness.md"
                            .to_owned()
                    },
                    |(_, advice)| advice,
                );
                let message = format!("unknown column `{}`", cell.text);
                problems.push(sheet.problem(&sheet.header, cell, message, &hint));
            } else if let Some(first) =
                found.and_then(|column| columns.iter().position(|c| c.is_some_and(|c| c.same(column))))
            {
                let message = format!("`{}` repeats `{}`", cell.text, heads[first].text);
                problems.push(sheet.problem(&sheet.header, cell, message, "remove one of the two columns"));
            }
            columns.push(found);
        }
        let columns = Columns { columns };
        for (missing, hint) in columns.missing(robot) {
            let message = format!("missing {missing}");
            problems.push(sheet.problem_of_line(&sheet.header, message, &hint));
        }
        columns
    }

    /// Whether a column is of this kind.
    fn has(&self, requested: impl Fn(Column) -> bool) -> bool {
        self.columns.iter().flatten().any(|column| requested(*column))
    }

    /// Missing columns, and hints.
    ///
    /// A table needs every joint, a force or moment, and a displacement or rotation; a rotation needs its joint.
    fn missing(&self, robot: &Robot) -> Vec<(String, String)> {
        let mut missing = Vec::new();
        let without: Vec<String> = robot
            .joints()
            .iter()
            .enumerate()
            .filter(|(joint, _)| !self.has(|column| matches!(column, Column::Joint(j, _) if j == *joint)))
            .map(|(joint, described)| {
                let unit = if robot.slides(joint) { "mm" } else { "deg" };
                format!("`{}_{unit}`", described.name)
            })
            .collect();
        if !without.is_empty() {
            let hint = "every test needs all joint positions: one column per joint, in degrees (`_deg`) or radians \
                (`_rad`)";
            missing.push((
                format!("joint positions: {}", without.join(", ")),
                hint.to_owned(),
            ));
        }
        if !self.has(|column| matches!(column, Column::Force(..) | Column::Moment(_))) {
            let hint = "add the load on the tool in base axes: `fx_n`, `fy_n`, `fz_n`; a weight of 10 kg is fz_n = \
                -98.1";
            missing.push(("forces".to_owned(), hint.to_owned()));
        }
        let turned = [
            self.has(|c| c == Column::TurnedJoint),
            self.has(|c| matches!(c, Column::Turn(_))),
        ];
        if turned[0] != turned[1] {
            let name = if turned[0] { "`turn_urad`" } else { "`joint`" };
            missing.push((
                name.to_owned(),
                "a rotation and its joint must be given together".to_owned(),
            ));
        }
        if !self.has(|column| matches!(column, Column::Displacement(..) | Column::Turn(_))) {
            let hint =
                "add the measured values: `dx_mm`, `dy_mm`, `dz_mm` in base axes, or `joint` and `turn_urad`";
            missing.push(("readings".to_owned(), hint.to_owned()));
        }
        missing
    }
}

impl Column {
    /// Whether both columns have the same quantity, in any unit.
    fn same(self, other: Column) -> bool {
        use Column::{
            Displacement, DisplacementU, ForPeople, Force, ForcePoint, GaugePoint, Joint, Turn, TurnU,
        };
        match (self, other) {
            (ForPeople, ForPeople) => false,
            (Joint(a, _), Joint(b, _))
            | (Force(a, _), Force(b, _))
            | (Displacement(a, _), Displacement(b, _))
            | (ForcePoint(a, _), ForcePoint(b, _))
            | (GaugePoint(a, _), GaugePoint(b, _)) => a == b,
            (DisplacementU(_), DisplacementU(_)) | (Turn(_), Turn(_)) | (TurnU(_), TurnU(_)) => true,
            (a, b) => a == b,
        }
    }
}
