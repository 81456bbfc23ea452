//! Design of load tests: postures and loads that minimise the uncertainty of the compliances.
//!
//! D-optimal: the determinant of `sum D_t^T D_t + P^T P` is greatest, `D_t` the derivatives of the readings of test `t`
//! by the logarithms of the sizes over the uncertainty of the gauge, `P` the typical prior. Candidates are postures of
//! a Halton sequence inside the joint limits, with the tool clear of the floor and of the arm itself, each with every
//! load; tests are added one by one and then exchanged until there is no further gain (Fedorov 1972; Mitchell 1974).
//! The result is reproducible.

use nalgebra::{DMatrix, Unit, Vector3};

use super::effect::{Effects, State};
use super::load_test::{LoadTest, Measured, Reading};
use super::prior::{LogPrior, typical};
use super::spread::Spread;
use super::unknown::Unknown;
use crate::robot::chain::Axis;
use crate::robot::forward::forward;
use crate::robot::{Joint, Limits, Robot};
use crate::spatial::Wrench;

/// Input of a plan.
#[derive(Clone, Debug)]
pub struct PlanQuestion {
    /// Number of tests.
    pub tests: usize,
    /// Loads that can be applied, N, base axes.
    pub pulls: Vec<Vector3<f64>>,
    /// Force point and measured point, m, flange frame.
    pub tool_point: Vector3<f64>,
    /// Standard uncertainty of a displacement reading, m.
    pub gauge: f64,
    /// The tool must stay above this plane; `None` without such a plane.
    pub floor: Option<Floor>,
}

/// A floor, a wall or a ceiling that the arm is mounted on or next to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// Away from it, base axes.
    pub up: Unit<Vector3<f64>>,
    /// Its distance along `up` from the base origin, m.
    pub height: f64,
}

impl Floor {
    /// The floor that the arm is mounted on: base z is up, the base origin is in it.
    pub fn under_base() -> Floor {
        Floor {
            up: Vector3::z_axis(),
            height: 0.0,
        }
    }
}

/// One test to do.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedTest {
    /// Joint positions, rad (m), whole degrees (mm).
    pub joints: Vec<f64>,
    /// N, base axes.
    pub force: Vector3<f64>,
    /// Displacement predicted with typical drives, m, base axes.
    pub expected: Vector3<f64>,
}

/// Tests and the expected uncertainties.
#[derive(Clone, Debug)]
pub struct Plan {
    /// In the order of their postures.
    pub tests: Vec<PlannedTest>,
    /// Of the logarithms of the sizes: the square root of its diagonal is the expected relative uncertainty.
    pub spread: Spread,
}

/// Number of candidate postures.
const POSTURES: u32 = 400;
/// Maximum number of exchange rounds; two or three are usual.
const ROUNDS: usize = 6;
/// The tool stays higher than this over the floor, m, and than this fraction of the reach of the flange.
const LOWEST: [f64; 2] = [0.2, 0.15];
/// And further than this from the first axis, m, and than this fraction: outside the arm itself.
const NEAREST: [f64; 2] = [0.4, 0.3];
/// A joint without known limits is turned (moved) by no more than this, rad (m).
const FREE: f64 = 1.5;
/// Part of its range that a joint keeps clear of at each end.
const MARGIN: f64 = 0.1;
const PRIMES: [u32; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// A candidate test, and its rows of the unknowns.
struct Candidate {
    posture: u32,
    test: PlannedTest,
    rows: DMatrix<f64>,
}

/// The best tests for `unknowns`; fewer than requested only where no further posture is free.
pub fn plan(robot: &Robot, unknowns: &[Unknown], requested: &PlanQuestion) -> Plan {
    let candidates = candidates(robot, unknowns, requested);
    let (prior, _) = LogPrior::rows(&typical(unknowns), unknowns.len());
    let mut information = prior.tr_mul(&prior);
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < requested.tests.min(candidates.len()) {
        let best = best_addition(&information, &candidates, &chosen);
        add(&mut information, &candidates[best], 1.0);
        chosen.push(best);
    }
    for _ in 0..ROUNDS {
        let before = chosen.clone();
        for _ in 0..chosen.len() {
            let oldest = chosen.remove(0);
            add(&mut information, &candidates[oldest], -1.0);
            let best = best_addition(&information, &candidates, &chosen);
            add(&mut information, &candidates[best], 1.0);
            chosen.push(best);
        }
        if chosen == before {
            break;
        }
    }
    chosen.sort_by_key(|place| (candidates[*place].posture, *place));
    let mut rows = DMatrix::zeros(3 * chosen.len(), unknowns.len());
    for (row, place) in chosen.iter().enumerate() {
        rows.rows_mut(3 * row, 3).copy_from(&candidates[*place].rows);
    }
    Plan {
        tests: chosen
            .iter()
            .map(|place| candidates[*place].test.clone())
            .collect(),
        spread: Spread::of(&rows, &prior, &vec![true; unknowns.len()]),
    }
}

fn add(information: &mut DMatrix<f64>, candidate: &Candidate, times: f64) {
    *information += candidate.rows.tr_mul(&candidate.rows) * times;
}

/// The candidate that multiplies the determinant most, `det(1 + D M^-1 D^T)`, of those not yet chosen: a repeated test
/// would only show the scatter.
fn best_addition(information: &DMatrix<f64>, candidates: &[Candidate], chosen: &[usize]) -> usize {
    let inverse = information.clone().cholesky().map(|c| c.inverse());
    let inverse = inverse.unwrap_or_else(|| DMatrix::identity(information.nrows(), information.ncols()));
    let gain = |candidate: &Candidate| {
        let inner = &candidate.rows * &inverse * candidate.rows.transpose();
        (DMatrix::identity(3, 3) + inner).determinant()
    };
    let free = candidates
        .iter()
        .enumerate()
        .filter(|(place, _)| !chosen.contains(place));
    let gains = free.map(|(place, candidate)| (place, gain(candidate)));
    // The first of equal ones.
    gains
        .fold(
            (0, f64::NEG_INFINITY),
            |best, next| if next.1 > best.1 { next } else { best },
        )
        .0
}

fn candidates(robot: &Robot, unknowns: &[Unknown], requested: &PlanQuestion) -> Vec<Candidate> {
    let state = State::typical(unknowns);
    let mut found = Vec::new();
    for (posture, joints) in postures_with_room(robot, requested) {
        for pull in &requested.pulls {
            let test = test_of(&joints, *pull, requested);
            let effects = Effects::of(robot, unknowns, &test);
            let jacobian = effects.jacobian(unknowns, &state);
            let rows = DMatrix::from_fn(3, unknowns.len(), |i, k| {
                jacobian[(i, k)] * state.sizes[k] / requested.gauge
            });
            let readings = effects.readings(unknowns, &state);
            found.push(Candidate {
                posture,
                test: PlannedTest {
                    joints: joints.clone(),
                    force: *pull,
                    expected: Vector3::from_column_slice(&readings),
                },
                rows,
            });
        }
    }
    found
}

fn test_of(joints: &[f64], pull: Vector3<f64>, requested: &PlanQuestion) -> LoadTest {
    let reading = |axis| Reading {
        what: Measured::Displacement(axis),
        value: 0.0,
        standard_uncertainty: requested.gauge,
    };
    LoadTest {
        joints: joints.to_vec(),
        wrench: Wrench::from_force(pull),
        force_point: requested.tool_point,
        measured_point: requested.tool_point,
        readings: [Axis::X, Axis::Y, Axis::Z].map(reading).to_vec(),
    }
}

/// Postures of the sequence in which the tool is clear of floor and arm, each with its number.
fn postures_with_room(robot: &Robot, requested: &PlanQuestion) -> Vec<(u32, Vec<f64>)> {
    let looked_at = (1..=POSTURES).map(|index| {
        let joints = posture(robot, index);
        let frames = forward(robot, &joints);
        let tool = frames.base_from_flange * nalgebra::Point3::from(requested.tool_point);
        let places = [frames.base_from_flange.translation.vector, tool.coords];
        let first = frames.origin(0);
        let away = places.map(|place| (place.xy() - first.coords.xy()).norm());
        (index, joints, places, away)
    });
    let looked_at: Vec<_> = looked_at.collect();
    let farthest = looked_at.iter().map(|(.., away)| away[0]).fold(0.0, f64::max);
    let clearance = |[most, part]: [f64; 2]| f64::min(most, part * farthest);
    let (lowest, nearest) = (clearance(LOWEST), clearance(NEAREST));
    let above = |place: &Vector3<f64>| {
        let floor = requested.floor.as_ref();
        floor.is_none_or(|floor| place.dot(&floor.up) - floor.height > lowest)
    };
    let has_room = looked_at
        .into_iter()
        .filter(|(_, _, places, away)| places.iter().all(above) && away.iter().all(|away| *away > nearest));
    has_room.map(|(index, joints, ..)| (index, joints)).collect()
}

/// Posture number `index` of the sequence.
fn posture(robot: &Robot, index: u32) -> Vec<f64> {
    let position = |(joint, described): (usize, &Joint)| {
        let free = Limits {
            lower: -FREE,
            upper: FREE,
        };
        let limits = described.limits.unwrap_or(free);
        // A range of more than one turn adds nothing.
        let half = (0.5 * (limits.upper - limits.lower) * (1.0 - 2.0 * MARGIN)).min(std::f64::consts::PI);
        let part = halton(index, PRIMES[joint % PRIMES.len()]);
        let position = limits.middle() + half * (2.0 * part - 1.0);
        if robot.slides(joint) {
            (position * 1e3).round() * 1e-3
        } else {
            position.to_degrees().round().to_radians()
        }
    };
    robot.joints().iter().enumerate().map(position).collect()
}

/// Element `index` of the Halton sequence of this prime, 0 to 1.
fn halton(mut index: u32, prime: u32) -> f64 {
    let (mut value, mut part) = (0.0, 1.0);
    while index > 0 {
        part /= f64::from(prime);
        value += part * f64::from(index % prime);
        index /= prime;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::super::small_arm::arm;
    use super::super::unknown::{bending, drives};
    use super::*;

    #[test]
    fn the_sequence_of_two_is_that_of_van_der_corput() {
        let first: Vec<f64> = (1..=7).map(|index| halton(index, 2)).collect();
        assert_eq!(first, [0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875]);
    }

    fn question(scale: f64, floor: Option<Floor>) -> PlanQuestion {
        PlanQuestion {
            tests: 5,
            pulls: vec![-Vector3::z() * 150.0, Vector3::x() * 150.0, Vector3::y() * 150.0],
            tool_point: Vector3::new(0.0, 0.03, 0.02) * scale,
            gauge: 1e-5,
            floor,
        }
    }

    /// Position of the tool in each test, m, base.
    fn tools(robot: &Robot, question: &PlanQuestion, plan: &Plan) -> Vec<Vector3<f64>> {
        let tool = |test: &PlannedTest| {
            let frames = forward(robot, &test.joints);
            (frames.base_from_flange * nalgebra::Point3::from(question.tool_point)).coords
        };
        plan.tests.iter().map(tool).collect()
    }

    #[test]
    fn no_exchange_of_a_single_test_increases_the_determinant() {
        let robot = arm(1.0);
        let unknowns = [drives(&robot), bending(&robot)].concat();
        let question = question(1.0, Some(Floor::under_base()));
        let plan = plan(&robot, &unknowns, &question);
        let all = candidates(&robot, &unknowns, &question);
        let chosen: Vec<usize> = plan
            .tests
            .iter()
            .map(|test| all.iter().position(|candidate| candidate.test == *test).unwrap())
            .collect();
        let (prior, _) = LogPrior::rows(&typical(&unknowns), unknowns.len());
        let mut information = prior.tr_mul(&prior);
        for place in &chosen {
            add(&mut information, &all[*place], 1.0);
        }
        let most = information.clone().determinant();
        for place in &chosen {
            for other in (0..all.len()).filter(|other| !chosen.contains(other)) {
                let mut exchanged = information.clone();
                add(&mut exchanged, &all[*place], -1.0);
                add(&mut exchanged, &all[other], 1.0);
                assert!(exchanged.determinant() < most * (1.0 + 1e-9), "{place} {other}");
            }
        }
    }

    #[test]
    fn the_expected_covariance_is_that_of_the_information_of_the_tests() {
        let robot = arm(1.0);
        let unknowns = drives(&robot);
        let question = question(1.0, None);
        let plan = plan(&robot, &unknowns, &question);
        let (prior, _) = LogPrior::rows(&typical(&unknowns), unknowns.len());
        let mut information = prior.tr_mul(&prior);
        for candidate in candidates(&robot, &unknowns, &question) {
            if plan.tests.contains(&candidate.test) {
                add(&mut information, &candidate, 1.0);
            }
        }
        let covariance = information.try_inverse().unwrap();
        assert!((&plan.spread.covariance - &covariance).amax() < 1e-9 * covariance.amax());
        // More tests increase no uncertainty.
        let more = PlanQuestion {
            tests: 10,
            ..question
        };
        let more = super::plan(&robot, &unknowns, &more);
        for k in 0..unknowns.len() {
            assert!(more.spread.covariance[(k, k)] < covariance[(k, k)], "{k}");
        }
    }

    #[test]
    fn a_small_arm_has_a_plan_that_keeps_clear_of_floor_and_arm() {
        for scale in [0.25, 1.0, 4.0] {
            let robot = arm(scale);
            let question = question(scale, Some(Floor::under_base()));
            let plan = plan(&robot, &drives(&robot), &question);
            assert_eq!(plan.tests.len(), 5, "{scale}");
            let (lowest, nearest) = (f64::min(0.2, 0.14 * scale), f64::min(0.4, 0.28 * scale));
            for tool in tools(&robot, &question, &plan) {
                assert!(tool.z > lowest && tool.xy().norm() > nearest, "{scale}: {tool}");
            }
        }
    }

    #[test]
    fn an_arm_on_a_wall_or_a_ceiling_keeps_clear_of_it() {
        let robot = arm(1.0);
        let wall = Floor {
            up: -Vector3::x_axis(),
            height: -0.3,
        };
        let ceiling = Floor {
            up: -Vector3::z_axis(),
            height: -0.9,
        };
        for floor in [wall, ceiling] {
            let question = question(1.0, Some(floor));
            let plan = plan(&robot, &drives(&robot), &question);
            assert_eq!(plan.tests.len(), 5, "{floor:?}");
            for tool in tools(&robot, &question, &plan) {
                assert!(tool.dot(&floor.up) - floor.height > 0.14, "{floor:?}: {tool}");
            }
        }
        // Under a floor that covers all positions no posture is free; without one all are.
        let deep = Floor {
            height: 10.0,
            ..Floor::under_base()
        };
        assert!(
            plan(&robot, &drives(&robot), &question(1.0, Some(deep)))
                .tests
                .is_empty()
        );
        let postures = |floor| postures_with_room(&robot, &question(1.0, floor)).len();
        assert!(postures(None) > postures(Some(wall)) && postures(None) > postures(Some(ceiling)));
    }

    #[test]
    fn elements_of_the_sequence_are_distributed_evenly() {
        for prime in PRIMES {
            let all: Vec<f64> = (1..=400).map(|index| halton(index, prime)).collect();
            assert!(all.iter().all(|value| (0.0..1.0).contains(value)));
            for tenth in 0..10 {
                let (from, to) = (f64::from(tenth) / 10.0, f64::from(tenth + 1) / 10.0);
                let inside = all.iter().filter(|value| (from..to).contains(*value)).count();
                // A sequence without pattern would miss by 6; this one by two digits of its prime at most.
                assert!(inside.abs_diff(40) <= 20, "{prime}: {inside} from {from} to {to}");
            }
        }
    }
}
