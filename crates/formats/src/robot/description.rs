//! A robot with what the core does not need to know: where its numbers come from.

use armill_core::robot::Robot;

/// A robot and the origin of its numbers.
#[derive(Clone, Debug)]
pub struct RobotDescription {
    /// The robot.
    pub robot: Robot,
    /// Maker's name and type, for people.
    pub title: String,
    /// What a user should know before trusting it.
    pub note: Option<String>,
    /// Payload, kg, if known.
    pub payload_kg: Option<f64>,
    /// Symbol of each elementary motion in its source, by index in the chain; empty where it has none.
    pub symbols: Vec<Symbol>,
    /// What else is known of each joint.
    pub joints: Vec<JointNote>,
    /// Every source, in the order of the file.
    pub sources: Vec<Source>,
}

/// Name of an elementary motion in its source, such as `lz`.
pub type Symbol = Option<String>;

/// What a robot file says of a joint beside its numbers.
#[derive(Clone, Debug, Default)]
pub struct JointNote {
    /// Key of the source of sign, limits and speed.
    pub source: Option<String>,
    /// Key of the source of the compliance.
    pub compliance_source: Option<String>,
    /// Key of the source of its standard uncertainty.
    pub compliance_u_source: Option<String>,
    /// Limits by other sources: degrees (mm), source key, note.
    pub other_limits: Vec<([f64; 2], String, Option<String>)>,
}

/// Where numbers come from.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Source {
    /// Key inside the file.
    pub key: String,
    /// What was taken.
    pub what: String,
    /// Where it stands.
    #[serde(rename = "where")]
    pub place: String,
    /// Under which licence, or that it is a fact.
    pub licence: String,
}
