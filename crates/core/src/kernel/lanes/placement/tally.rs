//! Totals of a posture over the points of a path: unreachable points, the largest deviation, sums.

use crate::kernel::lanes::solve::{Postures, flag};
use crate::numbers::{BLOCK, Float, Plane, Real, Work};

/// Totals of a posture, plain and with the wrist flipped, over the points.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::kernel) struct Tallied {
    /// Points where it cannot be used: plain, and with the wrist flipped.
    pub unreachable: [usize; 2],
    /// Largest selected component of the deviation, m.
    pub worst: f64,
    /// Sum of the deviations, m.
    pub sum: f64,
    /// Sum of the excess over the tolerance, m.
    pub above: f64,
}

/// Keeps the smaller deviation of each point, where the plain or the flipped posture can be used.
pub(super) struct Lesser<'a> {
    pub postures: &'a Postures<f64>,
    pub deviation: &'a Plane<f64>,
    /// Whether the plain posture and the flipped one are open.
    pub open: [bool; 2],
    pub bend2: f64,
    pub best: &'a mut Plane<f64>,
}

impl Work<f64> for Lesser<'_> {
    #[inline(always)]
    fn run<R: Real<Float = f64>>(self) {
        let limits = [flag::OUTSIDE_LIMITS, flag::OUTSIDE_LIMITS_FLIPPED];
        let [plain, flipped] = limits.map(|limit| (NEVER | limit) as i32);
        let (flags, bend2) = (&self.postures.flags, self.postures.bend2());
        for i in 0..BLOCK {
            R::step();
            let bits = flags[i] as i32;
            let usable = (((bits & plain) == 0) & self.open[0]) | (((bits & flipped) == 0) & self.open[1]);
            let better = usable & (bend2[i] >= self.bend2) & (self.deviation[i] < self.best[i]);
            self.best[i] = if better { self.deviation[i] } else { self.best[i] };
        }
    }
}

/// With one of these flags a posture cannot be used, plain or flipped.
const NEVER: u32 = flag::UNREACHABLE | flag::WRIST_UNDECIDED | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;

/// Adds a block to the totals of a posture.
pub(super) struct Tally<'a, T> {
    pub postures: &'a Postures<T>,
    pub deviation: &'a Plane<T>,
    pub used: usize,
    pub bend2: f64,
    pub tolerance: f64,
    pub out: &'a mut Tallied,
}

/// Width of the partial sums, fixed so that the order of summation never changes.
const SIDE: usize = 16;

impl<T: Float> Work<T> for Tally<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let never = NEVER as i32;
        let (plain, flipped) = (flag::OUTSIDE_LIMITS as i32, flag::OUTSIDE_LIMITS_FLIPPED as i32);
        let zero = R::of(0.0);
        let (least_bend2, tolerance) = (R::of(self.bend2), R::of(self.tolerance));
        let mut unreachable = [[0_i32; SIDE]; 2];
        let (mut worst, mut sum, mut above) = ([zero; SIDE], [zero; SIDE], [zero; SIDE]);
        let (flags, bend2) = (&self.postures.flags, self.postures.bend2());
        for first in (0..BLOCK).step_by(SIDE) {
            for k in 0..SIDE {
                R::step();
                let i = first + k;
                let here = i < self.used;
                let bits = flags[i].to_i32();
                let bent = R::load(bend2[i]) >= least_bend2;
                let usable = ((bits & never) == 0) & bent;
                unreachable[0][k] += i32::from(here & !(usable & ((bits & plain) == 0)));
                unreachable[1][k] += i32::from(here & !(usable & ((bits & flipped) == 0)));
                let deviation = R::either(here & usable, R::load(self.deviation[i]), zero);
                worst[k] = deviation.max(worst[k]);
                sum[k] = sum[k] + deviation;
                above[k] = above[k] + (deviation - tolerance).max(zero);
            }
        }
        for flip in 0..2 {
            self.out.unreachable[flip] += unreachable[flip].iter().sum::<i32>() as usize;
        }
        let values = |lanes: [R; SIDE]| lanes.into_iter().map(|lane| lane.store().to_f64());
        self.out.worst = values(worst).fold(self.out.worst, f64::max);
        self.out.sum += values(sum).sum::<f64>();
        self.out.above += values(above).sum::<f64>();
    }
}
