//! How far modes are from real (normal) modes.
//!
//! ```text
//! H_k = sum_r ( R_kr / (i w - p_r) + R*_kr / (i w - p*_r) ) + ... = sum_r (a_kr + i w b_kr) q_r + ...
//! b = 2 Re R        a = -2 Re (R p*)        a real mode: Re R = 0
//! mean phase deviation = sum_k |R_k| |angle| / sum_k |R_k|        angle of R_k from the imaginary axis
//! collinearity = ( (Sxx - Syy)^2 + 4 Sxy^2 ) / (Sxx + Syy)^2,   Sxx = sum (Re R)^2, Syy = sum (Im R)^2, Sxy = sum Re R Im R
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R_kr`, `p_r` | complex residue of FRF k in mode r, pole `-zeta omega + i omega sqrt(1 - zeta^2)` | m/(N s), 1/s |
//! | `a`, `b` | real coefficients, by linear least squares with fixed poles | 1/kg, s/kg |
//!
//! Source: Pappa, Elliott, Schenk 1993 on the modal phase collinearity; Heylen, Lammens, Sas, Modal analysis theory and testing (recalled).

use nalgebra::Complex;

use super::denominator::Pole;
use super::frf::Frf;
use super::model::{columns, solve};

/// Complexity of one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complexity {
    /// Mean phase deviation of the residues from those of a real mode, rad.
    pub phase_deviation: f64,
    /// Modal phase collinearity: 1 if all residues have one phase.
    pub collinearity: f64,
}

/// Complexity of each mode; `None` where complex residues are not determined.
pub(super) fn complexity(frfs: &[Frf], poles: &[Pole]) -> Option<Vec<Complexity>> {
    let mut residues = vec![Vec::with_capacity(frfs.len()); poles.len()];
    for frf in frfs {
        let mut all = columns(frf, poles);
        for (k, pole) in poles.iter().enumerate() {
            // i w / omega: in the size of the other columns.
            let scale = Complex::new(0.0, 1.0 / pole.angular_frequency);
            let pairs = all[k].iter().zip(&frf.angular_frequencies);
            let turned = pairs.map(|(q, w)| q * scale * *w).collect();
            all.push(turned);
        }
        let found = solve(frf, &all)?.coefficients;
        for (k, pole) in poles.iter().enumerate() {
            let (omega, zeta) = (pole.angular_frequency, pole.damping_ratio);
            let damped = omega * (1.0 - zeta * zeta).sqrt();
            let real = 0.5 * found[poles.len() + 2 + k] / omega;
            // a = -2 (Re R Re p + Im R Im p)
            let imaginary = -(0.5 * found[k] - real * zeta * omega) / damped;
            residues[k].push(Complex::new(real, imaginary));
        }
    }
    Some(residues.iter().map(|own| of_residues(own)).collect())
}

fn of_residues(residues: &[Complex<f64>]) -> Complexity {
    let (mut angles, mut sizes) = (0.0, 0.0);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for residue in residues {
        sizes += residue.norm();
        angles += residue.norm() * residue.re.abs().atan2(residue.im.abs());
        xx += residue.re * residue.re;
        yy += residue.im * residue.im;
        xy += residue.re * residue.im;
    }
    let whole = xx + yy;
    Complexity {
        phase_deviation: if sizes > 0.0 { angles / sizes } else { 0.0 },
        collinearity: match whole > 0.0 {
            true => ((xx - yy) * (xx - yy) + 4.0 * xy * xy) / (whole * whole),
            false => 1.0,
        },
    }
}
