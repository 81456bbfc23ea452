//! `measured`: what was measured on one circle of the study, on the part that was cut and on the path without load.
//!
//! ```text
//! a = zero_deg + f      or, where the files look at the circle from the other side, a = zero_deg - f
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
use armill_formats::measurement::ballbar::BallbarReadOptions;
use armill_formats::measurement::profile::{Points, ProfileReadOptions};
use schemars::JsonSchema;
use serde::Deserialize;

use super::places::Places;
use super::resolve::{Ask, Subject};
use crate::ballbar::{self, Wanted as BallbarWanted};
use crate::error::StudyError;
use crate::roundness;

/// What was measured on one circle: the part that was cut, the path without load.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExperimentTable {
    /// Name of the path that was cut, a circle; needed where the study asks for several.
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
    /// Nominal radius of what was measured, where a file does not tell it; that of the circle if left out.
    #[schemars(range(min = 0.001, max = 1e4))]
    pub radius_mm: Option<f64>,
    /// Where angle 0 of the files lies on the circle, from +y' towards z'; 0 if left out.
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

/// What deviations count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DatumName {
    /// As the file has it.
    AsMeasured,
    /// That of the least-squares circle.
    LeastSquares,
}

/// What was measured, in the angles of the circle.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// What the study says.
    pub table: ExperimentTable,
    /// Name of the path.
    pub analysis: String,
    /// Nominal radius of the circle, m.
    pub radius: f64,
    /// What is taken off every curve.
    pub removed: Removed,
    /// The part; none where it was not measured.
    pub part: Option<Part>,
    /// The path without load; none where it was not measured.
    pub test: Option<CircularTest>,
    /// What a user must know of the files, each a sentence.
    pub notes: Vec<String>,
}

/// The profile of the part.
#[derive(Clone, Debug)]
pub struct Part {
    /// Radial deviation over the angle.
    pub run: Run,
    /// How many points the file has.
    pub points: usize,
    /// Where its centre was found, in the axes of the file, m; none where deviations count from the origin.
    pub centre: Option<[f64; 2]>,
    /// Standard uncertainty of a point, m.
    pub u: f64,
}

/// A point that is off by more than this part of the radius is none of that circle.
const FARTHEST: f64 = 0.1;

impl Experiment {
    /// Reads what the table names; `None` where something of it is wrong, told at its place.
    pub(super) fn read(
        places: &mut Places<'_>,
        table: &ExperimentTable,
        folder: &Path,
        (analyses, all_read): (&[Ask], bool),
    ) -> Option<Experiment> {
        let circle = circle(places, ("measured", table.analysis.as_ref()), (analyses, all_read));
        if table.part.is_none() && table.ballbar.is_empty() {
            let hint = "part = \"cmm.csv\", or ballbar = [\"first.csv\", \"second.csv\"]";
            places.problem("measured", "nothing measured is named", hint);
        }
        let least_squares = |name: Option<DatumName>| name != Some(DatumName::AsMeasured);
        let removed = Removed {
            centre: least_squares(table.centre),
            radius: least_squares(table.radius),
        };
        // Files are read even where the circle is not known: their problems belong to the same list.
        let radius_mm = table
            .radius_mm
            .or(circle.as_ref().map(|(_, radius)| radius * 1e3));
        let mut notes = Vec::new();
        let part = table.part.as_ref().map(|file| {
            let of = (file.as_str(), folder.join(file));
            part(places, table, of, (radius_mm, removed))
        });
        let test = (!table.ballbar.is_empty()).then(|| test(places, table, folder, (removed, &mut notes)));
        let (analysis, radius) = circle?;
        // A file that was named and could not be read is a problem already.
        let (part, test) = (part.map_or(Some(None), |part| part.map(Some))?, test);
        let test = test.map_or(Some(None), |test| test.map(Some))?;
        let other = test
            .as_ref()
            .map(CircularTest::radius)
            .filter(|r| (r / radius - 1.0).abs() > 0.01);
        notes.extend(other.map(|other| {
            format!(
                "the ball-bar went round a circle of {} mm, the cut round one of {} mm: what the path does without \
                 load is taken to be the same",
                crate::number::decimals(other * 1e3, 3),
                crate::number::decimals(radius * 1e3, 3)
            )
        }));
        Some(Experiment {
            table: table.clone(),
            analysis,
            radius,
            removed,
            part,
            test,
            notes,
        })
    }
}

/// The circle that the table `key` is of, with its radius (m); `None` where there is none, told at its place.
pub(super) fn circle(
    places: &mut Places<'_>,
    (key, analysis): (&str, Option<&String>),
    (analyses, all_read): (&[Ask], bool),
) -> Option<(String, f64)> {
    let radius = |analysis: &Ask| match &analysis.subject {
        Subject::Path(path) => match path.shape() {
            Some(Shape::Circle { radius, .. }) => Some(*radius),
            _ => None,
        },
        _ => None,
    };
    let circles: Vec<(String, f64)> = analyses
        .iter()
        .filter_map(|analysis| Some((analysis.name.clone(), radius(analysis)?)))
        .collect();
    let hint = "the name of an ask of kind = \"path\" with circle = { radius_mm = 100 }";
    match (analysis, &circles[..]) {
        (Some(name), _) => {
            let found = circles.iter().find(|(own, _)| own == name);
            // An ask with problems of its own is told there.
            if found.is_none() && all_read {
                let message = match analyses.iter().any(|analysis| analysis.name == *name) {
                    true => format!("`{name}` is no circle"),
                    false => format!("the study asks for nothing called `{name}`"),
                };
                places.problem(&format!("{key}.ask"), message, hint);
            }
            found.cloned()
        }
        (None, [one]) => Some(one.clone()),
        (None, _) if !all_read => None,
        (None, []) => {
            places.problem(key, "the study has no circle that could have been measured", hint);
            None
        }
        (None, several) => {
            let names: Vec<&str> = several.iter().map(|(name, _)| name.as_str()).collect();
            let message = format!("the study has {} circles: {}", several.len(), names.join(", "));
            places.problem(key, message, "name the one that was measured: ask = \"...\"");
            None
        }
    }
}

/// Angles of a file as those of the circle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turned {
    zero: f64,
    sign: f64,
}

impl Turned {
    pub(super) fn new(zero_deg: Option<f64>, mirrored: bool) -> Turned {
        Turned {
            zero: zero_deg.unwrap_or(0.0).to_radians(),
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

/// The profile of the part; `None` where it cannot be used, told at its place.
fn part(
    places: &mut Places<'_>,
    table: &ExperimentTable,
    (file, path): (&str, std::path::PathBuf),
    (radius_mm, removed): (Option<f64>, Removed),
) -> Option<Part> {
    let key = "measured.part";
    let shown = path.display().to_string();
    let requested = ProfileReadOptions {
        radius_mm: table.radius_mm,
        else_radius_mm: radius_mm,
        unit: None,
    };
    let given = roundness::read((&shown, &path), &requested);
    let measured = taken(places, key, given)?;
    let count = measured.points.count();
    let points = match measured.points {
        Points::Plane(points) => points,
        Points::Space(_) if !removed.centre => {
            let message = format!("{file} holds points in space: they have no centre to count from");
            places.problem(key, message, "centre = \"least-squares\"");
            return None;
        }
        Points::Space(points) => {
            let Some(plane) = Plane::nearest(&points) else {
                places.problem(
                    key,
                    format!("the points of {file} lie in no plane"),
                    "points of a circle",
                );
                return None;
            };
            points.iter().map(|point| plane.seen(point)).collect()
        }
    };
    let (centre, points) = match removed.centre {
        false => (None, points),
        true => match Profile::new(points) {
            Ok(profile) => {
                let centre = profile.least_squares().centre.coords;
                let own = profile.points().iter().map(|point| point - centre);
                (Some(centre.into()), own.collect())
            }
            Err(error) => {
                places.problem(key, format!("{file}: {error}"), "points of one circle");
                return None;
            }
        },
    };
    // Where the circle is unknown that is a problem already, and nothing more can be said of the part.
    let radius_mm = radius_mm?;
    let nominal = radius_mm * 1e-3;
    let turned = Turned::new(table.zero_deg, table.mirrored);
    let angle = points.iter().map(|p| turned.angle(p.y.atan2(p.x))).collect();
    let deviation: Vec<f64> = points.iter().map(|p| p.coords.norm() - nominal).collect();
    if let Some(most) = deviation.iter().copied().find(|by| by.abs() > FARTHEST * nominal) {
        let message = format!(
            "{file}: a point is {:.3} mm off a circle of {radius_mm} mm",
            most * 1e3
        );
        let hint = "the radius that the part shows, such as radius_mm = 100; centre = \"least-squares\"";
        places.problem(key, message, hint);
        return None;
    }
    match Run::new(Direction::Anticlockwise, angle, deviation) {
        Ok(run) => Some(Part {
            run,
            points: count,
            centre,
            u: table.part_u_um.unwrap_or(0.0) * 1e-6,
        }),
        Err(error) => {
            places.problem(
                key,
                format!("{file}: {error}"),
                "a point every 15 degrees, or more",
            );
            None
        }
    }
}

/// The path without load; `None` where it cannot be used, told at its place.
fn test(
    places: &mut Places<'_>,
    table: &ExperimentTable,
    folder: &Path,
    (removed, notes): (Removed, &mut Vec<String>),
) -> Option<CircularTest> {
    let turned = Turned::new(
        table.ballbar_zero_deg.or(table.zero_deg),
        table.ballbar_mirrored.unwrap_or(table.mirrored),
    );
    let of = ("measured.ballbar", &table.ballbar[..]);
    let measured = bar(places, of, (folder, table.radius_mm), notes)?;
    turned_test(places, of.0, &measured, (turned, removed.centre))
}

/// What the files named at `key` hold of one circle; `None` where they cannot be read, told at its place.
pub(super) fn bar(
    places: &mut Places<'_>,
    (key, files): (&str, &[String]),
    (folder, radius_mm): (&Path, Option<f64>),
    notes: &mut Vec<String>,
) -> Option<ballbar::Measured> {
    let mut all_there = true;
    for (index, file) in files.iter().enumerate() {
        if !folder.join(file).is_file() {
            let hint = "a CSV with `angle_deg,radius_dev_um,direction,run`, or results of a ball-bar (.b5r)";
            places.problem(
                &format!("{key}[{index}]"),
                format!("there is no file {file}"),
                hint,
            );
            all_there = false;
        }
    }
    let files: Vec<_> = files.iter().map(|file| folder.join(file)).collect();
    if !all_there {
        return None;
    }
    let requested = BallbarWanted {
        given: BallbarReadOptions {
            radius: radius_mm.map(|mm| mm * 1e-3),
            ..BallbarReadOptions::default()
        },
        ..BallbarWanted::default()
    };
    let measured = taken(places, key, ballbar::read(&files, &requested))?;
    notes.extend(measured.notes.iter().cloned());
    Some(measured)
}

/// These runs in the angles of the circle, seen from their own centre where that is taken off; `None` where that cannot be,
/// told at its place.
pub(super) fn turned_test(
    places: &mut Places<'_>,
    key: &str,
    measured: &ballbar::Measured,
    (turned, takes_centre): (Turned, bool),
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
            places.problem(
                key,
                error.to_string(),
                "see what `armill ballbar` tells of these files",
            );
        })
        .ok()
}

/// What was read; `None` where it has problems: those of a file stand in it, others at `key`.
fn taken<T>(places: &mut Places<'_>, key: &str, read: Result<T, StudyError>) -> Option<T> {
    match read {
        Ok(found) => Some(found),
        Err(StudyError::Problems(problems)) => {
            places.problems.extend(problems);
            None
        }
        Err(StudyError::Value { message, hint }) => {
            places.problem(key, message, &hint);
            None
        }
        Err(error) => {
            places.problem(key, error.to_string(), "is the file readable?");
            None
        }
    }
}
