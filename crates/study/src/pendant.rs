//! A robot file beside its pendant: what disagrees, in the words of the file.
//!
//! | verdict | meaning |
//! |---|---|
//! | `agrees` | every reading lies within the bound of what the file makes of its joints |
//! | `explained` | one explanation is simpler than any other that brings all readings within it |
//! | `undecided` | several are equally simple: more readings tell them apart |
//! | `unexplained` | no change that is looked for explains the readings |
//!
//! What is looked for, and how simple it is, says `armill_core::robot::convention`.

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::convention::{
    Apart, Change, Comparison, Explanation, NotInspected, Reading, Verdict, inspect,
};
use armill_core::watch::Watch;
use armill_formats::robot::RobotDescription;
use serde::Serialize;

use crate::error::StudyError;
use crate::{BASE_LINK, base_from_reference};

/// What was read, and how.
#[derive(Clone, Debug)]
pub struct PendantQuestion {
    /// Joint positions as shown, deg (mm for sliding joints), and the pose beside them, m.
    pub readings: Vec<(Vec<f64>, Isometry)>,
    /// Flange to tool centre point that the pendant had active.
    pub flange_from_tool: Isometry,
    /// Frame that the pendant is believed to count from.
    pub base: String,
    /// Distance and angle within which a reading agrees, m and rad.
    pub within: Apart,
}

/// What the readings say of the file.
#[derive(Clone, Debug, Serialize)]
pub struct PendantAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Frame that the pendant is believed to count from.
    pub base: String,
    /// How far each reading lies from what the file makes of its joints.
    pub readings: Vec<ApartAnswer>,
    /// `agrees`, `explained`, `undecided` or `unexplained`.
    pub verdict: &'static str,
    /// Each explanation as a list of changes; one unless undecided.
    pub explanations: Vec<ExplanationAnswer>,
    /// Changes that would not show in these readings.
    pub unseen: Vec<String>,
}

/// How far two poses lie apart.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ApartAnswer {
    /// Distance.
    pub apart_mm: f64,
    /// Angle.
    pub apart_deg: f64,
}

/// What the file would have to say otherwise.
#[derive(Clone, Debug, Serialize)]
pub struct ExplanationAnswer {
    /// Each change in words.
    pub changes: Vec<String>,
    /// How far the readings then lie away at the most.
    pub apart: ApartAnswer,
}

/// Compares the readings with the file.
///
/// # Errors
/// No reading, a reading with another number of joints, an unknown frame, more turning joints than can be searched;
/// cancelled by the watch.
pub fn check(
    described: &RobotDescription,
    question: &PendantQuestion,
    watch: Watch<'_>,
) -> Result<PendantAnswer, StudyError> {
    let robot = &described.robot;
    let counted = base_from_reference(robot, &question.base).map_err(|known| {
        StudyError::value(
            format!("`{}` is no frame of `{}`", question.base, robot.name()),
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
            StudyError::value(not.to_string(), "compare the arm without what carries it")
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
            // An explanation without changes says that the file is right.
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
        readings: found.as_the_file_has_it.iter().copied().map(apart).collect(),
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
            value * 1e-3
        } else {
            value.to_radians()
        }
    };
    Ok(Reading {
        joints: joints.iter().enumerate().map(to_si).collect(),
        reference_from_tool: *pose,
    })
}

/// In mm and deg.
fn apart(apart: Apart) -> ApartAnswer {
    ApartAnswer {
        apart_mm: apart.metres * 1e3,
        apart_deg: apart.radians.to_degrees(),
    }
}

/// Changes in the words of the robot file.
struct Words<'a> {
    robot: &'a Robot,
    counted: &'a Isometry,
    base: &'a str,
    within: Apart,
}

impl Words<'_> {
    /// One explanation, each change in a sentence.
    fn explanation(&self, explanation: &Explanation) -> ExplanationAnswer {
        ExplanationAnswer {
            changes: explanation.changes.iter().map(|c| self.change(c)).collect(),
            apart: apart(explanation.apart),
        }
    }

    /// What the file would have to say, with the keys of the file.
    fn change(&self, change: &Change) -> String {
        let joints = self.robot.joints();
        match *change {
            Change::Sign { joint } => {
                let sign = joints[joint].sign.factor();
                format!(
                    "joint {} counts the other way: sign = {} in place of {sign}",
                    joints[joint].name, -sign
                )
            }
            Change::Zero { joint, by, .. } => {
                let before = joints[joint].zero_offset;
                format!(
                    "joint {} has its zero elsewhere: zero_offset_deg = {} in place of {}",
                    joints[joint].name,
                    degrees(before + by),
                    degrees(before)
                )
            }
            Change::Coupling { joint, other, factor } => self.coupling(joint, other, factor),
            Change::BaseHeight { by } => {
                let at = self.counted.translation.vector + self.counted.rotation * Vector3::new(0.0, 0.0, by);
                format!(
                    "the pendant counts from a base {:.2} mm above {}{}",
                    by * 1e3,
                    self.base,
                    self.frame_at(&at)
                )
            }
            Change::BaseShift { by } => {
                let [x, y, z]: [f64; 3] = (by * 1e3).into();
                format!(
                    "the pendant counts from a base at ({x:.2}, {y:.2}, {z:.2}) mm of {}",
                    self.base
                )
            }
            Change::FlangeTurn { turn } => {
                let [rx, ry, rz]: [f64; 3] = fixed_angles(&turn).into();
                format!(
                    "the pendant's flange frame is turned against the file's: end the chain with about z {}, about y {}, about x {} deg",
                    degrees(rz),
                    degrees(ry),
                    degrees(rx)
                )
            }
            Change::Inches => "positions were read in inches, not in mm".to_owned(),
        }
    }

    /// What the file would have to say of the coupling of `joint` to `other`, which is `more` than it has now.
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
            format!("joint {name} does not count {other_name} in: take out its coupling")
        } else {
            format!(
                "joint {name} counts {other_name} in: coupling = [{{ joint = \"{other_name}\", factor = {factor} }}]"
            )
        }
    }

    /// The frame of the robot that lies at this point of base, if one does.
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
    let turned = (radians.to_degrees() * 1e3).round() / 1e3;
    turned - 360.0 * ((turned - 180.0) / 360.0).ceil()
}
