//! Virtual joints: compliances of an arm in addition to its drives.
//!
//! Bearings, links, the floor under the base, holder and tool deflect. Each deflection mode is a **spring**: it has an
//! *attachment*, moves everything after it along one local unit twist `u`, by `c u (u . w)` under a wrench `w`.
//! A whole 6 x 6 compliance at an attachment is a sum of at most six such springs, `C = sum_k c_k u_k u_k^T`: its
//! eigenvectors.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u` | local twist: at the origin of the attachment, in its axes | m or rad per unit of the spring |
//! | `c` | compliance of the spring | rad/(N m) for a rotation, m/N for a translation |
//!
//! The attachment of a joint is the frame right after the joint's motion. Source: Pashkevich, Klimchik & Chablat 2011,
//! "Enhanced stiffness modeling of manipulators with passive joints", Mechanism and Machine Theory 46:662-679 (virtual
//! joint method); `docs/theory/virtual-joints.md`.

use nalgebra::{Matrix6, Vector3};

use super::joint::JointCompliance;
use super::structure_error::StructureError;
use crate::spatial::Twist;

/// Where a spring or a mass is attached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// Under the whole arm, in the base frame.
    Base,
    /// On the link after the joint with this index, in the frame right after its motion.
    Joint(usize),
    /// On the flange, in its frame: holder, spindle.
    Flange,
    /// At the tool centre point, in the tool's frame.
    Tool,
}

impl Attachment {
    /// Its position in the order from base to tool of an arm with this many joints: 0 for the base.
    pub fn rank(self, joints: usize) -> usize {
        match self {
            Attachment::Base => 0,
            Attachment::Joint(index) => index + 1,
            Attachment::Flange => joints + 1,
            Attachment::Tool => joints + 2,
        }
    }

    /// Number of attachments of an arm with this many joints: one per joint, and base, flange and tool.
    pub fn count(joints: usize) -> usize {
        joints + 3
    }
}

/// One compliant direction of an arm in addition to its drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Its attachment.
    pub attachment: Attachment,
    /// Its direction, per unit: a twist at the origin of the attachment, in its axes.
    pub direction: Twist,
    /// Its compliance.
    pub compliance: JointCompliance,
}

impl Spring {
    /// A rotational spring about `axis` (unit vector, axes of the attachment); rad/(N m).
    pub fn about(attachment: Attachment, axis: Vector3<f64>, compliance: JointCompliance) -> Spring {
        Spring {
            attachment,
            direction: Twist::about(axis),
            compliance,
        }
    }

    /// A translational spring along `axis` (unit vector, axes of the attachment); m/N.
    pub fn along(attachment: Attachment, axis: Vector3<f64>, compliance: JointCompliance) -> Spring {
        Spring {
            attachment,
            direction: Twist::along(axis),
            compliance,
        }
    }
}

/// The two springs of a round cutter that bends like a clamped bar: along x and y of the tool, `64 L^3 / (3 pi E d^4)`.
///
/// `stick_out` L and `diameter` d in m, `modulus` E in Pa. Flutes weaken a cutter: d is the diameter of its core, about
/// 0.8 of the outer one. Neglected: rotation of the tip, axial compliance, clamping. No uncertainty. Source: bending of
/// a cantilever by a force at its end, any textbook on strength of materials.
pub fn cutter_springs(stick_out: f64, diameter: f64, modulus: f64) -> [Spring; 2] {
    let value = 64.0 * stick_out.powi(3) / (3.0 * std::f64::consts::PI * modulus * diameter.powi(4));
    [Vector3::x(), Vector3::y()].map(|axis| {
        let compliance = JointCompliance {
            value,
            standard_uncertainty: 0.0,
        };
        Spring::along(Attachment::Tool, axis, compliance)
    })
}

/// Entries of a matrix that are smaller than its largest entry by this factor are rounding of its source.
const ROUNDING: f64 = 1e-6;

/// The springs that together have the compliance `compliance` at an attachment: 6 x 6, at its origin in its axes,
/// translation first, m/N, 1/N, rad/(N m). At most six, without uncertainty.
///
/// # Errors
/// Numbers that are not finite, a matrix that is not symmetric, or has a negative eigenvalue.
pub fn springs_of(attachment: Attachment, compliance: &Matrix6<f64>) -> Result<Vec<Spring>, StructureError> {
    if compliance.iter().any(|value| !value.is_finite()) {
        return Err(StructureError::NotFinite("a compliance matrix"));
    }
    let rounding = ROUNDING * compliance.amax();
    if (compliance - compliance.transpose()).amax() > rounding {
        return Err(StructureError::NotSymmetric("a compliance matrix"));
    }
    let eigen = (0.5 * (compliance + compliance.transpose())).symmetric_eigen();
    if eigen.eigenvalues.min() < -rounding {
        return Err(StructureError::NegativeEigenvalue("a compliance matrix"));
    }
    let spring = |i: usize| {
        let u = eigen.eigenvectors.column(i);
        Spring {
            attachment,
            direction: Twist {
                linear: u.fixed_rows::<3>(0).into_owned(),
                angular: u.fixed_rows::<3>(3).into_owned(),
            },
            compliance: JointCompliance {
                value: eigen.eigenvalues[i],
                standard_uncertainty: 0.0,
            },
        }
    };
    // Six products of rounding each are left of a zero.
    let zero = 6.0 * f64::EPSILON * eigen.eigenvalues.max();
    Ok((0..6)
        .filter(|i| eigen.eigenvalues[*i] > zero)
        .map(spring)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_of_a_matrix_add_up_to_it() {
        let a = Matrix6::from_fn(|i, j| ((3 * i + 5 * j + i * j) % 7) as f64 - 2.5);
        let matrix = a * a.transpose() * 1e-9;
        let springs = springs_of(Attachment::Flange, &matrix).unwrap();
        let sum: Matrix6<f64> = springs
            .iter()
            .map(|s| s.direction.to_vector() * s.direction.to_vector().transpose() * s.compliance.value)
            .sum();
        // A decomposition of a 6 x 6 matrix: some ten roundings of its largest entry.
        assert!((sum - matrix).amax() < 1e-14 * matrix.amax());
    }

    #[test]
    fn a_matrix_of_one_direction_is_one_spring() {
        let mut matrix = Matrix6::zeros();
        matrix[(4, 4)] = 2e-8;
        let springs = springs_of(Attachment::Base, &matrix).unwrap();
        assert_eq!(springs.len(), 1);
        assert_eq!(springs[0].compliance.value, 2e-8);
        assert_eq!(springs[0].direction.angular.map(f64::abs), Vector3::y());
    }

    #[test]
    fn refuses_matrices_that_are_not_a_compliance() {
        let of = |i: usize, j: usize, value: f64| {
            let mut matrix = Matrix6::identity() * 1e-8;
            matrix[(i, j)] = value;
            springs_of(Attachment::Base, &matrix).unwrap_err()
        };
        assert!(matches!(of(0, 1, 1e-9), StructureError::NotSymmetric(_)));
        assert!(matches!(of(2, 2, -1e-9), StructureError::NegativeEigenvalue(_)));
        assert!(matches!(of(3, 3, f64::NAN), StructureError::NotFinite(_)));
    }

    #[test]
    fn a_cutter_bends_like_a_clamped_bar() {
        // F L^3 / (3 E I) with I = pi d^4 / 64 = 4.909e-10 m^4: 10 mm carbide, 50 mm out, 1 N.
        let [x, _] = cutter_springs(0.05, 0.01, 6e11);
        let inertia = 4.908_738_521e-10;
        let witness = 0.05_f64.powi(3) / (3.0 * 6e11 * inertia);
        assert!(
            (x.compliance.value / witness - 1.0).abs() < 1e-9,
            "{} m/N",
            x.compliance.value
        );
    }

    #[test]
    fn attachments_are_ordered_from_base_to_tool() {
        let attachments = [
            Attachment::Base,
            Attachment::Joint(0),
            Attachment::Joint(5),
            Attachment::Flange,
            Attachment::Tool,
        ];
        assert_eq!(attachments.map(|attachment| attachment.rank(6)), [0, 1, 6, 7, 8]);
        assert_eq!(Attachment::count(6), 9);
    }
}
