//! Errors of poses that were not used: with the nominal, the calibrated and the learnt model, each found again without them.
//!
//! The poses are divided into stretches of equal length in the order of their file; neighbours of a path are therefore held out
//! together. For each stretch base and tool (nominal), the geometry (calibrated) and the residual with all its settings (learnt)
//! are found from the others alone: no number that is chosen has seen the pose it is tried on.

use nalgebra::{DMatrix, Matrix3xX, Vector3};
use rayon::prelude::*;

use super::residual::{learn, residuals};
use crate::calibrate::{Calibrated, MeasuredPose, ParameterLocation, ParameterSet, Question, Refusal, fit};
use crate::robot::Robot;
use crate::robot::learnt::{Learnt, LearntError, LearntResidual};
use crate::watch::Watch;

/// Half width of an interval that holds 95 % of a normal distribution, in standard deviations.
const NORMAL_95: f64 = 1.959_964;

/// Errors of poses that were held out, in the order of the poses.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldOut {
    /// Measured minus predicted position, m, axes of the tracker; base and tool found, the chain nominal.
    pub nominal: Vec<Vector3<f64>>,
    /// With the calibrated chain.
    pub calibrated: Vec<Vector3<f64>>,
    /// With the learnt residual in addition.
    pub learnt: Vec<Vector3<f64>>,
    /// Fraction of all components within the 95 % interval of the learnt model and its geometry.
    pub coverage: f64,
}

/// Mean reduction of the squared error by the learnt residual, and its standard error, m^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Mean over the stretches.
    pub mean: f64,
    /// Its standard error, from the differences between the stretches.
    pub standard_error: f64,
}

impl Reduction {
    /// Whether it is beyond its uncertainty: the mean exceeds twice the standard error.
    pub fn is_significant(&self) -> bool {
        self.mean > 2.0 * self.standard_error && self.mean > 0.0
    }
}

impl HeldOut {
    /// How much the learnt residual reduces the squared error of the calibrated model; the poses in `stretches` stretches.
    pub fn reduction(&self, stretches: usize) -> Reduction {
        let count = self.learnt.len();
        let difference = |k: usize| self.calibrated[k].norm_squared() - self.learnt[k].norm_squared();
        let of = |k: usize| {
            let stretch = k * count / stretches..(k + 1) * count / stretches;
            let size = stretch.len().max(1) as f64;
            stretch.map(difference).sum::<f64>() / size
        };
        let each: Vec<f64> = (0..stretches).map(of).collect();
        let mean = each.iter().sum::<f64>() / stretches as f64;
        let scatter: f64 = each.iter().map(|one| (one - mean).powi(2)).sum();
        Reduction {
            mean,
            standard_error: (scatter / (stretches * (stretches - 1)) as f64).sqrt(),
        }
    }
}

/// Why no poses could be held out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FewPoses {
    /// The calibration without one stretch.
    #[error("without poses {} to {}: {error}", .first + 1, .last + 1)]
    Calibration {
        /// First pose of the stretch, from 0.
        first: usize,
        /// Last one.
        last: usize,
        /// What is wrong.
        error: Refusal,
    },
    /// The residual without one stretch.
    #[error(transparent)]
    Learnt(#[from] LearntError),
    /// Fewer poses than stretches.
    #[error("{0} poses cannot be divided into {1} stretches")]
    Stretches(usize, usize),
    /// Cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Errors of `poses` of `robot`, held out in `stretches` stretches.
///
/// # Errors
/// See [`FewPoses`].
pub fn held_out(
    robot: &Robot,
    poses: &[MeasuredPose],
    question: &Question,
    stretches: usize,
    watch: Watch<'_>,
) -> Result<HeldOut, FewPoses> {
    if stretches < 2 || poses.len() < 2 * stretches {
        return Err(FewPoses::Stretches(poses.len(), stretches));
    }
    let end = |k: usize| k * poses.len() / stretches;
    let each = (0..stretches).into_par_iter().map(|k| {
        if watch.is_cancelled() {
            return Err(FewPoses::Cancelled);
        }
        let found = without(robot, poses, question, [end(k), end(k + 1)])?;
        (watch.finished)(end(k + 1) - end(k));
        Ok(found)
    });
    let parts = each.collect::<Result<Vec<HeldOut>, FewPoses>>()?;
    let join = |of: fn(&HeldOut) -> &Vec<Vector3<f64>>| parts.iter().flat_map(of).copied().collect();
    let weighted = |part: &HeldOut| part.coverage * part.learnt.len() as f64;
    Ok(HeldOut {
        nominal: join(|part| &part.nominal),
        calibrated: join(|part| &part.calibrated),
        learnt: join(|part| &part.learnt),
        coverage: parts.iter().map(weighted).sum::<f64>() / poses.len() as f64,
    })
}

/// Errors of the poses of one stretch, by models that were found without it.
fn without(
    robot: &Robot,
    poses: &[MeasuredPose],
    question: &Question,
    [from, to]: [usize; 2],
) -> Result<HeldOut, FewPoses> {
    let refused = |error| FewPoses::Calibration {
        first: from,
        last: to - 1,
        error,
    };
    let training = [&poses[..from], &poses[to..]].concat();
    let held = &poses[from..to];
    let frames = Question {
        requested: ParameterSet::BaseAndTool,
        ..question.clone()
    };
    let nominal = fit(robot, &training, &frames).map_err(refused)?;
    let calibrated = fit(robot, &training, question).map_err(refused)?;
    let learnt = learn(robot, &residuals(robot, &calibrated, &training).map_err(refused)?)?;
    let left = residuals(robot, &calibrated, held).map_err(refused)?;
    let tracker_from_base = calibrated.tracker_from_base.rotation;
    let base_from_tracker = tracker_from_base.inverse().to_rotation_matrix().into_inner();
    let geometry = root_of(&calibrated.covariance);
    let mut inside = 0;
    let mut after = Vec::with_capacity(held.len());
    for pose in &left {
        let here = learnt.at(&pose.joints);
        let error = pose.residual - here.mean;
        let by_geometry = base_from_tracker * calibrated.derivatives(robot, &pose.joints) * &geometry;
        inside += components_inside(&here, &by_geometry, &error);
        after.push(tracker_from_base * error);
    }
    let errors = |of: &Calibrated| {
        let errors = of.errors_of(robot, held).map_err(refused);
        errors.map(|errors| errors.position)
    };
    Ok(HeldOut {
        nominal: errors(&nominal)?,
        calibrated: errors(&calibrated)?,
        learnt: after,
        coverage: inside as f64 / (3 * held.len()) as f64,
    })
}

/// Models that were found from the same poses.
#[derive(Clone, Copy, Debug)]
pub struct Models<'a> {
    /// Base and tool found, the chain nominal.
    pub nominal: &'a Calibrated,
    /// Base, tool and chain found.
    pub calibrated: &'a Calibrated,
    /// What the calibrated chain leaves.
    pub learnt: &'a Learnt,
}

/// What is found from the poses of another set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OtherSetUp {
    /// Base and measured point: the point was mounted again.
    BaseAndPoint,
    /// The base alone: the point has not been touched since the training.
    Base,
}

/// Errors of poses that were measured from another position of the tracker: base and, if it was mounted again, the measured point are found
/// from them, for each model; chain and residual are those of the training.
///
/// # Errors
/// Poses of another robot, or too few.
pub fn on_other_poses(
    robot: &Robot,
    models: Models<'_>,
    set_up: OtherSetUp,
    poses: &[MeasuredPose],
    question: &Question,
) -> Result<HeldOut, Refusal> {
    let Models {
        nominal,
        calibrated,
        learnt,
    } = models;
    let frames = |of: &Calibrated| Question {
        requested: match set_up {
            OtherSetUp::BaseAndPoint => ParameterSet::BaseAndTool,
            OtherSetUp::Base => ParameterSet::Base,
        },
        flange_from_point: of.flange_from_point,
        ..question.clone()
    };
    let with_chain = calibrated.bare_robot(robot).map_err(|_| Refusal::NotFound)?;
    let nominal = fit(robot, poses, &frames(nominal))?;
    let frames = frames(calibrated);
    let mut found = fit(&with_chain, poses, &frames)?;
    let before = found.errors.position.clone();
    // The residual is added along the axes of the base, which are found with it.
    for _ in 0..ROUNDS {
        let without: Vec<MeasuredPose> = poses
            .iter()
            .map(|pose| MeasuredPose {
                position: pose.position - found.tracker_from_base.rotation * learnt.mean(&pose.joints),
                ..pose.clone()
            })
            .collect();
        found = fit(&with_chain, &without, &frames)?;
    }
    let base_from_tracker = found.tracker_from_base.rotation.inverse();
    let by_geometry = by_geometry(robot, calibrated, (&with_chain, &found), poses);
    let each = poses.iter().zip(&found.errors.position).zip(&by_geometry);
    let inside: usize = each
        .map(|((pose, error), by_geometry)| {
            components_inside(
                &learnt.at(&pose.joints),
                by_geometry,
                &(base_from_tracker * error),
            )
        })
        .sum();
    Ok(HeldOut {
        nominal: nominal.errors.position,
        calibrated: before,
        coverage: inside as f64 / (3 * poses.len()) as f64,
        learnt: found.errors.position,
    })
}

/// Directions of frames with less than this part of the largest effect are none.
const INDEPENDENT: f64 = 1e-9;
/// Rounds of frames and residual: the axes of the base change by microradians.
const ROUNDS: usize = 2;

/// Displacement of the point (m, base) at each pose by one standard uncertainty of each independent input of the calibrated chain, less what base and
/// point, which are found from these poses, take of it.
fn by_geometry(
    robot: &Robot,
    calibrated: &Calibrated,
    (with_chain, found): (&Robot, &Calibrated),
    poses: &[MeasuredPose],
) -> Vec<Matrix3xX<f64>> {
    let of_chain = |k: &usize| {
        matches!(
            calibrated.estimates[*k].unknown.place,
            ParameterLocation::After(_)
        )
    };
    let chain: Vec<usize> = (0..calibrated.estimates.len()).filter(of_chain).collect();
    let root = root_of(&DMatrix::from_fn(chain.len(), chain.len(), |i, j| {
        calibrated.covariance[(chain[i], chain[j])]
    }));
    let in_base = |of: &Calibrated| {
        of.tracker_from_base
            .rotation
            .inverse()
            .to_rotation_matrix()
            .into_inner()
    };
    let mut all = DMatrix::zeros(3 * poses.len(), root.ncols());
    let mut frames = DMatrix::zeros(3 * poses.len(), found.estimates.len());
    for (k, pose) in poses.iter().enumerate() {
        let here = in_base(calibrated) * calibrated.derivatives(robot, &pose.joints).select_columns(&chain);
        all.rows_mut(3 * k, 3).copy_from(&(here * &root));
        let here = in_base(found) * found.derivatives(with_chain, &pose.joints);
        frames.rows_mut(3 * k, 3).copy_from(&here);
    }
    let basis = orthonormal(frames);
    all -= &basis * basis.tr_mul(&all);
    (0..poses.len())
        .map(|k| Matrix3xX::from_fn(root.ncols(), |axis, input| all[(3 * k + axis, input)]))
        .collect()
}

/// An orthonormal basis of the columns.
fn orthonormal(columns: DMatrix<f64>) -> DMatrix<f64> {
    let parts = columns.svd(true, false);
    let least = INDEPENDENT * parts.singular_values.max();
    let kept: Vec<usize> = (0..parts.singular_values.len())
        .filter(|k| parts.singular_values[*k] > least)
        .collect();
    (parts.u).map_or_else(|| DMatrix::zeros(0, 0), |u| u.select_columns(&kept))
}

/// A matrix whose square (times its transpose) is this covariance.
fn root_of(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let axes = covariance.clone().symmetric_eigen();
    let lengths = axes.eigenvalues.map(|variance| variance.max(0.0).sqrt());
    axes.eigenvectors * DMatrix::from_diagonal(&lengths)
}

/// How many components of `error` (m, base) are within the 95 % interval of this residual and of the geometry, whose independent inputs displace the
/// point by the columns of `by_geometry`.
fn components_inside(here: &LearntResidual, by_geometry: &Matrix3xX<f64>, error: &Vector3<f64>) -> usize {
    let inside = |u: &&Vector3<f64>| {
        let axis = u.normalize();
        let variance = u.norm_squared() + by_geometry.tr_mul(&axis).norm_squared();
        error.dot(&axis).abs() <= NORMAL_95 * variance.sqrt()
    };
    here.uncertainty.iter().filter(inside).count()
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::arms;
    use crate::frame::Isometry;
    use crate::robot::forward::forward;

    /// Poses of an arm whose first joint has an error of its gear, 0.3 mrad once a turn.
    fn poses(robot: &Robot, count: usize) -> Vec<MeasuredPose> {
        let mut stream = arms::Stream(17);
        (0..count)
            .map(|_| {
                let joints = stream.joints(robot);
                let mut actual = joints.clone();
                actual[0] += 3e-4 * (joints[0] + 0.5).cos();
                let flange = forward(robot, &actual).base_from_flange;
                MeasuredPose {
                    position: (flange * Point3::new(0.05, 0.02, 0.15)).coords + stream.vector(5e-6),
                    joints,
                    rotation: None,
                }
            })
            .collect()
    }

    fn rms(errors: &[Vector3<f64>]) -> f64 {
        (errors.iter().map(Vector3::norm_squared).sum::<f64>() / errors.len() as f64).sqrt()
    }

    #[test]
    fn a_gear_error_that_no_geometry_has_is_learnt_and_confirmed_by_poses_held_out() {
        let robot = arms::mh12();
        let question = Question {
            requested: ParameterSet::Zeros,
            flange_from_point: Isometry::identity(),
            turn_length: 1.0,
            prior: None,
        };
        let found = held_out(&robot, &poses(&robot, 120), &question, 4, Watch::NONE).unwrap();
        let [calibrated, learnt] = [&found.calibrated, &found.learnt].map(|errors| rms(errors));
        // Ninety postures over the whole range of six joints.
        assert!(
            calibrated > 1e-4 && learnt < 0.5 * calibrated,
            "{calibrated} {learnt}"
        );
        assert!(found.coverage > 0.88, "{}", found.coverage);
        assert_eq!(found.nominal.len(), 120);
        assert!(found.reduction(4).is_significant());
    }

    #[test]
    fn a_reduction_within_the_differences_of_the_stretches_is_not_significant() {
        let along = |sizes: [f64; 6]| sizes.map(|size| Vector3::new(size, 0.0, 0.0)).to_vec();
        let held = |learnt: [f64; 6]| HeldOut {
            nominal: Vec::new(),
            calibrated: along([2.0; 6]),
            learnt: along(learnt),
            coverage: 1.0,
        };
        let steady = held([1.0, 1.0, 1.0, 1.0, 1.0, 1.0]).reduction(3);
        assert_eq!((steady.mean, steady.standard_error), (3.0, 0.0));
        // 4 - 0, 4 - 9, 4 - 1 in the three stretches: mean 2/3, standard error sqrt(((10/3)^2 + (17/3)^2 + (7/3)^2) / 6).
        let mixed = held([0.0, 0.0, 3.0, 3.0, 1.0, 1.0]).reduction(3);
        assert!((mixed.mean - 2.0 / 3.0).abs() < 1e-12);
        assert!((mixed.standard_error - (438.0_f64 / 54.0).sqrt()).abs() < 1e-12);
        assert!(steady.is_significant() && !mixed.is_significant());
    }

    #[test]
    fn poses_of_another_set_up_are_predicted_with_their_own_base() {
        let robot = arms::mh12();
        let all = poses(&robot, 160);
        let question = Question {
            requested: ParameterSet::Zeros,
            flange_from_point: Isometry::identity(),
            turn_length: 1.0,
            prior: None,
        };
        let calibrated = fit(&robot, &all[..110], &question).unwrap();
        let learnt = learn(&robot, &residuals(&robot, &calibrated, &all[..110]).unwrap()).unwrap();
        let tracker = Isometry::new(Vector3::new(3.0, -1.0, 0.4), Vector3::new(0.1, 0.2, 2.5));
        let moved: Vec<MeasuredPose> = all[110..]
            .iter()
            .map(|pose| MeasuredPose {
                position: (tracker * Point3::from(pose.position)).coords,
                ..pose.clone()
            })
            .collect();
        let frames = Question {
            requested: ParameterSet::BaseAndTool,
            ..question.clone()
        };
        let models = Models {
            nominal: &fit(&robot, &all[..110], &frames).unwrap(),
            calibrated: &calibrated,
            learnt: &learnt,
        };
        for set_up in [OtherSetUp::BaseAndPoint, OtherSetUp::Base] {
            let found = on_other_poses(&robot, models, set_up, &moved, &question).unwrap();
            assert!(rms(&found.learnt) < 0.6 * rms(&found.calibrated));
            assert!(found.coverage > 0.85, "{}", found.coverage);
        }
    }

    #[test]
    fn too_few_poses_and_cancellation_are_refused() {
        let robot = arms::mh12();
        let question = Question {
            requested: ParameterSet::BaseAndTool,
            flange_from_point: Isometry::identity(),
            turn_length: 1.0,
            prior: None,
        };
        let poses = poses(&robot, 12);
        let of = |stretches, watch| held_out(&robot, &poses, &question, stretches, watch).unwrap_err();
        assert_eq!(of(7, Watch::NONE), FewPoses::Stretches(12, 7));
        let cancel = std::sync::atomic::AtomicBool::new(true);
        let watch = Watch {
            cancel: &cancel,
            ..Watch::NONE
        };
        assert_eq!(of(4, watch), FewPoses::Cancelled);
    }
}
