//! Springs from load tests: known ones are found again, with honest uncertainty; real tests are predicted as well as
//! told.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

mod arms;

use armill_core::identify::effect::{Effects, State};
use armill_core::identify::fit::Scatter;
use armill_core::identify::unknown::{base, bending, drives, lost_motion, tool};
use armill_core::identify::{
    Floor, Identified, LoadTest, Loss, Measured, Method, PlanQuestion, Points, Prior, Reading, Refusal, Role,
    Unknown, displacement_errors, identify, measured_over_typical, plan,
};
use armill_core::nalgebra::{DMatrix, Vector3};
use armill_core::robot::chain::Axis;
use armill_core::robot::{Robot, Seat};
use armill_core::spatial::Wrench;

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// SplitMix64; the seed is part of the test.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal with mean 0 and standard deviation 1, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let (a, b) = (self.uniform().max(1e-300), self.uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

fn plain() -> Method {
    Method {
        prior: Prior::None,
        points: Points::Known,
        loss: Loss::Squares,
        scatter: Scatter::Found,
    }
}

fn usual() -> Method {
    Method {
        prior: Prior::Typical,
        points: Points::Known,
        loss: Loss::Huber,
        scatter: Scatter::Found,
    }
}

/// Tests of `robot` in random postures with pulls of up to 500 N and no reading yet.
fn loads(robot: &Robot, count: usize, random: &mut Random) -> Vec<LoadTest> {
    let test = |_| LoadTest {
        joints: robot
            .joints()
            .iter()
            .map(|joint| {
                let limits = joint.limits.unwrap();
                limits.middle() + 0.7 * (random.uniform() - 0.5) * (limits.upper - limits.lower)
            })
            .collect(),
        wrench: Wrench::from_force(Vector3::from_fn(|_, _| 500.0 * (2.0 * random.uniform() - 1.0))),
        force_point: Vector3::new(0.0, 0.05, 0.3),
        measured_point: Vector3::new(0.01, 0.05, 0.28),
        readings: AXES
            .map(|axis| Reading {
                what: Measured::Displacement(axis),
                value: 0.0,
                standard_uncertainty: 1e-5,
            })
            .to_vec(),
    };
    (0..count).map(test).collect()
}

/// Readings that springs of these sizes give, with normal noise, m.
fn measure(
    robot: &Robot,
    unknowns: &[Unknown],
    state: &State,
    tests: &mut [LoadTest],
    mut noise: impl FnMut() -> f64,
) {
    for test in tests {
        let values = Effects::of(robot, unknowns, test).readings(unknowns, state);
        for (reading, value) in test.readings.iter_mut().zip(values) {
            reading.value = value + noise();
        }
    }
}

/// Some sizes about the middle of the prior, different for each unknown.
fn some_sizes(unknowns: &[Unknown], random: &mut Random) -> Vec<f64> {
    armill_core::identify::prior::typical_sizes(unknowns)
        .into_iter()
        .map(|size| size * (2.0 * random.uniform() - 1.0).exp())
        .collect()
}

#[test]
fn drives_are_found_exactly_where_nothing_scatters() {
    let (robot, mut random) = (arms::mh12(), Random(1));
    let unknowns = drives(&robot);
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    let mut tests = loads(&robot, 10, &mut random);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(truth.clone()),
        &mut tests,
        || 0.0,
    );
    for method in [plain(), usual()] {
        let found = identify(&robot, &unknowns, &tests, method).unwrap();
        for (estimate, truth) in found.estimates.iter().zip(&truth) {
            // Residuals of 1e-9 of the largest reading count as rounding.
            assert!(
                (estimate.value / truth - 1.0).abs() < 1e-6,
                "{estimate:?} against {truth}"
            );
        }
    }
}

#[test]
fn every_spring_and_both_points_are_found_exactly_where_nothing_scatters() {
    let (robot, mut random) = (arms::kr120(), Random(2));
    let unknowns = [drives(&robot), bending(&robot), base(&robot), tool()].concat();
    let truth = State {
        sizes: some_sizes(&unknowns, &mut random),
        force_shift: Vector3::new(0.02, -0.05, 0.04),
        measured_shift: Vector3::new(-0.03, 0.01, 0.06),
    };
    let mut tests = loads(&robot, 60, &mut random);
    measure(&robot, &unknowns, &truth, &mut tests, || 0.0);
    let method = Method {
        points: Points::Separate(0.2),
        ..usual()
    };
    let found = identify(&robot, &unknowns, &tests, method).unwrap();
    // Three springs of one size about axes through the wrist centre yield alike in every posture: which of drives and
    // bendings of the wrist yields stays open, and no prediction needs it.
    let open = |k: &usize| found.together.iter().any(|set| set.contains(k));
    let in_wrist = |k: usize| matches!(unknowns[k].seat, Seat::Joint(3..=5));
    assert!(
        (0..unknowns.len()).filter(open).all(in_wrist),
        "{:?}",
        found.together
    );
    assert!(!found.together.is_empty());
    for (k, (estimate, truth)) in found.estimates.iter().zip(&truth.sizes).enumerate() {
        let near = (estimate.value / truth - 1.0).abs() < 1e-4;
        assert!(near || open(&k), "{estimate:?} against {truth}");
    }
    // Displacements are some mm; residuals below 1e-9 of the largest count as rounding.
    let errors = displacement_errors(&tests, found.tests.iter().map(|t| &t.left_out)).unwrap();
    assert!(errors.largest < 1e-8, "{errors:?}");
    let (force, measured) = (found.force_shift.unwrap(), found.measured_shift.unwrap());
    assert!((force[0] - truth.force_shift).norm() < 1e-6, "{}", force[0]);
    assert!(
        (measured[0] - truth.measured_shift).norm() < 1e-6,
        "{}",
        measured[0]
    );
}

#[test]
fn stated_uncertainties_cover_the_truth_as_often_as_they_say() {
    let robot = arms::kr120();
    let unknowns = drives(&robot);
    let truth = vec![6e-7, 5e-7, 9e-7, 2e-6, 3e-6, 5e-6];
    let (mut inside, mut all) = (0, 0);
    for seed in 0..200 {
        let mut random = Random(1000 + seed);
        let mut tests = loads(&robot, 12, &mut random);
        let mut noise = Random(5000 + seed);
        measure(
            &robot,
            &unknowns,
            &State::of_sizes(truth.clone()),
            &mut tests,
            || 2e-5 * noise.normal(),
        );
        let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
        for (estimate, truth) in found.estimates.iter().zip(&truth) {
            all += 1;
            inside += usize::from((estimate.value - truth).abs() < 2.0 * estimate.standard_uncertainty);
        }
    }
    // Two standard uncertainties of a normal error hold 95.4 %. With three readings a test robust weights of normal
    // noise are 0.85 in the mean and enlarge the uncertainty by 1.08, which is more than they cost: 97 %. 1200 draws
    // scatter by 0.6 %, and do not depend on the machine.
    let share = f64::from(inside as u32) / f64::from(all);
    assert!((0.94..0.985).contains(&share), "{share}");
}

#[test]
fn uncertainties_of_all_springs_cover_the_truth() {
    let robot = arms::kr120();
    let unknowns = [drives(&robot), bending(&robot), base(&robot)].concat();
    let (mut inside, mut all) = (0, 0);
    for seed in 0..12 {
        let mut random = Random(20_000 + seed);
        let truth = some_sizes(&unknowns, &mut random);
        let mut tests = loads(&robot, 40, &mut random);
        let mut noise = Random(30_000 + seed);
        measure(
            &robot,
            &unknowns,
            &State::of_sizes(truth.clone()),
            &mut tests,
            || 2e-5 * noise.normal(),
        );
        let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
        for (estimate, truth) in found.estimates.iter().zip(&truth) {
            // Of logarithms, since a prior of factors is one of logarithms.
            let off = (estimate.value / truth).ln().abs();
            all += 1;
            inside += usize::from(off < 2.0 * estimate.standard_uncertainty / estimate.value);
        }
    }
    let share = f64::from(inside as u32) / f64::from(all);
    // The truths here lie nearer to the middle of the prior than it claims: more are covered than 95 %.
    assert!(share > 0.93, "{share}");
}

#[test]
fn one_wild_test_is_named_and_moves_little() {
    let (robot, mut random) = (arms::kr120(), Random(3));
    let unknowns = drives(&robot);
    let truth = vec![6e-7, 5e-7, 9e-7, 2e-6, 3e-6, 5e-6];
    let mut tests = loads(&robot, 25, &mut random);
    let mut noise = Random(4);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(truth.clone()),
        &mut tests,
        || 1e-5 * noise.normal(),
    );
    tests[7].readings[1].value += 2e-3;
    let robust = identify(&robot, &unknowns, &tests, usual()).unwrap();
    let named: Vec<usize> = (0..25).filter(|test| robust.tests[*test].outlier).collect();
    assert_eq!(named, [7]);
    let squares = Method {
        loss: Loss::Squares,
        ..usual()
    };
    let squares = identify(&robot, &unknowns, &tests, squares).unwrap();
    let off = |found: &Identified| {
        // The last drive moves these tests by less than the noise.
        let errors = found.estimates[..5]
            .iter()
            .zip(&truth)
            .map(|(e, t)| (e.value / t - 1.0).abs());
        errors.fold(0.0, f64::max)
    };
    assert!(
        off(&robust) < 0.3 * off(&squares),
        "{} against {}",
        off(&robust),
        off(&squares)
    );
}

#[test]
fn the_way_of_the_paper_gives_each_joint_by_itself() {
    // One link loaded, its turn against the one before read: c = turn / torque, whatever the others do.
    let (robot, mut random) = (arms::mh12(), Random(5));
    let unknowns = drives(&robot);
    let truth = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    let mut tests = Vec::new();
    for (joint, truth) in truth.into_iter().enumerate() {
        for mut test in loads(&robot, 2, &mut random) {
            let torque = Effects::of(&robot, &unknowns, &test).torques()[joint];
            test.readings = vec![Reading {
                what: Measured::Turn(joint),
                value: truth * torque,
                standard_uncertainty: 1e-5,
            }];
            tests.push(test);
        }
    }
    let found = identify(&robot, &unknowns, &tests, plain()).unwrap();
    for (estimate, truth) in found.estimates.iter().zip(truth) {
        assert!(
            (estimate.value / truth - 1.0).abs() < 1e-9,
            "{estimate:?} against {truth}"
        );
    }
}

#[test]
fn springs_that_act_alike_are_named_together() {
    let (robot, mut random) = (arms::mh12(), Random(6));
    // The link after B bends about y where B itself turns about y: nothing tells them apart.
    let twin = Unknown::about(Seat::Joint(4), Axis::Y, Role::Bending);
    let mut unknowns = drives(&robot);
    unknowns.push(twin);
    let mut tests = loads(&robot, 12, &mut random);
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 3.0e-5, 8.0e-5, 3.0e-5];
    measure(&robot, &unknowns, &State::of_sizes(truth), &mut tests, || 0.0);
    let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
    assert_eq!(found.together, [vec![4, 6]]);
    // Their sum is known nonetheless.
    let sum = found.estimates[4].value + found.estimates[6].value;
    assert!((sum / 6.0e-5 - 1.0).abs() < 1e-4, "{sum}");
}

#[test]
fn a_joint_that_no_test_loads_is_named_and_keeps_its_prior() {
    let robot = arms::mh12();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(7));
    for test in &mut tests {
        // On the last axis: the flange turns about its own z.
        test.force_point = Vector3::new(0.0, 0.0, 0.1);
        test.measured_point = test.force_point;
    }
    let truth = vec![2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
    measure(&robot, &unknowns, &State::of_sizes(truth), &mut tests, || 0.0);
    let found = identify(&robot, &unknowns, &tests, usual()).unwrap();
    assert!(found.estimates[5].known < 0.01, "{:?}", found.estimates[5]);
    assert!(found.estimates[..5].iter().all(|e| e.known > 0.99));
    let relative = found.estimates[5].standard_uncertainty / found.estimates[5].value;
    assert!((relative - 2.0).abs() < 0.01, "{relative}");
}

#[test]
fn tests_that_cannot_tell_are_refused() {
    let robot = arms::mh12();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(8));
    let nothing = identify(&robot, &unknowns, &tests, usual()).unwrap_err();
    assert_eq!(nothing, Refusal::NothingMeasured);
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(vec![1e-6; 6]),
        &mut tests,
        || 0.0,
    );
    let few = identify(&robot, &unknowns, &tests[..1], usual()).unwrap_err();
    assert_eq!(
        few,
        Refusal::TooFewReadings {
            readings: 3,
            unknowns: 6
        }
    );
    let joints = tests[0].joints.clone();
    for test in &mut tests {
        test.joints.clone_from(&joints);
    }
    let one = identify(&robot, &unknowns, &tests, usual()).unwrap_err();
    assert_eq!(one, Refusal::OnePosture { tests: 10 });
    assert!(matches!(
        identify(&robot, &unknowns, &[], usual()).unwrap_err(),
        Refusal::TooFewReadings { readings: 0, .. }
    ));
}

#[test]
fn wrong_units_show_in_the_size_of_what_was_measured() {
    let robot = arms::kr120();
    let unknowns = drives(&robot);
    let mut tests = loads(&robot, 10, &mut Random(9));
    measure(
        &robot,
        &unknowns,
        &State::of_sizes(vec![1e-6; 6]),
        &mut tests,
        || 0.0,
    );
    let ratio = measured_over_typical(&robot, &tests).unwrap();
    assert!((ratio - 0.5).abs() < 1e-9, "{ratio}");
}

#[test]
fn a_plan_knows_more_than_chance_and_stays_inside_the_limits() {
    let robot = arms::mh12();
    let unknowns = [drives(&robot), bending(&robot)].concat();
    let asked = PlanQuestion {
        tests: 12,
        pulls: [[0.0, 0.0, -150.0], [150.0, 0.0, 0.0], [0.0, 150.0, 0.0]]
            .map(Vector3::from)
            .to_vec(),
        tool_point: Vector3::new(0.0, 0.05, 0.2),
        gauge: 1e-5,
        floor: Some(Floor::under_base()),
    };
    let planned = plan(&robot, &unknowns, &asked);
    assert_eq!(planned.tests.len(), 12);
    for test in &planned.tests {
        let (_, margin) = robot.limit_margin(&test.joints).unwrap();
        assert!(margin > 0.0, "{:?}", test.joints);
        let frames = armill_core::robot::forward::forward(&robot, &test.joints);
        assert!(frames.base_from_flange.translation.vector.z > 0.2);
    }
    assert_eq!(plan(&robot, &unknowns, &asked).tests, planned.tests);
    for (place, test) in planned.tests.iter().enumerate() {
        assert!(!planned.tests[..place].contains(test), "{test:?} twice");
    }
    let volume = |tests: &[LoadTest]| {
        let mut information = DMatrix::<f64>::identity(unknowns.len(), unknowns.len());
        let state = State::typical(&unknowns);
        for test in tests {
            let mut rows = Effects::of(&robot, &unknowns, test)
                .jacobian(&unknowns, &state)
                .columns(0, unknowns.len())
                .into_owned();
            for (k, size) in state.sizes.iter().enumerate() {
                rows.column_mut(k).scale_mut(size / 1e-5);
            }
            information += rows.tr_mul(&rows);
        }
        information
            .symmetric_eigenvalues()
            .iter()
            .map(|v| v.ln())
            .sum::<f64>()
    };
    let as_test = |joints: &[f64], force| LoadTest {
        joints: joints.to_vec(),
        wrench: Wrench::from_force(force),
        force_point: asked.tool_point,
        measured_point: asked.tool_point,
        readings: loads(&robot, 1, &mut Random(1))[0].readings.clone(),
    };
    let best: Vec<LoadTest> = planned
        .tests
        .iter()
        .map(|t| as_test(&t.joints, t.force))
        .collect();
    let mut random = Random(77);
    for _ in 0..20 {
        let chance: Vec<LoadTest> = loads(&robot, 12, &mut random)
            .into_iter()
            .enumerate()
            .map(|(i, t)| as_test(&t.joints, asked.pulls[i % 3]))
            .collect();
        assert!(volume(&chance) < volume(&best));
    }
}

/// Liu et al. 2026 by modified DH rows; each joint stands after its row's two displacements along and about x and its
/// length along z, so that seats are the origins of the DH frames.
fn r2000ic() -> Robot {
    let described = arms::r2000ic();
    let mut motions = described.chain().motions().to_vec();
    for row in motions.chunks_mut(5) {
        row.swap(3, 4);
    }
    Robot::new("fanuc/r2000ic", motions, described.joints().to_vec()).unwrap()
}

fn fanuc_tests() -> Option<Vec<LoadTest>> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    let folder = std::path::Path::new(&samples).join("datasets/fanuc-r2000ic-deflection");
    let rows = |file: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(folder.join(file)).expect(file);
        let lines = text.lines().skip(1);
        lines
            .map(|line| line.split(',').map(|cell| cell.trim().parse().unwrap()).collect())
            .collect()
    };
    let point = Vector3::new(0.0069, 0.2453, 0.3193);
    let tests = rows("joint_angles.csv")
        .into_iter()
        .zip(rows("forces.csv"))
        .zip(rows("deltaX.csv"))
        .map(|((joints, force), displacement)| LoadTest {
            joints,
            wrench: Wrench::from_force(Vector3::from_column_slice(&force)),
            force_point: point,
            measured_point: point,
            readings: AXES
                .map(|axis| Reading {
                    what: Measured::Displacement(axis),
                    value: displacement[axis.index()],
                    standard_uncertainty: 1e-5,
                })
                .to_vec(),
        });
    Some(tests.collect())
}

/// Fit rms, left-out rms (mm), left-out mean over mean measured (%).
fn errors(tests: &[LoadTest], found: &Identified) -> [f64; 3] {
    let fit = displacement_errors(tests, found.tests.iter().map(|t| &t.residuals)).unwrap();
    let left_out = displacement_errors(tests, found.tests.iter().map(|t| &t.left_out)).unwrap();
    [fit.rms * 1e3, left_out.rms * 1e3, left_out.relative * 100.0]
}

#[test]
fn least_squares_on_43_real_tests_give_what_another_program_gave() {
    let Some(tests) = fanuc_tests() else { return };
    let robot = r2000ic();
    let six = drives(&robot);
    let both = |axis| (0..6).map(move |joint| Unknown::about(Seat::Joint(joint), axis, Role::Bending));
    let eighteen: Vec<Unknown> = six
        .iter()
        .copied()
        .chain(both(Axis::X))
        .chain(both(Axis::Y))
        .collect();
    // Numbers by numpy and scipy (nnls, least_squares), printed to three and one decimals.
    let rows = [
        ("6, points known", &six, Points::Known, [0.372, 0.405, 20.8]),
        ("18, points known", &eighteen, Points::Known, [0.276, 0.305, 16.5]),
        ("6, common point", &six, Points::Common(1.0), [0.298, 0.343, 17.3]),
        (
            "18, common point",
            &eighteen,
            Points::Common(1.0),
            [0.191, 0.228, 11.0],
        ),
        (
            "18, two points",
            &eighteen,
            Points::Separate(1.0),
            [0.180, 0.225, 10.5],
        ),
    ];
    for (name, unknowns, points, expected) in rows {
        let found = identify(&robot, unknowns, &tests, Method { points, ..plain() }).unwrap();
        let errors = errors(&tests, &found);
        println!("{name}: {errors:.4?}");
        for (found, (expected, half_digit)) in errors.iter().zip(expected.iter().zip([6e-4, 6e-4, 0.06])) {
            assert!(
                (found - expected).abs() < half_digit,
                "{name}: {errors:?} against {expected}"
            );
        }
        if name == "6, points known" {
            let stiffness = [
                860_896.0,
                2_719_583.0,
                1_959_760.0,
                270_828.0,
                424_693.0,
                206_020.0,
            ];
            for (estimate, k) in found.estimates.iter().zip(stiffness) {
                assert!(
                    (estimate.value * k - 1.0).abs() < 2e-6,
                    "{} against {k}",
                    1.0 / estimate.value
                );
            }
        }
    }
}

#[test]
fn a_weak_prior_and_robust_weights_predict_real_tests_better() {
    let Some(tests) = fanuc_tests() else { return };
    let robot = r2000ic();
    let springs = [drives(&robot), bending(&robot), base(&robot)].concat();
    let torques: Vec<f64> = (0..6)
        .map(|joint| {
            let torque = |test| Effects::of(&robot, &springs, test).torques()[joint].abs();
            0.05 * tests.iter().map(torque).fold(0.0, f64::max)
        })
        .collect();
    let with_gaps = [springs.clone(), lost_motion(&robot, &torques)].concat();
    // What plain least squares reach on the same tests, best of all its models: 10.5 %, 0.225 mm.
    let rows = [
        ("known points", &springs, Points::Known, [0.307, 16.5]),
        ("common point", &springs, Points::Common(0.2), [0.208, 9.65]),
        ("two points", &springs, Points::Separate(0.2), [0.205, 8.9]),
        (
            "two points and lost motion",
            &with_gaps,
            Points::Separate(0.2),
            [0.203, 8.55],
        ),
    ];
    for (name, unknowns, points, most) in rows {
        let found = identify(&robot, unknowns, &tests, Method { points, ..usual() }).unwrap();
        let [fit, rms, relative] = errors(&tests, &found);
        println!("{name}: fit {fit:.4} mm, left out {rms:.4} mm, {relative:.2} %");
        assert!(
            rms < most[0] && relative < most[1],
            "{name}: {rms} mm, {relative} %"
        );
        // No spring is rigid, none softer than a drive of a small arm.
        let springs = found.estimates.iter().take(springs.len());
        assert!(
            springs.clone().all(|e| e.value > 1e-8 && e.value < 1e-4),
            "{name}"
        );
        if points != Points::Known {
            let outliers: Vec<usize> = (0..43)
                .filter(|t| found.tests[*t].outlier)
                .map(|t| t + 1)
                .collect();
            assert_eq!(outliers, [11], "{name}");
        }
    }
}
