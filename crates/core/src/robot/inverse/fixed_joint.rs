//! Seven turning joints of which one stands still: the other six have a spherical wrist, wherever it stands.
//!
//! ```text
//! E1 ... Ek ... E7 M = T        becomes        E1 ... E'(k+1) ... E'7 (Ek M) = T
//! ```
//!
//! `Ek` is the turn of the standing joint by its held angle; it carries the axes behind it, and the flange at zero `M`.
//!
//! Which joint it is, is decided by trying: of those that leave a spherical wrist at every angle tried, the one with which
//! most of some poses are reached that the arm has come to with all its joints. Of shoulder - elbow - wrist arms
//! (KUKA iiwa) that is joint 3: it turns the elbow about the line from shoulder to
//! wrist. Angles rad.

use std::cmp::Ordering;
use std::f64::consts::PI;

use nalgebra::{Point3, UnitQuaternion};

use super::super::chain::Chain;
use super::closed_form::CALIBRATED;
use super::lines::{IDEAL, Line, lines_at_zero};
use super::spherical_wrist::SphericalWrist;
use super::starts::spread;
use crate::frame::Isometry;

/// Angles at which a joint is tried: to both sides of zero, none of them special.
const TRIED: [f64; 2] = [0.4, -0.7];
/// Poses that are tried at each angle.
const POSES: usize = 16;
/// The order of joints where equally many poses are reached: those amidst the arm first.
const AMIDST: [usize; 7] = [2, 3, 4, 1, 5, 0, 6];

/// Seven turning joints, one of them standing.
#[derive(Clone, Debug)]
pub struct FixedJoint {
    lines: [Line; 7],
    at_zero: Isometry,
    within: f64,
    /// Index of the joint that stands, in the chain.
    pub(super) joint: usize,
}

impl FixedJoint {
    /// The joint of `chain` to stand still, if there is one; exact wrists first, then those of calibrated arms.
    pub fn recognise(chain: &Chain) -> Option<FixedJoint> {
        let lines = lines_at_zero(chain)?;
        let at_zero = chain.base_from_flange(&[0.0; 7]);
        let poses: Vec<Isometry> = (1..=POSES)
            .map(|k| {
                let mut theta = [0.0; 7];
                spread(k, &[[-PI, PI]; 7], &mut theta);
                chain.base_from_flange(&theta)
            })
            .collect();
        [IDEAL, CALIBRATED].into_iter().find_map(|within| {
            let mut most: Option<(usize, FixedJoint)> = None;
            for joint in AMIDST {
                let arm_state = FixedJoint {
                    lines,
                    at_zero,
                    within,
                    joint,
                };
                let Some(reached) = arm_state.reached(&poses) else {
                    continue;
                };
                if most.as_ref().is_none_or(|(most, _)| reached > *most) {
                    most = Some((reached, arm_state));
                }
            }
            Some(most?.1)
        })
    }

    /// How many of these poses are reached; `None` without a spherical wrist.
    fn reached(&self, poses: &[Isometry]) -> Option<usize> {
        let mut reached = 0;
        for angle in TRIED {
            let six = self.at(angle)?;
            reached += poses
                .iter()
                .filter(|pose| !six.chain_positions(pose, None).is_empty())
                .count();
        }
        Some(reached)
    }

    /// Whether the wrist axes meet as they are.
    pub fn is_exact(&self) -> bool {
        self.within == IDEAL
    }

    /// The six joints that are left where the standing one has turned by `angle` (rad).
    pub(super) fn at(&self, angle: f64) -> Option<SphericalWrist> {
        let evaluation = self.lines[self.joint];
        let six: [Line; 6] = std::array::from_fn(|i| {
            if i < self.joint {
                self.lines[i]
            } else {
                evaluation.carried(angle, &self.lines[i + 1])
            }
        });
        let turn = Isometry::from_parts(
            evaluation.turned(angle, &Point3::origin()).coords.into(),
            UnitQuaternion::from_rotation_matrix(&evaluation.rotation(angle)),
        );
        SphericalWrist::of(&six, &(turn * self.at_zero), self.within)
    }

    /// All seven chain positions.
    pub(super) fn with(&self, angle: f64, six: &[f64; 6]) -> [f64; 7] {
        std::array::from_fn(|i| match i.cmp(&self.joint) {
            Ordering::Less => six[i],
            Ordering::Equal => angle,
            Ordering::Greater => six[i - 1],
        })
    }

    /// The six chain positions beside that of the standing joint; `None` of another count than seven.
    pub(super) fn without(&self, theta: &[f64]) -> Option<[f64; 6]> {
        let theta: &[f64; 7] = theta.try_into().ok()?;
        Some(std::array::from_fn(|i| theta[i + usize::from(i >= self.joint)]))
    }
}

#[cfg(test)]
mod tests;
