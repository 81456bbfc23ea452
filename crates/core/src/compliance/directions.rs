//! Directions: the greatest compliance, and the permissible force for a tolerance.
//!
//! With `C_t` the translational 3 x 3 block (displacement by force) and `C_plane` its two in-plane rows (2 x 3, force
//! free in space):
//!
//! - principal compliances: eigenvalues and eigenvectors of `C_t`;
//! - permissible force in the unit direction `f` for a tolerance `e`: `e / |C_plane f|`;
//! - in the worst direction: `e / sigma_max(C_plane)`.
//!
//! Units: C in m/N, e in m, force in N. Source: `docs/notation.md`; standard linear algebra.

use nalgebra::{Matrix2x3, Matrix3, Unit, Vector3};

use crate::frame::both_across;

/// A principal direction: a force along it moves the tool along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalCompliance {
    /// m/N
    pub value: f64,
    /// Unit vector in base; its sign is arbitrary.
    pub direction: Vector3<f64>,
}

/// Principal compliances of the translational block, the most compliant first.
pub fn principal_compliances(by_force: &Matrix3<f64>) -> [PrincipalCompliance; 3] {
    let eigen = by_force.symmetric_eigen();
    let mut principal = [0, 1, 2].map(|i| PrincipalCompliance {
        value: eigen.eigenvalues[i],
        direction: eigen.eigenvectors.column(i).into(),
    });
    principal.sort_by(|a, b| b.value.total_cmp(&a.value));
    principal
}

/// Greatest force (N) in direction `f` whose in-plane deviation is within `limit` (m); infinite where such
/// a force moves nothing in the plane. `normal` is the plane's normal, base basis.
pub fn permissible_force(
    by_force: &Matrix3<f64>,
    normal: Unit<Vector3<f64>>,
    f: Unit<Vector3<f64>>,
    limit: f64,
) -> f64 {
    limit / (in_plane_rows(by_force, normal) * f.into_inner()).norm()
}

/// Force (N) that is permissible in every direction for the tolerance `limit` (m), and the critical direction.
pub fn permissible_force_in_worst_direction(
    by_force: &Matrix3<f64>,
    normal: Unit<Vector3<f64>>,
    limit: f64,
) -> (f64, Vector3<f64>) {
    let rows = in_plane_rows(by_force, normal);
    let eigen = (rows.transpose() * rows).symmetric_eigen();
    let worst = eigen.eigenvalues.imax();
    (
        limit / eigen.eigenvalues[worst].max(0.0).sqrt(),
        eigen.eigenvectors.column(worst).into(),
    )
}

/// The two in-plane rows of the translational compliance, in an arbitrary basis of the plane.
fn in_plane_rows(by_force: &Matrix3<f64>, normal: Unit<Vector3<f64>>) -> Matrix2x3<f64> {
    let [u, v] = both_across(&normal);
    Matrix2x3::from_rows(&[u.transpose() * by_force, v.transpose() * by_force])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some_compliance() -> Matrix3<f64> {
        let a = Matrix3::from_fn(|i, j| ((3 * i + 5 * j + i * j) % 7) as f64 - 2.5);
        a * a.transpose() * 1e-7
    }

    #[test]
    fn principal_compliances_are_sorted_and_solve_the_eigenvalue_problem() {
        let c = some_compliance();
        let principal = principal_compliances(&c);
        assert!(principal[0].value >= principal[1].value && principal[1].value >= principal[2].value);
        for p in principal {
            let moved = c * p.direction;
            assert!((moved - p.direction * p.value).norm() < 1e-12 * c.norm());
        }
    }

    #[test]
    fn the_permissible_force_gives_exactly_the_tolerance() {
        let (c, n) = (
            some_compliance(),
            Unit::new_normalize(Vector3::new(0.2, -0.4, 1.0)),
        );
        let f = Unit::new_normalize(Vector3::new(1.0, 2.0, -0.5));
        let force = permissible_force(&c, n, f, 50e-6);
        let moved = c * f.into_inner() * force;
        let in_plane = moved - n.into_inner() * moved.dot(&n);
        assert!((in_plane.norm() - 50e-6).abs() < 1e-18);
    }

    #[test]
    fn no_direction_permits_less_than_the_worst_one() {
        let (c, n) = (
            some_compliance(),
            Unit::new_normalize(Vector3::new(0.2, -0.4, 1.0)),
        );
        let (worst, direction) = permissible_force_in_worst_direction(&c, n, 50e-6);
        let there = permissible_force(&c, n, Unit::new_normalize(direction), 50e-6);
        assert!((there / worst - 1.0).abs() < 1e-9, "{there} N against {worst} N");
        for i in 0..200 {
            let (a, b) = (f64::from(i) * 0.7, f64::from(i) * 0.31);
            let f = Unit::new_normalize(Vector3::new(a.sin() * b.cos(), a.sin() * b.sin(), a.cos()));
            assert!(permissible_force(&c, n, f, 50e-6) > worst * (1.0 - 1e-9));
        }
    }
}
