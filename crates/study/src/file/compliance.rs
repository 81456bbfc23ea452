//! The joint compliances given by a study: its own numbers, or those of a class.
//!
//! | `[compliance]` | compliance of the joints | assumed |
//! |---|---|---|
//! | `rad_per_n_m`, `u_rad_per_n_m`, `source` | these numbers, one for each joint, base to flange | if `assumed = true` |
//! | `class` | mean and spread of published arms of that payload | always |
//! | left out | those of the robot file; a problem if it has none | - |

use armill_core::robot::{JointCompliance, Robot};

use crate::compliance_class::CLASSES;
use crate::error::StudyError;
use crate::file::format::{ComplianceTable, StudyFile};
use crate::input::problem_log::ProblemLog;

/// Largest compliance of a joint of an arm, rad/(N m).
const MOST_COMPLIANT: f64 = 1.0;

/// The statement of every result on compliances given by a study.
#[derive(Clone, Debug)]
pub struct OwnCompliance {
    /// Source of the values.
    pub source: String,
    /// The warning of every result, if they are assumed.
    pub caution: Option<String>,
}

impl OwnCompliance {
    /// Source and caution of `[compliance]` for `robot`.
    ///
    /// # Errors
    /// A class that cannot be read: a defect of the library.
    pub(super) fn of(table: &ComplianceTable, robot: &Robot) -> Result<OwnCompliance, StudyError> {
        let given = table.source.clone();
        Ok(match table.class {
            Some(class) => OwnCompliance {
                source: given.unwrap_or_else(|| class.source()),
                caution: Some(class.caution(robot)?),
            },
            None => OwnCompliance {
                source: given.unwrap_or_default(),
                caution: (table.assumed == Some(true)).then(|| {
                    "The joint compliances are assumed, not measured: all deviations are estimates of that quality.".to_owned()
                }),
            },
        })
    }
}

/// The compliances of `[compliance]` for `robot`, if there are any and they are valid; none are required if the
/// robot has its own.
///
/// # Errors
/// A class that cannot be read: a defect of the library.
pub(super) fn of_study(
    log: &mut ProblemLog<'_>,
    file: &StudyFile,
    robot: &Robot,
) -> Result<Option<Vec<JointCompliance>>, StudyError> {
    let Some(table) = &file.compliance else {
        if robot.compliance().is_none() {
            let message = format!("no joint compliance is known for robot `{}`", file.robot);
            let hint = format!(
                "identify it from load tests (`armill identify`) and give it as [compliance] rad_per_n_m = [...] (one for each joint) with its source; or assume it: [compliance] class = \"...\", {CLASSES}, marked as assumed in every result"
            );
            log.problem("robot", message, &hint);
        }
        return Ok(None);
    };
    match (&table.rad_per_n_m, table.class) {
        (Some(values), None) => Ok(given(log, table, values, robot.joints().len())),
        (None, Some(class)) => {
            if table.u_rad_per_n_m.is_some() {
                let hint = "leave it out: the uncertainty of a class is its spread";
                log.problem(
                    "compliance.u_rad_per_n_m",
                    "a class has its own uncertainty",
                    hint,
                );
            }
            if table.assumed == Some(false) {
                let hint = "leave `assumed` out, or give measured values with `rad_per_n_m`";
                log.problem("compliance.assumed", "values of a class are assumed", hint);
            }
            match class.compliance_of(robot) {
                Ok(joints) => Ok(Some(joints)),
                Err(StudyError::Value { message, hint }) => {
                    log.problem("compliance.class", message, &hint);
                    Ok(None)
                }
                Err(other) => Err(other),
            }
        }
        (Some(_), Some(_)) => {
            let hint = "keep `rad_per_n_m` if you know them, `class` if you do not";
            log.problem(
                "compliance.class",
                "both `rad_per_n_m` and `class` are given",
                hint,
            );
            Ok(None)
        }
        (None, None) => {
            let hint =
                format!("write rad_per_n_m = [...], one for each joint, or class = \"...\"; {CLASSES}");
            log.problem("compliance", "neither `rad_per_n_m` nor `class` is given", &hint);
            Ok(None)
        }
    }
}

/// Compliances given one by one, checked.
///
/// `None` if something of them is wrong; an uncertainty that is left out is zero.
fn given(
    log: &mut ProblemLog<'_>,
    table: &ComplianceTable,
    values: &[f64],
    joints: usize,
) -> Option<Vec<JointCompliance>> {
    // All problems are reported, so whether there are new ones is evaluated at the end.
    let before = log.problems.len();
    if table.source.is_none() {
        let hint = "add source = \"...\": who measured them, or that they are assumed";
        log.problem("compliance", "compliances without `source`", hint);
    }
    let zeros = vec![0.0; joints];
    let uncertainties = table.u_rad_per_n_m.as_deref().unwrap_or(&zeros);
    for (key, list) in [("rad_per_n_m", values), ("u_rad_per_n_m", uncertainties)] {
        let path = format!("compliance.{key}");
        if list.len() != joints {
            let message = format!("{} values for the {joints} joints of the robot", list.len());
            log.problem(
                &path,
                message,
                "give one for each joint, base to flange; 0 for a rigid joint",
            );
        }
        for (index, value) in list.iter().enumerate() {
            let (message, hint) = if *value < 0.0 {
                (
                    format!("{value} rad/(N m) is below 0"),
                    "joint compliances must be 0 or more",
                )
            } else if *value > MOST_COMPLIANT {
                (
                    format!("{value} rad/(N m) is above {MOST_COMPLIANT} rad/(N m)"),
                    "typical joint compliances are around 1e-6 rad/(N m)",
                )
            } else {
                continue;
            };
            log.problem(&format!("{path}[{index}]"), message, hint);
        }
    }
    (log.problems.len() == before).then(|| {
        let both = values.iter().zip(uncertainties);
        both.map(|(value, u)| JointCompliance {
            value: *value,
            standard_uncertainty: *u,
        })
        .collect()
    })
}
