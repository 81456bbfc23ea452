//! Alignment by datums: three points of a primary plane, two of a secondary, one of a tertiary one (3-2-1).
//!
//! ```text
//! n1  normal of the primary plane: of the plane through its points, of more than three the least-squares plane
//! n2  across n1 and the line through the secondary points, seen along n1; of more than two the least-squares line
//! n3  n1 x n2
//! origin: n1 o = mean of n1 p (primary), n2 o = mean of n2 p (secondary), n3 o = n3 p (tertiary)
//! ```
//!
//! The signs are those of the given outer normals. Exact for six points. ISO 5459 associates tangential planes; for points of a probe
//! on three, two and one places both are the same.

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};

use super::error::FormError;
use super::plane::{known, least_squares_plane};
use crate::frame::Isometry;

/// Points on three datum planes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DatumTargets<'a> {
    /// At least three.
    pub primary: &'a [Point3<f64>],
    /// At least two.
    pub secondary: &'a [Point3<f64>],
    /// One.
    pub tertiary: Point3<f64>,
}

/// Outer normals of three datum planes, roughly: only their signs matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DatumNormals {
    /// Of the primary plane.
    pub primary: Vector3<f64>,
    /// Of the secondary plane.
    pub secondary: Vector3<f64>,
    /// Of the tertiary plane.
    pub tertiary: Vector3<f64>,
}

/// The frame of three datum planes: z along the outer normal of the primary one, x along that of the secondary, y across
/// both; the origin is on all three.
///
/// # Errors
/// Too few points, points that are not finite, on a line (primary) or at one position along it (secondary).
pub fn datum_frame(targets: &DatumTargets<'_>, normals: &DatumNormals) -> Result<Isometry, FormError> {
    known(targets.secondary, 2)?;
    known(&[targets.tertiary], 1)?;
    let plane = least_squares_plane(targets.primary)?;
    let n1 = plane.normal * sign(plane.normal.dot(&normals.primary))?;
    let about = mean(targets.secondary);
    let off = targets
        .secondary
        .iter()
        .map(|p| p - about)
        .map(|off| off - n1 * off.dot(&n1));
    let spread: Matrix3<f64> = off.map(|off| off * off.transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let most = eigen.eigenvalues.imax();
    if eigen.eigenvalues[most] <= 0.0 {
        return Err(FormError::Undetermined);
    }
    let along = eigen.eigenvectors.column(most).into_owned();
    let across = n1
        .cross(&along)
        .try_normalize(0.5)
        .ok_or(FormError::Undetermined)?;
    let n2 = across * sign(across.dot(&normals.secondary))?;
    // The axes are right-handed whatever the tertiary normal: it only has to be off both others.
    let n3 = n1.cross(&n2);
    sign(n3.dot(&normals.tertiary))?;
    let turn = Matrix3::from_columns(&[n2, n3, n1]);
    let place = n1 * n1.dot(&plane.origin.coords)
        + n2 * n2.dot(&about.coords)
        + n3 * n3.dot(&targets.tertiary.coords);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    Ok(Isometry::from_parts(place.into(), turn))
}

/// The motion from measured targets to nominal ones.
///
/// # Errors
/// Those of [`datum_frame`].
pub fn datum_motion(
    measured: &DatumTargets<'_>,
    nominal: &DatumTargets<'_>,
    normals: &DatumNormals,
) -> Result<Isometry, FormError> {
    Ok(datum_frame(nominal, normals)? * datum_frame(measured, normals)?.inverse())
}

fn mean(points: &[Point3<f64>]) -> Point3<f64> {
    Point3::from(points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64)
}

/// 1 or -1.
///
/// # Errors
/// A direction across the given normal.
fn sign(along: f64) -> Result<f64, FormError> {
    match along.abs() > 1e-6 {
        true => Ok(along.signum()),
        false => Err(FormError::Undetermined),
    }
}

#[cfg(test)]
mod tests;
