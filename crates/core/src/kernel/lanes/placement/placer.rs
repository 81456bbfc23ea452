//! A path on a part, evaluated at many placements of the part: the inner loop of a placement search.
//!
//! The points are stored in the part's axes, one plane per number, and do not change. Only the pose of the arm relative
//! to the part differs from placement to placement. A placement therefore costs only the kernels.
//!
//! | of the points | same for all | different |
//! |---|---|---|
//! | orientation of the tool | solved once per placement | one rotation per point |
//! | directions of the deviation | rotated once per placement | rotated into the arm's axes at each point |
//! | wrenches | rotated once per placement | the rows of the compliance are rotated to them |
//!
//! In `f32` a placement takes half the time and is less accurate. [`Placer::generous`] widens limits and margins by
//! [`GENEROUS`], and deviations have an error of at most [`Placer::rounding_error`]. It can therefore prove that a
//! placement is not good enough, and nothing else.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::points::{PlacementPoints, filled, six};
use super::tally::{Lesser, Tallied, Tally};
use super::weighed::{LargestOfEach, RowsOfEach};
use crate::kernel::lanes::by_block::{Batch, FOUR, Scratch};
use crate::kernel::lanes::geometry::{Arm, CosineLimits, Second, aim_still};
use crate::kernel::path_on_part::{PartPlacement, PostureMargins, SpunPlacement, WrenchAxes};
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Planes, Precision, planes};
use crate::robot::inverse::OrthoParallel;
use crate::spatial::Wrench;

/// By how much (rad, and relative) limits and margins are widened in single precision. At two degrees from a singular
/// posture, angles have an error of `1e-7 / sin 1 deg`, cosines of 1e-7. Ends of ranges are tested by cosines, which
/// this changes by at least 5e-5.
const GENEROUS: f64 = 0.01;

/// Relative error of deviations in single precision, of the longest lever: rounding of 6e-8 in some ten sums, over the
/// smallest sine of a bend, `sin 1 deg`.
const ROUNDING: f64 = 3.5e-5;

/// Evaluates placements of a path; one per thread.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Placer<T> {
    batch: Batch<T>,
    /// The arm relative to the robot's base.
    arm: Arm,
    /// Middle of the range of axis 5 for limits tested by cosines, tool axes.
    middle: Option<Vector3<f64>>,
    rows: Box<Planes<T, 12>>,
    /// Smallest squared sine of the wrist's bend.
    bend2: f64,
    /// The excess of deviations over it is summed, m.
    tolerance: f64,
}

impl Placer<f64> {
    /// For an arm of this form with these margins.
    pub fn new(question: &Question<'_>, form: &OrthoParallel, margins: &PostureMargins) -> Placer<f64> {
        Placer::with_slack(question, form, margins, 0.0)
    }

    /// The smallest deviation at each point, over the spins `tried` and all open branches, into `least`; infinite
    /// where no posture can be used.
    pub fn least_of_each(
        &mut self,
        points: &PlacementPoints<f64>,
        tried: SpunPlacement<'_>,
        open: [bool; 8],
        least: &mut Vec<f64>,
    ) {
        let SpunPlacement { placement, spins } = tried;
        least.clear();
        for block in 0..points.at.len() {
            let mut best = [f64::INFINITY; BLOCK];
            for spin in spins {
                let turned = PartPlacement {
                    spin: placement.spin + spin,
                    ..*placement
                };
                self.set_pose(points, &turned);
                let (bend2, fours) = (
                    self.bend2,
                    [0, 1, 2, 3].map(|four| [open[2 * four], open[2 * four + 1]]),
                );
                self.each_posture(points, block, fours.map(|two| two[0] || two[1]), |four, batch| {
                    batch.backend.run(Lesser {
                        postures: &batch.scratch.postures,
                        deviation: &batch.scratch.in_plane,
                        open: fours[four],
                        bend2,
                        best: &mut best,
                    });
                });
            }
            let used = BLOCK.min(points.count - block * BLOCK);
            least.extend_from_slice(&best[..used]);
        }
    }
}

impl Placer<f32> {
    /// The same with widened limits: see [`GENEROUS`].
    pub fn generous(question: &Question<'_>, form: &OrthoParallel, margins: &PostureMargins) -> Placer<f32> {
        Placer::with_slack(question, form, margins, GENEROUS)
    }

    /// Largest error of its deviations, m.
    pub fn rounding_error(&self, points: &PlacementPoints<f32>) -> f64 {
        let prepared = &self.batch.prepared;
        let lever = prepared.arm.longest_lever();
        let sum: f64 = prepared.compliance.iter().sum();
        ROUNDING * sum * lever * (lever * points.strongest[0] + points.strongest[1])
    }
}

impl<T: Precision> Placer<T> {
    fn with_slack(
        question: &Question<'_>,
        form: &OrthoParallel,
        margins: &PostureMargins,
        slack: f64,
    ) -> Placer<T> {
        let mut batch = Batch::new(question, form, Backend::fastest());
        let prepared = &mut batch.prepared;
        prepared.arm.keep_away(margins.margin);
        prepared.arm.allow(slack);
        prepared.cosines = CosineLimits::new(&prepared.arm);
        // The part is seldom oriented like the arm.
        prepared.turned = true;
        Placer {
            arm: prepared.arm.clone(),
            middle: prepared.cosines.as_ref().map(|cosines| cosines.tool_middle),
            batch,
            rows: Box::new(planes()),
            bend2: (margins.wrist.max(margins.margin).sin() * (1.0 - slack)).powi(2),
            tolerance: margins.tolerance,
        }
    }

    /// Totals of front elbow-up, front elbow-down, back elbow-up and back elbow-down over the points at this placement.
    /// Continues after each block with the postures for which `keep` returns true.
    pub fn evaluate(
        &mut self,
        points: &PlacementPoints<T>,
        placement: &PartPlacement,
        mut keep: impl FnMut(usize, &Tallied) -> bool,
    ) -> [Tallied; 4] {
        self.set_pose(points, placement);
        let mut tallied = [Tallied::default(); 4];
        let mut open = std::array::from_fn(|four| keep(four, &tallied[four]));
        for block in 0..points.at.len() {
            if open == [false; 4] {
                break;
            }
            let (bend2, tolerance) = (self.bend2, self.tolerance);
            self.each_posture(points, block, open, |four, batch| {
                batch.backend.run(Tally {
                    postures: &batch.scratch.postures,
                    deviation: &batch.scratch.in_plane,
                    used: BLOCK.min(points.count - block * BLOCK),
                    bend2,
                    tolerance,
                    out: &mut tallied[four],
                });
            });
            open = std::array::from_fn(|four| open[four] && keep(four, &tallied[four]));
        }
        tallied
    }

    /// Calls `use_posture` with each open posture of the block, solved, with limit flags and deviations.
    fn each_posture(
        &mut self,
        points: &PlacementPoints<T>,
        block: usize,
        open: [bool; 4],
        mut use_posture: impl FnMut(usize, &Batch<T>),
    ) {
        let still = points.rotations.is_empty();
        self.batch.place(points.at[block].each_ref());
        if let Some(rotations) = points.rotations.get(block) {
            self.batch.scratch.rotations = *rotations;
            self.batch.orient(Second::InTheMiddle);
        }
        let mut reached = None;
        for four in (0..FOUR.len()).filter(|four| open[*four]) {
            let signs = FOUR[four];
            self.batch.solve_after(reached == Some(signs[0]), signs, still);
            reached = Some(signs[0]);
            self.batch.limit(still);
            self.weigh(points, block);
            use_posture(four, &self.batch);
        }
    }

    /// Sets the arm as seen from the part at this placement.
    fn set_pose(&mut self, points: &PlacementPoints<T>, placement: &PartPlacement) {
        let prepared = &mut self.batch.prepared;
        let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin);
        prepared.arm.arm_from_base = self.arm.arm_from_base * placement.base_from_part;
        prepared.arm.lever = spin * self.arm.lever;
        prepared.arm.tool_from_axis_6 = spin * self.arm.tool_from_axis_6;
        prepared.arm.tool_from_axis_5 = spin * self.arm.tool_from_axis_5;
        if let (Some(cosines), Some(middle)) = (&mut prepared.cosines, self.middle) {
            cosines.tool_middle = spin * middle;
        }
        let from_part = prepared.arm.arm_from_base_rotation();
        let from_wrench = axes_of(points.wrench_axes, &from_part, &self.arm);
        prepared.cases.clear();
        let turned = |w: &Wrench| [from_wrench * w.force, from_wrench * w.moment];
        prepared.cases.extend(points.cases_of_all.iter().map(turned));
        prepared.moments = points.moments;
        let [first, second] = points.steady.map(|along| from_part * along);
        prepared.plane = [first, second, Vector3::zeros()];
        if points.rotations.is_empty() {
            let second = match &prepared.cosines {
                Some(cosines) => cosines.tool_middle,
                None => prepared.arm.tool_from_axis_5,
            };
            aim_still(prepared, &points.still, &second, &mut self.batch.scratch.aims);
        }
    }

    /// Selected component of the deviation at the points of the solved block, into the scratch.
    fn weigh(&mut self, points: &PlacementPoints<T>, block: usize) {
        let still = points.rotations.is_empty();
        let batch = &mut self.batch;
        if points.along.is_empty() && points.wrenches.is_empty() {
            batch.largest(still, None);
            return;
        }
        let prepared = &batch.prepared;
        let Scratch {
            aims,
            postures,
            in_plane,
            ..
        } = &mut *batch.scratch;
        let steady;
        let along = match points.along.get(block) {
            Some(along) => along,
            None => {
                steady = filled(|_| six(points.steady));
                &steady
            }
        };
        let arm_from_part = prepared.arm.arm_from_base_rotation();
        let rows = &mut *self.rows;
        macro_rules! rows_of_each {
            ($still:literal, $moments:literal) => {
                batch.backend.run(RowsOfEach::<T, $still, $moments> {
                    prepared,
                    arm_from_part: &arm_from_part,
                    along,
                    aims,
                    postures,
                    rows,
                })
            };
        }
        match (still, prepared.moments) {
            (true, false) => rows_of_each!(true, false),
            (true, true) => rows_of_each!(true, true),
            (false, false) => rows_of_each!(false, false),
            (false, true) => rows_of_each!(false, true),
        }
        let shared: Vec<Planes<T, 6>>;
        let wrenches = match points.wrenches.is_empty() {
            false => &points.wrenches[block * points.cases..][..points.cases],
            true => {
                let planes_of = |w: &Wrench| filled(|_| six([w.force, w.moment]));
                shared = points.cases_of_all.iter().map(planes_of).collect();
                &shared
            }
        };
        batch.backend.run(LargestOfEach {
            wrench_from_arm: &axes_of(points.wrench_axes, &arm_from_part, &self.arm).transpose(),
            moments: prepared.moments,
            wrenches,
            rows,
            deviation: in_plane,
        });
    }
}

/// Axes of the wrenches, in the arm's axes.
fn axes_of(axes: WrenchAxes, arm_from_part: &Matrix3<f64>, arm: &Arm) -> Matrix3<f64> {
    match axes {
        WrenchAxes::Part => *arm_from_part,
        WrenchAxes::Base => arm.arm_from_base_rotation(),
    }
}
