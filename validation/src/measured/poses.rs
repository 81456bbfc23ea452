//! Measured poses of an arm: by the nominal, the calibrated and the learnt model, held out and on other paths.

use armill_core::calibrate::{MeasuredPose, ParameterSet, Prior, Question, fit};
use armill_core::frame::Isometry;
use armill_core::learn::{HeldOut, Models, OtherSetUp, held_out, learn, on_other_poses, residuals};
use armill_core::robot::Robot;
use armill_core::units::{from_deg, from_mm};
use armill_core::watch::Watch;

use super::Comparison;

/// Length that weighs as much as a rotation of 1 rad, m.
pub const TURN_LENGTH: f64 = 0.2;

/// The question of all sets: the geometry with a prior of 0.5 mm and 0.05 deg.
pub fn question() -> Question {
    Question {
        requested: ParameterSet::Geometry,
        flange_from_point: Isometry::identity(),
        turn_length: TURN_LENGTH,
        prior: Some(Prior {
            length: from_mm(0.5),
            angle: from_deg(0.05),
        }),
    }
}

/// Positions held out in this number of stretches.
pub fn stretches_held_out(
    robot: &Robot,
    name: &str,
    poses: &[MeasuredPose],
    stretches: usize,
) -> Vec<Comparison> {
    let errors = held_out(robot, poses, &question(), stretches, Watch::NONE)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    Comparison::of_models(&format!("{name}, held out in {stretches} stretches"), &errors)
}

/// Positions of each of `others` by what was found from `poses`; base and point are found from them.
pub fn on_others(
    robot: &Robot,
    question: &Question,
    (name, poses): (&str, &[MeasuredPose]),
    others: &[(&str, &[MeasuredPose])],
) -> Vec<Comparison> {
    let with = |requested| Question {
        requested,
        ..question.clone()
    };
    let found =
        |requested| fit(robot, poses, &with(requested)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (nominal, calibrated) = (found(ParameterSet::BaseAndTool), found(ParameterSet::Geometry));
    let left = residuals(robot, &calibrated, poses).unwrap_or_else(|error| panic!("{name}: {error}"));
    let learnt = learn(robot, &left).unwrap_or_else(|error| panic!("{name}: {error}"));
    let models = Models {
        nominal: &nominal,
        calibrated: &calibrated,
        learnt: &learnt,
    };
    let on = |(other, poses): &(&str, &[MeasuredPose])| {
        let errors: HeldOut = on_other_poses(robot, models, OtherSetUp::BaseAndPoint, poses, question)
            .unwrap_or_else(|error| panic!("{name}, {other}: {error}"));
        Comparison::of_models(&format!("{other}, from {name}"), &errors)
    };
    others.iter().flat_map(on).collect()
}

#[cfg(test)]
pub(super) mod testing {
    use super::*;

    /// Root mean square of position (mm) and rotation (deg): nominal with base and point fitted, and calibrated without a prior.
    pub fn least_squares(robot: &Robot, poses: &[MeasuredPose]) -> [[f64; 2]; 2] {
        [ParameterSet::BaseAndTool, ParameterSet::Geometry].map(|requested| {
            let question = Question {
                requested,
                prior: None,
                ..question()
            };
            let errors = fit(robot, poses, &question).unwrap().errors;
            let turn = errors.of_turn().unwrap();
            [errors.of_position().unwrap().rms * 1e3, turn.rms.to_degrees()]
        })
    }

    /// Whether both are those of another program, within this part.
    pub fn assert_near(found: [[f64; 2]; 2], expected: [[f64; 2]; 2], part: f64) {
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found / expected - 1.0).abs() < part, "{found} {expected}");
        }
    }
}
