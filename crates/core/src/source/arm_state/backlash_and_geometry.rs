//! Deviations of the tool that no load causes: backlash of the joints, and an arm that differs from the model in its
//! controller.

use nalgebra::{Matrix3, Point3, Vector2, Vector3};

use super::ArmState;
use crate::robot::Attachment;
use crate::robot::forward::forward;
use crate::source::{Contributor, backlash, geometric};
use crate::spatial::{Twist, Wrench};

/// Positions of the links of joints with backlash.
#[derive(Debug)]
pub enum Links<'a> {
    /// Backlash and geometry are neglected: only load and gravity are included.
    Neglected,
    /// Along a path: kept there by friction, one position per joint, rad (m).
    KeptByFriction(&'a [f64]),
    /// At a single point they are unknown: the worst case is used, the largest displacement along these two directions
    /// (base). The positions are written here, one per joint, rad (m).
    Farthest([Vector3<f64>; 2], &'a mut [f64]),
}

impl Links<'_> {
    /// One position per joint, rad (m); `None` where they are not included.
    pub fn positions(&self) -> Option<&[f64]> {
        match self {
            Links::Neglected => None,
            Links::KeptByFriction(positions) => Some(positions),
            Links::Farthest(_, positions) => Some(positions),
        }
    }
}

impl ArmState<'_> {
    /// Displacement of the tool by backlash: `kept` are the positions kept by friction, one per joint, rad (m), which
    /// apply where gravity and `wrench` do not decide the side.
    pub fn backlash(&self, kept: &[f64], wrench: &Wrench) -> Twist {
        let gaps = self.arm.model.structure.joints_with_backlash();
        gaps.map(|(joint, _)| self.backlash_of(joint, kept, wrench)).sum()
    }

    /// Displacement of the tool because the arm differs from the model in its controller.
    pub fn geometric(&self) -> Twist {
        let (arm, model) = (&self.arm, self.arm.model);
        let known = model.actual.as_ref().map_or(Twist::ZERO, |actual| {
            geometric::displacement(arm.robot, actual, arm.flange_from_tool, &self.joints)
        });
        let shift = model.structure.geometry.as_deref().map(|geometry| {
            let tip = self.base_from_tool.translation.vector.into();
            geometry.shift(&forward(arm.robot, &self.joints).base_from_joint, &tip)
        });
        known + shift.unwrap_or(Twist::ZERO)
    }

    /// Displacement of the tool by one standard uncertainty of each independent input of the geometry, base.
    pub fn geometry_uncertainty(&self) -> Vec<Twist> {
        let geometry = self.arm.model.structure.geometry.as_deref();
        geometry.map_or_else(Vec::new, |geometry| {
            let tip = self.base_from_tool.translation.vector.into();
            geometry.displacements(&forward(self.arm.robot, &self.joints).base_from_joint, &tip)
        })
    }

    /// Displacement of the tool because the links have grown since the calibration.
    pub fn thermal(&self) -> Twist {
        let thermal = self.arm.model.thermal;
        thermal.map_or(Twist::ZERO, |thermal| {
            thermal.displacement(&self.constant_lengths())
        })
    }

    /// Standard uncertainty of [`ArmState::thermal`], m, base: its components are fully correlated.
    pub(crate) fn thermal_uncertainty(&self) -> Vector3<f64> {
        let thermal = self.arm.model.thermal;
        thermal.map_or_else(Vector3::zeros, |thermal| {
            thermal.uncertainty(&self.constant_lengths())
        })
    }

    /// Displacement of the tool by what the model leaves of measured positions.
    pub fn learnt(&self) -> Twist {
        let learnt = self.arm.model.structure.learnt.as_ref();
        learnt.map_or(Twist::ZERO, |learnt| Twist {
            linear: learnt.mean(&self.joints),
            ..Twist::ZERO
        })
    }

    /// From the ground to the flange of the arm without the travel of prismatic joints, m, base. Of an arm that holds the part,
    /// the opposite: the tool moves relative to the part as the ground does.
    fn constant_lengths(&self) -> Vector3<f64> {
        let ground = self.arm.robot.chain().ground();
        let travel = |(joint, theta): (usize, &f64)| {
            let slides = self.arm.robot.slides(joint);
            slides.then(|| self.screws[joint].linear * *theta)
        };
        let of_arm = self.theta.iter().enumerate().skip(ground.positioner_joints());
        let travelled: Vector3<f64> = of_arm.filter_map(travel).sum();
        let base_from_ground = self.base_from_ground.translation.vector;
        if ground.part_is_in_hand() {
            return base_from_ground - travelled;
        }
        let tool_from_flange = self.arm.flange_from_tool.inverse().translation.vector;
        let flange = self.base_from_tool * Point3::from(tool_from_flange);
        flange.coords - base_from_ground - travelled
    }

    /// Writes the worst-case positions of the links where load and gravity displace the tool by `by_load` (m, base).
    pub(crate) fn settle(&self, links: &mut Links<'_>, by_load: &Vector3<f64>, wrench: &Wrench) {
        if let Links::Farthest(along, positions) = links {
            positions.fill(0.0);
            let known = self.geometric() + self.thermal() + self.learnt() + self.backlash(positions, wrench);
            self.place_farthest(&(by_load + known.linear), along, wrench, positions);
        }
    }

    /// Puts the links on the sides with the largest displacement of the tool along these two directions (base); `from`
    /// (m, base) is the displacement by all else. Links whose side is given by a torque get 0.
    fn place_farthest(
        &self,
        from: &Vector3<f64>,
        along: &[Vector3<f64>; 2],
        wrench: &Wrench,
        positions: &mut [f64],
    ) {
        let projected = |v: &Vector3<f64>| Vector2::from(along.map(|along| along.dot(v)));
        let gaps = self.arm.model.structure.joints_with_backlash();
        let free = gaps.filter(|(joint, _)| self.backlash_of(*joint, positions, wrench) == Twist::ZERO);
        let (joints, halves): (Vec<(usize, f64)>, Vec<Vector2<f64>>) = free
            .map(|(joint, gap)| {
                let half = 0.5 * gap.gap;
                ((joint, half), projected(&(self.screws[joint].linear * half)))
            })
            .unzip();
        let mut signs = vec![0.0; halves.len()];
        backlash::farthest(projected(from), &halves, &mut signs);
        for ((joint, half), sign) in joints.into_iter().zip(signs) {
            positions[joint] = half * sign;
        }
    }

    /// Adds every part that does not depend on the load to the shares and to the covariance (m^2) of the displacement.
    pub(crate) fn add_unloaded(
        &self,
        links: &Links<'_>,
        wrench: &Wrench,
        shares: &mut [Twist],
        covariance: &mut Matrix3<f64>,
    ) {
        let Some(positions) = links.positions() else {
            return;
        };
        let contributors = self.arm.model.contributors(self.theta.len());
        self.each_unloaded(positions, wrench, |contributor, part, u| {
            if let Some(share) = contributors.iter().position(|other| *other == contributor) {
                shares[share] = shares[share] + part;
            }
            *covariance += u * u.transpose();
        });
    }

    /// Calls `take` with each part that does not depend on the load and its standard uncertainty (m, base; its components are fully correlated). The
    /// uncertainty of a backlash is relative.
    pub(crate) fn each_unloaded(
        &self,
        kept: &[f64],
        wrench: &Wrench,
        mut take: impl FnMut(Contributor, Twist, Vector3<f64>),
    ) {
        for (joint, gap) in self.arm.model.structure.joints_with_backlash() {
            let part = self.backlash_of(joint, kept, wrench);
            let u = part.linear * (gap.standard_uncertainty / gap.gap);
            take(Contributor::At(Attachment::Joint(joint)), part, u);
        }
        if self.arm.model.actual.is_some() {
            take(Contributor::Geometry, self.geometric(), Vector3::zeros());
        }
        for moved in self.geometry_uncertainty() {
            take(Contributor::Geometry, Twist::ZERO, moved.linear);
        }
        if self.arm.model.thermal.is_some() {
            take(Contributor::Thermal, self.thermal(), self.thermal_uncertainty());
        }
        if let Some(learnt) = &self.arm.model.structure.learnt {
            let here = learnt.at(&self.joints);
            let [along, across, up] = here.uncertainty;
            let mean = Twist {
                linear: here.mean,
                ..Twist::ZERO
            };
            take(Contributor::Learnt, mean, along);
            take(Contributor::Learnt, Twist::ZERO, across);
            take(Contributor::Learnt, Twist::ZERO, up);
        }
    }

    /// Part of joint `joint`, which has backlash.
    pub(crate) fn backlash_of(&self, joint: usize, kept: &[f64], wrench: &Wrench) -> Twist {
        let screw = self.screws[joint];
        let gap = self.arm.model.structure.backlash[joint];
        let offset = gap.map_or(0.0, |gap| {
            backlash::link_offset(&gap, kept[joint], &screw, wrench, self.before[joint])
        });
        screw * offset
    }
}
