//! What to measure next: the measurements that make the deviation at the work most certain.
//!
//! Of many candidates the one is taken that lowers the variance `V` of the deviation at the work (see [`work`](super::work)) most; the
//! covariance is updated as if it had been measured, and so on. With `H` the derivatives of a candidate over its standard uncertainties:
//!
//! ```text
//! S = 1 + H C H'        gain = tr (G C H' S^-1 H C G')        C <- C - C H' S^-1 H C        information = (1/2) ln det S
//! ```
//!
//! A position refers to the base by a frame that is known within [`FRAME`] before, and to a point known within the same: they
//! are columns of `H` too, shared by all positions chosen.
//!
//! Source: D. Lindley, On a measure of the information provided by an experiment, Ann. Math. Stat. 27, 1956; choice by the variance of the
//! prediction, K. Chaloner and I. Verdinelli, Bayesian experimental design: a review, Statistical Science 10, 1995.

use nalgebra::{Cholesky, DMatrix, Dyn, Vector3};
use rayon::prelude::*;

use super::measurement::{Campaign, Condition, Known, Observed, Positions};
use super::parameter::Knowledge;
use super::posterior::Posterior;
use super::state::Model;
use super::work::Work;
use crate::calibrate::MeasuredPose;
use crate::frame::Isometry;
use crate::identify::LoadTest;
use crate::robot::Robot;

/// Standard deviation of frame and point of new positions: m, rad.
pub const FRAME: [f64; 2] = [1e-3, 1e-3];

/// A measurement that could be made.
#[derive(Clone, Debug, PartialEq)]
pub enum Candidate {
    /// The position of the point at these joint positions, without load.
    Position(Vec<f64>),
    /// A load test; values of its readings do not matter.
    LoadTest(LoadTest),
}

/// How new positions are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instrument {
    /// The point on the flange.
    pub flange_from_point: Isometry,
    /// Standard uncertainty of a coordinate, m.
    pub standard_uncertainty: f64,
}

/// How much is to be measured, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Number of measurements.
    pub count: usize,
    /// Of positions.
    pub instrument: Instrument,
}

/// A chosen measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// Index of the candidate.
    pub candidate: usize,
    /// Standard uncertainty of the deviation at the work once it and all before it are measured, m.
    pub uncertainty: f64,
    /// Information that it adds, bit.
    pub information: f64,
}

/// The `count` best of `candidates`, best first; fewer if there are fewer.
pub fn next(
    robot: &Robot,
    known: &Posterior,
    work: &Work,
    candidates: &[Candidate],
    plan: Plan,
) -> Vec<Chosen> {
    let (knowledge, covariance) = (&known.knowledge, &known.covariance);
    let blocks = rows(robot, knowledge, candidates, plan.instrument);
    let width = knowledge.len() + FRAMES;
    let mut derivatives = work.derivatives(robot, knowledge);
    derivatives = derivatives.resize_horizontally(width, 0.0);
    let mut now = covariance.clone().resize(width, width, 0.0);
    for k in 0..FRAMES {
        let deviation = FRAME[usize::from((3..6).contains(&k))];
        now[(knowledge.len() + k, knowledge.len() + k)] = deviation * deviation;
    }
    let mut left: Vec<usize> = (0..candidates.len()).collect();
    let mut chosen = Vec::new();
    while chosen.len() < plan.count && !left.is_empty() {
        let at_work = &derivatives * &now;
        let gain = |candidate: &usize| {
            let update = Update::of(&blocks[*candidate], &now)?;
            Some((
                *candidate,
                update.whitened_gain(&at_work, &blocks[*candidate]),
                update,
            ))
        };
        let best = left.par_iter().filter_map(gain).max_by(|a, b| {
            // Of equal gains the first candidate.
            a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))
        });
        let Some((candidate, _, update)) = best else {
            break;
        };
        now = update.after(&now, &blocks[candidate]);
        left.retain(|other| *other != candidate);
        let variance = (&derivatives * &now).component_mul(&derivatives).sum();
        chosen.push(Chosen {
            candidate,
            uncertainty: (variance.max(0.0) / work.points() as f64).sqrt(),
            information: update.bits(),
        });
    }
    chosen
}

/// Columns of a base frame and a point.
const FRAMES: usize = 9;

/// What one candidate does to the covariance.
struct Update {
    /// Cholesky factor of `S`.
    factor: Cholesky<f64, Dyn>,
}

impl Update {
    /// None where `S` is not positive definite: numbers that are not finite.
    fn of(rows: &DMatrix<f64>, covariance: &DMatrix<f64>) -> Option<Update> {
        let s = rows * covariance * rows.transpose() + DMatrix::identity(rows.nrows(), rows.nrows());
        Some(Update {
            factor: s.cholesky()?,
        })
    }

    /// `tr (G C H' S^-1 H C G')`, with `at_work = G C`.
    fn whitened_gain(&self, at_work: &DMatrix<f64>, rows: &DMatrix<f64>) -> f64 {
        let mut seen = rows * at_work.transpose();
        self.factor.l_dirty().solve_lower_triangular_mut(&mut seen);
        seen.norm_squared()
    }

    fn after(&self, covariance: &DMatrix<f64>, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let seen = rows * covariance;
        covariance - seen.transpose() * self.factor.solve(&seen)
    }

    fn bits(&self) -> f64 {
        let diagonal = self.factor.l_dirty().diagonal();
        diagonal.iter().map(|entry| entry.log2()).sum()
    }
}

/// Derivatives of each candidate over its standard uncertainties; frame and point last.
fn rows(
    robot: &Robot,
    knowledge: &[Knowledge],
    candidates: &[Candidate],
    instrument: Instrument,
) -> Vec<DMatrix<f64>> {
    let width = knowledge.len() + FRAMES;
    let of = |candidate: &Candidate| {
        let campaign = match candidate {
            Candidate::LoadTest(test) => Campaign::LoadTests(vec![test.clone()]),
            Candidate::Position(joints) => Campaign::Positions(Positions {
                poses: vec![MeasuredPose {
                    joints: joints.clone(),
                    position: Vector3::zeros(),
                    rotation: None,
                }],
                conditions: vec![Condition::unloaded(robot)],
                flange_from_point: instrument.flange_from_point,
                point: Known::Approximately,
                standard_uncertainty: instrument.standard_uncertainty,
                turn_length: 1.0,
                observed: Observed::Coordinates,
            }),
        };
        let campaigns = [campaign];
        let model = Model::new(robot, knowledge, &campaigns);
        let rows = model.rows(&model.at(instrument.flange_from_point), 0);
        let columns = rows.ncols() - 1;
        rows.columns(0, columns)
            .into_owned()
            .resize_horizontally(width, 0.0)
    };
    candidates.par_iter().map(of).collect()
}
