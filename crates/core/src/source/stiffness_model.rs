//! Which parts of the stiffness model are on, and the arm that they are on for.
//!
//! The simple model: every joint yields about its own axis, and nothing else does. Everything beyond is a part that is
//! there or not; without it the same numbers come out, to the last bit.

use nalgebra::Vector3;

use crate::frame::Isometry;
use crate::robot::{Joint, JointCompliance, Robot, Seat, Structure};

/// Standard acceleration of free fall, m/s^2: 3rd CGPM 1901, ISO 80000-3.
pub const FREE_FALL: f64 = 9.806_65;

/// Gravity, and the pose where the tool was set: what the arm sags there does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// Acceleration, m/s^2, base; points down.
    pub acceleration: Vector3<f64>,
    /// Joint positions where the tool was set, rad (m), the controller's counting.
    pub reference: Vec<f64>,
}

/// The parts of the stiffness model beside the drive springs.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessModel {
    /// What yields and weighs, tool and payload included.
    pub structure: Structure,
    /// Gravity; `None` leaves it out, whatever the masses.
    pub gravity: Option<Gravity>,
    /// Whether the load acts on the arm as it has yielded, instead of as it stood.
    pub load_dependent: bool,
}

impl StiffnessModel {
    /// Drive springs and nothing else.
    pub const DRIVES: &'static StiffnessModel = &StiffnessModel {
        structure: Structure::EMPTY,
        gravity: None,
        load_dependent: false,
    };

    /// Whether drive springs alone make the deviation, each with an uncertainty of its own.
    pub fn is_drives_alone(&self) -> bool {
        let s = &self.structure;
        let curved = s.curves.iter().any(Option::is_some);
        let plain = s.springs.is_empty() && s.compensator.is_none() && s.covariance.is_none() && !curved;
        plain && !self.load_dependent && (self.gravity.is_none() || s.masses.is_empty())
    }

    /// Whether the deviation under a wrench `w` is `C w + g` in one posture: no joint stiffens with its torque, and the
    /// load does not change the arm that it acts on.
    pub fn is_affine(&self) -> bool {
        !self.load_dependent && self.structure.curves.iter().all(Option::is_none)
    }

    /// What the deviation is shared out to: every joint, then base, flange and tool where springs sit.
    pub fn sharers(&self, joints: usize) -> Vec<Seat> {
        let others = [Seat::Base, Seat::Flange, Seat::Tool];
        let sits = |seat: &Seat| self.structure.springs.iter().any(|spring| spring.seat == *seat);
        (0..joints)
            .map(Seat::Joint)
            .chain(others.into_iter().filter(sits))
            .collect()
    }

    /// Names of [`StiffnessModel::sharers`]: joints as their maker calls them, then `base`, `flange`, `tool`.
    pub fn sharer_names(&self, joints: &[Joint]) -> Vec<String> {
        let name = |seat: Seat| match seat {
            Seat::Joint(index) => joints[index].name.clone(),
            Seat::Base => "base".to_owned(),
            Seat::Flange => "flange".to_owned(),
            Seat::Tool => "tool".to_owned(),
        };
        self.sharers(joints.len()).into_iter().map(name).collect()
    }
}

/// An arm that holds a tool, with all that yields and weighs in it.
#[derive(Clone, Copy, Debug)]
pub struct Arm<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Compliance of each of its joints.
    pub compliance: &'a [JointCompliance],
    /// What else is on.
    pub model: &'a StiffnessModel,
    /// Flange to tool centre point.
    pub flange_from_tool: &'a Isometry,
}

impl Arm<'_> {
    /// Compliances of all drives, then of all springs.
    pub fn compliances(&self) -> Vec<JointCompliance> {
        let springs = self
            .model
            .structure
            .springs
            .iter()
            .map(|spring| spring.compliance);
        self.compliance.iter().copied().chain(springs).collect()
    }

    /// Where each drive, then each spring sits.
    pub(super) fn seats(&self) -> Vec<Seat> {
        let springs = self.model.structure.springs.iter().map(|spring| spring.seat);
        (0..self.robot.joints().len())
            .map(Seat::Joint)
            .chain(springs)
            .collect()
    }
}
