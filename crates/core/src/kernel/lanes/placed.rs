//! A path that lies on a part, judged in many places of the part: what a search for a placement asks.
//!
//! The points are held in the part's axes, a plane a number, and stay as they are; what changes from place to place is where
//! the arm stands as the part sees it. So a place costs the kernels alone.
//!
//! | of the points | shared by all | of each |
//! |---|---|---|
//! | orientation of the tool | solved once a place | a rotation a point |
//! | directions that count | turned once a place | turned into the arm's axes a point |
//! | wrenches | turned once a place | the rows of the compliance are turned to them |
//!
//! In `f32` a place costs half as much and is told less well: [`Placer::generous`] counts points as held that are by
//! [`GENEROUS`] nearer than allowed to where the arm may not stand, and deviations stray by [`Placer::strays`] at most. So it can
//! prove that a place is not worth a second look, and nothing else.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::aims;
use super::arm::Arm;
use super::backend::{Backend, Precision};
use super::batch::{Batch, Scratch};
use super::block::{BLOCK, Planes, planes};
use super::laid::{Laid, filled, six};
use super::limits::CosineLimits;
use super::steps::{FOUR, Second};
use super::tally::{Lesser, Tallied, Tally};
use super::weighed::{LargestOfEach, RowsOfEach};
use crate::kernel::placed::{Keeping, PartPlacement, ToldIn};
use crate::kernel::question::Question;
use crate::robot::inverse::OrthoParallel;
use crate::spatial::Wrench;

/// How much nearer (rad, and as a share) to limits and singular postures than they may come points still count as held
/// in single precision. There, two degrees off a singular posture, angles stray by `1e-7 / sin 1 deg`, cosines by 1e-7; ends of
/// ranges are told by cosines, which this turns by 5e-5 at the least.
const GENEROUS: f64 = 0.01;

/// What deviations stray by in single precision, as a share of [`Placer::longest`]: rounding of 6e-8 in some ten sums, over the
/// least sine of a bend, `sin 1 deg`.
const STRAYS: f64 = 3.5e-5;

/// Judges places of a path; one a thread.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Placer<T> {
    batch: Batch<T>,
    /// The arm as the robot's base sees it.
    arm_state: Arm,
    /// Where the limits told by cosines want axis 5, tool axes.
    middle: Option<Vector3<f64>>,
    rows: Box<Planes<T, 12>>,
    /// Least squared sine of the wrist's bend.
    bend2: f64,
    /// Deviations above it are summed, m.
    limit: f64,
}

impl Placer<f64> {
    /// For an arm of this form, which keeps away from its limits as `keeping` says.
    pub fn new(question: &Question<'_>, form: &OrthoParallel, keeping: &Keeping) -> Placer<f64> {
        Placer::with_slack(question, form, keeping, 0.0)
    }

    /// The least deviation at each point, of all turns of the tool and all branches that are open, into `least`; infinite where
    /// none stands.
    pub fn least_of_each(
        &mut self,
        laid: &Laid<f64>,
        (placement, spins): (&PartPlacement, &[f64]),
        open: [bool; 8],
        least: &mut Vec<f64>,
    ) {
        least.clear();
        for block in 0..laid.at.len() {
            let mut best = [f64::INFINITY; BLOCK];
            for spin in spins {
                let turned = PartPlacement {
                    spin: placement.spin + spin,
                    ..*placement
                };
                self.set_joints(laid, &turned);
                let (bend2, fours) = (
                    self.bend2,
                    [0, 1, 2, 3].map(|four| [open[2 * four], open[2 * four + 1]]),
                );
                self.each_posture(laid, block, fours.map(|two| two[0] || two[1]), |four, batch| {
                    batch.backend.run(Lesser {
                        postures: &batch.scratch.postures,
                        deviation: &batch.scratch.in_plane,
                        open: fours[four],
                        bend2,
                        best: &mut best,
                    });
                });
            }
            let used = BLOCK.min(laid.count - block * BLOCK);
            least.extend_from_slice(&best[..used]);
        }
    }
}

impl Placer<f32> {
    /// The same, which holds a little more than the arm may: see [`GENEROUS`].
    pub fn generous(question: &Question<'_>, form: &OrthoParallel, keeping: &Keeping) -> Placer<f32> {
        Placer::with_slack(question, form, keeping, GENEROUS)
    }

    /// Deviations that it tells stray from the true ones by this at most, m.
    pub fn strays(&self, laid: &Laid<f32>) -> f64 {
        let prepared = &self.batch.prepared;
        let lever = prepared.arm.longest_lever();
        let sum: f64 = prepared.compliance.iter().sum();
        STRAYS * sum * lever * (lever * laid.strongest[0] + laid.strongest[1])
    }
}

impl<T: Precision> Placer<T> {
    fn with_slack(question: &Question<'_>, form: &OrthoParallel, keeping: &Keeping, slack: f64) -> Placer<T> {
        let mut batch = Batch::new(question, form, Backend::fastest());
        let prepared = &mut batch.prepared;
        prepared.arm.keep_away(keeping.margin);
        prepared.arm.allow(slack);
        prepared.cosines = CosineLimits::new(&prepared.arm);
        // The part is seldom turned as the arm is.
        prepared.turned = true;
        Placer {
            arm_state: prepared.arm.clone(),
            middle: prepared.cosines.as_ref().map(|cosines| cosines.tool_middle),
            batch,
            rows: Box::new(planes()),
            bend2: (keeping.wrist.max(keeping.margin).sin() * (1.0 - slack)).powi(2),
            limit: keeping.limit,
        }
    }

    /// What each of front elbow-up, front elbow-down, back elbow-up and back elbow-down makes of the points where the part
    /// lies so; goes on after a block with those that `worth` says yes to.
    pub fn judge(
        &mut self,
        laid: &Laid<T>,
        placement: &PartPlacement,
        mut worth: impl FnMut(usize, &Tallied) -> bool,
    ) -> [Tallied; 4] {
        self.set_joints(laid, placement);
        let mut tallied = [Tallied::default(); 4];
        let mut open = std::array::from_fn(|four| worth(four, &tallied[four]));
        for block in 0..laid.at.len() {
            if open == [false; 4] {
                break;
            }
            let (bend2, limit) = (self.bend2, self.limit);
            self.each_posture(laid, block, open, |four, batch| {
                batch.backend.run(Tally {
                    postures: &batch.scratch.postures,
                    deviation: &batch.scratch.in_plane,
                    used: BLOCK.min(laid.count - block * BLOCK),
                    bend2,
                    limit,
                    out: &mut tallied[four],
                });
            });
            open = std::array::from_fn(|four| open[four] && worth(four, &tallied[four]));
        }
        tallied
    }

    /// Gives `told` each posture of the block that is open, solved, with its limits flagged and its deviations weighed.
    fn each_posture(
        &mut self,
        laid: &Laid<T>,
        block: usize,
        open: [bool; 4],
        mut given: impl FnMut(usize, &Batch<T>),
    ) {
        let still = laid.rotations.is_empty();
        self.batch.place(laid.at[block].each_ref());
        if let Some(rotations) = laid.rotations.get(block) {
            self.batch.scratch.rotations = *rotations;
            self.batch.orient(Second::InTheMiddle);
        }
        let mut reached = None;
        for four in (0..FOUR.len()).filter(|four| open[*four]) {
            let signs = FOUR[four];
            self.batch.solve_after(reached == Some(signs[0]), signs, still);
            reached = Some(signs[0]);
            self.batch.limit(still);
            self.weigh(laid, block);
            given(four, &self.batch);
        }
    }

    /// Lets the arm stand as a part that lies so sees it.
    fn stand(&mut self, laid: &Laid<T>, placement: &PartPlacement) {
        let prepared = &mut self.batch.prepared;
        let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin);
        prepared.arm.arm_from_base = self.arm_state.arm_from_base * placement.base_from_part;
        prepared.arm.lever = spin * self.arm_state.lever;
        prepared.arm.tool_from_axis_6 = spin * self.arm_state.tool_from_axis_6;
        prepared.arm.tool_from_axis_5 = spin * self.arm_state.tool_from_axis_5;
        if let (Some(cosines), Some(middle)) = (&mut prepared.cosines, self.middle) {
            cosines.tool_middle = spin * middle;
        }
        let from_part = prepared.arm.arm_from_base_rotation();
        let from_told = told_axes(laid.told_in, &from_part, &self.arm_state);
        prepared.cases.clear();
        let turned = |w: &Wrench| [from_told * w.force, from_told * w.moment];
        prepared.cases.extend(laid.cases_of_all.iter().map(turned));
        prepared.moments = laid.moments;
        let [first, second] = laid.steady.map(|along| from_part * along);
        prepared.plane = [first, second, Vector3::zeros()];
        if laid.rotations.is_empty() {
            let second = match &prepared.cosines {
                Some(cosines) => cosines.tool_middle,
                None => prepared.arm.tool_from_axis_5,
            };
            aims::still(prepared, &laid.still, &second, &mut self.batch.scratch.aims);
        }
    }

    /// Deviation that counts at the points of the solved block, into the scratch.
    fn weigh(&mut self, laid: &Laid<T>, block: usize) {
        let still = laid.rotations.is_empty();
        let batch = &mut self.batch;
        if laid.along.is_empty() && laid.wrenches.is_empty() {
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
        let along = match laid.along.get(block) {
            Some(along) => along,
            None => {
                steady = filled(|_| six(laid.steady));
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
        let wrenches = match laid.wrenches.is_empty() {
            false => &laid.wrenches[block * laid.cases..][..laid.cases],
            true => {
                let planes_of = |w: &Wrench| filled(|_| six([w.force, w.moment]));
                shared = laid.cases_of_all.iter().map(planes_of).collect();
                &shared
            }
        };
        batch.backend.run(LargestOfEach {
            told_from_arm: &told_axes(laid.told_in, &arm_from_part, &self.arm_state).transpose(),
            moments: prepared.moments,
            wrenches,
            rows,
            deviation: in_plane,
        });
    }
}

/// Axes that wrenches are told in, in the arm's.
fn told_axes(given: ToldIn, arm_from_part: &Matrix3<f64>, arm_state: &Arm) -> Matrix3<f64> {
    match given {
        ToldIn::Part => *arm_from_part,
        ToldIn::Base => arm_state.arm_from_base_rotation(),
    }
}
