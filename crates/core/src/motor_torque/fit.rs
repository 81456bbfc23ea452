//! Friction, inertia and load, fitted to a log.

use super::load::{LoadTerm, LoadUnit};
use crate::torsion::linear::{self, Column, Estimated};
use crate::torsion::signals::{derivatives, half_window, rms_about_mean};
use crate::torsion::{Estimate, INSEPARABLE};

/// Part of the greatest speed below which a joint is at rest.
const AT_REST: f64 = 0.003;
/// Fewest instants in motion.
const FEWEST: usize = 50;
/// Columns before the loads: direction, speed, acceleration.
const OF_MOTION: [&str; 3] = ["Coulomb friction", "viscous friction", "inertia"];
/// The last column.
const CONSTANT: &str = "constant part";

/// Signals of one joint, all of one length, at rising times.
#[derive(Clone, Copy, Debug)]
pub struct MotorSignals<'a> {
    /// Times, s.
    pub times: &'a [f64],
    /// Position of the joint by its motor, rad.
    pub motor: &'a [f64],
    /// Torque of the motor, N m.
    pub torque: &'a [f64],
    /// Functions of the positions that describe the load.
    pub loads: &'a [LoadTerm],
}

/// The coefficient of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadEstimate {
    /// Name of its function.
    pub name: String,
    /// Unit of the coefficient.
    pub unit: LoadUnit,
    /// The coefficient.
    // unit: that of `unit`
    pub estimate: Estimate,
}

/// What makes up the torque of a motor.
#[derive(Clone, Debug)]
pub struct MotorTorque {
    /// Coulomb friction, N m; with the constant part, if the joint moves in one direction only.
    pub coulomb: Option<Estimate>,
    /// Viscous friction, N m s/rad of the joint.
    pub viscous: Option<Estimate>,
    /// Torque per acceleration of the joint, kg m^2.
    pub inertia: Option<Estimate>,
    /// Coefficients of the loads that the log determines.
    pub loads: Vec<LoadEstimate>,
    /// Constant part, N m.
    pub constant: Option<Estimate>,
    /// Terms that the log does not determine.
    pub left_out: Vec<String>,
    /// Root mean square of the torque in motion about its mean, N m.
    pub before_rms: f64,
    /// Root mean square of the residuals, N m.
    pub after_rms: f64,
    /// Number of independent instants.
    pub independent_samples: f64,
    /// Pairs of values that cannot be distinguished, with their correlation.
    pub inseparable: Vec<(String, String, f64)>,
    /// Coefficient of every column, 0 where it was left out.
    coefficients: Vec<f64>,
}

/// Fits the model to the signals of a joint.
///
/// `None`: fewer than 50 instants in motion; residuals without enough independent ones.
pub fn fit(signals: &MotorSignals<'_>) -> Option<MotorTorque> {
    let design = Design::of(signals)?;
    let (kept, estimated) = design.estimate()?;
    Some(MotorTorque::of(&design, &kept, &estimated))
}

/// Regressors and target of the instants in motion.
struct Design {
    names: Vec<String>,
    /// Number of columns of each load, and the unit of each of these columns.
    loads: Vec<usize>,
    load_units: Vec<LoadUnit>,
    columns: Vec<Column>,
    torques: Vec<f64>,
}

impl Design {
    fn of(signals: &MotorSignals<'_>) -> Option<Design> {
        let MotorSignals {
            times,
            motor,
            torque,
            loads,
        } = *signals;
        let count = times.len().min(motor.len()).min(torque.len());
        if count < FEWEST {
            return None;
        }
        let rates = derivatives(times, motor);
        let fastest = rates.iter().fold(0.0, |most: f64, rate| most.max(rate[0].abs()));
        let half = half_window(times);
        let moving: Vec<usize> = (half..count.saturating_sub(half))
            .filter(|index| rates[*index][0].abs() > AT_REST * fastest)
            .collect();
        if moving.len() < FEWEST {
            return None;
        }
        let column =
            |of: &dyn Fn(usize) -> f64| Column::exact(moving.iter().map(|index| of(*index)).collect());
        let mut columns = vec![
            column(&|index| rates[index][0].signum()),
            column(&|index| rates[index][0]),
            column(&|index| rates[index][1]),
        ];
        let mut names = OF_MOTION.map(str::to_owned).to_vec();
        let mut load_units = Vec::new();
        for load in loads {
            columns.extend(load.values.iter().map(|values| column(&|index| values[index])));
            names.extend(load.names.iter().cloned());
            load_units.extend(load.values.iter().map(|_| load.unit));
        }
        columns.push(column(&|_| 1.0));
        names.push(CONSTANT.to_owned());
        Some(Design {
            names,
            loads: loads.iter().map(|load| load.values.len()).collect(),
            load_units,
            columns,
            torques: moving.iter().map(|index| torque[*index]).collect(),
        })
    }

    /// The columns that the log determines, and their coefficients.
    ///
    /// The columns of motion and the first load are always used. Each further load, and at last the constant part, is used if no coefficient of it has a correlation above the limit with that of a column before.
    fn estimate(&self) -> Option<(Vec<usize>, Estimated)> {
        let used = |kept: &[usize]| {
            let columns: Vec<Column> = kept.iter().map(|index| self.columns[*index].clone()).collect();
            linear::estimate(&columns, &self.torques)
        };
        let first = OF_MOTION.len();
        let mut kept: Vec<usize> = (0..first).collect();
        let mut estimated = used(&kept)?;
        let mut next = first;
        for size in self.loads.iter().copied().chain([1]) {
            let wider: Vec<usize> = kept.iter().copied().chain(next..next + size).collect();
            next += size;
            let Some(found) = used(&wider) else { continue };
            let is_determined = (kept.len()..wider.len()).all(|new| {
                found.values[new].is_some()
                    && (0..kept.len()).all(|old| found.correlation[(old, new)].abs() <= INSEPARABLE)
            });
            if is_determined || (kept.len() == first && next < self.columns.len()) {
                (kept, estimated) = (wider, found);
            }
        }
        Some((kept, estimated))
    }
}

impl MotorTorque {
    fn of(design: &Design, kept: &[usize], estimated: &Estimated) -> MotorTorque {
        let estimate = |column: usize| {
            let place = kept.iter().position(|index| *index == column)?;
            estimated.values[place].map(|value| Estimate {
                value,
                u: estimated.u[place],
            })
        };
        let all: Vec<Option<Estimate>> = (0..design.columns.len()).map(estimate).collect();
        let last = all.len() - 1;
        let is_zero = |column: usize| design.columns[column].values.iter().all(|value| *value == 0.0);
        let mut inseparable = Vec::new();
        for (one, first) in kept.iter().enumerate() {
            for (other, second) in kept.iter().enumerate().skip(one + 1) {
                let correlation = estimated.correlation[(one, other)];
                if correlation.abs() > INSEPARABLE {
                    let names = [first, second].map(|index| design.names[*index].clone());
                    let [first, second] = names;
                    inseparable.push((first, second, correlation));
                }
            }
        }
        MotorTorque {
            coulomb: all[0],
            viscous: all[1],
            inertia: all[2],
            loads: (OF_MOTION.len()..last)
                .zip(&design.load_units)
                .filter_map(|(column, unit)| {
                    all[column].map(|estimate| LoadEstimate {
                        name: design.names[column].clone(),
                        unit: *unit,
                        estimate,
                    })
                })
                .collect(),
            constant: all[last],
            left_out: (0..=last)
                .filter(|column| all[*column].is_none() && !is_zero(*column))
                .map(|column| design.names[column].clone())
                .collect(),
            before_rms: rms_about_mean(&design.torques),
            after_rms: root_mean_square(&estimated.residuals),
            independent_samples: estimated.residuals.len() as f64 / estimated.inflation,
            inseparable,
            coefficients: all
                .iter()
                .map(|estimate| estimate.map_or(0.0, |estimate| estimate.value))
                .collect(),
        }
    }

    /// Root mean square in another log, N m: of the torque about its mean, less its prediction, and less its prediction with a constant part of its own.
    ///
    /// `None`: fewer than 50 instants in motion, or loads of other functions.
    pub fn prediction_rms(&self, other: &MotorSignals<'_>) -> Option<[f64; 3]> {
        let design = Design::of(other)?;
        if design.columns.len() != self.coefficients.len() {
            return None;
        }
        let residuals: Vec<f64> = (0..design.torques.len())
            .map(|row| {
                let predicted: f64 = (design.columns.iter().zip(&self.coefficients))
                    .map(|(column, coefficient)| column.values[row] * coefficient)
                    .sum();
                design.torques[row] - predicted
            })
            .collect();
        Some([
            rms_about_mean(&design.torques),
            root_mean_square(&residuals),
            rms_about_mean(&residuals),
        ])
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().map(|value| value * value).sum();
    (sum / values.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests;
