//! Wall thickness: two-point sizes between two opposite planes (ISO 14405-1, LP).
//!
//! ```text
//! n   mean of the normals of both least-squares planes, from the first to the second
//! size at a point a of the first side:  n (b - a),  b the point of the second side that is nearest across n,
//!     moved along the second plane to the place of a
//! ```
//!
//! Points of the first side without any point of the second within the reach across `n` are left out and counted. Valid for sides that are
//! parallel within some degrees.

use nalgebra::{Point3, Vector3};

use super::error::FormError;
use super::neighbours::Neighbours;
use super::plane::{known, least_squares_plane, range};

/// Two-point sizes of a wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Thickness {
    /// Size at each point of the first side, m; `None` without an opposite point.
    pub sizes: Vec<Option<f64>>,
    /// Least size, m.
    pub least: f64,
    /// Mean size, m.
    pub mean: f64,
    /// Largest size, m.
    pub largest: f64,
    /// Points without an opposite point.
    pub unpaired: usize,
}

/// Two-point sizes between two sides, m; opposite points are within `reach` (m) of each other across the wall's normal.
///
/// # Errors
/// Points that do not determine a plane, sides that are not opposite, a reach that is not above 0, no pair.
pub fn thickness(first: &[Point3<f64>], second: &[Point3<f64>], reach: f64) -> Result<Thickness, FormError> {
    if !(reach > 0.0 && reach.is_finite()) {
        return Err(FormError::Length { value: reach });
    }
    known(first, 3)?;
    let (one, other) = (least_squares_plane(first)?, least_squares_plane(second)?);
    let across = other.origin - one.origin;
    let toward = |normal: Vector3<f64>| normal * normal.dot(&across).signum();
    let (n1, n2) = (toward(one.normal), toward(other.normal));
    let n = (n1 + n2).try_normalize(1.0).ok_or(FormError::Undetermined)?;
    if n.dot(&n1) < 0.9 {
        return Err(FormError::Undetermined);
    }
    // Seen along n: heights are taken off, so that cells are those of the projection.
    let flat = |p: &Point3<f64>| *p - n * (p - one.origin).dot(&n);
    let opposite: Vec<Point3<f64>> = second.iter().map(flat).collect();
    let cells = Neighbours::new(&opposite, reach);
    let size = |a: &Point3<f64>| {
        let place = flat(a);
        let mut nearest: Option<(f64, usize)> = None;
        cells.visit(&place, |index, square| {
            if nearest.is_none_or(|found| (square, index) < found) {
                nearest = Some((square, index));
            }
        });
        let (_, index) = nearest?;
        // Along the second plane: n2 (step + n rise) = 0.
        let step = place - opposite[index];
        let rise = -n2.dot(&step) / n2.dot(&n);
        Some((second[index] - a).dot(&n) + rise)
    };
    let sizes: Vec<Option<f64>> = first.iter().map(size).collect();
    let paired = sizes.iter().flatten().count();
    if paired == 0 {
        return Err(FormError::TooFew { needed: 1, given: 0 });
    }
    let [least, largest] = range(sizes.iter().flatten().copied());
    Ok(Thickness {
        least,
        mean: sizes.iter().flatten().sum::<f64>() / paired as f64,
        largest,
        unpaired: sizes.len() - paired,
        sizes,
    })
}

#[cfg(test)]
mod tests;
