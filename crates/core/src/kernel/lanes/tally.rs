//! What a posture makes of the points of a path: where it stands, the largest deviation, sums.

use super::backend::Work;
use super::block::{BLOCK, Plane};
use super::real::{Float, Real};
use super::solve::{Postures, flag};

/// What a posture that differs in more than the wrist's flip makes of the points.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::kernel) struct Tallied {
    /// Points where it does not stand: plain, and with the wrist flipped.
    pub lost: [usize; 2],
    /// Largest deviation that counts, m.
    pub worst: f64,
    /// Sum of them, m.
    pub sum: f64,
    /// Sum of what is above the limit, m.
    pub above: f64,
}

/// Keeps the lesser deviation of each point, where a posture stands plain or flipped.
pub(super) struct Lesser<'a> {
    pub postures: &'a Postures<f64>,
    pub deviation: &'a Plane<f64>,
    /// Whether the plain posture and the flipped one may be taken.
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
            let stands = (((bits & plain) == 0) & self.open[0]) | (((bits & flipped) == 0) & self.open[1]);
            let counts = stands & (bend2[i] >= self.bend2) & (self.deviation[i] < self.best[i]);
            self.best[i] = if counts { self.deviation[i] } else { self.best[i] };
        }
    }
}

/// A posture so flagged stands in no case.
const NEVER: u32 = flag::UNREACHABLE | flag::WRIST_UNDECIDED | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;

/// Adds a block to what is told of a posture.
pub(super) struct Tally<'a, T> {
    pub postures: &'a Postures<T>,
    pub deviation: &'a Plane<T>,
    pub used: usize,
    pub bend2: f64,
    pub limit: f64,
    pub out: &'a mut Tallied,
}

/// Sums are taken this many at a time, always the same ones together.
const SIDE: usize = 16;

impl<T: Float> Work<T> for Tally<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let never = NEVER as i32;
        let (plain, flipped) = (flag::OUTSIDE_LIMITS as i32, flag::OUTSIDE_LIMITS_FLIPPED as i32);
        let zero = R::of(0.0);
        let (least_bend2, limit) = (R::of(self.bend2), R::of(self.limit));
        let mut lost = [[0_i32; SIDE]; 2];
        let (mut worst, mut sum, mut above) = ([zero; SIDE], [zero; SIDE], [zero; SIDE]);
        let (flags, bend2) = (&self.postures.flags, self.postures.bend2());
        for first in (0..BLOCK).step_by(SIDE) {
            for k in 0..SIDE {
                R::step();
                let i = first + k;
                let here = i < self.used;
                let bits = flags[i].to_i32();
                let bent = R::load(bend2[i]) >= least_bend2;
                let stands = ((bits & never) == 0) & bent;
                lost[0][k] += i32::from(here & !(stands & ((bits & plain) == 0)));
                lost[1][k] += i32::from(here & !(stands & ((bits & flipped) == 0)));
                let deviation = R::either(here & stands, R::load(self.deviation[i]), zero);
                worst[k] = deviation.max(worst[k]);
                sum[k] = sum[k] + deviation;
                above[k] = above[k] + (deviation - limit).max(zero);
            }
        }
        for flip in 0..2 {
            self.out.lost[flip] += lost[flip].iter().sum::<i32>() as usize;
        }
        let given = |lanes: [R; SIDE]| lanes.into_iter().map(|lane| lane.store().to_f64());
        self.out.worst = given(worst).fold(self.out.worst, f64::max);
        self.out.sum += given(sum).sum::<f64>();
        self.out.above += given(above).sum::<f64>();
    }
}
