//! Signals of a joint, their values between samples, and their derivatives.

use nalgebra::{Matrix3, Vector3};

/// Signals of one joint, all of one length, at rising times.
#[derive(Clone, Copy, Debug)]
pub struct Signals<'a> {
    /// Times, s.
    pub times: &'a [f64],
    /// Motor encoder, reduced to the joint, rad.
    pub motor: &'a [f64],
    /// Link encoder, rad.
    pub link: &'a [f64],
    /// Torque of the motor, N m.
    pub torque: &'a [f64],
}

impl Signals<'_> {
    /// Number of instants that all signals have.
    pub fn len(&self) -> usize {
        let lengths = [self.motor.len(), self.link.len(), self.torque.len()];
        lengths.into_iter().fold(self.times.len(), usize::min)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Root mean square of link minus motor about its mean, rad.
    pub fn difference_rms(&self) -> f64 {
        let differences: Vec<f64> = self
            .link
            .iter()
            .zip(self.motor)
            .map(|(link, motor)| link - motor)
            .collect();
        rms_about_mean(&differences)
    }
}

/// Root mean square about the mean; 0 of none.
pub(crate) fn rms_about_mean(values: &[f64]) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Value and derivative of a signal at a time: a cubic through two samples with the slopes of the parabolas through their neighbours.
///
/// The time is clamped to that of the signal.
pub(super) fn at(times: &[f64], values: &[f64], time: f64) -> [f64; 2] {
    let last = times.len().min(values.len()) - 1;
    if last == 0 {
        return [values[0], 0.0];
    }
    let time = time.clamp(times[0], times[last]);
    let low = times[..=last]
        .partition_point(|other| *other <= time)
        .clamp(1, last)
        - 1;
    let step = times[low + 1] - times[low];
    let part = (time - times[low]) / step;
    let [from, to] = [
        slope(times, values, low, last),
        slope(times, values, low + 1, last),
    ]
    .map(|slope| slope * step);
    let rise = values[low + 1] - values[low];
    let [second, third] = [3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise];
    [
        values[low] + part * (from + part * (second + part * third)),
        (from + part * (2.0 * second + part * 3.0 * third)) / step,
    ]
}

fn slope(times: &[f64], values: &[f64], index: usize, last: usize) -> f64 {
    let rate = |low: usize| (values[low + 1] - values[low]) / (times[low + 1] - times[low]);
    if index == 0 {
        return rate(0);
    }
    if index == last {
        return rate(last - 1);
    }
    let [before, after] = [times[index] - times[index - 1], times[index + 1] - times[index]];
    (rate(index - 1) * after + rate(index) * before) / (before + after)
}

/// Half of the time of the parabolas of [`derivatives`], s, and samples of it at least.
const HALF_TIME: f64 = 0.02;
const FEWEST_HALF: usize = 3;

/// Samples before and after each instant that [`derivatives`] uses.
pub(crate) fn half_window(times: &[f64]) -> usize {
    let last = times.len().saturating_sub(1).max(1);
    let step = (times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0)) / last as f64;
    let samples = (HALF_TIME / step).round();
    // A step of zero has no window that is longer than the log.
    (samples.min(last as f64) as usize).max(FEWEST_HALF)
}

/// First and second derivative at each instant, of the parabola that fits the samples within [`half_window`] of it best; fewer at the ends.
///
/// Not checked: that times rise, and that there are at least four samples.
pub(crate) fn derivatives(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let count = times.len().min(values.len());
    let half = half_window(&times[..count]);
    (0..count)
        .map(|index| {
            let window = index.saturating_sub(half)..(index + half + 1).min(count);
            parabola(times[index], &times[window.clone()], &values[window])
        })
        .collect()
}

/// Torque of a motor, N m, less what accelerates its rotor; `rotor`: torque per acceleration of the joint, kg m^2 (inertia times gear ratio).
///
/// Not checked: that the signals have one length, at rising times.
pub fn without_rotor(times: &[f64], motor: &[f64], torque: &[f64], rotor: f64) -> Vec<f64> {
    if rotor == 0.0 {
        return torque.to_vec();
    }
    let rates = derivatives(times, motor);
    torque
        .iter()
        .zip(rates)
        .map(|(torque, rate)| torque - rotor * rate[1])
        .collect()
}

/// Derivatives at `time` of the parabola through samples by least squares.
fn parabola(time: f64, times: &[f64], values: &[f64]) -> [f64; 2] {
    // In units of the window: sums of powers are of the order of 1.
    let unit = times[times.len() - 1] - times[0];
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (other, value) in times.iter().zip(values) {
        let x = (other - time) / unit;
        let row = Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        right += row * (value - values[0]);
    }
    normal.try_inverse().map_or([0.0; 2], |inverse| {
        let found = inverse * right;
        [found.y / unit, 2.0 * found.z / (unit * unit)]
    })
}

/// Direction of the last motion at each instant: -1 or 1 from where the speed was above `threshold`, 0 before.
pub(super) fn directions(speeds: &[f64], threshold: f64) -> Vec<f64> {
    let mut now = 0.0;
    let of = |speed: &f64| {
        if speed.abs() > threshold {
            now = speed.signum();
        }
        now
    };
    speeds.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_between_uneven_samples() {
        let times = [0.0, 1.0, 2.5, 3.0, 4.0];
        let values = times.map(|t| 2.0 * t * t - t);
        for time in [1.2, 2.0, 2.7] {
            let [value, rate] = at(&times, &values, time);
            assert!((value - (2.0 * time * time - time)).abs() < 1e-12);
            assert!((rate - (4.0 * time - 1.0)).abs() < 1e-12);
        }
        assert_eq!(at(&times, &values, -1.0)[0], 0.0);
    }

    #[test]
    fn derivatives_of_a_parabola_are_exact_at_uneven_samples() {
        let times: Vec<f64> = (0..40)
            .map(|k| 0.004 * f64::from(k) + 0.001 * f64::from(k % 3))
            .collect();
        let values: Vec<f64> = times.iter().map(|t| 2.0 * t * t - t + 5.0).collect();
        for (time, [first, second]) in times.iter().zip(derivatives(&times, &values)) {
            assert!((first - (4.0 * time - 1.0)).abs() < 1e-9, "{time}: {first}");
            assert!((second - 4.0).abs() < 1e-6, "{time}: {second}");
        }
    }

    #[test]
    fn the_last_direction_is_kept_at_rest() {
        assert_eq!(
            directions(&[0.0, 2.0, 0.5, -2.0, 0.0], 1.0),
            [0.0, 1.0, 1.0, -1.0, -1.0]
        );
    }
}
