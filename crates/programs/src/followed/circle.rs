//! The arc through three points.
//!
//! ```text
//! u = p_1 - p_0    v = p_2 - p_0    n = u x v        centre = p_0 + (|u|^2 (v x n) + |v|^2 (n x u)) / (2 |n|^2)
//! ```
//!
//! The arc is right-handed about `n`, from `p_0` over `p_1` to `p_2`. m.

use std::f64::consts::TAU;

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::Arc;

/// A larger radius is treated as a line, m: its arc over a metre leaves the chord by a tenth of a micrometre.
const LARGEST_RADIUS: f64 = 1e6;

/// Curve through three points.
pub(super) enum Through {
    /// An arc, and the fraction of it at the second point.
    Arc(Arc, f64),
    /// A line: the points are on one line, or two of them coincide.
    Line,
}

/// The arc from the first point through the second to the third.
pub(super) fn through([begin, via, end]: [Point3<f64>; 3]) -> Through {
    let (u, v) = (via - begin, end - begin);
    let n = u.cross(&v);
    // Two coincident points leave the radius undefined: 0/0.
    let radius = u.norm() * v.norm() * (u - v).norm() / (2.0 * n.norm());
    if radius.is_nan() || radius >= LARGEST_RADIUS {
        return Through::Line;
    }
    let centre =
        begin + (v.cross(&n) * u.norm_squared() + n.cross(&u) * v.norm_squared()) / (2.0 * n.norm_squared());
    let axis = Unit::new_normalize(n);
    let turned = |to: Point3<f64>| -> f64 {
        let (from, to): (Vector3<f64>, Vector3<f64>) = (begin - centre, to - centre);
        from.cross(&to).dot(&axis).atan2(from.dot(&to)).rem_euclid(TAU)
    };
    let sweep = turned(end);
    match sweep > 0.0 {
        true => Through::Arc(Arc { centre, axis, sweep }, turned(via) / sweep),
        false => Through::Line,
    }
}

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::Rotation3;

    use super::*;

    #[test]
    fn three_points_of_a_circle_give_its_centre_and_angle() {
        let (centre, radius) = (Point3::new(1.2, -0.4, 0.7), 0.083);
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        let on = |angle: f64| centre + turn * Vector3::new(angle.cos(), angle.sin(), 0.0) * radius;
        for (part, sweep) in [(0.5, 1.0), (0.1, 3.0), (0.9, 4.0), (0.3, 6.2), (0.5, 0.01)] {
            for way in [1.0, -1.0] {
                let at = |part: f64| on(0.3 + way * part * sweep);
                let Through::Arc(arc, found) = through([at(0.0), at(part), at(1.0)]) else {
                    panic!("an arc of {sweep} rad");
                };
                // A short arc is close to its chord: rounding errors of the points grow with its square.
                let good = 1e-14 / (sweep * sweep).min(1.0);
                assert!((arc.centre - centre).norm() < good, "{sweep}");
                assert!((arc.sweep - sweep).abs() < 1e2 * good && (found - part).abs() < 1e2 * good);
                assert!((arc.axis.into_inner() - turn * Vector3::z() * way).norm() < 1e2 * good);
            }
        }
    }

    #[test]
    fn points_on_a_line_and_coincident_points_give_no_arc() {
        let at = |x: f64| Point3::new(x, 2.0 * x, -x);
        for three in [
            [0.0, 1.0, 2.0],
            [0.0, 3.0, 2.0],
            [0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0],
            [1.0; 3],
        ] {
            assert!(matches!(through(three.map(at)), Through::Line), "{three:?}");
        }
    }
}
