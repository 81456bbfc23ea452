//! Envelopes over load cases, slots of blocks, and statistics of all points.

use super::*;
use crate::robot::{Sides, Unreachable};

fn evaluation(in_plane: f64) -> Evaluation {
    Evaluation {
        name: PostureName::Sides(Sides::default()),
        limit_margin: 0.5,
        limit_joint: 0,
        singularity: None,
        worst_case: 9,
        in_plane,
        in_plane_uncertainty: None,
        normal: 7.0,
        full: 7.0,
    }
}

fn answers(points: Vec<Result<Evaluation, Unreachable>>) -> Answers {
    let count = points.len();
    Answers {
        points,
        joints: (0..2 * count).map(|k| k as f64).collect(),
        deviations: (0..3 * count).map(|k| Vector3::repeat(k as f64)).collect(),
        shares: (0..4 * count).map(|k| k as f64).collect(),
        clearances: Vec::new(),
        joint_count: 2,
        case_count: 3,
        share_count: 4,
    }
}

#[test]
fn the_envelope_takes_the_largest_of_each_and_the_first_of_equals() {
    let deviations = [
        Vector3::new(1.0, 0.0, 2.0),
        Vector3::new(0.0, 3.0, -5.0),
        Vector3::new(-3.0, 0.0, 4.0),
    ];
    let mut one = evaluation(0.0);
    one.take_envelope(&deviations, Vector3::z_axis());
    assert_eq!((one.in_plane, one.worst_case), (3.0, 1));
    // Along the normal the one with the largest magnitude, with its sign.
    assert_eq!(one.normal, -5.0);
    assert_eq!(one.full, 34_f64.sqrt());
    // Previous values are replaced; fields other than deviations stay.
    one.take_envelope(&[Vector3::zeros()], Vector3::z_axis());
    assert_eq!(
        (one.in_plane, one.worst_case, one.normal, one.full),
        (0.0, 0, 0.0, 0.0)
    );
    assert_eq!((one.limit_margin, one.limit_joint), (0.5, 0));
}

#[test]
fn reversing_the_normal_changes_only_the_sign() {
    let deviations = [Vector3::new(0.3, -0.2, 0.9), Vector3::new(-0.1, 0.8, 0.05)];
    let normal = Unit::new_normalize(Vector3::new(0.3, 0.5, -0.8));
    let (mut one, mut other) = (evaluation(0.0), evaluation(0.0));
    one.take_envelope(&deviations, normal);
    other.take_envelope(&deviations, -normal);
    assert_eq!(one.normal, -other.normal);
    assert_eq!(
        (one.in_plane, one.full, one.worst_case),
        (other.in_plane, other.full, other.worst_case)
    );
}

#[test]
fn blocks_contain_every_value_once_and_in_order() {
    for size in [1, 2, 5, 7, 100] {
        let mut all = answers(vec![Ok(evaluation(1.0)); 7]);
        let (joints, shares) = (all.joints.clone(), all.shares.clone());
        let mut blocks = all.blocks(size);
        assert_eq!(blocks.len(), 7_usize.div_ceil(size));
        let mut point = 0;
        for block in &mut blocks {
            for i in 0..block.points.len() {
                let slot = block.at(i);
                assert_eq!(slot.joints, &joints[2 * point..][..2]);
                assert_eq!(slot.shares, &shares[4 * point..][..4]);
                assert_eq!(slot.deviations[2], Vector3::repeat(3.0 * point as f64 + 2.0));
                *slot.point = Err(Unreachable::TooFar { by: point as f64 });
                point += 1;
            }
        }
        assert_eq!(point, 7);
        let given: Vec<f64> = all
            .points
            .iter()
            .filter_map(|p| p.as_ref().unwrap_err().amount())
            .collect();
        assert_eq!(given, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
    assert!(answers(Vec::new()).blocks(3).is_empty());
}

#[test]
fn values_of_a_point_are_at_its_index() {
    let all = answers(vec![Ok(evaluation(1.0)); 3]);
    assert_eq!(all.joints_at(2), [4.0, 5.0]);
    assert_eq!(all.shares_at(1), [4.0, 5.0, 6.0, 7.0]);
    assert_eq!(all.deviations_at(1)[0], Vector3::repeat(3.0));
    // The values of one point, and the state.
    let bytes = Answers::bytes_per_point(2, 4, 3);
    assert_eq!(
        bytes,
        size_of::<Result<Evaluation, Unreachable>>() + 8 * 6 + 24 * 3
    );
}

#[test]
fn worst_and_best_are_the_first_of_those_that_differ_only_by_rounding() {
    let missed = Err(Unreachable::OtherBranch);
    let all = answers(vec![
        missed,
        Ok(evaluation(2.0)),
        Ok(evaluation(5.0)),
        Ok(evaluation(5.0 * (1.0 + 1e-13))),
        Ok(evaluation(2.0 * (1.0 - 1e-13))),
        missed,
        Ok(evaluation(3.0)),
    ]);
    assert_eq!(all.worst().unwrap().0, 2);
    assert_eq!(all.best().unwrap().0, 1);
    assert_eq!(
        all.evaluations().map(|(i, _)| i).collect::<Vec<_>>(),
        [1, 2, 3, 4, 6]
    );
    let none = answers(vec![missed; 4]);
    assert!(none.worst().is_none() && none.best().is_none());
}

#[test]
fn a_joint_at_its_limit_is_inside_up_to_rounding() {
    let with = |limit_margin| Evaluation {
        limit_margin,
        ..evaluation(0.0)
    };
    assert!(with(0.0).within_limits() && with(-0.9 * AT_LIMIT).within_limits());
    assert!(!with(-1.1 * AT_LIMIT).within_limits());
    assert!(with(f64::INFINITY).within_limits());
}
