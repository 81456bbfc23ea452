//! Frames: poses, and the tool pose of a tool axis.
//!
//! A transform is named so that neighbours cancel: `base_from_tool = base_from_flange * flange_from_tool`.
//!
//! | frame | origin and axes |
//! |---|---|
//! | `base` | root of the robot |
//! | `flange` | z out of the flange, as ROS-Industrial `tool0` |
//! | `tool` | origin at the tool centre point (TCP), z from the spindle towards the part |
//! | `part` | workpiece, z = outward normal of its plane |
//!
//! Lengths in m, angles in rad. Source: `docs/notation.md`.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Matrix3, Matrix4, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

/// A rigid displacement; the name of the variable states the two frames.
pub type Isometry = Isometry3<f64>;

/// Permitted deviation (no unit) of a matrix from a rotation by rounding in its source: single precision has
/// seven digits.
const ROUNDED: f64 = 1e-6;

/// Why a matrix is not a valid pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PoseMatrixError {
    /// A number is NaN or infinite.
    #[error("a number is not finite")]
    NotFinite,
    /// The last row is another.
    #[error("the last row is not 0, 0, 0, 1")]
    LastRow,
    /// The axes are not of length 1, or not perpendicular.
    #[error("its axes are not of length 1 and perpendicular (within {ROUNDED})")]
    NoRotation,
    /// The axes are left-handed.
    #[error("its axes are left-handed")]
    Mirrored,
}

/// The isometry of a homogeneous matrix (rotation, translation in m, last row 0 0 0 1); its rotation is made exact.
///
/// # Errors
/// A matrix that is not valid: see [`PoseMatrixError`].
pub fn from_matrix(matrix: &Matrix4<f64>) -> Result<Isometry, PoseMatrixError> {
    if matrix.iter().any(|value| !value.is_finite()) {
        return Err(PoseMatrixError::NotFinite);
    }
    if matrix.row(3) != Matrix4::identity().row(3) {
        return Err(PoseMatrixError::LastRow);
    }
    let axes: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    if (axes.transpose() * axes - Matrix3::identity()).amax() > ROUNDED {
        return Err(PoseMatrixError::NoRotation);
    }
    if axes.determinant() < 0.0 {
        return Err(PoseMatrixError::Mirrored);
    }
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Ok(Isometry::from_parts(
        matrix.fixed_view::<3, 1>(0, 3).into_owned().into(),
        UnitQuaternion::new_normalize(turn.into_inner()),
    ))
}

/// The isometry with translation `xyz` (m) and rotation `Rz(rz) Ry(ry) Rx(rx)` (rad).
///
/// The same as turning about the fixed axes x, then y, then z: URDF's `rpy` and Yaskawa's Rx, Ry, Rz.
pub fn from_xyz_and_fixed_angles(xyz: Vector3<f64>, rx_ry_rz: Vector3<f64>) -> Isometry {
    let rotation = UnitQuaternion::from_euler_angles(rx_ry_rz.x, rx_ry_rz.y, rx_ry_rz.z);
    Isometry::from_parts(Translation3::from(xyz), rotation)
}

/// The rotations rx, ry, rz (rad) about the fixed axes x, then y, then z of this rotation: the input of
/// [`from_xyz_and_fixed_angles`].
///
/// rx and rz are within -pi to pi, ry within -pi/2 to pi/2. Accurate to rounding everywhere: where ry is 90 deg, only
/// the sum or difference of the other two is defined, and any split of it is valid.
pub fn fixed_angles(rotation: &UnitQuaternion<f64>) -> Vector3<f64> {
    let m = rotation.to_rotation_matrix();
    // By arc tangents alone, which lose no digits at 90 deg, and rx in the axes that ry and rz leave.
    let ry = (-m[(2, 0)]).atan2(m[(0, 0)].hypot(m[(1, 0)]));
    let rz = m[(1, 0)].atan2(m[(0, 0)]);
    let (sin, cos) = rz.sin_cos();
    let rx = (sin * m[(0, 2)] - cos * m[(1, 2)]).atan2(cos * m[(1, 1)] - sin * m[(0, 1)]);
    Vector3::new(rx, ry, rz)
}

/// The orientation `base_from_tool` of a tool whose z axis is `axis`, turned about it by `spin` (rad).
///
/// At spin zero the tool's second axis (y) is as near as possible to base y, or to base x where the
/// axis is parallel to y. Positive spin follows the right hand about `axis`.
pub fn tool_orientation(axis: Unit<Vector3<f64>>, spin: f64) -> UnitQuaternion<f64> {
    let z = axis.into_inner();
    // Within 1e-6 rad of base y the projection of y has no reliable direction.
    let reference = if z.cross(&Vector3::y()).norm() > 1e-6 {
        Vector3::y()
    } else {
        Vector3::x()
    };
    let y = (reference - z * reference.dot(&z)).normalize();
    let unspun = Matrix3::from_columns(&[y.cross(&z), y, z]);
    let about_axis = UnitQuaternion::from_axis_angle(&axis, spin);
    about_axis * UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(unspun))
}

/// Axis times angle (rad, up to half a turn) of the turn that takes the axes `from` to the axes `to`, both as columns.
///
/// Not checked: that both are rotations.
pub fn turn_between(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    // Each pair of axes gives the sine of the angle between them: exact where the cosine has lost it.
    let sine: Vector3<f64> = (0..3)
        .map(|i| from.column(i).cross(&to.column(i)))
        .sum::<Vector3<f64>>()
        * 0.5;
    let cosine = 0.5 * (from.dot(to) - 1.0);
    let length = sine.norm();
    if length > 1e-6 || cosine > 0.0 {
        // For small angles the sine is the angle, to rounding.
        let factor = if length > 1e-9 {
            length.atan2(cosine) / length
        } else {
            1.0
        };
        return sine * factor;
    }
    // Half a turn: the axis is the longest column of R + I.
    let turn = to * from.transpose() + Matrix3::identity();
    let axis = turn
        .column_iter()
        .map(nalgebra::Matrix::into_owned)
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .unwrap_or_else(Vector3::x);
    axis.normalize() * PI
}

/// A unit vector perpendicular to `axis`, always the same one; `axis` must not be zero.
pub fn any_perpendicular(axis: &Vector3<f64>) -> Vector3<f64> {
    axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize()
}

/// Two directions perpendicular to a unit vector and to each other, always the same ones for the same vector.
pub fn both_across(axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let across = any_perpendicular(axis);
    [across, axis.cross(&across)]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_matrix_of_a_pose_is_read_back_and_invalid_matrices_are_refused() {
        let pose = from_xyz_and_fixed_angles(Vector3::new(0.1, -2.0, 3.0), Vector3::new(3.1, -0.4, 2.0));
        let matrix = pose.to_homogeneous();
        let back = from_matrix(&matrix).unwrap();
        // Nine products of rounding each.
        assert!((back.to_homogeneous() - matrix).amax() < 1e-15);
        // Single precision is accepted, and made exact.
        let single = from_matrix(&matrix.map(|value| f64::from(value as f32))).unwrap();
        assert!((single.rotation.norm() - 1.0).abs() < 1e-15);
        let changed = |at: (usize, usize), value: f64| {
            let mut matrix = matrix;
            matrix[at] = value;
            from_matrix(&matrix).unwrap_err()
        };
        assert_eq!(changed((0, 3), f64::NAN), PoseMatrixError::NotFinite);
        assert_eq!(changed((3, 1), 1e-3), PoseMatrixError::LastRow);
        assert_eq!(changed((1, 1), 0.5), PoseMatrixError::NoRotation);
        let mirror = Matrix4::from_diagonal(&nalgebra::Vector4::new(1.0, 1.0, -1.0, 1.0));
        assert_eq!(from_matrix(&(matrix * mirror)), Err(PoseMatrixError::Mirrored));
    }

    /// Any angle, and those near a quarter turn, where two of the three axes coincide.
    fn angle() -> impl Strategy<Value = f64> {
        let near = (-1e-6..1e-6f64).prop_map(|by| FRAC_PI_2 + by);
        prop_oneof![
            -7.0..7.0f64,
            near.clone(),
            near.prop_map(|angle| -angle),
            Just(FRAC_PI_2),
            Just(-FRAC_PI_2)
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn fixed_angles_make_the_rotation_that_they_come_from(angles in prop::array::uniform3(angle())) {
            let turned = |angles: Vector3<f64>| from_xyz_and_fixed_angles(Vector3::zeros(), angles).rotation;
            let rotation = turned(Vector3::from(angles));
            let again = fixed_angles(&rotation);
            prop_assert!(again.x.abs() <= PI && again.y.abs() <= FRAC_PI_2 && again.z.abs() <= PI, "{again}");
            let apart = rotation.to_rotation_matrix().matrix() - turned(again).to_rotation_matrix().matrix();
            // Some ten roundings of numbers up to one.
            prop_assert!(apart.amax() < 1e-14, "{again}");
        }
    }

    #[test]
    fn fixed_angles_of_turns_about_one_axis_are_that_turn() {
        for axis in 0..3 {
            let mut angles = Vector3::zeros();
            angles[axis] = 1.25;
            let rotation = from_xyz_and_fixed_angles(Vector3::zeros(), angles).rotation;
            assert!((fixed_angles(&rotation) - angles).amax() < 1e-15);
        }
    }

    #[test]
    fn turns_between_axes_are_those_that_were_made() {
        let from = Rotation3::from_euler_angles(0.3, -1.0, 2.0);
        let axis = Vector3::new(0.48, -0.6, 0.64);
        for angle in [0.0, 1e-12, 1e-5, 0.3, 1.7, 3.0, 3.1] {
            let to = Rotation3::new(axis * angle) * from;
            let found = turn_between(from.matrix(), to.matrix());
            assert!((found - axis * angle).norm() < 1e-9, "{angle}: {found}");
        }
        let half = Rotation3::new(axis * PI) * from;
        let found = turn_between(from.matrix(), half.matrix());
        assert!((found.norm() - PI).abs() < 1e-9 && found.cross(&axis).norm() < 1e-6);
    }

    #[test]
    fn fixed_angles_turn_about_x_first() {
        let quarter_turns =
            from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(FRAC_PI_2, 0.0, FRAC_PI_2));
        // y goes to z by the turn about x; the turn about z leaves it there.
        assert!((quarter_turns.rotation * Vector3::y() - Vector3::z()).norm() < 1e-15);
    }

    #[test]
    fn tool_z_is_the_axis_and_tool_y_is_near_base_y() {
        let axis = Unit::new_normalize(Vector3::new(0.3, 0.2, -0.9));
        let base_from_tool = tool_orientation(axis, 0.0);
        assert!((base_from_tool * Vector3::z() - axis.into_inner()).norm() < 1e-15);
        let y = base_from_tool * Vector3::y();
        for spin in [0.1, -0.1, 1.0, PI] {
            let turned = tool_orientation(axis, spin) * Vector3::y();
            assert!(turned.y < y.y, "spin {spin} brings tool y nearer to base y");
        }
    }

    #[test]
    fn axis_along_base_y_falls_back_to_base_x() {
        let y = tool_orientation(Vector3::y_axis(), 0.0) * Vector3::y();
        assert!((y - Vector3::x()).norm() < 1e-15);
    }

    #[test]
    fn positive_spin_follows_the_right_hand() {
        let y = tool_orientation(Vector3::x_axis(), FRAC_PI_2) * Vector3::y();
        assert!((y - Vector3::z()).norm() < 1e-15);
    }

    /// Axes all over the sphere, all general.
    fn axes() -> impl Iterator<Item = Unit<Vector3<f64>>> {
        (0..60).map(|i| {
            let (a, b) = (0.37 * f64::from(i), 1.3 * f64::from(i));
            Unit::new_normalize(Vector3::new(a.sin() * b.cos(), a.sin() * b.sin(), a.cos()))
        })
    }

    #[test]
    fn spins_add_up() {
        for axis in axes() {
            let (once, rest) = (tool_orientation(axis, 0.9), tool_orientation(axis, 0.9 + 1.7));
            let turned = UnitQuaternion::from_axis_angle(&axis, 1.7) * once;
            assert!(
                (turned.coords - rest.coords)
                    .norm()
                    .min((turned.coords + rest.coords).norm())
                    < 1e-14
            );
            let whole = tool_orientation(axis, 2.0 * PI + 0.9);
            assert!((whole * Vector3::y() - once * Vector3::y()).norm() < 1e-14);
        }
    }

    #[test]
    fn every_orientation_is_a_rotation_with_the_requested_third_axis() {
        for axis in axes().chain([Vector3::x_axis(), -Vector3::y_axis(), Vector3::z_axis()]) {
            let rotation = tool_orientation(axis, 0.4).to_rotation_matrix();
            let away = rotation.matrix() * rotation.matrix().transpose() - Matrix3::identity();
            assert!(away.norm() < 1e-14 && rotation.matrix().determinant() > 0.0);
            assert!((rotation * Vector3::z() - axis.into_inner()).norm() < 1e-14);
        }
    }

    #[test]
    fn base_y_is_replaced_only_within_a_microradian() {
        // On either side of 1e-6 rad from base y: outside it tool y is near base y, across the axis; inside it base x
        // is used.
        for (angle, near_x) in [(2e-6_f64, false), (0.5e-6, true)] {
            // Tilted towards z, so that the projection of y has nothing of x.
            let axis = Unit::new_normalize(Vector3::new(0.0, angle.cos(), angle.sin()));
            let y = tool_orientation(axis, 0.0) * Vector3::y();
            assert_eq!(y.x.abs() > 0.5, near_x, "{angle} rad: {y}");
            assert!(y.dot(&axis).abs() < 1e-9);
        }
    }

    #[test]
    fn fixed_angles_are_the_product_of_turns_about_z_y_and_x() {
        let (xyz, [rx, ry, rz]) = (Vector3::new(0.1, -0.2, 0.3), [0.4, -0.9, 2.3]);
        let product = Rotation3::from_axis_angle(&Vector3::z_axis(), rz)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), ry)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), rx);
        let found = from_xyz_and_fixed_angles(xyz, Vector3::new(rx, ry, rz));
        assert!((found.rotation.to_rotation_matrix().matrix() - product.matrix()).norm() < 1e-15);
        assert_eq!(found.translation.vector, xyz);
    }

    #[test]
    fn turning_back_is_the_opposite_turn() {
        for axis in axes() {
            let (from, to) = (tool_orientation(axis, 0.3), tool_orientation(-axis, -1.9));
            let (a, b) = (from.to_rotation_matrix(), to.to_rotation_matrix());
            let (there, back) = (
                turn_between(a.matrix(), b.matrix()),
                turn_between(b.matrix(), a.matrix()),
            );
            // Near half a turn, where the axis may have either sign, both are still the same rotation.
            let undone = Rotation3::new(back) * Rotation3::new(there);
            assert!(
                (undone.matrix() - Matrix3::identity()).norm() < 1e-9,
                "{there} {back}"
            );
            let reached = Rotation3::new(there) * a;
            assert!((reached.matrix() - b.matrix()).norm() < 1e-9);
        }
    }

    #[test]
    fn no_rotation_is_zero_whatever_the_axes() {
        for axis in axes() {
            let rotation = tool_orientation(axis, 1.0).to_rotation_matrix();
            // Rounding of the columns: some ulps.
            assert!(turn_between(rotation.matrix(), rotation.matrix()).norm() < 1e-15);
        }
    }

    #[test]
    fn the_perpendicular_vector_is_a_unit_vector() {
        for axis in axes().chain([Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()]) {
            let across = any_perpendicular(&axis);
            assert!((across.norm() - 1.0).abs() < 1e-15 && across.dot(&axis).abs() < 1e-15);
            assert_eq!(any_perpendicular(&axis), across);
            // The length of the axis has no effect.
            assert!((any_perpendicular(&(axis.into_inner() * 7.0)) - across).norm() < 1e-15);
        }
    }
}
