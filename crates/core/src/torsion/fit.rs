//! The model of the torsion, fitted to a log.

use std::f64::consts::TAU;

use super::linear::{self, Column, Estimated};
use super::signals::{Signals, at, directions, rms_about_mean};

/// Longest delay of the link encoder that is searched, s.
pub const MOST_DELAY: f64 = 0.1;
/// Iterations of the delay at most, and its precision, s.
const MOST: usize = 30;
const PRECISION: f64 = 1e-9;
/// Part of the greatest speed below which a joint is at rest.
const AT_REST: f64 = 0.003;
/// Samples from the torque to its instrument.
const INSTRUMENT: f64 = 3.0;
/// Fewest samples.
const FEWEST: usize = 50;
/// A value of this many standard uncertainties is found.
const FOUND: f64 = 3.0;
/// Correlation above which two values cannot be distinguished.
pub(crate) const INSEPARABLE: f64 = 0.95;
/// Names of the values, in the order of the columns.
const NAMES: [&str; 4] = ["offset", "delay", "compliance", "step at reversal"];

/// A value with its standard uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Estimated value.
    // unit: that of the name of its field
    pub value: f64,
    /// Standard uncertainty.
    // unit: that of the value
    pub u: f64,
}

impl Estimate {
    /// Whether the value is at least three standard uncertainties from 0.
    pub fn is_found(&self) -> bool {
        self.value.abs() >= FOUND * self.u && self.value != 0.0
    }
}

/// Transmission error of an order of the motor shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Order of the motor shaft.
    pub order: usize,
    /// Amplitude, rad.
    pub amplitude: Estimate,
}

/// Torsion of a joint.
#[derive(Clone, Debug)]
pub struct Torsion {
    /// Delay of the link encoder behind the motor encoder, s; `None` if the joint does not move.
    pub delay: Option<Estimate>,
    /// Offset of the zeros, rad.
    pub offset: Estimate,
    /// Torsion per torque of the motor, rad/(N m); `None` if the torque does not change.
    pub compliance: Option<Estimate>,
    /// Half of the step of the torsion at a reversal, rad; `None` without a reversal.
    pub reversal: Option<Estimate>,
    /// Transmission error, with a gear ratio.
    pub harmonics: Vec<Harmonic>,
    /// Root mean square of link minus motor about its mean, rad.
    pub before_rms: f64,
    /// Root mean square of the residuals, rad.
    pub after_rms: f64,
    /// Number of independent samples.
    pub independent_samples: f64,
    /// Pairs of values that cannot be distinguished, with their correlation.
    pub inseparable: Vec<(&'static str, &'static str, f64)>,
    /// Torque, rad of torsion without delay, offset and transmission error, and the fitted torsion, at each instant.
    pub curve: Vec<[f64; 3]>,
    /// Coefficients of the columns.
    coefficients: Vec<f64>,
    /// Gear ratio and orders.
    gear: Option<(f64, usize)>,
}

/// Fits the model to the signals of a joint, with transmission errors of `orders` orders if the gear ratio is given.
///
/// `None`: fewer than 50 samples; residuals without enough independent ones; a delay above [`MOST_DELAY`].
pub fn fit(signals: &Signals<'_>, gear: Option<(f64, usize)>) -> Option<Torsion> {
    if signals.len() < FEWEST {
        return None;
    }
    let mut delay = 0.0;
    for _ in 0..MOST {
        let design = Design::of(signals, delay, gear);
        let estimated = linear::estimate(&design.columns, &design.target)?;
        let step = estimated.values[1].unwrap_or(0.0);
        delay += step;
        if delay.abs() > MOST_DELAY {
            return None;
        }
        if step.abs() < PRECISION {
            break;
        }
    }
    let design = Design::of(signals, delay, gear);
    let estimated = linear::estimate(&design.columns, &design.target)?;
    Some(Torsion::of(signals, (delay, gear), &design, &estimated))
}

/// Regressors and target at one delay.
struct Design {
    columns: Vec<Column>,
    target: Vec<f64>,
    torques: Vec<f64>,
}

impl Design {
    /// Columns: offset, delay, compliance, step at a reversal, harmonics.
    fn of(signals: &Signals<'_>, delay: f64, gear: Option<(f64, usize)>) -> Design {
        let times = signals.times;
        let last = signals.len() - 1;
        let step = (times[last] - times[0]) / last as f64;
        let margin = INSTRUMENT * step;
        // Instants at which all shifted signals are known.
        let range = [
            times[0] + delay.max(0.0) + margin,
            times[last] + delay.min(0.0) - margin,
        ];
        let within: Vec<usize> = (0..=last)
            .filter(|index| (range[0]..=range[1]).contains(&times[*index]))
            .collect();
        let shifted = |values: &[f64], by: f64| -> Vec<[f64; 2]> {
            within
                .iter()
                .map(|index| at(times, values, times[*index] - delay + by))
                .collect()
        };
        let motor = shifted(signals.motor, 0.0);
        let first = |pairs: &[[f64; 2]]| -> Vec<f64> { pairs.iter().map(|pair| pair[0]).collect() };
        let speeds: Vec<f64> = motor.iter().map(|pair| pair[1]).collect();
        let torques = first(&shifted(signals.torque, 0.0));
        let [earlier, later] = [-margin, margin].map(|by| first(&shifted(signals.torque, by)));
        let fastest = speeds.iter().fold(0.0, |most: f64, speed| most.max(speed.abs()));
        let mut columns = vec![
            Column::exact(vec![1.0; within.len()]),
            Column::exact(speeds.iter().map(|speed| -speed).collect()),
            Column {
                values: torques.iter().map(|torque| -torque).collect(),
                instrument: earlier
                    .iter()
                    .zip(&later)
                    .map(|(one, other)| -(one + other) / 2.0)
                    .collect(),
            },
            Column::exact(directions(&speeds, AT_REST * fastest)),
        ];
        if let Some((ratio, orders)) = gear {
            for order in 1..=orders {
                let angles = || {
                    motor
                        .iter()
                        .map(move |pair| (pair[0] * ratio * order as f64) % TAU)
                };
                columns.push(Column::exact(angles().map(f64::cos).collect()));
                columns.push(Column::exact(angles().map(f64::sin).collect()));
            }
        }
        Design {
            columns,
            target: within
                .iter()
                .zip(&motor)
                .map(|(index, pair)| signals.link[*index] - pair[0])
                .collect(),
            torques,
        }
    }

    /// What the coefficients of all columns from `first` give at a row.
    fn predicted(&self, coefficients: &[f64], row: usize) -> f64 {
        self.columns
            .iter()
            .zip(coefficients)
            .map(|(column, value)| column.values[row] * value)
            .sum()
    }
}

impl Torsion {
    fn of(
        signals: &Signals<'_>,
        found: (f64, Option<(f64, usize)>),
        design: &Design,
        estimated: &Estimated,
    ) -> Torsion {
        let (delay, gear) = found;
        let estimate = |column: usize| {
            estimated.values[column].map(|value| Estimate {
                value,
                u: estimated.u[column],
            })
        };
        let coefficients: Vec<f64> = estimated
            .values
            .iter()
            .map(|value| value.unwrap_or(0.0))
            .collect();
        let harmonics = (1..=gear.map_or(0, |gear| gear.1)).filter_map(|order| {
            let [cosine, sine] = [estimate(2 + 2 * order)?, estimate(3 + 2 * order)?];
            let value = cosine.value.hypot(sine.value);
            // The greater of both: an amplitude has no direction.
            let u = cosine.u.max(sine.u);
            let amplitude = Estimate { value, u };
            Some(Harmonic { order, amplitude })
        });
        let mut inseparable = Vec::new();
        for (one, name) in NAMES.iter().enumerate() {
            for (other, second) in NAMES.iter().enumerate().skip(one + 1) {
                let correlation = estimated.correlation[(one, other)];
                if correlation.abs() > INSEPARABLE {
                    inseparable.push((*name, *second, correlation));
                }
            }
        }
        let row = |row: usize| {
            let elastic: f64 = (2..4)
                .map(|column| design.columns[column].values[row] * coefficients[column])
                .sum();
            [design.torques[row], elastic + estimated.residuals[row], elastic]
        };
        Torsion {
            delay: estimate(1).map(|step| Estimate {
                value: delay,
                u: step.u,
            }),
            offset: estimate(0).unwrap_or_default(),
            compliance: estimate(2),
            reversal: estimate(3),
            harmonics: harmonics.collect(),
            before_rms: signals.difference_rms(),
            after_rms: rms_about_mean(&estimated.residuals),
            independent_samples: estimated.residuals.len() as f64 / estimated.inflation,
            inseparable,
            curve: (0..design.target.len()).map(row).collect(),
            coefficients,
            gear,
        }
    }

    /// Root mean square of link minus its prediction in another log, rad: as it is, and about its mean (with an offset of its own).
    ///
    /// `None`: fewer than 50 samples.
    pub fn prediction_rms(&self, other: &Signals<'_>) -> Option<[f64; 2]> {
        if other.len() < FEWEST {
            return None;
        }
        let design = Design::of(other, self.delay.map_or(0.0, |delay| delay.value), self.gear);
        let mut coefficients = self.coefficients.clone();
        // The delay is in the design.
        coefficients[1] = 0.0;
        let count = design.target.len();
        let residuals: Vec<f64> = (0..count)
            .map(|row| design.target[row] - design.predicted(&coefficients, row))
            .collect();
        let mean_square =
            residuals.iter().map(|residual| residual * residual).sum::<f64>() / count.max(1) as f64;
        Some([mean_square.sqrt(), rms_about_mean(&residuals)])
    }
}

#[cfg(test)]
mod tests;
