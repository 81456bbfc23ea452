//! Masses of the links of a robot, estimated from the mass of the whole arm and the bodies of its links.
//!
//! The estimate is that of [`armill_core::clearance::solid`]; here it becomes tables of a robot file, with its source. Links whose mass the robot
//! file already gives keep it.

use armill_core::clearance::solid::{EstimateError, LINK_UNCERTAINTY, estimated_masses};
use armill_core::nalgebra::Point3;
use armill_core::robot::{Mass, Structure};
use armill_core::units::{from_mm, to_mm};
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

use crate::error::StudyError;
use crate::robots;
use crate::structure_answers::{MassDetails, StructureDetails};

/// Parts of an inertia below this part of the largest are written as zero.
const NEGLIGIBLE: f64 = 1e-3;
/// Key of the source of the masses.
const SOURCE: &str = "estimated masses";

/// The mass of an arm.
#[derive(Clone, Copy, Debug)]
pub struct ArmMass {
    /// Of the whole arm without its tool, kg.
    pub total_kg: f64,
    /// Its standard uncertainty.
    pub total_u_percent: f64,
}

/// Estimated masses of the links of a robot.
#[derive(Clone, Debug)]
pub struct EstimatedLinks {
    /// The robot, with the estimated masses as its only ones, and their source alone.
    pub robot: RobotDescription,
}

/// What came of it, as JSON.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EstimatedLinksAnswer {
    /// The file that was written; none if it was printed.
    pub file: Option<String>,
    /// The tables, if they were printed.
    pub text: Option<String>,
    /// The masses.
    pub masses: Vec<MassDetails>,
}

impl EstimatedLinks {
    /// Of the robot of this name or in this file.
    ///
    /// # Errors
    /// The problems of the file; a robot without bodies, or whose bodies are meshes; a total that the given masses exceed.
    pub fn of(name: &str, arm: ArmMass) -> Result<EstimatedLinks, StudyError> {
        let mut found = robots::find(name, Path::new("."))?;
        let given = &found.robot.structure().masses;
        let estimated = estimated_masses(&found.bodies, arm.total_kg, given).map_err(refused)?;
        let of_total = arm.total_u_percent / 100.0;
        let masses = estimated
            .into_iter()
            .map(|mass| rounded(&mass, LINK_UNCERTAINTY.hypot(of_total)));
        let structure = Structure {
            masses: masses.collect(),
            ..Structure::EMPTY
        };
        let no_error = |error: armill_core::robot::RobotError| StudyError::value(error.to_string(), "");
        found.robot = found.robot.with_structure(structure).map_err(no_error)?;
        found.sources = vec![Source {
            key: SOURCE.to_owned(),
            what: format!(
                "mass of the whole arm, {} kg, distributed over its links in the ratio of the volumes of their bodies by armill robots masses",
                arm.total_kg
            ),
            place: "the mass of the arm: write here where it is from".to_owned(),
            licence: "a fact".to_owned(),
        }];
        Ok(EstimatedLinks { robot: found })
    }

    /// What came of it, with `text` written to `file`.
    pub fn answer(&self, file: Option<String>, text: &str) -> EstimatedLinksAnswer {
        EstimatedLinksAnswer {
            text: file.is_none().then(|| text.to_owned()),
            file,
            masses: StructureDetails::of(&self.robot.robot).masses,
        }
    }
}

/// A mass as a table gives it: three digits, centre in whole millimetres.
fn rounded(mass: &Mass, relative_uncertainty: f64) -> Mass {
    let centre: Point3<f64> = from_mm(to_mm(mass.centre).map(f64::round));
    Mass {
        mass: three_digits(mass.mass),
        centre,
        inertia: mass.inertia.map(|inertia| {
            let least = inertia.amax() * NEGLIGIBLE;
            inertia.map(|part| {
                if part.abs() < least {
                    0.0
                } else {
                    three_digits(part)
                }
            })
        }),
        relative_uncertainty: three_digits(relative_uncertainty),
        ..*mass
    }
}

/// The nearest number of three decimal digits.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// The words for a refusal, with what to do.
fn refused(error: EstimateError) -> StudyError {
    let hint = match &error {
        EstimateError::WithoutBodies => {
            "masses are estimated from the [[body]] tables of a robot file: make them with `armill robots bodies`"
        }
        EstimateError::NothingLeft { .. } => "--total-kg is the mass of the whole arm, without its tool",
        EstimateError::Mesh(_) => {
            "capsules that enclose it: `armill robots import` and `armill robots bodies` write them"
        }
    };
    StudyError::value(format!("masses cannot be estimated: {error}"), hint)
}
