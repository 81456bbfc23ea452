//! What the measurements of a journal say.

use armill_core::units::{to_deg, to_mm, to_um};
use armill_core::update::{CampaignOutcome, Knowledge, Parameter};
use armill_formats::measurement::conditions::ConditionRow;
use armill_formats::measurement::journal::{Entry, Kind};
use armill_study::number::{decimals, digits};
use serde::Serialize;

use super::learning::{Learning, is_loaded};
use super::measurements::Measurements;
use super::output::DETERMINED;

/// Temperatures further apart than this are noted, K.
const SAME_TEMPERATURE: f64 = 5.0;
/// A scatter of more than this many stated uncertainties is noted.
const LARGE_SCALE: f64 = 2.0;

/// What the measurements of a journal say.
#[derive(Clone, Debug, Serialize)]
pub struct JournalAnswer {
    /// Name of the robot.
    pub robot: String,
    /// The journal.
    pub file: String,
    /// Each measurement.
    pub measurements: Vec<MeasurementAnswer>,
    /// Compliances of the drives.
    pub drives: Vec<ParameterAnswer>,
    /// Backlash of the joints.
    pub backlash: Vec<ParameterAnswer>,
    /// Small motions of the chain.
    pub geometry: GeometryAnswer,
    /// The deviation at the work.
    pub work: Option<WorkAnswer>,
    /// What to measure next, best first.
    pub next: Vec<NextAnswer>,
    /// Columns that were passed over.
    pub unused: Vec<String>,
    /// Notes on these numbers.
    pub notes: Vec<String>,
    /// Sources of the methods.
    pub sources: Vec<&'static str>,
}

/// One measurement.
#[derive(Clone, Debug, Serialize)]
pub struct MeasurementAnswer {
    /// Day.
    pub date: String,
    /// Temperature of the arm.
    pub temperature_c: f64,
    /// `part`, `tracker`, `ball-bar` or `load tests`.
    pub kind: &'static str,
    /// Its file.
    pub file: String,
    /// Number of measured numbers.
    pub readings: usize,
    /// Residuals over the stated uncertainty, root mean square: by the robot file.
    pub before: f64,
    /// As predicted from the measurements before it.
    pub predicted: f64,
    /// By the arm of all measurements.
    pub after: f64,
    /// Its scatter over the stated uncertainty; 1 where it is not larger.
    pub scatter: f64,
    /// Number of parameters that it determined.
    pub determined: f64,
}

/// Compliance or backlash of a joint.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterAnswer {
    /// Name of the joint.
    pub joint: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// After all measurements.
    pub value: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Before any measurement.
    pub before: f64,
    /// Its standard uncertainty.
    pub before_u: f64,
    /// Part of what is known that comes from the measurements.
    pub from_measurements_percent: f64,
}

/// The small motions of the chain.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryAnswer {
    /// Their number.
    pub parameters: usize,
    /// Number of those of which most is known from the measurements.
    pub determined: usize,
    /// Largest one along an axis.
    pub largest_mm: f64,
    /// Largest one about an axis.
    pub largest_deg: f64,
}

/// The deviation at the work, displacements and rotations of the whole removed.
#[derive(Clone, Debug, Serialize)]
pub struct WorkAnswer {
    /// Its root mean square by the arm of all measurements.
    pub deviation_um: f64,
    /// Its standard uncertainty, root mean square: before any measurement, and after each.
    pub uncertainty_um: Vec<f64>,
}

/// A measurement to make.
#[derive(Clone, Debug, Serialize)]
pub struct NextAnswer {
    /// Line of the candidate in its file.
    pub line: usize,
    /// `position` or `load test`.
    pub kind: &'static str,
    /// Joint positions: deg, of prismatic joints mm.
    pub joints: Vec<f64>,
    /// Standard uncertainty of the deviation at the work, once it and those before it are measured.
    pub uncertainty_um: f64,
    /// Information that it adds.
    pub information_bit: f64,
}

/// The numbers of what was learnt.
pub fn answer(measurements: &Measurements, learning: &Learning) -> JournalAnswer {
    let posterior = &learning.posterior;
    let entries = measurements.journal.measurements.iter();
    let each = entries.zip(&posterior.campaigns).zip(&learning.predicted);
    let measured: Vec<MeasurementAnswer> = each
        .map(|((entry, outcome), predicted)| measurement(entry, outcome, *predicted))
        .collect();
    let um = |length: f64| decimals(to_um(length), 2);
    JournalAnswer {
        robot: measurements.robot.robot.name().to_owned(),
        file: measurements.file.clone(),
        drives: parameters(measurements, learning, |parameter| match parameter {
            Parameter::Drive(joint) => Some(joint),
            _ => None,
        }),
        backlash: parameters(measurements, learning, |parameter| match parameter {
            Parameter::Backlash(joint) => Some(joint),
            _ => None,
        }),
        geometry: geometry(learning),
        work: learning.uncertainty.as_ref().map(|uncertainty| WorkAnswer {
            deviation_um: um(learning.deviation.unwrap_or_default()),
            uncertainty_um: uncertainty.iter().map(|u| um(*u)).collect(),
        }),
        next: next(measurements, learning),
        unused: measurements.unused.clone(),
        notes: notes(measurements, learning, &measured),
        measurements: measured,
        sources: vec![
            "Gelman et al. 2013: Bayesian Data Analysis, chapter 4; Chaloner and Verdinelli 1995: Bayesian experimental design",
            "theory: docs/theory/journal.md",
        ],
    }
}

fn measurement(entry: &Entry, outcome: &CampaignOutcome, predicted: f64) -> MeasurementAnswer {
    let reported = |value: f64| digits(value, 3);
    MeasurementAnswer {
        date: entry.date.clone(),
        temperature_c: entry.temperature_c,
        kind: match entry.kind {
            Kind::Part(_) => "part",
            Kind::Tracker(_) => "tracker",
            Kind::LoadTests => "load tests",
            Kind::BallBar { .. } => "ball-bar",
        },
        file: entry.file.clone(),
        readings: outcome.rows,
        before: reported(outcome.before),
        predicted: reported(predicted),
        after: reported(outcome.after),
        scatter: reported(outcome.scale),
        determined: decimals(outcome.determined, 1),
    }
}

fn parameters(
    measurements: &Measurements,
    learning: &Learning,
    joint_of: impl Fn(Parameter) -> Option<usize>,
) -> Vec<ParameterAnswer> {
    let robot = &measurements.robot.robot;
    let posterior = &learning.posterior;
    let of = |(k, known): (usize, &Knowledge)| {
        let joint = joint_of(known.parameter)?;
        let (unit, factor) = match (known.parameter, robot.slides(joint)) {
            (Parameter::Drive(_), false) => ("rad/(N m)", 1.0),
            (Parameter::Drive(_), true) => ("um/N", to_um(1.0)),
            (_, false) => ("deg", to_deg(1.0)),
            (_, true) => ("mm", to_mm(1.0)),
        };
        let reported = |value: f64| digits(value * factor, 4);
        let before = &posterior.prior[k];
        Some(ParameterAnswer {
            joint: robot.joints()[joint].name.clone(),
            unit,
            value: reported(known.value()),
            u: reported(known.standard_uncertainty()),
            before: reported(before.value()),
            before_u: reported(before.standard_uncertainty()),
            from_measurements_percent: decimals(100.0 * posterior.from_measurements(k), 1),
        })
    };
    posterior.knowledge.iter().enumerate().filter_map(of).collect()
}

fn geometry(learning: &Learning) -> GeometryAnswer {
    let posterior = &learning.posterior;
    let mut answer = GeometryAnswer {
        parameters: 0,
        determined: 0,
        largest_mm: 0.0,
        largest_deg: 0.0,
    };
    for (k, known) in posterior.knowledge.iter().enumerate() {
        let Parameter::Geometry(unknown) = known.parameter else {
            continue;
        };
        answer.parameters += 1;
        answer.determined += usize::from(posterior.from_measurements(k) >= DETERMINED);
        let largest = match unknown.turns() {
            true => (&mut answer.largest_deg, decimals(to_deg(known.mean.abs()), 4)),
            false => (&mut answer.largest_mm, decimals(to_mm(known.mean.abs()), 4)),
        };
        *largest.0 = largest.0.max(largest.1);
    }
    answer
}

fn next(measurements: &Measurements, learning: &Learning) -> Vec<NextAnswer> {
    let robot = &measurements.robot.robot;
    let Some((rows, chosen)) = &learning.next else {
        return Vec::new();
    };
    let joints = |row: &ConditionRow| {
        let one = |(joint, value): (usize, &f64)| match robot.slides(joint) {
            true => decimals(to_mm(*value), 3),
            false => decimals(to_deg(*value), 3),
        };
        row.joints.iter().enumerate().map(one).collect()
    };
    let each = chosen.iter().map(|chosen| (chosen, &rows[chosen.candidate]));
    each.map(|(chosen, row)| NextAnswer {
        line: row.line,
        kind: if is_loaded(row) { "load test" } else { "position" },
        joints: joints(row),
        uncertainty_um: decimals(to_um(chosen.uncertainty), 2),
        information_bit: decimals(chosen.information, 2),
    })
    .collect()
}

fn notes(measurements: &Measurements, learning: &Learning, measured: &[MeasurementAnswer]) -> Vec<String> {
    let mut notes = vec![
        "the weight of the arm is part of its geometry: measure with the tool and the load that it will have"
            .to_owned(),
        "predicted: base and point are fitted to the measurement, the arm is known from those before it"
            .to_owned(),
    ];
    for measurement in measured
        .iter()
        .filter(|measurement| measurement.scatter > LARGE_SCALE)
    {
        notes.push(format!(
            "{}: the scatter is {} times the stated uncertainty; its weight is lower by that. Friction, temperature, and errors of gears are not modelled here (armill learn)",
            measurement.file, measurement.scatter
        ));
    }
    let temperatures = || measured.iter().map(|measurement| measurement.temperature_c);
    let (low, high) = (
        temperatures().fold(f64::INFINITY, f64::min),
        temperatures().fold(f64::NEG_INFINITY, f64::max),
    );
    if high - low > SAME_TEMPERATURE {
        notes.push(format!(
            "measured between {low} and {high} deg C: growth of the arm with temperature is part of what the measurements disagree by"
        ));
    }
    let posterior = &learning.posterior;
    let undetermined: Vec<&str> = (posterior.knowledge.iter().enumerate())
        .filter_map(|(k, known)| match known.parameter {
            Parameter::Drive(joint) if posterior.from_measurements(k) < DETERMINED => Some(joint),
            _ => None,
        })
        .map(|joint| measurements.robot.robot.joints()[joint].name.as_str())
        .collect();
    if !undetermined.is_empty() {
        notes.push(format!(
            "mostly known from before, not from the measurements: compliance of {}",
            undetermined.join(", ")
        ));
    }
    notes
}
