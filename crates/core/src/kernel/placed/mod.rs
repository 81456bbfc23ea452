//! A path on a part, evaluated at a placement of the part: called tens of thousands of times by a placement search.
//!
//! The points, the directions of the deviation and the wrenches are given once, relative to the part. A placement
//! ([`PartPlacement`]) then specifies the pose of the part and the spin of the tool. Each posture of the arm is
//! evaluated over all points ([`PathTotals`]).
//!
//! Arms with named branches go through lanes: ortho-parallel ones whose only springs are the drives without any angle,
//! the others by the whole model (`whole_placer`). Any other arm is computed one pose after the other. All agree to
//! rounding (`tests`).
//!
//! `path`: the points; `whole_placer`: the whole model in lanes; [`clear`]: the clearance there.

mod clear;
mod path;
mod whole_placer;

pub use clear::{PlacedBranch, PlacementClearance};
pub use path::{PathTotals, PlacedPath};

use super::column::{Column, Columns, PostureStatus, SLOTS};
use super::lanes::{PlacementPoints, Placer, Precision, Tallied};
use super::path_on_part::{PartPlacement, PostureMargins, SpunPlacement};
use super::question::Question;
use crate::clearance::ClearanceCheck;
use crate::robot::{Branch, BranchPattern};
use crate::source::Arm;
use whole_placer::{Placed, WholePlacer};

/// Evaluates placements; one per thread.
pub struct PlacementEvaluator<'q> {
    margins: PostureMargins,
    method: PlacementMethod<'q>,
}

/// By lanes or one after the other.
enum PlacementMethod<'q> {
    Lanes(Box<Placer<f64>>),
    General(Box<GeneralPlacer<'q>>),
}

/// Evaluates placements by the whole model.
struct GeneralPlacer<'q> {
    columns: Columns<'q>,
    /// For arms that lanes know.
    lanes: Option<WholePlacer>,
    /// The excess of deviations over it is summed, m.
    tolerance: f64,
}

impl<'q> PlacementEvaluator<'q> {
    /// For this arm. `home`: see [`Question::home`].
    pub fn new(arm: Arm<'q>, home: Option<&'q [f64]>, margins: PostureMargins) -> PlacementEvaluator<'q> {
        let question = Question::unloaded(arm, home);
        let lanes = arm.robot.ortho_parallel().filter(|_| arm.model.is_drives_alone());
        PlacementEvaluator {
            margins,
            method: match lanes {
                Some(form) => PlacementMethod::Lanes(Box::new(Placer::new(&question, form, &margins))),
                None => PlacementEvaluator::general(arm, home, margins),
            },
        }
    }

    /// Without the postures that do not pass this check; [`PlacementEvaluator::evaluate_each`] alone.
    pub(crate) fn keeping_clear(
        self,
        arm: Arm<'q>,
        home: Option<&'q [f64]>,
        clearance: Option<ClearanceCheck<'q>>,
    ) -> PlacementEvaluator<'q> {
        if clearance.is_none() {
            return self;
        }
        let columns = Columns::whole(arm, home, [self.margins.wrist, self.margins.margin]);
        PlacementEvaluator {
            margins: self.margins,
            method: PlacementMethod::General(Box::new(GeneralPlacer {
                columns: columns.keeping_clear(clearance),
                lanes: None,
                tolerance: self.margins.tolerance,
            })),
        }
    }

    fn general(arm: Arm<'q>, home: Option<&'q [f64]>, margins: PostureMargins) -> PlacementMethod<'q> {
        PlacementMethod::General(Box::new(GeneralPlacer {
            columns: Columns::whole(arm, home, [margins.wrist, margins.margin]),
            lanes: WholePlacer::of(arm, home, &margins),
            tolerance: margins.tolerance,
        }))
    }

    /// Whether the eight results are branches, in the order of [`Branch::ALL`]. For other arms only the first one is
    /// valid: the best posture at each point.
    pub fn has_branches(&self) -> bool {
        match &self.method {
            PlacementMethod::Lanes(_) => true,
            PlacementMethod::General(placer) => placer.columns.slots_are_branches(),
        }
    }

    /// Totals of each posture over the points of `path` at this placement. Branches outside `open` are skipped. A
    /// branch is given up as soon as `keep` returns false for its totals so far.
    pub fn evaluate(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        open: BranchPattern,
        keep: impl FnMut(&PathTotals) -> bool,
    ) -> [Option<PathTotals>; SLOTS] {
        let is_open = slots_of(open);
        match &mut self.method {
            PlacementMethod::Lanes(placer) => by_lanes(placer, &path.double, placement, is_open, keep),
            PlacementMethod::General(placer) => placer.evaluate(path, placement, is_open, keep),
        }
    }
}

impl PlacementEvaluator<'_> {
    /// Totals of the points of `path` at this placement where each point uses its best spin (rad, in addition to that
    /// of the placement) and its best open branch.
    pub fn evaluate_each(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        open: BranchPattern,
        spins: &[f64],
    ) -> PathTotals {
        let is_open = slots_of(open);
        let tried = SpunPlacement { placement, spins };
        let mut least = Vec::with_capacity(path.len());
        match &mut self.method {
            PlacementMethod::Lanes(placer) => {
                placer.least_of_each(&path.double, tried, is_open, &mut least);
            }
            PlacementMethod::General(placer) => {
                let columns = &mut placer.columns;
                let named = columns.slots_are_branches();
                let mut column = Column::default();
                columns.set_rail(placement.rail);
                columns.set_part(&placement.base_from_part);
                for index in 0..path.len() {
                    path.fill_column(columns, index, tried, &mut column);
                    let allowed = |slot: usize| !named || is_open[slot % SLOTS];
                    let all = column.deviations.iter().enumerate();
                    let open = all
                        .filter(|(slot, _)| allowed(*slot))
                        .map(|(_, deviation)| *deviation);
                    least.push(open.fold(f64::INFINITY, f64::min));
                }
            }
        }
        let mut totals = PathTotals::default();
        for deviation in least {
            totals.take(deviation, self.margins.tolerance);
        }
        totals
    }
}

/// Screens placements in half the time; one per thread. It can only prove that a placement is not better than required.
///
/// In single precision with widened limits: it accepts points just outside them, and deviations have an error of at
/// most [`PlacementScreen::rounding_error`].
pub struct PlacementScreen(Box<Placer<f32>>);

impl PlacementScreen {
    /// For this arm; `None` where lanes do not support it.
    pub fn new(arm: Arm<'_>, margins: PostureMargins) -> Option<PlacementScreen> {
        let form = arm
            .robot
            .ortho_parallel()
            .filter(|_| arm.model.is_drives_alone())?;
        let question = Question::unloaded(arm, None);
        Some(PlacementScreen(Box::new(Placer::generous(
            &question, form, &margins,
        ))))
    }

    /// Largest error of the deviations along `path`, m.
    pub fn rounding_error(&self, path: &PlacedPath) -> f64 {
        self.0.rounding_error(&path.single)
    }

    /// Whether an open branch may pass `keep`. The exact totals have at least as many unreachable points, and their
    /// deviations are at most [`PlacementScreen::rounding_error`] below those given to `keep`.
    pub fn may_pass(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        open: BranchPattern,
        keep: impl FnMut(&PathTotals) -> bool,
    ) -> bool {
        let totals = by_lanes(&mut self.0, &path.single, placement, slots_of(open), keep);
        totals.iter().any(Option::is_some)
    }
}

/// Which of the eight branches are open.
fn slots_of(open: BranchPattern) -> [bool; SLOTS] {
    std::array::from_fn(|slot| open.matches(Branch::ALL[slot]))
}

/// [`PlacementEvaluator::evaluate`] by lanes.
fn by_lanes<T: Precision>(
    placer: &mut Placer<T>,
    points: &PlacementPoints<T>,
    placement: &PartPlacement,
    open: [bool; SLOTS],
    mut keep: impl FnMut(&PathTotals) -> bool,
) -> [Option<PathTotals>; SLOTS] {
    let totals = |tallied: &Tallied, flip: usize| PathTotals {
        unreachable: tallied.unreachable[flip],
        worst: tallied.worst,
        sum: tallied.sum,
        above: tallied.above,
    };
    let mut dropped = [false; SLOTS];
    let tallied = placer.evaluate(points, placement, |four, tallied| {
        let mut any = false;
        for flip in 0..2 {
            let slot = 2 * four + flip;
            let open = open[slot] && !dropped[slot] && keep(&totals(tallied, flip));
            dropped[slot] = !open;
            any |= open;
        }
        any
    });
    std::array::from_fn(|slot| (!dropped[slot]).then(|| totals(&tallied[slot / 2], slot % 2)))
}

/// Points between two calls of `keep`.
const SOME: usize = 20;

impl GeneralPlacer<'_> {
    /// [`PlacementEvaluator::evaluate`] one pose after the other.
    fn evaluate(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        mut open: [bool; SLOTS],
        mut keep: impl FnMut(&PathTotals) -> bool,
    ) -> [Option<PathTotals>; SLOTS] {
        let GeneralPlacer {
            columns,
            lanes,
            tolerance,
        } = self;
        columns.set_rail(placement.rail);
        if let Some(lanes) = lanes {
            return lanes.evaluate(Placed { path, placement }, open, columns, keep);
        }
        let named = columns.slots_are_branches();
        if !named {
            // A single result: the best posture at each point.
            open = std::array::from_fn(|slot| slot == 0);
        }
        let unspun = SpunPlacement {
            placement,
            spins: &[0.0],
        };
        let mut totals = [PathTotals::default(); SLOTS];
        let mut column = Column::default();
        for index in 0..path.len() {
            path.fill_column(columns, index, unspun, &mut column);
            let best = || column.deviations.iter().copied().fold(f64::INFINITY, f64::min);
            for (slot, totals) in totals.iter_mut().enumerate().filter(|(slot, _)| open[*slot]) {
                let deviation = match named {
                    true => column.deviations[slot],
                    false => best(),
                };
                debug_assert!(
                    !named || deviation.is_finite() == (column.statuses[slot] == PostureStatus::Usable)
                );
                totals.take(deviation, *tolerance);
            }
            if (index + 1) % SOME == 0 {
                for (open, totals) in open.iter_mut().zip(&totals) {
                    *open = *open && keep(totals);
                }
                if open == [false; SLOTS] {
                    break;
                }
            }
        }
        std::array::from_fn(|slot| open[slot].then_some(totals[slot]))
    }
}

#[cfg(test)]
mod tests;
