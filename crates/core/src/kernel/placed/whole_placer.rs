//! A path on a part at a placement, by the whole model in lanes: blocks of points, each with its own load.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use super::path::{PathTotals, PlacedPath};
use crate::frame::Isometry;
use crate::kernel::column::{Column, Columns, SLOTS};
use crate::kernel::lanes::{BranchMargins, BranchStatus, LoadedBranches, POINTS, PointLoads};
use crate::kernel::path_on_part::{PartPlacement, PostureMargins, SpunPlacement};
use crate::kernel::question::Question;
use crate::robot::Branch;
use crate::source::Arm;

/// Evaluates placements of arms with named branches; one per thread.
pub(super) struct WholePlacer {
    lanes: LoadedBranches,
    loads: PointLoads,
    poses: Vec<Isometry>,
    tolerance: f64,
}

/// A path at a placement of its part.
#[derive(Clone, Copy)]
pub(super) struct Placed<'a> {
    pub path: &'a PlacedPath,
    pub placement: &'a PartPlacement,
}

impl WholePlacer {
    /// For this arm under load and gravity; none if lanes do not know it.
    pub fn of(arm: Arm<'_>, home: Option<&[f64]>, margins: &PostureMargins) -> Option<WholePlacer> {
        let kept = BranchMargins {
            wrist: margins.wrist,
            limits: margins.margin,
        };
        Some(WholePlacer {
            lanes: LoadedBranches::of(&Question::unloaded(arm, home), kept, false)?,
            loads: PointLoads::new(),
            poses: Vec::with_capacity(POINTS),
            tolerance: margins.tolerance,
        })
    }

    /// Totals of each open branch over the points of `path`; a branch is given up as soon as `keep` returns false for
    /// its totals so far. `rest` computes the points that lanes cannot
    /// decide, and has the rail where it is.
    pub fn evaluate(
        &mut self,
        placed: Placed<'_>,
        mut open: [bool; SLOTS],
        rest: &mut Columns<'_>,
        mut keep: impl FnMut(&PathTotals) -> bool,
    ) -> [Option<PathTotals>; SLOTS] {
        let path = placed.path;
        self.lanes.set_home(rest.home());
        let mut totals = [PathTotals::default(); SLOTS];
        for first in (0..path.len()).step_by(POINTS) {
            let last = path.len().min(first + POINTS);
            self.place(placed, first..last);
            // Of each undecided point: the deviations of all its branches.
            let mut decided: [Option<[f64; SLOTS]>; POINTS] = [None; POINTS];
            for (slot, branch) in Branch::ALL
                .into_iter()
                .enumerate()
                .filter(|(slot, _)| open[*slot])
            {
                self.lanes.solve(branch, &self.loads);
                for (i, decided) in decided.iter_mut().enumerate().take(last - first) {
                    let deviation = match self.lanes.status(i) {
                        BranchStatus::Usable => self.lanes.deviation(i),
                        BranchStatus::Undecided => {
                            let one_by_one = || deviations_at(placed, first + i, rest);
                            decided.get_or_insert_with(one_by_one)[slot]
                        }
                        _ => f64::INFINITY,
                    };
                    totals[slot].take(deviation, self.tolerance);
                }
            }
            for (open, totals) in open.iter_mut().zip(&totals) {
                *open = *open && keep(totals);
            }
            if open == [false; SLOTS] {
                break;
            }
        }
        std::array::from_fn(|slot| open[slot].then_some(totals[slot]))
    }

    /// Sets poses and loads of these points.
    fn place(&mut self, placed: Placed<'_>, points: Range<usize>) {
        let Placed { path, placement } = placed;
        let spun = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin);
        self.poses.clear();
        for (i, index) in points.enumerate() {
            let point = &path.points[index];
            self.poses
                .push(placement.base_from_part * point.part_from_tool * spun);
            let along = point.along.map(|along| placement.base_from_part * along);
            self.loads.set(i, path.wrenches_at(index, placement), &along);
        }
        self.lanes.aim_at(&self.poses, &self.loads);
    }
}

/// The deviations of all branches at point `index`, infinite where a branch cannot be used, m.
fn deviations_at(placed: Placed<'_>, index: usize, rest: &mut Columns<'_>) -> [f64; SLOTS] {
    let Placed { path, placement } = placed;
    let unspun = SpunPlacement {
        placement,
        spins: &[0.0],
    };
    let mut column = Column::default();
    path.fill_column(rest, index, unspun, &mut column);
    std::array::from_fn(|slot| column.deviations[slot])
}
