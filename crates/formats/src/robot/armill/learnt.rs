//! The learnt residual of a robot file: settings in the table `[learnt]`, residuals in a file of its folder.
//!
//! ```text
//! [learnt]      file = "arm-residuals.csv", sha256, axes, length_scales_deg, scatter, source
//! q1_deg,...,q6_deg,residual_x_mm,residual_y_mm,residual_z_mm          measured minus modelled position, axes of the base
//! ```
//!
//! The file of residuals belongs to the robot file: with another checksum the robot is refused.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use armill_core::calibrate::MeasuredPose;
use armill_core::robot::Robot;
use armill_core::robot::learnt::{Learnt, LearntAxes, LearntSettings, ResidualAt};
use armill_core::units::{from_deg, from_mm, to_deg, to_mm};
use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

use super::checks::Checks;
use super::file::RobotFile;
use super::identified::set_sources;
use super::learnt_table::{LearntAxesWord, LearntTable};
use crate::document::{Document, Problems};
use crate::file::sum_of;
use crate::input;
use crate::measurement::poses::{self, Mapping, PoseReadOptions};
use crate::robot::description::RobotDescription;

/// Key of the source.
const KEY: &str = "learnt";

impl LearntAxesWord {
    /// The word in a file.
    fn word(self) -> &'static str {
        match self {
            LearntAxesWord::Base => "base",
            LearntAxesWord::FirstJoint => "first-joint",
        }
    }

    fn axes(self) -> LearntAxes {
        match self {
            LearntAxesWord::Base => LearntAxes::Base,
            LearntAxesWord::FirstJoint => LearntAxes::FirstJoint,
        }
    }
}

impl LearntTable {
    /// The table of settings that were learnt, with the residuals in `file`, whose text is `residuals`.
    pub fn of(robot: &Robot, settings: &LearntSettings, file: &str, residuals: &str) -> LearntTable {
        let scale = |(joint, length): (usize, &f64)| match robot.slides(joint) {
            true => to_mm(*length),
            false => to_deg(*length),
        };
        LearntTable {
            file: file.to_owned(),
            sha256: sum_of(residuals.as_bytes()),
            axes: match settings.axes {
                LearntAxes::Base => LearntAxesWord::Base,
                LearntAxes::FirstJoint => LearntAxesWord::FirstJoint,
            },
            length_scales_deg: settings.lengths.iter().enumerate().map(scale).collect(),
            scatter: settings.noise,
            source: KEY.to_owned(),
        }
    }

    fn settings(&self, robot: &Robot) -> LearntSettings {
        let length = |(joint, scale): (usize, &f64)| match robot.slides(joint) {
            true => from_mm(*scale),
            false => from_deg(*scale),
        };
        LearntSettings {
            lengths: self.length_scales_deg.iter().enumerate().map(length).collect(),
            noise: self.scatter,
            axes: self.axes.axes(),
        }
    }
}

impl Checks<'_> {
    /// What no schema says of `[learnt]`.
    pub(super) fn learnt(&mut self, file: &RobotFile) {
        let Some(table) = &file.learnt else { return };
        let (given, joints) = (table.length_scales_deg.len(), file.joint.len());
        if given != joints {
            let message = format!("{given} length scales for {joints} joints");
            self.problem(
                "learnt.length_scales_deg",
                message,
                "one for each joint, base to flange",
            );
        }
        if Path::new(&table.file)
            .file_name()
            .is_none_or(|name| name != table.file.as_str())
        {
            let message = format!(
                "`{}` is not the name of a file in the folder of the robot file",
                table.file
            );
            self.problem(
                "learnt.file",
                message,
                "a name without folders, such as \"arm-residuals.csv\"",
            );
        }
    }
}

/// `found`, the robot of the file at `path` with this text, with the residual that its table `[learnt]` names.
///
/// # Errors
/// A file of residuals that cannot be read, is another one than was learnt from, or does not belong to this robot.
pub(in crate::robot) fn with_residuals_of_its_file(
    mut found: RobotDescription,
    path: &Path,
    text: &str,
) -> Result<RobotDescription, Problems> {
    let Some(table) = &found.learnt else {
        return Ok(found);
    };
    let document = Document::parse(&path.display().to_string(), text)?;
    let problem = |key: &str, message: String, hint: &str| {
        Problems::from(document.problem(&format!("learnt.{key}"), message, Some(hint)))
    };
    let place = path.parent().unwrap_or(Path::new("")).join(&table.file);
    let shown = place.display().to_string();
    let bytes = input::read(&place).map_err(|error| {
        let hint = "the file of residuals belongs into the folder of the robot file; or remove [learnt]";
        problem("file", format!("cannot read {shown}: {error}"), hint)
    })?;
    if sum_of(&bytes) != table.sha256 {
        let message = format!("{shown} is not the file that was learnt from: its checksum differs");
        return Err(problem("sha256", message, "learn again, or restore the file"));
    }
    let residuals = poses::read(&shown, &bytes[..], &found.robot, &columns())?;
    let at = |pose: &MeasuredPose| ResidualAt {
        joints: pose.joints.clone(),
        residual: pose.position,
    };
    let all: Vec<ResidualAt> = residuals.poses.iter().map(at).collect();
    let refused = |error: String| problem("file", format!("{shown}: {error}"), "learn again");
    let learnt = Learnt::new(&found.robot, &all, table.settings(&found.robot));
    let mut structure = found.robot.structure().clone();
    structure.learnt = Some(Arc::new(learnt.map_err(|error| refused(error.to_string()))?));
    found.robot = found
        .robot
        .with_structure(structure)
        .map_err(|error| refused(error.to_string()))?;
    Ok(found)
}

/// The columns of a file of residuals.
fn columns() -> PoseReadOptions {
    let column = |axis: &str| Mapping {
        ours: format!("{axis}_mm"),
        theirs: format!("residual_{axis}_mm"),
    };
    PoseReadOptions {
        columns: ["x", "y", "z"].map(column).to_vec(),
        ..PoseReadOptions::default()
    }
}

/// The file of these residuals of `robot`.
pub fn residuals_file(robot: &Robot, residuals: &[ResidualAt]) -> String {
    let joints = 0..robot.joints().len();
    let unit = |joint: usize| if robot.slides(joint) { "mm" } else { "deg" };
    let mut text: String = joints
        .clone()
        .map(|joint| format!("q{}_{},", joint + 1, unit(joint)))
        .collect();
    text.push_str("residual_x_mm,residual_y_mm,residual_z_mm\n");
    for at in residuals {
        for joint in joints.clone() {
            let q = at.joints[joint];
            let q = if robot.slides(joint) { to_mm(q) } else { to_deg(q) };
            let _ = write!(text, "{q:.7},");
        }
        let [x, y, z] = at.residual.map(to_mm).into();
        let _ = writeln!(text, "{x:.6},{y:.6},{z:.6}");
    }
    text
}

/// The robot file `text` (at `path`) with this learnt residual; `what` and `place` say what it was learnt from. A residual that
/// it had is replaced.
///
/// # Errors
/// A text that is not TOML, or no robot file with this table.
pub fn with_residual(
    path: &str,
    text: &str,
    table: &LearntTable,
    [what, place]: [&str; 2],
) -> Result<String, Problems> {
    let checked = Document::parse(path, text)?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    let scales: Array = table
        .length_scales_deg
        .iter()
        .map(|scale| Value::from(rounded(*scale)))
        .collect();
    let mut entry = Table::new();
    for (key, content) in [
        ("file", value(&table.file)),
        ("sha256", value(&table.sha256)),
        ("axes", value(table.axes.word())),
        ("length_scales_deg", value(scales)),
        ("scatter", value(rounded(table.scatter))),
        ("source", value(KEY)),
    ] {
        entry.insert(key, content);
    }
    document.insert("learnt", Item::Table(entry));
    set_sources(&mut document, KEY, [what, place])?;
    let text = document.to_string();
    super::read(&format!("{path} (with a learnt residual)"), "", &text)?;
    Ok(text)
}

/// Six significant digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests;
