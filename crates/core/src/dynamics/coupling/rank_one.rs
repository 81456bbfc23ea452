//! Modes with one shape each, fitted to all receptances of a tip at once.
//!
//! ```text
//! G_ij(w) = sum_r phi_ri phi_rj q_r(w) - l_ij/w^2 + u_ij      sum over ij, w of g_ij^2 |G_ij - G_ij(w)|^2 -> least
//! dq/domega = -(2 omega + 2 i zeta w) q^2      dq/dzeta = -2 i omega w q^2      dG_ij/dphi_k = (d_ik phi_j + d_jk phi_i) q
//! (J^T J + mu D) step = J^T residual
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `omega_r`, `zeta_r`, `phi_r`, `q_r` | angular frequency, damping ratio, shape, `1/(omega^2 - w^2 + 2 i zeta omega w)` | rad/s, -, 1/sqrt(kg), s^2 |
//! | `l_ij`, `u_ij` | lower and upper residual | 1/kg, m/N |
//! | `g_ij` | weight | N/m |
//! | `mu`, `D` | damping of the step (Levenberg, Marquardt), diagonal of `J^T J` | - |
//!
//! Residues of close poles, fitted one by one for each receptance, are determined only in their sum and may be of no shape: a product of
//! shapes is. Parameters are relative to their start. Source: nonlinear least squares of any text.

use nalgebra::{Complex, DMatrix, DVector, Vector6};

use super::super::modal_fit::Frf;
use super::super::mode::Mode;

/// Parameters of a mode: frequency, damping ratio, shape along x, y, z.
const OF_MODE: usize = 5;
/// Residuals of a receptance.
const OF_FRF: usize = 2;
/// Steps at most, the relative change of the sum of squares that ends the search, and the greatest damping that is tried.
const MOST_STEPS: usize = 60;
const END: f64 = 1e-9;
const MOST_DAMPING: f64 = 1e8;
/// Ranges of frequencies relative to the start, and of damping ratios.
const FREQUENCY: [f64; 2] = [0.9, 1.1];
const DAMPING: [f64; 2] = [1e-6, 0.9];

/// The modes that fit best, from these; without rotation.
pub(super) fn refined(frfs: &[Frf], start: &[Mode]) -> Vec<Mode> {
    let problem = Problem { frfs, start };
    let mut at = problem.first();
    let mut sum = problem.squares(&at);
    let mut mu = 1e-3;
    for _ in 0..MOST_STEPS {
        let (matrix, gradient) = problem.equations(&at);
        let mut better = None;
        while mu < MOST_DAMPING && better.is_none() {
            let next = step(&matrix, &gradient, mu).map(|step| &at + step);
            match next.filter(|next| problem.is_valid(next)) {
                Some(next) if problem.squares(&next) <= sum => better = Some(next),
                _ => mu *= 4.0,
            }
        }
        let Some(next) = better else { break };
        at = next;
        mu = (mu / 6.0).max(1e-12);
        let before = std::mem::replace(&mut sum, problem.squares(&at));
        if before - sum <= END * before {
            break;
        }
    }
    problem.modes(&at)
}

struct Problem<'a> {
    frfs: &'a [Frf],
    start: &'a [Mode],
}

impl Problem<'_> {
    /// The parameters of the start, residuals zero.
    fn first(&self) -> DVector<f64> {
        let mut all = DVector::zeros(OF_MODE * self.start.len() + OF_FRF * self.frfs.len());
        for (r, mode) in self.start.iter().enumerate() {
            let size = mode.shape.norm();
            let own = [
                1.0,
                1.0,
                mode.shape[0] / size,
                mode.shape[1] / size,
                mode.shape[2] / size,
            ];
            all.rows_mut(OF_MODE * r, OF_MODE).copy_from_slice(&own);
        }
        all
    }

    /// The modes of these parameters.
    fn modes(&self, at: &DVector<f64>) -> Vec<Mode> {
        let of = |(r, mode): (usize, &Mode)| {
            let own = at.rows(OF_MODE * r, OF_MODE);
            let size = mode.shape.norm();
            Mode {
                angular_frequency: mode.angular_frequency * own[0],
                damping_ratio: mode.damping_ratio * own[1],
                shape: Vector6::new(own[2] * size, own[3] * size, own[4] * size, 0.0, 0.0, 0.0),
            }
        };
        self.start.iter().enumerate().map(of).collect()
    }

    fn is_valid(&self, at: &DVector<f64>) -> bool {
        self.modes(at).iter().enumerate().all(|(r, mode)| {
            (FREQUENCY[0]..FREQUENCY[1]).contains(&at[OF_MODE * r])
                && (DAMPING[0]..DAMPING[1]).contains(&mode.damping_ratio)
        })
    }

    /// Scale of the lower and of the upper residual of an FRF: of the size of its values.
    fn scales(frf: &Frf) -> [f64; OF_FRF] {
        let least = |part: &dyn Fn(usize) -> f64| {
            (0..frf.receptance.len())
                .map(part)
                .fold(f64::INFINITY, f64::min)
                .max(f64::MIN_POSITIVE)
        };
        let upper = least(&|k| frf.receptance[k].norm());
        let lower = least(&|k| frf.receptance[k].norm() * frf.angular_frequencies[k].powi(2));
        [lower, upper]
    }

    /// Each weighted residual (real, imaginary), with its derivatives by the parameters if `visit` wants them.
    fn each(&self, at: &DVector<f64>, mut visit: impl FnMut(Complex<f64>, &[(usize, Complex<f64>)])) {
        let modes = self.modes(at);
        let mut slopes: Vec<(usize, Complex<f64>)> = Vec::new();
        for (k, frf) in self.frfs.iter().enumerate() {
            let (i, j) = (frf.response.axis, frf.reference.axis);
            let place = OF_MODE * modes.len() + OF_FRF * k;
            let scales = Problem::scales(frf);
            for (line, w) in frf.angular_frequencies.iter().enumerate() {
                let weight = frf.weights[line];
                slopes.clear();
                let mut value = Complex::new(0.0, 0.0);
                for (r, (mode, start)) in modes.iter().zip(self.start).enumerate() {
                    let (omega, zeta, phi) = (mode.angular_frequency, mode.damping_ratio, &mode.shape);
                    let q = Complex::new(omega * omega - w * w, 2.0 * zeta * omega * w).inv();
                    let both = phi[i] * phi[j];
                    value += q * both;
                    let first = OF_MODE * r;
                    let by_frequency = -Complex::new(2.0 * omega, 2.0 * zeta * w) * q * q * both;
                    let by_damping = -Complex::new(0.0, 2.0 * omega * w) * q * q * both;
                    slopes.push((first, by_frequency * (start.angular_frequency * weight)));
                    slopes.push((first + 1, by_damping * (start.damping_ratio * weight)));
                    let size = start.shape.norm() * weight;
                    slopes.push((first + 2 + i, q * (phi[j] * size)));
                    slopes.push((first + 2 + j, q * (phi[i] * size)));
                }
                let terms = [-scales[0] / (w * w), scales[1]];
                for (part, term) in terms.into_iter().enumerate() {
                    value += at[place + part] * term;
                    slopes.push((place + part, Complex::new(term * weight, 0.0)));
                }
                visit((frf.receptance[line] - value) * weight, &slopes);
            }
        }
    }

    fn squares(&self, at: &DVector<f64>) -> f64 {
        let mut sum = 0.0;
        self.each(at, |residual, _| sum += residual.norm_sqr());
        sum
    }

    /// `J^T J` and `J^T residual`.
    fn equations(&self, at: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
        let mut matrix = DMatrix::zeros(at.len(), at.len());
        let mut gradient = DVector::zeros(at.len());
        self.each(at, |residual, slopes| {
            for (a, one) in slopes {
                gradient[*a] += one.re * residual.re + one.im * residual.im;
                for (b, other) in slopes {
                    matrix[(*a, *b)] += one.re * other.re + one.im * other.im;
                }
            }
        });
        (matrix, gradient)
    }
}

/// The step with this damping; `None` if the parameters are not determined.
fn step(matrix: &DMatrix<f64>, gradient: &DVector<f64>, mu: f64) -> Option<DVector<f64>> {
    let size: DVector<f64> = matrix
        .diagonal()
        .map(|part| if part > 0.0 { part.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(size.len(), size.len(), |i, j| {
        let own = matrix[(i, j)] / (size[i] * size[j]);
        if i == j {
            own.max(f64::EPSILON) * (1.0 + mu)
        } else {
            own
        }
    });
    let found = scaled.cholesky()?.solve(&gradient.component_div(&size));
    Some(found.component_div(&size))
}
