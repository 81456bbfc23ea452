//! Tests to do: postures and pulls as a table to fill in.
//!
//! ```text
//! test,A1_deg,...,A6_deg,fx_n,fy_n,fz_n,dx_mm,dy_mm,dz_mm,expected_dx_mm,expected_dy_mm,expected_dz_mm
//! ```
//!
//! One row per test. `dx_mm` to `dz_mm` are empty, for the measured values: loaded minus unloaded, base axes. Expected
//! displacements are those of the drives of the robot file, else of a typical robot. Prismatic joints are in mm, as
//! their column names say.

use armill_core::frame::Isometry;
use armill_core::identify::{Floor, PlanQuestion, PlannedTest, plan as core_plan};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_core::source::elastic::displacement;
use armill_core::spatial::Wrench;
use armill_core::units::{to_deg, to_mm, to_um};
use armill_formats::table::csv;
use armill_study::StudyError;
use schemars::JsonSchema;
use serde::Serialize;

use super::question::{Question, spring_name, within};

/// A plan, for JSON and as a table.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PlanAnswer {
    /// Library name or file stem.
    pub robot: String,
    /// Different postures among the tests.
    pub postures: usize,
    /// The tests, in the order of their postures.
    pub tests: Vec<PlannedTestAnswer>,
    /// How well each spring will be known.
    pub springs: Vec<ExpectedSpring>,
    /// The table to fill in: CSV.
    #[serde(skip)]
    pub table: String,
}

/// One test to do.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PlannedTestAnswer {
    /// Joint positions (prismatic joints in mm).
    pub joints_deg: Vec<f64>,
    /// Pull on the tool, base axes.
    pub force_n: [f64; 3],
    /// Displacement from the drives of the robot file, or those of a typical robot if it has none.
    pub expected_mm: [f64; 3],
}

/// How well a spring will be known.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExpectedSpring {
    /// `A2 drive`.
    pub name: String,
    /// Expected standard uncertainty over compliance; 2 is a factor of seven, which is prior knowledge for any robot.
    pub relative_u_ratio: f64,
    /// How much of it the tests are expected to determine, 0 to 1.
    pub fraction_known_from_tests: f64,
}

/// Fewest and most tests of a plan.
const TESTS: std::ops::RangeInclusive<usize> = 1..=500;
/// Least and greatest pull, N.
const PULL_N: [f64; 2] = [1e-3, 1e6];
/// Least and greatest uncertainty of a gauge, um.
const GAUGE_UM: [f64; 2] = [1e-3, 1e6];

/// A plan of `count` tests with forces of `pull` (N): down, and level along base x and y. `gauge` (m) is the standard
/// uncertainty of a reading.
///
/// # Errors
/// An invalid count, force or uncertainty; a robot without a suitable posture.
pub fn plan(
    robot: &Robot,
    question: &Question,
    count: usize,
    [pull, gauge]: [f64; 2],
) -> Result<PlanAnswer, StudyError> {
    if !TESTS.contains(&count) {
        return Err(StudyError::value(
            format!("--plan {count} is not from {} to {}", TESTS.start(), TESTS.end()),
            "20 to 40 tests take an afternoon",
        ));
    }
    within("--pull-n", pull, PULL_N, "N")?;
    within("--gauge-um", to_um(gauge), GAUGE_UM, "um")?;
    let unknowns = question.unknowns(robot, &[])?;
    let requested = PlanQuestion {
        tests: count,
        pulls: [
            -Vector3::z(),
            Vector3::x(),
            -Vector3::x(),
            Vector3::y(),
            -Vector3::y(),
        ]
        .map(|direction| direction * pull)
        .to_vec(),
        tool_point: question.tool_point,
        gauge,
        floor: Some(Floor::under_base()),
    };
    let plan = core_plan(robot, &unknowns, &requested);
    if plan.tests.is_empty() {
        return Err(StudyError::value(
            "no posture inside the joint limits keeps the tool clear of the floor and of the robot",
            "is --tool-mm right, and do the limits of the robot file leave room?",
        ));
    }
    let tests: Vec<PlannedTestAnswer> = plan
        .tests
        .iter()
        .map(|test| PlannedTestAnswer {
            joints_deg: test
                .joints
                .iter()
                .enumerate()
                .map(|(i, q)| rounded(robot, i, *q))
                .collect(),
            force_n: test.force.into(),
            expected_mm: to_mm(expected(robot, question, test)).into(),
        })
        .collect();
    let mut postures: Vec<&Vec<f64>> = tests.iter().map(|test| &test.joints_deg).collect();
    // Tests in one posture are next to each other.
    postures.dedup();
    let springs = unknowns
        .iter()
        .enumerate()
        .map(|(k, unknown)| ExpectedSpring {
            name: spring_name(robot, unknown),
            relative_u_ratio: plan.spread.covariance[(k, k)].max(0.0).sqrt(),
            fraction_known_from_tests: plan.spread.known[k],
        })
        .collect();
    Ok(PlanAnswer {
        robot: robot.name().to_owned(),
        postures: postures.len(),
        table: table(robot, &tests),
        tests,
        springs,
    })
}

/// Unit of joint `i` in the table, per rad (m): degrees, mm.
fn scale(robot: &Robot, i: usize) -> f64 {
    if robot.slides(i) { 1e3 } else { to_deg(1f64) }
}

/// Joint `i` as the table has it: whole degrees (mm).
fn rounded(robot: &Robot, i: usize, q: f64) -> f64 {
    (q * scale(robot, i)).round()
}

/// The expected reading in the posture of the table, m, base axes: from the drives of the robot if they are known.
fn expected(robot: &Robot, question: &Question, test: &PlannedTest) -> Vector3<f64> {
    let Some(compliance) = robot.compliance() else {
        return test.expected;
    };
    let flange_from_tool = Isometry::from_parts(question.tool_point.into(), UnitQuaternion::identity());
    let joints: Vec<f64> = test
        .joints
        .iter()
        .enumerate()
        .map(|(i, q)| rounded(robot, i, *q) / scale(robot, i))
        .collect();
    let posture = posture_at(robot, &joints, &flange_from_tool);
    displacement(&posture.screws, compliance, &Wrench::from_force(test.force))
}

/// The plan as CSV, with empty cells for the measured values.
fn table(robot: &Robot, tests: &[PlannedTestAnswer]) -> String {
    let mut header = vec!["test".to_owned()];
    header.extend(robot.joints().iter().enumerate().map(|(i, joint)| {
        let unit = if robot.slides(i) { "mm" } else { "deg" };
        csv::text_cell(&format!("{}_{unit}", joint.name))
    }));
    header.extend(["fx_n", "fy_n", "fz_n", "dx_mm", "dy_mm", "dz_mm"].map(str::to_owned));
    header.extend(["expected_dx_mm", "expected_dy_mm", "expected_dz_mm"].map(str::to_owned));
    let mut lines = vec![header.join(",")];
    // Adding 0 turns -0 into 0.
    let plain = |value: &f64| format!("{}", to_mm(value).round() / 1e3 + 0.0);
    for (index, test) in tests.iter().enumerate() {
        let mut cells = vec![format!("{}", index + 1)];
        cells.extend(test.joints_deg.iter().chain(&test.force_n).map(plain));
        cells.extend(["", "", ""].map(str::to_owned));
        cells.extend(test.expected_mm.iter().map(plain));
        lines.push(cells.join(","));
    }
    lines.join("\r\n") + "\r\n"
}
