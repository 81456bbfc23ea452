//! Comparison of a robot file with its pendant: the differences, in terms of the file.
//!
//! | verdict | meaning |
//! |---|---|
//! | `agrees` | every reading is within the bound of the pose computed from its joints |
//! | `explained` | one explanation is simpler than any other for which all readings are within the bound |
//! | `undecided` | several are equally simple: more readings are needed |
//! | `unexplained` | none of the searched changes explains the readings |
//!
//! The changes that are searched, and their order, are in `armill_core::robot::convention`.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::convention::{
    Change, Comparison, Explanation, NotInspected, PoseDifference, Reading, Verdict, inspect,
};
use armill_core::units::{from_deg, from_mm, to_deg, to_mm};
use armill_core::watch::Watch;
use armill_formats::robot::RobotDescription;
use serde::Serialize;

use crate::error::StudyError;
use crate::number::decimals;
use crate::{BASE_LINK, base_from_reference};

/// What was read, and how.
#[derive(Clone, Debug)]
pub struct PendantQuestion {
    /// Joint positions as shown, deg (mm for prismatic joints), and the pose shown with them, m.
    pub readings: Vec<(Vec<f64>, Isometry)>,
    /// Flange to tool centre point that the pendant had active.
    pub flange_from_tool: Isometry,
    /// Frame to which the readings are expected to be relative.
    pub base: String,
    /// Distance and angle within which a reading agrees, m and rad.
    pub within: PoseDifference,
}

/// Result of the comparison.
#[derive(Clone, Debug, Serialize)]
pub struct PendantAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Frame to which the readings are expected to be relative.
    pub base: String,
    /// Distance of each reading from the pose computed from its joints.
    pub readings: Vec<ApartAnswer>,
    /// `agrees`, `explained`, `undecided` or `unexplained`.
    pub verdict: &'static str,
    /// Each explanation as a list of changes; one unless undecided.
    pub explanations: Vec<ExplanationAnswer>,
    /// Changes that these readings would not show.
    pub unseen: Vec<String>,
}

/// Distance of two poses.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ApartAnswer {
    /// Distance.
    pub apart_mm: f64,
    /// Angle.
    pub apart_deg: f64,
}

/// Changes of the file that explain the readings.
#[derive(Clone, Debug, Serialize)]
pub struct ExplanationAnswer {
    /// Each change as text.
    pub changes: Vec<String>,
    /// Greatest distance of the readings then.
    pub apart: ApartAnswer,
}

/// Compares the readings with the file.
///
/// # Errors
/// No reading, a reading with another number of joints, an unknown frame, more revolute joints than can be searched;
/// cancelled by the watch.
pub fn check(
    described: &RobotDescription,
    question: &PendantQuestion,
    watch: Watch<'_>,
) -> Result<PendantAnswer, StudyError> {
    let robot = &described.robot;
    let counted = base_from_reference(robot, &question.base).map_err(|known| {
        StudyError::value(
            format!("`{}` has no frame `{}`", robot.name(), question.base),
            format!("it knows {known}"),
        )
    })?;
    let readings: Vec<Reading> = question
        .readings
        .iter()
        .enumerate()
        .map(|(index, (joints, pose))| reading(robot, index, joints, pose))
        .collect::<Result<_, _>>()?;
    if readings.is_empty() {
        return Err(StudyError::value(
            "no reading to compare",
            "give some with --pose",
        ));
    }
    let comparison = Comparison {
        robot,
        base_from_reference: &counted,
        flange_from_tool: &question.flange_from_tool,
        readings: &readings,
        within: question.within,
    };
    let found = inspect(&comparison, watch).map_err(|not| match not {
        NotInspected::Cancelled(cancelled) => StudyError::Cancelled(cancelled),
        NotInspected::TooManyJoints { .. } => {
            StudyError::value(not.to_string(), "compare the robot without its external axes")
        }
    })?;
    let words = Words {
        robot,
        counted: &counted,
        base: &question.base,
        within: question.within,
    };
    let (verdict, explanations, unseen) = match &found.verdict {
        Verdict::Explained { explanation, unseen } => {
            // An explanation without changes means that the file is right.
            let verdict = if explanation.changes.is_empty() {
                "agrees"
            } else {
                "explained"
            };
            (verdict, vec![explanation.clone()], unseen.clone())
        }
        Verdict::Undecided(explanations) => ("undecided", explanations.clone(), Vec::new()),
        Verdict::Unexplained => ("unexplained", Vec::new(), Vec::new()),
    };
    Ok(PendantAnswer {
        robot: robot.name().to_owned(),
        base: question.base.clone(),
        readings: found.of_the_file.iter().copied().map(apart).collect(),
        verdict,
        explanations: explanations.iter().map(|e| words.explanation(e)).collect(),
        unseen: unseen.iter().map(|change| words.change(change)).collect(),
    })
}

/// One reading in SI; `index` counts from 0, errors from 1.
fn reading(robot: &Robot, index: usize, joints: &[f64], pose: &Isometry) -> Result<Reading, StudyError> {
    let names: Vec<&str> = robot.joints().iter().map(|joint| joint.name.as_str()).collect();
    if joints.len() != names.len() {
        let message = format!(
            "reading {}: {} joint positions for the {} joints of `{}`",
            index + 1,
            joints.len(),
            names.len(),
            robot.name()
        );
        return Err(StudyError::value(
            message,
            format!("one each for {}", names.join(", ")),
        ));
    }
    let to_si = |(i, value): (usize, &f64)| {
        if robot.slides(i) {
            from_mm(value)
        } else {
            from_deg(value)
        }
    };
    Ok(Reading {
        joints: joints.iter().enumerate().map(to_si).collect(),
        reference_from_tool: *pose,
    })
}

/// In mm and deg.
fn apart(apart: PoseDifference) -> ApartAnswer {
    ApartAnswer {
        apart_mm: to_mm(apart.metres),
        apart_deg: to_deg(apart.radians),
    }
}

/// Changes in terms of the robot file.
struct Words<'a> {
    robot: &'a Robot,
    counted: &'a Isometry,
    base: &'a str,
    within: PoseDifference,
}

impl Words<'_> {
    /// One explanation, each change in a sentence.
    fn explanation(&self, explanation: &Explanation) -> ExplanationAnswer {
        ExplanationAnswer {
            changes: explanation.changes.iter().map(|c| self.change(c)).collect(),
            apart: apart(explanation.apart),
        }
    }

    /// The required change, with the keys of the file.
    fn change(&self, change: &Change) -> String {
        let joints = self.robot.joints();
        match *change {
            Change::Sign { joint } => {
                let sign = joints[joint].sign.factor();
                format!(
                    "joint {} has the opposite sign: sign = {} in place of {sign}",
                    joints[joint].name, -sign
                )
            }
            Change::Zero { joint, by, .. } => {
                let before = joints[joint].zero_offset;
                format!(
                    "joint {} has another zero: zero_offset_deg = {} in place of {}",
                    joints[joint].name,
                    degrees(before + by),
                    degrees(before)
                )
            }
            Change::Coupling { joint, other, factor } => self.coupling(joint, other, factor),
            Change::BaseHeight { by } => {
                let at = self.counted.translation.vector + self.counted.rotation * Vector3::new(0.0, 0.0, by);
                format!(
                    "the base of the pendant is {:.2} mm above {}{}",
                    to_mm(by),
                    self.base,
                    self.frame_at(&at)
                )
            }
            Change::BaseShift { by } => {
                let [x, y, z]: [f64; 3] = to_mm(by).into();
                format!(
                    "the base of the pendant is at ({x:.2}, {y:.2}, {z:.2}) mm of {}",
                    self.base
                )
            }
            Change::FlangeTurn { turn } => {
                let [rx, ry, rz]: [f64; 3] = fixed_angles(&turn).into();
                format!(
                    "the flange frame of the pendant is rotated relative to that of the file: end the chain with about z {}, about y {}, about x {} deg",
                    degrees(rz),
                    degrees(ry),
                    degrees(rx)
                )
            }
            Change::Inches => "positions were read in inches, not in mm".to_owned(),
        }
    }

    /// The required coupling of `joint` to `other`, which is `more` than it is now.
    fn coupling(&self, joint: usize, other: usize, more: f64) -> String {
        let joints = self.robot.joints();
        let (name, other_name) = (&joints[joint].name, &joints[other].name);
        let before: f64 = joints[joint]
            .coupling
            .iter()
            .filter(|c| c.joint == other)
            .map(|c| c.factor)
            .sum();
        let factor = before + more;
        if factor == 0.0 {
            format!("joint {name} is not coupled to {other_name}: remove its coupling")
        } else {
            format!(
                "joint {name} is coupled to {other_name}: coupling = [{{ joint = \"{other_name}\", factor = {factor} }}]"
            )
        }
    }

    /// The frame of the robot at this point of base, if there is one.
    fn frame_at(&self, point: &Vector3<f64>) -> String {
        let named = self
            .robot
            .frames()
            .iter()
            .map(|frame| (frame.name.as_str(), frame.base_from_frame.translation.vector))
            .chain([(BASE_LINK, Vector3::zeros())]);
        let mut here = named.filter(|(_, at)| (at - point).norm() <= self.within.metres);
        here.next()
            .map_or_else(String::new, |(name, _)| format!(", its frame `{name}`"))
    }
}

/// Degrees in -180 to 180 with the digits that a pendant shows.
fn degrees(radians: f64) -> f64 {
    let turned = decimals(to_deg(radians), 3);
    turned - 360.0 * ((turned - 180.0) / 360.0).ceil()
}
