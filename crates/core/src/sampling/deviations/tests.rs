use super::*;
use crate::arms;
use crate::predict::predict;
use crate::robot::{
    Attachment, Backlash, BacklashSide, JointCompliance, SmallMotion, Spring, UncertainGeometry,
};
use crate::sampling::{Draws, InputSpace, Method};
use crate::source::{Arm, StiffnessModel};
use nalgebra::{DMatrix, Matrix3, Vector3};
use std::sync::Arc;

const Q: [f64; 12] = [0.4, -0.3, 0.2, 0.5, -0.8, 0.1, -0.2, 0.3, -0.4, 0.1, 0.9, 0.0];

fn loads() -> [Wrench; 2] {
    [[300.0, -200.0, 100.0], [-50.0, 80.0, 400.0]].map(|force| Wrench::from_force(Vector3::from(force)))
}

fn model() -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    let spring = JointCompliance {
        value: 4e-7,
        standard_uncertainty: 1e-8,
    };
    let structure = &mut model.structure;
    structure.springs = vec![Spring::about(Attachment::Joint(1), Vector3::x(), spring)];
    structure.covariance = Some(DMatrix::from_row_slice(2, 2, &[4e-16, 3e-16, 3e-16, 4e-16]));
    structure.backlash = vec![
        None,
        Some(Backlash {
            gap: 1e-4,
            standard_uncertainty: 1e-5,
            side: BacklashSide::Torque,
        }),
    ];
    let motions = [(0, 3), (1, 0), (4, 5)].map(|(after, component)| SmallMotion { after, component });
    let covariance = DMatrix::from_row_slice(3, 3, &[1e-8, 4e-9, 0.0, 4e-9, 2e-8, 0.0, 0.0, 0.0, 3e-8]);
    structure.geometry = Some(Arc::new(
        UncertainGeometry::new(motions.to_vec(), &covariance).unwrap(),
    ));
    (structure.model_error, structure.repeatability) = (0.05, 2e-5);
    model
}

fn sampled(model: &StiffnessModel, method: Method, count: usize) -> Vec<SampledArm> {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: &tool,
    };
    let space = InputSpace::of(&arm);
    let draws = Draws {
        method,
        seed: 2,
        inputs: space.inputs().len(),
    };
    draws
        .normal(0, count)
        .chunks(draws.inputs)
        .map(|z| space.sampled(&arm, z))
        .collect()
}

fn deviations(samples: &[SampledArm], all_sources: bool) -> Vec<f64> {
    let (robot, tool, cases) = (&arms::ALL[0], arms::bent_tool(), loads());
    let question = SampledDeviations {
        robot,
        flange_from_tool: &tool,
        samples,
        joints: &Q,
        cases: &cases,
        paired: false,
        all_sources,
    };
    let mut out = vec![f64::NAN; samples.len() * 12];
    question.write(&mut out, Watch::NONE).unwrap();
    let paired = SampledDeviations {
        paired: true,
        ..question
    };
    let mut each = vec![f64::NAN; samples.len() * 6];
    paired.write(&mut each, Watch::NONE).unwrap();
    for (all, each) in out.chunks(12).zip(each.chunks(6)) {
        // Point 0 under load 0, point 1 under load 1.
        assert_eq!([&all[..3], &all[9..]].concat(), each);
    }
    out
}

#[test]
fn each_sample_is_the_arm_with_its_values() {
    let samples = sampled(&model(), Method::Random, 5);
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    for all_sources in [false, true] {
        let found = deviations(&samples, all_sources);
        for (sample, found) in samples.iter().zip(found.chunks(12)) {
            let mut arm_state = ArmState::new(sample.arm(robot, &tool));
            for (q, found) in Q.chunks(6).zip(found.chunks(6)) {
                arm_state.set_joints(q);
                for (load, found) in loads().iter().zip(found.chunks(3)) {
                    let elastic = arm_state.elastic(load).unwrap().linear * (1.0 + sample.model_error);
                    let rest = arm_state.geometric() + arm_state.backlash(&sample.links(), load);
                    let expected = match all_sources {
                        true => elastic + rest.linear + sample.scatter,
                        false => elastic,
                    };
                    assert!(
                        (Vector3::from_column_slice(found) - expected).norm() < 1e-15,
                        "{found:?} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_covariance_of_many_samples_is_that_of_the_prediction() {
    const COUNT: usize = 1 << 13;
    let model = model();
    let found = deviations(&sampled(&model, Method::Sobol, COUNT), true);
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let arm = Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model: &model,
        flange_from_tool: &tool,
    };
    let mut arm_state = ArmState::new(arm);
    for (point, q) in Q.chunks(6).enumerate() {
        arm_state.set_joints(q);
        for (case, load) in loads().iter().enumerate() {
            let expected = predict(&mut arm_state, load, &mut Links::KeptByFriction(&[0.0; 6])).unwrap();
            let column = || {
                found
                    .chunks(12)
                    .map(|sample| Vector3::from_column_slice(&sample[6 * point + 3 * case..][..3]))
            };
            let mean: Vector3<f64> = column().sum::<Vector3<f64>>() / COUNT as f64;
            let spread = column()
                .map(|y| (y - mean) * (y - mean).transpose())
                .sum::<Matrix3<f64>>()
                / COUNT as f64;
            let u = expected.covariance.trace().sqrt();
            assert!(
                (mean - expected.twist.linear).norm() < 0.01 * u,
                "{mean} {}",
                expected.twist.linear
            );
            // The model error multiplies the compliances, a term of second order of some 0.1 %.
            assert!(
                (spread - expected.covariance).norm() < 0.02 * expected.covariance.norm(),
                "{spread} {}",
                expected.covariance
            );
        }
    }
}

#[test]
fn no_sample_gives_no_result() {
    assert!(deviations(&[], true).is_empty());
}

#[test]
fn a_cancelled_evaluation_stops() {
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let (robot, tool, cases) = (&arms::ALL[0], arms::bent_tool(), loads());
    let samples = sampled(&model(), Method::Random, 3);
    for (all_sources, paired) in [(false, false), (true, false), (true, true)] {
        let question = SampledDeviations {
            robot,
            flange_from_tool: &tool,
            samples: &samples,
            joints: &Q,
            cases: &cases,
            paired,
            all_sources,
        };
        let mut out = vec![0.0; if paired { 18 } else { 36 }];
        assert_eq!(
            question.write(&mut out, watch),
            Err(EvaluateError::Cancelled(Cancelled))
        );
    }
}
