//! A set of holes of an analysis: where they are, which way out of the part, and the load at each. Their order is of
//! no consequence.
//!
//! | specified by | position | direction out of the part |
//! |---|---|---|
//! | `holes.at_mm`, `holes.normals` | the frame of the part, moved by `part_from_holes_mm_deg` | one a hole, one for all, or the normal of the plane |
//! | `holes.file` | the same: a CSV with `x_mm, y_mm, z_mm` | its columns `i, j, k`, if it has them |
//! | `program.file` | as in the program: the ends of its plunges | as in the program |
//!
//! A load in axes of the feed (`load.frame = "feed"`) has z out of the hole and x as for the tool at spin 0; thrust
//! and torque of a `drill` are such a load.

use std::io::BufReader;
use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::load::PathLoad;
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::optimize::PostureSearch;
use armill_core::path::{Hole, Pace, Placing, SampledPath, Spin, Step, Track, drilled_holes, path_of_holes};
use armill_core::robot::Robot;
use armill_core::units::from_mm;
use armill_formats::input;
use armill_formats::toolpath::format::{self, Format, ToolpathReadOptions};

use crate::StudyError;
use crate::analysis::holes::table::HolesTable;
use crate::analysis::holes::{Drilling, HolesAnalysis};
use crate::analysis::path::program_file::FILE_HINT;
use crate::analysis::path::program_table::{ProgramTable, SpinName};
use crate::analysis::path::robot_program::RobotInCell;
use crate::analysis::path::{LoadSource, PathAnalysis, PathSource, program, put_on};
use crate::analysis::resolve::Resolver;
use crate::input::posture_search::{ComponentName, SearchTable};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::input::setting::Setting;

/// Holes that a study may list.
const MOST_HOLES: usize = 100_000;

impl Resolver<'_> {
    /// The holes of this analysis; `None` if it has problems, reported at their keys.
    ///
    /// # Errors
    /// The problems of the files that it names.
    pub fn holes(
        &self,
        log: &mut ProblemLog<'_>,
        setting: Option<Setting>,
        push: Option<LoadSource<'_>>,
    ) -> Result<Option<HolesAnalysis>, StudyError> {
        let search = setting
            .as_ref()
            .and_then(|setting| self.hole_search(log, setting));
        let (table, folder) = (self.table, self.folder);
        let of = table.holes.clone().unwrap_or_default();
        let reported = [of.at_mm.is_some(), of.file.is_some(), table.program.is_some()];
        if reported.iter().filter(|reported| **reported).count() != 1 {
            let hint = "holes = { at_mm = [[0, 0, 0]] }, holes = { file = \"holes.csv\" }, or program = { file = \"drilling.ngc\" }";
            log.problem_here("holes need exactly one list, file or program", hint);
            return Ok(None);
        }
        let before = log.problems.len();
        let found = match &table.program {
            Some(program) => {
                refuse_keys(log, program, &of);
                let Some(setting) = &setting else { return Ok(None) };
                let robot = self.robot.map(|found| &found.robot);
                of_program(log, program, folder, robot, setting)?
            }
            None => of_list(log, &of, folder, setting.as_ref())?,
        };
        let (Some((path, placing, source)), Some(setting), Some(push), Some(search)) =
            (found, setting, push, search)
        else {
            return Ok(None);
        };
        let mut analysis = PathAnalysis {
            spin_curve: None,
            source,
            track: Track {
                path,
                placing,
                base_from_part: setting.plane.base_from_part,
                spins: None,
                homes: None,
            },
            load: PathLoad::Cases(setting.load.clone()),
            cut: None,
            drill: None,
            forces: None,
            measured: None,
            machined_part: None,
            wants_limits: false,
            features: Vec::new(),
            setting,
        };
        let pushes = put_on(log, push, folder, &mut analysis)?;
        let fine = pushes && log.problems.len() == before;
        Ok(fine.then_some(HolesAnalysis {
            path: analysis,
            search,
            drilling: Drilling::of(&of),
        }))
    }

    /// What is searched for at holes, as usual where nothing is said; `None` also where that is wrong. Each hole is for
    /// itself: what joins points of a path has no meaning.
    fn hole_search(&self, log: &mut ProblemLog<'_>, setting: &Setting) -> Option<PostureSearch> {
        let own = self
            .table
            .posture
            .as_ref()
            .and_then(|posture| posture.search.as_ref());
        let given = [
            ("objective", own.is_some_and(|table| table.objective.is_some())),
            (
                "turn_deg_per_mm",
                own.is_some_and(|table| table.turn_deg_per_mm.is_some()),
            ),
            (
                "reversal_um_mm",
                own.is_some_and(|table| table.reversal_um_mm.is_some()),
            ),
            ("lean", own.is_some_and(|table| table.lean.is_some())),
            ("axes", own.is_some_and(|table| !table.axes.is_empty())),
        ];
        for (key, _) in given.iter().filter(|(_, given)| *given) {
            let message = format!("`{key}` is not valid for holes: each hole is evaluated separately");
            log.problem(
                &format!("posture.search.{key}"),
                message,
                "it belongs to kind = \"path\"",
            );
        }
        let table = self.of_posture(|posture| posture.search.as_ref());
        if table.and_then(|table| table.component) == Some(ComponentName::CrossTrack) {
            let hint = "`in-plane` or `axial`";
            log.problem(
                "posture.search.component",
                "`cross-track` is not valid for holes: they have no track",
                hint,
            );
            return None;
        }
        let usual = SearchTable::default();
        table
            .unwrap_or(&usual)
            .resolve(log, setting.tolerance, setting.open)
    }
}

/// Points, their placement, and their source.
type LocatedHoles = (SampledPath, Placing, PathSource);

/// Reports keys of a program that are not valid for holes.
fn refuse_keys(log: &mut ProblemLog<'_>, program: &ProgramTable, of: &HolesTable) {
    let given = [
        ("program.feature", !program.feature.is_empty()),
        ("program.limits", program.limits.is_some()),
        ("program.measured", program.measured.is_some()),
        (
            "program.spin",
            program.spin.is_some_and(|spin| spin != SpinName::Fixed),
        ),
        ("holes.normals", of.normals.is_some()),
        (
            "holes.part_from_holes_mm_deg",
            of.part_from_holes_mm_deg.is_some(),
        ),
    ];
    for (key, _) in given.iter().filter(|(_, given)| *given) {
        let message = format!("`{key}` is not valid for the holes of a program");
        log.problem(
            key,
            message,
            "remove it, or analyse the program with kind = \"path\"",
        );
    }
    if of.drill.is_some() && program.drill.is_some() {
        log.problem("holes.drill", "two drills are given", "keep `program.drill`");
    }
}

/// The ends of the plunges of a program.
fn of_program(
    log: &mut ProblemLog<'_>,
    table: &ProgramTable,
    folder: &Path,
    robot: Option<&Robot>,
    setting: &Setting,
) -> Result<Option<LocatedHoles>, StudyError> {
    let cell = RobotInCell::of(robot, Some(setting));
    let Some(found) = program::read(log, table, folder, cell)? else {
        return Ok(None);
    };
    let placing = program::placing(table, &setting.plane.base_from_part, found.robot.as_deref());
    let holes = drilled_holes(&found.path, &placing);
    if holes.points.is_empty() {
        let message = format!(
            "{} drills no hole: no cut is along the tool and ends there",
            table.file
        );
        let hint = "use drilling cycles or single plunges; use kind = \"path\" for a path";
        log.problem("program.file", message, hint);
        return Ok(None);
    }
    let file = table.file.clone();
    let source = PathSource::Program {
        file,
        summary: found.summary,
        robot: found.robot,
    };
    Ok(Some((holes, placing, source)))
}

/// Holes of a list or a CSV.
fn of_list(
    log: &mut ProblemLog<'_>,
    of: &HolesTable,
    folder: &Path,
    setting: Option<&Setting>,
) -> Result<Option<LocatedHoles>, StudyError> {
    let part_from_holes = of
        .part_from_holes_mm_deg
        .as_ref()
        .map_or_else(Isometry::identity, pose_mm_deg);
    let axis = part_from_holes.rotation.inverse() * Vector3::z_axis();
    let path = match (&of.at_mm, &of.file) {
        (Some(at), _) => listed(log, at, of.normals.as_deref(), axis),
        (None, Some(file)) => {
            if of.normals.is_some() {
                let hint = "use the columns i, j, k of the file";
                log.problem(
                    "holes.normals",
                    "the directions of a file are given in the file",
                    hint,
                );
            }
            in_file(log, file, folder, axis)?
        }
        (None, None) => None,
    };
    let (Some(path), Some(setting)) = (path, setting) else {
        return Ok(None);
    };
    let placing = Placing {
        base_from_path: setting.plane.base_from_part * part_from_holes,
        axis,
        keeps_axis: false,
        spin: Spin::Fixed(0.0),
    };
    let file = of.file.clone();
    Ok(Some((path, placing, PathSource::Holes { file })))
}

/// Holes that the study lists.
fn listed(
    log: &mut ProblemLog<'_>,
    at_mm: &[[f64; 3]],
    normals: Option<&[[f64; 3]]>,
    axis: Unit<Vector3<f64>>,
) -> Option<SampledPath> {
    let before = log.problems.len();
    if at_mm.is_empty() {
        log.problem(
            "holes.at_mm",
            "the list has no holes",
            "at_mm = [[0, 0, 0], [50, 0, 0]]",
        );
    }
    let normals = normals.unwrap_or_default();
    if normals.len() > 1 && normals.len() != at_mm.len() {
        let message = format!("{} normals for {} holes", normals.len(), at_mm.len());
        log.problem("holes.normals", message, "give one for each hole, or one for all");
    }
    let mut axes = Vec::new();
    for (index, normal) in normals.iter().enumerate() {
        match Unit::try_new(Vector3::from(*normal), 1e-9) {
            Some(axis) => axes.push(axis),
            None => {
                let path = format!("holes.normals[{index}]");
                log.problem(&path, "the normal has zero length", "such as [0, 0, 1]");
            }
        }
    }
    let axis_of = |index: usize| match axes[..] {
        [] => axis,
        [one] => one,
        _ => axes[index],
    };
    (log.problems.len() == before).then(|| {
        let hole = |(index, at): (usize, &[f64; 3])| Hole {
            at: Point3::from(from_mm(Vector3::from(*at))),
            axis: axis_of(index),
            line: index as u32 + 1,
        };
        path_of_holes(&at_mm.iter().enumerate().map(hole).collect::<Vec<_>>())
    })
}

/// Holes of a CSV: a row each.
///
/// # Errors
/// The problems of the file.
fn in_file(
    log: &mut ProblemLog<'_>,
    file: &str,
    folder: &Path,
    axis: Unit<Vector3<f64>>,
) -> Result<Option<SampledPath>, StudyError> {
    let path = folder.join(file);
    let shown = path.display().to_string();
    let opened = match input::open(&path) {
        Ok(opened) => opened,
        Err(error) => {
            let message = format!("cannot read {shown}: {error}");
            log.problem("holes.file", message, FILE_HINT);
            return Ok(None);
        }
    };
    let (mut holes, mut paces, mut operations) = (Vec::new(), Vec::new(), Vec::new());
    let mut too_many = false;
    let summary = format::read(
        &shown,
        BufReader::new(opened),
        &ToolpathReadOptions::default(),
        &mut |step| match step {
            Step::Operation(operation) => operations.push((holes.len(), operation)),
            Step::Command(_) => {}
            Step::Move(_) if holes.len() >= MOST_HOLES => too_many = true,
            Step::Move(next) => {
                paces.push(next.pace);
                holes.push(Hole {
                    at: next.end,
                    axis: next.axis.unwrap_or(axis),
                    line: next.line,
                });
            }
        },
    )?;
    let problem = if summary.format != Format::Csv {
        Some((
            format!("{shown} is a program, not a table of holes"),
            "use program = { file = ... }",
        ))
    } else if too_many {
        Some((
            format!("{shown} has more than {MOST_HOLES} holes"),
            "split the file",
        ))
    } else if holes.is_empty() {
        Some((
            format!("{shown} has no hole"),
            "give one row for each hole below the header",
        ))
    } else {
        None
    };
    if let Some((message, hint)) = problem {
        log.problem("holes.file", message, hint);
        return Ok(None);
    }
    let mut path = path_of_holes(&holes);
    path.operations = operations;
    for (point, pace) in path.points.iter_mut().zip(paces) {
        // A row is a hole at any feed of the tool.
        point.pace = if pace.cuts() { pace } else { Pace::Unknown };
    }
    Ok(Some(path))
}
