//! Signals of a joint, and their values between samples.

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
pub(super) fn rms_about_mean(values: &[f64]) -> f64 {
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
    fn the_last_direction_is_kept_at_rest() {
        assert_eq!(
            directions(&[0.0, 2.0, 0.5, -2.0, 0.0], 1.0),
            [0.0, 1.0, 1.0, -1.0, -1.0]
        );
    }
}
