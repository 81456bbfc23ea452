//! Each stage of the lanes against the same formula in plain `f64`, and lanes against each other.

use nalgebra::{Matrix3, Point3, Vector3};

use super::by_block::{FOUR, SolvedBlock};
use super::geometry::{Arm, CosineLimits, Second, aim};
use super::load::Flexibility;
use super::solve::{Links, Screws, Solved};
use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::kernel::Question;
use crate::kernel::tests::{NOMINAL, analysis, poses};
use crate::numbers::{Alone, BLOCK, Fused, Plain, Vector, fill};
use crate::robot::inverse::posture_at;
use crate::robot::{Branch, Robot, Unreachable};
use crate::source::StiffnessModel;

type Lane = Plain<f64>;

fn batch(question: &Question<'_>, backend: Backend) -> Batch<f64> {
    Batch::new(question, question.arm.robot.ortho_parallel().unwrap(), backend)
}

fn plain(v: Vector<Lane>) -> Vector3<f64> {
    Vector3::new(v.x.store(), v.y.store(), v.z.store())
}

/// For every arm a batch that is aimed at a block of poses.
fn aimed(count: usize, mut then: impl FnMut(&Robot, &[Isometry], &mut Batch<f64>)) {
    for robot in arms::all() {
        let poses = poses(&robot, count, 81);
        analysis(&robot, StiffnessModel::DRIVES, NOMINAL, |question| {
            let mut batch = batch(question, Backend::fastest());
            batch.aim_at(&poses);
            batch.orient(Second::AtZero);
            then(&robot, &poses, &mut batch);
        });
    }
}

#[test]
fn aims_are_the_poses_in_the_axes_of_the_arm_and_the_last_one_is_repeated() {
    aimed(77, |robot, poses, batch| {
        let SolvedBlock { prepared, aims, .. } = batch.solved();
        let arm = &prepared.arm;
        let geometry = robot.ortho_parallel().unwrap();
        for i in 0..BLOCK {
            let pose = poses[i.min(76)];
            let aim = aim::<Lane, false>(aims, i);
            let tcp = arm.arm_from_base * Point3::from(pose.translation.vector);
            assert!((plain(aim.tcp) - tcp.coords).norm() < 1e-14);
            let turn = arm.arm_from_base_rotation() * pose.rotation.to_rotation_matrix().matrix();
            let fixed = [arm.lever, arm.tool_from_axis_6, arm.tool_from_axis_5];
            for (found, fixed) in [aim.lever, aim.out, aim.second].into_iter().zip(fixed) {
                assert!((plain(found) - turn * fixed).norm() < 1e-14);
            }
            // Less its lever the tool centre point is the wrist centre.
            let flange = pose * arms::bent_tool().inverse();
            let wrist = geometry.arm_from_base * (flange * geometry.flange_from_wrist);
            assert!((plain(aim.tcp) - plain(aim.lever) - wrist.coords).norm() < 1e-14);
        }
    });
}

#[test]
fn solved_angles_and_flags_agree_with_the_closed_form() {
    aimed(BLOCK, |robot, poses, batch| {
        let geometry = robot.ortho_parallel().unwrap();
        let (mut compared, mut missed) = (0, 0);
        for (four, branches) in Branch::ALL.chunks(2).enumerate() {
            batch.solve(FOUR[four], false);
            let SolvedBlock { postures, .. } = batch.solved();
            for (i, pose) in poses.iter().enumerate() {
                let flags = postures.flags[i] as u32;
                let flange = pose * arms::bent_tool().inverse();
                match geometry.chain_positions(&flange, branches[0], None) {
                    Ok((theta, singularity)) => {
                        assert_eq!(flags & flag::UNREACHABLE, 0, "{}", robot.name());
                        if singularity.is_some() {
                            continue;
                        }
                        let s = geometry.sense;
                        let psi = geometry.upper_arm_at_zero + s[1] * theta[1];
                        let chi = geometry.forearm_at_zero + s[1] * theta[1] + s[2] * theta[2];
                        let turns = postures.turns().map(|plane| plane[i]);
                        for (k, angle) in [s[0] * theta[0], psi, chi].into_iter().enumerate() {
                            let away = (turns[2 * k] - angle.cos()).hypot(turns[2 * k + 1] - angle.sin());
                            // A degree from a singularity a hundred ulps become ten thousand.
                            assert!(away < 1e-11, "{}: {away}", robot.name());
                        }
                        compared += 1;
                    }
                    Err(miss) => {
                        let expected = match miss {
                            Unreachable::TooFar { .. } => flag::TOO_FAR,
                            Unreachable::TooNear { .. } => flag::TOO_NEAR,
                            _ => flag::INSIDE_LATERAL_OFFSET,
                        };
                        assert!(flags & expected != 0, "{}: {miss} {flags:b}", robot.name());
                        missed += 1;
                    }
                }
            }
        }
        assert!(compared > 80, "{}: {compared}, {missed}", robot.name());
    });
}

/// Calls `then` with the screws of a lane, and the same from the joint positions of the posture, in the axes of the
/// arm.
fn screws(mut then: impl FnMut(&Robot, &Screws<Lane>, [[Vector3<f64>; 2]; 6])) {
    aimed(BLOCK, |robot, poses, batch| {
        let geometry = robot.ortho_parallel().unwrap();
        batch.solve(FOUR[0], false);
        let SolvedBlock {
            prepared,
            aims,
            postures,
            ..
        } = batch.solved();
        let links = Links::<Lane>::new(&prepared.arm);
        for (i, pose) in poses.iter().enumerate() {
            let flange = pose * arms::bent_tool().inverse();
            let Ok((theta, None)) = geometry.chain_positions(&flange, Branch::ALL[0], None) else {
                continue;
            };
            let mut q: Vec<f64> = Vec::new();
            for (joint, theta) in theta.into_iter().enumerate() {
                q.push(robot.joint_position(joint, theta, &q));
            }
            let posture = posture_at(robot, &q, &arms::bent_tool());
            let turn = prepared.arm.arm_from_base_rotation();
            let expected = std::array::from_fn(|k| {
                let screw = &posture.screws[k];
                [turn * screw.linear, turn * screw.angular].map(|v| v * geometry.sense[k])
            });
            let solved = Solved::load(postures, i);
            let screws = Screws::new(&links, &aim::<Lane, false>(aims, i), &solved);
            then(robot, &screws, expected);
        }
    });
}

#[test]
fn screws_agree_with_the_posture_with_joint_5_scaled_by_the_sine_of_its_bend() {
    let mut compared = 0;
    screws(|robot, screws, expected| {
        for (k, [linear, axis]) in expected.into_iter().enumerate() {
            let (found, along) = (plain(screws.linear[k]), plain(screws.axes[k]));
            let (found, along) = if k == 4 {
                let per_bent = screws.per_n2.store().sqrt();
                // The sine of the bend is known except for its sign.
                let sign = along.dot(&axis).signum();
                (found * (per_bent * sign), along * (per_bent * sign))
            } else {
                (found, along)
            };
            assert!(
                (along - axis).norm() < 1e-10,
                "{} {k}: {along} {axis}",
                robot.name()
            );
            assert!(
                (found - linear).norm() < 1e-10,
                "{} {k}: {found} {linear}",
                robot.name()
            );
        }
        compared += 1;
    });
    assert!(compared > 100, "{compared}");
}

#[test]
fn the_flexibility_is_the_sum_over_the_screws() {
    let compliance: [f64; 6] = [1e-6, 2e-6, 3e-6, 2e-5, 3e-5, 5e-5];
    let lanes = compliance.map(Lane::of);
    let v = Vector3::new(0.3, -0.7, 0.2);
    let lane_v = Vector::<Lane>::of(&v);
    screws(|_, screws, expected| {
        let (mut a, mut d) = (Matrix3::zeros(), Matrix3::zeros());
        for (c, [linear, axis]) in compliance.iter().zip(expected) {
            a += linear * linear.transpose() * *c;
            d += linear * axis.transpose() * *c;
        }
        let both = Flexibility::new::<true>(screws, &lanes);
        let within = 1e-9 * (a.norm() + d.norm());
        let upper = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        for (found, at) in both.a.iter().zip(upper) {
            assert!((found.store() - a[at]).abs() < within);
        }
        for (row, found) in both.d.iter().enumerate() {
            assert!((plain(*found) - d.row(row).transpose()).norm() < within);
        }
        assert!((plain(both.times(lane_v)) - a * v).norm() < within);
        assert!((plain(both.transposed_d_times(lane_v)) - d.transpose() * v).norm() < within);
        // Without moments the same for forces, and zero for moments.
        let forces = Flexibility::new::<false>(screws, &lanes);
        assert_eq!(forces.a.map(Real::store), both.a.map(Real::store));
        assert!(forces.d.iter().all(|row| plain(*row) == Vector3::zeros()));
    });
}

/// Arrays of the poses: nine numbers of rotation, three of position.
fn arrays(poses: &[Isometry]) -> [Vec<f64>; 12] {
    std::array::from_fn(|k| {
        let number = |pose: &Isometry| {
            if k < 9 {
                pose.rotation.to_rotation_matrix().matrix()[(k / 3, k % 3)]
            } else {
                pose.translation.vector[k - 9]
            }
        };
        poses.iter().map(number).collect()
    })
}

fn free(arrays: &[Vec<f64>; 12]) -> Poses<'_, f64> {
    Poses::Free {
        rotations: std::array::from_fn(|k| &arrays[k][..]),
        at: std::array::from_fn(|k| &arrays[9 + k][..]),
    }
}

#[test]
fn an_invalid_pose_does_not_change_its_neighbours() {
    let robot = &arms::ALL[2];
    let sound = arrays(&poses(robot, 100, 82));
    analysis(robot, StiffnessModel::DRIVES, NOMINAL, |question| {
        for backend in Backend::available() {
            let mut batch = batch(question, backend);
            let mut given = |arrays: &[Vec<f64>; 12]| {
                let mut out = Envelopes::default();
                batch.envelopes(&free(arrays), Branch::ALL[0], &mut out);
                let flags: Vec<u32> = (0..100).map(|i| out.flags(i)).collect();
                let bits: Vec<u64> = out.in_plane().iter().map(|x| x.to_bits()).collect();
                (bits, flags)
            };
            let whole = given(&sound);
            for (array, value) in [
                (9, f64::NAN),
                (11, f64::INFINITY),
                (0, f64::NAN),
                (4, -f64::INFINITY),
            ] {
                for lane in [0, 3, 79, 80, 99] {
                    let mut broken = sound.clone();
                    broken[array][lane] = value;
                    let (bits, flags) = given(&broken);
                    for i in (0..100).filter(|i| *i != lane) {
                        assert_eq!(
                            (bits[i], flags[i]),
                            (whole.0[i], whole.1[i]),
                            "{backend}: {lane} to {i}"
                        );
                    }
                }
            }
            // It does not remain in the scratch either.
            assert_eq!(given(&sound), whole);
        }
    });
}

#[test]
fn all_four_postures_at_once_agree_with_each_alone() {
    for robot in arms::all() {
        let arrays = arrays(&poses(&robot, 130, 83));
        analysis(&robot, StiffnessModel::DRIVES, NOMINAL, |question| {
            let mut batch = batch(question, Backend::fastest());
            let mut four: [Envelopes<f64>; 4] = Default::default();
            batch.envelopes_of_all(&free(&arrays), &mut four);
            for (at_once, pair) in four.iter().zip(Branch::ALL.chunks(2)) {
                let mut alone = Envelopes::default();
                batch.envelopes(&free(&arrays), pair[0], &mut alone);
                assert_eq!(at_once, &alone, "{}", robot.name());
            }
        });
    }
}

#[test]
fn a_plane_is_filled_with_the_last_value() {
    let mut plane = [7.0; BLOCK];
    fill(&mut plane, &[1.0, 2.0, 3.0]);
    assert_eq!(plane[..3], [1.0, 2.0, 3.0]);
    assert!(plane[3..].iter().all(|value| *value == 3.0));
    let more: Vec<f64> = (0..200).map(f64::from).collect();
    fill(&mut plane, &more);
    assert_eq!(plane[..], more[..BLOCK]);
}

#[test]
fn cosines_and_positions_agree_on_limits_where_coupling_allows_cosines() {
    for (robot, given) in [
        (arms::mh12(), true),
        (arms::r2000ic(), true),
        (arms::hung(), false),
    ] {
        let arm = Arm::new(&robot, robot.ortho_parallel().unwrap(), &Isometry::identity());
        assert_eq!(CosineLimits::new(&arm).is_some(), given, "{}", robot.name());
    }
}

#[test]
fn a_cosine_is_smallest_at_the_limits_and_a_whole_turn_has_no_limit() {
    let robot = arms::mh12();
    let arm = Arm::new(&robot, robot.ortho_parallel().unwrap(), &Isometry::identity());
    // Joints 4 and 6 turn all the way round.
    let with: Vec<bool> = (0..6).map(|joint| arm.cosine_limit(joint).is_some()).collect();
    assert_eq!(with, [true, true, true, false, true, false]);
    for joint in [0, 1, 2, 4] {
        let [to_cos, to_sin, least] = arm.cosine_limit(joint).unwrap();
        let limits = robot.joints()[joint].limits.unwrap();
        for step in 0..200 {
            // From a limit to half a turn from the middle, in both directions.
            let part = f64::from(step) / 200.0 - 0.5;
            let q = limits.middle() + 2.0 * std::f64::consts::PI * part;
            let row = arm.joints[joint];
            let phi = (q - row.start) / row.gain;
            let inside = phi.cos() * to_cos + phi.sin() * to_sin >= least;
            assert_eq!(inside, limits.margin(q) >= -1e-9, "joint {joint} at {q}");
        }
    }
}

#[test]
fn vectors_of_lanes_multiply_like_vectors() {
    let (a, b) = (Vector3::new(0.3, -1.2, 2.0), Vector3::new(-0.7, 0.4, 0.9));
    let (la, lb) = (Vector::<Lane>::of(&a), Vector::<Lane>::of(&b));
    assert!((la.dot(lb).store() - a.dot(&b)).abs() < 1e-15);
    assert!((plain(la.cross(lb)) - a.cross(&b)).norm() < 1e-15);
    assert_eq!(plain(la + lb), a + b);
    assert_eq!(plain(la - lb), a - b);
    assert_eq!(plain(la.scaled(Lane::of(0.5))), a * 0.5);
    assert!((plain(la.mul_add(Lane::of(0.7), lb)) - (a * 0.7 + b)).norm() < 1e-15);
}

/// Branch-free selection of every number type.
fn chooses<R: Real<Float = f64>>() {
    let [nan, one, two] = [f64::NAN, 1.0, 2.0].map(R::load);
    assert_eq!((one.max(two).store(), one.min(two).store()), (2.0, 1.0));
    // If one is NaN the other is selected.
    assert_eq!((nan.max(two).store(), nan.min(two).store()), (2.0, 2.0));
    assert_eq!(
        (R::load(0.0).sign().store(), R::load(-0.5).sign().store()),
        (1.0, -1.0)
    );
    assert_eq!(
        (
            R::either(true, one, two).store(),
            R::either(false, one, two).store()
        ),
        (1.0, 2.0)
    );
    // Of two whole numbers the even one; correct up to 2^51.
    for (x, rounded) in [
        (0.5, 0.0),
        (1.5, 2.0),
        (2.5, 2.0),
        (-0.5, 0.0),
        (-1.4, -1.0),
        (2e15, 2e15),
    ] {
        assert_eq!(R::load(x).round().store(), rounded, "{x}");
    }
    assert_eq!(
        (R::load(-2.0).abs().store(), R::load(9.0).sqrt().store()),
        (2.0, 3.0)
    );
    assert!(R::load(-1.0).sqrt().store().is_nan());
}

#[test]
fn all_number_types_select_the_same_value() {
    chooses::<Plain<f64>>();
    chooses::<Alone<f64>>();
    chooses::<Fused<f64>>();
}

#[test]
fn only_fused_numbers_round_a_product_and_a_sum_once() {
    // (1 + e)(1 - e) = 1 - e^2, whose last part is lost where the product is rounded first.
    fn rest<R: Real<Float = f64>>() -> f64 {
        let e = f64::EPSILON;
        R::load(1.0 + e).mul_add(R::load(1.0 - e), R::load(-1.0)).store()
    }
    let exact = -f64::EPSILON * f64::EPSILON;
    assert_eq!(
        (rest::<Plain<f64>>(), rest::<Alone<f64>>(), rest::<Fused<f64>>()),
        (0.0, 0.0, exact)
    );
}

#[test]
fn the_fastest_back_end_is_there_and_the_scalar_one_everywhere() {
    let available = Backend::available();
    assert!(available.contains(&Backend::SCALAR) && available.contains(&Backend::fastest()));
    assert!(!Backend::SCALAR.fuses());
    for (i, backend) in available.iter().enumerate() {
        assert!(
            available[..i]
                .iter()
                .all(|other| other.to_string() != backend.to_string())
        );
    }
}

#[test]
#[should_panic(expected = "as many rotations as places")]
fn poses_with_more_positions_than_rotations_are_refused() {
    let mut arrays = arrays(&[Isometry::identity(); 3]);
    for at in &mut arrays[9..] {
        at.push(0.0);
    }
    free(&arrays).len();
}

#[test]
#[should_panic(expected = "arrays of points differ in length")]
fn position_arrays_of_different_length_are_refused() {
    let mut arrays = arrays(&[Isometry::identity(); 3]);
    arrays[10].push(0.0);
    free(&arrays).len();
}

#[test]
fn poses_report_their_number() {
    let three = arrays(&[Isometry::identity(); 3]);
    assert!(free(&three).len() == 3 && !free(&three).is_empty());
    let none: [f64; 0] = [];
    let still = Poses::Still {
        base_from_tool: nalgebra::Rotation3::identity(),
        at: [&none, &none, &none],
    };
    assert!(still.is_empty());
}
