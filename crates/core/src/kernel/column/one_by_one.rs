//! The postures of one pose after the other, of any arm and model.

use nalgebra::Vector3;

use super::postures::{ColumnLoad, PostureStatus, SLOTS, Slots};
use crate::frame::Isometry;
use crate::kernel::answer::AT_LIMIT;
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into, joint_axis};
use crate::robot::inverse::{Finder, InverseSolution, InverseTarget};
use crate::robot::jacobian::axes_4_and_6;
use crate::robot::{Branch, PostureName, Robot, Singularity};
use crate::source::{Arm, ArmState, Links};

/// The arm, and the margins to limits and singularities.
#[derive(Clone, Copy)]
pub(super) struct ArmMargins<'q> {
    pub arm: Arm<'q>,
    pub home: Option<&'q [f64]>,
    /// Smallest bend of the wrist, rad.
    pub wrist: f64,
    /// Smallest distance of every revolute joint from its limits, and of the elbow from stretched, rad.
    pub margin: f64,
}

/// Buffers for one pose after the other.
pub(super) struct OneByOne<'q> {
    pub finder: Finder<'q>,
    pub frames: Frames,
    pub arm_state: ArmState<'q>,
    pub tool_from_flange: Isometry,
    /// Joint positions at home, as they were fixed; `None` where the question specifies it.
    pub home: Option<Vec<f64>>,
    /// Link offsets in the backlash, rad (m); `None` where only the load is included.
    pub link_offsets: Option<Vec<f64>>,
}

impl OneByOne<'_> {
    /// Fills the slots of one pose.
    pub fn pose(&mut self, margins: &ArmMargins<'_>, pose: &Isometry, push: &ColumnLoad<'_>, out: Slots<'_>) {
        let arm = margins.arm;
        let requested = InverseTarget {
            base_from_flange: pose * self.tool_from_flange,
            near: None,
            home: self.home.as_deref().or(margins.home),
        };
        // The result at the pose before is not a start value: columns may come in any order.
        self.finder.forget();
        let Ok(found) = self.finder.all(&requested) else {
            return;
        };
        let named = arm.robot.inverse().has_branches();
        for (order, one) in found.iter().enumerate() {
            let slot = match one.name {
                PostureName::Branch(branch) if named => Branch::ALL.iter().position(|other| *other == branch),
                _ => (order < SLOTS).then_some(order),
            };
            // Of two postures with one name, which a calibrated arm may have near a singularity, the first is stored.
            let free = |slot: &usize| out.statuses[*slot] == PostureStatus::OutOfReach;
            let Some(slot) = slot.filter(free) else {
                continue;
            };
            let joint_count = one.joints.len();
            out.joints[slot * joint_count..][..joint_count].copy_from_slice(&one.joints);
            let status = if !margins.inside_limits(&one.joints) {
                PostureStatus::OutsideLimits
            } else {
                forward_into(arm.robot, &one.joints, &mut self.frames);
                let tcp = pose.translation.vector.into();
                self.arm_state.set_frames(&one.joints, &self.frames, &tcp);
                let wrist = margins.wrist.max(margins.margin);
                let bend = axes_4_and_6(arm.robot, self.arm_state.screws());
                if is_singular(one, bend, wrist) || elbow_bend(arm.robot, &self.frames) < margins.margin.sin()
                {
                    PostureStatus::Singular
                } else {
                    PostureStatus::Usable
                }
            };
            out.statuses[slot] = status;
            if status != PostureStatus::Usable {
                continue;
            }
            let mut most = 0.0_f64;
            for wrench in push.cases {
                let mut links = match &mut self.link_offsets {
                    None => Links::Neglected,
                    Some(link_offsets) => Links::Farthest(push.along, link_offsets),
                };
                match deviation_of(&mut self.arm_state, wrench, &mut links) {
                    Ok(twist) => {
                        let [a, b] = push.along.map(|along| along.dot(&twist.linear));
                        most = most.max(a.hypot(b));
                    }
                    Err(_) => most = f64::INFINITY,
                }
            }
            out.deviations[slot] = most;
            if most.is_infinite() {
                out.statuses[slot] = PostureStatus::Unstable;
            }
        }
    }
}

/// Whether a posture is nearer to a singularity than allowed: of an arm with branch names by the angle between its axes 4
/// and 6, of others by its flag.
fn is_singular(found: &InverseSolution, axes_4_and_6: Option<[Vector3<f64>; 2]>, wrist: f64) -> bool {
    match (found.singularity, axes_4_and_6) {
        (Some(Singularity::Elbow | Singularity::Shoulder), _) => true,
        (_, Some([fourth, sixth])) => fourth.cross(&sixth).norm() < wrist.sin(),
        (singularity, None) => singularity.is_some(),
    }
}

impl ArmMargins<'_> {
    /// Whether every joint is inside its limits, and every revolute joint by at least the margin.
    fn inside_limits(&self, joints: &[f64]) -> bool {
        let robot = self.arm.robot;
        robot.joints().iter().enumerate().all(|(index, joint)| {
            let margin = if robot.slides(index) { 0.0 } else { self.margin };
            joint
                .limits
                .is_none_or(|limits| limits.margin(joints[index]) >= margin - AT_LIMIT)
        })
    }
}

/// Sine of the angle between upper arm and forearm of an ortho-parallel arm in this posture; 1 for others.
fn elbow_bend(robot: &Robot, frames: &Frames) -> f64 {
    let Some(form) = robot.ortho_parallel() else {
        return 1.0;
    };
    let axis = joint_axis(robot, frames, 1);
    let [shoulder, elbow] = [1, 2].map(|joint| frames.origin(joint));
    let wrist = frames.base_from_flange * form.flange_from_wrist;
    let across = |v: Vector3<f64>| v - axis * axis.dot(&v);
    let (upper, fore) = (across(elbow - shoulder), across(wrist - elbow));
    upper.cross(&fore).norm() / (upper.norm() * fore.norm())
}
