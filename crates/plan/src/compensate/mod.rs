//! The path to command so that the tool follows the nominal path: the deviation before and after, and the path as a
//! table that armill reads again.
//!
//! | column of the table | unit | meaning |
//! |---|---|---|
//! | `x_mm`, `y_mm`, `z_mm` | mm | the tip, in the frame of the program |
//! | `i`, `j`, `k` | - | from the tip towards the spindle, same frame |
//! | `spin_deg` | deg | spin of the tool about its axis, for `spin = "given"` |
//! | `feed_mm_per_min` | mm/min | speed towards the point; empty if the program does not specify it |
//! | `rapid` | - | 1 where a rapid leads to the point |
//!
//! For a path from a robot program, that program is returned too, with changed targets ([`in_place`]).
//!
//! `answer`: the result of all paths, in numbers and sentences; `commanded`: a commanded path or set of holes; `error_answer`: the distances from the path; `holes`: holes instead of a
//! path; `in_place`: the program that a path is from, rewritten; `surface`: the part that comes out before and after.
//!
//! The correction is the elastic deviation (and that of gravity, backlash and the calibrated robot, if known)
//! under the mean of the load cases, of a cut under its nominal force; the difference of the cases is reported as
//! residual.

mod answer;
mod commanded;
pub mod error_answer;
mod holes;
pub mod in_place;
mod surface;

pub use answer::CompensationAnswer;
pub use commanded::{CollisionsAnswer, Commanded, CompensatedPath};
pub use error_answer::ErrorAnswer;
pub use surface::{CompensatedSurface, SurfaceNumbers};

use armill_core::kernel::Answers;
use armill_core::machined::surface_directions;
use armill_core::nalgebra::Vector3;
use armill_core::optimize::{Compensated, Compensation, compensated_along};
use armill_core::path::{LoadedTrack, Shape, Track};
use armill_core::units::{to_mm, to_um};
use armill_core::watch::Watch;
use armill_formats::table::csv;
use armill_report::{PathPlot, Series};
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::run::passes;
use armill_study::analysis::path::to_measure::{NominalPath, to_measure};
use armill_study::analysis::runner::Runner;
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;

use self::commanded::{caution, table};
use self::holes::of_holes;
use self::in_place::{RewrittenProgram, in_place};

/// How paths are compensated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requested {
    /// The fixed-point iteration.
    pub iteration: Compensation,
    /// Whether a path with a machined part is compensated only in the directions that show on its surface.
    pub normal_to_surface: bool,
}

impl From<Compensation> for Requested {
    fn from(iteration: Compensation) -> Requested {
        Requested {
            iteration,
            normal_to_surface: false,
        }
    }
}

/// Compensates every path and set of holes of the study, or the one called `name`. A circle is closed: its first point is commanded
/// again at its end.
///
/// # Errors
/// No such path; a robot without compliance; a path that misses its stock; cancelled by the watch.
pub fn compensate<'a>(
    study: &'a Study,
    name: Option<&str>,
    requested: impl Into<Requested>,
    watch: Watch<'_>,
) -> Result<Vec<Commanded<'a>>, StudyError> {
    let requested = requested.into();
    let runner = Runner::new(&study.robot.robot, watch)?;
    let paths = study.paths(name);
    let paths = paths.map(|(name, path)| of_path(&runner, name, path, requested));
    let holes = study.holes(name);
    let holes = holes.map(|(name, holes)| of_holes(&runner, name, holes, requested.iteration));
    let all: Vec<Commanded<'a>> = paths.chain(holes).collect::<Result<_, _>>()?;
    if all.is_empty() {
        let message = match name {
            Some(name) => format!("the study has no path or holes called `{name}`"),
            None => "the study has no path or holes that could be compensated".to_owned(),
        };
        return Err(StudyError::value(
            message,
            "[[analysis]] kind = \"path\" with a program or a shape",
        ));
    }
    Ok(all)
}

/// Points that the progress of [`compensate`] ends at: a path is followed once, and about three times more to determine
/// the commanded one.
pub fn point_count(study: &Study, name: Option<&str>) -> usize {
    let of = |(_, path): (&str, &PathAnalysis)| {
        let again = usize::from(path.source.robot().is_some())
            + usize::from(path.has_stock() && path.setting.cell.is_some());
        (passes(path) + 3 + again) * path.track.len()
    };
    let holes = study.holes(name).map(|(_, holes)| 4 * holes.path.track.len());
    study.paths(name).map(of).chain(holes).sum()
}

fn of_path<'a>(
    runner: &Runner<'_>,
    name: &str,
    path: &'a PathAnalysis,
    requested: Requested,
) -> Result<Commanded<'a>, StudyError> {
    let closed;
    let analysis = match path.shape() {
        Some(Shape::Circle { .. }) => {
            let mut track = path.track.closed(path.length());
            let last = track.spins.as_mut().and_then(|spins| spins.last_mut());
            if let (Some(curve), Some(last)) = (&path.spin_curve, last) {
                *last = curve.at(path.length());
            }
            closed = PathAnalysis {
                track,
                load: path.load.closed(),
                ..path.clone()
            };
            &closed
        }
        _ => path,
    };
    let (load, _) = runner.pushed(analysis)?;
    let followed = runner.follow(analysis, load)?;
    let load = &followed.load;
    let drawn = followed.turned.as_ref().unwrap_or(&analysis.track);
    let question = runner.question(&analysis.setting);
    let before = surface::uncompensated(runner, analysis, drawn, &followed.along)?;
    let directions = match (requested.normal_to_surface, &before) {
        (false, _) => None,
        (true, Some(part)) => Some(surface_directions(drawn.len(), &part.surface.points)),
        (true, None) => return Err(surface::no_part(name)),
    };
    let mut found = compensated_along(
        &question,
        LoadedTrack { track: drawn, load },
        &followed.along.choices,
        (requested.iteration, directions.as_deref()),
        runner.watch,
    )?;
    let surface = surface::answer(runner, analysis, (drawn, before.as_ref()), &found)?;
    // The tool cuts where the nominal path is, with the postures of the commanded one.
    runner.keep_clear_of_stock(analysis, &mut found.along)?;
    let rewritten = in_place(runner, analysis, &followed, load, &found.track)?;
    let (in_place, mut notes) = match rewritten {
        None => (None, Vec::new()),
        Some(Ok(written)) => (Some(written), Vec::new()),
        Some(Err(why)) => (
            None,
            vec![format!(
                "{}: the program itself is not written again: {why}",
                analysis.shown()
            )],
        ),
    };
    let before = &followed.along.answers;
    let file = format!("{}.commanded.csv", armill_study::file_names::slug(name));
    let correction = |index: usize| {
        let moved = found.track.path.points[index].at - drawn.path.points[index].at;
        to_um(moved.norm())
    };
    let largest_correction_um = (0..drawn.len()).map(correction).fold(0.0, f64::max);
    notes.extend(caution(name, largest_correction_um));
    let given = CompensatedPath {
        name: name.to_owned(),
        points: drawn.len(),
        before: ErrorAnswer::of(drawn, &before.deviations, before.case_count),
        after: ErrorAnswer::of(drawn, &found.residual, found.along.answers.case_count),
        largest_correction_um,
        rounds: found.rounds,
        last_round_um: to_um(found.last_move),
        contraction_ratio: found.contraction,
        unreachable: found.unmoved,
        collisions: CollisionsAnswer::of(&path.setting, &found.along.answers),
        outside_joint_limits: found
            .along
            .answers
            .evaluations()
            .filter(|(_, evaluation)| !evaluation.within_limits())
            .count(),
        file,
        in_place: in_place.as_ref().map(|written| written.given.clone()),
        surface,
        notes,
    };
    let nominal = NominalPath {
        robot: runner.robot,
        nominal: drawn,
        along: &found.along,
    };
    let to_measure = csv::write(&to_measure(name, &nominal)?);
    Ok(Commanded {
        picture: Some(picture(name, drawn, before, &found, in_place.as_ref())),
        holes: None,
        refused: Vec::new(),
        csv: csv::write(&table(name, &found.track)?),
        to_measure: Some(to_measure),
        setting: &path.setting,
        path: (found.track, found.along.answers),
        top: drawn.top(),
        spindle: path.cut.as_ref().and_then(|cut| cut.cutting.spindle),
        given,
        program: in_place.map_or_else(Vec::new, |written| written.files),
    })
}

/// Points that the picture has at most.
const MOST_POINTS: usize = 1200;

/// Distance from the nominal path along it, before and after: the largest of the load cases, and of points in one mark.
fn picture(
    name: &str,
    drawn: &Track,
    before: &Answers,
    found: &Compensated,
    in_place: Option<&RewrittenProgram>,
) -> String {
    let points = &drawn.path.points;
    let handful = points.len().div_ceil(MOST_POINTS).max(1);
    let series = |name: &str, errors: &[Vector3<f64>], cases: usize| Series {
        name: name.to_owned(),
        position: points
            .iter()
            .step_by(handful)
            .map(|point| to_mm(point.along))
            .collect(),
        deviation_um: errors
            .chunks(handful * cases)
            .map(|some| to_um(some.iter().map(Vector3::norm).fold(0.0, f64::max)))
            .collect(),
    };
    let after = found.along.answers.case_count;
    let mut all = vec![
        series("nominal", &before.deviations, before.case_count),
        series("compensated", &found.residual, after),
    ];
    all.extend(
        in_place.map(|written| series("compensated in the program's own moves", &written.residual, after)),
    );
    PathPlot {
        title: format!("{name}: compensated"),
        subtitle: "predicted distance of the tool from the nominal path; the largest of the load cases"
            .to_owned(),
        position_label: "along the path (mm)".to_owned(),
        quantity: "distance from the nominal path (µm)".to_owned(),
        series: all,
        envelope: None,
        tolerance_um: None,
    }
    .to_svg()
}
