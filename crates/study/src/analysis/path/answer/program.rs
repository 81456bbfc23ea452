//! The data of a path that is given by a program.

use armill_core::path::Operation;
use armill_core::units::to_um;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::run::PathResult;
use crate::analysis::path::{PathAnalysis, PathSource};

/// The program of a path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ProgramAnswer {
    /// Its file, as named in the study.
    pub file: String,
    /// The format it is in.
    pub format: &'static str,
    /// Moves, rapids included.
    pub moves: usize,
    /// Time of the cuts with a known feed.
    pub cutting_time_s: f64,
    /// Stretches with the same tool and spindle speed.
    pub operations: Vec<OperationAnswer>,
}

/// A stretch with the same tool and spindle speed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OperationAnswer {
    /// Its name in the program.
    pub name: Option<String>,
    /// Number of its tool.
    pub tool: Option<u32>,
    /// First line.
    pub line: u32,
    /// Its points.
    pub points: usize,
    /// Largest in-plane deviation.
    pub max_in_plane_um: Option<f64>,
}

impl ProgramAnswer {
    /// `None` of a shape.
    pub fn of(analysis: &PathAnalysis, found: &PathResult) -> Option<ProgramAnswer> {
        let PathSource::Program { file, summary, .. } = &analysis.source else {
            return None;
        };
        Some(ProgramAnswer {
            file: file.clone(),
            format: summary.format.name(),
            moves: analysis.track.path.moves,
            cutting_time_s: analysis.track.path.cutting_time,
            operations: operations(analysis, found),
        })
    }
}

/// Each operation from its first point to the first of the next; those without a point are left out.
fn operations(analysis: &PathAnalysis, found: &PathResult) -> Vec<OperationAnswer> {
    let (all, points) = (&analysis.track.path.operations, &found.along.answers.points);
    let of = |(i, (first, operation)): (usize, &(usize, Operation))| {
        let end = all.get(i + 1).map_or(points.len(), |next| next.0);
        let points = &points[*first..end];
        let largest = points
            .iter()
            .flatten()
            .map(|evaluation| to_um(evaluation.in_plane));
        OperationAnswer {
            name: operation.name.clone(),
            tool: operation.tool,
            line: operation.line,
            points: points.len(),
            max_in_plane_um: largest.max_by(f64::total_cmp),
        }
    };
    let given = all.iter().enumerate().map(of);
    given.filter(|operation| operation.points > 0).collect()
}

/// What was skipped in the program.
pub fn notes(analysis: &PathAnalysis) -> Vec<String> {
    match &analysis.source {
        PathSource::Program { summary, .. } => summary.notes.clone(),
        PathSource::Shape(_) | PathSource::Holes { .. } => Vec::new(),
    }
}
