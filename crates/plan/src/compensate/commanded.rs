//! A commanded path or set of holes: its numbers and its table.

use armill_core::frame::tool_orientation;
use armill_core::kernel::Answers;
use armill_core::nalgebra::UnitQuaternion;
use armill_core::path::{Pace, Track};
use armill_core::units::{to_deg, to_mm};
use armill_formats::table::{Column, ColumnData, Table};
use armill_programs::Written;
use armill_study::analysis::clearance::{LeastClearance, in_collision};
use armill_study::analysis::holes::HolesAnalysis;
use armill_study::analysis::path::to_measure::column;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::input::setting::Setting;
use armill_study::program_out::{HolesToWrite, PathToWrite, ProgramSettings, hole_program, program};
use serde::Serialize;

use super::error_answer::ErrorAnswer;
use super::in_place::RewrittenProgramAnswer;
use super::surface::CompensatedSurface;

/// One path, before and after.
#[derive(Clone, Debug, Serialize)]
pub struct CompensatedPath {
    /// Its name.
    pub name: String,
    /// How many points.
    pub points: usize,
    /// Deviation of the tool from the nominal path without compensation.
    pub before: ErrorAnswer,
    /// And with it, as predicted.
    pub after: ErrorAnswer,
    /// Largest move of a point.
    pub largest_correction_um: f64,
    /// Rounds of the fixed point.
    pub rounds: usize,
    /// Largest move of a point in the last round.
    pub last_round_um: f64,
    /// What that was of the one before; none after one round.
    pub contraction_ratio: Option<f64>,
    /// Points without posture, which are not changed.
    pub unreachable: usize,
    /// Of these the points where no posture keeps the demanded clearance, if there are any.
    pub collisions: Option<CollisionsAnswer>,
    /// Points outside joint limits after the correction.
    pub outside_joint_limits: usize,
    /// File of the commanded path.
    pub file: String,
    /// The program that the path is from, with changed targets; none for another path, or if `notes` give a reason.
    pub in_place: Option<RewrittenProgramAnswer>,
    /// The surface of the part that comes out, before and after; none if the study does not ask for it.
    pub surface: Option<CompensatedSurface>,
    /// What a user must know, each a sentence.
    pub notes: Vec<String>,
}

/// Points where no posture keeps the demanded clearance.
#[derive(Clone, Debug, Serialize)]
pub struct CollisionsAnswer {
    /// How many.
    pub points: usize,
    /// The least distance of two bodies there; 0 where they touch.
    pub least_clearance_mm: f64,
    /// The two bodies.
    pub nearest: [String; 2],
    /// Both in words.
    #[serde(skip)]
    pub in_words: String,
}

impl CollisionsAnswer {
    /// Those of the answers at the points of a path with these settings; `None` without any.
    pub(super) fn of(setting: &Setting, answers: &Answers) -> Option<CollisionsAnswer> {
        let points = in_collision(answers);
        let least = LeastClearance::of(setting, answers).filter(|_| points > 0)?;
        Some(CollisionsAnswer {
            points,
            in_words: least.in_words(),
            least_clearance_mm: least.distance_mm,
            nearest: least.bodies,
        })
    }
}

/// Result for one path.
#[derive(Clone, Debug)]
pub struct Commanded<'a> {
    /// Its analysis.
    pub setting: &'a Setting,
    /// The path to command, and its postures.
    pub path: (Track, Answers),
    /// Top of the nominal path, m ([`Track::top`]).
    pub top: f64,
    /// Speed of the spindle if the path does not specify it, rad/s.
    pub spindle: Option<f64>,
    /// In numbers.
    pub given: CompensatedPath,
    /// The table, as CSV.
    pub csv: Vec<u8>,
    /// The table to be completed with measured positions, as CSV; none for holes.
    pub to_measure: Option<Vec<u8>>,
    /// Before and after along the path, as SVG; none for holes.
    pub picture: Option<String>,
    /// The holes, if it is not a path.
    pub holes: Option<&'a HolesAnalysis>,
    /// Indices of holes that cannot be drilled, because every posture is rejected.
    pub refused: Vec<usize>,
    /// Files of the program that the path came from, with its targets moved.
    pub program: Vec<(String, Vec<u8>)>,
}

impl Commanded<'_> {
    /// Its files: the table, the picture, and the program that the path came from, each by its name.
    pub fn files(&self) -> Vec<(String, &[u8])> {
        let mut files = vec![(self.given.file.clone(), &self.csv[..])];
        if let Some(table) = &self.to_measure {
            let name = self.given.file.replace(".commanded.csv", ".to-measure.csv");
            files.push((name, table));
        }
        if let Some(svg) = self.picture.as_ref().filter(|_| self.given.rounds > 0) {
            let picture = self.given.file.replace(".commanded.csv", "-compensated.svg");
            files.push((picture, svg.as_bytes()));
        }
        files.extend(
            self.program
                .iter()
                .map(|(name, bytes)| (name.clone(), &bytes[..])),
        );
        files
    }

    /// The robot program along it; `study`: the one that it was computed of.
    ///
    /// # Errors
    /// As of [`program`] and [`hole_program`].
    pub fn robot_program(&self, study: &Study, requested: &ProgramSettings) -> Result<Written, StudyError> {
        let (track, answers) = (&self.path.0, &self.path.1);
        match self.holes {
            Some(holes) => {
                let refused = &self.refused;
                let holes = HolesToWrite {
                    holes,
                    track,
                    answers,
                    refused,
                };
                hole_program(study, holes, requested)
            }
            None => {
                let path = PathToWrite {
                    setting: self.setting,
                    track,
                    answers,
                    top: self.top,
                    spindle: self.spindle,
                };
                program(study, path, requested)
            }
        }
    }

    /// The robot program along the only one of these.
    ///
    /// # Errors
    /// Several, or none; as of [`Commanded::robot_program`].
    pub fn only_program(
        all: &[Commanded<'_>],
        study: &Study,
        requested: &ProgramSettings,
    ) -> Result<Written, StudyError> {
        match all {
            [one] => one.robot_program(study, requested),
            _ => Err(StudyError::value(
                format!(
                    "the study has {} paths and sets of holes, a program contains one",
                    all.len()
                ),
                "select one: --analysis NAME",
            )),
        }
    }
}

/// Corrections above this are questioned, um.
const LARGE_UM: f64 = 1000.0;

/// A caution if the corrections are larger than an arm deflects in machining.
pub(super) fn caution(name: &str, largest_correction_um: f64) -> Option<String> {
    (largest_correction_um > LARGE_UM).then(|| {
        format!(
            "points of {name} move by up to {:.1} mm, more than arms deflect in machining: check load, tool and \
             compliances before the program is used",
            largest_correction_um / 1000.0
        )
    })
}

/// Positions of the tip and directions of the tool.
pub(super) fn position_columns(track: &Track) -> Vec<Column> {
    let points = &track.path.points;
    let mut columns = Vec::new();
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let values = points.iter().map(|point| to_mm(point.at[axis])).collect();
        columns.push(column(
            &format!("{letter}_mm"),
            Some("mm"),
            (6, ColumnData::Float(values)),
        ));
    }
    for (axis, letter) in ["i", "j", "k"].into_iter().enumerate() {
        let values = points
            .iter()
            .map(|point| track.placing.path_spindle(point)[axis])
            .collect();
        columns.push(column(letter, None, (9, ColumnData::Float(values))));
    }
    columns
}

/// The path as a table of points.
pub(super) fn table(name: &str, track: &Track) -> Result<Table, StudyError> {
    let points = &track.path.points;
    let mut columns = position_columns(track);
    let spins = (0..points.len())
        .map(|index| to_deg(spin(track, index)))
        .collect();
    columns.push(column("spin_deg", Some("deg"), (6, ColumnData::Float(spins))));
    let feed = |pace: Pace| match pace {
        Pace::Feed(speed) => Some(speed * 60e3),
        Pace::Rapid | Pace::Unknown => None,
    };
    let feeds = points.iter().map(|point| feed(point.pace)).collect();
    columns.push(column(
        "feed_mm_per_min",
        Some("mm/min"),
        (3, ColumnData::OptionalFloat(feeds)),
    ));
    let rapid = |index: usize| i64::from(track.path.begins(index));
    let rapids = (0..points.len()).map(rapid).collect();
    columns.push(column("rapid", None, (0, ColumnData::Integer(rapids))));
    Ok(Table::new(name, columns)?)
}

/// Spin of the tool about its axis at a point, relative to [`tool_orientation`], rad.
fn spin(track: &Track, index: usize) -> f64 {
    let stop = track.stop(index);
    let unspun = tool_orientation(-stop.normal, 0.0);
    let turn: UnitQuaternion<f64> = unspun.inverse() * stop.base_from_tool.rotation;
    2.0 * turn.k.atan2(turn.w)
}
