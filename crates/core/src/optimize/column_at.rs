//! The column of a point of a path: every posture at every setting that is tried there.

use nalgebra::{UnitQuaternion, Vector3};

use super::freedoms::LeanRange;
use super::ground_spin::GroundSpin;
use super::posture_search::PostureSearch;
use super::window::Window;
use crate::frame::Isometry;
use crate::kernel::{Column, ColumnLoad, Columns, PostureStatus};
use crate::load::LeaningForces;
use crate::path::{Lean, LoadedStop, LoadedTrack, RoundedEnd};
use crate::robot::{Branch, BranchPattern};

/// The end of a tool that does not lean.
const ANY_END: RoundedEnd = RoundedEnd {
    radius: 0.0,
    corner: 0.0,
};

/// Fills `column` with the postures of point `index` of `path`, at every setting of `window`; `forces` are those
/// of its load with the tool leaning.
pub(super) fn fill(
    (maker, forces): (&mut Columns<'_>, &LeaningForces),
    path: LoadedTrack<'_>,
    index: usize,
    (search, window): (&PostureSearch, &Window),
    column: &mut Column,
) {
    let grid = window.grid();
    let spins = window.tried(0, index);
    let end = search.lean.map_or(ANY_END, |LeanRange { end, .. }| end);
    let normal = path.track.stop(index).normal;
    let along = search.component.along(path.track, index, normal);
    let mut part = Column::default();
    column.clear(0, 0);
    let mut home = maker.robot().home(maker.home());
    let robot = maker.robot();
    let ground_spin = GroundSpin::of(robot, path.track, maker.home_of_question());
    for first in (0..grid.len()).step_by(spins.count) {
        let setting = window.setting(grid.indices(first), index);
        for (axis, moving) in search.axes.iter().enumerate() {
            home[moving.joint] = setting[3 + axis];
        }
        if !search.axes.is_empty() {
            maker.set_home(Some(home.clone()));
        }
        let lean = Lean {
            lead: setting[1],
            tilt: setting[2],
        };
        let LoadedStop { stop, cases } = match search.lean {
            Some(_) => path.track.leaning_stop(index, (lean, end), (path.load, forces)),
            None => path.track.loaded_stop(index, path.load),
        };
        let ahead = ground_spin.at(&home, &(stop.base_from_tool * Vector3::z()));
        let poses: Vec<Isometry> = (0..spins.count)
            .map(|turn| stop.base_from_tool * about_z(spins.at(turn) + ahead))
            .collect();
        let push = ColumnLoad { cases: &cases, along };
        maker.fill(&poses, &push, &mut part);
        column.append(&part);
    }
    if search.margin > 0.0 {
        column.keep_margin(maker.robot(), search.margin);
    }
    if maker.slots_are_branches() && search.branches != BranchPattern::default() {
        for (slot, branch) in Branch::ALL.into_iter().enumerate() {
            if !search.branches.matches(branch) {
                column.forbid(slot);
            }
        }
    }
}

/// The most frequent reason in a column without a usable posture; out of reach only where there is no other.
pub(super) fn blocked_by(column: &Column) -> PostureStatus {
    let count = |status: PostureStatus| column.statuses.iter().filter(|other| **other == status).count();
    let most = PostureStatus::ALL[1..5]
        .iter()
        .copied()
        .max_by_key(|status| count(*status));
    let most = most.filter(|status| count(*status) > 0);
    most.unwrap_or(PostureStatus::OutOfReach)
}

pub(super) fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
}
