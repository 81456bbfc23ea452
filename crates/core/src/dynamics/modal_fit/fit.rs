//! The modes of a set of FRFs, with their standard uncertainties.
//!
//! ```text
//! u^2(theta) = (J^T J)^-1 v      cov(a_kr, a_lr) = delta_kl s_k^2 v (Phi_k^+ Phi_k^+T)_rr + g_kr^T cov(theta) g_lr
//! g_kr = -(Phi_k^+ dPhi_k/dtheta c_k)_r      v = (1 + rho) / (1 - rho)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `theta`, `J`, `Phi`, `c`, `s` | as in `refine` | - |
//! | `a_kr` | residue | 1/kg |
//! | `rho` | correlation of the residuals of neighbouring frequencies, at least 0 | - |
//! | `v` | increase of the variance by this correlation | - |
//!
//! The uncertainties contain what the residuals show: noise. An error of calibration of hammer or sensor is not in them. Source: JCGM 100,
//! nonlinear least squares of any text; `v` is that of an autoregressive process of first order (recalled).

use nalgebra::{Complex, DMatrix, DVector};
use thiserror::Error;

use super::complexity::complexity;
use super::denominator::{Pole, poles_by_order};
use super::frf::Frf;
use super::model::terms;
use super::refine::Refined;
use super::residual_search::with_weak_modes;
use super::selection::select;
use super::stable::candidates;

/// The highest order of the denominator.
const HIGHEST_ORDER: usize = 40;
/// Frequencies per order at least.
const PER_ORDER: usize = 4;
/// Candidates that are fitted together at most.
const MOST_CANDIDATES: usize = 25;
/// Fewest frequencies of an FRF.
pub const FEWEST_FREQUENCIES: usize = 16;

/// What is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Band of angular frequencies, rad/s.
    pub band: [f64; 2],
    /// Number of modes; none: as many as the FRFs determine.
    pub modes: Option<usize>,
    /// Whether weak modes are sought in the residuals of the others: these are noise then, not an error of the model.
    pub seeks_weak: bool,
}

/// Why there are no modes.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum FitError {
    /// Too few frequencies.
    #[error("an FRF has {0} frequencies in the band; at least {FEWEST_FREQUENCIES} are necessary")]
    TooFew(usize),
    /// No FRFs.
    #[error("there are no frequency response functions")]
    NoFrfs,
    /// No stable pole.
    #[error("no mode of vibration is found in the band")]
    NoMode,
}

/// Modes of a set of FRFs.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalFit {
    /// The modes, frequencies rising.
    pub modes: Vec<FittedMode>,
    /// The FRFs, in the given order.
    pub frfs: Vec<FittedFrf>,
    /// Stable poles that were found, modes among them.
    pub candidates: usize,
}

/// A mode.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedMode {
    /// `omega`: undamped angular frequency, rad/s.
    pub angular_frequency: f64,
    /// Its standard uncertainty, rad/s.
    pub angular_frequency_u: f64,
    /// `zeta`: damping ratio.
    pub damping_ratio: f64,
    /// Its standard uncertainty.
    pub damping_ratio_u: f64,
    /// Residue of each FRF, 1/kg.
    pub residues: Vec<f64>,
    /// Their covariance, 1/kg^2.
    pub residues_covariance: DMatrix<f64>,
    /// Mean phase deviation of its residues from those of a real mode, rad; none if complex residues are not determined.
    pub phase_deviation: Option<f64>,
    /// Modal phase collinearity, 0 to 1: 1 if all residues have one phase.
    pub collinearity: Option<f64>,
}

/// How an FRF is described.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedFrf {
    /// `l`: lower residual, 1/kg.
    pub lower: f64,
    /// `u`: upper residual, m/N.
    pub upper: f64,
    /// Fraction of the weighted sum of squares that modes and residuals describe.
    pub explained: f64,
    /// Root mean square of measured less fitted receptance, m/N.
    pub residual: f64,
    /// Correlation of the residuals of neighbouring frequencies.
    pub correlation: f64,
}

impl ModalFit {
    /// Receptance of FRF `index` by modes and residuals at the angular frequency `w` (rad/s), m/N.
    ///
    /// # Panics
    /// If there is no such FRF.
    pub fn receptance(&self, index: usize, w: f64) -> Complex<f64> {
        let poles: Vec<Pole> = (self.modes.iter())
            .map(|mode| Pole {
                angular_frequency: mode.angular_frequency,
                damping_ratio: mode.damping_ratio,
            })
            .collect();
        let frf = &self.frfs[index];
        let residues = self.modes.iter().map(|mode| mode.residues[index]);
        let coefficients = residues.chain([frf.lower, frf.upper]);
        let parts = terms(&poles, w).into_iter().zip(coefficients);
        parts.map(|(term, coefficient)| term * coefficient).sum()
    }
}

/// Fits the modes of `frfs` within the band.
///
/// # Errors
/// No FRFs, too few frequencies, no mode.
pub fn fit(frfs: &[Frf], options: &FitOptions) -> Result<ModalFit, FitError> {
    let frfs: Vec<Frf> = frfs.iter().map(|frf| frf.within(options.band)).collect();
    let fewest = frfs.iter().map(|frf| frf.receptance.len()).min();
    let fewest = fewest.ok_or(FitError::NoFrfs)?;
    if fewest < FEWEST_FREQUENCIES {
        return Err(FitError::TooFew(fewest));
    }
    let highest = HIGHEST_ORDER.min(fewest / PER_ORDER);
    let found = candidates(&poles_by_order(&frfs, options.band, highest));
    let count = found.len();
    let most = MOST_CANDIDATES.min(fewest / PER_ORDER);
    let poles: Vec<Pole> = found.iter().take(most).map(|candidate| candidate.pole).collect();
    let mut refined = select(&frfs, options.band, &poles, options.modes).ok_or(FitError::NoMode)?;
    if options.seeks_weak {
        let most = options.modes.unwrap_or(most).min(most);
        refined = with_weak_modes(&frfs, options.band, refined, most);
    }
    let fitted: Vec<FittedFrf> = frfs
        .iter()
        .enumerate()
        .map(|(k, frf)| described(frf, &refined, k))
        .collect();
    let mut modes = modes_of(&refined, &fitted).ok_or(FitError::NoMode)?;
    if let Some(found) = complexity(&frfs, &refined.poles) {
        for (mode, own) in modes.iter_mut().zip(found) {
            mode.phase_deviation = Some(own.phase_deviation);
            mode.collinearity = Some(own.collinearity);
        }
    }
    modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
    Ok(ModalFit {
        modes,
        frfs: fitted,
        candidates: count,
    })
}

fn described(frf: &Frf, refined: &Refined, index: usize) -> FittedFrf {
    let solved = &refined.solved[index];
    let count = refined.poles.len();
    let squares = solved.residuals.norm_squared();
    let plain: f64 = (frf.weights.iter().enumerate())
        .map(|(k, g)| (solved.residuals[2 * k].powi(2) + solved.residuals[2 * k + 1].powi(2)) / (g * g))
        .sum();
    let ahead: f64 = (2..solved.residuals.len())
        .map(|k| solved.residuals[k] * solved.residuals[k - 2])
        .sum();
    FittedFrf {
        lower: solved.coefficients[count],
        upper: solved.coefficients[count + 1],
        explained: 1.0 - squares / frf.energy().max(f64::MIN_POSITIVE),
        residual: (plain / frf.weights.len() as f64).sqrt(),
        correlation: ahead / squares.max(f64::MIN_POSITIVE),
    }
}

/// Modes with uncertainties; `None` if the poles are not determined.
fn modes_of(refined: &Refined, fitted: &[FittedFrf]) -> Option<Vec<FittedMode>> {
    let inverse = inverse(&refined.information)?;
    // The largest increase of all FRFs, for the poles that all of them determine.
    let increase = |frf: &FittedFrf| {
        let rho = frf.correlation.clamp(0.0, 0.99);
        (1.0 + rho) / (1.0 - rho)
    };
    let covariance = inverse * fitted.iter().map(increase).fold(1.0, f64::max);
    let gains: Vec<DMatrix<f64>> = (refined.solved.iter().zip(&refined.slopes))
        .map(|(solved, slope)| -(&solved.inverse * slope))
        .collect();
    let modes = refined.poles.iter().enumerate().map(|(r, pole)| {
        let size = fitted.len();
        let mut of_residues = DMatrix::zeros(size, size);
        for k in 0..size {
            let gain = &covariance * gains[k].row(r).transpose();
            for l in 0..size {
                of_residues[(l, k)] = gains[l].row(r).transpose().dot(&gain);
            }
            let own = refined.solved[k].inverse.row(r).norm_squared();
            of_residues[(k, k)] += refined.deviations[k].powi(2) * increase(&fitted[k]) * own;
        }
        FittedMode {
            angular_frequency: pole.angular_frequency,
            angular_frequency_u: covariance[(2 * r, 2 * r)].max(0.0).sqrt(),
            damping_ratio: pole.damping_ratio,
            damping_ratio_u: covariance[(2 * r + 1, 2 * r + 1)].max(0.0).sqrt(),
            residues: refined
                .solved
                .iter()
                .map(|solved| solved.coefficients[r])
                .collect(),
            residues_covariance: of_residues,
            phase_deviation: None,
            collinearity: None,
        }
    });
    Some(modes.collect())
}

/// The inverse of a symmetric positive definite matrix.
fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.nrows();
    let mut found = DMatrix::zeros(size, size);
    for k in 0..size {
        let mut unit = DVector::zeros(size);
        unit[k] = 1.0;
        found.set_column(k, &super::refine::scaled_solve(matrix, &unit)?);
    }
    Some(found)
}
