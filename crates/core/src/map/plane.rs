//! Deviation over a workpiece plane.

use nalgebra::Point2;

use crate::frame::Isometry;
use crate::kernel::{Answers, Evaluation, Question, evaluate};
use crate::robot::Unreachable;
use crate::watch::{Cancelled, Watch};
use crate::workpiece::{Grid, Plane};

use super::region::{Region, region_within};

/// Answers on a grid over a plane.
#[derive(Clone, Debug)]
pub struct PlaneMap {
    /// The plane.
    pub plane: Plane,
    /// Its points.
    pub grid: Grid,
    /// Results at each point, in the grid's order.
    pub answers: Answers,
}

/// Number of points within the tolerance, and the reasons for the others. The first five add up to all points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// In-plane deviation within the tolerance.
    pub within: usize,
    /// In-plane deviation above the tolerance.
    pub above_tolerance: usize,
    /// No posture reaches the point.
    pub out_of_reach: usize,
    /// Postures exist, but none inside the joint limits (only if the best branch is requested).
    pub no_posture_inside_limits: usize,
    /// A search found no posture, which does not prove that there is none.
    pub not_found: usize,
    /// The inverse kinematics failed its own check.
    pub unverified: usize,
    /// A posture reaches the point, but the arm has no stable equilibrium under the load.
    pub unstable: usize,
    /// Postures reach the point, but none keeps the demanded clearance.
    pub in_collision: usize,
    /// Of the points with a posture: at least one joint is outside its limits.
    pub outside_joint_limits: usize,
    /// Of the points within the tolerance: every joint is inside its limits.
    pub within_and_inside_joint_limits: usize,
    /// Of the points with a posture: near a singularity.
    pub near_singularity: usize,
}

impl Counts {
    /// Counts the points of `answers` for this `limit` (m): the tolerance.
    pub fn of(answers: &Answers, limit: f64) -> Counts {
        let mut counts = Counts::default();
        for point in &answers.points {
            match point {
                Ok(evaluation) => {
                    let within = evaluation.in_plane <= limit;
                    counts.within += usize::from(within);
                    counts.above_tolerance += usize::from(!within);
                    counts.outside_joint_limits += usize::from(!evaluation.within_limits());
                    counts.within_and_inside_joint_limits +=
                        usize::from(within && evaluation.within_limits());
                    counts.near_singularity += usize::from(evaluation.singularity.is_some());
                }
                Err(Unreachable::OutsideLimits { .. }) => counts.no_posture_inside_limits += 1,
                Err(Unreachable::NotFound { .. } | Unreachable::OtherBranch) => counts.not_found += 1,
                Err(Unreachable::Unverified { .. }) => counts.unverified += 1,
                Err(Unreachable::Unstable { .. }) => counts.unstable += 1,
                Err(Unreachable::InCollision { .. }) => counts.in_collision += 1,
                Err(
                    Unreachable::TooFar { .. }
                    | Unreachable::TooNear { .. }
                    | Unreachable::InsideLateralOffset { .. },
                ) => counts.out_of_reach += 1,
            }
        }
        counts
    }

    /// All points.
    pub fn points(&self) -> usize {
        let reached = self.within + self.above_tolerance;
        let missed = self.out_of_reach + self.no_posture_inside_limits + self.not_found;
        reached + missed + self.unverified + self.unstable + self.in_collision
    }

    /// Points within the tolerance over all points; 0 where there is none.
    pub fn fraction_within(&self) -> f64 {
        self.within as f64 / self.points().max(1) as f64
    }

    /// Points within the tolerance and inside the joint limits over all points.
    pub fn fraction_within_and_inside_joint_limits(&self) -> f64 {
        self.within_and_inside_joint_limits as f64 / self.points().max(1) as f64
    }
}

impl PlaneMap {
    /// The region within the tolerance `limit` (m), of points inside the joint limits.
    pub fn region(&self, limit: f64) -> Region {
        region_within(
            &self.grid,
            &self.inside_joint_limits(|evaluation| evaluation.in_plane),
            limit,
        )
    }

    /// `value` at each usable point: `None` without posture, or outside joint limits.
    pub(super) fn inside_joint_limits(&self, value: impl Fn(&Evaluation) -> f64) -> Vec<Option<f64>> {
        let of = |point: &Result<Evaluation, Unreachable>| {
            let evaluation = point
                .as_ref()
                .ok()
                .filter(|evaluation| evaluation.within_limits());
            evaluation.map(&value)
        };
        self.answers.points.iter().map(of).collect()
    }
}

/// The map of `plane` on `grid`. The question's normal and load cases are those of the plane.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn plane_map(
    question: &Question<'_>,
    plane: Plane,
    grid: Grid,
    watch: Watch<'_>,
) -> Result<PlaneMap, Cancelled> {
    let rotation = plane.base_from_tool(Point2::origin(), 0.0).rotation;
    let pose = |i| Isometry::from_parts(plane.at(grid.point(i)).coords.into(), rotation);
    let answers = evaluate(question, grid.len(), pose, watch)?;
    Ok(PlaneMap { plane, grid, answers })
}
