//! The two triangles of a crossed edge of the lattice.
//!
//! Seen along the edge, its four vertices are one in each quarter around it. The line of the edge crosses one of the two triangles of a diagonal, at a height
//! that is compared with the place of the crossing. A diagonal is not used if one of its triangles is turned over; of the two, at least one has none.

use nalgebra::Point3;

use super::lattice_crossings::Crossing;
use super::swept::across;

/// The cells once round an edge, by the offset of the edge in them: counter-clockwise in the two directions across, in order.
pub(super) const AROUND: [usize; 4] = [3, 2, 0, 1];
/// Differences of height below this, m, do not decide.
const EQUAL: f64 = 1e-9;

/// The triangles of a crossing at `place`, counter-clockwise seen from outside.
pub(super) fn triangles(
    crossing: &Crossing,
    place: &Point3<f64>,
    corners: [u32; 4],
    vertices: &[Point3<f64>],
) -> [[u32; 3]; 2] {
    let [i, j] = across(crossing.axis);
    let seen = corners.map(|corner| {
        let off = vertices[corner as usize] - place;
        [off[i], off[j], off[crossing.axis]]
    });
    let errors = [0, 1].map(|first| error(&seen, first));
    let [a, b, c, d] = corners;
    let two = if errors[1] + EQUAL < errors[0] {
        [[b, c, d], [b, d, a]]
    } else {
        [[a, b, c], [a, c, d]]
    };
    // The directions across y are z, x in the order of a right hand.
    if crossing.begins != (crossing.axis == 1) {
        two.map(|[a, b, c]| [a, c, b])
    } else {
        two
    }
}

/// Distance along the edge from the crossing to the triangles of the diagonal from corner `first`; infinite if one of them is turned over.
fn error(seen: &[[f64; 3]; 4], first: usize) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|n| seen[(first + n) % 4]);
    let area =
        |p: [f64; 3], q: [f64; 3], r: [f64; 3]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    if area(a, b, c) < 0.0 || area(a, c, d) < 0.0 {
        return f64::INFINITY;
    }
    let edge = [0.0; 3];
    // The edge is on one side of the diagonal.
    let third = if area(a, c, edge) < 0.0 { b } else { d };
    let whole = area(a, c, third);
    let height =
        (area(c, third, edge) * a[2] + area(third, a, edge) * c[2] + area(a, c, edge) * third[2]) / whole;
    if height.is_finite() {
        height.abs()
    } else {
        f64::INFINITY
    }
}
