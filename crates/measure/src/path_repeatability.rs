//! Repeatability of a path of which only measured passes are known: the result of `armill path-accuracy` without a commanded path.
//!
//! ```text
//! records -> passes forth and back, between rests -> RT of each direction, distance of the directions
//! ```
//!
//! The path of a direction is its first pass at even distances; RT is that about the barycentre of the passes, which does not depend on it but for the planes across
//! it. The directions are apart by the distance of the barycentre of the one from the path of barycentres of the other.

use std::io::BufReader;
use std::path::PathBuf;

use armill_core::measure::passes::{Passes, distance_from, evenly};
use armill_core::measure::path_accuracy::{PathAccuracy, path_accuracy};
use armill_core::nalgebra::Vector3;
use armill_core::units::{to_mm, to_um};
use armill_formats::input;
use armill_formats::measurement::trace;
use armill_report::{PathPlot, Series};
use armill_study::StudyError;
use armill_study::number::decimals;
use serde::Serialize;

/// Points of a path at which passes are compared.
const POINTS: usize = 501;

/// Passes of a path, in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct PathRepeatabilityAnswer {
    /// The records.
    pub files: Vec<String>,
    /// Each direction that was passed: `forth`, as the first pass, and `back`.
    pub directions: Vec<DirectionAnswer>,
    /// Distance of the mean paths of both directions; none of one direction.
    pub apart: Option<ApartAnswer>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
    /// Sources of the definitions.
    pub sources: Vec<&'static str>,
}

/// The passes in one direction.
#[derive(Clone, Debug, Serialize)]
pub struct DirectionAnswer {
    /// `forth` or `back`.
    pub direction: &'static str,
    /// Passes.
    pub cycles: usize,
    /// Length of the first pass.
    pub length_mm: f64,
    /// RT: the largest mean distance from the barycentre with three standard deviations; none of one pass.
    pub rt_mm: Option<f64>,
    /// How far along the path that is.
    pub rt_at_mm: Option<f64>,
    /// Mean of that value over the path.
    pub rt_mean_mm: Option<f64>,
}

/// Distance of the mean paths of both directions.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ApartAnswer {
    /// Largest.
    pub largest_mm: f64,
    /// How far along the path forth.
    pub at_mm: f64,
    /// Mean over the path.
    pub mean_mm: f64,
}

/// A direction with its evaluation.
#[derive(Clone, Debug)]
pub struct Direction {
    name: &'static str,
    length: f64,
    /// Mean of the points where the passes begin, and where they end: planes there are not passed by all.
    ends: [Vector3<f64>; 2],
    found: PathAccuracy,
}

impl Direction {
    fn of(name: &'static str, passes: &[Vec<Vector3<f64>>]) -> Option<Result<Direction, StudyError>> {
        let first = passes.first()?;
        let path = evenly(first, POINTS);
        let length = path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let found = path_accuracy(&path, passes).map_err(|error| {
            let hint = "passes of one path, each between two rests";
            StudyError::value(format!("the passes {name}: {error}"), hint)
        });
        let mean = |of: fn(&Vec<Vector3<f64>>) -> Vector3<f64>| {
            passes.iter().map(of).sum::<Vector3<f64>>() / passes.len() as f64
        };
        let ends = [mean(|pass| pass[0]), mean(|pass| pass[pass.len() - 1])];
        Some(found.map(|found| Direction {
            name,
            length,
            ends,
            found,
        }))
    }

    /// How far along the path its evaluated point with this index is, m.
    fn along(&self, index: usize) -> f64 {
        self.length * self.found.points[index].index as f64 / (POINTS - 1) as f64
    }

    /// The barycentres of the passes, m, without those of their ends.
    fn barycentres(&self) -> impl Iterator<Item = Vector3<f64>> {
        let points = self.found.points.iter();
        points.map(|point| point.commanded + point.offset)
    }

    fn answer(&self) -> DirectionAnswer {
        let rt = self.found.repeatability();
        let all: Option<Vec<f64>> = self
            .found
            .points
            .iter()
            .map(|point| point.repeatability)
            .collect();
        let mean = all.map(|all| all.iter().sum::<f64>() / all.len() as f64);
        DirectionAnswer {
            direction: self.name,
            cycles: self.found.cycles,
            length_mm: reported(self.length),
            rt_mm: rt.map(|(_, rt)| reported(rt)),
            rt_at_mm: rt.map(|(at, _)| reported(self.along(at))),
            rt_mean_mm: mean.map(reported),
        }
    }
}

/// The records of passes of a path.
///
/// # Errors
/// A file that cannot be read; the problems of a file.
pub fn read(files: &[PathBuf]) -> Result<(Vec<String>, Passes), StudyError> {
    let (mut names, mut passes) = (Vec::new(), Passes::default());
    for file in files {
        let shown = file.display().to_string();
        let opened = input::open(file).map_err(|error| {
            let hint = "a table of points: x_mm, y_mm, z_mm, or an export of SpatialAnalyzer";
            StudyError::value(format!("cannot read {shown}: {error}"), hint)
        })?;
        for run in trace::read(&shown, BufReader::new(opened))?.runs {
            passes.extend(Passes::of(&run.points));
        }
        names.push(shown);
    }
    Ok((names, passes))
}

/// The directions of these passes.
///
/// # Errors
/// No pass; passes that do not follow one path.
pub fn directions(passes: &Passes) -> Result<Vec<Direction>, StudyError> {
    let both = [("forth", &passes.forth), ("back", &passes.back)];
    let found = both
        .into_iter()
        .filter_map(|(name, passes)| Direction::of(name, passes));
    let found: Vec<Direction> = found.collect::<Result<_, _>>()?;
    match found.is_empty() {
        true => Err(StudyError::value(
            "the records have no pass of 1 mm or more",
            "points along a path, in the order of time",
        )),
        false => Ok(found),
    }
}

/// Distance of the mean path forth from that back, m, at each point of the first; empty of one direction.
fn apart(directions: &[Direction]) -> Vec<f64> {
    let [forth, back] = directions else {
        return Vec::new();
    };
    let [begin, end] = back.ends;
    let other: Vec<Vector3<f64>> = [begin]
        .into_iter()
        .chain(back.barycentres())
        .chain([end])
        .collect();
    forth.barycentres().map(|at| distance_from(&at, &other)).collect()
}

/// The result in numbers.
pub fn answer(files: &[String], directions: &[Direction]) -> PathRepeatabilityAnswer {
    let distances = apart(directions);
    let largest = distances
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1));
    PathRepeatabilityAnswer {
        files: files.to_vec(),
        directions: directions.iter().map(Direction::answer).collect(),
        apart: largest.map(|(at, largest)| ApartAnswer {
            largest_mm: reported(largest),
            at_mm: reported(directions[0].along(at)),
            mean_mm: reported(distances.iter().sum::<f64>() / distances.len() as f64),
        }),
        notes: notes(directions),
        sources: vec![
            "ISO 9283:1998, definitions from memory: compare with the standard before claiming conformity",
        ],
    }
}

fn notes(directions: &[Direction]) -> Vec<String> {
    let mut notes = vec![
        "no commanded path is given: accuracy (AT) is not known".to_owned(),
        "records are divided into passes at rests of 100 points within 0.05 mm".to_owned(),
    ];
    for direction in directions {
        match direction.found.cycles {
            1 => notes.push(format!(
                "one pass {}: its repeatability is not known",
                direction.name
            )),
            cycles if cycles < armill_core::measure::path_accuracy::CYCLES => notes.push(format!(
                "ISO 9283 requires {} cycles of a path; these are {cycles} passes {}",
                armill_core::measure::path_accuracy::CYCLES,
                direction.name
            )),
            _ => {}
        }
    }
    if directions.len() > 1 {
        notes.push(
            "a path that is commanded alike in both directions is followed alike by joints that are late by the same time: where the directions are apart, joints differ in \
             their lag, or have backlash"
                .to_owned(),
        );
    }
    notes
}

/// RT of each direction and their distance along the path, as SVG.
pub fn drawing(directions: &[Direction]) -> String {
    let series = |name: String, position: Vec<f64>, values: Vec<f64>| Series {
        name,
        position,
        deviation_um: values.into_iter().map(to_um).collect(),
    };
    let positions = |direction: &Direction| {
        (0..direction.found.points.len())
            .map(|at| to_mm(direction.along(at)))
            .collect()
    };
    let mut all: Vec<Series> = directions
        .iter()
        .filter(|direction| direction.found.cycles > 1)
        .map(|direction| {
            let points = direction.found.points.iter();
            let values = points
                .map(|point| point.repeatability.unwrap_or_default())
                .collect();
            series(format!("RT {}", direction.name), positions(direction), values)
        })
        .collect();
    let distances = apart(directions);
    if !distances.is_empty() {
        let name = "distance of the mean paths forth and back".to_owned();
        all.push(series(name, positions(&directions[0]), distances));
    }
    let cycles: Vec<String> = (directions.iter())
        .map(|direction| format!("{} {}", direction.found.cycles, direction.name))
        .collect();
    PathPlot {
        title: "Path repeatability".to_owned(),
        subtitle: format!("passes: {}", cycles.join(", ")),
        position_label: "along the path (mm)".to_owned(),
        quantity: "distance (µm)".to_owned(),
        series: all,
        envelope: None,
        tolerance_um: None,
    }
    .to_svg()
}

/// mm, to a nanometre.
fn reported(value: f64) -> f64 {
    decimals(to_mm(value), 6)
}
