//! A pose as the makers write it, on their pendants and in their programs: three angles, a rotation vector or a
//! quaternion.
//!
//! | maker | numbers | rotation |
//! |---|---|---|
//! | Yaskawa | Rx, Ry, Rz deg | `Rz(Rz) Ry(Ry) Rx(Rx)` |
//! | FANUC | W, P, R deg | `Rz(R) Ry(P) Rx(W)` |
//! | KUKA | A, B, C deg | `Rz(A) Ry(B) Rx(C)` |
//! | ABB | q1, q2, q3, q4 | quaternion, real part first |
//! | UR | rotation vector, rad | `exp([r]x)` |
//! | Staubli | Rx, Ry, Rz deg | `Rx(Rx) Ry(Ry) Rz(Rz)` |
//!
//! Positions in mm. Source: programs of one list of poses written for six controllers by the public RoboDK posts,
//! which agree to their last digit; Staubli from such a post alone.
//!
//! Near +-90 deg of the middle angle the other two share one turn: compare rotations, never numbers.

use armill_core::frame::{Isometry, fixed_angles, from_xyz_and_fixed_angles};
use armill_core::nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};
use armill_core::units::{from_deg, from_mm, to_deg, to_mm};

/// How a maker writes an orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// KUKA A, B, C.
    Kuka,
    /// ABB quaternion.
    Abb,
    /// FANUC W, P, R.
    Fanuc,
    /// Yaskawa Rx, Ry, Rz.
    Yaskawa,
    /// Staubli Rx, Ry, Rz.
    Staubli,
    /// UR rotation vector.
    Ur,
}

/// A quaternion whose length is farther from 1 than this was mistyped: controllers show four digits and more.
const UNIT: f64 = 1e-2;

/// No controller shows a larger number, mm or deg; sines and squares of far larger ones are none.
const LARGEST: f64 = 1e9;

/// Why numbers are not a valid pose.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PoseError {
    /// Another count of numbers than the convention has.
    #[error("{found} numbers of the pose, where {convention} has {expected}: {names}")]
    Count {
        /// Name of the convention.
        convention: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
        /// What they are.
        names: &'static str,
    },
    /// A quaternion that is not of unit length.
    #[error("the quaternion has length {0:.4}, not 1")]
    NotUnit(f64),
    /// A number that no controller shows.
    #[error("{0:e} is beyond {LARGEST:e}: no length in mm or angle in deg is so large")]
    TooLarge(f64),
}

impl Convention {
    /// Every convention.
    pub const ALL: [Convention; 6] = [
        Convention::Kuka,
        Convention::Abb,
        Convention::Fanuc,
        Convention::Yaskawa,
        Convention::Staubli,
        Convention::Ur,
    ];

    /// Its name in options.
    pub fn name(self) -> &'static str {
        match self {
            Convention::Kuka => "kuka",
            Convention::Abb => "abb",
            Convention::Fanuc => "fanuc",
            Convention::Yaskawa => "yaskawa",
            Convention::Staubli => "staubli",
            Convention::Ur => "ur",
        }
    }

    /// The numbers of a pose.
    pub fn numbers(self) -> &'static str {
        match self {
            Convention::Kuka => "X,Y,Z,A,B,C (mm, deg)",
            Convention::Abb => "X,Y,Z,q1,q2,q3,q4 (mm; quaternion, real part first)",
            Convention::Fanuc => "X,Y,Z,W,P,R (mm, deg)",
            Convention::Yaskawa | Convention::Staubli => "X,Y,Z,Rx,Ry,Rz (mm, deg)",
            Convention::Ur => "X,Y,Z,Rx,Ry,Rz (mm; rotation vector, rad)",
        }
    }

    /// The pose of these numbers, m.
    ///
    /// Numbers in the order of [`Convention::numbers`]. A quaternion that is not quite of unit length is normalised.
    ///
    /// # Errors
    /// Another count of numbers; a number beyond any pendant's; a quaternion that is not of unit length.
    pub fn pose(self, numbers: &[f64]) -> Result<Isometry, PoseError> {
        let wrong_count = || PoseError::Count {
            convention: self.name(),
            found: numbers.len(),
            expected: if self == Convention::Abb { 7 } else { 6 },
            names: self.numbers(),
        };
        if let Some(number) = numbers
            .iter()
            .find(|number| number.is_nan() || number.abs() > LARGEST)
        {
            return Err(PoseError::TooLarge(*number));
        }
        if self == Convention::Abb {
            let [x, y, z, w, i, j, k] = *numbers else {
                return Err(wrong_count());
            };
            let quaternion = Quaternion::new(w, i, j, k);
            if (quaternion.norm() - 1.0).abs() > UNIT {
                return Err(PoseError::NotUnit(quaternion.norm()));
            }
            let translation = Translation3::new(from_mm(x), from_mm(y), from_mm(z));
            return Ok(Isometry::from_parts(
                translation,
                UnitQuaternion::from_quaternion(quaternion),
            ));
        }
        let [x, y, z, a, b, c] = *numbers else {
            return Err(wrong_count());
        };
        let position = from_mm(Vector3::new(x, y, z));
        let fixed =
            |x: f64, y: f64, z: f64| from_xyz_and_fixed_angles(position, Vector3::new(x, y, z).map(from_deg));
        Ok(match self {
            Convention::Kuka => fixed(c, b, a),
            Convention::Staubli => {
                let about = |axis, deg: f64| UnitQuaternion::from_axis_angle(&axis, from_deg(deg));
                let turn =
                    about(Vector3::x_axis(), a) * about(Vector3::y_axis(), b) * about(Vector3::z_axis(), c);
                Isometry::from_parts(position.into(), turn)
            }
            Convention::Ur => Isometry::from_parts(
                position.into(),
                UnitQuaternion::from_scaled_axis(Vector3::new(a, b, c)),
            ),
            Convention::Fanuc | Convention::Yaskawa | Convention::Abb => fixed(a, b, c),
        })
    }

    /// The numbers of this pose (m), in the order and units of [`Convention::numbers`].
    ///
    /// Of the quaternions that mean one rotation the one with real part >= 0.
    pub fn numbers_of(self, pose: &Isometry) -> Vec<f64> {
        let place = to_mm(pose.translation.vector);
        let turn = match self {
            Convention::Kuka => {
                let fixed = fixed_angles(&pose.rotation).map(to_deg);
                vec![fixed.z, fixed.y, fixed.x]
            }
            Convention::Fanuc | Convention::Yaskawa => {
                fixed_angles(&pose.rotation).map(to_deg).as_slice().to_vec()
            }
            // Turns about moving axes x, y, z are those about the fixed axes of the inverse, the other way round.
            Convention::Staubli => (-fixed_angles(&pose.rotation.inverse()))
                .map(to_deg)
                .as_slice()
                .to_vec(),
            Convention::Ur => pose.rotation.scaled_axis().as_slice().to_vec(),
            Convention::Abb => {
                let quaternion = pose.rotation.into_inner();
                let sign = if quaternion.w < 0.0 { -1.0 } else { 1.0 };
                vec![
                    sign * quaternion.w,
                    sign * quaternion.i,
                    sign * quaternion.j,
                    sign * quaternion.k,
                ]
            }
        };
        place.as_slice().iter().copied().chain(turn).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(convention: Convention, numbers: &[f64]) -> Isometry {
        convention.pose(numbers).unwrap()
    }

    #[test]
    fn one_orientation_in_the_conventions_of_four_manufacturers() {
        // The linear targets of one program written for four controllers by the RoboDK posts; six decimals of UR.
        let kuka = pose(Convention::Kuka, &[0.0, 0.0, 0.0, 180.0, 0.0, -150.0]).rotation;
        for (convention, angles, tolerance) in [
            (Convention::Fanuc, [-150.0, 0.0, 180.0], 1e-12),
            (Convention::Yaskawa, [-150.0, 0.0, 180.0], 1e-12),
            (Convention::Ur, [0.0, -3.034_545, 0.813_104], 2e-6),
        ] {
            let [a, b, c] = angles;
            let other = pose(convention, &[0.0, 0.0, 0.0, a, b, c]).rotation;
            assert!(kuka.angle_to(&other) < tolerance, "{}", convention.name());
        }
    }

    #[test]
    fn order_of_turns_of_each_maker_is_its_own() {
        // 90 deg about x and 90 deg about z, written in the fields of each maker, and where the tool's z then points.
        let z = |convention, numbers: &[f64]| pose(convention, numbers).rotation * Vector3::z();
        let near = |a: Vector3<f64>, b: Vector3<f64>| (a - b).norm() < 1e-12;
        // Fixed axes x, then z: z goes to -y, then to x.
        assert!(near(
            z(Convention::Fanuc, &[0.0, 0.0, 0.0, 90.0, 0.0, 90.0]),
            Vector3::x()
        ));
        assert!(near(
            z(Convention::Kuka, &[0.0, 0.0, 0.0, 90.0, 0.0, 90.0]),
            Vector3::x()
        ));
        // Staubli turns about its own z after x: z stays at -y.
        assert!(near(
            z(Convention::Staubli, &[0.0, 0.0, 0.0, 90.0, 0.0, 90.0]),
            -Vector3::y()
        ));
    }

    #[test]
    fn kuka_and_staubli_differ_in_the_middle_angle_and_the_order() {
        let angles = [20.0, 30.0, 40.0];
        let [a, b, c] = angles;
        let of = |convention, [a, b, c]: [f64; 3]| pose(convention, &[0.0, 0.0, 0.0, a, b, c]).rotation;
        assert!(of(Convention::Kuka, angles).angle_to(&of(Convention::Yaskawa, [c, b, a])) < 1e-12);
        assert!(of(Convention::Kuka, angles).angle_to(&of(Convention::Yaskawa, angles)) > 0.1);
        // Rx Ry Rz is the inverse of Rz Ry Rx with turned signs.
        let inverse = of(Convention::Yaskawa, [-a, -b, -c]).inverse();
        assert!(of(Convention::Staubli, angles).angle_to(&inverse) < 1e-12);
    }

    #[test]
    fn a_quaternion_of_abb_has_its_real_part_first() {
        let half = 0.5_f64.sqrt();
        let turned = pose(Convention::Abb, &[1000.0, 0.0, 0.0, half, 0.0, half, 0.0]);
        assert!((turned.rotation * Vector3::z() - Vector3::x()).norm() < 1e-12);
        assert_eq!(turned.translation.x, 1.0);
        let error = Convention::Abb.pose(&[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
        assert!(error.unwrap_err().to_string().contains("length 1.4142"));
    }

    #[test]
    fn numbers_of_a_pose_make_it_again_for_every_maker() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        for round in 0..2000 {
            let mut turn = Vector3::from_fn(|_, _| 3.2 * random());
            if round % 4 == 0 {
                // The middle angle at and near a right angle.
                turn.y = std::f64::consts::FRAC_PI_2 + [0.0, 1e-9, -1e-5][round / 4 % 3];
            }
            let pose = from_xyz_and_fixed_angles(Vector3::from_fn(|_, _| 3.0 * random()), turn);
            for convention in Convention::ALL {
                let again = convention.pose(&convention.numbers_of(&pose)).unwrap();
                let moved = (again.translation.vector - pose.translation.vector).norm();
                // Some roundings of numbers of a few metres, and of angles.
                assert!(
                    moved < 4e-15 && again.rotation.angle_to(&pose.rotation) < 1e-7,
                    "{}",
                    convention.name()
                );
                // `angle_to` uses the arc cosine, which has no resolution below 1e-8; the columns of the matrices have.
                let apart = (again.rotation.to_rotation_matrix().matrix()
                    - pose.rotation.to_rotation_matrix().matrix())
                .norm();
                assert!(apart < 3e-15, "{} {apart:e}", convention.name());
            }
        }
    }
}
