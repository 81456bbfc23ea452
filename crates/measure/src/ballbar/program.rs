//! The corrected circle as a robot program, on a circle of a study.
//!
//! ```text
//! a = zero + f   or, where the bar looks from the other side, a = zero - f
//! p(a) = centre + (R + c(f)) (-cos a, sin a)        path axes: -x is y', y is z' of the plane
//! straight moves between N points leave the circle by R (1 - cos(pi / N))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f`, `a` | angle in the files, and on the circle of the study: from its +y' towards z' | rad |
//! | `c` | correction of the radius | m |
//!
//! The program passes every point of the table, and closes the circle. The robot keeps the branch of the study.

use std::f64::consts::{PI, TAU};

use armill_core::load::{LoadCases, LoadFrame, PathLoad};
use armill_core::map::along_path;
use armill_core::nalgebra::Vector2;
use armill_core::path::{Shape, Track};
use armill_core::spatial::Wrench;
use armill_core::units::{to_mm, to_um};
use armill_core::watch::Watch;
use armill_programs::Written;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::number::decimals;
use armill_study::program_out::{PathToWrite, ProgramSettings, program};

use super::teach::TaughtCircle;

/// Position of the corrected circle in the cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CirclePlacement {
    /// Name of the circle; the only one if not given.
    pub analysis: Option<String>,
    /// Angle on the circle, from +y' towards z', at which the files have angle 0, rad.
    pub zero: f64,
    /// Whether angles of the files grow from z' towards y'.
    pub mirrored: bool,
}

/// Radii that differ by more are of two circles, m.
const SAME_RADIUS: f64 = 1e-6;
/// Tolerance for leaving out points of the table, m: none is left out.
const ALL: f64 = 1e-9;

/// The fewest points, a multiple of 12, between which straight moves leave a circle of `radius` (m) by `within` (m)
/// at most.
pub fn points_within(radius: f64, within: f64) -> usize {
    let half = (1.0 - (within / radius).min(1.0)).acos();
    let least = (PI / half.max(1e-6)).ceil() as usize;
    least.div_ceil(12) * 12
}

/// Deviation of linear moves between `points` equally spaced points from a circle of `radius` (m), m.
fn sagitta(radius: f64, points: usize) -> f64 {
    radius * (1.0 - (PI / points as f64).cos())
}

/// The program of `taught` on a circle of `study`.
///
/// # Errors
/// No such circle, or one of another radius; an analysis with a posture search; a point out of reach; data that the
/// language cannot express.
pub fn taught_program(
    study: &Study,
    taught: &TaughtCircle,
    circle: &CirclePlacement,
    expected: &ProgramSettings,
) -> Result<Written, StudyError> {
    let (analysis, centre, radius) = requested(study, circle.analysis.as_deref())?;
    if (radius - taught.radius).abs() > SAME_RADIUS {
        return Err(StudyError::value(
            format!(
                "the circle of the study has {} mm, that of the ball-bar {} mm",
                decimals(to_mm(radius), 6),
                decimals(to_mm(taught.radius), 6)
            ),
            "use the same circle in both; give --radius-mm if the files do not contain it",
        ));
    }
    if analysis.setting.search.is_some() {
        return Err(StudyError::value(
            "posture.search changes the spin of the tool along the path, which the ball-bar test did not have",
            "use the study of the ball-bar test, with one spin and one branch",
        ));
    }
    let sign = if circle.mirrored { -1.0 } else { 1.0 };
    let count = taught.corrections.len();
    let mut path = Shape::Circle { centre, radius }.sampled(TAU * radius / count as f64 * (1.0 + 1e-9));
    for (k, point) in path.points.iter_mut().enumerate() {
        // Angles of the study grow with the points; those of the files are looked up.
        let a = TAU * k as f64 / count as f64;
        let (sin, cos) = a.sin_cos();
        let at = centre + Vector2::new(-cos, sin) * taught.radius_at(sign * (a - circle.zero));
        (point.at.x, point.at.y) = (at.x, at.y);
    }
    let track = Track {
        path,
        ..analysis.track.clone()
    };
    let track = track.closed(TAU * radius);
    let nothing = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: vec![Wrench::ZERO],
    });
    let runner = Runner::new(&study.robot.robot, Watch::NONE)?;
    let along = along_path(&runner.question(&analysis.setting), &track, nothing, Watch::NONE)?;
    let all_points = ProgramSettings {
        within: ALL,
        ..expected.clone()
    };
    let path = PathToWrite {
        setting: &analysis.setting,
        track: &track,
        answers: &along.answers,
        top: track.top(),
        spindle: None,
    };
    let mut written = program(study, path, &all_points)?;
    let sagitta = sagitta(radius, count);
    if sagitta > expected.within {
        written.notes.push(format!(
            "linear moves between {count} points deviate by {:.1} um from the circle; {} points are within {} um",
            to_um(sagitta),
            points_within(radius, expected.within),
            decimals(to_um(expected.within), 6)
        ));
    }
    Ok(written)
}

/// The requested circle, its centre and its radius.
fn requested<'a>(
    study: &'a Study,
    name: Option<&str>,
) -> Result<(&'a PathAnalysis, armill_core::nalgebra::Point2<f64>, f64), StudyError> {
    let circles: Vec<_> = study
        .paths(name)
        .filter_map(|(name, path)| match path.shape() {
            Some(Shape::Circle { centre, radius }) => Some((name, (path, *centre, *radius))),
            _ => None,
        })
        .collect();
    let hint = "an analysis of kind = \"path\" with circle = { radius_mm = 100 }";
    match (&circles[..], name) {
        ([(_, one)], _) => Ok(*one),
        ([], Some(name)) => Err(StudyError::value(
            format!("the study has no circle called `{name}`"),
            hint,
        )),
        ([], None) => Err(StudyError::value("the study has no circle", hint)),
        (several, _) => {
            let names: Vec<&str> = several.iter().map(|(name, _)| *name).collect();
            let message = format!("the study has {} circles: {}", several.len(), names.join(", "));
            Err(StudyError::value(
                message,
                "name the one that was measured: --analysis NAME",
            ))
        }
    }
}
