//! `armill export`: writes a robot in the format of another program.
//!
//! The file goes to `--out`, or to stdout; with `--json` stdout has an [`ExportedRobotAnswer`]. A xacro has a file of arguments next to it. Stderr
//! reports what the format does not express.

use std::path::{Path, PathBuf};

use armill_formats::robot::RobotDescription;
use armill_formats::robot::export::{
    CoupledJoints, ExportFormat, ExportOptions, Exported, ExportedStiffness,
};
use armill_study::exported_robot::{ExportedRobotAnswer, exported};
use armill_study::joint_unit::JointUnit;
use armill_study::{StudyError, robots};

use super::pose_subject::with_compliances;
use crate::arguments::numbers::finite;
use crate::arguments::{CouplingArgument, ExportArguments, StiffnessArgument};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Writes the robot.
///
/// # Errors
/// No such robot; a robot that the format cannot express; a file that must not be replaced or cannot be written.
pub(crate) fn run(arguments: &ExportArguments) -> Result<Outcome, StudyError> {
    let format = format(arguments)?;
    let mut found = robots::find(&arguments.robot, Path::new("."))?;
    let caution = with_compliances(
        arguments.compliance_rad_per_n_m.as_deref(),
        arguments.compliance_class.as_deref(),
        &mut found,
    )?;
    let poses_file = arguments.out.as_deref().map(arguments_path);
    let options = ExportOptions {
        coupling: arguments.coupling.map(|coupling| match coupling {
            CouplingArgument::Own => CoupledJoints::Own,
            CouplingArgument::Mimic => CoupledJoints::Follower,
        }),
        stiffness: arguments
            .stiffness
            .map_or(ExportedStiffness::None, |stiffness| match stiffness {
                StiffnessArgument::Passive => ExportedStiffness::Passive,
                StiffnessArgument::Joints => ExportedStiffness::Joints,
            }),
        joints: joints(arguments, &found)?,
        convention: arguments.convention.unwrap_or_default(),
        caution: caution.map(|caution| caution.trim_end_matches('.').to_owned()),
        meshes: Vec::new(),
        arguments_file: poses_file
            .as_deref()
            .and_then(Path::file_name)
            .map(|name| name.to_string_lossy().into_owned()),
    };
    let exported = exported(&arguments.robot, &found, format, options)?;
    let files = write(arguments, &exported, poses_file)?;
    if arguments.json {
        let answer = ExportedRobotAnswer::of(&found, format, &exported, files.clone());
        print(&serde_json::to_string(&answer)?)?;
    } else if files.is_empty() {
        print(exported.text.trim_end())?;
    }
    for warning in &exported.warnings {
        say(&format!("warning: {warning}"));
    }
    if !files.is_empty() {
        say(&format!("created {}", files.join(" and ")));
    }
    Ok(Outcome::Fine)
}

/// The format requested, or that of the file to write.
fn format(arguments: &ExportArguments) -> Result<ExportFormat, StudyError> {
    if let Some(format) = arguments.format {
        return Ok(format);
    }
    let names = ExportFormat::ALL.map(ExportFormat::name).join(", ");
    let hint = format!("--format gives it: {names}");
    let Some(out) = &arguments.out else {
        return Err(StudyError::value("the format of the robot is not given", hint));
    };
    let ending = out
        .extension()
        .map(|ending| ending.to_string_lossy().into_owned());
    ending
        .as_deref()
        .and_then(ExportFormat::of_ending)
        .ok_or_else(|| {
            let message = format!(
                "the extension of `{}` is not one of a robot format",
                out.display()
            );
            StudyError::value(message, hint)
        })
}

/// Joint positions, rad (m).
fn joints(arguments: &ExportArguments, found: &RobotDescription) -> Result<Option<Vec<f64>>, StudyError> {
    let Some(given) = &arguments.joints_deg else {
        return Ok(None);
    };
    finite("--joints-deg", given)?;
    let robot = &found.robot;
    let scale = |index: usize| match index < robot.joints().len() {
        true => JointUnit::of(robot, index).scale,
        false => 1.0,
    };
    let joints = given.iter().enumerate();
    Ok(Some(
        joints.map(|(index, position)| position / scale(index)).collect(),
    ))
}

/// The file of arguments that belongs to a xacro: `arm.xacro` has `arm_geometry.yaml`.
fn arguments_path(out: &Path) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.trim_end_matches(".xacro").trim_end_matches(".urdf");
    out.with_file_name(format!("{stem}_geometry.yaml"))
}

/// Writes the files, and gives their names.
fn write(
    arguments: &ExportArguments,
    exported: &Exported,
    poses_file: Option<PathBuf>,
) -> Result<Vec<String>, StudyError> {
    let (Some(out), Some(poses_file)) = (&arguments.out, poses_file) else {
        if exported.arguments.is_some() && !arguments.json {
            let message = "a xacro has two files, which cannot be printed as one";
            return Err(StudyError::value(message, "--out FILE names the first one"));
        }
        return Ok(Vec::new());
    };
    let writer = arguments.writing.writer("export").for_new_files();
    let mut files = vec![(out.clone(), exported.text.as_bytes())];
    if let Some(text) = &exported.arguments {
        // First, so that the file that names it is never without it.
        files.insert(0, (poses_file, text.as_bytes()));
    }
    writer.write_all(&files)?;
    Ok(files
        .iter()
        .rev()
        .map(|(path, _)| path.display().to_string())
        .collect())
}
