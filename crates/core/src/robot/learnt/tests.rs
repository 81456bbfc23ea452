use super::*;
use crate::arms;

fn settings(axes: LearntAxes) -> LearntSettings {
    LearntSettings {
        lengths: (0..6).map(|joint| 1.0 + 0.2 * f64::from(joint)).collect(),
        noise: 0.4,
        axes,
    }
}

fn poses(count: usize) -> Vec<ResidualAt> {
    let residual = |i: f64| Vector3::new(i.cos(), (2.0 * i).sin(), 0.3 * i - 1.0) * 1e-4;
    let pose = |i: usize| ResidualAt {
        joints: (0..6)
            .map(|j| (1.7 * i as f64 + 0.9 * f64::from(j)).sin())
            .collect(),
        residual: residual(i as f64),
    };
    (0..count).map(pose).collect()
}

fn target() -> Vec<f64> {
    (0..6).map(|j| 0.3 - 0.1 * f64::from(j)).collect()
}

/// scikit-learn 1.x, `GaussianProcessRegressor(RBF(1, "fixed"), alpha=0.16)` on the cosines and sines over their length scales;
/// `s_c` by numpy from the same matrix.
#[test]
fn mean_and_uncertainty_are_those_of_scikit_learn() {
    let learnt = Learnt::new(&arms::mh12(), &poses(8), settings(LearntAxes::Base)).unwrap();
    let here = learnt.at(&target());
    let close = |found: f64, expected_um: f64| assert!((found * 1e6 - expected_um).abs() < 1e-6, "{found}");
    for (c, expected) in [20.360_463_86, 19.514_182, -8.322_902_37].into_iter().enumerate() {
        close(here.mean[c], expected);
    }
    for (c, expected) in [131.756_645_88, 99.770_317_48, 139.777_051_08]
        .into_iter()
        .enumerate()
    {
        close(learnt.deviation()[c], expected);
    }
    for (c, expected) in [96.689_339_8, 73.216_239_42, 102.575_097_43]
        .into_iter()
        .enumerate()
    {
        close(here.uncertainty[c].norm(), expected);
    }
    assert!((learnt.mean(&target()) - here.mean).norm() < 1e-18);
}

#[test]
fn far_from_every_pose_nothing_is_corrected_and_the_uncertainty_is_that_of_the_arm() {
    let mut near = settings(LearntAxes::Base);
    near.lengths = vec![0.2; 6];
    let learnt = Learnt::new(&arms::mh12(), &poses(8), near).unwrap();
    let far = [2.8, -2.9, 3.0, 2.7, -3.0, 2.9];
    let here = learnt.at(&far);
    assert!(here.mean.norm() < 1e-9, "{}", here.mean);
    assert!(learnt.weight(&far) < 1e-6);
    for c in 0..3 {
        let expected = learnt.deviation()[c] * 1.16_f64.sqrt();
        assert!((here.uncertainty[c].norm() / expected - 1.0).abs() < 1e-6);
    }
    // At a pose alone in its neighbourhood the weight is 1 / (1 + n^2).
    let at_pose = learnt.weight(&poses(8)[3].joints);
    assert!((at_pose - 1.0 / 1.16).abs() < 0.01, "{at_pose}");
}

#[test]
fn a_whole_turn_changes_nothing_and_a_prismatic_joint_has_no_turns() {
    let learnt = Learnt::new(&arms::mh12(), &poses(8), settings(LearntAxes::FirstJoint)).unwrap();
    let mut turned = target();
    turned[0] += std::f64::consts::TAU;
    turned[5] -= std::f64::consts::TAU;
    assert!((learnt.mean(&turned) - learnt.mean(&target())).norm() < 1e-15);
    let rail = arms::other::on_rail(&arms::mh12());
    let on_rail: Vec<ResidualAt> = poses(8)
        .into_iter()
        .map(|mut pose| {
            pose.joints.insert(0, 0.5 * pose.joints[3]);
            pose
        })
        .collect();
    let mut with_rail = settings(LearntAxes::FirstJoint);
    with_rail.lengths.insert(0, 0.5);
    let learnt = Learnt::new(&rail, &on_rail, with_rail).unwrap();
    let mut q = target();
    q.insert(0, 1e3);
    assert!(learnt.weight(&q) < 1e-12);
}

#[test]
fn an_error_behind_the_first_joint_rotates_with_it() {
    let robot = arms::mh12();
    let behind = Vector3::new(3e-4, -1e-4, 2e-4);
    let sign = robot.joints()[0].sign.factor();
    let rotated = |q: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), sign * q) * behind;
    let poses: Vec<ResidualAt> = (0..12)
        .map(|k| {
            let mut joints = vec![0.1; 6];
            joints[0] = 0.5 * f64::from(k) - 3.0;
            ResidualAt {
                residual: rotated(joints[0]),
                joints,
            }
        })
        .collect();
    let of = |axes| {
        let settings = LearntSettings {
            lengths: vec![3.0; 6],
            noise: 0.01,
            axes,
        };
        let learnt = Learnt::new(&robot, &poses, settings).unwrap();
        let q = [0.77, 0.1, 0.1, 0.1, 0.1, 0.1];
        (learnt.mean(&q) - rotated(0.77)).norm()
    };
    // Constant in these axes: the process finds it from any pose.
    assert!(of(LearntAxes::FirstJoint) < 1e-6);
    assert!(of(LearntAxes::Base) < 3e-5);
}

#[test]
fn a_shift_moves_the_mean_by_one_standard_uncertainty() {
    let learnt = Learnt::new(&arms::mh12(), &poses(8), settings(LearntAxes::FirstJoint)).unwrap();
    let here = learnt.at(&target());
    for c in 0..3 {
        let by = learnt.shifted(c).mean(&target()) - here.mean;
        assert!((by - here.uncertainty[c]).norm() < 1e-18);
    }
}

#[test]
fn refuses_what_cannot_be_learnt() {
    let robot = arms::mh12();
    let refused =
        |poses: &[ResidualAt], settings: LearntSettings| Learnt::new(&robot, poses, settings).unwrap_err();
    let base = || settings(LearntAxes::Base);
    assert_eq!(refused(&poses(7), base()), LearntError::Poses(7));
    let mut short = poses(8);
    short[4].joints.pop();
    assert!(matches!(
        refused(&short, base()),
        LearntError::Pose { index: 4, .. }
    ));
    let mut wild = poses(8);
    wild[2].residual.y = f64::NAN;
    assert!(matches!(
        refused(&wild, base()),
        LearntError::Pose { index: 2, .. }
    ));
    let mut zero = poses(8);
    zero.iter_mut().for_each(|pose| pose.residual = Vector3::zeros());
    assert_eq!(refused(&zero, base()), LearntError::Nothing);
    let mut setting = base();
    setting.noise = 0.0;
    assert_eq!(
        refused(&poses(8), setting),
        LearntError::Setting("the scatter", 0.0)
    );
    let mut setting = base();
    setting.lengths.pop();
    assert!(matches!(
        refused(&poses(8), setting),
        LearntError::Lengths { lengths: 5, .. }
    ));
}
