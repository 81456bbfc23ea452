//! The in-plane deviation along a path, short enough for a chart.

use armill_core::kernel::Answers;
use armill_core::units::to_um;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::point_groups::PointGroups;

/// Deviation over distance.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// Distance along the path.
    pub position_mm: Vec<f64>,
    /// Deviation; NaN at unreachable points.
    pub in_plane_um: Vec<f64>,
}

impl Curve {
    /// Along this path.
    pub(super) fn along(analysis: &PathAnalysis, answers: &Answers) -> Curve {
        let points = &analysis.track.path.points;
        let handfuls = PointGroups::of(points.len());
        let in_plane = |i: usize| match &answers.points[i] {
            Ok(evaluation) => to_um(evaluation.in_plane),
            Err(_) => f64::NAN,
        };
        Curve {
            position_mm: handfuls.positions_mm(points),
            in_plane_um: handfuls.largest(in_plane),
        }
    }
}
