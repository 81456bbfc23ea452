//! The clearance of a path at a placement: the points that a branch loses because the arm does not keep it there.
//!
//! Some points, spread over the path, are checked first, so that most placements in collision are given up after a few postures.
//! The others are near them: most of these are decided by the bounds of [`ClearanceAlong`], without a measurement.

use nalgebra::{UnitQuaternion, Vector3};

use super::path::PlacedPath;
use crate::clearance::ClearanceAlong;
use crate::frame::Isometry;
use crate::kernel::column::{Column, Columns, PostureStatus, SLOTS};
use crate::kernel::lanes::{BranchMargins, BranchStatus, LoadedBranches, POINTS, PointLoads};
use crate::kernel::path_on_part::{PartPlacement, PostureMargins, SpunPlacement};
use crate::kernel::question::Question;
use crate::robot::Branch;
use crate::spatial::Wrench;

/// Every so many points one is checked before the others.
const STRIDE: usize = 16;

/// Counts the points of a path that are lost at a placement; one per thread. For arms with named branches.
pub struct PlacementClearance<'q> {
    clearance: ClearanceAlong<'q>,
    /// For arms that lanes know.
    lanes: Option<(LoadedBranches, PointLoads)>,
    columns: Columns<'q>,
    column: Column,
    poses: Vec<Isometry>,
    joints: Vec<f64>,
}

/// A branch along a path at a placement.
#[derive(Clone, Copy, Debug)]
pub struct PlacedBranch<'a> {
    /// The path.
    pub path: &'a PlacedPath,
    /// The placement.
    pub placement: &'a PartPlacement,
    /// The branch.
    pub branch: Branch,
}

impl<'q> PlacementClearance<'q> {
    /// For the arm of `question`; `None` if it demands no clearance, or its branches have no names.
    pub fn new(question: &Question<'q>, margins: PostureMargins) -> Option<PlacementClearance<'q>> {
        let check = question.clearance_check()?;
        let (arm, home) = (question.arm, question.home);
        if !arm.robot.inverse().has_branches() {
            return None;
        }
        let kept = BranchMargins {
            wrist: margins.wrist,
            limits: margins.margin,
        };
        let mut loads = PointLoads::new();
        for i in 0..POINTS {
            loads.set(i, std::iter::once(Wrench::ZERO), &[Vector3::zeros(); 2]);
        }
        Some(PlacementClearance {
            clearance: ClearanceAlong::new(check),
            lanes: LoadedBranches::of(&Question::unloaded(arm, home), kept, false)
                .map(|lanes| (lanes, loads)),
            columns: Columns::whole(arm, home, [margins.wrist, margins.margin]),
            column: Column::default(),
            poses: Vec::with_capacity(POINTS),
            joints: Vec::new(),
        })
    }

    /// Points of the path where the branch cannot be used or does not keep the demanded clearance. If there are more than `most`, a number
    /// above it, not above that of all.
    pub fn lost(&mut self, placed: PlacedBranch<'_>, most: usize) -> usize {
        let PlacedBranch { path, placement, .. } = placed;
        self.clearance.set_part(&placement.base_from_part);
        self.columns.set_rail(placement.rail);
        if let Some((lanes, _)) = &mut self.lanes {
            lanes.set_home(self.columns.home());
        }
        let first = (STRIDE / 2..path.len()).step_by(STRIDE);
        let others = (0..path.len()).filter(|index| index % STRIDE != STRIDE / 2);
        let order: Vec<usize> = first.chain(others).collect();
        let mut lost = 0;
        for indices in order.chunks(POINTS) {
            lost += self.lost_of(placed, indices, most.saturating_sub(lost));
            if lost > most {
                break;
            }
        }
        lost
    }

    /// The same of these points, at most a block.
    fn lost_of(&mut self, placed: PlacedBranch<'_>, indices: &[usize], most: usize) -> usize {
        let PlacedBranch {
            path,
            placement,
            branch,
        } = placed;
        let spun = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin);
        if let Some((lanes, loads)) = &mut self.lanes {
            self.poses.clear();
            let pose = |index: &usize| placement.base_from_part * path.points[*index].part_from_tool * spun;
            self.poses.extend(indices.iter().map(pose));
            lanes.aim_at(&self.poses, loads);
            lanes.solve(branch, loads);
        }
        let mut lost = 0;
        for (i, index) in indices.iter().enumerate() {
            let decided = self.lanes.as_ref().map(|(lanes, _)| (lanes, lanes.status(i)));
            let usable = match decided {
                None | Some((_, BranchStatus::Undecided)) => self.one_by_one(placed, *index),
                Some((lanes, BranchStatus::Usable)) => {
                    self.joints.clear();
                    self.joints.extend(lanes.joints(i));
                    true
                }
                Some(_) => false,
            };
            lost += usize::from(!usable || !self.clearance.is_kept(&self.joints));
            if lost > most {
                break;
            }
        }
        lost
    }

    /// Whether the branch can be used at this point; its joint positions are then known.
    fn one_by_one(&mut self, placed: PlacedBranch<'_>, index: usize) -> bool {
        let PlacementClearance {
            columns,
            column,
            joints,
            ..
        } = self;
        let unspun = SpunPlacement {
            placement: placed.placement,
            spins: &[0.0],
        };
        placed.path.fill_column(columns, index, unspun, column);
        let slot = Branch::ALL.iter().position(|branch| *branch == placed.branch);
        let usable = slot.filter(|slot| *slot < SLOTS && column.statuses[*slot] == PostureStatus::Usable);
        if let Some(slot) = usable {
            joints.clear();
            joints.extend_from_slice(column.joints_of(slot, columns.robot().joints().len()));
        }
        usable.is_some()
    }
}
