//! `measured`: measurements of one circle of the study, of the machined part and of the path without load.
//!
//! ```text
//! a = zero_deg + f      or, if the files view the circle from the other side, a = zero_deg - f
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f` | angle of a sample in its file | rad |
//! | `a` | angle on the circle of the study: from its +y' towards z', the way in which it is cut | rad |
//!
//! Forces that were measured are no part of this table: they are the load of the path.

use std::path::Path;

use armill_core::budget::Removed;
use armill_core::measure::ballbar::centre::seen_from;
use armill_core::measure::ballbar::{CircularTest, Direction, Run, RunError, least_squares_centre};
use armill_core::path::Shape;
use armill_core::roundness::{Plane, Profile};
use armill_core::units::{from_deg, from_mm, from_um, to_mm};
use armill_formats::measurement::ballbar::BallbarReadOptions;
use armill_formats::measurement::profile::{Points, ProfileReadOptions};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::analysis::{Analysis, Subject};
use crate::error::StudyError;
use crate::file::ResolvedAnalyses;
use crate::input::problem_log::ProblemLog;
use crate::measured::circular_test::{self, FileOptions, MeasuredTest};
use crate::measured::profile;

/// Measurements of one circle: the machined part, the path without load.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExperimentTable {
    /// Name of the path that was cut, a circle; required if the study has several.
    pub analysis: Option<String>,
    /// Profile of the part, relative to the study.
    pub part: Option<String>,
    /// Circular tests of the path without load.
    #[schemars(length(max = 100))]
    #[serde(default)]
    pub ballbar: Vec<String>,
    /// From which centre deviations count: `least-squares` (so if left out) of each, or `as-measured`.
    pub centre: Option<DatumName>,
    /// From which radius: `least-squares` (so if left out) of each, or `as-measured`, from the nominal one.
    pub radius: Option<DatumName>,
    /// Nominal radius of the measurement, if a file does not specify it; that of the circle if left out.
    #[schemars(range(min = 0.001, max = 1e4))]
    pub radius_mm: Option<f64>,
    /// Position of angle 0 of the files on the circle, from +y' towards z'; 0 if left out.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub zero_deg: Option<f64>,
    /// Whether angles of the files grow from z' towards y'.
    #[serde(default)]
    pub mirrored: bool,
    /// The same of the ball-bar alone.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub ballbar_zero_deg: Option<f64>,
    /// The same of the ball-bar alone.
    pub ballbar_mirrored: Option<bool>,
    /// Standard uncertainty of a point of the part; 0 if left out.
    #[schemars(range(min = 0.0, max = 1e4))]
    pub part_u_um: Option<f64>,
}

impl ExperimentTable {
    /// Components that are removed from every curve.
    fn removed(&self) -> Removed {
        let least_squares = |name: Option<DatumName>| name != Some(DatumName::AsMeasured);
        Removed {
            centre: least_squares(self.centre),
            radius: least_squares(self.radius),
        }
    }
}

/// Reference of deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DatumName {
    /// As in the file.
    AsMeasured,
    /// That of the least-squares circle.
    LeastSquares,
}

/// The measurements, in the angles of the circle.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Its table in the study.
    pub table: ExperimentTable,
    /// Name of the path.
    pub analysis: String,
    /// Nominal radius of the circle, m.
    pub radius: f64,
    /// Components that are removed from every curve.
    pub removed: Removed,
    /// The part; none if it was not measured.
    pub part: Option<Part>,
    /// The path without load; none if it was not measured.
    pub test: Option<CircularTest>,
    /// Notes for the user on the files, each a sentence.
    pub notes: Vec<String>,
}

/// The profile of the part.
#[derive(Clone, Debug)]
pub struct Part {
    /// Radial deviation over the angle.
    pub run: Run,
    /// How many points the file has.
    pub points: usize,
    /// Where its centre was found, in the axes of the file, m; none if deviations count from the origin.
    pub centre: Option<[f64; 2]>,
    /// Standard uncertainty of a point, m.
    pub u: f64,
}

/// A point farther off than this part of the radius does not belong to the circle.
const FARTHEST: f64 = 0.1;

impl Experiment {
    /// Reads the files of the table; `None` if there are problems, reported at their keys.
    pub(super) fn read(
        log: &mut ProblemLog<'_>,
        table: &ExperimentTable,
        folder: &Path,
        analyses: ResolvedAnalyses<'_>,
    ) -> Option<Experiment> {
        let circle = circle(log, "measured", table.analysis.as_ref(), analyses);
        if table.part.is_none() && table.ballbar.is_empty() {
            let hint = "part = \"cmm.csv\", or ballbar = [\"first.csv\", \"second.csv\"]";
            log.problem("measured", "no measurement is named", hint);
        }
        // Files are read even if the circle is not known: their problems belong to the same list.
        let radius_mm = table
            .radius_mm
            .or(circle.as_ref().map(|(_, radius)| to_mm(radius)));
        let part = table
            .part
            .as_ref()
            .map(|file| part(log, table, file, folder, radius_mm));
        let test = (!table.ballbar.is_empty()).then(|| test(log, table, folder));
        let (analysis, radius) = circle?;
        // A file that was named and could not be read is a problem already.
        let part = part.map_or(Some(None), |part| part.map(Some))?;
        let (test, mut notes) = match test {
            Some(read) => read.map(|(test, notes)| (Some(test), notes))?,
            None => (None, Vec::new()),
        };
        let other = test
            .as_ref()
            .map(CircularTest::radius)
            .filter(|r| (r / radius - 1.0).abs() > 0.01);
        notes.extend(other.map(|other| {
            format!(
                "the circle of the ball-bar has {} mm, that of the cut {} mm: the path error without load is \
                 assumed to be the same",
                crate::number::decimals(to_mm(other), 3),
                crate::number::decimals(to_mm(radius), 3)
            )
        }));
        Some(Experiment {
            table: table.clone(),
            analysis,
            radius,
            removed: table.removed(),
            part,
            test,
            notes,
        })
    }
}

/// The circle of the table `key`, with its radius (m); `None` if there is none, reported at its key.
pub(super) fn circle(
    log: &mut ProblemLog<'_>,
    key: &str,
    analysis: Option<&String>,
    analyses: ResolvedAnalyses<'_>,
) -> Option<(String, f64)> {
    let radius = |analysis: &Analysis| match &analysis.subject {
        Subject::Path(path) => match path.shape() {
            Some(Shape::Circle { radius, .. }) => Some(*radius),
            _ => None,
        },
        _ => None,
    };
    let circles: Vec<(String, f64)> = analyses
        .list
        .iter()
        .filter_map(|analysis| Some((analysis.name.clone(), radius(analysis)?)))
        .collect();
    let hint = "the name of an analysis of kind = \"path\" with circle = { radius_mm = 100 }";
    match (analysis, &circles[..]) {
        (Some(name), _) => {
            let found = circles.iter().find(|(own, _)| own == name);
            // The problems of an analysis are reported there.
            if found.is_none() && analyses.complete {
                let message = match analyses.list.iter().any(|analysis| analysis.name == *name) {
                    true => format!("`{name}` is not a circle"),
                    false => format!("the study has no analysis called `{name}`"),
                };
                log.problem(&format!("{key}.analysis"), message, hint);
            }
            found.cloned()
        }
        (None, [one]) => Some(one.clone()),
        (None, _) if !analyses.complete => None,
        (None, []) => {
            log.problem(key, "the study has no circle", hint);
            None
        }
        (None, several) => {
            let names: Vec<&str> = several.iter().map(|(name, _)| name.as_str()).collect();
            let message = format!("the study has {} circles: {}", several.len(), names.join(", "));
            log.problem(key, message, "name the one that was measured: analysis = \"...\"");
            None
        }
    }
}

/// Angles of a file as those of the circle.
#[derive(Clone, Copy, Debug)]
pub(super) struct AngleMapping {
    zero: f64,
    sign: f64,
}

impl AngleMapping {
    pub(super) fn new(zero_deg: Option<f64>, mirrored: bool) -> AngleMapping {
        AngleMapping {
            zero: from_deg(zero_deg.unwrap_or(0.0)),
            sign: if mirrored { -1.0 } else { 1.0 },
        }
    }

    fn angle(self, of_file: f64) -> f64 {
        self.zero + self.sign * of_file
    }

    fn direction(self, of_file: Direction) -> Direction {
        match self.sign < 0.0 {
            true => Direction::BOTH[1 - of_file.index()],
            false => of_file,
        }
    }
}

/// The profile of the part; `None` if it cannot be used, reported at its key.
fn part(
    log: &mut ProblemLog<'_>,
    table: &ExperimentTable,
    file: &str,
    folder: &Path,
    radius_mm: Option<f64>,
) -> Option<Part> {
    let key = "measured.part";
    let path = folder.join(file);
    let shown = path.display().to_string();
    let requested = ProfileReadOptions {
        radius_mm: table.radius_mm,
        else_radius_mm: radius_mm,
        unit: None,
    };
    let given = profile::read(&shown, &path, &requested);
    let measured = taken(log, key, given)?;
    let count = measured.points.count();
    let removes_centre = table.removed().centre;
    let points = match measured.points {
        Points::Plane(points) => points,
        Points::Space(_) if !removes_centre => {
            let message = format!("{file} has points in space, which have no centre to measure from");
            log.problem(key, message, "centre = \"least-squares\"");
            return None;
        }
        Points::Space(points) => {
            let Some(plane) = Plane::nearest(&points) else {
                log.problem(
                    key,
                    format!("the points of {file} are not in one plane"),
                    "give points of a circle",
                );
                return None;
            };
            points.iter().map(|point| plane.seen(point)).collect()
        }
    };
    let (centre, points) = match removes_centre {
        false => (None, points),
        true => match Profile::new(points) {
            Ok(profile) => {
                let centre = profile.least_squares().centre.coords;
                let own = profile.points().iter().map(|point| point - centre);
                (Some(centre.into()), own.collect())
            }
            Err(error) => {
                log.problem(key, format!("{file}: {error}"), "give points of one circle");
                return None;
            }
        },
    };
    // An unknown circle is a problem already, and the part cannot be checked further.
    let radius_mm = radius_mm?;
    let nominal = from_mm(radius_mm);
    let turned = AngleMapping::new(table.zero_deg, table.mirrored);
    let angle = points.iter().map(|p| turned.angle(p.y.atan2(p.x))).collect();
    let deviation: Vec<f64> = points.iter().map(|p| p.coords.norm() - nominal).collect();
    if let Some(most) = deviation.iter().copied().find(|by| by.abs() > FARTHEST * nominal) {
        let message = format!(
            "{file}: a point is {:.3} mm off a circle of {radius_mm} mm",
            to_mm(most)
        );
        let hint = "give the measured radius, such as radius_mm = 100; centre = \"least-squares\"";
        log.problem(key, message, hint);
        return None;
    }
    match Run::new(Direction::Anticlockwise, angle, deviation) {
        Ok(run) => Some(Part {
            run,
            points: count,
            centre,
            u: from_um(table.part_u_um.unwrap_or(0.0)),
        }),
        Err(error) => {
            log.problem(
                key,
                format!("{file}: {error}"),
                "give a point every 15 degrees or denser",
            );
            None
        }
    }
}

/// The path without load, and notes on its files; `None` if it cannot be used, reported at its key.
fn test(
    log: &mut ProblemLog<'_>,
    table: &ExperimentTable,
    folder: &Path,
) -> Option<(CircularTest, Vec<String>)> {
    let turned = AngleMapping::new(
        table.ballbar_zero_deg.or(table.zero_deg),
        table.ballbar_mirrored.unwrap_or(table.mirrored),
    );
    let key = "measured.ballbar";
    let measured = bar(log, key, &table.ballbar, folder, table.radius_mm)?;
    let test = turned_test(log, key, &measured, turned, table.removed().centre)?;
    Some((test, measured.notes))
}

/// The measurements of one circle in the files named at `key`; `None` if they cannot be read, reported at its key.
pub(super) fn bar(
    log: &mut ProblemLog<'_>,
    key: &str,
    files: &[String],
    folder: &Path,
    radius_mm: Option<f64>,
) -> Option<MeasuredTest> {
    let mut all_there = true;
    for (index, file) in files.iter().enumerate() {
        if !folder.join(file).is_file() {
            let hint = "a CSV with `angle_deg,radius_dev_um,direction,run`, or results of a ball-bar (.b5r)";
            log.problem(&format!("{key}[{index}]"), format!("file {file} not found"), hint);
            all_there = false;
        }
    }
    let files: Vec<_> = files.iter().map(|file| folder.join(file)).collect();
    if !all_there {
        return None;
    }
    let requested = FileOptions {
        given: BallbarReadOptions {
            radius: radius_mm.map(from_mm),
            ..BallbarReadOptions::default()
        },
        ..FileOptions::default()
    };
    taken(log, key, circular_test::read(&files, &requested))
}

/// These runs in the angles of the circle, seen from their own centre where that is taken off; `None` if that cannot
/// be, reported at its key.
pub(super) fn turned_test(
    log: &mut ProblemLog<'_>,
    key: &str,
    measured: &MeasuredTest,
    turned: AngleMapping,
    takes_centre: bool,
) -> Option<CircularTest> {
    let of_test = || -> Result<CircularTest, RunError> {
        let offset = least_squares_centre(&measured.test).filter(|_| takes_centre);
        let centred = match offset {
            Some(centre) => seen_from(&measured.test, centre.offset)?,
            None => measured.test.clone(),
        };
        let run = |run: &Run| {
            let angle = run.angle().iter().map(|f| turned.angle(*f)).collect();
            Run::new(turned.direction(run.direction()), angle, run.deviation().to_vec())
        };
        CircularTest::new(
            centred.radius(),
            centred.runs().iter().map(run).collect::<Result<_, _>>()?,
        )
    };
    of_test()
        .map_err(|error| {
            log.problem(
                key,
                error.to_string(),
                "see the output of `armill ballbar` for these files",
            );
        })
        .ok()
}

/// What was read; `None` if it has problems: those of a file are reported in that file, others at `key`.
fn taken<T>(log: &mut ProblemLog<'_>, key: &str, read: Result<T, StudyError>) -> Option<T> {
    match read {
        Ok(found) => Some(found),
        Err(StudyError::Problems(problems)) => {
            log.problems.extend(problems);
            None
        }
        Err(StudyError::Value { message, hint }) => {
            log.problem(key, message, &hint);
            None
        }
        Err(error) => {
            log.problem(key, error.to_string(), "check that the file is readable");
            None
        }
    }
}
