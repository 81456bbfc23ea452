//! Units that neither header nor options give, from the values, and the log in SI.
//!
//! | quantity | concluded |
//! |---|---|
//! | time | the unit in which the usual step is from 1 ms to 100 ms; the units differ by 1000, so that there is one at most |
//! | position | degrees, where a position in rad would be more than two turns; otherwise it is refused |

use std::f64::consts::TAU;

use armill_core::units::from_deg;

use super::columns::Columns;
use super::log::{JointLog, LogReadOptions};
use super::unit::{AngleUnit, TimeUnit};
use crate::document::Problems;
use crate::document::lines::Line;

/// Usual steps of logs, s.
const STEPS: [f64; 2] = [1e-3, 0.1];
/// No joint of a log in rad is beyond this, rad.
const FARTHEST_RAD: f64 = 2.0 * TAU;
/// No joint is beyond this, rad.
const FARTHEST: f64 = 200.0;
/// Longest log, s.
const LONGEST: f64 = 1e6;

/// Converts a log in the units of its file to s from its first instant, and rad.
///
/// # Errors
/// A unit that is not given and cannot be concluded; times or positions out of range.
pub(super) fn convert(
    path: &str,
    header: &Line,
    columns: &Columns,
    given: LogReadOptions,
    log: &mut JointLog,
) -> Result<(), Problems> {
    let refuse = |message: String, hint: &str| header.problem(path, 0..header.text.len(), message, hint);
    let mut problems = Vec::new();
    let time = columns
        .time
        .or(given.time)
        .or_else(|| concluded_time(log))
        .ok_or_else(|| {
            refuse(
                format!(
                    "no unit of time is given, and a step of {} fits none",
                    log.usual_step()
                ),
                "name the column `time_s`, `time_ms`, `time_us` or `time_ns`, or give the option --time-unit",
            )
        });
    let largest = (log
        .positions
        .iter()
        .chain(log.commanded.iter().flatten())
        .chain(log.link.iter().flatten()))
    .fold(0.0, |most: f64, value| most.max(value.abs()));
    let angle = columns
        .angle
        .or(given.angle)
        .or_else(|| concluded_angle(largest, log))
        .ok_or_else(|| {
            refuse(
                format!("no unit of the joint positions is given, and {largest} may be degrees or rad"),
                "name the columns `J1_deg` or `J1_rad`, or give the option --angle-unit",
            )
        });
    match (time, angle) {
        (Ok(time), Ok(angle)) => {
            let first = log.times[0];
            for at in &mut log.times {
                *at = (*at - first) * time.factor();
            }
            let to_rad = |value: &mut f64| {
                if angle == AngleUnit::Degree {
                    *value = from_deg(*value);
                }
            };
            log.positions.iter_mut().for_each(to_rad);
            log.commanded.iter_mut().flatten().for_each(to_rad);
            log.link.iter_mut().flatten().for_each(to_rad);
            let duration = log.times[log.times.len() - 1];
            if duration > LONGEST {
                problems.push(refuse(
                    format!("a log of {duration:.3e} s exceeds {LONGEST} s"),
                    "is the unit of time right?",
                ));
            }
            let most = match angle {
                AngleUnit::Degree => from_deg(largest),
                AngleUnit::Radian => largest,
            };
            if most > FARTHEST {
                problems.push(refuse(
                    format!("a joint position of {most:.3e} rad exceeds {FARTHEST} rad"),
                    "is the unit of the joint positions right?",
                ));
            }
        }
        (time, angle) => {
            problems.extend(time.err());
            problems.extend(angle.err());
        }
    }
    Problems::from(problems).into_result()
}

fn concluded_time(log: &mut JointLog) -> Option<TimeUnit> {
    let step = log.usual_step();
    let fits = |unit: &TimeUnit| (STEPS[0]..STEPS[1]).contains(&(step * unit.factor()));
    let unit = TimeUnit::ALL.into_iter().find(fits)?;
    log.notes.push(format!(
        "no unit of time is given: {}, as the usual step fits no other (otherwise give --time-unit)",
        unit.symbol()
    ));
    Some(unit)
}

fn concluded_angle(largest: f64, log: &mut JointLog) -> Option<AngleUnit> {
    (largest > FARTHEST_RAD).then(|| {
        let note = "no unit of the joint positions is given: degrees, as in rad a joint would make more than two turns (otherwise give --angle-unit)";
        log.notes.push(note.to_owned());
        AngleUnit::Degree
    })
}
