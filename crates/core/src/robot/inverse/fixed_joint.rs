//! Seven revolute joints of which one is fixed: the other six have a spherical wrist at any position of it.
//!
//! ```text
//! E1 ... Ek ... E7 M = T        becomes        E1 ... E'(k+1) ... E'7 (Ek M) = T
//! ```
//!
//! `Ek` is the rotation of the fixed joint by its given angle; it carries the axes after it, and the flange at zero
//! `M`.
//!
//! The joint is chosen by trial: of those that leave a spherical wrist at every angle tried, the one that reaches most
//! of some poses, which were made with all joints. Of shoulder - elbow - wrist arms
//! (KUKA iiwa) that is joint 3: it turns the elbow about the line from shoulder to wrist. Angles rad.

use std::cmp::Ordering;
use std::f64::consts::PI;

use nalgebra::{Point3, UnitQuaternion};

use super::super::chain::Chain;
use super::closed_form::CALIBRATED;
use super::lines::{IDEAL, Line, lines_at_zero};
use super::ortho_parallel::OrthoParallel;
use super::spherical_wrist::SphericalWrist;
use super::starts::Starts;
use crate::frame::Isometry;

/// Angles at which a joint is tried: to both sides of zero, all of them general.
const TRIED: [f64; 2] = [0.4, -0.7];
/// Poses that are tried at each angle.
const POSES: usize = 16;
/// The order of joints where equally many poses are reached: those in the middle of the arm first.
const AMIDST: [usize; 7] = [2, 3, 4, 1, 5, 0, 6];

/// Seven revolute joints, one of them fixed.
#[derive(Clone, Debug)]
pub struct FixedJoint {
    lines: [Line; 7],
    at_zero: Isometry,
    within: f64,
    /// Index of the fixed joint, in the chain.
    pub(super) joint: usize,
}

impl FixedJoint {
    /// The joint of `chain` to be fixed, if there is one; exact wrists first, then those of calibrated arms.
    pub fn recognise(chain: &Chain) -> Option<FixedJoint> {
        let lines = lines_at_zero(chain)?;
        let at_zero = chain.base_from_flange(&[0.0; 7]);
        let starts = Starts::within(&[[-PI, PI]; 7]);
        let poses: Vec<Isometry> = (1..=POSES)
            .map(|k| {
                let mut theta = [0.0; 7];
                starts.point(k, &mut theta);
                chain.base_from_flange(&theta)
            })
            .collect();
        [IDEAL, CALIBRATED].into_iter().find_map(|within| {
            let mut most: Option<(usize, FixedJoint)> = None;
            for joint in AMIDST {
                let fixed = FixedJoint {
                    lines,
                    at_zero,
                    within,
                    joint,
                };
                let Some(reached) = fixed.reached(&poses) else {
                    continue;
                };
                if most.as_ref().is_none_or(|(most, _)| reached > *most) {
                    most = Some((reached, fixed));
                }
            }
            Some(most?.1)
        })
    }

    /// Number of these poses that are reached; `None` without a spherical wrist.
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

    /// Whether the wrist axes meet exactly.
    pub fn is_exact(&self) -> bool {
        self.within == IDEAL
    }

    /// The six joints that remain with the fixed one at `angle` (rad).
    pub(super) fn at(&self, angle: f64) -> Option<SphericalWrist> {
        let (six, at_zero) = self.lines_at(angle);
        SphericalWrist::of(&six, &at_zero, self.within)
    }

    /// The six joints of [`FixedJoint::at`], where they are an ortho-parallel arm.
    pub(super) fn ortho_parallel_at(&self, angle: f64) -> Option<OrthoParallel> {
        let (six, at_zero) = self.lines_at(angle);
        OrthoParallel::of(&six, &at_zero)
    }

    /// The axes that remain with the fixed joint at `angle` (rad), and the flange, at zero of the others.
    fn lines_at(&self, angle: f64) -> ([Line; 6], Isometry) {
        let axis = self.lines[self.joint];
        let six: [Line; 6] = std::array::from_fn(|i| {
            if i < self.joint {
                self.lines[i]
            } else {
                axis.carried(angle, &self.lines[i + 1])
            }
        });
        let turn = Isometry::from_parts(
            axis.turned(angle, &Point3::origin()).coords.into(),
            UnitQuaternion::from_rotation_matrix(&axis.rotation(angle)),
        );
        (six, turn * self.at_zero)
    }

    /// All seven chain positions, of one posture or in lanes.
    pub(super) fn with<T: Copy>(&self, angle: T, six: &[T; 6]) -> [T; 7] {
        std::array::from_fn(|i| match i.cmp(&self.joint) {
            Ordering::Less => six[i],
            Ordering::Equal => angle,
            Ordering::Greater => six[i - 1],
        })
    }

    /// The six chain positions without that of the fixed joint; `None` for another number than seven.
    pub(super) fn without(&self, theta: &[f64]) -> Option<[f64; 6]> {
        let theta: &[f64; 7] = theta.try_into().ok()?;
        Some(std::array::from_fn(|i| theta[i + usize::from(i >= self.joint)]))
    }
}

#[cfg(test)]
mod tests;
