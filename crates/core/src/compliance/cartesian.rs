//! Compliance and stiffness of the whole arm at the tool.
//!
//! `C = J C_q J^T = sum_i c_i s_i s_i^T`, 6 x 6, symmetric, positive semidefinite.
//!
//! | block | unit |
//! |---|---|
//! | translation from force | m/N |
//! | translation from moment, rotation from force | 1/N |
//! | rotation from moment | rad/(N m) |
//!
//! Reference point: TCP. Basis: base. This replaces eqs (7)-(8) of Shneor & Chapsky 2021, which lack the shift
//! to the TCP; see `docs/theory/compliance.md`.

use nalgebra::{Matrix3, Matrix6};

use crate::robot::joint::JointCompliance;
use crate::spatial::Twist;

/// The 6 x 6 compliance at the reference point of the `screws`, translation first, SI.
pub fn compliance_at_tool(screws: &[Twist], joints: &[JointCompliance]) -> Matrix6<f64> {
    let mut compliance = Matrix6::zeros();
    for (screw, joint) in screws.iter().zip(joints) {
        let s = screw.to_vector();
        compliance += s * s.transpose() * joint.value;
    }
    compliance
}

/// The block of a 6 x 6 compliance that gives displacement by force, m/N.
pub fn by_force(compliance: &Matrix6<f64>) -> Matrix3<f64> {
    compliance.fixed_view::<3, 3>(0, 0).into_owned()
}

/// The stiffness matrix of eq. (7) with its rank and condition number.
#[derive(Clone, Debug)]
pub struct Stiffness {
    /// `K = C^-1` (pseudo-inverse where `C` is singular), N/m, N, N m/rad.
    pub matrix: Matrix6<f64>,
    /// Rank: directions in which the arm has a compliance; 6 where `K` is a true inverse.
    pub rank: usize,
    /// Largest over smallest eigenvalue of `C` made dimensionless by `length`; infinite below rank 6.
    pub condition_number: f64,
    /// The length (m) that scales rotations to translations.
    pub length: f64,
}

/// The stiffness at the tool. `length` (m) weights rotations against translations in rank and condition number: use
/// the arm's reach or the tool length.
pub fn stiffness_at_tool(compliance: &Matrix6<f64>, length: f64) -> Stiffness {
    // Twist [m, rad] -> [m, m]: with S = diag(1, 1, 1, L, L, L) the compliance is S C S, in m/N throughout.
    // Eigenvectors, not the singular value decomposition: that of nalgebra 0.34 sometimes loses digits.
    let scale = Matrix6::from_diagonal(&nalgebra::Vector6::new(1.0, 1.0, 1.0, length, length, length));
    let eigen = (scale * compliance * scale).symmetric_eigen();
    let (values, vectors) = (eigen.eigenvalues, eigen.eigenvectors);
    // Six products of eps each are the rounding of a zero eigenvalue; a hundred times that is zero.
    let zero = values.max() * 1e2 * 6.0 * f64::EPSILON;
    let rank = values.iter().filter(|value| **value > zero).count();
    let inverse = values.map(|value| if value > zero { 1.0 / value } else { 0.0 });
    let matrix = vectors * Matrix6::from_diagonal(&inverse) * vectors.transpose();
    let condition_number = if rank == 6 {
        values.max() / values.min()
    } else {
        f64::INFINITY
    };
    Stiffness {
        matrix: scale * matrix * scale,
        rank,
        condition_number,
        length,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn screw(o: Vector3<f64>, z: Vector3<f64>) -> Twist {
        Twist {
            linear: z.cross(&-o),
            angular: z,
        }
    }

    fn six_joints() -> (Vec<Twist>, Vec<JointCompliance>) {
        let places = [
            (Vector3::new(-1.0, 0.0, 0.3), Vector3::z()),
            (Vector3::new(-0.8, 0.0, 0.1), Vector3::y()),
            (Vector3::new(-0.5, 0.2, 0.6), Vector3::y()),
            (Vector3::new(-0.1, 0.1, 0.2), Vector3::x()),
            (Vector3::new(-0.1, 0.0, 0.2), Vector3::new(0.0, 0.8, 0.6)),
            (Vector3::new(-0.1, 0.05, 0.1), Vector3::new(0.6, 0.0, 0.8)),
        ];
        let screws = places.iter().map(|(o, z)| screw(*o, *z)).collect();
        let joints = (1..=6)
            .map(|i| JointCompliance {
                value: f64::from(i) * 1e-6,
                standard_uncertainty: 0.0,
            })
            .collect();
        (screws, joints)
    }

    #[test]
    fn stiffness_is_the_inverse_where_six_joints_are_compliant() {
        let (screws, joints) = six_joints();
        let c = compliance_at_tool(&screws, &joints);
        let k = stiffness_at_tool(&c, 1.0);
        assert_eq!(k.rank, 6);
        // K C = 1 up to the rounding of a matrix of this condition.
        assert!((k.matrix * c - Matrix6::identity()).norm() < 1e-14 * k.condition_number);
    }

    #[test]
    fn fewer_than_six_compliant_joints_lower_the_rank() {
        let (screws, joints) = six_joints();
        let k = stiffness_at_tool(&compliance_at_tool(&screws[..4], &joints[..4]), 1.0);
        assert_eq!(k.rank, 4);
        assert!(k.condition_number.is_infinite());
    }
}
