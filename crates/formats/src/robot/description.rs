//! A robot with what the core does not need to know: where its numbers come from.
//!
//! Each format gives one: our own robot file fills all of it, a foreign one has one source for everything and states in
//! `remarks` what it assumed.

use armill_core::clearance::ArmBody;
use armill_core::robot::Robot;

use crate::controller::ControllerTable;
use crate::motion::MotionTable;
use crate::robot::armill::LearntTable;
use crate::sources::Source;

/// A robot and the origin of its numbers.
#[derive(Clone, Debug)]
pub struct RobotDescription {
    /// The robot.
    pub robot: Robot,
    /// Maker's name and type, for people.
    pub title: String,
    /// What a user should know before trusting it.
    pub note: Option<String>,
    /// Its zeros, frames and origin in words.
    pub description: Option<String>,
    /// What its reader assumed or left out, one sentence each; empty for our own robot files.
    pub remarks: Vec<String>,
    /// Payload, kg, if known.
    pub payload_kg: Option<f64>,
    /// How robot programs are written for its cell.
    pub controller: Option<ControllerTable>,
    /// How its controller moves it.
    pub motion: Option<MotionTable>,
    /// What its chain leaves of measured positions; the residual itself is in the structure of the robot.
    pub learnt: Option<LearntTable>,
    /// Symbol of each elementary motion in its source, by index in the chain; empty where it has none.
    pub symbols: Vec<Symbol>,
    /// What else is known of each joint, in the order of the robot's.
    pub joint_notes: Vec<JointNote>,
    /// Bodies of its links.
    pub bodies: Vec<ArmBody>,
    /// What else is known of each of these bodies, in their order; empty where nothing is.
    pub body_notes: Vec<BodyNote>,
    /// Pairs of these bodies that are apart in every posture, by index.
    pub apart: Vec<[usize; 2]>,
    /// Every source, in the order of their keys.
    pub sources: Vec<Source>,
}

/// Name of an elementary motion in its source, such as `lz`.
pub type Symbol = Option<String>;

/// What a robot file says of a joint apart from its numbers.
#[derive(Clone, Debug, Default)]
pub struct JointNote {
    /// Key of the source of sign, limits and speed.
    pub source: Option<String>,
    /// Key of the source of the compliance.
    pub compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty.
    pub compliance_u_source: Option<String>,
    /// Limits by other sources.
    pub other_limits: Vec<OtherLimits>,
}

/// What a robot file says of a body apart from its shape.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyNote {
    /// Largest distance of its surface from the link, mm; `None` if not known.
    pub accuracy_mm: Option<f64>,
    /// Key of the source.
    pub source: String,
}

/// Limits that another source gives for a joint; reported, never enforced.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherLimits {
    /// Lower and upper limit, deg.
    pub limits_deg: [f64; 2],
    /// Key of the source.
    pub source: String,
    /// What to make of them.
    pub note: Option<String>,
}

impl RobotDescription {
    /// A robot read from a foreign file at `place`, which is the one source (`key`) of all its numbers.
    ///
    /// Title is the robot's name; nothing is known of payload and symbols.
    pub(super) fn of_one_source(robot: Robot, key: &str, place: &str, what: &str) -> RobotDescription {
        let note = JointNote {
            source: Some(key.to_owned()),
            ..JointNote::default()
        };
        RobotDescription {
            title: robot.name().to_owned(),
            note: None,
            description: None,
            remarks: Vec::new(),
            payload_kg: None,
            controller: None,
            motion: None,
            learnt: None,
            symbols: vec![None; robot.chain().motions().len()],
            joint_notes: vec![note; robot.joints().len()],
            bodies: Vec::new(),
            body_notes: Vec::new(),
            apart: Vec::new(),
            sources: vec![Source {
                key: key.to_owned(),
                what: what.to_owned(),
                place: place.to_owned(),
                licence: "the user's file".to_owned(),
            }],
            robot,
        }
    }
}
