//! Prior knowledge of any arm: typical compliances.
//!
//! Compliances are positive and differ by powers, so the knowledge is of their logarithms, normal with mean and
//! standard uncertainty. A bending compliance is relative to the drive of its joint. Every prior is weak: a factor of 3
//! to 7 either way is one standard uncertainty, and a few good tests outweigh it.
//!
//! | part | prior | from |
//! |---|---|---|
//! | revolute drive | 2e-6 rad/(N m), factor e^2 | middle of 6 to 250 kg arms, Shneor & Chapsky 2021 to KUKA KR210 |
//! | prismatic drive | 1e-8 m/N, factor e^2 | ball screw, 100 N/um |
//! | bending, floor | drive / 3.3, factor e^1.2 | geometric mean and spread of 12 ratios of Staubli TX200, Huynh et al. 2020 |
//! | tool and holder | 3e-7 m/N, factor e^1.5 | holder 1.07e-7 and tool 9.34e-7 m/N of a roboforming cell, Sci. Rep. 14:20291 |
//! | lost motion | 3e-5 rad, factor e | a tenth of an arc minute: reducers of industrial arms |

use nalgebra::{DMatrix, DVector};

use super::unknown::{Role, Unknown};
use crate::robot::Attachment;

/// Kind of prior knowledge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prior {
    /// Typical compliances within powers of ten: the table of this module.
    Typical,
    /// None, except that no compliance is negative.
    None,
}

/// `sum factor * ln c = mean +- standard_uncertainty`.
#[derive(Clone, Debug, PartialEq)]
pub struct LogPrior {
    /// Index of the unknown, factor.
    pub parts: Vec<(usize, f64)>,
    /// Of the sum.
    pub mean: f64,
    /// Of the sum.
    pub standard_uncertainty: f64,
}

impl LogPrior {
    /// These priors as rows over `count` unknowns, and their values; both over the standard uncertainties.
    pub(super) fn rows(priors: &[LogPrior], count: usize) -> (DMatrix<f64>, DVector<f64>) {
        let mut rows = DMatrix::zeros(priors.len(), count);
        for (row, prior) in priors.iter().enumerate() {
            for (k, factor) in &prior.parts {
                rows[(row, *k)] = factor / prior.standard_uncertainty;
            }
        }
        let requested = priors.iter().map(|prior| prior.mean / prior.standard_uncertainty);
        (rows, DVector::from_iterator(priors.len(), requested))
    }
}

/// Compliance of a drive, rad/(N m).
pub const DRIVE: f64 = 2e-6;
/// Compliance of a prismatic drive, m/N.
pub const SLIDING_DRIVE: f64 = 1e-8;
const DRIVE_FACTOR: f64 = 2.0;
/// A bending is stiffer than its drive by this.
const STIFFER: f64 = 3.3;
const BENDING_FACTOR: f64 = 1.2;
/// m/N
const TOOL: f64 = 3e-7;
const TOOL_FACTOR: f64 = 1.5;
/// rad
const LOST_MOTION: f64 = 3e-5;
const LOST_MOTION_FACTOR: f64 = 1.0;

/// The typical prior, one row per unknown.
pub fn typical(unknowns: &[Unknown]) -> Vec<LogPrior> {
    let drive_of = |attachment: Attachment| {
        let attachment = if attachment == Attachment::Base {
            Attachment::Joint(0)
        } else {
            attachment
        };
        unknowns
            .iter()
            .position(|other| other.role == Role::Drive && other.turns() && other.attachment == attachment)
    };
    let row = |(index, unknown): (usize, &Unknown)| {
        let alone = |value: f64, factor: f64| LogPrior {
            parts: vec![(index, 1.0)],
            mean: value.ln(),
            standard_uncertainty: factor,
        };
        match unknown.role {
            Role::Drive if unknown.turns() => alone(DRIVE, DRIVE_FACTOR),
            Role::Drive => alone(SLIDING_DRIVE, DRIVE_FACTOR),
            Role::Tool => alone(TOOL, TOOL_FACTOR),
            Role::LostMotion { .. } => alone(LOST_MOTION, LOST_MOTION_FACTOR),
            Role::Bending | Role::Base => match drive_of(unknown.attachment) {
                Some(drive) => LogPrior {
                    parts: vec![(index, 1.0), (drive, -1.0)],
                    mean: -STIFFER.ln(),
                    standard_uncertainty: BENDING_FACTOR,
                },
                None => alone(DRIVE / STIFFER, DRIVE_FACTOR.hypot(BENDING_FACTOR)),
            },
        }
    };
    unknowns.iter().enumerate().map(row).collect()
}

/// The middle of the typical prior, one value per unknown.
pub fn typical_sizes(unknowns: &[Unknown]) -> Vec<f64> {
    let size = |unknown: &Unknown| match unknown.role {
        Role::Drive if unknown.turns() => DRIVE,
        Role::Drive => SLIDING_DRIVE,
        Role::Tool => TOOL,
        Role::LostMotion { .. } => LOST_MOTION,
        Role::Bending | Role::Base => DRIVE / STIFFER,
    };
    unknowns.iter().map(size).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::chain::Axis;

    #[test]
    fn the_ratio_of_bending_to_drive_is_that_of_the_tx200() {
        // 1e6 N m/rad: drive, then bending about x and y of each joint; Huynh et al. 2020 as transcribed in
        // rafisondi/sensitivity_milling_analysis.
        let rows = [
            [2.3, 13.1, 17.0],
            [8.6, 4.1, 19.9],
            [2.8, 18.8, 2.9],
            [3.0, 2.3, 3.1],
            [0.2, 2.1, 0.9],
            [0.9, 14.8, 8.3],
        ];
        let logs: Vec<f64> = rows
            .iter()
            .flat_map(|[z, x, y]: &[f64; 3]| [(x / z).ln(), (y / z).ln()])
            .collect();
        let mean = logs.iter().sum::<f64>() / 12.0;
        let variance = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / 11.0;
        assert!((mean.exp() - STIFFER).abs() < 0.05, "{}", mean.exp());
        assert!(
            (variance.sqrt() - BENDING_FACTOR).abs() < 0.05,
            "{}",
            variance.sqrt()
        );
    }

    #[test]
    fn the_middle_satisfies_every_row() {
        let unknowns = [
            Unknown::about(Attachment::Joint(0), Axis::Z, Role::Drive),
            Unknown::about(Attachment::Joint(0), Axis::X, Role::Bending),
            Unknown::about(Attachment::Base, Axis::X, Role::Base),
            Unknown::along(Attachment::Flange, Axis::X, Role::Tool),
            Unknown::along(Attachment::Joint(1), Axis::X, Role::Drive),
        ];
        let sizes = typical_sizes(&unknowns);
        for row in typical(&unknowns) {
            let sum: f64 = row.parts.iter().map(|(k, factor)| factor * sizes[*k].ln()).sum();
            assert!((sum - row.mean).abs() < 1e-12, "{row:?}");
        }
    }

    #[test]
    fn the_middle_meets_all_rows_and_a_factor_deviates_by_its_standard_uncertainty() {
        let unknowns = [
            Unknown::about(Attachment::Joint(0), Axis::Z, Role::Drive),
            Unknown::about(Attachment::Joint(0), Axis::X, Role::Bending),
            Unknown::along(Attachment::Flange, Axis::X, Role::Tool),
        ];
        let priors = typical(&unknowns);
        let (rows, requested) = LogPrior::rows(&priors, 5);
        assert_eq!((rows.shape(), requested.len()), ((3, 5), 3));
        let sizes = typical_sizes(&unknowns);
        let logs = DVector::from_fn(5, |k, _| sizes.get(k).map_or(0.0, |size| size.ln()));
        assert!((&rows * &logs - &requested).norm() < 1e-12);
        for (k, prior) in priors.iter().enumerate() {
            let mut off = logs.clone();
            off[k] += prior.standard_uncertainty;
            // Its own row by one; a drive also changes the bending that is relative to it.
            let away = &rows * &off - &requested;
            assert!((away[k] - 1.0).abs() < 1e-12, "{k}: {away}");
        }
        let (none, nothing) = LogPrior::rows(&[], 4);
        assert_eq!((none.shape(), nothing.len()), ((0, 4), 0));
    }
}
