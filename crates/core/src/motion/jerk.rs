//! Limited jerk: the position along the path, averaged over a window of time.
//!
//! ```text
//! s~(t) = 1/T  integral of s over [t - T, t]
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s(t)` | position along the path of a profile whose acceleration is constant between its points | m |
//! | `s~(t)` | the same with jerk of at most `(change of the acceleration)/T` | m |
//! | `T` | window | s |
//!
//! Neither the greatest speed nor the greatest acceleration grows. A trapezoid of speed becomes the profile of seven sections of constant jerk; the motion takes `T`
//! longer. A stop is passed with a low speed instead, as controllers do where a point is not waited at.
//!
//! Source: moving average as a filter of a trajectory, Biagiotti and Melchiorri 2008, section 4.6 (recalled).

use rayon::prelude::*;

use super::speed::SpeedProfile;

/// Times that a thread seeks at once.
const AT_ONCE: usize = 4096;

/// First step in which a time is sought, s.
const FIRST_STEP: f64 = 1e-3;
/// Below this speed it may rest, m/s.
const RESTING: f64 = 1e-6;
/// Precision of a time, s.
const PRECISION: f64 = 1e-10;

/// A position along the path as a function of time.
#[derive(Clone, Debug)]
pub struct Timed {
    times: Vec<f64>,
    along: Vec<f64>,
    speeds: Vec<f64>,
    /// Integral of the position up to each point, m s.
    sums: Vec<f64>,
    window: f64,
}

/// Sections of a profile that were used last, at both ends of the window: times that follow each other are near each other.
#[derive(Clone, Copy, Default)]
struct Sections {
    at_start: usize,
    at_end: usize,
}

/// Where a motion is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Position along the path, m.
    pub along: f64,
    /// Speed, m/s.
    pub speed: f64,
}

impl Timed {
    /// A profile of a path with these lengths, m, averaged over a window, s; 0 leaves it as it is.
    pub fn of(profile: &SpeedProfile, along: &[f64], window: f64) -> Timed {
        let mut sums = vec![0.0; along.len()];
        for index in 1..along.len() {
            let h = profile.times[index] - profile.times[index - 1];
            let (from, to) = (along[index - 1], along[index]);
            let (v, w) = (profile.speeds[index - 1], profile.speeds[index]);
            // The position is a parabola.
            sums[index] = sums[index - 1] + h * (0.5 * (from + to) + h * (v - w) / 12.0);
        }
        Timed {
            times: profile.times.clone(),
            along: along.to_vec(),
            speeds: profile.speeds.clone(),
            sums,
            window,
        }
    }

    /// The time that the motion takes, s.
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0) + self.window
    }

    /// Where it is at a time, s; at rest before the start and after the end.
    pub fn at(&self, time: f64) -> Moment {
        self.near(time, &mut Sections::default())
    }

    /// The same, sought from the sections found last.
    fn near(&self, time: f64, last: &mut Sections) -> Moment {
        let (to, speed, after) = self.exact(time, &mut last.at_end);
        if self.window <= 0.0 {
            return Moment { along: to, speed };
        }
        let (from, _, before) = self.exact(time - self.window, &mut last.at_start);
        Moment {
            along: (after - before) / self.window,
            speed: (to - from) / self.window,
        }
    }

    /// The time at which it passes each of these positions, m, which rise; the middle of a rest there.
    ///
    /// Not checked: that they are on the path.
    pub fn times_at(&self, along: &[f64]) -> Vec<f64> {
        let mut times = vec![0.0; along.len()];
        let blocks = times.par_chunks_mut(AT_ONCE).zip(along.par_chunks(AT_ONCE));
        blocks.for_each(|(times, along)| {
            let (mut earliest, mut last) = (self.times[0], Sections::default());
            for (time, at) in times.iter_mut().zip(along) {
                let early = self.crossing(*at, earliest, &mut last, |here, at| here < at);
                earliest = early;
                *time = early;
                if self.near(early, &mut last).speed <= RESTING {
                    let late = self.crossing(*at, early, &mut last, |here, at| here <= at);
                    *time = 0.5 * (early + late);
                }
            }
        });
        times
    }

    /// The end of the times, from one on, at which the position is before `at` by this comparison.
    fn crossing(&self, at: f64, from: f64, last: &mut Sections, is_before: impl Fn(f64, f64) -> bool) -> f64 {
        let end = self.duration();
        let mut low = from;
        if !is_before(self.near(low, last).along, at) {
            return low;
        }
        // Positions that follow each other are passed soon.
        let mut step = FIRST_STEP;
        let mut high = low + step;
        while high < end && is_before(self.near(high, last).along, at) {
            step *= 2.0;
            (low, high) = (high, high + step);
        }
        high = high.min(end);
        if is_before(self.near(high, last).along, at) {
            return high;
        }
        // Newton's method, and bisection where it leaves the bracket or does not halve it.
        let mut guess = low;
        let mut width = f64::INFINITY;
        while high - low > PRECISION {
            let is_inside = guess > low && guess < high;
            if !is_inside || high - low > 0.5 * width {
                guess = 0.5 * (low + high);
            }
            width = high - low;
            let here = self.near(guess, last);
            match is_before(here.along, at) {
                true => low = guess,
                false => high = guess,
            }
            if here.speed > RESTING {
                let step = (at - here.along) / here.speed;
                if step.abs() < 0.5 * PRECISION {
                    return guess;
                }
                guess += step;
            }
        }
        0.5 * (low + high)
    }

    /// The last point that is passed at a time before the end, sought in growing steps from another one.
    fn section(&self, time: f64, near: usize) -> usize {
        let (mut low, mut high) = (near, near + 1);
        let mut step = 1;
        while low > 0 && self.times[low] > time {
            high = low;
            low = low.saturating_sub(step);
            step *= 2;
        }
        while high < self.times.len() && self.times[high] <= time {
            low = high;
            high = (high + step).min(self.times.len());
            step *= 2;
        }
        low + self.times[low..high].partition_point(|at| *at <= time) - 1
    }

    /// Position, speed and integral of the position without the average.
    fn exact(&self, time: f64, last_section: &mut usize) -> (f64, f64, f64) {
        let last = self.times.len() - 1;
        if time <= self.times[0] {
            return (self.along[0], 0.0, self.along[0] * (time - self.times[0]));
        }
        if time >= self.times[last] {
            let after = self.along[last] * (time - self.times[last]);
            return (self.along[last], 0.0, self.sums[last] + after);
        }
        let index = self.section(time, *last_section);
        *last_section = index;
        let (h, t) = (
            self.times[index + 1] - self.times[index],
            time - self.times[index],
        );
        let (v, s) = (self.speeds[index], self.along[index]);
        let a = (self.speeds[index + 1] - v) / h;
        let along = s + t * (v + 0.5 * a * t);
        (
            along,
            v + a * t,
            self.sums[index] + t * (s + t * (0.5 * v + a * t / 6.0)),
        )
    }
}

#[cfg(test)]
mod tests;
