//! The source of the load on the tool along a path: given cases, a cut, a drill, or measured forces.
//!
//! The first of these that is given:
//!
//! | order | load | specified by |
//! |---|---|---|
//! | 1 | measured forces | `program.measured` of the analysis |
//! | 2 | a drill | `program.drill` or `holes.drill` of the analysis |
//! | 3 | a cut | `cut` of the analysis |
//! | 4 | given cases | `load` of the analysis |
//! | 5 | a cut, then given cases | `cut`, then `load` of the study |
//!
//! Holes have a drill or given cases; other analyses without a path have given cases alone. Two sources in one analysis
//! are refused, except for a cut that only predicts where a record starts.

use std::path::Path;

use armill_core::load::PathLoad;
use armill_core::path::NoForces;
use armill_core::watch::Watch;

use crate::StudyError;
use crate::analysis::path::cut::CutTable;
use crate::analysis::path::drill::DrillTable;
use crate::analysis::path::measured::{MeasuredTable, SynchroniseName};
use crate::analysis::path::{PathAnalysis, PathSource, cut, drill, measured};
use crate::analysis::study_tables::StudyTables;
use crate::analysis::table::{AnalysisKind, AnalysisTable};
use crate::input::freedoms::ToolEnd;
use crate::input::problem_log::ProblemLog;
use crate::input::tables::LoadTable;

/// The source of the load on the tool, as the study specifies it.
#[derive(Clone, Copy)]
pub enum LoadSource<'a> {
    /// Given cases.
    Load(&'a LoadTable),
    /// Forces of a cut.
    Cut(&'a CutTable),
    /// Forces of a drill, by the key of its table.
    Drill(&'static str, &'a DrillTable),
    /// A record, and the cut that predicts it if that is requested.
    Measured(&'a MeasuredTable, Option<&'a CutTable>),
}

impl<'a> LoadSource<'a> {
    /// The load in this analysis: what it brings itself, else the cut of the study (along a path), else its load.
    pub fn of(common: &'a StudyTables<'a>, analysis: &'a AnalysisTable) -> Option<LoadSource<'a>> {
        if analysis.kind == AnalysisKind::Holes {
            let own = drill(analysis).or(analysis.load.as_ref().map(LoadSource::Load));
            return own.or(common.load.map(LoadSource::Load));
        }
        let along = analysis.kind == AnalysisKind::Path;
        let program = analysis.program.as_ref().filter(|_| along);
        let own_cut = analysis.cut.as_ref().filter(|_| along);
        let cut = own_cut.or(common.cut.filter(|_| along));
        if let Some(measured) = program.and_then(|program| program.measured.as_ref()) {
            return Some(LoadSource::Measured(
                measured,
                cut.filter(|_| measured.is_predicted()),
            ));
        }
        let own = drill(analysis).or(own_cut.map(LoadSource::Cut));
        let own = own.or(analysis.load.as_ref().map(LoadSource::Load));
        own.or(cut.map(LoadSource::Cut))
            .or(common.load.map(LoadSource::Load))
    }

    /// The end of the tool, as far as it is known from the load.
    pub fn tool_end(self) -> ToolEnd {
        match self {
            LoadSource::Cut(cut) | LoadSource::Measured(_, Some(cut)) => {
                let corner = cut.cutter.corner_radius_mm.unwrap_or(0.0);
                ToolEnd::Cutter(cut.cutter.diameter_mm, corner)
            }
            LoadSource::Drill(..) => ToolEnd::Drill,
            LoadSource::Load(_) | LoadSource::Measured(_, None) => ToolEnd::NotGiven,
        }
    }

    /// Reports an analysis with two sources of load.
    pub fn refuse_two(log: &mut ProblemLog<'_>, analysis: &AnalysisTable) {
        let program = analysis.program.as_ref();
        let measured = program.and_then(|program| program.measured.as_ref());
        let predicted = measured.is_some_and(MeasuredTable::is_predicted);
        let brought = [
            ("load", "a load", analysis.load.is_some()),
            ("cut", "a cut", analysis.cut.is_some() && !predicted),
            (
                "program.drill",
                "a drill",
                program.is_some_and(|program| program.drill.is_some()),
            ),
            (
                "holes.drill",
                "a drill",
                analysis.holes.as_ref().is_some_and(|holes| holes.drill.is_some()),
            ),
            ("program.measured", "measured forces", measured.is_some()),
        ];
        let mut brought = brought.into_iter().filter(|(.., given)| *given);
        if let (Some((_, first, _)), Some((key, second, _))) = (brought.next(), brought.next()) {
            log.problem(
                key,
                format!("this {} has {first} and {second}", analysis.kind.noun()),
                "remove one",
            );
        }
    }
}

/// The drill of an analysis.
fn drill(analysis: &AnalysisTable) -> Option<LoadSource<'_>> {
    let of_program = analysis
        .program
        .as_ref()
        .and_then(|program| program.drill.as_ref());
    let of_holes = analysis.holes.as_ref().and_then(|holes| holes.drill.as_ref());
    let of_program = of_program.map(|drill| LoadSource::Drill("program.drill", drill));
    of_program.or(of_holes.map(|drill| LoadSource::Drill("holes.drill", drill)))
}

impl MeasuredTable {
    /// Whether a prediction determines the start.
    fn is_predicted(&self) -> bool {
        self.synchronise == Some(SynchroniseName::Predicted)
    }
}

/// Puts the load on a path whose load is that of its setting; whether it could, problems are reported at their keys.
///
/// # Errors
/// The problems of a file of measured forces.
pub fn put_on(
    log: &mut ProblemLog<'_>,
    push: LoadSource<'_>,
    folder: &Path,
    analysis: &mut PathAnalysis,
) -> Result<bool, StudyError> {
    let found = match push {
        LoadSource::Load(_) => Some(()),
        LoadSource::Cut(table) => cut::resolve(log, table).and_then(|cut| put_cut(log, cut, analysis)),
        LoadSource::Drill(key, table) => {
            let drill = drill::resolve(log, key, table);
            drill.and_then(|drill| put_drill(log, key, drill, analysis))
        }
        LoadSource::Measured(table, cut) => {
            let predicting = cut.map(|table| cut::resolve(log, table));
            if matches!(predicting, Some(None)) {
                return Ok(false);
            }
            let found = measured::along(log, table, folder, &analysis.track, predicting.flatten().as_ref())?;
            found.map(|(load, forces)| {
                analysis.setting.uncertainty.relative = table.u_percent.unwrap_or(0.0) / 100.0;
                (analysis.load, analysis.measured) = (load, Some(Box::new(forces)));
            })
        }
    };
    Ok(found.is_some())
}

/// Puts on the forces of a cut whose engagement is the same everywhere; a stock is cut when the study runs.
fn put_cut(log: &mut ProblemLog<'_>, cut: cut::Cut, analysis: &mut PathAnalysis) -> Option<()> {
    let (path, placing) = (&analysis.track.path, &analysis.track.placing);
    let found = cut.cutting.along(path, placing, None, Watch::NONE);
    let missing_hint =
        "give feed and spindle speed in the program, or cut.feed_mm_per_min and cut.spindle_rpm";
    let found = found
        .map_err(|error| report_no_forces(log, analysis, &error, missing_hint))
        .ok()?;
    analysis.setting.uncertainty.relative = found.summary.relative_uncertainty;
    (analysis.load, analysis.cut, analysis.forces) =
        (PathLoad::Cuts(found.cuts), Some(cut), Some(found.summary));
    Some(())
}

/// Puts on thrust and torque of a drill.
fn put_drill(
    log: &mut ProblemLog<'_>,
    key: &str,
    drill: drill::DrillCut,
    analysis: &mut PathAnalysis,
) -> Option<()> {
    let (path, placing) = (&analysis.track.path, &analysis.track.placing);
    let found = drill.drill.along(path, placing);
    let missing_hint =
        format!("give feed and spindle speed in the program, or {key} with feed_mm_per_min and spindle_rpm");
    let (load, reported) = found
        .map_err(|error| report_no_forces(log, analysis, &error, &missing_hint))
        .ok()?;
    analysis.setting.uncertainty.relative = reported.relative_uncertainty;
    (analysis.load, analysis.drill, analysis.forces) = (load, Some(drill), Some(reported));
    Some(())
}

/// Reports why there are no forces; `missing_hint` is the hint for a missing feed or spindle speed.
fn report_no_forces(log: &mut ProblemLog<'_>, analysis: &PathAnalysis, error: &NoForces, missing_hint: &str) {
    let hint = match error {
        NoForces::Cut { .. } => {
            "depths are those of the program, or cut.axial_depth_mm and cut.radial_depth_mm"
        }
        _ => missing_hint,
    };
    let message = format!("{}: {error}", analysis.shown());
    match &analysis.source {
        PathSource::Program { .. } => log.problem("program.file", message, hint),
        PathSource::Shape(_) | PathSource::Holes { .. } => log.problem_here(message, hint),
    }
}
