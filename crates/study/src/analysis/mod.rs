//! The kinds of analysis: one folder each, with the same files.
//!
//! | file | content |
//! |---|---|
//! | `table` | the keys of the study file that only this kind has |
//! | `resolve` | these keys, checked and in SI |
//! | `run` | the evaluation by the core |
//! | `answer`, `sentence`, `warnings` | the result as JSON, in one sentence, and what to know before relying on it |
//! | `columns`, `pictures`, `report` | its columns of the table, its pictures, its chapter of the report |
//!
//! A file is missing where a kind has nothing of its own. [`map`], [`sections`], [`volume`], [`path`], [`holes`]; this
//! file is the list of them. What they share: [`table`] `[[analysis]]`, [`study_tables`] what the study gives to each,
//! [`resolve`] the values of the study and those of the analysis, `sheet` a plane with its grid, [`runner`] the question
//! to the core, [`point`] a point of an answer, [`quantity`] what is known of a point (`quantity_entry`: an entry of that list; `motion_quantity`, `vibration_quantity`: those of a motion and of vibration), [`clearance`] their clearance, [`rows`], [`numbers`] and
//! [`columns`] the points as a table, [`vibration`] modes and stability there, `breakthrough` of a drill, [`picture`], [`panels`] and [`arm`] for pictures, [`cells`] for tables of a
//! report, [`words`] for sentences.

pub mod arm;
mod breakthrough;
pub mod cells;
pub mod clearance;
pub mod columns;
pub mod holes;
pub mod map;
mod motion_quantity;
pub mod numbers;
pub mod panels;
pub mod path;
pub mod picture;
pub mod point;
pub mod quantity;
mod quantity_entry;
pub mod resolve;
pub mod rows;
pub mod runner;
pub mod sections;
mod sheet;
pub mod study_tables;
pub mod table;
pub mod vibration;
mod vibration_quantity;
pub mod volume;
pub mod words;

use armill_core::map::{BoxGrid, PlaneMap, VolumeMap, plane_map, volume_map};
use armill_core::optimize::{HolesFound, hole_postures};
use armill_core::path::LoadedTrack;
use armill_core::robot::Robot;
use armill_formats::robot::RobotDescription;

use self::holes::HolesAnalysis;
use self::numbers::Numbers;
use self::path::PathAnalysis;
use self::path::run::PathResult;
use self::rows::Rows;
use self::runner::Runner;
use self::sections::Section;
pub use self::sheet::Sheet;
use self::vibration::{Cuts, SeriesVibration};
use crate::error::StudyError;
use crate::input::memory::{ExtraBytes, OF_FIELD, OF_MAP, PointMemory};
use crate::input::setting::Setting;

/// One resolved analysis.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Its name.
    pub name: String,
    /// What it is about.
    pub subject: Subject,
}

/// The subject of an analysis.
#[derive(Clone, Debug)]
pub enum Subject {
    /// One plane.
    Map(Sheet),
    /// Several planes, each with its label.
    Sections(Vec<(String, Sheet)>),
    /// A box of points.
    Volume(Setting, BoxGrid),
    /// A path.
    Path(Box<PathAnalysis>),
    /// Holes.
    Holes(Box<HolesAnalysis>),
}

/// The result of one analysis.
#[derive(Clone, Debug)]
pub struct AnalysisResult<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its data.
    pub found: AnalysisData<'a>,
    /// The vibration at the points of each of its series; empty if the study does not ask for it.
    pub vibration: Vec<SeriesVibration>,
}

/// The data of one result, with the analysis they belong to.
#[derive(Clone, Debug)]
pub enum AnalysisData<'a> {
    /// One plane.
    Map(&'a Sheet, PlaneMap),
    /// Several planes, in the order of the study.
    Sections(Vec<Section<'a>>),
    /// A box of points.
    Volume(&'a Setting, VolumeMap),
    /// A path.
    Path(&'a PathAnalysis, Box<PathResult>),
    /// Holes.
    Holes(&'a HolesAnalysis, Box<HolesFound>),
}

impl Subject {
    /// What its points share; of sections that of the one with this number, from 0.
    pub fn setting(&self, section: usize) -> Option<&Setting> {
        match self {
            Subject::Map(sheet) => Some(&sheet.setting),
            Subject::Sections(sections) => sections.get(section).map(|(_, sheet)| &sheet.setting),
            Subject::Volume(setting, _) => Some(setting),
            Subject::Path(path) => Some(&path.setting),
            Subject::Holes(holes) => Some(&holes.path.setting),
        }
    }

    /// Its points, each as often as it is evaluated.
    pub fn points_to_evaluate(&self) -> usize {
        match self {
            Subject::Map(sheet) => sheet.grid.len(),
            Subject::Sections(sections) => sections.iter().map(|(_, sheet)| sheet.grid.len()).sum(),
            Subject::Volume(_, grid) => grid.len(),
            Subject::Path(path) => path.track.len() * path::run::passes(path),
            Subject::Holes(holes) => holes.path.track.len(),
        }
    }

    /// Estimated memory of its answers, bytes.
    pub fn bytes(&self, robot: &RobotDescription) -> f64 {
        let of_grid = |extra: &ExtraBytes, setting: &Setting, points: usize| {
            let memory = PointMemory {
                robot,
                setting,
                cases: setting.cases.len(),
                points: points as f64,
                extra,
            };
            memory.bytes()
        };
        let of_path = |path: &PathAnalysis| {
            let part = path.machined_part.as_ref().map_or(0.0, |part| part.bytes());
            path.memory(robot).bytes() + part
        };
        match self {
            Subject::Map(sheet) => of_grid(&OF_MAP, &sheet.setting, sheet.grid.len()),
            Subject::Sections(all) => all
                .iter()
                .map(|(_, sheet)| of_grid(&OF_FIELD, &sheet.setting, sheet.grid.len()))
                .sum(),
            Subject::Volume(setting, grid) => of_grid(&OF_FIELD, setting, grid.len()),
            Subject::Holes(holes) => of_path(&holes.path),
            Subject::Path(path) => of_path(path),
        }
    }

    /// Its result.
    ///
    /// # Errors
    /// Cancelled by the watch; a path that misses its stock.
    pub fn run<'s>(&'s self, runner: &Runner<'_>) -> Result<AnalysisData<'s>, StudyError> {
        let map = |sheet: &Sheet| -> Result<PlaneMap, StudyError> {
            let question = runner.question(&sheet.setting);
            let mut map = plane_map(&question, sheet.setting.plane, sheet.grid, runner.watch)?;
            map.answers.measure_clearances(&question);
            Ok(map)
        };
        Ok(match self {
            Subject::Map(sheet) => AnalysisData::Map(sheet, map(sheet)?),
            Subject::Sections(sections) => {
                let section = |(label, sheet): &'s (String, Sheet)| {
                    let map = map(sheet)?;
                    Ok(Section { label, sheet, map })
                };
                AnalysisData::Sections(sections.iter().map(section).collect::<Result<_, StudyError>>()?)
            }
            Subject::Volume(setting, grid) => {
                let question = runner.question(setting);
                let mut volume = volume_map(&question, setting.plane, *grid, runner.watch)?;
                volume.answers.measure_clearances(&question);
                AnalysisData::Volume(setting, volume)
            }
            Subject::Path(path) => AnalysisData::Path(path, Box::new(runner.path(path)?)),
            Subject::Holes(holes) => {
                let (path, question) = (&holes.path, runner.question(&holes.path.setting));
                let loaded = LoadedTrack {
                    track: &path.track,
                    load: &path.load,
                };
                let mut found = hole_postures(
                    &question,
                    loaded,
                    &holes.search,
                    &holes.path.setting.least_gain,
                    runner.watch,
                )?;
                found.answers.measure_clearances(&question);
                AnalysisData::Holes(holes, Box::new(found))
            }
        })
    }
}

impl AnalysisResult<'_> {
    /// Every series of its points, with their vibration.
    pub fn rows(&self) -> Vec<Rows<'_>> {
        let numbered = self.found.rows().into_iter().enumerate();
        numbered
            .map(|(series, rows)| rows.with_vibration(self.vibration.get(series)))
            .collect()
    }

    /// The data of a path, without its analysis, and its vibration.
    pub fn into_path(self) -> Option<(Box<PathResult>, Vec<SeriesVibration>)> {
        match self.found {
            AnalysisData::Path(_, found) => Some((found, self.vibration)),
            AnalysisData::Map(..)
            | AnalysisData::Sections(_)
            | AnalysisData::Volume(..)
            | AnalysisData::Holes(..) => None,
        }
    }
}

impl AnalysisData<'_> {
    /// Every series of its points.
    pub fn rows(&self) -> Vec<Rows<'_>> {
        match self {
            AnalysisData::Map(sheet, found) => vec![Rows::of_map("", &sheet.setting, found)],
            AnalysisData::Sections(sections) => sections
                .iter()
                .map(|section| Rows::of_map(section.label, &section.sheet.setting, &section.map))
                .collect(),
            AnalysisData::Volume(setting, volume) => vec![Rows::of_volume(setting, volume)],
            AnalysisData::Path(analysis, found) => {
                let answers = &found.along.answers;
                vec![Rows::of_path(&analysis.setting, &analysis.track, answers)]
            }
            AnalysisData::Holes(analysis, found) => {
                let path = &analysis.path;
                vec![Rows::of_holes(&path.setting, &path.track, found)]
            }
        }
    }

    /// The vibration at the points of each of its series; empty if the study does not ask for it.
    pub fn vibration(&self, robot: &Robot) -> Vec<SeriesVibration> {
        let of = |rows: &Rows<'_>| {
            let cuts = match self {
                AnalysisData::Path(analysis, found) => {
                    path::vibration::cuts(analysis, &analysis.track, &found.along.load)
                }
                _ => on_plane(rows.setting),
            };
            SeriesVibration::of(robot, rows.setting, rows.answers, cuts.as_ref())
        };
        self.rows().iter().filter_map(of).collect()
    }

    /// The columns that only its kind has.
    pub fn own_columns<'a>(&'a self, robot: &'a Robot) -> Vec<Numbers<'a>> {
        match self {
            AnalysisData::Path(analysis, found) => path::columns::columns(analysis, found),
            AnalysisData::Holes(analysis, found) => holes::columns::columns(robot, analysis, found),
            AnalysisData::Map(..) | AnalysisData::Sections(_) | AnalysisData::Volume(..) => Vec::new(),
        }
    }
}

/// The cut of the study at every point of a map or volume, if it has one.
fn on_plane(setting: &Setting) -> Option<Cuts<'static>> {
    let cut = setting.vibration.as_ref()?.on_plane?;
    Some(Cuts {
        at: Box::new(move |_| Some(cut)),
        are_followed: false,
    })
}
