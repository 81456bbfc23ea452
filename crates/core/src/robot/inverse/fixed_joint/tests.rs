//! Which joint stands, and that the other six hold what all seven held.

use super::*;
use crate::arms::{self, Stream};

fn iiwa() -> (Chain, FixedJoint) {
    let chain = arms::other::iiwa14().chain().clone();
    let arm_state = FixedJoint::recognise(&chain).unwrap();
    (chain, arm_state)
}

#[test]
fn joint_3_of_an_iiwa_stands_and_its_wrist_is_exact() {
    let (_, arm_state) = iiwa();
    assert_eq!(arm_state.joint, 2);
    assert!(arm_state.is_exact());
}

#[test]
fn putting_the_standing_joint_in_and_taking_it_out_changes_nothing() {
    let (_, mut arm_state) = iiwa();
    let six = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    for joint in 0..7 {
        arm_state.joint = joint;
        let seven = arm_state.with(-1.0, &six);
        assert_eq!(seven[joint], -1.0);
        assert_eq!(arm_state.without(&seven), Some(six));
    }
    assert_eq!(arm_state.without(&six), None);
}

#[test]
fn the_six_joints_beside_the_standing_one_hold_what_all_seven_held() {
    let (chain, arm_state) = iiwa();
    let mut stream = Stream(31);
    for _ in 0..100 {
        let theta: [f64; 7] = std::array::from_fn(|_| stream.between(-2.5, 2.5));
        let pose = chain.base_from_flange(&theta);
        let six = arm_state.at(theta[2]).unwrap();
        let own = arm_state.without(&theta).unwrap();
        let found = six.chain_positions(&pose, None);
        let away = |found: &[f64; 6]| {
            (0..6)
                .map(|i| (0.5 * (found[i] - own[i])).sin().abs())
                .fold(0.0, f64::max)
        };
        // Near a singularity joints are known to the root of rounding.
        assert!(found.iter().any(|found| away(found) < 1e-5), "{theta:?}");
        for six in found {
            let reached = chain.base_from_flange(&arm_state.with(theta[2], &six));
            assert!((reached.to_homogeneous() - pose.to_homogeneous()).norm() < 1e-7);
        }
    }
}

#[test]
fn arms_without_a_wrist_or_without_a_joint_to_spare_have_no_standing_joint() {
    assert!(FixedJoint::recognise(arms::mh12().chain()).is_none());
    let mut rows = arms::other::IIWA14;
    // Offsets everywhere: no three axes meet, whichever joint stands.
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] += 0.05 * (i as f64 + 1.0);
        row[1] += 0.08;
    }
    let general = arms::other::of_rows("general", &rows, &[170.0; 7]);
    assert!(FixedJoint::recognise(general.chain()).is_none());
}
