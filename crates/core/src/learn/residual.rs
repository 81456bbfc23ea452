//! The learnt residual of an arm.
//!
//! The settings are the most likely ones of at most [`MOST_FOR_SETTINGS`] poses, evenly chosen, from two starts for each kind of
//! axes; the process then uses at most [`MOST_POSES`] poses.

use nalgebra::DVector;

use super::evidence::Evidence;
use super::search::minimum;
use crate::calibrate::{Calibrated, MeasuredPose, Refusal};
use crate::robot::Robot;
use crate::robot::learnt::{Learnt, LearntAxes, LearntError, LearntSettings, MOST_POSES, ResidualAt};
use crate::robot::learnt_of_robot::components;

/// Most poses that decide the settings: each comparison takes the third power of their number.
pub const MOST_FOR_SETTINGS: usize = 300;
/// The second start: this fraction of the prior length scales.
const SHORTER: f64 = 0.4;
/// Range of length scales and scatter; the likelihood is flat beyond.
const LEAST: f64 = 1e-2;
const GREATEST: f64 = 20.0;

/// What `calibrated` leaves of `poses`: measured minus modelled position, in the base of the robot.
///
/// # Errors
/// Poses of another robot.
pub fn residuals(
    robot: &Robot,
    calibrated: &Calibrated,
    poses: &[MeasuredPose],
) -> Result<Vec<ResidualAt>, Refusal> {
    let errors = calibrated.errors_of(robot, poses)?;
    let base_from_tracker = calibrated.tracker_from_base.rotation.inverse();
    let of = |(pose, error): (&MeasuredPose, &nalgebra::Vector3<f64>)| ResidualAt {
        joints: pose.joints.clone(),
        residual: base_from_tracker * error,
    };
    Ok(poses.iter().zip(&errors.position).map(of).collect())
}

/// The residual of `robot` that these poses make most likely.
///
/// # Errors
/// See [`LearntError`].
pub fn learn(robot: &Robot, poses: &[ResidualAt]) -> Result<Learnt, LearntError> {
    let used: Vec<ResidualAt> = evenly(poses, MOST_POSES).into_iter().cloned().collect();
    let joints = robot.joints().len();
    // Poses that are not valid are refused before anything is computed of them.
    let probe = |axes| LearntSettings {
        lengths: vec![1.0; joints],
        noise: 0.5,
        axes,
    };
    Learnt::new(robot, &used, probe(LearntAxes::Base))?;
    let best = [LearntAxes::Base, LearntAxes::FirstJoint]
        .into_iter()
        .filter_map(|axes| most_likely(robot, &used, axes))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let settings = best.map_or_else(|| probe(LearntAxes::Base), |(settings, _)| settings);
    Learnt::new(robot, &used, settings)
}

/// The most likely settings with these axes, and their value.
fn most_likely(robot: &Robot, poses: &[ResidualAt], axes: LearntAxes) -> Option<(LearntSettings, f64)> {
    let chosen: Vec<ResidualAt> = evenly(poses, MOST_FOR_SETTINGS).into_iter().cloned().collect();
    let evidence = Evidence::new(
        robot,
        &chosen.iter().collect::<Vec<_>>(),
        &components(robot, &chosen, axes),
    );
    let joints = robot.joints().len();
    let shorter = DVector::from_fn(joints + 1, |k, _| if k < joints { SHORTER.ln() } else { 0.0 });
    let starts = [evidence.prior().clone(), evidence.prior() + shorter];
    let found = starts
        .iter()
        .filter_map(|start| minimum(|at| evidence.at(at), start));
    let (at, value) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let setting = |k: usize| at[k].exp().clamp(LEAST, GREATEST);
    Some((
        LearntSettings {
            lengths: (0..joints).map(setting).collect(),
            noise: setting(joints),
            axes,
        },
        value,
    ))
}

/// At most `most` of these, evenly chosen, in their order.
fn evenly<T>(all: &[T], most: usize) -> Vec<&T> {
    let step = (all.len() as f64 / most as f64).max(1.0);
    let count = (all.len() as f64 / step).round() as usize;
    (0..count)
        .filter_map(|k| all.get((k as f64 * step) as usize))
        .collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::arms;

    /// Gears of joints 1 and 2 with an error once a turn, and scatter of 20 um.
    fn poses(robot: &Robot, count: usize, seed: u64) -> Vec<ResidualAt> {
        let mut stream = arms::Stream(seed);
        (0..count)
            .map(|_| {
                let joints = stream.joints(robot);
                let truth = truth(&joints);
                ResidualAt {
                    residual: truth + stream.vector(20e-6),
                    joints,
                }
            })
            .collect()
    }

    fn truth(q: &[f64]) -> Vector3<f64> {
        Vector3::new(
            2e-4 * q[0].sin(),
            1.5e-4 * (q[1] + 0.4).cos() * q[0].cos(),
            1e-4 * q[1].sin(),
        )
    }

    fn rms(errors: impl Iterator<Item = Vector3<f64>>) -> f64 {
        let (count, sum) = errors.fold((0.0, 0.0), |(count, sum), e| {
            (count + 1.0, sum + e.norm_squared())
        });
        (sum / count).sqrt()
    }

    #[test]
    fn a_hidden_function_is_found_and_its_uncertainty_covers_other_poses() {
        let robot = arms::mh12();
        let learnt = learn(&robot, &poses(&robot, 150, 3)).unwrap();
        let others = poses(&robot, 400, 4);
        let before = rms(others.iter().map(|pose| pose.residual));
        let after = rms(others
            .iter()
            .map(|pose| pose.residual - learnt.mean(&pose.joints)));
        // The scatter of 20 um along each axis, uniform: 20 um rms of the three axes together.
        assert!(before > 1.4e-4 && after < 4e-5, "{before} {after}");
        let inside = others.iter().flat_map(|pose| {
            let here = learnt.at(&pose.joints);
            here.uncertainty.map(|u| {
                let off = (pose.residual - here.mean).dot(&u) / u.norm_squared();
                off.abs() < 1.96
            })
        });
        let inside = inside.filter(|inside| *inside).count() as f64 / 1200.0;
        assert!((0.90..=0.99).contains(&inside), "{inside}");
        // Joints 4 to 6 have no effect: their length scales are long.
        let lengths = &learnt.settings().lengths;
        assert!(
            lengths[3..]
                .iter()
                .all(|length| *length > 2.0 * lengths[0].max(lengths[1])),
            "{lengths:?}"
        );
    }

    #[test]
    fn scatter_alone_is_not_mistaken_for_a_function() {
        let robot = arms::mh12();
        let mut stream = arms::Stream(9);
        let noise = |stream: &mut arms::Stream| ResidualAt {
            joints: stream.joints(&robot),
            residual: stream.vector(5e-5),
        };
        let all: Vec<ResidualAt> = (0..200).map(|_| noise(&mut stream)).collect();
        let learnt = learn(&robot, &all[..120]).unwrap();
        let before = rms(all[120..].iter().map(|pose| pose.residual));
        let after = rms(all[120..]
            .iter()
            .map(|pose| pose.residual - learnt.mean(&pose.joints)));
        assert!(after < 1.05 * before, "{before} {after}");
    }

    #[test]
    fn even_choices_keep_the_order_and_the_number() {
        let all: Vec<usize> = (0..1000).collect();
        assert_eq!(evenly(&all, 2000).len(), 1000);
        let some = evenly(&all, 300);
        assert_eq!(some.len(), 300);
        assert!(some.windows(2).all(|pair| pair[0] < pair[1]) && *some[299] > 990);
    }
}
