//! The vertex of a piece of surface: the point that is next to the tangent planes of its crossings.
//!
//! ```text
//! minimise  sum over i of (n_i . (x - p_i))^2     over x in the cell, next to the mean c of all p_i
//!
//! A d = b,   d = x - c,   A = sum n_i n_i^T,   b = sum n_i (n_i . (p_i - c))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p_i`, `n_i` | place and normal of a crossing | m, - |
//! | `c` | mean of the places | m |
//! | `A`, `b` | matrix and right side; eigenvalues of `A` below [`LEAST`] of the largest are 0: along them `x` is at `c` | -, m |
//!
//! On a plane `x = c`, on an edge of two planes the point of the edge next to `c`, at a corner of three the corner. Where the solution is outside
//! of the cell, it is solved again without the eigenvalues below [`LEAST_OUTSIDE`]; then the coordinate that is farthest out is clamped to the face and the others
//! are solved again.
//!
//! Source: Ju, Losasso, Schaefer & Warren 2002, *Dual contouring of Hermite data*, ACM Transactions on Graphics 21(3), section 2 \[recalled\]; clamping \[derived\].

use nalgebra::{Matrix3, Point3, Unit, Vector3};

/// A crossing: a place and, if it is known, the normal there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    pub(super) place: Point3<f64>,
    pub(super) normal: Option<Unit<Vector3<f64>>>,
}

/// Square of the least singular value that is used, relative to the largest: two planes at 5.7 deg have an edge.
const LEAST: f64 = 0.05 * 0.05;
/// The same where the solution is outside of the cell: there a small one is the curvature of one surface, seen from its side, and no edge of two.
const LEAST_OUTSIDE: f64 = 0.3 * 0.3;
/// Eigenvalues of unit vectors below this are rounding.
const ROUNDING: f64 = 1e-12;
/// Normals with a difference below this are the same.
const SAME: f64 = 1e-9;

/// The vertex of these crossings, of which there is at least one, within the cell between two corners.
pub(super) fn vertex(tangents: &[Tangent], [low, high]: [Point3<f64>; 2]) -> Point3<f64> {
    let offs = tangents.iter().map(|tangent| tangent.place - low);
    let mean = low + offs.sum::<Vector3<f64>>() / tangents.len() as f64;
    let first = tangents.first().and_then(|tangent| tangent.normal);
    let is_same = |tangent: &Tangent| match (first, tangent.normal) {
        (Some(first), Some(normal)) => (first.into_inner() - normal.into_inner()).norm() < SAME,
        (None, None) => true,
        _ => false,
    };
    if tangents.iter().all(is_same) {
        return mean;
    }
    let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
    for tangent in tangents {
        if let Some(normal) = tangent.normal {
            a += normal.into_inner() * normal.transpose();
            b += normal.into_inner() * normal.dot(&(tangent.place - mean));
        }
    }
    let ranges = [low - mean, high - mean];
    mean + solve(&a, &b, ranges)
}

/// The solution between two corners.
fn solve(a: &Matrix3<f64>, b: &Vector3<f64>, [low, high]: [Vector3<f64>; 2]) -> Vector3<f64> {
    let out = |found: &Vector3<f64>, k: usize| (low[k] - found[k]).max(found[k] - high[k]);
    let fine = pseudo_solution(a, b, LEAST);
    if (0..3).all(|k| out(&fine, k) <= 0.0) {
        return fine;
    }
    let mut is_clamped = [false; 3];
    let mut clamped = Vector3::zeros();
    loop {
        let (mut part, mut right) = (*a, b - a * clamped);
        for k in (0..3).filter(|k| is_clamped[*k]) {
            part.fill_row(k, 0.0);
            part.fill_column(k, 0.0);
            right[k] = 0.0;
        }
        let found = clamped + pseudo_solution(&part, &right, LEAST_OUTSIDE);
        let free = (0..3).filter(|k| !is_clamped[*k]);
        let farthest = free.max_by(|i, j| out(&found, *i).total_cmp(&out(&found, *j)));
        match farthest {
            Some(k) if out(&found, k) > 0.0 => {
                is_clamped[k] = true;
                clamped[k] = found[k].clamp(low[k], high[k]);
            }
            _ => return found,
        }
    }
}

/// The solution without the directions whose eigenvalues are at most `least` of the largest.
fn pseudo_solution(a: &Matrix3<f64>, b: &Vector3<f64>, least: f64) -> Vector3<f64> {
    let eigen = a.symmetric_eigen();
    let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
    let least = (least * eigen.eigenvalues.max()).max(ROUNDING);
    let used = pairs.filter(|(value, _)| **value > least);
    used.map(|(value, vector)| vector * (vector.dot(b) / value)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: [Point3<f64>; 2] = [Point3::new(-1.0, -1.0, -1.0), Point3::new(1.0, 1.0, 1.0)];

    fn tangent(place: [f64; 3], normal: [f64; 3]) -> Tangent {
        Tangent {
            place: Point3::from(place),
            normal: Some(Unit::new_normalize(Vector3::from(normal))),
        }
    }

    #[test]
    fn planes_edges_and_corners_are_met() {
        let tilted = [1.0, 2.0, 2.0];
        // On the plane x + 2 y + 2 z = 1.
        let plane = [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]].map(|at| tangent(at, tilted));
        assert!((vertex(&plane, CELL) - Point3::new(1.0, 0.5, 0.5) / 3.0).norm() < 1e-15);
        // The edge x = 0.25, z = 0.5, next to the mean y.
        let edge = [
            tangent([0.25, -0.5, -1.0], [1.0, 0.0, 0.0]),
            tangent([0.25, 0.5, -1.0], [1.0, 0.0, 0.0]),
            tangent([-1.0, -0.5, 0.5], [0.0, 0.0, 1.0]),
            tangent([-1.0, 0.9, 0.5], [0.0, 0.0, 1.0]),
        ];
        assert!((vertex(&edge, CELL) - Point3::new(0.25, 0.1, 0.5)).norm() < 1e-14);
        let corner = [
            tangent([0.25, 0.0, 0.0], [1.0, 0.0, 0.0]),
            tangent([0.0, -0.5, 0.0], [0.0, -1.0, 0.0]),
            tangent([0.0, 0.0, 0.75], [0.0, 0.6, 0.8]),
        ];
        // 0.6 y + 0.8 z = 0.6 at y = -0.5.
        assert!(
            (vertex(&corner, CELL) - Point3::new(0.25, -0.5, 1.125).inf(&Point3::new(1.0, 1.0, 1.0))).norm()
                < 0.2
        );
        let wide = [CELL[0] * 2.0, CELL[1] * 2.0];
        assert!((vertex(&corner, wide) - Point3::new(0.25, -0.5, 1.125)).norm() < 1e-14);
    }

    #[test]
    fn an_edge_that_leaves_the_cell_is_met_at_its_face() {
        // The edge through (1, 0, 0.8) along (1, 0, -1): x + z = 1.8, y = 0; the cell ends at x = 1.
        let planes = [
            tangent([1.8, 0.0, 0.0], [1.0, 0.0, 1.0]),
            tangent([1.6, 0.0, -1.0], [0.0, 1.0, 0.0]),
        ];
        let found = vertex(&planes, CELL);
        assert!((found - Point3::new(1.0, 0.0, 0.8)).norm() < 1e-14, "{found}");
    }

    #[test]
    fn a_point_is_never_outside_of_its_cell() {
        let far = [
            tangent([1.0, 0.9, 1.0], [0.1, 0.0, 1.0]),
            tangent([0.9, 1.0, 1.0], [-0.1, 0.2, 1.0]),
            tangent([-0.5, 0.2, -1.0], [0.3, 0.1, 1.0]),
        ];
        let found = vertex(&far, CELL);
        assert!(found.iter().all(|value| value.abs() <= 1.0), "{found}");
        let unknown = Tangent {
            place: Point3::new(0.5, 0.0, 0.0),
            normal: None,
        };
        assert_eq!(vertex(&[unknown], CELL), unknown.place);
    }
}
