use nalgebra::{DMatrix, DVector, Point3, Vector3};

use super::state::{Model, residual};
use super::*;
use crate::arms;
use crate::calibrate::{MeasuredPose, Prior};
use crate::frame::Isometry;
use crate::identify::{LoadTest, Measured, Reading};
use crate::robot::chain::{Amount, Axis, Motion};
use crate::robot::forward::forward;
use crate::robot::jacobian::screws_at;
use crate::robot::{Joint, JointCompliance, Robot};
use crate::source::elastic;
use crate::spatial::Wrench;

mod ball_bar;
mod surface;

const FACTORS: PriorFactors = PriorFactors {
    geometry: Prior {
        length: 3e-4,
        angle: 5e-4,
    },
    factor: 1.5,
};

fn tool() -> Isometry {
    Isometry::translation(0.03, -0.02, 0.15)
}

/// An arm with hidden geometry, compliances and backlash.
struct Hidden {
    nominal: Robot,
    /// Its true chain.
    chain: Robot,
    compliances: Vec<JointCompliance>,
    gaps: Vec<f64>,
}

impl Hidden {
    fn new() -> Hidden {
        let nominal = arms::mh12();
        let mut next = arms::Stream(5);
        let mut motions = Vec::new();
        for motion in nominal.chain().motions() {
            motions.push(*motion);
            if let Amount::Joint(joint) = motion.amount()
                && joint + 1 < nominal.joints().len()
            {
                let size = |by: f64, random: f64| Amount::Constant(by * random);
                motions
                    .extend(Axis::ALL.map(|axis| Motion::Along(axis, size(2e-4, next.between(-1.0, 1.0)))));
                motions
                    .extend(Axis::ALL.map(|axis| Motion::About(axis, size(4e-4, next.between(-1.0, 1.0)))));
            }
        }
        let chain = Robot::new("hidden", motions, nominal.joints().to_vec()).unwrap();
        let stated = nominal.compliance().unwrap();
        let compliances = stated.iter().map(|joint| JointCompliance {
            value: joint.value * next.between(0.6, 1.6),
            standard_uncertainty: 0.0,
        });
        Hidden {
            compliances: compliances.collect(),
            gaps: (0..6).map(|_| next.between(2e-5, 1e-4)).collect(),
            chain,
            nominal,
        }
    }

    /// The true position of the tip, base, m.
    fn tip(&self, joints: &[f64], condition: &Condition) -> Vector3<f64> {
        let frames = forward(&self.chain, joints);
        let tip = frames.base_from_flange * Point3::from(tool().translation.vector);
        let screws = screws_at(&self.chain, &frames, &tip);
        let bent = elastic::displacement(&screws, &self.compliances, &condition.wrench);
        let mut moved = tip.coords + bent;
        for (joint, screw) in screws.iter().enumerate() {
            let chain_sign = self.chain.joints()[joint].sign.factor();
            moved -= screw.linear * (0.5 * self.gaps[joint] * condition.directions[joint] * chain_sign);
        }
        moved
    }

    /// Displacement under a load, m.
    fn displacement(&self, joints: &[f64], wrench: &Wrench) -> Vector3<f64> {
        let unloaded = Condition::unloaded(&self.nominal);
        let loaded = Condition {
            wrench: *wrench,
            ..unloaded.clone()
        };
        self.tip(joints, &loaded) - self.tip(joints, &unloaded)
    }
}

/// Random postures of a work space in front of the arm, with loads and directions.
fn work(hidden: &Hidden, count: usize, seed: u64) -> Vec<WorkPoint> {
    let mut next = arms::Stream(seed);
    let middle = [0.1, 0.3, -0.4, 0.2, -0.9, 0.3];
    let mut point = || WorkPoint {
        joints: middle.iter().map(|at| at + next.between(-0.35, 0.35)).collect(),
        condition: Condition {
            wrench: Wrench::from_force(next.vector(250.0)),
            directions: (0..6)
                .map(|_| if next.next() > 0.5 { 1.0 } else { -1.0 })
                .collect(),
        },
    };
    let _ = hidden;
    (0..count).map(|_| point()).collect()
}

/// A part: features cut at `points` and measured on a coordinate measuring machine, in a frame of its own.
fn part(hidden: &Hidden, points: &[WorkPoint], u: f64) -> Campaign {
    let mut next = arms::Stream(77);
    let frame = Isometry::new(Vector3::new(0.4, -0.2, 0.1), Vector3::new(0.3, -0.1, 1.2));
    let mut measured = |point: &WorkPoint| MeasuredPose {
        joints: point.joints.clone(),
        position: (frame * Point3::from(hidden.tip(&point.joints, &point.condition))).coords
            + Vector3::from_fn(|_, _| u * next.normal()),
        rotation: None,
    };
    Campaign::Positions(Positions {
        poses: points.iter().map(&mut measured).collect(),
        conditions: points.iter().map(|point| point.condition.clone()).collect(),
        flange_from_point: tool(),
        point: Known::Exactly,
        standard_uncertainty: u,
        turn_length: 1.0,
        observed: Observed::Coordinates,
    })
}

/// Positions of a tracker without load at these joint positions; the reflector is some millimetres from where it is said to be.
fn tracker(hidden: &Hidden, joints: Vec<Vec<f64>>, u: f64) -> Campaign {
    let mut next = arms::Stream(78);
    let frame = Isometry::new(Vector3::new(-2.0, 1.0, 0.5), Vector3::new(0.1, 0.2, -2.0));
    let conditions = vec![Condition::unloaded(&hidden.nominal); joints.len()];
    let poses = joints.into_iter().map(|joints| MeasuredPose {
        position: (frame * Point3::from(hidden.tip(&joints, &conditions[0]))).coords
            + Vector3::from_fn(|_, _| u * next.normal()),
        joints,
        rotation: None,
    });
    Campaign::Positions(Positions {
        poses: poses.collect(),
        conditions,
        flange_from_point: Isometry::translation(0.002, -0.003, 0.001) * tool(),
        point: Known::Approximately,
        standard_uncertainty: u,
        turn_length: 1.0,
        observed: Observed::Coordinates,
    })
}

fn load_test(
    hidden: &Hidden,
    joints: &[f64],
    force: Vector3<f64>,
    noise: &mut impl FnMut() -> f64,
) -> LoadTest {
    let wrench = Wrench::from_force(force);
    let moved = hidden.displacement(joints, &wrench);
    let u = 5e-6;
    LoadTest {
        joints: joints.to_vec(),
        wrench,
        force_point: tool().translation.vector,
        measured_point: tool().translation.vector,
        readings: Axis::ALL
            .map(|axis| Reading {
                what: Measured::Displacement(axis),
                value: moved[axis.index()] + u * noise(),
                standard_uncertainty: u,
            })
            .to_vec(),
    }
}

/// Root mean square of the difference between the true deviation and the predicted one, displacements of the whole removed, and of its
/// standard uncertainty, m.
fn error(hidden: &Hidden, points: &[WorkPoint], known: (&[Knowledge], &DMatrix<f64>)) -> [f64; 2] {
    let robot = &hidden.nominal;
    let at_work = Work::new(robot, tool(), points).unwrap();
    let predicted = at_work.deviation(robot, known.0);
    let mut all = DVector::zeros(3 * points.len());
    let mut rigid = DMatrix::zeros(3 * points.len(), 6);
    for (k, (point, predicted)) in points.iter().zip(&predicted).enumerate() {
        let nominal =
            forward(robot, &point.joints).base_from_flange * Point3::from(tool().translation.vector);
        let truth = hidden.tip(&point.joints, &point.condition) - nominal.coords;
        all.fixed_rows_mut::<3>(3 * k).copy_from(&(truth - predicted));
        rigid.fixed_view_mut::<3, 3>(3 * k, 0).fill_with_identity();
        for axis in 0..3 {
            let turn = Axis::ALL[axis].unit().cross(&nominal.coords);
            rigid.fixed_view_mut::<3, 1>(3 * k, 3 + axis).copy_from(&turn);
        }
    }
    let whole = rigid.clone().svd(true, true).solve(&all, 1e-12).unwrap();
    let left = (all - rigid * whole).norm() / (points.len() as f64).sqrt();
    [left, at_work.uncertainty(robot, known.0, known.1)]
}

#[test]
fn the_error_of_a_hidden_arm_decreases_from_round_to_round_as_its_uncertainty_says() {
    let hidden = Hidden::new();
    let robot = &hidden.nominal;
    let known = prior(robot, &FACTORS, true);
    let held_out = work(&hidden, 60, 900);
    let at_work = Work::new(robot, tool(), &work(&hidden, 40, 3)).unwrap();
    let mut rounds = vec![error(&hidden, &held_out, (&known, &work::independent(&known)))];

    let mut campaigns = vec![part(&hidden, &work(&hidden, 20, 1), 5e-6)];
    let first = update(robot, &known, &campaigns).unwrap();
    rounds.push(error(&hidden, &held_out, (&first.knowledge, &first.covariance)));

    let candidates: Vec<Vec<f64>> = work(&hidden, 150, 4)
        .into_iter()
        .map(|point| point.joints)
        .collect();
    let instrument = Instrument {
        flange_from_point: tool(),
        standard_uncertainty: 2e-5,
    };
    let plan = |count| Plan { count, instrument };
    let poses: Vec<Candidate> = candidates.iter().cloned().map(Candidate::Position).collect();
    let chosen = next(robot, &first, &at_work, &poses, plan(30));
    let joints = chosen.iter().map(|one| candidates[one.candidate].clone());
    campaigns.push(tracker(&hidden, joints.collect(), 2e-5));
    let second = update(robot, &known, &campaigns).unwrap();
    rounds.push(error(&hidden, &held_out, (&second.knowledge, &second.covariance)));

    let mut random = arms::Stream(12);
    let mut noise = arms::Stream(13);
    let tests: Vec<LoadTest> = (candidates.iter())
        .map(|joints| load_test(&hidden, joints, random.vector(300.0), &mut || noise.normal()))
        .collect();
    let loads: Vec<Candidate> = tests.iter().cloned().map(Candidate::LoadTest).collect();
    let chosen = next(robot, &second, &at_work, &loads, plan(8));
    campaigns.push(Campaign::LoadTests(
        chosen.iter().map(|one| tests[one.candidate].clone()).collect(),
    ));
    let third = update(robot, &known, &campaigns).unwrap();
    rounds.push(error(&hidden, &held_out, (&third.knowledge, &third.covariance)));

    // Part and tracker together predict the load tests, which the robot file does not.
    let predicted = update(robot, &second.knowledge, &campaigns[2..]).unwrap();
    assert!(
        predicted.campaigns[0].before < 0.05 * third.campaigns[2].before,
        "{predicted:?}"
    );
    // The part alone predicts the tracker.
    let predicted = update(robot, &first.knowledge, &campaigns[1..2]).unwrap();
    assert!(
        predicted.campaigns[0].before < 0.6 * third.campaigns[1].before,
        "{predicted:?}"
    );

    println!(
        "rounds (error, uncertainty), um: {:?}",
        rounds.iter().map(|one| one.map(|m| m * 1e6)).collect::<Vec<_>>()
    );
    for (estimate, truth) in third.knowledge.iter().filter_map(|known| match known.parameter {
        Parameter::Drive(joint) => Some((known, hidden.compliances[joint].value)),
        Parameter::Backlash(joint) => Some((known, hidden.gaps[joint])),
        Parameter::Geometry(_) => None,
    }) {
        let off = (truth.ln() - estimate.mean) / estimate.deviation;
        println!(
            "{:?} {:.3e} truth {truth:.3e}: {off:.2} deviations of {:.3}",
            estimate.parameter,
            estimate.value(),
            estimate.deviation
        );
        assert!(off.abs() < 4.0, "{estimate:?} {truth}");
    }
    println!("{:?}", third.campaigns);
    for pair in rounds.windows(2) {
        assert!(pair[1][0] < pair[0][0] && pair[1][1] < pair[0][1], "{rounds:?}");
    }
    // Before any measurement the uncertainty is that of factors, to first order.
    for [error, uncertainty] in &rounds[1..] {
        assert!((0.4..2.0).contains(&(error / uncertainty)), "{rounds:?}");
    }
}

#[test]
fn rows_match_finite_differences() {
    let hidden = Hidden::new();
    let robot = &hidden.nominal;
    let known: Vec<Knowledge> = (prior(robot, &FACTORS, true).into_iter().enumerate())
        .map(|(k, one)| Knowledge {
            mean: one.mean + one.deviation * (k as f64).sin(),
            ..one
        })
        .collect();
    let mut noise = arms::Stream(1);
    let test = load_test(&hidden, &[0.1; 6], Vector3::new(50.0, -80.0, 20.0), &mut || {
        noise.normal()
    });
    let campaigns = [
        part(&hidden, &work(&hidden, 3, 8), 1.0),
        surface::measured(&hidden, &work(&hidden, 3, 8), 1.0),
        ball_bar::readings(&hidden, &work(&hidden, 4, 9), 1.0, true),
        ball_bar::readings(&hidden, &work(&hidden, 4, 10), 1.0, false),
        tracker(
            &hidden,
            vec![vec![0.3; 6], vec![-0.2; 6], vec![0.1; 6], vec![0.5; 6]],
            1.0,
        ),
        Campaign::LoadTests(vec![LoadTest {
            readings: test
                .readings
                .iter()
                .map(|reading| Reading {
                    standard_uncertainty: 1.0,
                    ..*reading
                })
                .collect(),
            ..test
        }]),
    ];
    let model = Model::new(robot, &known, &campaigns);
    let state = model.at(tool());
    for campaign in 0..campaigns.len() {
        let rows = model.rows(&state, campaign);
        for column in 0..model.unknowns() {
            let side = |step: f64| {
                let mut by = vec![0.0; model.unknowns()];
                by[column] = step;
                residual(&model.rows(&model.changed(&state, &by), campaign))
            };
            let step = 1e-5;
            // The residual decreases as the prediction increases.
            let slope = (side(-step) - side(step)) / (2.0 * step);
            let wrong = (slope - rows.column(column)).amax();
            assert!(wrong < 2e-7, "{campaign} {column}: {wrong}");
        }
    }
}

/// One joint about z with the tip at 1 m along x.
fn one_joint(compliance: f64, u: f64) -> Robot {
    let motions = vec![
        Motion::About(Axis::Z, Amount::Joint(0)),
        Motion::Along(Axis::X, Amount::Constant(1.0)),
    ];
    let stated = JointCompliance {
        value: compliance,
        standard_uncertainty: u,
    };
    let robot = Robot::new("one", motions, vec![Joint::plain("a")]).unwrap();
    robot.with_compliance(vec![stated]).unwrap()
}

#[test]
fn a_compliance_from_one_load_test_is_the_mode_of_the_product_of_prior_and_likelihood() {
    let robot = one_joint(1e-6, 4e-7);
    let known: Vec<Knowledge> = (prior(&robot, &FACTORS, false).into_iter())
        .filter(|one| matches!(one.parameter, Parameter::Drive(_)))
        .collect();
    assert_eq!(known.len(), 1);
    // 200 N across an arm of 1 m: 200 N m; the displacement along y is 200 c.
    let (value, u) = (3.2e-4, 5e-5);
    let test = LoadTest {
        joints: vec![0.0],
        wrench: Wrench::from_force(Vector3::y() * 200.0),
        force_point: Vector3::zeros(),
        measured_point: Vector3::zeros(),
        readings: vec![Reading {
            what: Measured::Displacement(Axis::Y),
            value,
            standard_uncertainty: u,
        }],
    };
    let found = update(&robot, &known, &[Campaign::LoadTests(vec![test])]).unwrap();
    // The exponent by hand, on a fine grid of the logarithm: prior ln c = ln 1e-6 +- 0.4.
    let exponent = |ln: f64| ((200.0 * ln.exp() - value) / u).powi(2) + ((ln - 1e-6_f64.ln()) / 0.4).powi(2);
    let grid = (0..200_000).map(|k| 1e-6_f64.ln() - 1.0 + 1e-5 * f64::from(k));
    let best = grid.min_by(|a, b| exponent(*a).total_cmp(&exponent(*b))).unwrap();
    assert!(
        (found.knowledge[0].mean - best).abs() < 2e-5,
        "{} {best}",
        found.knowledge[0].mean
    );
    let by_hand = 1.0 / ((200.0 * best.exp() / u).powi(2) + 1.0 / 0.16).sqrt();
    assert!((found.knowledge[0].deviation / by_hand - 1.0).abs() < 1e-4);
    assert!((found.from_measurements(0) - (1.0 - (by_hand / 0.4).powi(2))).abs() < 1e-4);
}

#[test]
fn the_longer_lever_is_measured_next_and_the_gain_is_that_by_hand() {
    let robot = one_joint(1e-6, 4e-7);
    let known: Vec<Knowledge> = (prior(&robot, &FACTORS, false).into_iter())
        .filter(|one| matches!(one.parameter, Parameter::Drive(_)))
        .collect();
    let test = |force: f64| LoadTest {
        joints: vec![0.0],
        wrench: Wrench::from_force(Vector3::y() * force),
        force_point: Vector3::zeros(),
        measured_point: Vector3::zeros(),
        readings: vec![Reading {
            what: Measured::Displacement(Axis::Y),
            value: 0.0,
            standard_uncertainty: 5e-5,
        }],
    };
    // Work at two points, of which one is loaded: what a rigid body does not take up is half of the difference each, and more.
    let point = |angle: f64, force: f64| WorkPoint {
        joints: vec![angle],
        condition: Condition {
            wrench: Wrench::from_force(Vector3::x() * force),
            directions: vec![0.0],
        },
    };
    let points: Vec<WorkPoint> = (0..5)
        .map(|k| point(0.3 * f64::from(k), if k % 2 == 0 { 100.0 } else { -60.0 }))
        .collect();
    let work = Work::new(&robot, Isometry::identity(), &points).unwrap();
    let before = Posterior {
        prior: known.clone(),
        covariance: work::independent(&known),
        knowledge: known.clone(),
        campaigns: Vec::new(),
    };
    let candidates = [test(50.0), test(200.0), test(100.0)].map(Candidate::LoadTest);
    let plan = Plan {
        count: 2,
        instrument: Instrument {
            flange_from_point: Isometry::identity(),
            standard_uncertainty: 1e-5,
        },
    };
    let chosen = next(&robot, &before, &work, &candidates, plan);
    assert_eq!(chosen.iter().map(|one| one.candidate).collect::<Vec<_>>(), [1, 2]);
    // One parameter: the deviation of the work is proportional to that of ln c. A test of d = 200 c has d/u = 2e-4 / 5e-5 = 4 per unit of ln c.
    let start = work.uncertainty(&robot, &known, &before.covariance);
    let after = |information: f64| start / 0.4 / (1.0 / 0.16 + information).sqrt();
    assert!(
        (chosen[0].uncertainty / after(16.0) - 1.0).abs() < 1e-9,
        "{chosen:?}"
    );
    assert!(
        (chosen[1].uncertainty / after(20.0) - 1.0).abs() < 1e-9,
        "{chosen:?}"
    );
    assert!((chosen[0].information - 0.5 * (1.0 + 16.0 * 0.16_f64).log2()).abs() < 1e-9);
}

#[test]
fn a_campaign_with_more_scatter_than_stated_has_a_larger_scale_and_less_weight() {
    let hidden = Hidden::new();
    let known = prior(&hidden.nominal, &FACTORS, true);
    let mut campaign = part(&hidden, &work(&hidden, 60, 1), 5e-5);
    if let Campaign::Positions(positions) = &mut campaign {
        positions.standard_uncertainty = 1e-5;
    }
    let found = update(&hidden.nominal, &known, &[campaign]).unwrap();
    let scale = found.campaigns[0].scale;
    assert!((4.0..6.2).contains(&scale), "{scale}");
}

#[test]
fn unsound_measurements_are_refused() {
    let hidden = Hidden::new();
    let known = prior(&hidden.nominal, &FACTORS, true);
    let refused = |campaigns: &[Campaign]| update(&hidden.nominal, &known, campaigns).unwrap_err();
    assert_eq!(refused(&[]), Refusal::Nothing);
    let good = part(&hidden, &work(&hidden, 5, 1), 1e-5);
    let changed = |change: &dyn Fn(&mut Positions)| {
        let mut campaign = good.clone();
        if let Campaign::Positions(positions) = &mut campaign {
            change(positions);
        }
        refused(&[good.clone(), campaign]).to_string()
    };
    assert!(changed(&|one| one.standard_uncertainty = 0.0).contains("number 2: its standard uncertainty"));
    assert!(changed(&|one| one.conditions.truncate(2)).contains("number of conditions"));
    assert!(changed(&|one| one.conditions[1].directions.truncate(2)).contains("number of directions"));
    assert!(
        changed(&|one| {
            one.poses.truncate(2);
            one.conditions.truncate(2);
        })
        .contains("number 2: 2 poses")
    );
    assert!(changed(&|one| one.poses[3].position.x = f64::NAN).contains("number 2: pose number 4"));
    let tests = Campaign::LoadTests(Vec::new());
    assert!(refused(&[tests]).to_string().contains("no readings"));
}
