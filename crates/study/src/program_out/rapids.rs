//! Tool poses of the rapids of a path: the axes that they give, and as little turn of the tool about itself as possible.

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::path::{Move, Placing};

use super::arm::ArmAt;

/// Rapids of a path with this placing.
pub(super) struct RapidPoses<'a> {
    pub placing: &'a Placing,
}

impl RapidPoses<'_> {
    /// The poses of rapids after a cut: the tool has their axes, and turns about itself as little as possible.
    pub fn after(&self, from: &ArmAt, moves: &[Move]) -> Vec<Isometry> {
        let mut rotation = from.base_from_tool.rotation;
        let pose = |next: &Move| {
            rotation = self.with_axis(rotation, next);
            self.at(next, rotation)
        };
        moves.iter().map(pose).collect()
    }

    /// The poses of rapids before a cut.
    pub fn before(&self, to: &ArmAt, moves: &[Move]) -> Vec<Isometry> {
        let mut rotation = to.base_from_tool.rotation;
        let pose = |next: &Move| {
            rotation = self.with_axis(rotation, next);
            self.at(next, rotation)
        };
        let mut poses: Vec<Isometry> = moves.iter().rev().map(pose).collect();
        poses.reverse();
        poses
    }

    /// The poses of rapids between two cuts: the turn about the tool axis that is left is distributed over them.
    pub fn between(&self, from: &ArmAt, to: &ArmAt, moves: &[Move]) -> Vec<Isometry> {
        let mut poses = self.after(from, moves);
        let Some(last) = poses.last() else {
            return poses;
        };
        let axis = to.base_from_tool.rotation * Vector3::z();
        let arrived = turned_to(last.rotation, &axis);
        let left = arrived.inverse() * to.base_from_tool.rotation;
        let spin = 2.0 * left.k.atan2(left.w);
        let spin = spin - TAU * (spin / TAU).round();
        let count = poses.len() as f64;
        for (index, pose) in poses.iter_mut().enumerate() {
            let part = spin * (index + 1) as f64 / count;
            pose.rotation *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), part);
        }
        poses
    }

    fn with_axis(&self, rotation: UnitQuaternion<f64>, next: &Move) -> UnitQuaternion<f64> {
        let placing = self.placing;
        match next.axis.filter(|_| !placing.keeps_axis) {
            Some(axis) => turned_to(rotation, &-(placing.base_from_path.rotation * axis.into_inner())),
            None => rotation,
        }
    }

    fn at(&self, next: &Move, rotation: UnitQuaternion<f64>) -> Isometry {
        let tip = self.placing.base_from_path * next.end;
        Isometry::from_parts(tip.coords.into(), rotation)
    }
}

/// The orientation with z of the tool along `axis`, by the shortest rotation.
fn turned_to(rotation: UnitQuaternion<f64>, axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    let z = rotation * Vector3::z();
    UnitQuaternion::rotation_between(&z, axis).map_or(rotation, |turn| turn * rotation)
}
