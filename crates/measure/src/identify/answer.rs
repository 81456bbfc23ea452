//! Springs with uncertainties, residuals, prediction of left-out tests, outliers, open questions: one JSON value.
//!
//! With a prior the fit has less weight for readings with large residuals (Huber), without one it is plain least
//! squares. Residuals are predicted minus measured. Method and meaning of the numbers: `docs/theory/identification.md`.

use armill_core::identify::fit::Scatter;
use armill_core::identify::{
    Errors, Identified, LoadTest, Loss, Measured, Method, Refusal, Role, TestOutcome, Unknown,
    displacement_errors, identify, measured_over_typical,
};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_per_um, to_um};
use armill_formats::measurement::load_tests::LoadTests;
use armill_study::StudyError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_check::{self, SlipAnswer};

use super::question::{PointsModel, PriorModel, Question, Units, attachment_name, spring_name};

/// Result of load tests. The fields are those of the JSON result.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Answer {
    /// Library name or file stem.
    pub robot: String,
    /// Tests with a reading.
    pub tests: usize,
    /// Numbers measured in them.
    pub readings: usize,
    /// One a spring, drives first.
    pub springs: Vec<SpringAnswer>,
    /// Backlash in drives, if requested.
    pub lost_motion: Vec<LostMotionAnswer>,
    /// The point of the force, flange frame; if requested.
    pub force_point: Option<PointAnswer>,
    /// Where displacement was measured, flange frame.
    pub gauge_point: Option<PointAnswer>,
    /// Standard uncertainty of a reading, estimated from the residuals, over the one given (or over 10 um, 10 urad).
    pub scatter_ratio: f64,
    /// Predicted minus measured displacement, over all tests.
    pub residual: Option<ErrorsAnswer>,
    /// The same, every test predicted from the others.
    pub left_out: Option<ErrorsAnswer>,
    /// Names of the outliers: residuals beyond 3.5 times the scatter.
    pub outliers: Vec<String>,
    /// Springs of which these tests determine only some sum or difference; a single one is not loaded in any test.
    pub not_identifiable: Vec<Vec<String>>,
    /// Every test.
    pub by_test: Vec<TestAnswer>,
    /// The likely slip in the data: a sign, an order of columns or a zero with which they agree much better.
    pub slip: Option<SlipAnswer>,
    /// What a user should know.
    pub notes: Vec<String>,
    /// The numbers as the core has them.
    #[serde(skip)]
    pub identified: Identified,
    /// What they are of.
    #[serde(skip)]
    pub unknowns: Vec<Unknown>,
}

/// One spring; compliance and stiffness in the unit that fits.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SpringAnswer {
    /// `A2 drive`, `A2 about x`.
    pub name: String,
    /// Attachment: `base`, a joint, `flange`.
    pub at: String,
    /// Of springs that turn.
    pub compliance_rad_per_n_m: Option<f64>,
    /// Standard uncertainty.
    pub compliance_u_rad_per_n_m: Option<f64>,
    /// Its inverse; none if rigid fits best.
    pub stiffness_n_m_per_rad: Option<f64>,
    /// Of springs that slide.
    pub compliance_um_per_n: Option<f64>,
    /// Standard uncertainty.
    pub compliance_u_um_per_n: Option<f64>,
    /// Its inverse.
    pub stiffness_n_per_um: Option<f64>,
    /// How much of it the tests determine, 0 to 1; the rest is prior knowledge.
    pub fraction_known_from_tests: f64,
}

/// The backlash in a drive.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LostMotionAnswer {
    /// Joint.
    pub joint: String,
    /// The total backlash.
    pub gap_urad: f64,
    /// Standard uncertainty.
    pub gap_u_urad: f64,
    /// Torque that takes up three quarters of it: assumed, 5 % of the largest of the tests.
    pub closing_torque_n_m: f64,
    /// How much of it the tests determine, 0 to 1.
    pub fraction_known_from_tests: f64,
}

/// A point in the flange frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PointAnswer {
    /// Offset from the point given in the tests.
    pub shift_mm: [f64; 3],
    /// Standard uncertainty.
    pub shift_u_mm: [f64; 3],
    /// The tool point so shifted.
    pub tool_point_mm: [f64; 3],
}

/// Lengths of displacement errors over all tests that measured a displacement.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErrorsAnswer {
    /// Mean.
    pub mean_um: f64,
    /// Root mean square.
    pub rms_um: f64,
    /// Greatest.
    pub max_um: f64,
    /// Mean over the mean of the measured displacement.
    pub fraction_of_measured: f64,
}

/// One test.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TestAnswer {
    /// Its `test` cell, or its line.
    pub name: String,
    /// Predicted minus measured displacement; none if an axis was not measured.
    pub residual_um: [Option<f64>; 3],
    /// The same with a prediction that has not seen this test.
    pub left_out_um: [Option<f64>; 3],
    /// Predicted minus measured turn.
    pub turn_residual_urad: Option<f64>,
    /// Residual over the scatter.
    pub residual_ratio: f64,
    /// Its weight, 0 to 1.
    pub weight_fraction: f64,
    /// Beyond 3.5 times the scatter.
    pub outlier: bool,
}

/// Measured displacements larger or smaller by this factor than those of a typical robot have another unit.
const TOO_LARGE: f64 = 300.0;
/// The same to the other side.
const TOO_SMALL: f64 = 0.01;
/// Left-out tests that are missed by a larger fraction of their displacement make no robot file.
const MOST_MISSED: f64 = 0.3;
/// Springs of which the tests determine less than this are listed.
const HARDLY_KNOWN: f64 = 0.5;

/// The result for `tests` of `robot`.
///
/// # Errors
/// Unknown groups, implausible readings, tests that cannot determine the requested springs.
pub fn answer(robot: &Robot, tests: &LoadTests, question: &Question) -> Result<Answer, StudyError> {
    let unknowns = question.unknowns(robot, &tests.tests)?;
    if question.units == Units::Checked {
        check_units(robot, &tests.tests)?;
        check_direction(robot, tests)?;
    }
    let method = Method {
        prior: question.prior(),
        points: question.points(),
        loss: match question.prior {
            PriorModel::Typical => Loss::Huber,
            PriorModel::None => Loss::Squares,
        },
        scatter: if tests.uncertainties_stated {
            Scatter::Stated
        } else {
            Scatter::Found
        },
    };
    let identified =
        identify(robot, &unknowns, &tests.tests, method).map_err(|refusal| refused(&refusal, question))?;
    let slip = data_check::load_tests::slip(robot, &tests.tests, &tests.names);
    let mut answer = reported(robot, tests, question, unknowns, identified);
    answer.slip = slip;
    Ok(answer)
}

impl Answer {
    /// Whether these compliances may be written to a robot file.
    ///
    /// # Errors
    /// Data with a likely slip; tests that the others predict too badly.
    pub fn check_usable(&self) -> Result<(), StudyError> {
        if let Some(slip) = &self.slip {
            return Err(StudyError::value(
                format!("--out: the compliances are not usable: {}", slip.sentence()),
                "correct the data, or leave --out out to see the result",
            ));
        }
        let missed = self
            .left_out
            .as_ref()
            .map_or(0.0, |errors| errors.fraction_of_measured);
        if missed > MOST_MISSED {
            return Err(StudyError::value(
                format!(
                    "--out: the compliances are not usable: left-out tests are missed by {:.0} % of their displacement, at most {:.0} % is accepted",
                    missed * 100.0,
                    MOST_MISSED * 100.0
                ),
                "check the worst tests (--json: by_test), the force points and the posture of each test; or add --unknowns drives+bending",
            ));
        }
        Ok(())
    }
}

/// Refuses displacements against the force in most tests: no elastic arm moves so.
fn check_direction(robot: &Robot, tests: &LoadTests) -> Result<(), StudyError> {
    let Some([against, all]) = data_check::load_tests::against_force(&tests.tests) else {
        return Ok(());
    };
    if 2 * against <= all {
        return Ok(());
    }
    let slip = data_check::load_tests::slip(robot, &tests.tests, &tests.names);
    let slip = slip.map_or_else(String::new, |slip| format!("; {}", slip.sentence()));
    Err(StudyError::value(
        format!("the displacement is against the force in {against} of {all} tests{slip}"),
        "give the force on the tool, not its reaction, and loaded minus unloaded displacements: reverse the sign of one of them; --trust-units accepts the values",
    ))
}

/// Refuses readings so far from those of a typical robot that a unit must be wrong.
fn check_units(robot: &Robot, tests: &[LoadTest]) -> Result<(), StudyError> {
    let Some(ratio) = measured_over_typical(robot, tests) else {
        return Ok(());
    };
    let (word, guess) = if ratio > TOO_LARGE {
        (
            "larger",
            "are readings in micrometres called mm, or forces in kN called N?",
        )
    } else if ratio < TOO_SMALL {
        (
            "smaller",
            "are readings in millimetres called um, or in metres called mm?",
        )
    } else {
        return Ok(());
    };
    // As a factor above 1, in either direction.
    let times = if ratio > 1.0 { ratio } else { 1.0 / ratio };
    let message =
        format!("readings are {times:.0} times {word} than those of a typical robot under these loads");
    Err(StudyError::value(
        message,
        format!("{guess} The unit is in the name of the column; --trust-units accepts the values"),
    ))
}

/// An error of the core, with what the user can do about it.
fn refused(refusal: &Refusal, question: &Question) -> StudyError {
    let hint = match refusal {
        Refusal::TooFewReadings { .. } => {
            let fewer = match (question.points, question.unknowns.as_str()) {
                (PointsModel::Known, "drives") => "",
                (PointsModel::Known, _) => " or use fewer unknowns: --unknowns drives",
                _ => " or use fewer unknowns: --unknowns drives --points known",
            };
            format!("do more tests{fewer}; `armill identify --plan 20` proposes some")
        }
        Refusal::OnePosture { .. } => {
            "one posture determines the compliance at the tool, but not the joints; `armill identify --plan 20` proposes \
             postures"
                .to_owned()
        }
        Refusal::NothingMeasured => "fill in loads and readings, loaded minus unloaded".to_owned(),
    };
    StudyError::value(refusal.to_string(), hint)
}

/// The result, in the units and names of the JSON value.
fn reported(
    robot: &Robot,
    tests: &LoadTests,
    question: &Question,
    unknowns: Vec<Unknown>,
    identified: Identified,
) -> Answer {
    let names: Vec<String> = unknowns
        .iter()
        .map(|unknown| spring_name(robot, unknown))
        .collect();
    let (mut springs, mut lost_motion) = (Vec::new(), Vec::new());
    for ((unknown, estimate), name) in unknowns.iter().zip(&identified.estimates).zip(&names) {
        let at = attachment_name(robot, unknown);
        let fraction_known_from_tests = estimate.known;
        if let Role::LostMotion { torque } = unknown.role {
            lost_motion.push(LostMotionAnswer {
                joint: at,
                gap_urad: 2e6 * estimate.value,
                gap_u_urad: 2e6 * estimate.standard_uncertainty,
                closing_torque_n_m: torque,
                fraction_known_from_tests,
            });
            continue;
        }
        let turns = unknown.turns();
        let (value, u) = (estimate.value, estimate.standard_uncertainty);
        // A spring that came out rigid has no finite stiffness.
        let stiffness = (value > 0.0).then(|| 1.0 / value);
        springs.push(SpringAnswer {
            name: name.clone(),
            at,
            compliance_rad_per_n_m: turns.then_some(value),
            compliance_u_rad_per_n_m: turns.then_some(u),
            stiffness_n_m_per_rad: stiffness.filter(|_| turns),
            compliance_um_per_n: (!turns).then_some(to_um(value)),
            compliance_u_um_per_n: (!turns).then_some(to_um(u)),
            stiffness_n_per_um: stiffness.filter(|_| !turns).map(to_per_um),
            fraction_known_from_tests,
        });
    }
    let point = |shift: Option<[Vector3<f64>; 2]>| {
        shift.map(|[shift, u]| PointAnswer {
            shift_mm: to_mm(shift).into(),
            shift_u_mm: to_mm(u).into(),
            tool_point_mm: to_mm(question.tool_point + shift).into(),
        })
    };
    let errors = |errors: Option<Errors>| {
        errors.map(|errors| ErrorsAnswer {
            mean_um: to_um(errors.mean),
            rms_um: to_um(errors.rms),
            max_um: to_um(errors.largest),
            fraction_of_measured: errors.relative,
        })
    };
    let by_test: Vec<TestAnswer> = tests
        .tests
        .iter()
        .zip(&tests.names)
        .zip(&identified.tests)
        .map(|((test, name), outcome)| test_answer(name, test, outcome))
        .collect();
    Answer {
        robot: robot.name().to_owned(),
        tests: tests.tests.len(),
        readings: tests.tests.iter().map(|test| test.readings.len()).sum(),
        springs,
        lost_motion,
        force_point: point(identified.force_shift),
        gauge_point: point(identified.measured_shift),
        scatter_ratio: identified.scale,
        residual: errors(displacement_errors(
            &tests.tests,
            identified.tests.iter().map(|t| &t.residuals),
        )),
        left_out: errors(displacement_errors(
            &tests.tests,
            identified.tests.iter().map(|t| &t.left_out),
        )),
        outliers: by_test
            .iter()
            .filter(|t| t.outlier)
            .map(|t| t.name.clone())
            .collect(),
        not_identifiable: identified
            .together
            .iter()
            .map(|set| set.iter().map(|k| names[*k].clone()).collect())
            .collect(),
        by_test,
        slip: None,
        notes: notes(tests, &names, &identified),
        identified,
        unknowns,
    }
}

/// One test, by axes of base; empty where not measured.
fn test_answer(name: &str, test: &LoadTest, outcome: &TestOutcome) -> TestAnswer {
    let mut answer = TestAnswer {
        name: name.to_owned(),
        residual_um: [None; 3],
        left_out_um: [None; 3],
        turn_residual_urad: None,
        residual_ratio: outcome.standardised,
        weight_fraction: outcome.weight,
        outlier: outcome.outlier,
    };
    for (k, reading) in test.readings.iter().enumerate() {
        match reading.what {
            Measured::Displacement(axis) => {
                answer.residual_um[axis.index()] = outcome.residuals.get(k).map(to_um);
                answer.left_out_um[axis.index()] = outcome.left_out.get(k).map(to_um);
            }
            Measured::Turn(_) => answer.turn_residual_urad = outcome.residuals.get(k).map(to_um),
        }
    }
    answer
}

/// Notes for the user: rows without a reading, springs that the tests hardly determine, residuals far beyond the given
/// uncertainties.
fn notes(tests: &LoadTests, names: &[String], identified: &Identified) -> Vec<String> {
    let mut notes = Vec::new();
    if tests.empty_rows > 0 {
        notes.push(format!(
            "{} rows without a reading were passed over",
            tests.empty_rows
        ));
    }
    if let Some(first) = tests.outside_limits.first() {
        let more = match tests.outside_limits.len() - 1 {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        notes.push(format!(
            "postures outside the limits of the robot file are used as measured: {first}{more}"
        ));
    }
    let hardly: Vec<&str> = identified
        .estimates
        .iter()
        .zip(names)
        .filter(|(estimate, _)| estimate.known < HARDLY_KNOWN)
        .map(|(_, name)| name.as_str())
        .collect();
    if !hardly.is_empty() {
        notes.push(format!(
            "mostly from prior knowledge, not from these tests: {}",
            hardly.join(", ")
        ));
    }
    if tests.uncertainties_stated && identified.scale > 2.0 {
        notes.push(format!(
            "residuals are {:.1} times as large as the given uncertainties: something is missing in the model or in \
             the uncertainties",
            identified.scale
        ));
    }
    notes
}
