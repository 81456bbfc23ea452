//! Many postures that are near each other, as along a path: which keep the demanded clearance.
//!
//! A posture that was measured with a clearance `c` decides all postures to which no point of the arm moves as far as `|c - c_least|`:
//!
//! ```text
//! sum over the joints k of  |dtheta_k| D_k  <  |c - c_least|
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `dtheta_k` | motion of joint k from the measured posture | rad (m) |
//! | `D_k` | largest distance of a body from the origin of joint k in any posture inside the limits; 1 for a prismatic joint | m |
//!
//! The result is that of [`ClearanceCheck::conflict`] for every posture, but for rounding. Source: as [`super::swept`].

use std::collections::VecDeque;

use super::demanded::ClearanceCheck;
use super::state::{Check, Room};
use crate::frame::Isometry;

/// Measured postures that are remembered.
const REMEMBERED: usize = 32;
/// A clearance is not measured farther than this beyond the demanded one, m.
const ENOUGH: f64 = 0.3;
/// Rounding of clearances and ways, m.
const ROUNDING: f64 = 1e-9;

/// Checks postures near each other; one per thread.
#[derive(Clone, Debug)]
pub struct ClearanceAlong<'a> {
    check: ClearanceCheck<'a>,
    reach: Vec<f64>,
    /// Newest first.
    measured: VecDeque<Measured>,
    theta: Vec<f64>,
    /// What was in the way last.
    likely: Option<Check>,
}

/// A posture with its clearance.
#[derive(Clone, Debug)]
struct Measured {
    theta: Vec<f64>,
    room: Room,
}

impl<'a> ClearanceAlong<'a> {
    /// With this check of single postures.
    pub fn new(check: ClearanceCheck<'a>) -> ClearanceAlong<'a> {
        ClearanceAlong {
            reach: check.state.reach_of_joints(),
            check,
            measured: VecDeque::with_capacity(REMEMBERED),
            theta: Vec::new(),
            likely: None,
        }
    }

    /// Moves the part.
    pub fn set_part(&mut self, base_from_part: &Isometry) {
        self.check.set_part(base_from_part);
        self.measured.clear();
    }

    /// Forgets the measured postures: the next ones are far from them.
    pub fn forget(&mut self) {
        self.measured.clear();
    }

    /// Whether the demanded clearance is kept at these joint positions, rad (m).
    pub fn is_kept(&mut self, joints: &[f64]) -> bool {
        let robot = self.check.state.robot();
        self.theta.clear();
        self.theta
            .extend((0..joints.len()).map(|joint| robot.theta(joint, joints)));
        let near = self.measured.iter().find(|measured| {
            let way = way(&self.theta, &measured.theta, &self.reach);
            way + ROUNDING < measured.room.by.abs()
        });
        if let Some(near) = near {
            return near.room.conflict.is_none();
        }
        self.check.state.set_joints(joints);
        let room = self.check.state.room(self.check.least, ENOUGH, self.likely);
        self.likely = room.conflict.or(self.likely);
        let mut theta = match self.measured.len() {
            REMEMBERED => self.measured.pop_back().map(|oldest| oldest.theta),
            _ => None,
        }
        .unwrap_or_default();
        theta.clone_from(&self.theta);
        self.measured.push_front(Measured { theta, room });
        room.conflict.is_none()
    }
}

/// An upper bound of the way of any point of the arm between two postures, m.
fn way(from: &[f64], to: &[f64], reach: &[f64]) -> f64 {
    let of_joint = |((from, to), reach): ((&f64, &f64), &f64)| match (to - from).abs() {
        // Also where the reach is not bounded.
        0.0 => 0.0,
        by => by * reach,
    };
    from.iter().zip(to).zip(reach).map(of_joint).sum()
}

#[cfg(test)]
pub(super) mod tests;
