//! Loop gain: displacement at the tip by the cutting force of a displacement, per depth of cut.
//!
//! ```text
//! u = b (1 - e^(-i w T)) L(w) u        L(w) = G(w) A_0/b = sum over modes of d_m(w) R_m        R_m = phi_m (phi_m^T A_0/b)
//! d_m(w) = 1/(omega_m^2 - w^2 + 2 i zeta_m omega_m w)
//! ```
//!
//! At the boundary of stability `b (1 - e^(-i w T))` is the reciprocal `x` of an eigenvalue of `L`. These are the roots of
//!
//! ```text
//! 1 - c_2 x + c_1 x^2 - c_0 x^3 = 0        c_2 = trace L,  c_1 = sum of its principal minors of order 2,  c_0 = det L
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u` | amplitude of the displacement at the tip, feed frame | m |
//! | `w`, `T` | angular frequency of chatter, period of the teeth | rad/s, s |
//! | `G`, `phi_m` | receptance (translation), shape of a mode (translation) | m/N, 1/sqrt(kg) |
//! | `A_0`, `b` | mean directional matrix at the depth of cut `b` | N/m, m |
//! | `x` | complex depth | m |

use nalgebra::{Complex, Matrix3, Vector3};

use super::cubic::{roots_of_cubic, roots_of_quadratic};
use crate::dynamics::Mode;

/// Most branches: one per direction.
pub(super) const BRANCHES: usize = 3;
/// In place of the complex depth of an eigenvalue that is zero, m: no depth of cut reaches it.
pub(super) const NO_DEPTH: f64 = 1e30;

/// Complex depths of the branches at one frequency, m.
pub(super) type Depths = [Complex<f64>; BRANCHES];

/// The loop gain of some modes in a cut.
#[derive(Clone, Debug)]
pub(super) struct LoopGain {
    terms: Vec<Term>,
    /// Whether displacements along the tool axis change no chip.
    is_planar: bool,
}

#[derive(Clone, Debug)]
struct Term {
    omega: f64,
    zeta: f64,
    shape: Vector3<f64>,
    /// `phi^T A_0/b`
    row: Vector3<f64>,
    /// `R_m`, row by row.
    matrix: [[f64; 3]; 3],
}

impl LoopGain {
    /// Of these modes (shapes in the feed frame) and this mean directional matrix per depth of cut (Pa).
    pub(super) fn new(modes: &[Mode], per_depth: &Matrix3<f64>) -> LoopGain {
        let term = |mode: &Mode| {
            let shape: Vector3<f64> = mode.shape.fixed_rows::<3>(0).into();
            let row = per_depth.transpose() * shape;
            let outer = shape * row.transpose();
            Term {
                omega: mode.angular_frequency,
                zeta: mode.damping_ratio,
                shape,
                row,
                matrix: [0, 1, 2].map(|r| [0, 1, 2].map(|c| outer[(r, c)])),
            }
        };
        LoopGain {
            terms: modes.iter().map(term).collect(),
            is_planar: per_depth.column(2).amax() == 0.0,
        }
    }

    /// Undamped angular frequency (rad/s) and damping ratio of the modes.
    pub(super) fn frequencies(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.terms.iter().map(|term| [term.omega, term.zeta])
    }

    /// Complex depths at the angular frequency `w` (rad/s), in no order.
    pub(super) fn depths(&self, w: f64) -> Depths {
        let absent = Complex::new(NO_DEPTH, 0.0);
        if self.is_planar {
            let mut sum = [[Complex::new(0.0, 0.0); 2]; 2];
            for term in &self.terms {
                let dynamic = term.dynamic(w);
                for (row, line) in sum.iter_mut().zip(term.matrix) {
                    row[0] += dynamic * line[0];
                    row[1] += dynamic * line[1];
                }
            }
            let [[a, b], [c, d]] = sum;
            let [first, second] = roots_of_quadratic(a + d, a * d - b * c, NO_DEPTH);
            return [first, second, absent];
        }
        let m = self.at(w);
        let minor = |r: usize, s: usize| m[(r, r)] * m[(s, s)] - m[(r, s)] * m[(s, r)];
        let minors = minor(0, 1) + minor(0, 2) + minor(1, 2);
        roots_of_cubic([m.trace(), minors, m.determinant()], NO_DEPTH)
    }

    /// `L` at the angular frequency `w`.
    fn at(&self, w: f64) -> Matrix3<Complex<f64>> {
        let mut sum = [[Complex::new(0.0, 0.0); 3]; 3];
        for term in &self.terms {
            let dynamic = term.dynamic(w);
            for (row, line) in sum.iter_mut().zip(term.matrix) {
                for (entry, value) in row.iter_mut().zip(line) {
                    *entry += dynamic * value;
                }
            }
        }
        Matrix3::from_fn(|r, c| sum[r][c])
    }

    /// Shares of the modes in the loop gain at `w` on the branch with the complex depth `x`; their sum is 1.
    ///
    /// With the right and left eigenvectors `v`, `y` of `L`: the real part of `x y^T d_m R_m v/(y^T v)`.
    pub(super) fn shares(&self, w: f64, x: Complex<f64>) -> Vec<f64> {
        let shifted = self.at(w) * x - Matrix3::identity();
        let [right, left] = [shifted, shifted.transpose()].map(null_vector);
        let norm: Complex<f64> = (left.transpose() * right)[(0, 0)];
        let share = |term: &Term| {
            let along = |vector: &Vector3<Complex<f64>>, by: &Vector3<f64>| -> Complex<f64> {
                vector.iter().zip(by.iter()).map(|(v, b)| v * *b).sum()
            };
            (x * term.dynamic(w) * along(&left, &term.shape) * along(&right, &term.row) / norm).re
        };
        self.terms.iter().map(share).collect()
    }

    /// The mode with the largest share.
    pub(super) fn largest_share(&self, w: f64, x: Complex<f64>) -> usize {
        let shares = self.shares(w, x);
        (0..shares.len())
            .max_by(|a, b| shares[*a].total_cmp(&shares[*b]))
            .unwrap_or(0)
    }
}

impl Term {
    fn dynamic(&self, w: f64) -> Complex<f64> {
        let re = self.omega * self.omega - w * w;
        let im = 2.0 * self.zeta * self.omega * w;
        let norm = 1.0 / (re * re + im * im);
        Complex::new(re * norm, -im * norm)
    }
}

/// The vector that a nearly singular matrix takes to nearly zero: the longest cross product of its rows.
fn null_vector(matrix: Matrix3<Complex<f64>>) -> Vector3<Complex<f64>> {
    let row = |index: usize| matrix.row(index).transpose();
    let crosses = [(0, 1), (0, 2), (1, 2)].map(|(r, s)| row(r).cross(&row(s)));
    let [first, second, third] = crosses;
    [second, third].into_iter().fold(
        first,
        |best, next| if next.norm() > best.norm() { next } else { best },
    )
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::*;

    fn modes() -> Vec<Mode> {
        [
            (100.0, 0.02, [0.5, 0.1, 0.2]),
            (140.0, 0.05, [-0.1, 0.6, 0.1]),
            (900.0, 0.01, [0.3, 0.3, 2.0]),
        ]
        .map(|(omega, zeta, [x, y, z])| Mode {
            angular_frequency: omega,
            damping_ratio: zeta,
            shape: Vector6::new(x, y, z, 0.0, 0.0, 0.0),
        })
        .to_vec()
    }

    #[test]
    fn complex_depths_are_reciprocal_eigenvalues_and_shares_add_up() {
        let flat = Matrix3::new(-2e8, -5e8, 0.0, 3e8, -2e8, 0.0, 1e8, 1e8, 0.0);
        let ball = Matrix3::new(-2e8, -5e8, 1e8, 3e8, -2e8, -2e8, 1e8, 1e8, -3e8);
        for per_depth in [flat, ball] {
            let gain = LoopGain::new(&modes(), &per_depth);
            for w in [0.0, 60.0, 101.0, 150.0, 890.0] {
                let found: Vec<_> = gain.depths(w).into_iter().filter(|x| x.norm() < 1e20).collect();
                assert_eq!(found.len(), if per_depth == flat { 2 } else { 3 });
                for x in found {
                    let rest = (Matrix3::identity() - gain.at(w) * x).determinant();
                    assert!(rest.norm() < 1e-10, "{w} {x} {rest}");
                    let sum: f64 = gain.shares(w, x).iter().sum();
                    assert!((sum - 1.0).abs() < 1e-8, "{w} {x} {sum}");
                }
            }
        }
    }

    #[test]
    fn near_a_resonance_its_mode_has_the_largest_share() {
        let flat = Matrix3::new(-2e8, -5e8, 0.0, 3e8, -2e8, 0.0, 1e8, 1e8, 0.0);
        let gain = LoopGain::new(&modes(), &flat);
        for (w, mode) in [(100.5, 0), (142.0, 1), (903.0, 2)] {
            let least = gain
                .depths(w)
                .into_iter()
                .min_by(|a, b| a.norm().total_cmp(&b.norm()))
                .unwrap();
            assert_eq!(gain.largest_share(w, least), mode, "{w}");
        }
    }
}
