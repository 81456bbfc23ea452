//! The lines of equal deviation of a map, in the coordinates of its grid.

use armill_core::marching_squares::ScalarField;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::map::answer::MapAnswer;
use crate::number::decimals;

/// A level at the tolerance, within this (um), has no lines of its own.
const COINCIDES_UM: f64 = 1e-6;

/// Lines of equal in-plane deviation on a map.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LinesAnswer {
    /// Where it equals the tolerance: y', z' along each line; closed lines repeat their first point.
    pub tolerance_mm: Vec<Vec<[f64; 2]>>,
    /// Lines at the levels of the colour scale; levels without a line and one at the tolerance are left out.
    pub levels: Vec<LevelAnswer>,
}

/// Lines at one level.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LevelAnswer {
    /// The deviation along them.
    pub level_um: f64,
    /// y', z' along each line; closed lines repeat their first point.
    pub lines_mm: Vec<Vec<[f64; 2]>>,
}

impl LinesAnswer {
    /// The lines of this map, at its tolerance and at these levels.
    pub(super) fn of(map: &MapAnswer, levels_um: &[f64]) -> LinesAnswer {
        let field = ScalarField {
            x: &map.grid.y_mm,
            y: &map.grid.z_mm,
            values: &map.grid.in_plane_um,
        };
        let lines_at = |level: f64| -> Vec<Vec<[f64; 2]>> {
            let lines = field.lines_at(level).into_iter();
            lines.map(|line| line.into_iter().map(short).collect()).collect()
        };
        let tolerance_um = map.setting.tolerance_um;
        let apart = levels_um
            .par_iter()
            .filter(|level| (**level - tolerance_um).abs() > COINCIDES_UM);
        let levels = apart.map(|level| LevelAnswer {
            level_um: *level,
            lines_mm: lines_at(*level),
        });
        LinesAnswer {
            tolerance_mm: lines_at(tolerance_um),
            levels: levels.filter(|level| !level.lines_mm.is_empty()).collect(),
        }
    }
}

/// A point to a micrometre.
pub(super) fn short(at: [f64; 2]) -> [f64; 2] {
    at.map(|mm| decimals(mm, 3))
}
