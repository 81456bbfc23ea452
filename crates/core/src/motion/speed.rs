//! The fastest speed along a path within the limits of joints and path.
//!
//! ```text
//! dq/dt = q' v        d2q/dt2 = q' u + q'' x        x = v^2,  u = dv/dt,  x_{i+1} = x_i + 2 h_i u_i
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `v`, `u` | speed and acceleration along the path | m/s, m/s^2 |
//! | `x` | square of the speed | m^2/s^2 |
//! | `q'`, `q''` | derivatives of a joint by the length of the path | rad/m, rad/m^2 |
//! | `h_i` | distance to the next point | m |
//!
//! Every limit of an acceleration is a strip of the (x, u) plane, `|u - c x| <= w` with `c = -q''/q'` and `w = A/|q'|`. From the end back the greatest `x_i`
//! from which the next point can be passed is found in closed form: the strips of two limits meet where `|c_k - c_l| x <= w_k + w_l`. From the start on the greatest
//! acceleration is used at each point. The result is the fastest of all profiles whose accelerations are constant between points.
//!
//! Source: reachability analysis of time-optimal path parameterization, Pham and Pham 2018 (TOPP-RA), here in one dimension and in closed form.

use super::joint_path::JointPath;
use super::limits::{Limiting, MotionLimits};

/// A derivative below this, relative to the largest of the point, is 0.
const FLAT: f64 = 1e-12;

/// The speed along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedProfile {
    /// Speed at each point, m/s.
    pub speeds: Vec<f64>,
    /// Time at each point from the start, s; waits are not part of it.
    pub times: Vec<f64>,
    /// What limits the speed at each point.
    pub limiting: Vec<Limiting>,
}

/// A limit of an acceleration at a point: `|u - c x| <= w`.
#[derive(Clone, Copy, Debug)]
struct Strip {
    c: f64,
    w: f64,
    limiting: Limiting,
}

/// The limits at the beginning of a step.
#[derive(Clone, Debug, Default)]
struct Strips {
    all: Vec<Strip>,
}

/// An upper bound with its reason.
#[derive(Clone, Copy, Debug)]
struct Bound {
    value: f64,
    limiting: Limiting,
}

impl Bound {
    fn tighten(&mut self, value: f64, limiting: Limiting) {
        if value < self.value {
            *self = Bound { value, limiting };
        }
    }
}

impl Strips {
    /// Those of these derivatives; adds bounds of the square of the speed that are known from them alone.
    fn fill(
        &mut self,
        derivatives: impl Iterator<Item = (f64, f64)>,
        limits: &MotionLimits,
        bound: &mut Bound,
    ) {
        self.all.clear();
        if limits.acceleration.is_finite() {
            self.all.push(Strip {
                c: 0.0,
                w: limits.acceleration,
                limiting: Limiting::PathAcceleration,
            });
        }
        for (joint, ((slope, curvature), limit)) in derivatives.zip(&limits.joints).enumerate() {
            bound.tighten((limit.speed / slope.abs()).powi(2), Limiting::JointSpeed(joint));
            if !limit.acceleration.is_finite() {
                continue;
            }
            let limiting = Limiting::JointAcceleration(joint);
            if slope.abs() <= FLAT * (slope.abs() + curvature.abs()) {
                bound.tighten(limit.acceleration / curvature.abs(), limiting);
                continue;
            }
            self.all.push(Strip {
                c: -curvature / slope,
                w: limit.acceleration / slope.abs(),
                limiting,
            });
        }
        for (k, first) in self.all.iter().enumerate() {
            for second in &self.all[k + 1..] {
                let apart = (first.c - second.c).abs();
                // The one that bends more is in the way.
                let limiting = if first.c.abs() > second.c.abs() {
                    first.limiting
                } else {
                    second.limiting
                };
                bound.tighten((first.w + second.w) / apart, limiting);
            }
        }
    }

    /// The greatest square of the speed from which a step of length `h` may end at or below `next`.
    fn controllable(&self, h: f64, next: f64, bound: &mut Bound) {
        let per_step = 0.5 / h;
        for strip in &self.all {
            // c x - w <= (next - x) / (2 h), and -x / (2 h) <= c x + w.
            let slope = strip.c + per_step;
            match slope > 0.0 {
                true => bound.tighten((strip.w + next * per_step) / slope, strip.limiting),
                false if slope < 0.0 => bound.tighten(strip.w / -slope, strip.limiting),
                false => {}
            }
        }
    }

    /// The greatest acceleration at this square of the speed.
    fn greatest(&self, x: f64) -> Option<(f64, Limiting)> {
        let all = self
            .all
            .iter()
            .map(|strip| (strip.c * x + strip.w, strip.limiting));
        all.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The fastest profile along a path with these limits; `feeds`: the programmed speed on the step after each point, m/s, one fewer than points.
///
/// # Panics
/// If the numbers of feeds or joints do not belong to the path.
pub fn fastest(path: &JointPath, limits: &MotionLimits, feeds: &[f64]) -> SpeedProfile {
    let count = path.len();
    assert_eq!(feeds.len() + 1, count, "a feed for every step");
    let mut strips = Strips::default();
    // Greatest square of the speed at each point from which the rest can be followed.
    let mut greatest: Vec<Bound> = Vec::with_capacity(count);
    greatest.resize(
        count,
        Bound {
            value: 0.0,
            limiting: Limiting::Stop,
        },
    );
    for index in (0..count - 1).rev() {
        if path.stops(index) {
            continue;
        }
        let feed = feeds[index].min(feeds[index - 1]);
        let mut bound = Bound {
            value: feed * feed,
            limiting: Limiting::Feed,
        };
        strips.fill(path.after(index), limits, &mut bound);
        strips.controllable(path.step(index), greatest[index + 1].value, &mut bound);
        greatest[index] = bound;
    }
    let mut squares = vec![0.0; count];
    let mut limiting = vec![Limiting::Stop; count];
    for index in 0..count - 1 {
        let mut unused = Bound {
            value: f64::INFINITY,
            limiting: Limiting::Feed,
        };
        strips.fill(path.after(index), limits, &mut unused);
        let next = greatest[index + 1];
        let reached = strips
            .greatest(squares[index])
            .map(|(u, by)| (squares[index] + 2.0 * path.step(index) * u, by));
        (squares[index + 1], limiting[index + 1]) = match reached {
            Some((square, by)) if square < next.value => (square.max(0.0), by),
            _ => (next.value, next.limiting),
        };
    }
    let speeds: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    let mut times = vec![0.0; count];
    for index in 0..count - 1 {
        let (h, both) = (path.step(index), speeds[index] + speeds[index + 1]);
        let time = match both > 0.0 {
            true => 2.0 * h / both,
            false => {
                let mut bound = Bound {
                    value: feeds[index] * feeds[index],
                    limiting: Limiting::Feed,
                };
                strips.fill(path.after(index), limits, &mut bound);
                from_rest_to_rest(
                    h,
                    bound.value.sqrt(),
                    strips.greatest(0.0).map_or(f64::INFINITY, |(u, _)| u),
                )
            }
        };
        times[index + 1] = times[index] + time;
    }
    SpeedProfile {
        speeds,
        times,
        limiting,
    }
}

/// Time for a way between two stops with this greatest speed and acceleration, s.
pub(super) fn from_rest_to_rest(way: f64, speed: f64, acceleration: f64) -> f64 {
    if way <= 0.0 {
        return 0.0;
    }
    match acceleration * way <= speed * speed {
        true => 2.0 * (way / acceleration).sqrt(),
        false => way / speed + speed / acceleration,
    }
}

#[cfg(test)]
mod tests;
