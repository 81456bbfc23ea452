//! The chain of elementary motions (form-shaping function, FSF).
//!
//! A robot is an ordered product of elementary motions, `A = A_1 A_2 ... A_m`, each along or about one
//! coordinate axis of the frame reached so far, each a constant or one joint variable. The same product
//! serves three kinds of object:
//!
//! | object | components in frame n | transform |
//! |---|---|---|
//! | position `r` | `[x, y, z, 1]`, m | [`Chain::base_from_flange`] times `r` |
//! | direction `c` | `[x, y, z, 0]`, unit | its rotation times `c` |
//! | screw (twist about the origin) | `[linear; angular]` | [`Chain::screw`], 6 x 6 |
//!
//! For speed all reduce to one inner form: a fixed isometry before each joint, the joint's axis, and a fixed
//! isometry after the last joint. Lengths m, angles rad.
//!
//! Source: Shneor & Chapsky 2021, eqs (1)-(6) and Table 2; `docs/theory/chain.md`.

use nalgebra::{Matrix3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3};

use super::ground::Ground;
use crate::frame::Isometry;
use crate::spatial::adjoint;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// (1, 0, 0)
    X,
    /// (0, 1, 0)
    Y,
    /// (0, 0, 1)
    Z,
}

impl Axis {
    /// x, y, z.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

    /// Its name: `x`, `y` or `z`.
    pub fn letter(self) -> char {
        match self {
            Axis::X => 'x',
            Axis::Y => 'y',
            Axis::Z => 'z',
        }
    }

    /// 0, 1, 2 for x, y, z.
    pub fn index(self) -> usize {
        match self {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        }
    }

    /// The unit vector of this axis.
    pub fn unit(self) -> Vector3<f64> {
        match self {
            Axis::X => Vector3::x(),
            Axis::Y => Vector3::y(),
            Axis::Z => Vector3::z(),
        }
    }
}

/// Amount of an elementary motion: m for a translation, rad for a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// A length or angle of the arm's geometry.
    Constant(f64),
    /// The position of the joint with this index.
    Joint(usize),
}

/// One elementary motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// A translation: A1, A2, A3 of the paper.
    Along(Axis, Amount),
    /// A rotation by the right hand: A4, A5, A6 of the paper.
    About(Axis, Amount),
}

impl Motion {
    /// Amount of this motion.
    pub fn amount(&self) -> Amount {
        match *self {
            Motion::Along(_, amount) | Motion::About(_, amount) => amount,
        }
    }

    /// Moves the frame with these axes (columns) and this origin by `distance` (m or rad).
    pub(crate) fn advance(&self, distance: f64, axes: &mut Matrix3<f64>, origin: &mut Vector3<f64>) {
        match *self {
            Motion::Along(axis, _) => *origin += axes.column(axis.index()) * distance,
            // The two axes behind the turning one, in cyclic order, turn into each other.
            Motion::About(Axis::X, _) => turn::<1, 2>(axes, distance),
            Motion::About(Axis::Y, _) => turn::<2, 0>(axes, distance),
            Motion::About(Axis::Z, _) => turn::<0, 1>(axes, distance),
        }
    }

    /// The displacement by `distance` (m or rad) along or about the axis of this motion.
    pub fn displacement(&self, distance: f64) -> Isometry {
        match *self {
            Motion::Along(axis, _) => Isometry::from_parts(
                Translation3::from(axis.unit() * distance),
                UnitQuaternion::identity(),
            ),
            Motion::About(axis, _) => Isometry::from_parts(
                Translation3::identity(),
                UnitQuaternion::new(axis.unit() * distance),
            ),
        }
    }
}

/// Turns the axes (columns) `A` and `B` into each other. Type parameters, so that they stay in registers.
#[inline]
fn turn<const A: usize, const B: usize>(axes: &mut Matrix3<f64>, angle: f64) {
    let (sin, cos) = angle.sin_cos();
    let (first, second) = (axes.column(A).into_owned(), axes.column(B).into_owned());
    axes.set_column(A, &(first * cos + second * sin));
    axes.set_column(B, &(second * cos - first * sin));
}

/// A joint in the inner form: the fixed displacement before it, and its motion.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// From the frame of the joint before, after its motion, to this joint at zero.
    pub before: Fixed,
    /// The motion of this joint, in its own frame.
    pub motion: Motion,
}

/// A constant displacement inside a chain.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    translation: Vector3<f64>,
    /// `None` where the axes stay parallel, as between most joints.
    rotation: Option<Matrix3<f64>>,
}

impl Fixed {
    fn new(displacement: &Isometry) -> Fixed {
        let turns = displacement.rotation.imag() != Vector3::zeros();
        Fixed {
            translation: displacement.translation.vector,
            rotation: turns.then(|| displacement.rotation.to_rotation_matrix().into_inner()),
        }
    }

    /// Its translation, m, and its rotation; none where the axes stay parallel.
    pub(crate) fn parts(&self) -> (Vector3<f64>, Option<Matrix3<f64>>) {
        (self.translation, self.rotation)
    }

    /// Applies the displacement to the frame with these axes (columns) and this origin.
    pub(super) fn advance(&self, axes: &mut Matrix3<f64>, origin: &mut Vector3<f64>) {
        *origin += *axes * self.translation;
        if let Some(rotation) = &self.rotation {
            *axes *= rotation;
        }
    }
}

/// An ordered product of elementary motions, with its inner form.
#[derive(Clone, Debug)]
pub struct Chain {
    motions: Vec<Motion>,
    links: Vec<Link>,
    last_joint_from_flange: Fixed,
    ground: Ground,
    external: usize,
}

/// Longest constant of a chain, m (rad): a gantry is shorter, and squares of it stay far from overflow.
pub const LONGEST: f64 = 1e3;

/// Why a list of elementary motions is not a valid chain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainError {
    /// No joint.
    #[error("the chain of {0} elementary motions has no joint")]
    NoJoint(usize),
    /// Joint variables must appear once each, in the order of the joints.
    #[error(
        "motion {motion} uses joint {found}, but joint {expected} comes next: joints appear once each, in order"
    )]
    JointOrder {
        /// Index of the motion in the chain, from 0.
        motion: usize,
        /// Index of the joint found there, from 0.
        found: usize,
        /// Index of the joint that should come next, from 0.
        expected: usize,
    },
    /// A length or angle that is not finite, or a length beyond [`LONGEST`].
    #[error("motion number {}: {value} (m or rad) is not a number within {LONGEST} m", motion + 1)]
    Amount {
        /// Index of the motion in the chain, from 0.
        motion: usize,
        /// The value given.
        value: f64,
    },
}

impl Chain {
    /// The chain of these motions, base to flange.
    ///
    /// # Errors
    /// No joint at all, a joint out of order or used twice, a constant that is not finite or beyond [`LONGEST`].
    pub fn new(motions: Vec<Motion>) -> Result<Chain, ChainError> {
        let mut links = Vec::new();
        let mut fixed = Isometry::identity();
        for (index, motion) in motions.iter().enumerate() {
            match motion.amount() {
                Amount::Constant(value) if value.is_nan() || value.abs() > LONGEST => {
                    return Err(ChainError::Amount { motion: index, value });
                }
                Amount::Constant(value) => fixed *= motion.displacement(value),
                Amount::Joint(found) if found != links.len() => {
                    return Err(ChainError::JointOrder {
                        motion: index,
                        found,
                        expected: links.len(),
                    });
                }
                Amount::Joint(_) => {
                    links.push(Link {
                        before: Fixed::new(&fixed),
                        motion: *motion,
                    });
                    fixed = Isometry::identity();
                }
            }
        }
        if links.is_empty() {
            return Err(ChainError::NoJoint(motions.len()));
        }
        Ok(Chain {
            motions,
            links,
            last_joint_from_flange: Fixed::new(&fixed),
            ground: Ground::at_base(),
            external: 0,
        })
    }

    /// This chain with the ground at another link; the joints of a positioner in front of it are external axes.
    pub(super) fn with_ground(self, ground: Ground) -> Chain {
        Chain {
            external: self.external.max(ground.positioner_joints()),
            ground,
            ..self
        }
    }

    /// This chain with its first joints as external axes, of any kind: those of a turntable that carries an arm.
    pub(super) fn with_external(self, joints: usize) -> Chain {
        Chain {
            external: joints.max(self.ground.positioner_joints()),
            ..self
        }
    }

    /// The link that does not move.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Number of joints in front of the arm that are external axes as stated; prismatic ones are so without that.
    pub(super) fn external(&self) -> usize {
        self.external
    }

    /// The elementary motions, base to flange.
    pub fn motions(&self) -> &[Motion] {
        &self.motions
    }

    /// The joints in inner form, base to flange.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// Whether joint `index` is prismatic.
    pub fn slides(&self, index: usize) -> bool {
        matches!(self.links[index].motion, Motion::Along(_, Amount::Joint(_)))
    }

    /// From the frame of the last joint, after its motion, to the flange.
    pub fn last_joint_from_flange(&self) -> &Fixed {
        &self.last_joint_from_flange
    }

    /// Half the length (m) of all its fixed translations: scales rotations of this chain to its
    /// translations. 1 m where there are none.
    pub fn length(&self) -> f64 {
        let fixed = self
            .links
            .iter()
            .map(|link| &link.before)
            .chain([&self.last_joint_from_flange]);
        let length = 0.5 * fixed.map(|fixed| fixed.translation.norm()).sum::<f64>();
        if length > 1e-6 { length } else { 1.0 }
    }

    /// This chain split before its joint `count`: the motions before, and the rest as a separate chain; `None` where
    /// no joint is left for it.
    pub fn split(&self, count: usize) -> Option<(Vec<Motion>, Chain)> {
        let joint = |motion: &Motion| matches!(motion.amount(), Amount::Joint(joint) if joint >= count);
        let place = self.motions.iter().position(joint)?;
        let moved = |motion: &Motion| match *motion {
            Motion::Along(axis, Amount::Joint(joint)) => Motion::Along(axis, Amount::Joint(joint - count)),
            Motion::About(axis, Amount::Joint(joint)) => Motion::About(axis, Amount::Joint(joint - count)),
            constant => constant,
        };
        let rest = self.motions[place..].iter().map(moved).collect();
        Some((self.motions[..place].to_vec(), Chain::new(rest).ok()?))
    }

    /// `A(theta)`: from the base to the flange, straight from the product of elementary motions.
    ///
    /// `theta` are chain positions (m, rad), without sign, zero offset or coupling of the joints.
    pub fn base_from_flange(&self, theta: &[f64]) -> Isometry {
        self.motions
            .iter()
            .fold(Isometry::identity(), |base_from_here, motion| {
                base_from_here
                    * match motion.amount() {
                        Amount::Constant(value) => motion.displacement(value),
                        Amount::Joint(joint) => motion.displacement(theta[joint]),
                    }
            })
    }

    /// Screw form of the FSF: the 6 x 6 matrix that takes a twist at the flange (its origin, its axes)
    /// to the twist of the same motion at the base origin in base axes.
    pub fn screw(&self, theta: &[f64]) -> Matrix6<f64> {
        adjoint(&self.base_from_flange(theta), &Point3::origin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elbow() -> Chain {
        Chain::new(vec![
            Motion::Along(Axis::Z, Amount::Constant(0.5)),
            Motion::About(Axis::Z, Amount::Joint(0)),
            Motion::Along(Axis::X, Amount::Constant(0.2)),
            Motion::About(Axis::Y, Amount::Joint(1)),
            Motion::Along(Axis::X, Amount::Joint(2)),
            Motion::About(Axis::X, Amount::Constant(0.3)),
        ])
        .unwrap()
    }

    #[test]
    fn screw_form_is_the_product_of_the_elementary_screw_matrices() {
        // Table 2 of the paper: translation [[I, [p]], [0, I]], rotation diag(R, R).
        let (chain, theta) = (elbow(), [0.4, -0.7, 0.25]);
        let mut product = Matrix6::identity();
        for motion in chain.motions() {
            let distance = match motion.amount() {
                Amount::Constant(value) => value,
                Amount::Joint(joint) => theta[joint],
            };
            let step = motion.displacement(distance);
            let mut elementary = Matrix6::zeros();
            let r = step.rotation.to_rotation_matrix().into_inner();
            elementary.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
            elementary.fixed_view_mut::<3, 3>(3, 3).copy_from(&r);
            elementary
                .fixed_view_mut::<3, 3>(0, 3)
                .copy_from(&(step.translation.vector.cross_matrix() * r));
            product *= elementary;
        }
        assert!((product - chain.screw(&theta)).norm() < 1e-15);
    }

    #[test]
    fn a_chain_without_joint_is_refused() {
        let rigid = Chain::new(vec![Motion::Along(Axis::Z, Amount::Constant(1.0))]);
        assert_eq!(rigid.unwrap_err(), ChainError::NoJoint(1));
    }

    #[test]
    fn a_joint_used_twice_is_refused() {
        let twice = Chain::new(vec![
            Motion::About(Axis::Z, Amount::Joint(0)),
            Motion::About(Axis::Y, Amount::Joint(0)),
        ]);
        assert_eq!(
            twice.unwrap_err(),
            ChainError::JointOrder {
                motion: 1,
                found: 0,
                expected: 1
            }
        );
    }

    #[test]
    fn a_length_that_is_not_finite_or_absurd_is_refused() {
        for value in [f64::NAN, f64::INFINITY, -1e300, 1001.0] {
            let broken = Chain::new(vec![
                Motion::About(Axis::Z, Amount::Joint(0)),
                Motion::Along(Axis::X, Amount::Constant(value)),
            ]);
            assert!(
                matches!(broken, Err(ChainError::Amount { motion: 1, .. })),
                "{value}"
            );
        }
    }

    #[test]
    fn a_chain_split_before_a_joint_multiplies_back_to_the_whole() {
        let (chain, theta) = (elbow(), [0.4, -0.7, 0.25]);
        for count in 0..3 {
            let (before, rest) = chain.split(count).unwrap();
            let mut at = Isometry::identity();
            for motion in &before {
                at *= motion.displacement(match motion.amount() {
                    Amount::Constant(value) => value,
                    Amount::Joint(joint) => theta[joint],
                });
            }
            let product = (at * rest.base_from_flange(&theta[count..])).to_homogeneous();
            assert!((product - chain.base_from_flange(&theta).to_homogeneous()).norm() < 1e-15);
            assert_eq!(rest.links().len(), 3 - count);
        }
        assert!(chain.split(3).is_none());
    }

    #[test]
    fn the_length_is_half_of_the_distances_between_the_joints() {
        // 0.5 m before joint 1 and 0.2 m before joint 2; joint motions have no length.
        assert!((elbow().length() - 0.35).abs() < 1e-15);
        let gantry = Chain::new(vec![Motion::Along(Axis::X, Amount::Joint(0))]).unwrap();
        assert_eq!(gantry.length(), 1.0);
    }

    #[test]
    fn constants_may_be_as_long_as_the_longest() {
        let with = |value| {
            Chain::new(vec![
                Motion::About(Axis::Z, Amount::Joint(0)),
                Motion::Along(Axis::X, Amount::Constant(value)),
            ])
        };
        assert!(with(LONGEST).is_ok() && with(-LONGEST).is_ok());
        let error = with(LONGEST.next_up()).unwrap_err().to_string();
        assert!(
            error.starts_with("motion number 2: 1000.") && error.ends_with("within 1000 m"),
            "{error}"
        );
    }

    #[test]
    fn joints_come_in_order_from_the_first() {
        let from_one = Chain::new(vec![Motion::About(Axis::Z, Amount::Joint(1))]).unwrap_err();
        assert_eq!(
            from_one.to_string(),
            "motion 0 uses joint 1, but joint 0 comes next: joints appear once each, in order"
        );
    }

    #[test]
    fn advancing_a_frame_is_multiplying_by_the_displacement() {
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            for motion in [
                Motion::Along(axis, Amount::Joint(0)),
                Motion::About(axis, Amount::Joint(0)),
            ] {
                let start = crate::frame::from_xyz_and_fixed_angles(
                    Vector3::new(0.1, 0.2, -0.3),
                    Vector3::new(0.5, -0.4, 1.3),
                );
                let mut axes = start.rotation.to_rotation_matrix().into_inner();
                let mut origin = start.translation.vector;
                motion.advance(0.8, &mut axes, &mut origin);
                let product = start * motion.displacement(0.8);
                assert!((origin - product.translation.vector).norm() < 1e-15);
                assert!((axes - product.rotation.to_rotation_matrix().matrix()).norm() < 1e-15);
            }
        }
    }
}
