//! Virtual joints: directions in which an arm yields beside its drives.
//!
//! Bearings, links, the floor under the base, holder and tool bend. Each way of bending is a **spring**: it sits at a
//! *seat*, moves what comes after it along one local unit twist `u`, and does so by `c u (u . w)` under a wrench `w`.
//! A whole 6 x 6 compliance at a seat is a sum of at most six such springs, `C = sum_k c_k u_k u_k^T`: its eigenvectors.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `u` | local twist: at the seat's origin, in its axes | m or rad per unit of the spring |
//! | `c` | compliance of the spring | rad/(N m) for a turn, m/N for a slide |
//!
//! The seat of a joint is the frame right after the joint's motion. Source: Pashkevich, Klimchik & Chablat 2011,
//! "Enhanced stiffness modeling of manipulators with passive joints", Mechanism and Machine Theory 46:662-679 (virtual
//! joint method); `docs/theory/virtual-joints.md`.

use nalgebra::{Matrix6, Vector3};

use super::joint::JointCompliance;
use super::structure::StructureError;
use crate::spatial::Twist;

/// Where a spring or a mass sits.
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
    /// Place in the order from base to tool of an arm with this many joints: 0 for the base.
    pub fn rank(self, joints: usize) -> usize {
        match self {
            Attachment::Base => 0,
            Attachment::Joint(index) => index + 1,
            Attachment::Flange => joints + 1,
            Attachment::Tool => joints + 2,
        }
    }

    /// Seats of an arm with this many joints: two more than joints, and the base.
    pub fn count(joints: usize) -> usize {
        joints + 3
    }
}

/// One direction in which an arm yields beside its drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Where it sits.
    pub attachment: Attachment,
    /// How it moves what comes after it, per unit: a twist at the seat's origin in the seat's axes.
    pub direction: Twist,
    /// How much it yields.
    pub compliance: JointCompliance,
}

impl Spring {
    /// A spring that turns about `axis` (unit vector, seat's axes); rad/(N m).
    pub fn about(attachment: Attachment, axis: Vector3<f64>, compliance: JointCompliance) -> Spring {
        Spring {
            attachment,
            direction: Twist::about(axis),
            compliance,
        }
    }

    /// A spring that slides along `axis` (unit vector, seat's axes); m/N.
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
/// `stick_out` L and `diameter` d in m, `modulus` E in Pa. Flutes weaken a cutter: d is the diameter of its core, about 0.8
/// of the outer one. Left out: the turn of the tip, the cutter along its axis, clamping. No uncertainty.
/// Source: bending of a cantilever by a force at its end, any textbook on strength of materials.
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

/// Parts of a matrix that are smaller than its largest entry by this factor are rounding of whoever wrote it.
const ROUNDING: f64 = 1e-6;

/// The springs that together yield like `compliance` at a seat: 6 x 6, at the seat's origin in its axes, translation
/// first, m/N, 1/N, rad/(N m). At most six, without uncertainty.
///
/// # Errors
/// Numbers that are not finite, a matrix that is not symmetric, or one that yields against its load.
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
        return Err(StructureError::YieldsAgainstLoad("a compliance matrix"));
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
    // Six products of rounding each are what is left of a zero.
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
    fn matrices_that_no_body_has_are_refused() {
        let of = |i: usize, j: usize, value: f64| {
            let mut matrix = Matrix6::identity() * 1e-8;
            matrix[(i, j)] = value;
            springs_of(Attachment::Base, &matrix).unwrap_err()
        };
        assert!(matches!(of(0, 1, 1e-9), StructureError::NotSymmetric(_)));
        assert!(matches!(of(2, 2, -1e-9), StructureError::YieldsAgainstLoad(_)));
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
    fn seats_are_ordered_from_base_to_tool() {
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
