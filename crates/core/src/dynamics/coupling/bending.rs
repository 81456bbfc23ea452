//! Bending of a uniform beam in one plane: dynamic stiffness of its ends.
//!
//! ```text
//! s = (v, p, Q L^2/(E I), M L/(E I)),  v over L      ds/dz = a s / L
//!     | 0  1  c  0 |
//! a = | 0  0  0  1 |     b = w^2 rho A L^4/(E I)      r = w^2 rho L^2/E      c = E I/(k G A L^2)
//!     |-b  0  0  0 |
//!     | 0 -r -1  0 |     Euler and Bernoulli: c = r = 0
//! T = exp(a) = [Tuu Tuf; Tfu Tff]      D11 = Tuf^-1 Tuu      D12 = -Tuf^-1      D22 = S D11 S,  S = diag(1, -1)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `v`, `p` | deflection; rotation of the section, `dv/dz` if shear is neglected | m, rad |
//! | `Q`, `M` | shear force and bending moment on the end of larger z | N, N m |
//! | `D` | dynamic stiffness: forces on both ends by `v`, `p` of both ends | N/m, N, N m/rad |
//! | `w`, `L`, others | angular frequency, length, [`super::section`]; `E`, `G` complex | rad/s, m |
//!
//! The exponential is summed as a power series. A long beam is halved until the coefficients of the characteristic polynomial of `a` are small: no growing exponentials, no division by
//! small differences, and the static limit is exact; two equal halves are then joined. Source: Timoshenko's beam of any text; Weaver, Timoshenko,
//! Young, Vibration problems in engineering (recalled).

use nalgebra::{Complex, Matrix2, Matrix4};

use super::segment::{BeamTheory, Segment};

/// Largest `b`, `r`, `b c` and `b r c` of a piece: these are the coefficients of the characteristic polynomial of `a`.
const SMALL: f64 = 1.0;
/// Halvings at most.
const MOST_HALVINGS: usize = 24;
/// Terms of the exponential at most.
const MOST_TERMS: usize = 60;

/// Stiffness of both ends of a beam in one plane, each with deflection and rotation.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndStiffness {
    /// Of the end of smaller z by itself.
    pub near: Matrix2<Complex<f64>>,
    /// Forces on the end of smaller z by the displacement of the other.
    pub across: Matrix2<Complex<f64>>,
    /// Of the end of larger z by itself.
    pub far: Matrix2<Complex<f64>>,
}

/// Dynamic stiffness in bending at `w` (rad/s); `None` if it is not finite.
pub(super) fn bending(segment: &Segment, w: f64) -> Option<EndStiffness> {
    let mut length = segment.length;
    let mut halvings = 0;
    while !is_small(&Numbers::of(segment, length, w)) {
        length *= 0.5;
        halvings += 1;
        if halvings > MOST_HALVINGS {
            return None;
        }
    }
    let mut stiffness = of_piece(&Numbers::of(segment, length, w), length)?;
    for _ in 0..halvings {
        stiffness = joined(&stiffness)?;
    }
    Some(stiffness)
}

/// The dimensionless numbers of a piece, and `E I`.
struct Numbers {
    b: Complex<f64>,
    r: Complex<f64>,
    c: f64,
    bending: Complex<f64>,
}

impl Numbers {
    fn of(segment: &Segment, length: f64, w: f64) -> Numbers {
        let (section, material) = (&segment.section, &segment.material);
        let modulus = Complex::new(1.0, material.loss_factor) * material.modulus;
        let (area, moment) = (section.area(), section.second_moment());
        let inertia = w * w * material.density;
        let is_timoshenko = segment.theory == BeamTheory::Timoshenko;
        let shear = 2.0 * (1.0 + material.poisson) / section.shear_coefficient(material.poisson);
        Numbers {
            b: inertia * area * length.powi(4) / (modulus * moment),
            r: match is_timoshenko {
                true => inertia * length.powi(2) / modulus,
                false => Complex::new(0.0, 0.0),
            },
            c: if is_timoshenko {
                shear * moment / (area * length.powi(2))
            } else {
                0.0
            },
            bending: modulus * moment,
        }
    }
}

fn is_small(numbers: &Numbers) -> bool {
    let (b, r, c) = (numbers.b, numbers.r, numbers.c);
    [b, r, b * c, b * r * c]
        .iter()
        .all(|number| number.norm() <= SMALL)
}

fn of_piece(numbers: &Numbers, length: f64) -> Option<EndStiffness> {
    let (zero, one) = (Complex::new(0.0, 0.0), Complex::new(1.0, 0.0));
    let shear = Complex::new(numbers.c, 0.0);
    #[rustfmt::skip]
    let a = Matrix4::new(
        zero, one, shear, zero,
        zero, zero, zero, one,
        -numbers.b, zero, zero, zero,
        zero, -numbers.r, -one, zero,
    );
    let transfer = exponential(&a);
    let part = |row: usize, column: usize| transfer.fixed_view::<2, 2>(row, column).into_owned();
    let inverse = part(0, 2).try_inverse()?;
    let near = inverse * part(0, 0);
    // From the scaled state to (m, rad) and (N, N m).
    let force = numbers.bending / length;
    let scaled = |m: Matrix2<Complex<f64>>| {
        let scale = |k: usize| if k == 0 { 1.0 / length } else { 1.0 };
        Matrix2::from_fn(|i, j| m[(i, j)] * force * scale(i) * scale(j))
    };
    let near = scaled(near);
    let found = EndStiffness {
        near,
        across: scaled(-inverse),
        far: mirrored(&near),
    };
    let is_finite = |m: &Matrix2<Complex<f64>>| m.iter().all(|z| z.re.is_finite() && z.im.is_finite());
    (is_finite(&found.near) && is_finite(&found.across)).then_some(found)
}

/// `S m S`: the same end seen from the other side.
fn mirrored(m: &Matrix2<Complex<f64>>) -> Matrix2<Complex<f64>> {
    Matrix2::new(m[(0, 0)], -m[(0, 1)], -m[(1, 0)], m[(1, 1)])
}

fn exponential(a: &Matrix4<Complex<f64>>) -> Matrix4<Complex<f64>> {
    let mut sum = Matrix4::identity();
    let mut term = Matrix4::identity();
    for k in 1..=MOST_TERMS {
        term = term * a / Complex::new(k as f64, 0.0);
        sum += term;
        if term.norm() <= f64::EPSILON * 1e-3 {
            break;
        }
    }
    sum
}

/// Two equal pieces, one behind the other.
fn joined(piece: &EndStiffness) -> Option<EndStiffness> {
    let middle = (piece.far + piece.near).try_inverse()?;
    let near = piece.near - piece.across * middle * piece.across.transpose();
    Some(EndStiffness {
        near,
        across: -(piece.across * middle * piece.across),
        far: mirrored(&near),
    })
}
