//! The arm after each measurement of a journal, and what to measure next.

use std::path::PathBuf;

use armill_core::frame::Isometry;
use armill_core::identify::{LoadTest, Measured, Reading};
use armill_core::nalgebra::{DMatrix, Vector3};
use armill_core::robot::Axis;
use armill_core::update::{
    Campaign, Candidate, Chosen, Instrument, Knowledge, Plan, Posterior, Work, WorkPoint, next, prior, update,
};
use armill_core::watch::{Cancelled, Watch};
use armill_formats::measurement::conditions::ConditionRow;
use armill_study::StudyError;

use super::measurements::{Measurements, conditions};

/// Settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Points where the deviation matters: joint positions, loads, directions.
    pub work: Option<PathBuf>,
    /// What to measure next.
    pub planned: Option<Planned>,
}

/// What could be measured next.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Number of measurements.
    pub count: usize,
    /// Candidates: rows with a load are load tests, rows without positions. The work without a file.
    pub candidates: Option<PathBuf>,
    /// Standard uncertainty of a coordinate, m.
    pub position_u: f64,
    /// Standard uncertainty of a displacement under load, m.
    pub displacement_u: f64,
}

/// What was learnt.
#[derive(Clone, Debug)]
pub struct Learning {
    /// After all measurements.
    pub posterior: Posterior,
    /// Residuals of each measurement over their uncertainties, root mean square, as predicted from those before it.
    pub predicted: Vec<f64>,
    /// Standard uncertainty of the deviation at the work before any measurement and after each, m.
    pub uncertainty: Option<Vec<f64>>,
    /// Deviation at the work, m: its root mean square.
    pub deviation: Option<f64>,
    /// Candidates and those chosen.
    pub next: Option<(Vec<ConditionRow>, Vec<Chosen>)>,
}

/// Learns from `measurements`. The watch counts measurements.
///
/// # Errors
/// Measurements that belong to another robot; the problems of a file; cancellation.
pub fn learn(
    measurements: &Measurements,
    question: &Question,
    watch: Watch<'_>,
) -> Result<Learning, StudyError> {
    let robot = &measurements.robot.robot;
    let campaigns = &measurements.campaigns;
    let reverses = campaigns.iter().any(Campaign::reverses);
    let before = prior(robot, &measurements.journal.prior, reverses);
    let work = match &question.work {
        None => None,
        Some(path) => Some((path, conditions(path, robot)?)),
    };
    let tool = Isometry::from_parts(measurements.journal.tool_point.into(), Default::default());
    let points = work.as_ref().map(|(_, rows)| {
        let point = |row: &ConditionRow| WorkPoint {
            joints: row.joints.clone(),
            condition: row.condition.clone(),
        };
        rows.iter().map(point).collect::<Vec<_>>()
    });
    let at_work = points.and_then(|points| Work::new(robot, tool, &points));
    let uncertainty = |knowledge: &[Knowledge], covariance: &DMatrix<f64>| {
        (at_work.as_ref()).map(|work| work.uncertainty(robot, knowledge, covariance))
    };
    let independent = armill_core::update::work::independent(&before);
    let mut uncertainties = vec![uncertainty(&before, &independent)];
    let mut predicted = Vec::new();
    let mut known = before.clone();
    let mut posterior = None;
    for count in 1..=campaigns.len() {
        if watch.is_cancelled() {
            return Err(Cancelled.into());
        }
        let alone = update(robot, &known, &campaigns[count - 1..count]);
        predicted.push(refused(measurements, count - 1, alone)?.campaigns[0].before);
        let found = refused(measurements, 0, update(robot, &before, &campaigns[..count]))?;
        uncertainties.push(uncertainty(&found.knowledge, &found.covariance));
        known.clone_from(&found.knowledge);
        posterior = Some(found);
        (watch.finished)(1);
    }
    let posterior = posterior.ok_or_else(|| {
        StudyError::value(
            format!("{}: there are no measurements", measurements.file),
            "add [[measurement]]",
        )
    })?;
    let planned = match (&question.planned, &at_work) {
        (None, _) => None,
        (Some(_), None) => {
            return Err(StudyError::value(
                "--next: the work is missing".to_owned(),
                "add --work FILE: joint positions, loads and directions where the deviation matters",
            ));
        }
        (Some(planned), Some(at_work)) => {
            let rows = match (&planned.candidates, work) {
                (Some(path), _) => conditions(path, robot)?,
                (None, Some((_, rows))) => rows,
                (None, None) => Vec::new(),
            };
            let of_row = |row: &ConditionRow| candidate(row, tool, planned.displacement_u);
            let candidates: Vec<Candidate> = rows.iter().map(of_row).collect();
            let plan = Plan {
                count: planned.count,
                instrument: Instrument {
                    flange_from_point: tool,
                    standard_uncertainty: planned.position_u,
                },
            };
            let chosen = next(robot, &posterior, at_work, &candidates, plan);
            Some((rows, chosen))
        }
    };
    let deviation = at_work.map(|work| {
        let all = work.deviation(robot, &posterior.knowledge);
        let squares: f64 = all.iter().map(Vector3::norm_squared).sum();
        (squares / all.len() as f64).sqrt()
    });
    Ok(Learning {
        uncertainty: uncertainties.into_iter().collect(),
        next: planned,
        posterior,
        predicted,
        deviation,
    })
}

/// Whether a row is a load test.
pub(super) fn is_loaded(row: &ConditionRow) -> bool {
    let wrench = &row.condition.wrench;
    wrench.force.norm() > 0.0 || wrench.moment.norm() > 0.0
}

fn candidate(row: &ConditionRow, tool: Isometry, displacement_u: f64) -> Candidate {
    if !is_loaded(row) {
        return Candidate::Position(row.joints.clone());
    }
    let point = tool.translation.vector;
    Candidate::LoadTest(LoadTest {
        joints: row.joints.clone(),
        wrench: row.condition.wrench,
        force_point: point,
        measured_point: point,
        readings: Axis::ALL
            .map(|axis| Reading {
                what: Measured::Displacement(axis),
                value: 0.0,
                standard_uncertainty: displacement_u,
            })
            .to_vec(),
    })
}

fn refused<T>(
    measurements: &Measurements,
    first: usize,
    found: Result<T, armill_core::update::Refusal>,
) -> Result<T, StudyError> {
    use armill_core::update::Refusal;
    found.map_err(|error| {
        let of = |index: usize| {
            let entry = measurements.journal.measurements.get(first + index);
            entry.map_or_else(|| measurements.file.clone(), |entry| entry.file.clone())
        };
        match &error {
            Refusal::Positions { index, error } => crate::calibrate::calibration::refused(&of(*index), error),
            Refusal::Unsound { index, what } => StudyError::value(
                format!("{}: {what}", of(*index)),
                "is it a measurement of this robot?",
            ),
            Refusal::Nothing | Refusal::NotFound => StudyError::value(
                format!("{}: {error}", measurements.file),
                "check units, signs and the order of the joints in each file; or permit larger deviations in [prior]",
            ),
        }
    })
}
