//! The deviation along a path for each of several constant spins of the tool.
//!
//! A row of the map is the answer of [`along_path`] with the tool turned by one spin at all points: with the branch that is
//! followed then, and with forces, backlash and geometry as there. Its columns are points of the path.
//!
//! A path is evaluated at all its points. Where path and spins have more than [`MOST_EVALUATED`] of them, only the points of
//! the columns are, each with the point before it. Deviations are the same, except for links that friction keeps (they
//! depend on all the motion before); whole turns and jumps are then known at these points only.

use rayon::prelude::*;

use super::along::along_path;
use super::obstacles::{ObstacleKind, obstacles};
use crate::kernel::{Evaluation, Question};
use crate::path::LoadedTrack;
use crate::robot::Unreachable;
use crate::watch::{Cancelled, Watch};

/// Points of all rows that are evaluated at most where every point of the path is.
pub const MOST_EVALUATED: usize = 300_000;

/// The deviation over points of a path and spins of the tool.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinMap {
    /// Indices of the points of the columns, ascending; the first and the last point are among them.
    pub points: Vec<usize>,
    /// Spin after spin, each column after column.
    pub cells: Vec<SpinCell>,
    /// Whether every point of the path was evaluated.
    pub is_complete: bool,
}

/// A point of a path at a spin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinCell {
    /// The answer; `None` where the point has no posture.
    pub evaluation: Option<Evaluation>,
    /// Whether no posture there keeps the demanded clearance.
    pub in_collision: bool,
    /// The first obstacle of the moves since the column before: a joint that jumps, or one too slow for the feed.
    pub on_move: Option<ObstacleKind>,
}

impl SpinMap {
    /// The cell of spin number `row` and column `column`.
    pub fn cell(&self, row: usize, column: usize) -> &SpinCell {
        &self.cells[row * self.points.len() + column]
    }
}

/// The map of `path` for these `spins` (rad), each in addition to the spin of the track, at `columns` points or fewer.
/// Cases and normal of `question` are not used, as in [`along_path`].
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](crate::load::PathLoad::covers) the points of the track.
pub fn spin_map(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    spins: &[f64],
    columns: usize,
    watch: Watch<'_>,
) -> Result<SpinMap, Cancelled> {
    let count = path.track.len();
    let points = spread(count, columns);
    let is_complete = count.saturating_mul(spins.len()) <= MOST_EVALUATED;
    let evaluated = match is_complete {
        true => (0..count).collect(),
        false => with_points_before(&points),
    };
    let (track, load) = match is_complete {
        true => (path.track.clone(), path.load.clone()),
        false => (path.track.at_points(&evaluated), path.load.at_points(&evaluated)),
    };
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let row = |spin: &f64| -> Result<Vec<SpinCell>, Cancelled> {
        let turned = track.spun(*spin);
        let along = along_path(question, &turned, load.clone(), quiet)?;
        let at = |point: &usize| {
            let index = evaluated.partition_point(|other| other < point);
            let found = along.answers.points[index];
            SpinCell {
                evaluation: found.ok(),
                in_collision: matches!(found, Err(Unreachable::InCollision { .. })),
                on_move: None,
            }
        };
        let mut cells: Vec<SpinCell> = points.iter().map(at).collect();
        for obstacle in obstacles(question.arm.robot, &turned.path, &along.answers, 0.0) {
            let here = evaluated[obstacle.index];
            let follows = obstacle.index > 0 && evaluated[obstacle.index - 1] + 1 == here;
            let is_move = matches!(
                obstacle.kind,
                ObstacleKind::Jump { .. } | ObstacleKind::TooSlow { .. }
            );
            let column = points.partition_point(|point| *point < here);
            if is_move && follows {
                cells[column].on_move.get_or_insert(obstacle.kind);
            }
        }
        Ok(cells)
    };
    let rows: Vec<Vec<SpinCell>> = spins.par_iter().map(row).collect::<Result<_, _>>()?;
    Ok(SpinMap {
        points,
        cells: rows.concat(),
        is_complete,
    })
}

/// `most` of `count` indices, or all, evenly spread from the first to the last.
fn spread(count: usize, most: usize) -> Vec<usize> {
    let kept = count.min(most.max(2));
    (0..kept)
        .map(|column| column * (count - 1) / (kept - 1).max(1))
        .collect()
}

/// These indices, each after the one before it; ascending, once each.
fn with_points_before(points: &[usize]) -> Vec<usize> {
    let mut all: Vec<usize> = points
        .iter()
        .flat_map(|point| [point.saturating_sub(1), *point])
        .collect();
    all.dedup();
    all
}

#[cfg(test)]
mod tests;
