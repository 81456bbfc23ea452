//! A column: every posture of some poses, and whether each can be used.

use std::ops::Range;

use nalgebra::Vector3;

use crate::clearance::ClearanceCheck;
use crate::robot::Robot;
use crate::spatial::Wrench;

/// Number of postures stored for a pose. Of arms without branch names, the first postures found are stored.
pub const SLOTS: usize = 8;

/// The load, and the component of the deviation.
#[derive(Clone, Copy, Debug)]
pub struct ColumnLoad<'a> {
    /// Wrenches on the tool at the TCP, base; at least one.
    pub cases: &'a [Wrench],
    /// Directions of the component of the deviation, base; of length 1, or 0 where one is enough.
    pub along: [Vector3<f64>; 2],
}

/// Whether a posture can be used at a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum PostureStatus {
    /// Inside its limits, away from singularities.
    Usable,
    /// A joint is outside its limits.
    OutsideLimits,
    /// The angle between axes 4 and 6 is below the limit, or the arm is near another singularity.
    Singular,
    /// The arm has no stable equilibrium under the load.
    Unstable,
    /// Two bodies are nearer to each other than demanded.
    InCollision,
    /// The pose is out of reach in this posture.
    #[default]
    OutOfReach,
}

impl PostureStatus {
    /// All, the usable one first.
    pub const ALL: [PostureStatus; 6] = [
        PostureStatus::Usable,
        PostureStatus::OutsideLimits,
        PostureStatus::Singular,
        PostureStatus::Unstable,
        PostureStatus::InCollision,
        PostureStatus::OutOfReach,
    ];

    /// Name in results.
    pub fn word(self) -> &'static str {
        match self {
            PostureStatus::Usable => "usable",
            PostureStatus::OutsideLimits => "outside_joint_limits",
            PostureStatus::Singular => "singular",
            PostureStatus::Unstable => "unstable",
            PostureStatus::InCollision => "in_collision",
            PostureStatus::OutOfReach => "out_of_reach",
        }
    }
}

/// The postures of some poses: [`SLOTS`] per pose, pose after pose.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Whether each posture can be used.
    pub statuses: Vec<PostureStatus>,
    /// Selected component of the deviation, m; infinite where the posture cannot be used.
    pub deviations: Vec<f64>,
    /// Joint positions, rad (m of a prismatic joint), as many as the robot has. Not defined where no posture was found.
    pub joints: Vec<f64>,
}

impl Column {
    /// Joint positions of posture `slot`, with slots numbered through all poses, of an arm with this number of joints.
    pub fn joints_of(&self, slot: usize, joint_count: usize) -> &[f64] {
        &self.joints[slot * joint_count..][..joint_count]
    }

    /// The slots of pose `index`, of an arm with this number of joints.
    pub(super) fn slots_of(&mut self, index: usize, joint_count: usize) -> Slots<'_> {
        let first = index * SLOTS;
        Slots {
            statuses: &mut self.statuses[first..][..SLOTS],
            deviations: &mut self.deviations[first..][..SLOTS],
            joints: &mut self.joints[first * joint_count..][..SLOTS * joint_count],
        }
    }

    /// Adds the poses of another column.
    pub(crate) fn append(&mut self, other: &Column) {
        self.statuses.extend_from_slice(&other.statuses);
        self.deviations.extend_from_slice(&other.deviations);
        self.joints.extend_from_slice(&other.joints);
    }

    /// Excludes posture `slot` at every pose.
    pub(crate) fn forbid(&mut self, slot: usize) {
        for at in (slot..self.statuses.len()).step_by(SLOTS) {
            self.statuses[at] = PostureStatus::OutOfReach;
            self.deviations[at] = f64::INFINITY;
        }
    }

    /// Excludes postures in which a joint of `robot` is nearer to a limit than `margin`, rad (m).
    pub(crate) fn keep_margin(&mut self, robot: &Robot, margin: f64) {
        let joint_count = robot.joints().len();
        for slot in 0..self.statuses.len() {
            let usable = self.statuses[slot] == PostureStatus::Usable;
            let room = |joints: &[f64]| robot.limit_margin(joints).map_or(f64::INFINITY, |(_, room)| room);
            if usable && room(self.joints_of(slot, joint_count)) < margin {
                self.statuses[slot] = PostureStatus::OutsideLimits;
                self.deviations[slot] = f64::INFINITY;
            }
        }
    }

    /// Excludes postures that do not keep the demanded clearance.
    pub(super) fn keep_clear(&mut self, clearance: &mut ClearanceCheck<'_>, joint_count: usize) {
        for slot in 0..self.statuses.len() {
            let usable = self.statuses[slot] == PostureStatus::Usable;
            if usable && clearance.conflict(self.joints_of(slot, joint_count)).is_some() {
                self.set_in_collision(slot..slot + 1);
            }
        }
    }

    /// The first usable posture of these slots.
    pub(crate) fn first_usable(&self, slots: Range<usize>) -> Option<usize> {
        let mut slots = slots;
        slots.find(|slot| self.statuses[*slot] == PostureStatus::Usable)
    }

    /// Excludes the usable postures of these slots: two bodies are nearer than demanded.
    pub(crate) fn set_in_collision(&mut self, slots: Range<usize>) {
        for slot in slots {
            if self.statuses[slot] == PostureStatus::Usable {
                self.statuses[slot] = PostureStatus::InCollision;
                self.deviations[slot] = f64::INFINITY;
            }
        }
    }

    pub(crate) fn clear(&mut self, poses: usize, joint_count: usize) {
        self.statuses.clear();
        self.statuses.resize(poses * SLOTS, PostureStatus::OutOfReach);
        self.deviations.clear();
        self.deviations.resize(poses * SLOTS, f64::INFINITY);
        self.joints.resize(poses * SLOTS * joint_count, 0.0);
    }
}

/// The postures of one pose: parts of a [`Column`].
pub(super) struct Slots<'a> {
    pub statuses: &'a mut [PostureStatus],
    pub deviations: &'a mut [f64],
    pub joints: &'a mut [f64],
}

impl Slots<'_> {
    pub fn clear(&mut self) {
        self.statuses.fill(PostureStatus::OutOfReach);
        self.deviations.fill(f64::INFINITY);
    }
}
