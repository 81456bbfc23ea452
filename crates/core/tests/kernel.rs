//! The kernel against the plain version in `predict.rs`, and against itself on every back end.
#![allow(clippy::unwrap_used)]

mod arms;

use std::fmt::Debug;

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::lanes::{Arrays, Backend, Batch, Envelopes, Poses, Precision, flag};
use armill_core::kernel::{AT_LIMIT, BranchChoice, Question, at_joints, evaluate};
use armill_core::load::Doubt;
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::predict::predict;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Amount, Axis, Branch, Joint, JointCompliance, Motion, Posture, Robot};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::{Plane, Split};
use arms::Stream;

/// How far (rad) outside their limits joints may stand: 20 deg.
const BEYOND: f64 = 0.35;

/// Three cases, one with a moment; five where many are asked.
fn cases(count: usize) -> Vec<Wrench> {
    let mut all = vec![
        Wrench::from_force(Vector3::new(3.0, -5.0, 5.0)),
        Wrench {
            force: Vector3::new(-20.0, 4.0, 1.0),
            moment: Vector3::new(0.4, -1.5, 2.0),
        },
        Wrench::from_force(Vector3::new(1.0, 8.0, -30.0)),
        Wrench::from_force(Vector3::new(1.0, 2.0, 3.0)),
        Wrench::from_force(Vector3::new(25.0, -25.0, 10.0)),
    ];
    all.truncate(count);
    all
}

/// Asks `question` with a bent tool and an oblique plane.
fn ask<T>(robot: &Robot, cases: &[Wrench], choice: BranchChoice, then: impl FnOnce(&Question<'_>) -> T) -> T {
    let tool = arms::bent_tool();
    then(&Question {
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        doubt: Doubt::NONE,
        home: None,
        cases,
        normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
        choice,
    })
}

/// Lanes for the arm of `question`.
fn batch<T: Precision>(question: &Question<'_>, backend: Backend) -> Batch<T> {
    Batch::new(question, question.arm.robot.ortho_parallel().unwrap(), backend)
}

/// Random postures of `robot`.
fn some(robot: &Robot, count: usize) -> Vec<Posture> {
    let mut stream = Stream(7);
    (0..count)
        .map(|_| posture_at(robot, &stream.joints_beyond(robot, BEYOND), &arms::bent_tool()))
        .collect()
}

/// Poses of postures, an array a number.
struct Soa<T>([Vec<T>; 12]);

impl<T: Precision> Soa<T> {
    fn of<'a>(poses: impl Iterator<Item = &'a Isometry>) -> Soa<T> {
        let mut arrays: [Vec<T>; 12] = std::array::from_fn(|_| Vec::new());
        for pose in poses {
            let rotation = pose.rotation.to_rotation_matrix().matrix().transpose();
            let numbers = rotation.iter().chain(pose.translation.vector.iter());
            for (array, value) in arrays.iter_mut().zip(numbers) {
                array.push(T::from_f64(*value));
            }
        }
        Soa(arrays)
    }

    fn poses(&self) -> Poses<'_, T> {
        Poses::Free {
            rotations: std::array::from_fn(|k| &self.0[k][..]),
            at: std::array::from_fn(|k| &self.0[9 + k][..]),
        }
    }
}

fn poses_of<T: Precision>(postures: &[Posture]) -> Soa<T> {
    Soa::of(postures.iter().map(|posture| &posture.base_from_tool))
}

const NEAR_SINGULAR: u32 = flag::NEAR_WRIST | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;

/// Largest difference of envelopes from `predict`, against the whole deviation, away from singularities; every difference near them
/// is below `near`.
fn worst_difference<T: Precision>(
    robot: &Robot,
    postures: &[Posture],
    backend: Backend,
    near: Option<f64>,
) -> f64 {
    let soa = poses_of::<T>(postures);
    let mut worst: f64 = 0.0;
    ask(robot, &cases(5), BranchChoice::Best, |question| {
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
                let decided = splits[ours.deciding_case(i)].in_plane;
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
        // Between 1 and 6 deg from the wrist singularity, and the arm nearly stretched, a rounded pose is worth more.
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
fn joint_limits_by_cosines_agree_with_joint_positions() {
    for robot in arms::all() {
        let found = some(&robot, 20_000);
        let soa = poses_of::<f64>(&found);
        ask(&robot, &cases(1), BranchChoice::Best, |question| {
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
        ask(&robot, &cases(1), BranchChoice::Best, |question| {
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
        ask(&robot, &cases(1), BranchChoice::Best, |question| {
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
        ask(&robot, &cases(1), BranchChoice::Best, |question| {
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

/// All that a batch can tell of these poses, as numbers.
fn everything<T: Precision>(
    question: &Question<'_>,
    soa: &Soa<T>,
    count: usize,
    backend: Backend,
) -> Vec<f64> {
    let cut = Soa(std::array::from_fn(|k| soa.0[k][..count].to_vec()));
    let mut batch = batch::<T>(question, backend);
    let mut all = Vec::new();
    let mut envelopes: [Envelopes<T>; 4] = Default::default();
    batch.envelopes_of_all(&cut.poses(), &mut envelopes);
    for one in &envelopes {
        all.extend(one.in_plane().iter().map(|x| x.to_f64()));
        all.extend((0..count).map(|i| f64::from(one.flags(i))));
        all.extend((0..count).map(|i| one.deciding_case(i) as f64));
    }
    let mut out = Arrays::default();
    batch.compliances(&cut.poses(), Branch::ALL[2], &mut out);
    all.extend((0..22).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    batch.joints(&cut.poses(), &mut out);
    all.extend((0..56).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    let joints: Vec<Vec<T>> = (0..6).map(|k| out.array(k).to_vec()).collect();
    let joints: [&[T]; 6] = std::array::from_fn(|k| &joints[k][..]);
    batch.forward(&joints, &mut out);
    all.extend((0..48).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    all
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

fn same_bits_wherever_product_and_sum_are_fused<T: Precision + Debug>() {
    for robot in arms::all() {
        let soa = poses_of::<T>(&some(&robot, 1_000));
        ask(&robot, &cases(5), BranchChoice::Best, |question| {
            for fuses in [false, true] {
                let mut same = Backend::available()
                    .into_iter()
                    .filter(|backend| backend.fuses() == fuses)
                    .map(|backend| (backend, bits(&everything(question, &soa, 1_000, backend))));
                if let Some((first, expected)) = same.next() {
                    for (other, found) in same {
                        assert!(
                            found == expected,
                            "{}: {other} differs from {first}",
                            robot.name()
                        );
                    }
                }
            }
        });
    }
}

#[test]
fn same_bits_on_every_back_end_that_fuses_and_on_every_one_that_does_not() {
    same_bits_wherever_product_and_sum_are_fused::<f64>();
    same_bits_wherever_product_and_sum_are_fused::<f32>();
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
fn any_number_of_points_gives_the_bits_of_each_alone() {
    let robot = arms::tx2_90();
    let soa = poses_of::<f64>(&some(&robot, 400));
    ask(&robot, &cases(3), BranchChoice::Best, |question| {
        let mut batch = batch::<f64>(question, Backend::fastest());
        let mut whole = Envelopes::default();
        batch.envelopes(&soa.poses(), Branch::ALL[0], &mut whole);
        for count in [0, 1, 2, 79, 80, 81, 160, 161, 399] {
            let cut = Soa(std::array::from_fn(|k| soa.0[k][..count].to_vec()));
            let mut part = Envelopes::default();
            batch.envelopes(&cut.poses(), Branch::ALL[0], &mut part);
            assert_eq!(bits(part.in_plane()), bits(&whole.in_plane()[..count]));
        }
    });
}

#[test]
fn still_poses_give_what_free_poses_give() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(0.9, 0.1, 0.7), 0.3);
    let poses: Vec<Isometry> = (0..200)
        .map(|i| plane.base_from_tool([0.002 * f64::from(i) - 0.2, 0.1].into(), 0.4))
        .collect();
    let soa = Soa::<f64>::of(poses.iter());
    ask(&robot, &cases(2), BranchChoice::Best, |question| {
        let still = Poses::Still {
            base_from_tool: poses[0].rotation.to_rotation_matrix(),
            at: std::array::from_fn(|k| &soa.0[9 + k][..]),
        };
        let mut batch = batch::<f64>(question, Backend::fastest());
        let mut out: [Envelopes<f64>; 2] = Default::default();
        batch.envelopes(&soa.poses(), Branch::ALL[0], &mut out[0]);
        batch.envelopes(&still, Branch::ALL[0], &mut out[1]);
        for (a, b) in out[0].in_plane().iter().zip(out[1].in_plane()) {
            assert!((a - b).abs() < 1e-13 * a, "{a} {b}");
        }
    });
}

#[test]
fn whole_answers_agree_with_predict_and_add_up() {
    for robot in arms::all() {
        let found = some(&robot, 2_000);
        ask(
            &robot,
            &cases(5),
            BranchChoice::Of("front elbow-up".parse().unwrap()),
            |question| {
                let pose = |i: usize| found[i].base_from_tool;
                let answers = evaluate(question, found.len(), pose, Watch::NONE).unwrap();
                let mut checked = 0;
                for (i, held) in answers.held().filter(|(_, held)| held.singularity.is_none()) {
                    let posture = posture_at(&robot, answers.joints_at(i), question.arm.flange_from_tool);
                    assert_eq!(posture.name, held.name);
                    let moved = posture.base_from_tool.translation.vector
                        - found[i].base_from_tool.translation.vector;
                    assert!(moved.norm() < 1e-12, "{moved:?}");
                    let (mut normal, mut full): (f64, f64) = (0.0, 0.0);
                    for (case, wrench) in question.cases.iter().enumerate() {
                        let witness = predict(&posture, question.arm.compliance, wrench);
                        let away = answers.deviations_at(i)[case] - witness.twist.linear;
                        assert!(away.norm() < 1e-12 * witness.twist.linear.norm());
                        let split = Split::of(&witness.twist.linear, question.normal);
                        assert!(split.in_plane <= held.in_plane * (1.0 + 1e-12));
                        full = full.max(split.full);
                        if split.normal.abs() > normal.abs() {
                            normal = split.normal;
                        }
                        if case == held.deciding_case {
                            assert!((split.in_plane - held.in_plane).abs() < 1e-12 * held.full);
                            let along = witness.twist.linear - question.normal.into_inner() * split.normal;
                            let along = along.normalize();
                            let variance = (along.transpose() * witness.covariance * along).x;
                            assert!((variance.sqrt() - held.in_plane_uncertainty).abs() < 1e-10 * held.full);
                        }
                    }
                    assert!((full - held.full).abs() < 1e-12 * full);
                    assert!((normal - held.normal).abs() < 1e-12 * full);
                    let sum: f64 = answers.shares_at(i).iter().sum();
                    assert!((sum - held.in_plane).abs() < 1e-12 * held.full);
                    let (joint, margin) = robot.limit_margin(&posture.joints).unwrap();
                    assert!((margin - held.limit_margin).abs() < 1e-12 && joint == held.limit_joint);
                    checked += 1;
                }
                assert!(checked > 300, "{}: {checked}", robot.name());
            },
        );
    }
}

#[test]
fn a_pose_that_lanes_cannot_decide_is_finite_and_flagged() {
    let robot = arms::mh12();
    // Forearm and axis 6 in line; far beyond reach; wrist centre on axis 1, 100 mm behind the flange.
    let straight = posture_at(&robot, &[0.3, 0.2, 0.1, 0.0, 0.0, 0.0], &arms::bent_tool()).base_from_tool;
    let far = from_xyz_and_fixed_angles(Vector3::new(9.0, 0.0, 0.5), Vector3::zeros());
    let on_axis_1 = Isometry::translation(0.0, 0.0, 1.3) * arms::bent_tool();
    let soa = Soa::<f64>::of([straight, far, on_axis_1].iter());
    ask(
        &robot,
        &cases(2),
        BranchChoice::Of("front elbow-up".parse().unwrap()),
        |question| {
            let mut out = Envelopes::default();
            batch::<f64>(question, Backend::fastest()).envelopes(&soa.poses(), Branch::ALL[0], &mut out);
            assert!(out.in_plane().iter().all(|x| x.is_finite()), "{out:?}");
            assert_ne!(out.flags(0) & flag::WRIST_UNDECIDED, 0);
            assert_ne!(out.flags(1) & flag::TOO_FAR, 0);
            let of_shoulder = out.flags(2) & (flag::NEAR_SHOULDER | flag::UNREACHABLE);
            assert_eq!(of_shoulder, flag::NEAR_SHOULDER);
            let pose = |i: usize| [straight, far, on_axis_1][i];
            let answers = evaluate(question, 3, pose, Watch::NONE).unwrap();
            assert!(answers.points[0].is_ok_and(|held| held.in_plane > 0.0));
            assert!(answers.points[1].is_err());
            assert!(answers.points[2].is_ok_and(|held| held.in_plane > 0.0));
        },
    );
}

#[test]
fn any_chain_at_known_joint_positions_agrees_with_predict() {
    // Seven axes, one of them a rail: no closed form.
    let motions = vec![
        Motion::Along(Axis::Y, Amount::Joint(0)),
        Motion::Along(Axis::Z, Amount::Constant(0.4)),
        Motion::About(Axis::Z, Amount::Joint(1)),
        Motion::About(Axis::Y, Amount::Joint(2)),
        Motion::Along(Axis::Z, Amount::Constant(0.5)),
        Motion::About(Axis::X, Amount::Joint(3)),
        Motion::About(Axis::Y, Amount::Joint(4)),
        Motion::Along(Axis::X, Amount::Constant(0.6)),
        Motion::About(Axis::X, Amount::Joint(5)),
        Motion::About(Axis::Z, Amount::Joint(6)),
    ];
    let joints = ["rail", "a", "b", "c", "d", "e", "f"].map(Joint::plain).to_vec();
    let robot = Robot::new("made-up/seven", motions, joints).unwrap();
    let compliance = vec![
        JointCompliance {
            value: 2e-6,
            standard_uncertainty: 0.0,
        };
        7
    ];
    let (tool, cases) = (arms::bent_tool(), cases(5));
    let held = Arm {
        robot: &robot,
        compliance: &compliance,
        model: StiffnessModel::DRIVES,
        flange_from_tool: &tool,
    };
    let mut stream = Stream(3);
    let q: Vec<f64> = (0..7 * 1000).map(|_| 4.0 * stream.next() - 2.0).collect();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let out = one_thread.install(|| at_joints(&held, &cases, &q, Watch::NONE).unwrap());
    for (i, q) in q.chunks(7).enumerate() {
        let posture = posture_at(&robot, q, &tool);
        assert_eq!(posture.base_from_tool, out.base_from_tool[i]);
        assert_eq!(posture.screws, out.screws[7 * i..7 * i + 7]);
        for (case, wrench) in cases.iter().enumerate() {
            let witness = predict(&posture, &compliance, wrench).twist.linear;
            assert!((out.deviations[5 * i + case] - witness).norm() < 1e-15 * witness.norm() * 10.0);
        }
    }
    let again = at_joints(&held, &cases, &q, Watch::NONE).unwrap();
    assert_eq!(again.deviations, out.deviations);
}
