//! Settings: the unknowns, the points, the prior knowledge.
//!
//! | group | unknowns |
//! |---|---|
//! | `drives` | the spring of every joint; required |
//! | `bending` | bearings and links: rotations about the axes perpendicular to those of revolute joints |
//! | `base`, `tool` | foundation: rotations about axes of base; holder and tool: translations along axes of the flange |
//! | `lost-motion` | the backlash in the drive of every revolute joint |

use armill_core::identify::effect::Effects;
use armill_core::identify::unknown::{base, bending, drives, lost_motion, tool};
use armill_core::identify::{LoadTest, Points, Prior, Role, Unknown};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{Axis, Robot};
use armill_core::units::to_mm;
use armill_formats::robot::spring_tables::SpringKind;
use armill_study::{StudyError, robot_answers};

/// Settings for load tests.
#[derive(Clone, Debug)]
pub struct Question {
    /// Groups of unknowns with `+` between: `drives+bending+base`.
    pub unknowns: String,
    /// Whether force point and measured point are known.
    pub points: PointsModel,
    /// Standard uncertainty of points that are not known, m.
    pub point_u: f64,
    /// Prior knowledge.
    pub prior: PriorModel,
    /// Point of force and displacement unless given in a test, m, flange frame.
    pub tool_point: Vector3<f64>,
    /// Whether implausible values are refused.
    pub units: Units,
}

/// What is known of the two points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointsModel {
    /// Both, as given.
    Known,
    /// Both are off by one and the same shift.
    Common,
    /// Each with its own offset.
    Separate,
}

/// What is known of the springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PriorModel {
    /// Compliances of robots are within some powers of ten.
    Typical,
    /// Only that none is negative.
    None,
}

/// Whether implausible readings are accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// They are refused.
    Checked,
    /// They are taken.
    Trusted,
}

/// The groups that `unknowns` may name.
pub const GROUPS: [&str; 5] = ["drives", "bending", "base", "tool", "lost-motion"];
/// Share of the largest torque on a joint that takes up its backlash.
const GAP_CLOSES_AT: f64 = 0.05;

impl Question {
    /// The points for the core.
    pub fn points(&self) -> Points {
        match self.points {
            PointsModel::Known => Points::Known,
            PointsModel::Common => Points::Common(self.point_u),
            PointsModel::Separate => Points::Separate(self.point_u),
        }
    }

    /// The prior for the core.
    pub fn prior(&self) -> Prior {
        match self.prior {
            PriorModel::Typical => Prior::Typical,
            PriorModel::None => Prior::None,
        }
    }

    /// The unknowns of the groups, for this robot. Lost motion needs tests: their torques determine how soon a backlash
    /// is taken up.
    ///
    /// # Errors
    /// An unknown group; a list without drives; an implausible uncertainty of the points.
    pub fn unknowns(&self, robot: &Robot, tests: &[LoadTest]) -> Result<Vec<Unknown>, StudyError> {
        within("--point-u-mm", to_mm(self.point_u), POINT_U_MM, "mm")?;
        let groups: Vec<&str> = self.unknowns.split('+').map(str::trim).collect();
        if let Some(unknown) = groups.iter().find(|group| !GROUPS.contains(group)) {
            let message = format!("--unknowns: `{unknown}` is not a group of springs");
            return Err(StudyError::value(
                message,
                format!("one or more of {}, such as drives+bending", GROUPS.join(", ")),
            ));
        }
        if !groups.contains(&"drives") {
            let message = format!("--unknowns {}: drives are missing", self.unknowns);
            return Err(StudyError::value(
                message,
                "drives have the largest compliance: write drives+...",
            ));
        }
        let drives = drives(robot);
        let mut unknowns = drives.clone();
        for (name, group) in [
            ("bending", bending(robot)),
            ("base", base(robot)),
            ("tool", tool()),
        ] {
            if groups.contains(&name) {
                unknowns.extend(group);
            }
        }
        if groups.contains(&"lost-motion") {
            let mut torques = vec![0.0; drives.len()];
            for test in tests {
                for (largest, torque) in torques
                    .iter_mut()
                    .zip(Effects::of(robot, &drives, test).torques())
                {
                    *largest = f64::max(*largest, GAP_CLOSES_AT * torque.abs());
                }
            }
            unknowns.extend(lost_motion(robot, &torques));
        }
        Ok(unknowns)
    }
}

/// Plausible uncertainties of points, mm: squares of far smaller ones are 0.
const POINT_U_MM: [f64; 2] = [1e-3, 1e6];

/// A problem where `value` is outside of these limits.
pub(super) fn within(flag: &str, value: f64, [low, high]: [f64; 2], unit: &str) -> Result<(), StudyError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(StudyError::value(
        format!("{flag}: {value:?} {unit} is not from {low} to {high} {unit}"),
        "is the unit right?",
    ))
}

/// Name of the attachment of an unknown in a robot file.
pub fn attachment_name(robot: &Robot, unknown: &Unknown) -> String {
    robot_answers::attachment_name(robot, unknown.attachment)
}

/// The kind of spring of an unknown, as a robot file states it.
pub fn spring_kind(unknown: &Unknown) -> SpringKind {
    let direction = if unknown.turns() {
        unknown.direction.angular
    } else {
        unknown.direction.linear
    };
    let axis = Axis::ALL[direction.iamax()];
    match (unknown.role, unknown.turns()) {
        (Role::Drive | Role::LostMotion { .. }, true) => SpringKind::Drive,
        (Role::Drive | Role::LostMotion { .. }, false) => SpringKind::PrismaticDrive,
        (_, true) => SpringKind::About(axis),
        (_, false) => SpringKind::Along(axis),
    }
}

/// Name of an unknown in texts: `A2 drive`, `A2 about x`, `A2 lost motion`.
pub fn spring_name(robot: &Robot, unknown: &Unknown) -> String {
    let attachment = attachment_name(robot, unknown);
    match (unknown.role, spring_kind(unknown)) {
        (Role::LostMotion { .. }, _) => format!("{attachment} lost motion"),
        (_, SpringKind::Drive | SpringKind::PrismaticDrive) => format!("{attachment} drive"),
        (_, spring) => spring.name_at(&attachment),
    }
}
