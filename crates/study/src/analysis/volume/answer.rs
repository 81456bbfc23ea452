//! A volume in the answer: the part of a box within the tolerance.
//!
//! Its points are counted, not listed: the tables contain them all. The tool is oriented as on the plane of the
//! setting, whose normal defines in-plane and normal deviation.

use armill_core::map::VolumeMap;
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::clearance::LeastClearance;
use crate::analysis::map::answer::CountsAnswer;
use crate::analysis::point::{PointAnswer, ReachedPoint, SettingAnswer};
use crate::analysis::vibration::VibrationAnswer;
use crate::input::setting::Setting;

/// A box of points, the tool oriented as on the plane.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct VolumeAnswer {
    /// Its name.
    pub name: String,
    /// Requested posture: words of a branch, or `best`.
    pub branch: String,
    /// Points within the tolerance over all points.
    pub fraction_within: f64,
    /// The same, of points inside the joint limits only.
    pub fraction_within_and_inside_joint_limits: f64,
    /// Points with a posture outside joint limits.
    pub outside_joint_limits: usize,
    /// Volume of the points within, each representing one cell.
    pub volume_within_mm3: f64,
    /// Points by reason; their sum is the total.
    pub counts: CountsAnswer,
    /// The least distance of two bodies at a point; 0 where they touch, none without bodies.
    pub least_clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// Points along x, y, z of the reference frame.
    pub point_counts: [usize; 3],
    /// Pitch.
    pub step_mm: f64,
    /// The corner with the least coordinates, in the reference frame.
    pub origin_mm: [f64; 3],
    /// The point with the least in-plane deviation.
    pub best: Option<PointAnswer>,
    /// The point with the largest in-plane deviation.
    pub worst: Option<PointAnswer>,
    /// Modes of the arm and stability of the cut; none without `[vibration]`.
    pub vibration: Option<VibrationAnswer>,
    /// The common setting of all points.
    pub setting: SettingAnswer,
}

/// The result of the box of the analysis called `name`.
pub fn answer(
    robot: &Robot,
    name: &str,
    setting: &Setting,
    volume: &VolumeMap,
    vibration: Option<VibrationAnswer>,
) -> VolumeAnswer {
    let counts = volume.counts(setting.tolerance);
    let clearance = LeastClearance::of(setting, &volume.answers);
    let point = |(index, evaluation)| {
        let reached = ReachedPoint {
            answers: &volume.answers,
            index,
            evaluation,
            tcp: volume.grid.point(index),
        };
        PointAnswer::of(robot, setting, &reached)
    };
    VolumeAnswer {
        name: name.to_owned(),
        branch: setting.branch(),
        fraction_within: counts.fraction_within(),
        fraction_within_and_inside_joint_limits: counts.fraction_within_and_inside_joint_limits(),
        outside_joint_limits: counts.outside_joint_limits,
        volume_within_mm3: volume.volume_within(setting.tolerance) * 1e9,
        counts: CountsAnswer::of(&counts),
        least_clearance_mm: clearance.as_ref().map(|least| least.distance_mm),
        nearest: clearance.map(|least| least.bodies),
        point_counts: volume.grid.counts,
        step_mm: to_mm(volume.grid.step),
        origin_mm: setting
            .in_reference(&volume.grid.corner())
            .coords
            .map(|c| crate::number::without_rounding(to_mm(c)))
            .into(),
        best: volume.answers.best().map(point),
        worst: volume.answers.worst().map(point),
        vibration,
        setting: SettingAnswer::of(robot, setting),
    }
}
