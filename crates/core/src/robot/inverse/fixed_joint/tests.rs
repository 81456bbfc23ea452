//! The choice of the fixed joint, and that the other six reach what all seven reached.

use super::*;
use crate::arms::{self, Stream};

fn iiwa() -> (Chain, FixedJoint) {
    let chain = arms::other::iiwa14().chain().clone();
    let fixed = FixedJoint::recognise(&chain).unwrap();
    (chain, fixed)
}

#[test]
fn joint_3_of_an_iiwa_is_fixed_and_its_wrist_is_exact() {
    let (_, fixed) = iiwa();
    assert_eq!(fixed.joint, 2);
    assert!(fixed.is_exact());
}

#[test]
fn inserting_and_removing_the_fixed_joint_changes_nothing() {
    let (_, mut fixed) = iiwa();
    let six = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    for joint in 0..7 {
        fixed.joint = joint;
        let seven = fixed.with(-1.0, &six);
        assert_eq!(seven[joint], -1.0);
        assert_eq!(fixed.without(&seven), Some(six));
    }
    assert_eq!(fixed.without(&six), None);
}

#[test]
fn the_other_six_joints_reach_what_all_seven_reached() {
    let (chain, fixed) = iiwa();
    let mut stream = Stream(31);
    for _ in 0..100 {
        let theta: [f64; 7] = std::array::from_fn(|_| stream.between(-2.5, 2.5));
        let pose = chain.base_from_flange(&theta);
        let six = fixed.at(theta[2]).unwrap();
        let own = fixed.without(&theta).unwrap();
        let found = six.chain_positions(&pose, None);
        let away = |found: &[f64; 6]| {
            (0..6)
                .map(|i| (0.5 * (found[i] - own[i])).sin().abs())
                .fold(0.0, f64::max)
        };
        // Near a singularity joint positions are accurate to the root of rounding.
        assert!(found.iter().any(|found| away(found) < 1e-5), "{theta:?}");
        for six in found {
            let reached = chain.base_from_flange(&fixed.with(theta[2], &six));
            assert!((reached.to_homogeneous() - pose.to_homogeneous()).norm() < 1e-7);
        }
    }
}

#[test]
fn arms_without_a_wrist_or_a_redundant_joint_have_no_fixed_joint() {
    assert!(FixedJoint::recognise(arms::mh12().chain()).is_none());
    let mut rows = arms::other::IIWA14;
    // Offsets everywhere: no three axes meet, whichever joint is fixed.
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] += 0.05 * (i as f64 + 1.0);
        row[1] += 0.08;
    }
    let general = arms::other::of_rows("general", &rows, &[170.0; 7]);
    assert!(FixedJoint::recognise(general.chain()).is_none());
}
