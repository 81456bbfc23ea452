//! `armill learn`: what the calibrated chain leaves of measured poses.
//!
//! ```text
//! robot: file, poses
//! held out         mean   rms   95 %   max       nominal, calibrated, learnt; the same of another file
//! residual         standard deviation, scatter, length scale of each joint
//! ```

use std::path::Path;

use armill_core::calibrate::{ParameterSet, Prior};
use armill_core::learn::OtherSetUp;
use armill_core::units::{from_deg, from_mm};
use armill_measure::calibrate::read;
use armill_measure::learn::answer::{LengthsAnswer, ModelsAnswer};
use armill_measure::learn::{LearnAnswer, OtherPoses, Question, answer, drawing, learn, robot_file};
use armill_study::{StudyError, robots};

use super::poses::question;
use crate::arguments::numbers::above_zero;
use crate::arguments::{LearnArguments, LearnUnknownsArgument};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Reads, learns, writes the requested files and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of a file; poses that determine too little; a residual that does not carry to
/// other poses; a file that cannot be written.
pub(crate) fn run(arguments: &LearnArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let requested = match arguments.unknowns {
        LearnUnknownsArgument::Geometry => ParameterSet::Geometry,
        LearnUnknownsArgument::Zeros => ParameterSet::Zeros,
        LearnUnknownsArgument::None => ParameterSet::BaseAndTool,
    };
    let (mut calibration, given) = question(&arguments.poses, requested)?;
    calibration.prior = Some(Prior {
        length: from_mm(above_zero("--prior-mm", arguments.prior_mm)?),
        angle: from_deg(above_zero("--prior-deg", arguments.prior_deg)?),
    });
    let question = Question {
        calibration,
        stretches: arguments.stretches,
        other: arguments.other.as_ref().map(|path| OtherPoses {
            path: path.clone(),
            given: given.clone(),
            set_up: match arguments.same_point {
                true => OtherSetUp::Base,
                false => OtherSetUp::BaseAndPoint,
            },
        }),
    };
    let shown = arguments.poses_file.display().to_string();
    let robot = &found.robot;
    let measured = read(
        &shown,
        &arguments.poses_file,
        robot,
        &given,
        &question.calibration,
    )?;
    let progress = Progress::of("poses", measured.poses.len());
    let learning = progress.watch(|watch| learn(robot, &shown, &measured, &question, watch))?;
    let answer = answer(robot, &learning, &question);
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    let writer = arguments.writing.writer("learn");
    if let Some(file) = &arguments.out {
        let [path, text] = robots::text_of(&arguments.robot, &found)?;
        let residuals = residuals_path(file);
        let name = residuals
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        let [written, content] = robot_file(
            robot,
            [&path, &text],
            &name.unwrap_or_default(),
            &learning,
            &question,
        )?;
        let files = [
            (residuals.clone(), content.as_bytes()),
            (file.clone(), written.as_bytes()),
        ];
        writer.clone().for_new_files().write_all(&files)?;
        say(&format!(
            "robot with the learnt residual in {}, its residuals in {}",
            file.display(),
            residuals.display()
        ));
    }
    if let Some(file) = &arguments.drawing {
        super::drawing::write(&writer, file, &drawing(&answer, &learning))?;
    }
    Ok(Outcome::Fine)
}

/// The file of residuals of a robot file.
fn residuals_path(robot: &Path) -> std::path::PathBuf {
    let stem = robot.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    robot.with_file_name(format!("{}-residuals.csv", stem.unwrap_or_default()))
}

fn as_text(answer: &LearnAnswer) -> String {
    let mut lines = vec![format!(
        "{}: {}, {} poses",
        answer.robot, answer.file, answer.poses
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    let mut set = |name: &str, errors: &ModelsAnswer| {
        lines.push(String::new());
        lines.push(format!(
            "{name:<34} {:>8} {:>8} {:>8} {:>8}",
            "mean mm", "rms mm", "95 % mm", "max mm"
        ));
        let models = [
            ("nominal", &errors.nominal),
            ("calibrated", &errors.calibrated),
            ("calibrated and learnt", &errors.learnt),
        ];
        lines.extend(models.map(|(model, errors)| errors_text(model, errors)));
        lines.push(format!(
            "{:.1} % of the errors are within the 95 % intervals of the last",
            errors.coverage_percent
        ));
    };
    set(
        &format!("held out in {} stretches", answer.stretches),
        &answer.held_out,
    );
    if let Some(other) = &answer.other {
        set(&format!("{}, {} poses", other.file, other.poses), &other.errors);
    }
    let residual = &answer.residual;
    let three = |[a, b, c]: [f64; 3]| format!("({a:.1}, {b:.1}, {c:.1})");
    lines.push(String::new());
    lines.push(format!(
        "residual         {} um along the axes of the {}; scatter {} um",
        three(residual.deviation_um),
        residual.axes,
        three(residual.scatter_um)
    ));
    lines.extend(residual.length_scales.iter().map(|scale| {
        let length = match (scale.length_scale_deg, scale.length_scale_mm) {
            (Some(deg), _) => format!("{deg:>8.1} deg"),
            (_, mm) => format!("{:>8.1} mm", mm.unwrap_or_default()),
        };
        format!("length scale     {:<6} {length}", scale.joint)
    }));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

fn errors_text(model: &str, errors: &LengthsAnswer) -> String {
    format!(
        "{model:<34} {:>8.3} {:>8.3} {:>8.3} {:>8.3}",
        errors.mean_mm, errors.rms_mm, errors.p95_mm, errors.max_mm
    )
}
