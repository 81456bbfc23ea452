//! The joint compliances that a study brings: its own numbers, or those of a class.
//!
//! | `[compliance]` | what the joints yield | assumed |
//! |---|---|---|
//! | `rad_per_n_m`, `u_rad_per_n_m`, `source` | these numbers, one a joint, base to flange | where `assumed = true` |
//! | `class` | mean and spread of published arms of that payload | always |
//! | left out | what the robot file says; a problem where it says nothing | - |

use armill_core::robot::{JointCompliance, Robot};

use super::format::{ComplianceTable, StudyFile};
use super::places::Places;
use crate::compliance_class::CLASSES;
use crate::error::StudyError;

/// No joint of an arm yields more, rad/(N m).
const MOST_COMPLIANT: f64 = 1.0;

/// What every result says of the compliances that a study brings.
#[derive(Clone, Debug)]
pub struct OwnCompliance {
    /// Where they come from.
    pub source: String,
    /// What to tell with every result, where they are assumed.
    pub caution: Option<String>,
}

impl OwnCompliance {
    /// Source and caution of `[compliance]`.
    ///
    /// # Errors
    /// A class whose robots do not read: a defect of the library.
    pub(super) fn of(table: &ComplianceTable) -> Result<OwnCompliance, StudyError> {
        let given = table.source.clone();
        Ok(match table.class {
            Some(class) => OwnCompliance {
                source: given.unwrap_or_else(|| class.source()),
                caution: Some(class.caution()?),
            },
            None => OwnCompliance {
                source: given.unwrap_or_default(),
                caution: (table.assumed == Some(true)).then(|| {
                    "The joint compliances are assumed, not measured: every deviation here is a guess of that quality.".to_owned()
                }),
            },
        })
    }
}

/// The compliances of `[compliance]` for `robot`, if there are any and they are sound; none are needed where the
/// robot has its own.
///
/// # Errors
/// A class whose robots do not read: a defect of the library.
pub(super) fn of_study(
    places: &mut Places<'_>,
    file: &StudyFile,
    robot: &Robot,
) -> Result<Option<Vec<JointCompliance>>, StudyError> {
    let Some(table) = &file.compliance else {
        if robot.compliance().is_none() {
            let message = format!("no joint compliance is known for robot `{}`", file.robot);
            let hint = format!(
                "two ways out: identify it from load tests (`armill identify`) and bring it as [compliance] rad_per_n_m = [...] (one a joint) with its source; or assume it: [compliance] class = \"...\", {CLASSES}, marked as assumed in every result"
            );
            places.problem("robot", message, &hint);
        }
        return Ok(None);
    };
    match (&table.rad_per_n_m, table.class) {
        (Some(values), None) => Ok(given(places, table, values, robot.joints().len())),
        (None, Some(class)) => {
            if table.u_rad_per_n_m.is_some() {
                let hint = "leave it out: the uncertainty of a class is its spread";
                places.problem(
                    "compliance.u_rad_per_n_m",
                    "a class has its own uncertainty",
                    hint,
                );
            }
            if table.assumed == Some(false) {
                let hint = "leave `assumed` out, or bring measured values with `rad_per_n_m`";
                places.problem("compliance.assumed", "values of a class are assumed", hint);
            }
            match class.compliance_of(robot) {
                Ok(joints) => Ok(Some(joints)),
                Err(StudyError::Value { message, hint }) => {
                    places.problem("compliance.class", message, &hint);
                    Ok(None)
                }
                Err(other) => Err(other),
            }
        }
        (Some(_), Some(_)) => {
            let hint = "keep `rad_per_n_m` if you know them, `class` if you do not";
            places.problem(
                "compliance.class",
                "both `rad_per_n_m` and `class` are given",
                hint,
            );
            Ok(None)
        }
        (None, None) => {
            let hint = format!("write rad_per_n_m = [...], one a joint, or class = \"...\"; {CLASSES}");
            places.problem("compliance", "neither `rad_per_n_m` nor `class` is given", &hint);
            Ok(None)
        }
    }
}

/// Compliances given one by one, checked.
///
/// `None` where something of them is wrong; an uncertainty that is left out is zero.
fn given(
    places: &mut Places<'_>,
    table: &ComplianceTable,
    values: &[f64],
    joints: usize,
) -> Option<Vec<JointCompliance>> {
    // All problems are told, so whether there are new ones decides at the end.
    let before = places.problems.len();
    if table.source.is_none() {
        let hint = "add source = \"...\": who measured them, or that they are a guess";
        places.problem("compliance", "compliances without `source`", hint);
    }
    let zeros = vec![0.0; joints];
    let uncertainties = table.u_rad_per_n_m.as_deref().unwrap_or(&zeros);
    for (key, list) in [("rad_per_n_m", values), ("u_rad_per_n_m", uncertainties)] {
        let path = format!("compliance.{key}");
        if list.len() != joints {
            let message = format!("{} values for the {joints} joints of the robot", list.len());
            places.problem(&path, message, "one a joint, base to flange; 0 for a rigid joint");
        }
        for (index, value) in list.iter().enumerate() {
            let (message, hint) = if *value < 0.0 {
                (
                    format!("{value} rad/(N m) is below 0"),
                    "a joint yields with its load: 0 or more",
                )
            } else if *value > MOST_COMPLIANT {
                (
                    format!("{value} rad/(N m) is above {MOST_COMPLIANT} rad/(N m)"),
                    "the joints of an arm yield some 1e-6 rad/(N m)",
                )
            } else {
                continue;
            };
            places.problem(&format!("{path}[{index}]"), message, hint);
        }
    }
    (places.problems.len() == before).then(|| {
        let both = values.iter().zip(uncertainties);
        both.map(|(value, u)| JointCompliance {
            value: *value,
            standard_uncertainty: *u,
        })
        .collect()
    })
}
