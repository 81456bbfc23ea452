//! A measured force as the load of a program: its record, its orientation and treatment, and the start of the program
//! in it.
//!
//! A point that the tip reaches at the time `t` of the program gets the force at `start + t` of the record, as it acts
//! on the tool. Moments are left out: they refer to the origin of the sensor.

use std::path::Path;

use armill_core::load::record::align::align;
use armill_core::load::record::lag::{self, Lag};
use armill_core::load::record::revolutions::{mean_at, turn_at};
use armill_core::load::{ActsOn, LoadFrame, PathLoad, Record, RecordError};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::path::{Clock, NoTime, Speeds, Track};
use armill_core::spatial::Wrench;
use armill_core::units::from_deg;
use armill_core::watch::Watch;
use armill_formats::measurement::format::ForceReadOptions;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::StudyError;
use crate::analysis::path::cut::Cut;
use crate::input::problem_log::ProblemLog;
use crate::input::tables::LoadFrameName;
use crate::measured::force_record::{SensorRecord, Unread, read};
use crate::measured::treatment::{Air, ProcessedRecord, Refusal, Treatment, treat};

/// A record of measured forces.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredTable {
    /// Its file, relative to the study: a text export of DynoWare, or a CSV.
    pub file: String,
    /// What the forces of the file act on: the tool, or the part as measured by a dynamometer under it.
    pub acts_on: ActsOnName,
    /// Axes of the sensor: `base`, `part`, or `feed`.
    pub frame: LoadFrameName,
    /// Rotation of the sensor about z of that frame; 0 if left out.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub sensor_turned_deg: Option<f64>,
    /// Air-cut intervals, from when to when; the quietest ones if left out.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub air_s: Option<Vec<[f64; 2]>>,
    /// Whether drift is removed; true if left out.
    pub drift: Option<bool>,
    /// Cut-off of the low-pass filter; no filter if left out.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub low_pass_hz: Option<f64>,
    /// Spindle speed: forces are then averaged over whole revolutions.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub spindle_rpm: Option<f64>,
    /// Whether the force of largest size within each revolution is a second load case in addition to its mean.
    #[serde(default)]
    pub peak: bool,
    /// Time in the record at which the first cut of the program starts.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub start_s: Option<f64>,
    /// How that time is determined, in place of `start_s`.
    pub synchronise: Option<SynchroniseName>,
    /// For `synchronise = "threshold"`: the first cut starts where this force is first exceeded.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub threshold_n: Option<f64>,
    /// Speed of rapids between cuts.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub rapid_mm_per_min: Option<f64>,
    /// Feed, if the program does not specify it.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub feed_mm_per_min: Option<f64>,
    /// Standard uncertainty of the size of the force; 0 if left out.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub u_percent: Option<f64>,
    /// Cycle of an export with several cycles, from 1.
    #[schemars(range(min = 1, max = 10000))]
    pub cycle: Option<u32>,
    /// Names of three forces, and three moments if there are any, as an export has them; `Fx`, `Fy`, `Fz` if left out.
    pub channels: Option<Vec<String>>,
    /// Samples a second, of a CSV without column of time.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub rate_hz: Option<f64>,
    /// Columns in order, of a CSV without header.
    pub columns: Option<Vec<String>>,
}

/// The body on which a measured force acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActsOnName {
    /// The tool.
    Tool,
    /// The part: the tool feels it with all signs reversed.
    Part,
}

/// How the start of the program is determined in the record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SynchroniseName {
    /// The force exceeds `threshold_n` for the first time.
    Threshold,
    /// The record has the highest correlation with the force that `[cut]` predicts.
    Predicted,
}

/// Measured forces along a program.
#[derive(Clone, Debug)]
pub struct MeasuredForces {
    /// Its table in the study.
    pub table: MeasuredTable,
    /// Format of the file.
    pub format: &'static str,
    /// Intervals of the drift.
    pub air: Air,
    /// The record as the force on the tool, in the axes of the frame, before and after treatment.
    pub treated: ProcessedRecord,
    /// When the first cut of the program starts in the record and when its last one ends, s.
    pub program: [f64; 2],
    /// Confidence of the alignment, if it was determined with a prediction.
    pub lag: Option<Lag>,
    /// Largest force of the first case, and of the second, N.
    pub largest: [f64; 2],
}

/// A lag whose correlation exceeds the second best by less than this may be the wrong one.
const LOW_CONFIDENCE: f64 = 0.1;
/// A prediction is correlated with the record with so much of its time on either side without force, so that start and
/// end are included.
const MARGIN: f64 = 0.25;
/// 1 mm/min in m/s.
const M_S_PER_MM_MIN: f64 = 1e-3 / 60.0;

impl MeasuredForces {
    /// A warning for the user.
    pub fn warning(&self) -> Option<String> {
        let unsure = self.lag.filter(|lag| lag.confidence() < LOW_CONFIDENCE)?;
        Some(format!(
            "the start of the program in the record {} is uncertain: at {:.4} s the correlation with the prediction is {:.2}, elsewhere {:.2}; set `start_s` if it is known",
            self.table.file,
            self.program[0],
            unsure.likeness,
            unsure.runner_up.unwrap_or(0.0)
        ))
    }

    /// Samples between start and end of the program.
    pub fn samples(&self) -> usize {
        let [from, to] = self.program;
        let time = self.treated.after.time();
        time.partition_point(|t| *t <= to) - time.partition_point(|t| *t < from)
    }
}

/// The forces along a course as a load, and their source; `None` if they have problems, reported at their
/// keys.
///
/// # Errors
/// The problems of the file.
pub fn along(
    log: &mut ProblemLog<'_>,
    table: &MeasuredTable,
    folder: &Path,
    track: &Track,
    cut: Option<&Cut>,
) -> Result<Option<(PathLoad, MeasuredForces)>, StudyError> {
    let path = folder.join(&table.file);
    let shown = path.display().to_string();
    let acts_on = match table.acts_on {
        ActsOnName::Tool => ActsOn::Tool,
        ActsOnName::Part => ActsOn::Part,
    };
    let requested = ForceReadOptions {
        rate_hz: table.rate_hz,
        columns: table.columns.clone(),
        channels: table.channels.clone(),
    };
    let cycle = table.cycle.map(|cycle| cycle as usize);
    let found = match read(&shown, &path, acts_on, &requested, cycle) {
        Ok(measured) => forces(table, measured, track, cut),
        Err(Unread::File(problems)) => return Err(problems),
        Err(Unread::Value(refusal)) => Err(refusal),
    };
    Ok(found
        .map_err(|Refusal { key, message, hint }| {
            log.problem(&format!("program.measured.{key}"), message, &hint);
        })
        .ok())
}

/// Transforms the record to the tool and its frame, treats it, determines the start of the program, and evaluates the
/// forces at its points.
fn forces(
    table: &MeasuredTable,
    measured: SensorRecord,
    track: &Track,
    cut: Option<&Cut>,
) -> Result<(PathLoad, MeasuredForces), Refusal> {
    let treatment = Treatment {
        air: air(table)?,
        low_pass_hz: table.low_pass_hz,
        spindle_rpm: table.spindle_rpm,
    };
    let turn = from_deg(table.sensor_turned_deg.unwrap_or(0.0));
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
    let treated = treat(measured.record.on_tool().turned(&turn), &treatment)?;
    let clock = clock(table, track)?;
    let record = &treated.after;
    let [lasts, cuts] = [record.end() - record.begin(), clock.duration()];
    if cuts > lasts {
        let message = format!("the record lasts {lasts:.3} s, but the cuts of the program take {cuts:.3} s");
        let hint = "check that it is the record of this program, with the feeds and rapids as run";
        return Err(Refusal::new("file", message, hint));
    }
    let (start, lag) = start(table, &treated.after, &clock, track, cut)?;
    let program = [start, start + cuts];
    // A step of the record to either side is rounding.
    let step = lasts / (record.time().len() - 1) as f64;
    if program[0] < record.begin() - step || program[1] > record.end() + step {
        let message = format!(
            "the program runs from {:.3} to {:.3} s of a record from {:.3} to {:.3} s",
            program[0],
            program[1],
            record.begin(),
            record.end()
        );
        let key = if table.start_s.is_some() {
            "start_s"
        } else {
            "synchronise"
        };
        return Err(Refusal::new(
            key,
            message,
            "the record must contain the whole program",
        ));
    }
    let (load, largest) = at_points(table, &treated, &clock, start)?;
    let forces = MeasuredForces {
        table: table.clone(),
        format: measured.format,
        air: treatment.air,
        treated,
        program,
        lag,
        largest,
    };
    Ok((load, forces))
}

/// Intervals for drift removal: given, to be determined, or none.
fn air(table: &MeasuredTable) -> Result<Air, Refusal> {
    match (&table.air_s, table.drift) {
        (Some(_), Some(false)) => Err(Refusal::new(
            "air_s",
            "air cuts are given, but `drift = false` disables drift removal",
            "remove one",
        )),
        (None, Some(false)) => Ok(Air::NotRemoved),
        (Some(stretches), _) => Ok(Air::Given(stretches.clone())),
        (None, _) => Ok(Air::Detected),
    }
}

/// When the tip is at each point, from the start of the first cut.
fn clock(table: &MeasuredTable, track: &Track) -> Result<Clock, Refusal> {
    let speed = |given: Option<f64>| given.filter(|v| *v > 0.0).map(|v| v * M_S_PER_MM_MIN);
    let speeds = Speeds {
        feed: speed(table.feed_mm_per_min),
        rapid: speed(table.rapid_mm_per_min),
    };
    Clock::of(&track.path, speeds).map_err(|error| match error {
        NoTime::NoFeed { .. } => Refusal::new("feed_mm_per_min", error.to_string(), "feed_mm_per_min = 600"),
        NoTime::NoRapid { .. } => Refusal::new(
            "rapid_mm_per_min",
            error.to_string(),
            "rapid_mm_per_min = 6000: the speed of the robot between the cuts",
        ),
    })
}

/// When the first cut starts in the record, s.
///
/// With it the lag, if a prediction determined it; exactly one of `start_s` and `synchronise` must be given.
fn start(
    table: &MeasuredTable,
    record: &Record,
    clock: &Clock,
    track: &Track,
    cut: Option<&Cut>,
) -> Result<(f64, Option<Lag>), Refusal> {
    let refused = |error: RecordError, hint: &str| Refusal::new("synchronise", error.to_string(), hint);
    match (table.start_s, table.synchronise) {
        (Some(_), Some(_)) => Err(Refusal::new(
            "synchronise",
            "the start of the program is given twice",
            "either `start_s` or `synchronise`",
        )),
        (Some(start), None) => Ok((start, None)),
        (None, None) => Err(Refusal::new(
            "start_s",
            "the start of the program in the record is not given",
            "start_s = 1.2, or synchronise = \"threshold\" or \"predicted\"",
        )),
        (None, Some(SynchroniseName::Threshold)) => {
            let threshold = table.threshold_n.ok_or_else(|| {
                let message = "the start is to be determined with a threshold, but there is none";
                Refusal::new(
                    "threshold_n",
                    message,
                    "threshold_n = 10: above the noise, below the cut",
                )
            })?;
            let start = lag::start(record, threshold);
            let start = start.map_err(|error| refused(error, "use another threshold_n, or start_s"))?;
            Ok((start, None))
        }
        (None, Some(SynchroniseName::Predicted)) => {
            let cut = cut.ok_or_else(|| {
                Refusal::new(
                    "synchronise",
                    "synchronise = \"predicted\" requires a `cut` that predicts the force",
                    "[cut] with material, cutter and depths",
                )
            })?;
            let hint = "synchronise = \"threshold\", or start_s";
            let force = predicted(table, track, cut)?;
            let step = record.step().map_err(|error| refused(error, hint))?;
            let prediction = clock.record(|i| force[i], step, MARGIN * clock.duration());
            let prediction = prediction.map_err(|error| refused(error, hint))?;
            let range = [record.begin(), record.end() - clock.duration()];
            let lag = align(record, &prediction, range).map_err(|error| refused(error, hint))?;
            // The top of a parabola may be between samples beyond the last one.
            let start = lag.seconds.clamp(range[0], range[1].max(range[0]));
            Ok((start, Some(lag)))
        }
    }
}

/// The mean force of the cut at every point, in the axes of the record.
fn predicted(table: &MeasuredTable, track: &Track, cut: &Cut) -> Result<Vec<Vector3<f64>>, Refusal> {
    let mut stock = cut.stock.clone();
    let along = cut
        .cutting
        .along(&track.path, &track.placing, stock.as_mut(), Watch::NONE);
    let load = along.map_err(|error| {
        let hint = "give feed and spindle speed in the program, or cut.feed_mm_per_min and cut.spindle_rpm";
        Refusal::new("synchronise", error.to_string(), hint)
    })?;
    let load = PathLoad::Cuts(load.cuts);
    let part_from_base = track.base_from_part.rotation.inverse();
    let mut wrenches = vec![Wrench::ZERO; load.case_count()];
    let force = |index: usize| {
        track.wrenches(&load, index, &mut wrenches);
        let in_base = wrenches.first().map_or_else(Vector3::zeros, |mean| mean.force);
        match table.frame.frame() {
            LoadFrame::Base => in_base,
            LoadFrame::Part => part_from_base * in_base,
            LoadFrame::Feed => track.base_from_feed(index).inverse() * in_base,
        }
    };
    Ok((0..track.len()).map(force).collect())
}

/// The forces at the points, and the largest of each case, N.
///
/// With a spindle speed their mean over each revolution, interpolated between the middles of two, else the force at
/// that instant; with `peak` the largest of the revolution as a second case.
fn at_points(
    table: &MeasuredTable,
    treated: &ProcessedRecord,
    clock: &Clock,
    start: f64,
) -> Result<(PathLoad, [f64; 2]), Refusal> {
    let turns = treated.turns.as_deref();
    let cases = if table.peak { 2 } else { 1 };
    if table.peak && turns.is_none() {
        let message =
            "a peak is evaluated for each revolution of the spindle, and the spindle speed is not given";
        return Err(Refusal::new("peak", message, "spindle_rpm = 9000"));
    }
    let mut wrenches = Vec::with_capacity(clock.time().len() * cases);
    let mut largest = [0.0_f64; 2];
    for time in clock.time().iter().map(|time| start + time) {
        let mean = turns.and_then(|turns| mean_at(turns, time));
        let mean = mean.unwrap_or_else(|| treated.after.force_at(time));
        wrenches.push(Wrench::from_force(mean));
        largest[0] = largest[0].max(mean.norm());
        let turn = turns
            .and_then(|turns| turn_at(turns, time))
            .filter(|_| cases == 2);
        if let Some(turn) = turn {
            wrenches.push(Wrench::from_force(turn.strongest));
            largest[1] = largest[1].max(turn.strongest.norm());
        }
    }
    let load = PathLoad::OfEach {
        cases,
        frame: table.frame.frame(),
        wrenches,
    };
    Ok((load, largest))
}
