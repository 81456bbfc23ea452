//! Poses and joint positions of a program: the posture next to another one, and whether a straight move can be followed.

use std::f64::consts::TAU;

use armill_core::clearance::CellState;
use armill_core::frame::Isometry;
use armill_core::nalgebra::Point3;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Branch, Robot};
use armill_core::units::to_mm;
use armill_programs::{DraftPoint, FrameOn};

use crate::input::setting::Setting;
use crate::naming::{base_from_controller, controller_from_mount};

/// Joints of an arm that programs are written for; further ones, first in the chain, are external axes.
const ARM_JOINTS: usize = 6;
/// Distance between the samples of a straight move, m, and angle between them, rad.
const SAMPLE: f64 = 0.01;
const SAMPLE_TURN: f64 = 0.05;
/// A joint that turns farther than this between two samples changes the posture, rad.
const FARTHEST: f64 = 0.35;
/// Part of the maximum speed of a joint that a straight move uses.
const PART_OF_SPEED: f64 = 0.9;
/// Samples of a joint move.
const JOINT_SAMPLES: usize = 40;

/// The arm with its tool.
#[derive(Clone, Copy)]
pub(super) struct Arm<'a> {
    pub robot: &'a Robot,
    pub setting: &'a Setting,
    /// Base to the frame of the targets.
    pub base_from_path: Isometry,
    /// Where a positioner stands along the whole program, rad (m), from its table back; none if it moves, or if there is none.
    pub standing: Option<&'a [f64]>,
}

/// A tool pose with its joint positions.
#[derive(Clone, Debug)]
pub(super) struct ArmAt {
    /// Base to tool.
    pub base_from_tool: Isometry,
    /// rad, m
    pub joints: Vec<f64>,
    /// Posture, for an arm with named postures.
    pub branch: Option<Branch>,
}

/// A straight move that can be followed.
#[derive(Clone, Debug)]
pub(super) struct Straight {
    /// Its end.
    pub end: ArmAt,
    /// Greatest tip speed that the joints permit, m/s; infinite if the tip stays in place.
    pub fastest: f64,
}

impl Arm<'_> {
    /// The target of a move to `at`, linear at `speed` (m/s) or a joint move.
    pub fn target(&self, at: &ArmAt, speed: Option<f64>, blend: f64) -> DraftPoint {
        let external = at.joints.len().saturating_sub(ARM_JOINTS);
        DraftPoint {
            frame_from_tool: self.base_from_path.inverse() * at.base_from_tool,
            joints: match self.frame_on() {
                // The controller counts its joints from the base of the robot.
                FrameOn::Flange => at.joints.iter().rev().copied().collect(),
                FrameOn::Cell | FrameOn::Table => at.joints[external..].to_vec(),
            },
            external: self.external().map(|joint| at.joints[joint]).collect(),
            branch: at.branch,
            speed,
            blend,
        }
    }

    /// The joints that a program moves as external axes, in the order of a controller; without a positioner that stands.
    fn external(&self) -> impl Iterator<Item = usize> {
        let robot = self.robot;
        let of_positioner = robot.chain().ground().positioner_joints();
        let first_of_arm = robot.joints().len().saturating_sub(ARM_JOINTS);
        let carrying = of_positioner..first_of_arm.max(of_positioner);
        let moving = if self.standing.is_some() { 0 } else { of_positioner };
        carrying.chain((0..moving).rev())
    }

    /// Of each external axis whether it is prismatic.
    pub fn external_slides(&self) -> Vec<bool> {
        self.external().map(|joint| self.robot.slides(joint)).collect()
    }

    /// What the frame of the targets is fixed to.
    pub fn frame_on(&self) -> FrameOn {
        let ground = self.robot.chain().ground();
        if ground.part_is_in_hand() {
            FrameOn::Flange
        } else if !ground.is_base() && self.standing.is_none() {
            FrameOn::Table
        } else {
            FrameOn::Cell
        }
    }

    /// The frame of the targets: relative to the table of a positioner that moves it, to the flange of a robot that holds
    /// the part, else to the frame of the controller.
    pub fn reference_from_frame(&self) -> Isometry {
        match self.frame_on() {
            FrameOn::Table | FrameOn::Flange => self.base_from_path,
            FrameOn::Cell => base_from_controller(self.robot, self.standing).inverse() * self.base_from_path,
        }
    }

    /// The tool: relative to the flange, or to the frame of the controller where it stands in the cell.
    pub fn mount_from_tool(&self) -> Isometry {
        let controller_from_mount = controller_from_mount(self.robot).unwrap_or_else(Isometry::identity);
        controller_from_mount * self.setting.flange_from_tool
    }

    /// The arm at these joint positions, rad (m).
    pub fn at_joints(&self, joints: &[f64]) -> ArmAt {
        let posture = posture_at(self.robot, joints, &self.setting.flange_from_tool);
        ArmAt {
            base_from_tool: posture.base_from_tool,
            joints: joints.to_vec(),
            branch: posture.name.branch(),
        }
    }

    /// The posture of this pose next to `near` (rad, m), within the joint limits and with its turns; `None` if there is
    /// none in the same posture.
    fn next_to(&self, base_from_tool: &Isometry, near: &[f64]) -> Option<ArmAt> {
        let tool = ToolAt {
            flange_from_tool: &self.setting.flange_from_tool,
            near: Some(near),
            // External axes stay where they are on a straight move.
            home: Some(near),
        };
        let with_turns = |q: &[f64]| -> Vec<f64> {
            let turned = |(joint, (q, near)): (usize, (&f64, &f64))| match self.robot.slides(joint) {
                true => *q,
                false => q + TAU * ((near - q) / TAU).round(),
            };
            q.iter().zip(near).enumerate().map(turned).collect()
        };
        let away = |q: &[f64]| {
            let turning = q
                .iter()
                .zip(near)
                .enumerate()
                .filter(|(joint, _)| !self.robot.slides(*joint));
            turning.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max)
        };
        postures(self.robot, base_from_tool, tool)
            .unwrap_or_default()
            .into_iter()
            .map(|posture| ArmAt {
                base_from_tool: *base_from_tool,
                joints: with_turns(&posture.joints),
                branch: posture.name.branch(),
            })
            .filter(|at| self.is_within_limits(&at.joints) && away(&at.joints) < FARTHEST)
            .min_by(|a, b| away(&a.joints).total_cmp(&away(&b.joints)))
    }

    pub fn is_within_limits(&self, joints: &[f64]) -> bool {
        self.robot
            .limit_margin(joints)
            .is_none_or(|(_, margin)| margin >= 0.0)
    }

    /// The straight move from `from` to a pose; `None` if it leaves the reach or the joint limits, changes the posture, or does not
    /// keep the demanded clearance.
    pub fn straight(&self, from: &ArmAt, to: &Isometry) -> Option<Straight> {
        let mut cell = self.cell_state();
        let (a, b) = (&from.base_from_tool, to);
        let length = (b.translation.vector - a.translation.vector).norm();
        let turn = a.rotation.angle_to(&b.rotation);
        let pieces = (length / SAMPLE).max(turn / SAMPLE_TURN).ceil().clamp(1.0, 1e5) as usize;
        let (mut at, mut fastest) = (from.clone(), f64::INFINITY);
        for piece in 1..=pieces {
            let part = piece as f64 / pieces as f64;
            let pose = match piece == pieces {
                true => *to,
                false => a.try_lerp_slerp(b, part, f64::EPSILON).unwrap_or(*to),
            };
            let next = self.next_to(&pose, &at.joints)?;
            if let Some((state, least)) = &mut cell
                && state.conflict_on_move(&at.joints, &next.joints, *least).is_some()
            {
                return None;
            }
            let shortest = self.shortest_time(&at.joints, &next.joints);
            if length > 0.0 && shortest > 0.0 {
                fastest = fastest.min(PART_OF_SPEED * length / pieces as f64 / shortest);
            }
            at = next;
        }
        Some(Straight { end: at, fastest })
    }

    /// The bodies of the cell and the demanded clearance, m; none if the study has none.
    fn cell_state(&self) -> Option<(CellState<'_>, f64)> {
        let cell = self.setting.cell.as_ref()?;
        let state = CellState::new(cell.placed(), self.robot, &self.setting.flange_from_tool);
        Some((state, cell.least))
    }

    /// What comes nearer than demanded on a joint move, rad (m), in words.
    pub fn conflict_on_move(&self, from: &[f64], to: &[f64]) -> Option<String> {
        let (mut state, least) = self.cell_state()?;
        let found = state.conflict_on_move(from, to, least)?;
        let cell = &self.setting.cell.as_ref()?.cell;
        let [first, second] = found.bodies.map(|body| cell.name(body));
        Some(match found.nearest.distance > 0.0 {
            true => format!(
                "{first} and {second} come as near as {:.1} mm",
                to_mm(found.nearest.distance)
            ),
            false => format!("{first} and {second} touch"),
        })
    }

    /// Time that the joints need at least, s.
    fn shortest_time(&self, from: &[f64], to: &[f64]) -> f64 {
        let moves = from.iter().zip(to).zip(self.robot.joints());
        moves
            .filter_map(|((from, to), joint)| Some((to - from).abs() / joint.max_speed?))
            .fold(0.0, f64::max)
    }

    /// The tip along a joint move, in the frame of the path, m.
    pub fn tips<'b>(&'b self, from: &'b [f64], to: &'b [f64]) -> impl Iterator<Item = Point3<f64>> + 'b {
        let path_from_base = self.base_from_path.inverse();
        (0..=JOINT_SAMPLES).map(move |index| {
            let part = index as f64 / JOINT_SAMPLES as f64;
            let q: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + (b - a) * part).collect();
            path_from_base * Point3::from(self.at_joints(&q).base_from_tool.translation.vector)
        })
    }
}
