//! What moves the tool of an arm beside its load: links in the gaps of their joints, and an arm that is not the one its
//! controller reckons with.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::ArmState;
use crate::robot::Attachment;
use crate::source::{backlash, geometric};
use crate::spatial::{Twist, Wrench};

/// What is known of where the links of joints with backlash are in their gaps.
#[derive(Debug)]
pub enum Links<'a> {
    /// Neither backlash nor geometry is included: load and gravity alone.
    Neglected,
    /// Along a path: friction has dragged them here, one position a joint, rad (m).
    KeptByFriction(&'a [f64]),
    /// At a single point it is unknown: each is where it moves the tool farthest, measured along these two directions (base).
    /// The positions are written here, one a joint, rad (m).
    Farthest([Vector3<f64>; 2], &'a mut [f64]),
}

impl Links<'_> {
    /// One position a joint, rad (m); `None` where they are not included.
    pub fn positions(&self) -> Option<&[f64]> {
        match self {
            Links::Neglected => None,
            Links::KeptByFriction(positions) => Some(positions),
            Links::Farthest(_, positions) => Some(positions),
        }
    }
}

impl ArmState<'_> {
    /// Displacement of the tool because links lie in their gaps: `dragged` there by friction, one a joint, rad (m), or held
    /// on a flank by gravity and `wrench`.
    pub fn backlash(&self, dragged: &[f64], wrench: &Wrench) -> Twist {
        let gaps = self.arm.model.structure.gaps();
        gaps.map(|(joint, _)| self.backlash_of(joint, dragged, wrench))
            .sum()
    }

    /// Displacement of the tool because the arm is not as its controller has it.
    pub fn geometric(&self) -> Twist {
        let (arm, model) = (&self.arm, self.arm.model);
        model.actual.as_ref().map_or(Twist::ZERO, |actual| {
            geometric::displacement(arm.robot, actual, arm.flange_from_tool, &self.joints)
        })
    }

    /// Finds where links are that may be anywhere, where load and gravity move the tool by `by_load` (m, base).
    pub(crate) fn settle(&self, links: &mut Links<'_>, by_load: &Vector3<f64>, wrench: &Wrench) {
        if let Links::Farthest(along, positions) = links {
            positions.fill(0.0);
            let known = self.geometric() + self.backlash(positions, wrench);
            self.lie_farthest((&(by_load + known.linear), along), wrench, positions);
        }
    }

    /// Lets links lie on the flanks on which they move the tool farthest, counted along these two directions (base), that all
    /// else has moved by `from` (m, base). Those that a torque holds get 0: they lie where it holds them.
    fn lie_farthest(
        &self,
        (from, along): (&Vector3<f64>, &[Vector3<f64>; 2]),
        wrench: &Wrench,
        placements: &mut [f64],
    ) {
        let counted = |v: &Vector3<f64>| Vector2::from(along.map(|along| along.dot(v)));
        let gaps = self.arm.model.structure.gaps();
        let free = gaps.filter(|(joint, _)| self.backlash_of(*joint, placements, wrench) == Twist::ZERO);
        let (joints, halves): (Vec<(usize, f64)>, Vec<Vector2<f64>>) = free
            .map(|(joint, gap)| {
                let half = 0.5 * gap.gap;
                ((joint, half), counted(&(self.screws[joint].linear * half)))
            })
            .unzip();
        let mut signs = vec![0.0; halves.len()];
        backlash::farthest(counted(from), &halves, &mut signs);
        for ((joint, half), sign) in joints.into_iter().zip(signs) {
            placements[joint] = half * sign;
        }
    }

    /// Adds backlash to the shares of the joints and to the covariance (m^2) of the displacement: a gap is known in proportion.
    pub(crate) fn add_backlash(
        &self,
        links: &Links<'_>,
        wrench: &Wrench,
        (shares, covariance): (&mut [Twist], &mut Matrix3<f64>),
    ) {
        let Some(positions) = links.positions() else {
            return;
        };
        for (joint, gap) in self.arm.model.structure.gaps() {
            let part = self.backlash_of(joint, positions, wrench);
            // Joints come first among those who have shares.
            shares[joint] = shares[joint] + part;
            let u = part.linear * (gap.standard_uncertainty / gap.gap);
            *covariance += u * u.transpose();
        }
    }

    /// Part of joint `joint`, which has play.
    pub(crate) fn backlash_of(&self, joint: usize, dragged: &[f64], wrench: &Wrench) -> Twist {
        let screw = self.screws[joint];
        let gap = self.arm.model.structure.backlash[joint];
        let placements = gap.map_or(0.0, |gap| {
            backlash::placements(&gap, dragged[joint], (&screw, wrench), self.before[joint])
        });
        screw * placements
    }

    /// Adds the part of each link in its gap along the unit vector `along` (m) to the share of its joint, and gives the
    /// variance (m^2) of all of them along it.
    pub fn share_backlash(
        &self,
        along: &Vector3<f64>,
        (dragged, wrench): (&[f64], &Wrench),
        contributors: &[Attachment],
        shares: &mut [f64],
    ) -> f64 {
        let mut variance = 0.0;
        for (joint, gap) in self.arm.model.structure.gaps() {
            let part = self.backlash_of(joint, dragged, wrench).linear.dot(along);
            if let Some(share) = contributors.iter().position(|contributor| *contributor == Attachment::Joint(joint)) {
                shares[share] += part;
            }
            // In proportion to the gap.
            variance += (part * gap.standard_uncertainty / gap.gap).powi(2);
        }
        variance
    }
}
