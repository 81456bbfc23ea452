//! `armill identify`: springs from load tests, and plans of tests.
//!
//! A table of tests gives an [`Answer`] on stdout and, with `--out`, the robot with its identified compliances;
//! `--plan` gives a table to fill in, on stdout or in `--out`, and on stderr the expected result. `--unknowns`,
//! `--points`, `--prior` and `--tool-mm` are the [`Question`] of both.
//!
//! | `--plan` | stdout | `--out` | stderr |
//! |---|---|---|---|
//! | given | the table, unless it goes to `--out`; the plan with `--json` | the table | the expected uncertainty |
//! | not given | springs, points, errors, as text or JSON | the robot with its compliances | the file written |
//!
//! Compliances are rad/(N m) about an axis and um/N along one; `+-` precedes a standard uncertainty in per
//! cent of the value.

use std::fmt::Write;
use std::path::Path;

use armill_core::nalgebra::Vector3;
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::units::{from_mm, from_um};
use armill_formats::input;
use armill_formats::measurement::load_tests;
use armill_formats::robot::RobotDescription;
use armill_measure::identify::answer::{ErrorsAnswer, PointAnswer};
use armill_measure::identify::robot_file::robot_file;
use armill_measure::identify::{
    Answer, PlanAnswer, PointsModel, PriorModel, Question, SpringAnswer, Units, answer, plan,
};
use armill_study::{StudyError, robots};

use crate::arguments::numbers::{above_zero, three};
use crate::arguments::{IdentifyArguments, PointsArgument, PriorArgument};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Identifies from tests, or plans tests.
///
/// # Errors
/// No such robot; an invalid number; neither a table nor a plan requested; the problems of the table;
/// springs that cannot be identified from it; a file that cannot be written.
pub(crate) fn run(arguments: &IdentifyArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let question = question(arguments)?;
    match (&arguments.tests, arguments.plan) {
        (_, Some(count)) => plan_tests(arguments, &found, &question, count),
        (Some(tests), None) => from_tests(arguments, &found, &question, tests),
        (None, None) => Err(StudyError::value(
            "a table of tests or --plan is required",
            "`armill identify TESTS.csv --robot R`, or `armill identify --plan 20 --robot R` for a table to fill in",
        )),
    }
}

/// Settings for tests and plans, in SI. The force and the sensor are checked even if no plan
/// uses them.
fn question(arguments: &IdentifyArguments) -> Result<Question, StudyError> {
    let tool_point_mm = match &arguments.tool_mm {
        Some(tool_mm) => three("--tool-mm", tool_mm)?,
        None => Vector3::zeros(),
    };
    if let Some(pull_n) = arguments.pull_n {
        above_zero("--pull-n", pull_n)?;
    }
    above_zero("--gauge-um", arguments.gauge_um)?;
    Ok(Question {
        unknowns: arguments.unknowns.clone(),
        points: match arguments.points {
            PointsArgument::Known => PointsModel::Known,
            PointsArgument::Common => PointsModel::Common,
            PointsArgument::Separate => PointsModel::Separate,
        },
        point_u: from_mm(above_zero("--point-u-mm", arguments.point_u_mm)?),
        prior: match arguments.prior {
            PriorArgument::Typical => PriorModel::Typical,
            PriorArgument::None => PriorModel::None,
        },
        tool_point: from_mm(tool_point_mm),
        units: if arguments.trust_units {
            Units::Trusted
        } else {
            Units::Checked
        },
    })
}

/// Proposes `count` tests and reports the expected result.
fn plan_tests(
    arguments: &IdentifyArguments,
    found: &RobotDescription,
    question: &Question,
    count: usize,
) -> Result<Outcome, StudyError> {
    let pull_n = pull_n(arguments.pull_n, found.payload_kg)?;
    let plan = plan(
        &found.robot,
        question,
        count,
        [pull_n, from_um(arguments.gauge_um)],
    )?;
    match &arguments.out {
        Some(file) => {
            arguments
                .writing
                .writer("identify")
                .write(file, plan.table.as_bytes())?;
            say(&format!("table in {}", file.display()));
        }
        None if !arguments.json => print(plan.table.trim_end())?,
        None => {}
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&plan)?)?;
    }
    say(&plan_text(&plan));
    Ok(Outcome::Fine)
}

/// Force of a plan unless the payload is less, N.
const USUAL_PULL_N: f64 = 150.0;

/// The force of a plan, N: as given, at most the weight of the payload, where that is known.
fn pull_n(given: Option<f64>, payload_kg: Option<f64>) -> Result<f64, StudyError> {
    let Some(weight) = payload_kg.map(|payload| payload * FREE_FALL) else {
        return Ok(given.unwrap_or(USUAL_PULL_N));
    };
    match given {
        Some(pull) if pull > weight => Err(StudyError::value(
            format!("--pull-n: {pull} N is more than the weight of the payload, {weight:.0} N"),
            "a force that the robot may hold in every posture",
        )),
        Some(pull) => Ok(pull),
        // Whole newtons, as a spring scale is read.
        None => Ok(USUAL_PULL_N.min(weight.floor())),
    }
}

/// The expected uncertainty of each spring; springs determined less than half by the tests are reported as hardly
/// known.
fn plan_text(plan: &PlanAnswer) -> String {
    let mut text = format!(
        "{} tests in {} postures of {}. Check each posture for collisions before you move there.\n\
         Expected standard uncertainty, with the given uncertainty of the sensor:",
        plan.tests.len(),
        plan.postures,
        plan.robot
    );
    for spring in &plan.springs {
        let percent = spring.relative_u_ratio * 100.0;
        let known = if spring.fraction_known_from_tests < 0.5 {
            "hardly determined".to_owned()
        } else if percent < 1.0 {
            "within 1 %".to_owned()
        } else {
            format!("within {percent:.0} %")
        };
        let _ = write!(text, "\n  {:<14} {known}", spring.name);
    }
    text
}

/// Reads the table and identifies the springs; with `--out` writes a robot file with them.
fn from_tests(
    arguments: &IdentifyArguments,
    found: &RobotDescription,
    question: &Question,
    tests: &Path,
) -> Result<Outcome, StudyError> {
    let shown = tests.display().to_string();
    let bytes = input::read(tests).map_err(|error| {
        StudyError::value(
            format!("cannot read {shown}: {error}"),
            "a table of load tests, CSV; `armill identify --plan 20 --robot ...` writes one to fill in",
        )
    })?;
    let tests = load_tests::read(&shown, bytes.as_slice(), &found.robot, question.tool_point)?;
    let answer = answer(&found.robot, &tests, question)?;
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    if let Some(slip) = &answer.slip {
        say(&format!(
            "warning: the compliances are not usable: {}",
            slip.sentence()
        ));
    }
    if let Some(file) = &arguments.out {
        answer.check_usable()?;
        let [path, text] = robots::text_of(&arguments.robot, found)?;
        let written = robot_file(&found.robot, [&path, &text], &answer, &shown)?;
        arguments
            .writing
            .writer("identify")
            .for_new_files()
            .write(file, written.as_bytes())?;
        say(&format!("robot with these compliances in {}", file.display()));
    }
    Ok(Outcome::Fine)
}

/// The result as text: springs, lost motion, points, errors, outliers, springs that cannot be separated,
/// notes.
fn as_text(answer: &Answer) -> String {
    let mut lines = vec![format!(
        "{}: {} tests, {} readings, {} springs",
        answer.robot,
        answer.tests,
        answer.readings,
        answer.springs.len()
    )];
    lines.push(String::new());
    lines.push(format!(
        "{:<16} {:>26} {:>20}   determined by the tests",
        "spring", "compliance", "stiffness"
    ));
    lines.extend(answer.springs.iter().map(spring_text));
    for gap in &answer.lost_motion {
        lines.push(format!(
            "{:<16} {:>10.0} urad +- {:>3.0} %  {:>20}   {:>3.0} %",
            format!("{} lost motion", gap.joint),
            gap.gap_urad,
            percent(gap.gap_u_urad, gap.gap_urad),
            "",
            gap.fraction_known_from_tests * 100.0
        ));
    }
    lines.push(String::new());
    lines.extend(answer.force_point.iter().map(|p| point_text("force point", p)));
    lines.extend(answer.gauge_point.iter().map(|p| point_text("gauge point", p)));
    lines.extend(answer.residual.iter().map(|e| errors_text("residuals", e)));
    lines.extend(answer.left_out.iter().map(|e| errors_text("left out", e)));
    if answer.outliers.is_empty() {
        lines.push("outliers     none: no residual beyond 3.5 times the scatter".to_owned());
    } else {
        let named = answer.by_test.iter().filter(|test| test.outlier);
        let named: Vec<String> = named
            .map(|test| format!("{} ({:.1} times the scatter)", test.name, test.residual_ratio))
            .collect();
        lines.push(format!(
            "outliers     {}; they are used, with limited weight",
            named.join(", ")
        ));
    }
    for set in &answer.not_identifiable {
        lines.push(if set.len() == 1 {
            format!("no effect    {}: not loaded in any test", set.join(", "))
        } else {
            format!(
                "not separable  {}: only some sums of them are known",
                set.join(", ")
            )
        });
    }
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

/// One line per spring: compliance with its uncertainty, stiffness, and how much of it the tests determine.
fn spring_text(spring: &SpringAnswer) -> String {
    let (value, u, unit) = match (spring.compliance_rad_per_n_m, spring.compliance_um_per_n) {
        (Some(value), _) => (value, spring.compliance_u_rad_per_n_m.unwrap_or(0.0), "rad/(N m)"),
        (_, value) => (
            value.unwrap_or(0.0),
            spring.compliance_u_um_per_n.unwrap_or(0.0),
            "um/N",
        ),
    };
    let stiffness = match (spring.stiffness_n_m_per_rad, spring.stiffness_n_per_um) {
        (Some(k), _) => format!("{k:.3e} N m/rad"),
        (_, Some(k)) => format!("{k:.1} N/um"),
        _ => "rigid".to_owned(),
    };
    format!(
        "{:<16} {value:>9.2e} {unit:<9} +- {:>3.0} % {stiffness:>19}   {:>3.0} %",
        spring.name,
        percent(u, value),
        spring.fraction_known_from_tests * 100.0
    )
}

/// A fraction of a whole in per cent; 0 if the whole is 0.
fn percent(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { 100.0 * part / whole } else { 0.0 }
}

/// An identified point, in the flange frame, mm.
fn point_text(what: &str, point: &PointAnswer) -> String {
    let three = |[x, y, z]: [f64; 3]| format!("({x:.1}, {y:.1}, {z:.1})");
    format!(
        "{what}  {} mm in the flange frame, {} mm from the given point (standard uncertainty {} mm)",
        three(point.tool_point_mm),
        three(point.shift_mm),
        three(point.shift_u_mm)
    )
}

/// The residuals of the identified springs.
fn errors_text(what: &str, errors: &ErrorsAnswer) -> String {
    format!(
        "{what:<12} mean {:.1} um, rms {:.1} um, largest {:.1} um; mean {:.1} % of the measured displacement",
        errors.mean_um,
        errors.rms_um,
        errors.max_um,
        errors.fraction_of_measured * 100.0
    )
}
