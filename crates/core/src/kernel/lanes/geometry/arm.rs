//! The arm for the lanes: numbers computed once per question.
//!
//! All values are in the arm's axes: origin on axis 1 at the height of axis 2, x to the front, y along
//! axis 2, z along axis 1; `phi` are angles about axes turned to the common sense (see
//! `robot::inverse::ortho_parallel`).

use nalgebra::{Matrix3, Vector3};

use crate::frame::Isometry;
use crate::robot::Robot;
use crate::robot::inverse::OrthoParallel;
use crate::robot::inverse::two_links::NEAR_SINGULAR;

/// Half a range that no joint leaves: joints without limits have it.
pub(in crate::kernel::lanes) const UNLIMITED: f64 = 1e6;

/// Geometry, coupling of joints, limits, tool.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct Arm {
    pub a1: f64,
    pub b: f64,
    pub l2: f64,
    pub l3: f64,
    /// Axis 4, then axis 5 with joint 4 at chain zero, then their cross product; for a forearm that is upright (along
    /// +z).
    pub forearm: [Vector3<f64>; 3],
    pub joints: [JointRow; 6],
    /// Sense of each axis of the chain against the common one, 1 or -1.
    pub sense: [f64; 6],
    /// `k_ij` of the controller's counting.
    pub coupling: [[f64; 6]; 6],
    pub arm_from_base: Isometry,
    /// Axis 6 in the tool's axes.
    pub tool_from_axis_6: Vector3<f64>,
    /// Axis 5 with joint 6 at chain zero, in the tool's axes.
    pub tool_from_axis_5: Vector3<f64>,
    /// From the wrist centre to the TCP, tool axes.
    pub lever: Vector3<f64>,
    /// Sine of the elbow's bend below which the arm is near its stretched or folded pose.
    pub near_elbow: f64,
    /// Distance of the wrist centre from axis 1, relative to the stretched arm, below which it is near it.
    pub near_shoulder: f64,
}

/// Zero, sense and range of a joint: `q = gain phi + start - coupling`.
#[derive(Clone, Copy, Debug)]
pub(in crate::kernel::lanes) struct JointRow {
    pub gain: f64,
    pub start: f64,
    /// Middle and half of its range.
    pub middle: f64,
    pub half: f64,
}

impl Arm {
    pub fn new(robot: &Robot, arm: &OrthoParallel, flange_from_tool: &Isometry) -> Arm {
        let tool_from_flange = flange_from_tool.inverse();
        let upright = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), -arm.forearm_at_zero);
        let [a4, a5] = arm.wrist_axes.map(|axis| upright * axis);
        let zero_of = Arm::angles_at_zero(arm);
        let mut coupling = [[0.0; 6]; 6];
        let mut rows = [JointRow {
            gain: 1.0,
            start: 0.0,
            middle: 0.0,
            half: UNLIMITED,
        }; 6];
        for (i, (row, joint)) in rows.iter_mut().zip(robot.joints()).enumerate() {
            for k in &joint.coupling {
                coupling[i][k.joint] += k.factor;
            }
            let sign = joint.sign.factor();
            row.gain = sign * arm.sense[i];
            row.start = -sign * joint.zero_offset - row.gain * zero_of[i];
            if let Some(limits) = joint.limits {
                row.middle = limits.middle();
                row.half = 0.5 * (limits.upper - limits.lower);
            }
        }
        Arm {
            a1: arm.a1,
            b: arm.b,
            l2: arm.links.l2,
            l3: arm.links.l3,
            forearm: [a4, a5, a4.cross(&a5)],
            joints: rows,
            sense: arm.sense,
            coupling,
            arm_from_base: arm.arm_from_base,
            tool_from_axis_6: tool_from_flange * arm.flange_from_axis_6,
            tool_from_axis_5: tool_from_flange * arm.flange_from_axis_5,
            lever: -(tool_from_flange * arm.flange_from_wrist).coords,
            near_elbow: NEAR_SINGULAR,
            near_shoulder: NEAR_SINGULAR,
        }
    }

    /// The six angles at chain zero: phi1, psi, chi - psi, phi4, bend, phi6.
    pub fn angles_at_zero(arm: &OrthoParallel) -> [f64; 6] {
        [
            0.0,
            arm.upper_arm_at_zero,
            arm.forearm_at_zero - arm.upper_arm_at_zero,
            0.0,
            arm.bend_at_zero,
            0.0,
        ]
    }

    /// Ends every joint's range this much (rad) before its limits, and calls the elbow stretched or folded so much
    /// sooner.
    pub fn keep_away(&mut self, margin: f64) {
        for joint in &mut self.joints {
            joint.half = (joint.half - margin).max(0.0);
        }
        self.near_elbow = NEAR_SINGULAR.max(margin.sin());
    }

    /// Widens limits and margins by `slack` (rad, and relative).
    pub fn allow(&mut self, slack: f64) {
        for joint in &mut self.joints {
            joint.half += slack;
        }
        self.near_elbow *= 1.0 - slack;
        self.near_shoulder *= 1.0 - slack;
    }

    /// No TCP is farther than this from an axis that moves it, m.
    pub fn longest_lever(&self) -> f64 {
        self.a1.abs() + self.b.abs() + self.l2 + self.l3 + self.lever.norm()
    }

    /// Rotation of base vectors into the arm's axes.
    pub fn arm_from_base_rotation(&self) -> Matrix3<f64> {
        *self.arm_from_base.rotation.to_rotation_matrix().matrix()
    }

    /// Limit of joint `index` as a cosine about the middle of its range: `(cos, sin)` of the middle in `phi` (without
    /// the zero of the arm's angle) and the smallest cosine allowed; `None` if there is no such limit.
    pub fn cosine_limit(&self, index: usize) -> Option<[f64; 3]> {
        let row = self.joints[index];
        let half = row.half + crate::kernel::AT_LIMIT;
        (half < std::f64::consts::PI).then(|| {
            let middle = (row.middle - row.start) / row.gain;
            [middle.cos(), middle.sin(), half.cos()]
        })
    }
}
