//! Which chains have a closed form, and that the coordinates of their joints have no effect on it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::super::unreachable::Unreachable;
use super::super::two_links::NEAR_SINGULAR;
use super::*;
use crate::arms::Stream;
use crate::robot::chain::{Amount, Axis, Motion};

fn along(axis: Axis, length: f64) -> Motion {
    Motion::Along(axis, Amount::Constant(length))
}

fn turned(axis: Axis, angle: f64) -> Motion {
    Motion::About(axis, Amount::Constant(angle))
}

fn joint(axis: Axis, index: usize) -> Motion {
    Motion::About(axis, Amount::Joint(index))
}

/// Chain positions of one branch.
fn positions(
    form: &ClosedForm,
    pose: &Isometry,
    branch: Branch,
    near: Option<&[f64; 6]>,
) -> Result<([f64; 6], Option<Singularity>), Unreachable> {
    form.eight_branches(pose, branch.into(), near).get(branch)
}

const A1: f64 = 0.15;
const L2: f64 = 0.6;
const L3: f64 = 0.64;

/// An ortho-parallel arm that misses each of six conditions by so much (rad, m).
fn ortho_parallel(off: [f64; 6]) -> Vec<Motion> {
    use Axis::{X, Y, Z};
    vec![
        along(Z, 0.4),
        joint(Z, 0),
        along(X, A1),
        turned(X, off[0]),
        joint(Y, 1),
        along(Z, L2),
        turned(X, off[1]),
        joint(Y, 2),
        joint(X, 3),
        along(X, L3),
        turned(Z, off[2]),
        along(Z, off[3]),
        joint(Y, 4),
        turned(Z, off[4]),
        along(Z, off[5]),
        along(X, 0.1),
        joint(X, 5),
    ]
}

/// An arm with three parallel axes that misses each of six conditions by so much (rad, m).
fn three_parallel(off: [f64; 6]) -> Vec<Motion> {
    use Axis::{X, Y, Z};
    vec![
        along(Z, 0.18),
        joint(Z, 0),
        turned(X, off[0]),
        joint(Y, 1),
        along(X, L2),
        turned(X, off[1]),
        joint(Y, 2),
        along(X, 0.57),
        turned(X, off[2]),
        joint(Y, 3),
        along(Y, 0.17),
        turned(X, off[3]),
        joint(Z, 4),
        along(Z, 0.12),
        turned(X, off[4]),
        along(X, off[5]),
        joint(Y, 5),
        along(Y, 0.1),
    ]
}

fn ideal() -> [Chain; 2] {
    [ortho_parallel([0.0; 6]), three_parallel([0.0; 6])].map(|motions| Chain::new(motions).unwrap())
}

/// The same angles modulo whole turns.
fn same(a: &[f64], b: &[f64], within: f64) -> bool {
    let away = |(a, b): (&f64, &f64)| (a - b - TAU * ((a - b) / TAU).round()).abs();
    a.iter().zip(b).map(away).all(|away| away < within)
}

/// Poses of random chain positions away from singularities, with those positions.
fn poses(chain: &Chain, count: usize) -> Vec<([f64; 6], Isometry)> {
    let form = ClosedForm::recognise(chain).unwrap();
    let mut stream = Stream(12);
    let mut made = Vec::new();
    while made.len() < count {
        let theta = [0; 6].map(|_| stream.between(-PI, PI));
        if form.name(&theta).1.is_none() {
            made.push((theta, chain.base_from_flange(&theta)));
        }
    }
    made
}

#[test]
fn every_condition_that_is_violated_by_a_micrometre_is_noticed_and_compensated() {
    let kinds: [fn([f64; 6]) -> Vec<Motion>; 2] = [ortho_parallel, three_parallel];
    for (kind, motions) in kinds.into_iter().enumerate() {
        let is_kind = |form: Option<ClosedForm>| match form {
            Some(ClosedForm::OrthoParallel(_)) => kind == 0,
            Some(ClosedForm::ThreeParallel(_)) => kind == 1,
            None => false,
        };
        assert!(is_kind(ClosedForm::recognise(
            &Chain::new(motions([0.0; 6])).unwrap()
        )));
        for condition in 0..6 {
            let off = |by: f64| {
                let mut off = [0.0; 6];
                off[condition] = by;
                Chain::new(motions(off)).unwrap()
            };
            // Rounding is ignored; a micrometre is noticed; two centimetres are another arm.
            assert!(is_kind(ClosedForm::recognise(&off(1e-11))), "{kind} {condition}");
            assert!(ClosedForm::recognise(&off(1e-6)).is_none(), "{kind} {condition}");
            assert!(is_kind(ClosedForm::next_to(&off(1e-6))), "{kind} {condition}");
            assert!(is_kind(ClosedForm::next_to(&off(-9e-3))), "{kind} {condition}");
            assert!(!is_kind(ClosedForm::next_to(&off(2e-2))), "{kind} {condition}");
        }
    }
}

#[test]
fn the_ideal_neighbour_of_an_ideal_arm_is_the_arm_itself() {
    for (chain, bend_at_zero) in ideal().into_iter().zip([FRAC_PI_2, 0.0]) {
        let (form, next) = (
            ClosedForm::recognise(&chain).unwrap(),
            ClosedForm::next_to(&chain).unwrap(),
        );
        for (_, pose) in poses(&chain, 100) {
            for branch in Branch::ALL {
                // The elbow of the neighbour is limited to 2.6 deg from the end of its range: it answers beyond it as
                // well.
                if let Ok((own, _)) = positions(&form, &pose, branch, None)
                    && (own[2] + bend_at_zero).sin().abs() > 0.05
                {
                    let (its, _) = positions(&next, &pose, branch, None).unwrap();
                    assert!(same(&own, &its, 1e-9), "{branch}: {own:?} {its:?}");
                }
            }
        }
    }
}

#[test]
fn the_requested_branch_is_returned() {
    for chain in ideal() {
        let form = ClosedForm::recognise(&chain).unwrap();
        let (mut came, mut own_too) = (0, 0);
        for (theta, pose) in poses(&chain, 200) {
            let own = form.name(&theta).0;
            for branch in Branch::ALL {
                let Ok((found, singularity)) = positions(&form, &pose, branch, None) else {
                    continue;
                };
                if singularity.is_none() {
                    assert_eq!(form.name(&found), (branch, None));
                    came += 1;
                }
                if branch == own {
                    assert!(same(&found, &theta, 1e-9), "{found:?} {theta:?}");
                    own_too += 1;
                }
            }
        }
        assert_eq!(own_too, 200);
        assert!(came > 600, "{came}");
    }
}

/// `chain` with the zero of joint `i` at `-zeros[i]`, and against the right hand where `reversed`.
fn recounted(chain: &Chain, zeros: &[f64; 6], reversed: &[bool; 6]) -> Chain {
    let mut motions = Vec::new();
    for motion in chain.motions() {
        let Motion::About(axis, Amount::Joint(index)) = *motion else {
            motions.push(*motion);
            continue;
        };
        let aside = if axis == Axis::X { Axis::Y } else { Axis::X };
        motions.push(turned(axis, zeros[index]));
        let half = if reversed[index] { PI } else { 0.0 };
        motions.extend([turned(aside, half), *motion, turned(aside, -half)]);
    }
    Chain::new(motions).unwrap()
}

#[test]
fn postures_do_not_depend_on_joint_coordinates() {
    let mut stream = Stream(5);
    for chain in ideal() {
        let form = ClosedForm::recognise(&chain).unwrap();
        for (_, pose) in poses(&chain, 60) {
            let zeros = [0; 6].map(|_| stream.between(-PI, PI));
            let reversed = [0; 6].map(|_| stream.next() < 0.5);
            let other = ClosedForm::recognise(&recounted(&chain, &zeros, &reversed)).unwrap();
            let all = |form: &ClosedForm| -> Vec<[f64; 6]> {
                let of = |branch| positions(form, &pose, branch, None).ok();
                Branch::ALL
                    .into_iter()
                    .filter_map(of)
                    .map(|(theta, _)| theta)
                    .collect()
            };
            let (here, there) = (all(&form), all(&other));
            assert_eq!(here.len(), there.len());
            for theta in here {
                let given: [f64; 6] =
                    std::array::from_fn(|i| (theta[i] - zeros[i]) * if reversed[i] { -1.0 } else { 1.0 });
                // Where a branch ends two postures merge: accurate to the root of rounding.
                assert!(
                    there.iter().any(|other| same(other, &given, 1e-6)),
                    "{given:?} {there:?}"
                );
            }
        }
    }
}

#[test]
fn singularities_are_flagged_at_nine_tenths_of_their_bound_and_not_at_eleven() {
    let [chain, _] = ideal();
    let form = ClosedForm::recognise(&chain).unwrap();
    for (part, near) in [(0.9, true), (1.1, false)] {
        let sine = part * NEAR_SINGULAR;
        // At chain zero the upper arm is vertical and the forearm is level: the elbow is bent by a quarter turn.
        let with_bend = |psi: f64, bend: f64| [0.3, psi, bend - FRAC_PI_2, 0.2, 1.0, -0.4];
        let flagged = |theta: [f64; 6]| form.name(&theta).1;
        let expected = |singularity| near.then_some(singularity);
        for side in [1.0, -1.0] {
            assert_eq!(
                flagged(with_bend(0.6, side * sine.asin())),
                expected(Singularity::Elbow)
            );
            let mut straight = with_bend(0.4, 1.0);
            straight[4] = side * sine.asin();
            assert_eq!(flagged(straight), expected(Singularity::Wrist));
            // a1 + l2 sin psi + l3 sin(psi + 1) = r, as one sine.
            let r = side * sine * (L2 + L3);
            let (cos, sin) = (L2 + L3 * 1_f64.cos(), L3 * 1_f64.sin());
            let psi = ((r - A1) / cos.hypot(sin)).asin() - sin.atan2(cos);
            let theta = with_bend(psi, 1.0);
            assert_eq!(flagged(theta), expected(Singularity::Shoulder));
            // The inverse reports the same for the same posture.
            let (branch, _) = form.name(&theta);
            let (_, given) = positions(&form, &chain.base_from_flange(&theta), branch, None).unwrap();
            assert_eq!(given, expected(Singularity::Shoulder));
        }
    }
}

#[test]
fn at_a_straight_wrist_joint_4_stays_or_shares_the_turn_evenly() {
    let [chain, _] = ideal();
    let form = ClosedForm::recognise(&chain).unwrap();
    let theta = [0.3, 0.2, -0.5, 0.7, 0.0, -0.1];
    let pose = chain.base_from_flange(&theta);
    let branch = form.name(&theta).0;
    let (kept, singularity) = positions(&form, &pose, branch, Some(&theta)).unwrap();
    assert_eq!(singularity, Some(Singularity::Wrist));
    assert!(same(&kept, &theta, 1e-8), "{kept:?}");
    let (shared, _) = positions(&form, &pose, branch, None).unwrap();
    assert!(
        (shared[3] - 0.3).abs() < 1e-8 && (shared[5] - 0.3).abs() < 1e-8,
        "{shared:?}"
    );
}

#[test]
fn a_wrist_centre_out_of_reach_misses_by_the_distance() {
    let [chain, _] = ideal();
    let form = ClosedForm::recognise(&chain).unwrap();
    // The stretched arm, level, and 50 mm more; the flange is 100 mm before the wrist.
    let level = Isometry::translation(A1 + L2 + L3 + 0.1 + 0.05, 0.0, 0.4);
    let miss = positions(&form, &level, Branch::ALL[0], None).unwrap_err();
    assert!(
        matches!(miss, Unreachable::TooFar { by } if (by - 0.05).abs() < 1e-12),
        "{miss}"
    );
    // The folded arm stays 40 mm from the shoulder: here the wrist is 10 mm above it.
    let folded = Isometry::translation(A1 + 0.1, 0.0, 0.41);
    let miss = positions(&form, &folded, Branch::ALL[0], None).unwrap_err();
    assert!(
        matches!(miss, Unreachable::TooNear { by } if (by - 0.03).abs() < 1e-12),
        "{miss}"
    );
}

#[test]
fn a_neighbour_answers_slightly_beyond_the_reach() {
    let chain = Chain::new(ortho_parallel([9e-3; 6])).unwrap();
    let next = ClosedForm::next_to(&chain).unwrap();
    let at = |beyond: f64| {
        let level = Isometry::translation(A1 + L2 + L3 + 0.1 + beyond, 0.0, 0.4);
        positions(&next, &level, Branch::ALL[0], None)
    };
    // The lengths of the neighbour differ from the nominal ones by some 1e-2 m.
    assert!(at(SLACK - 2e-2).is_ok());
    assert!(matches!(at(SLACK + 2e-2), Err(Unreachable::TooFar { .. })));
    // One that is a tenth of a millimetre off reaches hardly farther than the ideal arm.
    let chain = Chain::new(ortho_parallel([1e-4; 6])).unwrap();
    let next = ClosedForm::next_to(&chain).unwrap();
    let at = |beyond: f64| {
        let level = Isometry::translation(A1 + L2 + L3 + 0.1 + beyond, 0.0, 0.4);
        positions(&next, &level, Branch::ALL[0], None)
    };
    assert!(at(2e-4).is_ok());
    assert!(matches!(at(5e-3), Err(Unreachable::TooFar { .. })));
}
