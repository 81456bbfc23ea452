//! What pushes on the tool along a path: given cases, a cut, a drill, or what was measured.
//!
//! The first of these that there is:
//!
//! | order | what pushes | told by |
//! |---|---|---|
//! | 1 | measured forces | `program.measured` of the ask |
//! | 2 | a drill | `program.drill` or `holes.drill` of the ask |
//! | 3 | a cut | `cut` of the ask |
//! | 4 | given cases | `load` of the ask |
//! | 5 | a cut, then given cases | `cut`, then `load` of the study |
//!
//! Holes have a drill or given cases; an ask that is neither has given cases alone. Two things of one ask are refused, but a cut that only predicts where
//! a record begins.

use std::path::Path;

use armill_core::load::PathLoad;
use armill_core::path::NoForces;
use armill_core::watch::Watch;

use super::cut::{self, CutTable};
use super::drill::{self, DrillTable};
use super::measured::{self, MeasuredTable, SynchroniseName};
use super::{PathAnalysis, PathSource};
use crate::StudyError;
use crate::file::analysis::kind_noun;
use crate::file::format::{AnalysisKind, AnalysisTable, LoadTable, StudyFile};
use crate::file::places::Places;

/// What pushes on the tool, as the study tells it.
#[derive(Clone, Copy)]
pub(in crate::file) enum Push<'a> {
    /// Given cases.
    Load(&'a LoadTable),
    /// Forces of a cut.
    Cut(&'a CutTable),
    /// Forces of a drill, by the key of its table.
    Drill(&'static str, &'a DrillTable),
    /// A record, and the cut that predicts it where that is asked for.
    Measured(&'a MeasuredTable, Option<&'a CutTable>),
}

impl<'a> Push<'a> {
    /// What pushes in this ask: what it brings itself, else the cut of the study (along a path), else its load.
    pub fn of(file: &'a StudyFile, analysis: &'a AnalysisTable) -> Option<Push<'a>> {
        if analysis.kind == AnalysisKind::Holes {
            let own = drill(analysis).or(analysis.load.as_ref().map(Push::Load));
            return own.or(file.load.as_ref().map(Push::Load));
        }
        let along = analysis.kind == AnalysisKind::Path;
        let program = analysis.program.as_ref().filter(|_| along);
        let own_cut = analysis.cut.as_ref().filter(|_| along);
        let cut = own_cut.or(file.cut.as_ref().filter(|_| along));
        if let Some(measured) = program.and_then(|program| program.measured.as_ref()) {
            return Some(Push::Measured(measured, cut.filter(|_| measured.is_predicted())));
        }
        let own = drill(analysis).or(own_cut.map(Push::Cut));
        let own = own.or(analysis.load.as_ref().map(Push::Load));
        own.or(cut.map(Push::Cut)).or(file.load.as_ref().map(Push::Load))
    }

    /// Tells an ask that brings two things that push.
    pub fn refuse_two(places: &mut Places<'_>, analysis: &AnalysisTable) {
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
            places.problem(
                key,
                format!("this {} has {first} and {second}", kind_noun(analysis.kind)),
                "remove one",
            );
        }
    }
}

/// The drill of an ask.
fn drill(analysis: &AnalysisTable) -> Option<Push<'_>> {
    let of_program = analysis.program.as_ref().and_then(|program| program.drill.as_ref());
    let of_holes = analysis.holes.as_ref().and_then(|holes| holes.drill.as_ref());
    let of_program = of_program.map(|drill| Push::Drill("program.drill", drill));
    of_program.or(of_holes.map(|drill| Push::Drill("holes.drill", drill)))
}

impl MeasuredTable {
    /// Whether the begin is found by a prediction.
    fn is_predicted(&self) -> bool {
        self.synchronise == Some(SynchroniseName::Predicted)
    }
}

/// Puts what pushes on a path whose load is that of its setting; whether it could, problems are told at their places.
///
/// # Errors
/// The problems of a file of measured forces.
pub(in crate::file) fn put_on(
    places: &mut Places<'_>,
    push: Push<'_>,
    folder: &Path,
    analysis: &mut PathAnalysis,
) -> Result<bool, StudyError> {
    let found = match push {
        Push::Load(_) => Some(()),
        Push::Cut(table) => cut::resolve(places, table).and_then(|cut| put_cut(places, cut, analysis)),
        Push::Drill(key, table) => {
            let drill = drill::resolve(places, (key, table));
            drill.and_then(|drill| put_drill(places, (key, drill), analysis))
        }
        Push::Measured(table, cut) => {
            let predicting = cut.map(|table| cut::resolve(places, table));
            if matches!(predicting, Some(None)) {
                return Ok(false);
            }
            let found = measured::along(places, table, folder, (&analysis.track, predicting.flatten().as_ref()))?;
            found.map(|(load, forces)| {
                analysis.setting.uncertainty.relative = table.u_percent.unwrap_or(0.0) / 100.0;
                (analysis.load, analysis.measured) = (load, Some(Box::new(forces)));
            })
        }
    };
    Ok(found.is_some())
}

/// Puts on the forces of a cut whose engagement is the same everywhere; a stock is cut when the study runs.
fn put_cut(places: &mut Places<'_>, cut: cut::Cut, analysis: &mut PathAnalysis) -> Option<()> {
    let (path, placing) = (&analysis.track.path, &analysis.track.placing);
    let found = cut.cutting.along(path, placing, None, Watch::NONE);
    let untold = "the program tells feed and spindle, or cut.feed_mm_per_min and cut.spindle_rpm do";
    let found = found.map_err(|error| tell(places, analysis, &error, untold)).ok()?;
    analysis.setting.uncertainty.relative = found.reported.relative_uncertainty;
    (analysis.load, analysis.cut, analysis.forces) = (PathLoad::Cuts(found.cuts), Some(cut), Some(found.reported));
    Some(())
}

/// Puts on thrust and torque of a drill.
fn put_drill(
    places: &mut Places<'_>,
    (key, drill): (&str, drill::DrillCut),
    analysis: &mut PathAnalysis,
) -> Option<()> {
    let (path, placing) = (&analysis.track.path, &analysis.track.placing);
    let found = drill.drill.along(path, placing);
    let untold = format!("the program tells feed and spindle, or {key} with feed_mm_per_min and spindle_rpm");
    let (load, reported) = found.map_err(|error| tell(places, analysis, &error, &untold)).ok()?;
    analysis.setting.uncertainty.relative = reported.relative_uncertainty;
    (analysis.load, analysis.drill, analysis.forces) = (load, Some(drill), Some(reported));
    Some(())
}

/// Tells why there are no forces; `untold` helps where feed or spindle are missing.
fn tell(places: &mut Places<'_>, analysis: &PathAnalysis, error: &NoForces, untold: &str) {
    let hint = match error {
        NoForces::Cut { .. } => {
            "depths are those of the program, or cut.axial_depth_mm and cut.radial_depth_mm"
        }
        _ => untold,
    };
    let message = format!("{}: {error}", analysis.shown());
    match &analysis.source {
        PathSource::Program { .. } => places.problem("program.file", message, hint),
        PathSource::Shape(_) | PathSource::Holes { .. } => places.problem_here(message, hint),
    }
}
