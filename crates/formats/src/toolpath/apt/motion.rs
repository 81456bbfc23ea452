//! GOTO and CIRCLE as lines and arcs.
//!
//! An arc is right-handed about its axis `n`, from the position of the tip (`a` from the centre, across the axis)
//! to the next GOTO (`b`): `sweep = atan2(n . (a x b), a . b)`, between 0 and a full turn; where both are in the same
//! direction from the centre it is a full turn.

use std::f64::consts::TAU;

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::{Arc, Course, Move, Pace};
use armill_core::units::{to_deg, to_mm};

use super::modal::Interpreter;
use super::options::Dialect;
use super::settings::{Circle, Feed};
use super::statement::Statement;
use crate::toolpath::direction::direction;

/// Points no farther apart are the same, m: programs write six decimals of mm, old ones four.
const SAME_POINT: f64 = 1e-7;
/// The radii at both ends of an arc differ by no more than this part of them, and this many metres: what coarse
/// rounding of the centre gives, and far below any radius that was mistaken.
const RADIUS_SLACK: [f64; 2] = [1e-3, 1e-5];
/// A helix ends at the angle that its number of turns says, within this, rad.
const TURN_SLACK: f64 = 1e-3;
/// No helix has more turns.
const MOST_TURNS: f64 = 10_000.0;

/// A tool axis, where one is written.
type WrittenAxis = Option<Unit<Vector3<f64>>>;

impl Interpreter<'_> {
    /// GOTO, FROM and GOHOME; the latter two in rapid.
    ///
    /// Within a cycle it is a hole. A point that is refused gives no move, and what follows is still looked at.
    pub fn goto(&mut self, statement: &Statement) {
        let rapid = std::mem::take(&mut self.rapid) || statement.word != "GOTO";
        let circle = self.circle.take();
        self.points += 1;
        let Some((end, given)) = self.point_and_axis(statement) else {
            return;
        };
        let axis = self.axis_of(statement, given);
        if let Some(cycle) = self.cycle.clone() {
            if rapid || circle.is_some() {
                let message = "RAPID or CIRCLE within a drilling cycle: not known whether this is a hole";
                self.report(
                    statement,
                    statement.word_span(),
                    message,
                    "end the cycle before it with `CYCLE/OFF`",
                );
                return;
            }
            return self.hole(statement, &cycle, end, axis);
        }
        let course = match circle {
            None => Course::Line,
            Some(circle) => match self.arc(statement, &circle, end) {
                Some(arc) => Course::Arc(arc),
                None => {
                    self.at = Some(end);
                    return;
                }
            },
        };
        let pace = match rapid {
            true => Pace::Rapid,
            false => self.pace(statement),
        };
        let line = statement.line();
        self.give(
            statement,
            Move {
                end,
                axis,
                spin: None,
                course,
                pace,
                line,
            },
        );
    }

    /// CIRCLE: three numbers of the centre, three of the axis; NX adds the radius, two tolerances, diameter and corner
    /// of the tool, and for a helix `TIMES,n`.
    ///
    /// A CIRCLE before it that no GOTO has ended is a problem.
    pub fn circle(&mut self, statement: &Statement) {
        let without_end = statement.problem(
            self.name,
            statement.word_span(),
            "no GOTO ends this CIRCLE",
            "the next GOTO is the end of the arc",
        );
        if let Some(before) = self.circle.take() {
            self.problems.push(before.without_end);
        }
        let names: Vec<String> = statement
            .parameters()
            .map(|parameter| parameter.text.to_uppercase())
            .collect();
        let numbered = names
            .iter()
            .position(|name| name == "TIMES")
            .unwrap_or(names.len());
        let before = self.problems.len();
        let mut numbers = Vec::new();
        for (index, parameter) in statement.parameters().enumerate() {
            if index != numbered {
                numbers.extend(self.number(statement, &parameter));
            }
        }
        if self.problems.len() > before {
            return;
        }
        let after = names.len().saturating_sub(numbered + 1);
        let ([x, y, z, i, j, k, rest @ ..], true) = (
            numbers.as_slice(),
            matches!(numbered, 6 | 7 | 11) && after == usize::from(numbered < names.len()),
        ) else {
            let message = format!("a CIRCLE has {} parameters", names.len());
            let hint = "write centre and axis: `CIRCLE/x,y,z,i,j,k`; or centre, axis, radius, two tolerances, \
                diameter and corner of the tool, for a helix followed by `TIMES,n`";
            self.report(statement, statement.parameters_span(), message, hint);
            return;
        };
        let metres = self.metres(statement);
        let Some(axis) = self.direction(statement, [*i, *j, *k]) else {
            return;
        };
        let turns = (after == 1).then(|| rest.last().copied()).flatten();
        if let Some(turns) = turns.filter(|turns| !(*turns > 0.0 && *turns <= MOST_TURNS)) {
            let message = format!("a helix of {turns} turns is not between 0 and {MOST_TURNS}");
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "TIMES is followed by the number of turns",
            );
            return;
        }
        self.circle = Some(Circle {
            centre: self.path_from_here * (Point3::new(*x, *y, *z) * metres),
            axis,
            radius: (numbered > 6)
                .then(|| rest.first().map(|radius| radius.abs() * metres))
                .flatten(),
            turns,
            without_end,
        });
    }

    /// Speed of a GOTO that is not rapid.
    ///
    /// Feed a turn is taken with the spindle as it turns here; without one it is a problem.
    pub fn pace(&mut self, statement: &Statement) -> Pace {
        match self.feed {
            None => Pace::Unknown,
            Some(Feed::Speed(speed)) => Pace::Feed(speed),
            Some(Feed::PerTurn(length)) => match self.operation.spindle.filter(|speed| *speed != 0.0) {
                Some(speed) => Pace::Feed(length * speed.abs() / TAU),
                None => {
                    // Reported once for each FEDRAT.
                    self.feed = None;
                    let message = "the feed is per revolution, but the spindle does not turn here";
                    let hint = "add a `SPINDL/n,RPM,CLW` before it";
                    self.report(statement, statement.word_span(), message, hint);
                    Pace::Unknown
                }
            },
        }
    }

    /// The point of a GOTO in the frame of the path, m, and the axis it writes.
    ///
    /// Refused are other counts than three and six, and a direction that has not length 1.
    fn point_and_axis(&mut self, statement: &Statement) -> Option<(Point3<f64>, WrittenAxis)> {
        let numbers = self.numbers(statement)?;
        let (point, axis) = match numbers.as_slice() {
            [x, y, z] => ([*x, *y, *z], None),
            [x, y, z, i, j, k] => ([*x, *y, *z], Some(self.direction(statement, [*i, *j, *k])?)),
            _ => {
                let message = format!("a {} has {} numbers", statement.word, numbers.len());
                let hint = "write three numbers for the point, or six with the tool axis";
                self.report(statement, statement.parameters_span(), message, hint);
                return None;
            }
        };
        let metres = self.metres(statement);
        Some((self.path_from_here * (Point3::from(point) * metres), axis))
    }

    /// The tool axis at a point with this written axis, according to the dialect.
    ///
    /// Where the dialect is not known, leaving out an axis that was written before is a problem: each means another.
    fn axis_of(&mut self, statement: &Statement, given: WrittenAxis) -> Option<Unit<Vector3<f64>>> {
        match (given, self.dialect) {
            (Some(axis), _) => self.axis = Some(axis),
            (None, Some(Dialect::Nx)) => {}
            (None, Some(Dialect::SolidWorks)) => self.axis = Some(Vector3::z_axis()),
            (None, None) if self.axis.is_some() => {
                let message = "no tool axis here, but one before: ambiguous between the same axis and 0,0,1";
                let hint = "dialect = \"nx\" keeps the axis, dialect = \"solidworks\" uses 0,0,1";
                self.report(statement, statement.parameters_span(), message, hint);
                self.axis = None;
            }
            (None, None) => {}
        }
        self.axis
    }

    /// A direction of length 1, in the frame of the path.
    fn direction(&mut self, statement: &Statement, ijk: [f64; 3]) -> Option<Unit<Vector3<f64>>> {
        match direction(ijk) {
            Ok(direction) => Some(self.path_from_here * direction),
            Err(length) => {
                let [i, j, k] = ijk;
                let message = format!("the direction {i},{j},{k} has a length of {length:.4}, not 1");
                let hint = "write the point first, then a direction of length 1";
                self.report(statement, statement.parameters_span(), message, hint);
                None
            }
        }
    }

    /// The arc from the position of the tip to `end`.
    ///
    /// Refused are an arc from nowhere, ends and written radius that differ by more than [`RADIUS_SLACK`], and a helix
    /// whose turns do not end where it ends. What a helix climbs is the distance of both ends along its axis.
    fn arc(&mut self, statement: &Statement, circle: &Circle, end: Point3<f64>) -> Option<Arc> {
        let Some(from) = self.at else {
            let message = "an arc without a start: no GOTO before it gives the position of the tip";
            self.report(statement, statement.word_span(), message, "begin with a GOTO");
            return None;
        };
        let across = |point: Point3<f64>| {
            let out = point - circle.centre;
            out - circle.axis.into_inner() * out.dot(&circle.axis)
        };
        let (a, b) = (across(from), across(end));
        let radii = [Some(a.norm()), Some(b.norm()), circle.radius];
        let [least, most] = radii
            .into_iter()
            .flatten()
            .fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], radius| {
                [least.min(radius), most.max(radius)]
            });
        if most - least > RADIUS_SLACK[0] * most + RADIUS_SLACK[1] || least <= SAME_POINT {
            let written = circle.radius.map_or_else(String::new, |radius| {
                format!(", and {:.4} mm is written", to_mm(radius))
            });
            let message = format!(
                "this arc begins {:.4} mm from its centre and ends {:.4} mm from it{written}",
                to_mm(a.norm()),
                to_mm(b.norm())
            );
            let hint = "the CIRCLE before gives the centre; both ends must be on the circle";
            self.report(statement, statement.parameters_span(), message, hint);
            return None;
        }
        let turned = circle.axis.dot(&a.cross(&b)).atan2(a.dot(&b));
        // Along the circle, for radii may differ by what rounding gives.
        let ends_where_it_began = turned.abs() * most <= SAME_POINT;
        let angle = match ends_where_it_began {
            true => TAU,
            false => turned.rem_euclid(TAU),
        };
        let sweep = match circle.turns {
            None => angle,
            Some(turns) => {
                let sweep = turns * TAU;
                let apart = (sweep - angle).rem_euclid(TAU);
                if apart.min(TAU - apart) > TURN_SLACK {
                    let message = format!(
                        "a helix of {turns} turns that ends {:.3} deg from where it begins",
                        to_deg(angle)
                    );
                    let hint = "it is ambiguous whether the part of a turn is additional: write the helix as full \
                        turns, or as lines";
                    self.report(statement, statement.parameters_span(), message, hint);
                    return None;
                }
                sweep
            }
        };
        Some(Arc {
            centre: circle.centre,
            axis: circle.axis,
            sweep,
        })
    }
}
