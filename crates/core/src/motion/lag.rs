//! Joints that follow late: a velocity loop of first order, with feed-forward.
//!
//! ```text
//! T dq/dt = q_c - q + k T dq_c/dt
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `q_c`, `q` | commanded and actual position | rad (m) |
//! | `T` | time constant, the inverse of the loop gain `Kv` | s |
//! | `k` | feed-forward of the speed: 0 none, 1 complete | - |
//!
//! At constant speed the joint is `(1 - k) T dq_c/dt` late. On a circle of angular speed `w` the gain is `sqrt(1 + (k w T)^2) / sqrt(1 + (w T)^2)`: without feed-forward
//! the radius shrinks by about half the square of the angle per time constant.
//!
//! Source: second-order terms neglected, Weck, machine tools volume 3 (recalled); gain by the transfer function.

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// Time constant, s.
    pub time: f64,
    /// Feed-forward of the speed, 0 to 1.
    pub feed_forward: f64,
}

impl Lag {
    /// The actual positions, rad (m), of a joint commanded to these positions at these times, s, which do not fall, and straight between them; it begins at rest at the
    /// first.
    ///
    /// # Panics
    /// If there are fewer times than positions.
    pub fn followed(&self, times: &[f64], commanded: &[f64]) -> Vec<f64> {
        let Some(first) = commanded.first() else {
            return Vec::new();
        };
        if self.time <= 0.0 {
            return commanded.to_vec();
        }
        let mut actual = Vec::with_capacity(commanded.len());
        actual.push(*first);
        let mut here = *first;
        for (times, pair) in times.windows(2).zip(commanded.windows(2)) {
            let step = times[1] - times[0];
            if step > 0.0 {
                // At constant speed the error tends to this.
                let steady = (self.feed_forward - 1.0) * self.time * (pair[1] - pair[0]) / step;
                here = pair[1] + steady + (here - pair[0] - steady) * (-step / self.time).exp();
            } else {
                // A step of the command, of which the feed-forward passes its part on at once.
                here += self.feed_forward * (pair[1] - pair[0]);
            }
            actual.push(here);
        }
        actual
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn at_constant_speed_a_joint_is_a_time_constant_late() {
        for feed_forward in [0.0, 0.6, 1.0] {
            let lag = Lag {
                time: 0.02,
                feed_forward,
            };
            let commanded: Vec<f64> = (0..1000).map(|i| 0.3 * f64::from(i) * 1e-3).collect();
            let times: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
            let actual = lag.followed(&times, &commanded);
            let late = commanded[999] - actual[999];
            assert!((late - (1.0 - feed_forward) * 0.02 * 0.3).abs() < 1e-12, "{late}");
        }
    }

    #[test]
    fn the_radius_of_a_circle_shrinks_by_half_the_square_of_the_angle_per_time_constant() {
        let (time, w, step) = (0.015, 4.0, 1e-5);
        for feed_forward in [0.0_f64, 0.5] {
            let lag = Lag { time, feed_forward };
            let count = (3.0 * TAU / w / step) as usize;
            let axis = |phase: f64| {
                let commanded: Vec<f64> = (0..count).map(|i| (w * i as f64 * step + phase).sin()).collect();
                let times: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
                *lag.followed(&times, &commanded).last().unwrap()
            };
            let radius = axis(0.0).hypot(axis(TAU / 4.0));
            let wt = w * time;
            let exact = (1.0 + (feed_forward * wt).powi(2)).sqrt() / (1.0 + wt * wt).sqrt();
            assert!((radius - exact).abs() < 1e-7, "{radius} {exact}");
            if feed_forward == 0.0 {
                assert!((1.0 - radius - 0.5 * wt * wt).abs() < 0.01 * wt * wt);
            }
        }
    }
}
