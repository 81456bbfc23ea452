//! Search for the postures along a path: spin of the tool and branch, point after point, and where permitted the lean of
//! the tool and the positions of external axes.
//!
//! At each point the tool may be turned about its own axis and lean from the programmed one, external axes may move, and
//! each such setting has several postures: a lattice of path x setting x posture. Of all chains that meet the limits, the
//! one with the lowest deviation is used, as specified by [`Objective`](super::Objective) (`chain`). With lean or external axes the lattice
//! is refined step by step near the best chain so far (`refined`).
//!
//! | limit | how it is met |
//! |---|---|
//! | joint range | a posture outside, or nearer to a limit than the margin, is not usable |
//! | singularities | a posture near a stretched arm, or with a wrist bend below the limit, is not usable |
//! | joint speed at the feed | from point to point, and for the turn of the tool |
//! | a jump | no joint turns by half a radian between neighbouring points |
//! | whole turns | a joint that turns more than once stays within its range over a whole cut |
//! | external axis | limited per metre of the path, or still within a cut; its speed limit |
//! | turn and lean of the tool | limited per metre of the path, in steps; then smoothed, at most half a step away. Where a smoothed turn is nearer to a limit than the margin, or a body nearer to another than demanded, the search is repeated with a greater margin or clearance |
//! | clearance | a posture in which two bodies, or a body and the stock as it is at the point, are nearer than demanded is not usable |
//!
//! Where a joint reverses, its backlash leaves a mark on the part. With a price on reversals
//! ([`PostureSearch::back_price`]) a second chain with fewer reversals is computed. The one with the lower sum of
//! lattice cost and price is used. Reversals are counted after the steps of the lattice have been smoothed.
//!
//! The branch changes only between cuts. The chain is the best of the lattice, not of all turns between its steps;
//! forces are those of the nominal path, of a cut with the tool leaning as in the setting. Both are recomputed when the path is evaluated with the result
//! ([`crate::map::along_postures`]).

use super::freedoms::MOST_MOVING;
use super::lost::Lost;
use super::posture_search::{PostureFound, PostureSearch, SearchedPath};
use super::refined::refined;
use crate::kernel::{AT_LIMIT, Question};
use crate::map::{along_postures, exclude_points_near_stock, obstacles};
use crate::path::LoadedTrack;
use crate::watch::{Cancelled, Watch};

/// Least increase of a clearance that was not kept after smoothing, m.
const LEAST_MORE: f64 = 1e-3;

/// The best postures along `path` for these settings. Cases, normal, uncertainty and choice of `question`
/// are not used.
///
/// Memory: one byte for each point x spin x posture, and a hundred times that for each of about a hundred points; with
/// lean or external axes four bytes.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// If the load does not [cover](crate::load::PathLoad::covers) the points of the track, there is no spin, or more
/// than [`MOST_MOVING`] external axes move.
pub fn postures_along(
    question: &Question<'_>,
    path: LoadedTrack<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    postures_in_stock(question, SearchedPath::new(path, None), search, watch)
}

/// [`postures_along`] of a path whose stock is a body too, as it is at each point: at most 200 MB in addition for copies
/// of its map, or one copy.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
///
/// # Panics
/// Those of [`postures_along`].
pub fn postures_in_stock(
    question: &Question<'_>,
    mut path: SearchedPath<'_>,
    search: &PostureSearch,
    watch: Watch<'_>,
) -> Result<PostureFound, Cancelled> {
    // Another spin, as after smoothing, does not move them: they need no more than is demanded.
    path.least_of_round = question
        .clearance
        .filter(|_| search.is_of_spins())
        .map(|demanded| demanded.least);
    let LoadedTrack { track, load } = path.loaded;
    assert!(load.covers(track.len()), "a load for each point of the track");
    assert!(search.spins.count > 0, "at least one spin");
    assert!(search.axes.len() <= MOST_MOVING, "too many external axes");
    let mut search = search.clone();
    let margin = search.margin;
    let mut of_lattice = *question;
    let rounds = if question.clearance.is_some() || !search.is_of_spins() {
        5
    } else {
        3
    };
    let quiet = Watch {
        finished: &|_| (),
        ..watch
    };
    let mut best: Option<(usize, PostureFound)> = None;
    for _ in 0..rounds {
        let found = refined(&of_lattice, path, &search, watch)?;
        let turned = found.turned(track);
        let mut along = along_postures(question, &turned, found.load(load), found.choices(), watch)?;
        if let Some(stock) = path.stock {
            exclude_points_near_stock(question, stock, &mut along, quiet)?;
        }
        let rooms = along
            .answers
            .evaluations()
            .map(|(index, here)| (index, here.limit_margin));
        let usable = |index: usize| {
            found
                .unreachable
                .binary_search_by_key(&index, |(lost, _)| *lost)
                .is_err()
        };
        let least = rooms
            .filter(|(index, _)| usable(*index))
            .map(|(_, room)| room)
            .fold(f64::INFINITY, f64::min);
        let missing = along.answers.missing_clearance(usable);
        let obstacles = obstacles(question.arm.robot, &track.path, &along.answers, margin - AT_LIMIT);
        let lost = Lost::of(obstacles.filter(|at| usable(at.index) && !found.breaks.contains(&at.index)));
        let keeps = least >= margin - AT_LIMIT && missing.is_none();
        let is_refined = !search.is_of_spins();
        let is_lost = is_refined && lost.by_smoothing > 0;
        let stops = is_refined && !found.breaks.is_empty();
        let all_lost = lost.all + found.breaks.len() + found.unreachable.len();
        if best.as_ref().is_none_or(|(least, _)| all_lost <= *least) {
            best = Some((all_lost, found));
        }
        // More margin and clearance than demanded may lose more points than smoothing did.
        if keeps && !is_lost && !stops {
            break;
        }
        if is_lost {
            search = search.finer();
        }
        // A chain of large steps with sudden motions is not followed by one of small steps.
        if stops {
            search = search.calmer();
        }
        // By smoothing a joint is this much nearer to a limit, and a body to another, than in the lattice.
        search.margin += 1.5 * (margin - least).max(0.0);
        if let (Some(demanded), Some(missing)) = (&mut of_lattice.clearance, missing) {
            demanded.least += 1.5 * missing + LEAST_MORE;
        }
    }
    Ok(best.expect("at least one round").1)
}

#[cfg(test)]
pub(super) mod tests;
