//! Lanes against the plain version: envelopes, limits, compliances, joints, forward.

use armill_core::compliance::compliance_at_tool;
use armill_core::kernel::lanes::{Arrays, Backend, Envelopes, Precision, flag};
use armill_core::kernel::{AT_LIMIT, BranchChoice};
use armill_core::robot::inverse::{ToolAt, postures};
use armill_core::robot::{Branch, Posture, Robot};
use armill_core::source::elastic::predict;
use armill_core::workpiece::Split;

use crate::{NEAR_SINGULAR, analysis, arms, batch, cases, poses_of, some};

/// Largest difference of envelopes from `predict`, against the whole deviation, away from singularities; every
/// difference near them is below `near`.
fn worst_difference<T: Precision>(
    robot: &Robot,
    postures: &[Posture],
    backend: Backend,
    near: Option<f64>,
) -> f64 {
    let soa = poses_of::<T>(postures);
    let mut worst: f64 = 0.0;
    analysis(robot, &cases(5), BranchChoice::Best, |question| {
        let mut batch = batch::<T>(question, backend);
        let mut out: [Envelopes<T>; 4] = Default::default();
        batch.envelopes_of_all(&soa.poses(), &mut out);
        for (i, posture) in postures.iter().enumerate() {
            let branch = Branch::ALL
                .iter()
                .position(|b| Some(*b) == posture.name.branch())
                .unwrap();
            let ours = &out[branch / 2];
            let flags = ours.flags(i);
            let splits: Vec<Split> = question
                .cases
                .iter()
                .map(|wrench| predict(posture, question.arm.compliance, wrench).twist.linear)
                .map(|deviation| Split::of(&deviation, question.normal))
                .collect();
            let of = |get: fn(&Split) -> f64| splits.iter().map(get).fold(0.0, f64::max);
            let (largest, full) = (of(|split| split.in_plane), of(|split| split.full));
            let away = (ours.in_plane()[i].to_f64() - largest).abs() / full;
            // Whatever is near a singularity in double precision may be out of reach in single.
            if posture.singularity.is_some() && near.is_none() {
                continue;
            }
            if flags & flag::WRIST_UNDECIDED != 0 {
                continue;
            }
            assert_eq!(flags & flag::UNREACHABLE, 0, "{}: {posture:?}", robot.name());
            if flags & NEAR_SINGULAR != 0 {
                let allowed = near.unwrap_or(f64::INFINITY);
                assert!(away < allowed, "{}: {away:e} at {posture:?}", robot.name());
            } else {
                worst = worst.max(away);
                let decided = splits[ours.worst_case(i)].in_plane;
                assert!((decided - largest).abs() < 1e-3 * full, "another case decides");
            }
        }
    });
    worst
}

#[test]
fn envelopes_agree_with_predict_on_a_million_poses_of_six_arms() {
    let mut regular_poses = 0;
    for robot in arms::all() {
        let (regular, bent_little): (Vec<Posture>, Vec<Posture>) = some(&robot, 200_000)
            .into_iter()
            .partition(|posture| posture.screws[3].angular.cross(&posture.screws[5].angular).norm() > 0.1);
        regular_poses += regular.len();
        // Near a singularity the posture itself is only known to eps over the square of the sine.
        let worst = worst_difference::<f64>(&robot, &regular, Backend::fastest(), Some(1e-6));
        assert!(worst < 1e-12, "{}: {worst:e}", robot.name());
        // Between 1 and 6 deg from the wrist singularity, and with the arm nearly stretched, rounding of the pose has
        // more effect.
        let worst = worst_difference::<f64>(&robot, &bent_little, Backend::fastest(), Some(1e-6));
        assert!(worst < 4e-12, "{}: {worst:e}", robot.name());
    }
    assert!(regular_poses > 1_000_000, "{regular_poses}");
}

#[test]
fn envelopes_in_single_precision_agree_to_one_in_ten_thousand() {
    for robot in arms::all() {
        // A pose rounded to single precision is another pose, a few tenths of a micrometre away: near a
        // singularity that turns joints far.
        let worst = worst_difference::<f32>(&robot, &some(&robot, 20_000), Backend::fastest(), None);
        assert!(worst < 1e-4, "{}: {worst:e}", robot.name());
    }
}

#[test]
fn back_ends_that_do_not_fuse_agree_with_predict_as_well() {
    for robot in arms::all() {
        for backend in Backend::available() {
            let worst = worst_difference::<f64>(&robot, &some(&robot, 5_000), backend, Some(1e-6));
            assert!(worst < 1e-12, "{} on {backend}: {worst:e}", robot.name());
        }
    }
}

#[test]
fn joint_limits_by_cosines_agree_with_joint_positions() {
    for robot in arms::all() {
        let found = some(&robot, 20_000);
        let soa = poses_of::<f64>(&found);
        analysis(&robot, &cases(1), BranchChoice::Best, |question| {
            let mut batch = batch::<f64>(question, Backend::fastest());
            let mut out: [Envelopes<f64>; 4] = Default::default();
            batch.envelopes_of_all(&soa.poses(), &mut out);
            let mut outside = 0;
            for (i, posture) in found.iter().enumerate() {
                let tool = ToolAt {
                    flange_from_tool: question.arm.flange_from_tool,
                    near: None,
                    home: None,
                };
                for all in postures(&robot, &posture.base_from_tool, tool).unwrap() {
                    let branch = Branch::ALL
                        .iter()
                        .position(|b| Some(*b) == all.name.branch())
                        .unwrap();
                    let flags = out[branch / 2].flags(i);
                    let bit = [flag::OUTSIDE_LIMITS, flag::OUTSIDE_LIMITS_FLIPPED][branch % 2];
                    let margin = robot.limit_margin(&all.joints).unwrap().1;
                    if flags & NEAR_SINGULAR == 0 && (margin + AT_LIMIT).abs() > 1e-7 {
                        assert_eq!(
                            flags & bit != 0,
                            margin < 0.0,
                            "{}: {margin} {all:?}",
                            robot.name()
                        );
                        outside += usize::from(margin < 0.0);
                    }
                }
            }
            assert!(outside > 1000);
        });
    }
}

#[test]
fn compliances_agree_with_the_sum_over_screws() {
    for robot in arms::all() {
        let found = some(&robot, 5_000);
        let soa = poses_of::<f64>(&found);
        analysis(&robot, &cases(1), BranchChoice::Best, |question| {
            let mut batch = batch::<f64>(question, Backend::fastest());
            for branch in Branch::ALL {
                let mut out = Arrays::default();
                batch.compliances(&soa.poses(), branch, &mut out);
                for (i, posture) in found.iter().enumerate() {
                    let flags = out.array(21)[i] as u32;
                    if posture.name.branch() != Some(branch) || flags & NEAR_SINGULAR != 0 {
                        continue;
                    }
                    let c = compliance_at_tool(&posture.screws, question.arm.compliance);
                    let mut at = 0;
                    for row in 0..6 {
                        for column in row..6 {
                            let away = (out.array(at)[i] - c[(row, column)]).abs();
                            assert!(away < 1e-12 * c.norm(), "{}: {away:e}", robot.name());
                            at += 1;
                        }
                    }
                }
            }
        });
    }
}

#[test]
fn joint_positions_of_all_branches_agree_with_the_closed_form() {
    // Rounding, 1e-15, over the square of the sine of 1 deg is 3e-12.
    for robot in arms::all() {
        let found = some(&robot, 3_000);
        let soa = poses_of::<f64>(&found);
        analysis(&robot, &cases(1), BranchChoice::Best, |question| {
            let mut out = Arrays::default();
            batch::<f64>(question, Backend::fastest()).joints(&soa.poses(), &mut out);
            for (i, posture) in found.iter().enumerate() {
                let tool = ToolAt {
                    flange_from_tool: question.arm.flange_from_tool,
                    near: None,
                    home: None,
                };
                let all = postures(&robot, &posture.base_from_tool, tool).unwrap();
                for (index, branch) in Branch::ALL.into_iter().enumerate() {
                    let flags = out.array(48 + index)[i] as u32;
                    let Some(witness) = all.iter().find(|p| p.name.branch() == Some(branch)) else {
                        assert_ne!(flags & flag::UNREACHABLE, 0);
                        continue;
                    };
                    if flags & NEAR_SINGULAR != 0 {
                        continue;
                    }
                    assert_eq!(flags & flag::UNREACHABLE, 0);
                    for (joint, q) in witness.joints.iter().enumerate() {
                        let away = (out.array(6 * index + joint)[i] - q).abs();
                        // Half a turn from the middle of its range a joint may be counted either way.
                        assert!(
                            away < 1e-11 || (away - std::f64::consts::TAU).abs() < 1e-11,
                            "{away:e}"
                        );
                    }
                }
            }
        });
    }
}

#[test]
fn forward_agrees_with_the_chain() {
    // Some hundred roundings of numbers below 3 m, 4e-16 each.
    for robot in arms::all() {
        let found = some(&robot, 5_000);
        let joints: [Vec<f64>; 6] = std::array::from_fn(|k| found.iter().map(|p| p.joints[k]).collect());
        let soa = poses_of::<f64>(&found);
        analysis(&robot, &cases(1), BranchChoice::Best, |question| {
            let mut out = Arrays::default();
            let planes: [&[f64]; 6] = std::array::from_fn(|k| &joints[k][..]);
            batch::<f64>(question, Backend::fastest()).forward(&planes, &mut out);
            for (i, posture) in found.iter().enumerate() {
                for k in 0..12 {
                    assert!((out.array(k)[i] - soa.0[k][i]).abs() < 1e-13, "{}", robot.name());
                }
                for (joint, screw) in posture.screws.iter().enumerate() {
                    for (k, value) in screw.linear.iter().chain(screw.angular.iter()).enumerate() {
                        assert!(
                            (out.array(12 + 6 * joint + k)[i] - value).abs() < 1e-13,
                            "{}",
                            robot.name()
                        );
                    }
                }
            }
        });
    }
}
