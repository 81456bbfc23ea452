//! `controller`: how a cell writes its robot programs, in a robot file or a study.

use armill_core::units::from_mm;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::document::{Document, Problem};

/// How robot programs are written for this cell. Values of the study replace those of the robot file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControllerTable {
    /// Number of the user frame on the controller; 1 if left out.
    #[schemars(range(max = 999))]
    pub frame: Option<u32>,
    /// Number of the tool on the controller; 1 if left out.
    #[schemars(range(max = 999))]
    pub tool: Option<u32>,
    /// Name of the user frame, in RAPID and URScript.
    pub frame_name: Option<String>,
    /// Name of the tool, in RAPID.
    pub tool_name: Option<String>,
    /// Mechanical unit of the positioner that a program coordinates: its name in RAPID, `STN1` if left out, or the number of
    /// its MACHINE_DEF in KRL, 2 if left out.
    #[schemars(length(min = 1, max = 32))]
    pub positioner_unit: Option<String>,
    /// Where the values of frame and tool come from: `program` (default) sets them, `controller` has them stored.
    pub data: Option<FrameDataName>,
    /// Home position, one value for each joint, deg (mm for prismatic joints): programs begin and end there, and change
    /// tools and postures there.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub home_deg: Option<Vec<f64>>,
    /// Speed of joint moves relative to the maximum; 10 if left out.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub joint_speed_percent: Option<f64>,
    /// Acceleration of joint moves relative to the maximum; that of the controller if left out.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub joint_acceleration_percent: Option<f64>,
    /// Acceleration of linear moves; that of the controller if left out.
    #[schemars(range(min = 0.001, max = 100.0))]
    // unit: m/s^2
    pub acceleration_m_per_s2: Option<f64>,
    /// Speed of linear moves that do not cut; 100 if left out.
    #[schemars(range(min = 0.1, max = 5000.0))]
    pub rapid_mm_per_s: Option<f64>,
    /// Statements before the first move, in the language of the program.
    #[schemars(length(max = 200))]
    pub header: Option<Vec<String>>,
    /// Statements after the last move.
    #[schemars(length(max = 200))]
    pub footer: Option<Vec<String>>,
    /// Statements that change the tool, with `{tool}`, `{diameter_mm}` and `{operation}`; if left out, the program stops
    /// with a message.
    #[schemars(length(max = 200))]
    pub tool_change: Option<Vec<String>>,
    /// Statements that start the spindle clockwise, with `{rpm}`; if left out, the program stops with a message.
    #[schemars(length(max = 200))]
    pub spindle_on: Option<Vec<String>>,
    /// Statements that start the spindle counter-clockwise, with `{rpm}`.
    #[schemars(length(max = 200))]
    pub spindle_on_counter_clockwise: Option<Vec<String>>,
    /// Statements that stop the spindle.
    #[schemars(length(max = 200))]
    pub spindle_off: Option<Vec<String>>,
    /// Statements that start the coolant; if left out, a comment is written.
    #[schemars(length(max = 200))]
    pub coolant_on: Option<Vec<String>>,
    /// Statements that stop the coolant.
    #[schemars(length(max = 200))]
    pub coolant_off: Option<Vec<String>>,
}

/// Where the values of frame and tool come from when a program runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FrameDataName {
    /// The program sets them.
    Program,
    /// They are stored on the controller.
    Controller,
}

/// Placeholders of the statements of `tool_change`.
const OF_TOOL: [&str; 4] = ["tool", "diameter_mm", "operation", "rpm"];
/// Placeholders of the statements that start the spindle.
const OF_SPINDLE: [&str; 1] = ["rpm"];

/// Speed of linear moves that do not cut, mm/s.
const RAPID_MM_S: f64 = 100.0;

impl ControllerTable {
    /// Speed of linear moves that do not cut, m/s.
    pub fn rapid(&self) -> f64 {
        from_mm(self.rapid_mm_per_s.unwrap_or(RAPID_MM_S))
    }

    /// These values, with those of `other` where this table has none.
    pub fn or(&self, other: &ControllerTable) -> ControllerTable {
        let statements =
            |own: &Option<Vec<String>>, other: &Option<Vec<String>>| own.clone().or_else(|| other.clone());
        ControllerTable {
            frame: self.frame.or(other.frame),
            tool: self.tool.or(other.tool),
            frame_name: self.frame_name.clone().or_else(|| other.frame_name.clone()),
            tool_name: self.tool_name.clone().or_else(|| other.tool_name.clone()),
            data: self.data.or(other.data),
            positioner_unit: self
                .positioner_unit
                .clone()
                .or_else(|| other.positioner_unit.clone()),
            home_deg: self.home_deg.clone().or_else(|| other.home_deg.clone()),
            joint_speed_percent: self.joint_speed_percent.or(other.joint_speed_percent),
            joint_acceleration_percent: self
                .joint_acceleration_percent
                .or(other.joint_acceleration_percent),
            acceleration_m_per_s2: self.acceleration_m_per_s2.or(other.acceleration_m_per_s2),
            rapid_mm_per_s: self.rapid_mm_per_s.or(other.rapid_mm_per_s),
            header: statements(&self.header, &other.header),
            footer: statements(&self.footer, &other.footer),
            tool_change: statements(&self.tool_change, &other.tool_change),
            spindle_on: statements(&self.spindle_on, &other.spindle_on),
            spindle_on_counter_clockwise: statements(
                &self.spindle_on_counter_clockwise,
                &other.spindle_on_counter_clockwise,
            ),
            spindle_off: statements(&self.spindle_off, &other.spindle_off),
            coolant_on: statements(&self.coolant_on, &other.coolant_on),
            coolant_off: statements(&self.coolant_off, &other.coolant_off),
        }
    }

    /// Problems of the table `controller` of this document, for an arm with this number of joints: a home position of
    /// another number, invalid names, statements of several lines, unknown placeholders.
    pub fn problems(&self, document: &Document, joint_count: usize, of_positioner: usize) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut report = |key: &str, message: String, hint: &str| {
            problems.push(document.problem(&format!("controller.{key}"), message, Some(hint)));
        };
        if let Some(home) = &self.home_deg
            && home.len() != joint_count
            && home.len() + of_positioner != joint_count
        {
            let message = format!(
                "`home_deg` has {} values, but the robot has {joint_count} joints",
                home.len()
            );
            report(
                "home_deg",
                message,
                "one value for each joint, in the order of the robot file",
            );
        }
        for (key, name) in [("frame_name", &self.frame_name), ("tool_name", &self.tool_name)] {
            let valid = |name: &str| {
                name.starts_with(|c: char| c.is_ascii_alphabetic())
                    && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
                    && name.len() <= LONGEST_NAME
            };
            if let Some(name) = name.as_ref().filter(|name| !valid(name)) {
                let message = format!("`{name}` is not a valid name on a controller");
                report(
                    key,
                    message,
                    "a letter, then letters, digits and underscores, at most 32 characters",
                );
            }
        }
        for (key, statements, placeholders) in [
            ("header", &self.header, &[][..]),
            ("footer", &self.footer, &[]),
            ("tool_change", &self.tool_change, &OF_TOOL),
            ("spindle_on", &self.spindle_on, &OF_SPINDLE),
            (
                "spindle_on_counter_clockwise",
                &self.spindle_on_counter_clockwise,
                &OF_SPINDLE,
            ),
            ("spindle_off", &self.spindle_off, &[]),
            ("coolant_on", &self.coolant_on, &[]),
            ("coolant_off", &self.coolant_off, &[]),
        ] {
            for (index, statement) in statements.iter().flatten().enumerate() {
                let key = format!("{key}[{index}]");
                if statement.chars().any(char::is_control) {
                    let message = "a statement with a line break or another control character".to_owned();
                    report(&key, message, "one entry for each line of the program");
                }
                for name in placeholders_of(statement) {
                    if KNOWN.contains(&name) && !placeholders.contains(&name) {
                        let message = format!("`{{{name}}}` has no value here");
                        report(
                            &key,
                            message,
                            "`{rpm}` in spindle_on, `{tool}`, `{diameter_mm}`, `{operation}` in tool_change",
                        );
                    }
                }
            }
        }
        problems
    }
}

/// Longest name of a frame or tool.
const LONGEST_NAME: usize = 32;
/// All placeholders. Other words in braces belong to the language, as in KRL.
const KNOWN: [&str; 4] = OF_TOOL;

/// The words in braces of a statement.
fn placeholders_of(statement: &str) -> impl Iterator<Item = &str> {
    statement
        .split('{')
        .skip(1)
        .filter_map(|after| after.split_once('}').map(|(name, _)| name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Document, ControllerTable) {
        #[derive(Deserialize, JsonSchema)]
        struct File {
            controller: ControllerTable,
        }
        let document = Document::from_bytes("cell.toml", text.as_bytes()).unwrap();
        let file: File = document.read().unwrap_or_else(|problems| panic!("{problems}"));
        (document, file.controller)
    }

    fn problems(text: &str) -> Vec<String> {
        let (document, table) = read(text);
        let problems = table.problems(&document, 6, 0);
        problems.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn values_of_the_study_replace_those_of_the_robot_file() {
        let (_, study) = read("[controller]\ntool = 3\nheader = []\n");
        let (_, robot) = read("[controller]\ntool = 1\nframe = 2\nheader = [\"A\"]\nfooter = [\"B\"]\n");
        let both = study.or(&robot);
        assert_eq!((both.tool, both.frame), (Some(3), Some(2)));
        assert_eq!(
            (both.header, both.footer),
            (Some(vec![]), Some(vec!["B".to_owned()]))
        );
    }

    #[test]
    fn every_problem_is_reported_at_its_line() {
        let text = "[controller]\nhome_deg = [0, 0]\ntool_name = \"2nd\"\nspindle_on = [\"A\\nB\", \"S {tool}\"]\n\
                    header = [\"{rpm}\", \"$BASE={X 0}\"]\n";
        let found = problems(text);
        for (problem, part) in found.iter().zip([
            "cell.toml:2:12: `home_deg` has 2 values, but the robot has 6 joints",
            "cell.toml:3:13: `2nd` is not a valid name",
            "cell.toml:5:11: `{rpm}` has no value here",
            "cell.toml:4:15: a statement with a line break",
            "cell.toml:4:23: `{tool}` has no value here",
        ]) {
            assert!(problem.contains(part), "{problem} | {part}");
        }
        assert_eq!(found.len(), 5, "{found:?}");
        assert!(problems("[controller]\nspindle_on = [\"$OUT[1]=TRUE\", \"S{rpm}\"]\n").is_empty());
    }
}
