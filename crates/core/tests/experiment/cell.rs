//! The true arm and the model in its controller, with the positions of the cuts and of the ball-bar.

use std::sync::Arc;

use armill_core::calibrate::{
    Calibrated, MeasuredPose, ParameterLocation, ParameterSet, Question as CalibrationQuestion, Unknown, fit,
};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::path::{Shape, Track};
use armill_core::robot::forward::forward;
use armill_core::robot::{Amount, Backlash, BacklashSide, JointCompliance, Motion, Robot};
use armill_core::source::StiffnessModel;

use crate::arms::circles::{RADIUS, circle};
use crate::arms::{self, Stream};

/// Points of the ring.
const POINTS: f64 = 360.0;
/// Poses measured by the tracker.
pub const POSES: usize = 60;

/// The true values of one experiment.
pub struct Truth {
    /// The model in the controller.
    pub believed: Robot,
    /// The true arm.
    pub actual: Robot,
    /// Of the geometry: each identifiable small motion, by its name.
    pub geometry: Vec<(String, f64)>,
    /// rad/(N m)
    pub compliance: Vec<f64>,
    /// rad
    pub gaps: Vec<f64>,
    /// Mean cutting force on the tool, N, base.
    pub force: Vector3<f64>,
}

impl Truth {
    pub fn of(seed: u64) -> Truth {
        let mut random = Stream(7_000 + seed);
        let believed = arms::mh12();
        let nominal: Vec<f64> = believed.compliance().unwrap().iter().map(|c| c.value).collect();
        let compliance = nominal.iter().map(|c| c * random.between(0.6, 1.6)).collect();
        let gaps = (0..6).map(|_| random.between(0.5e-4, 3e-4)).collect();
        let (actual, geometry) = bent(&believed, &mut random);
        Truth {
            believed,
            actual,
            geometry,
            compliance,
            gaps,
            force: Vector3::new(40.0, -60.0, 25.0) + random.vector(20.0),
        }
    }

    /// The stiffness model of the true arm.
    pub fn model(&self) -> StiffnessModel {
        model(&self.gaps, &[0.0; 6], self.actual.clone())
    }
}

/// An arm with this geometry and this backlash, in addition to its drives.
pub fn model(gaps: &[f64], u: &[f64], actual: Robot) -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    let with = |(gap, u): (&f64, &f64)| {
        Some(Backlash {
            gap: *gap,
            standard_uncertainty: *u,
            side: BacklashSide::Motion,
        })
    };
    model.structure.backlash = gaps.iter().zip(u).map(with).collect();
    model.actual = Some(Arc::new(actual));
    model
}

/// Drives with these compliances and standard uncertainties.
pub fn drives(values: &[f64], u: &[f64]) -> Vec<JointCompliance> {
    let drive = |(value, u): (&f64, &f64)| JointCompliance {
        value: *value,
        standard_uncertainty: *u,
    };
    values.iter().zip(u).map(drive).collect()
}

/// The milled ring.
pub fn ring() -> Track {
    let circle = circle([0.9, 0.1, 0.5], 90.0);
    let shape = Shape::Circle {
        centre: circle.centre,
        radius: circle.radius,
    };
    Track {
        path: shape.sampled(std::f64::consts::TAU * RADIUS / POINTS),
        placing: circle.placing,
        base_from_part: circle.placing.base_from_path,
        spins: None,
        homes: None,
    }
}

/// Positions of the tracker and its reflector.
pub fn frames() -> [Isometry; 2] {
    [
        Isometry::new(Vector3::new(2.0, -3.0, 0.4), Vector3::new(0.3, -1.2, 2.0)),
        Isometry::translation(0.03, -0.02, 0.11),
    ]
}

/// Poses of `robot` measured by a tracker at random, with noise of this standard deviation in each direction.
pub fn tracked(robot: &Robot, noise: f64, random: &mut Stream) -> Vec<MeasuredPose> {
    let [tracker_from_base, flange_from_point] = frames();
    (0..POSES)
        .map(|_| {
            let joints = random.joints(robot);
            let flange = forward(robot, &joints).base_from_flange;
            let turned = UnitQuaternion::from_rotation_matrix(&flange.rotation);
            let point =
                tracker_from_base * Isometry::from_parts(flange.translation, turned) * flange_from_point;
            let off = Vector3::from_fn(|_, _| noise * random.normal());
            MeasuredPose {
                joints,
                position: point.translation.vector + off,
                rotation: None,
            }
        })
        .collect()
}

/// The geometry of `robot` from these poses.
pub fn calibrated(robot: &Robot, poses: &[MeasuredPose]) -> Calibrated {
    let question = CalibrationQuestion {
        requested: ParameterSet::Geometry,
        flange_from_point: frames()[1],
        turn_length: 0.3,
        prior: None,
    };
    fit(robot, poses, &question).unwrap()
}

/// Small motions of the chain that are identifiable from poses of this arm.
fn identifiable(believed: &Robot) -> Vec<Unknown> {
    let poses = tracked(believed, 0.0, &mut Stream(1));
    let estimates = calibrated(believed, &poses).estimates;
    let unknowns = estimates.into_iter().map(|estimate| estimate.unknown);
    unknowns
        .filter(|unknown| matches!(unknown.place, ParameterLocation::After(_)))
        .collect()
}

/// Name of an unknown in these results.
pub fn name_of(unknown: &Unknown) -> String {
    format!("geometry {:?} {}", unknown.place, unknown.component)
}

/// The arm with an error in each identifiable small motion, up to 0.3 mm and 0.5 mrad.
fn bent(believed: &Robot, random: &mut Stream) -> (Robot, Vec<(String, f64)>) {
    let unknowns = identifiable(believed);
    let errors: Vec<f64> = unknowns
        .iter()
        .map(|unknown| if unknown.turns() { 5e-4 } else { 3e-4 } * random.between(-1.0, 1.0))
        .collect();
    let mut motions = Vec::new();
    for motion in believed.chain().motions() {
        motions.push(*motion);
        let Amount::Joint(joint) = motion.amount() else {
            continue;
        };
        let mut here: Vec<(&Unknown, &f64)> = unknowns
            .iter()
            .zip(&errors)
            .filter(|(unknown, _)| unknown.place == ParameterLocation::After(joint))
            .collect();
        here.sort_by_key(|(unknown, _)| unknown.component);
        motions.extend(here.into_iter().map(|(unknown, error)| {
            let amount = Amount::Constant(*error);
            match unknown.turns() {
                true => Motion::About(unknown.axis(), amount),
                false => Motion::Along(unknown.axis(), amount),
            }
        }));
    }
    let robot = Robot::new("bent", motions, believed.joints().to_vec()).unwrap();
    (robot, unknowns.iter().map(name_of).zip(errors).collect())
}
