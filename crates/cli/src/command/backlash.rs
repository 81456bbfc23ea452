//! `armill backlash`: the backlash of each joint from circular tests; plans of circles; simulated tests.
//!
//! Stdout has a [`BacklashAnswer`] (or a [`PlanAnswer`], or a list of the files written), as text or JSON.
//!
//! ```text
//! circle groove: radius 100 mm about (1000, 0, 800) mm; files           one per circle
//! joint   reverses at deg     step um   crossed CW deg   CCW deg        in both directions at the same place
//! joint   backlash   +-   inflation   robot file                        from all circles together
//! ```

use armill_core::units::{from_mm, from_um};
use armill_measure::backlash::answer::{CircleAnswer, JointAnswer, ReversalAnswer};
use armill_measure::backlash::plan::{
    ExpectedAnswer, IdentifiabilityAnswer, ProposedAnswer, candidate_count,
};
use armill_measure::backlash::{
    BacklashAnswer, EstimateOptions, PlanAnswer, PlanOptions, SimulatedFile, SimulationOptions, estimate,
    output, plan, simulate,
};
use armill_study::StudyError;
use armill_study::{Study, studies};

use crate::arguments::BacklashArguments;
use crate::arguments::numbers::{above_zero, finite, within};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{Align, columns, print, say};

/// Greatest number of lobes, circles, runs and radii.
const MOST: usize = 100;
/// Noise for a plan if none is given, um.
const PLAN_NOISE_UM: f64 = 1.0;

/// Reads the study, runs the requested task, and prints the result.
///
/// # Errors
/// No such study, or its problems; invalid options; no measurements; a folder or stdout that cannot be written.
pub(crate) fn run(arguments: &BacklashArguments) -> Result<Outcome, StudyError> {
    within("--lobes", arguments.lobes, [0, MOST])?;
    within("--circles", arguments.circles.unwrap_or(1), [1, MOST])?;
    within("--runs", arguments.runs, [1, MOST])?;
    let noise = arguments
        .noise_um
        .map(|um| above_zero("--noise-um", um))
        .transpose()?;
    let noise = noise.map(from_um);
    let study = studies::find(&arguments.study)?.read()?;
    print(&match (&arguments.simulate, arguments.circles) {
        (Some(_), _) => simulated(arguments, &study, noise)?,
        (None, Some(count)) => planned(arguments, &study, count, noise)?,
        (None, None) => estimated(arguments, &study, noise)?,
    })?;
    Ok(Outcome::Fine)
}

/// Estimates backlash.
fn estimated(arguments: &BacklashArguments, study: &Study, noise: Option<f64>) -> Result<String, StudyError> {
    let requested = EstimateOptions {
        most_lobes: arguments.lobes,
        noise,
    };
    let progress = Progress::new(estimate::point_count(study)?);
    let (found, given) = progress.watch(|watch| estimate(study, &requested, watch))?;
    if let Some(out) = &arguments.out {
        output::write(&given, &found, &arguments.writing.writer("backlash").folder(out)?)?;
        say(&format!("result, table and pictures in {}", out.display()));
    }
    if let Some(slip) = &given.slip {
        say(&format!(
            "warning: the backlash is not that of the robot: {}",
            slip.sentence()
        ));
    }
    for warning in &given.warnings {
        say(&format!("warning: {warning}"));
    }
    Ok(match arguments.json {
        true => serde_json::to_string_pretty(&given)?,
        false => as_text(&given),
    })
}

/// Plans circles.
fn planned(
    arguments: &BacklashArguments,
    study: &Study,
    count: usize,
    noise: Option<f64>,
) -> Result<String, StudyError> {
    let half = match arguments.within_mm[..] {
        [x, y, z] => [x, y, z],
        _ => {
            let message = format!(
                "--within-mm: 3 numbers are required (got {})",
                arguments.within_mm.len()
            );
            return Err(StudyError::value(
                message,
                "half the lengths of the sides, such as 200,200,200",
            ));
        }
    };
    finite("--within-mm", &half)?;
    if let Some(negative) = half.iter().find(|half| **half < 0.0) {
        let message = format!("--within-mm: {negative} is below 0");
        return Err(StudyError::value(
            message,
            "half the lengths of the sides of the box",
        ));
    }
    if arguments.radii_mm.len() > MOST {
        let message = format!(
            "--radii-mm: at most {MOST} radii (got {})",
            arguments.radii_mm.len()
        );
        return Err(StudyError::value(message, "the lengths of your ball-bar"));
    }
    let radii = arguments.radii_mm.iter().map(|mm| above_zero("--radii-mm", *mm));
    let requested = PlanOptions {
        analyses: arguments.analysis.clone(),
        count,
        half: half.map(from_mm),
        radii: radii
            .map(|mm| Ok(from_mm(mm?)))
            .collect::<Result<_, StudyError>>()?,
        most_lobes: arguments.lobes,
        noise: noise.unwrap_or(from_um(PLAN_NOISE_UM)),
    };
    let progress = Progress::of("circles", candidate_count(study, &requested)?);
    let given = progress.watch(|watch| plan(study, &requested, watch))?;
    Ok(match arguments.json {
        true => serde_json::to_string_pretty(&given)?,
        false => plan_as_text(&given),
    })
}

/// Simulates ball-bar files.
fn simulated(arguments: &BacklashArguments, study: &Study, noise: Option<f64>) -> Result<String, StudyError> {
    let requested = SimulationOptions {
        analyses: arguments.analysis.clone(),
        runs: arguments.runs,
        noise: noise.unwrap_or(0.0),
        seed: arguments.seed,
    };
    let folder = arguments.simulate.as_deref().unwrap_or(".".as_ref());
    let points = simulate::point_count(study, &requested.analyses)?;
    let writer = arguments.writing.writer("backlash");
    let given = Progress::new(points).watch(|watch| simulate(study, &requested, folder, &writer, watch))?;
    let line = |one: &SimulatedFile| {
        format!(
            "{}: {} um at most, in {}",
            one.analysis,
            um(one.largest_um),
            one.file
        )
    };
    Ok(match arguments.json {
        true => serde_json::to_string_pretty(&given)?,
        false => given.iter().map(line).collect::<Vec<_>>().join("\n"),
    })
}

fn um(value: f64) -> String {
    format!("{value:.1}")
}

/// The result as text, see the documentation of this module.
fn as_text(given: &BacklashAnswer) -> String {
    let mut lines = Vec::new();
    for circle in &given.circles {
        lines.extend(circle_as_text(circle));
        lines.push(String::new());
    }
    let head = ["joint", "backlash", "", "inflation", "robot file"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(given.joints.iter().map(joint_as_row));
    lines.extend(columns(&rows, &[Align::Left]));
    lines.push(String::new());
    lines.push(format!(
        "{} samples: {:.2} um rms residual of centre, radius and lobes, {:.2} um with backlash fitted too",
        given.samples, given.rms_before_um, given.rms_after_um
    ));
    lines.join("\n")
}

fn circle_as_text(circle: &CircleAnswer) -> Vec<String> {
    let [x, y, z] = circle.centre_mm;
    let mut lines = vec![format!(
        "circle {}: radius {} mm about ({x:.1}, {y:.1}, {z:.1}) mm; {}",
        circle.analysis,
        circle.radius_mm,
        circle.files.join(", ")
    )];
    let head = ["joint", "reverses at deg", "step um", "crossed CW deg", "CCW deg"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let deg = |value: Option<f64>| value.map_or("-".to_owned(), |deg| format!("{deg:.1}"));
    rows.extend(circle.reversals.iter().map(|at: &ReversalAnswer| {
        vec![
            at.joint.clone(),
            format!("{:.1}", at.at_deg),
            at.step_um.map_or("-".to_owned(), |um| format!("{um:+.1}")),
            deg(at.crossed_cw_deg),
            deg(at.crossed_ccw_deg),
        ]
    }));
    lines.extend(columns(&rows, &[Align::Left]));
    lines
}

fn joint_as_row(joint: &JointAnswer) -> Vec<String> {
    let given = match (
        joint.backlash_deg.zip(joint.backlash_u_deg),
        joint.backlash_mm.zip(joint.backlash_u_mm),
    ) {
        (Some((gap, u)), _) => [format!("{gap:.5}"), format!("+- {:.5} deg", 2.0 * u)],
        (None, Some((gap, u))) => [format!("{gap:.5}"), format!("+- {:.5} mm", 2.0 * u)],
        (None, None) => ["-".to_owned(), joint.state.to_owned()],
    };
    let file = match (joint.robot_file_deg, joint.robot_file_mm) {
        (Some(deg), _) => format!("{deg:.5} deg"),
        (None, Some(mm)) => format!("{mm:.5} mm"),
        (None, None) => "-".to_owned(),
    };
    let [gap, u] = given;
    let inflation = joint
        .inflation_ratio
        .map_or("-".to_owned(), |ratio| format!("{ratio:.1}"));
    vec![joint.joint.clone(), gap, u, inflation, file]
}

/// The plan as text.
fn plan_as_text(given: &PlanAnswer) -> String {
    let list = |numbers: &[f64]| {
        let words: Vec<String> = numbers.iter().map(|mm| format!("{mm:.0}")).collect();
        words.join(", ")
    };
    let [low, high] = &given.box_mm;
    let mut lines = vec![
        format!(
            "{} circles searched, {} analysed: {} centres per axis from ({}) to ({}) mm, planes {}, radii {} mm",
            given.candidates,
            given.followed,
            given.along,
            list(low),
            list(high),
            given.planes.join(" "),
            list(&given.radii_mm)
        ),
        format!(
            "tool axis against the normal of the plane; noise {} um",
            given.noise_um
        ),
        String::new(),
        format!("{:<10} {}", "study", given.begun.join(", ")),
        format!("{:<10} {}", "", known_as_text(&given.known)),
    ];
    for (index, circle) in given.circles.iter().enumerate() {
        lines.extend(proposed_as_text(index + 1, circle));
    }
    if let Some(last) = given.circles.last().map(|circle| &circle.known) {
        lines.push(String::new());
        lines.push("expected standard uncertainty with all of these circles".to_owned());
        let row = |joint: &ExpectedAnswer| {
            let u = match (joint.backlash_u_deg, joint.backlash_u_mm) {
                (Some(deg), _) => format!("{deg:.6} deg"),
                (None, Some(mm)) => format!("{mm:.6} mm"),
                (None, None) => "-".to_owned(),
            };
            vec![format!("  {}", joint.joint), u]
        };
        lines.extend(columns(
            &last.joints.iter().map(row).collect::<Vec<_>>(),
            &[Align::Left],
        ));
    }
    lines.join("\n")
}

fn proposed_as_text(number: usize, circle: &ProposedAnswer) -> [String; 3] {
    let [x, y, z] = circle.centre_mm;
    let [a, b, c] = circle.rotation_deg;
    let turns: Vec<String> = (circle.reversals.iter())
        .map(|turns| format!("{} {}", turns.joint, turns.times))
        .collect();
    [
        format!(
            "{number:<10} {}, centre ({x:.0}, {y:.0}, {z:.0}) mm, radius {:.0} mm; rotation_deg = [{a:.0}, {b:.0}, {c:.0}]",
            circle.plane, circle.radius_mm
        ),
        format!("{:<10} reversals: {}", "", turns.join(", ")),
        format!("{:<10} {}", "", known_as_text(&circle.known)),
    ]
}

fn known_as_text(known: &IdentifiabilityAnswer) -> String {
    let names: Vec<&str> = known.joints.iter().map(|joint| joint.joint.as_str()).collect();
    let mut parts = vec![match &names[..] {
        [] => "identifies no joint separately".to_owned(),
        names => format!("identifies {}", names.join(", ")),
    }];
    parts.extend(
        known
            .not_identifiable
            .iter()
            .map(|set| format!("not separable {}", set.join(", "))),
    );
    if !known.unseen.is_empty() {
        parts.push(format!("no effect of {}", known.unseen.join(", ")));
    }
    parts.extend(known.inflation_ratio.map(|ratio| format!("inflation {ratio:.1}")));
    parts.join("; ")
}
