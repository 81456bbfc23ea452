use super::*;
use crate::arms;
use crate::robot::{Attachment, JointCompliance, Spring};
use crate::sampling::deviations::compliance_terms;
use nalgebra::Vector3;
use std::sync::atomic::AtomicBool;

#[test]
fn compliances_of_all_samples_are_those_of_each() {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    let mut model = StiffnessModel::DRIVES.clone();
    let spring = JointCompliance {
        value: 3e-7,
        standard_uncertainty: 0.0,
    };
    model.structure.springs = vec![Spring::about(Attachment::Joint(2), Vector3::x(), spring)];
    let mut stream = arms::Stream(1);
    // More points than a block, and not a whole number of blocks.
    let joints: Vec<f64> = (0..3000).flat_map(|_| stream.joints(robot)).collect();
    let samples: Vec<(Vec<f64>, f64)> = (0..3)
        .map(|i| {
            (
                (0..7).map(|_| stream.between(1e-7, 1e-6)).collect(),
                1.0 + 0.1 * f64::from(i),
            )
        })
        .collect();
    let compliance = robot.compliance().unwrap();
    let arm = Arm {
        robot,
        compliance,
        model: &model,
        flange_from_tool: &tool,
    };
    let sums = SpringSums {
        arm,
        joints: &joints,
        samples: &samples,
        width: 36,
    };
    let mut out = vec![f64::NAN; 3 * 3000 * 36];
    sums.write(
        |arm_state, _, slots| compliance_terms(arm_state, slots),
        &mut out,
        Watch::NONE,
    )
    .unwrap();
    for (sample, out) in samples.iter().zip(out.chunks(3000 * 36)) {
        let mut model = model.clone();
        model.structure.springs[0].compliance.value = sample.0[6];
        let compliance: Vec<JointCompliance> = (sample.0[..6].iter())
            .map(|value| JointCompliance {
                value: *value,
                standard_uncertainty: 0.0,
            })
            .collect();
        let arm = Arm {
            compliance: &compliance,
            model: &model,
            ..arm
        };
        let mut arm_state = ArmState::new(arm);
        for (q, out) in joints.chunks(6).zip(out.chunks(36)).step_by(97) {
            arm_state.set_joints(q);
            let expected = arm_state.compliance().unwrap() * sample.1;
            assert_eq!(out, expected.as_slice());
        }
    }
    let cancel = AtomicBool::new(true);
    let cancelled = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let stopped = sums.write(
        |arm_state, _, slots| compliance_terms(arm_state, slots),
        &mut out,
        cancelled,
    );
    assert_eq!(stopped, Err(Cancelled));
}
