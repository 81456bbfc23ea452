//! Centre and radius of a curve: position and size of the circle, which are not errors of form.
//!
//! ```text
//! dr(a) = x cos a + y sin a + dR + form(a)        least over the turn: <form, form>
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `y` | shift of the centre along the axes of the plane | m |
//! | `dR` | radius beyond the nominal one | m |
//!
//! To first order in the shift over the radius; larger shifts are removed before, by the circle itself.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::turn::Turn;

/// The datum that is removed from every curve before the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Removed {
    /// The centre: the position of the part is not known.
    pub centre: bool,
    /// The radius: cutters and gauges differ from their nominal radii.
    pub radius: bool,
}

/// Centre and radius of a curve; 0 where they are not removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datum {
    /// m
    pub centre: Vector2<f64>,
    /// m
    pub radius: f64,
}

impl Datum {
    /// The datum of `curve` as selected by `removed`, and the curve without it.
    pub fn remove(turn: &Turn, curve: &[f64], removed: Removed) -> (Datum, Vec<f64>) {
        let row = |a: &f64| {
            let (sin, cos) = a.sin_cos();
            let requested = |is: bool, value: f64| if is { value } else { 0.0 };
            let [c, r] = [removed.centre, removed.radius];
            Vector3::new(requested(c, cos), requested(c, sin), requested(r, 1.0))
        };
        let rows: Vec<Vector3<f64>> = turn.angle().iter().map(row).collect();
        let part = |i: usize| -> Vec<f64> { rows.iter().map(|row| row[i]).collect() };
        let parts = [part(0), part(1), part(2)];
        let mut normal = Matrix3::from_fn(|i, j| turn.product(&parts[i], &parts[j]));
        let right = Vector3::from_fn(|i, _| turn.product(&parts[i], curve));
        // Parameters that are not removed are 0.
        for i in 0..3 {
            if !(if i == 2 { removed.radius } else { removed.centre }) {
                normal[(i, i)] = 1.0;
            }
        }
        // An arc of a third of a turn, the least of a `Turn`, determines all three.
        let found = normal.cholesky().map_or_else(Vector3::zeros, |n| n.solve(&right));
        let left = rows.iter().zip(curve).map(|(row, value)| value - row.dot(&found));
        let datum = Datum {
            centre: found.xy(),
            radius: found.z,
        };
        (datum, left.collect())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn the_selected_centre_and_radius_are_removed_and_the_form_remains() {
        for arc in [1.0, 0.6] {
            let angle: Vec<f64> = (0..200).map(|k| arc * TAU * f64::from(k) / 200.0).collect();
            let turn = Turn::new(angle.clone()).unwrap();
            let of = |a: &f64| 30e-6 * a.cos() - 20e-6 * a.sin() + 8e-6;
            let curve: Vec<f64> = angle.iter().map(of).collect();
            let both = Removed {
                centre: true,
                radius: true,
            };
            let (datum, left) = Datum::remove(&turn, &curve, both);
            assert!((datum.centre - Vector2::new(30e-6, -20e-6)).norm() < 1e-16);
            assert!((datum.radius - 8e-6).abs() < 1e-16 && turn.rms(&left) < 1e-16);
            let none = Removed {
                centre: false,
                radius: false,
            };
            assert_eq!(Datum::remove(&turn, &curve, none).1, curve);
        }
    }

    #[test]
    fn a_datum_that_was_removed_is_zero_afterwards() {
        let angle: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
        let turn = Turn::new(angle.clone()).unwrap();
        let curve: Vec<f64> = angle.iter().map(|a| (a.sin() + 0.3).powi(3) * 1e-5).collect();
        for (centre, radius) in [(true, true), (true, false), (false, true)] {
            let removed = Removed { centre, radius };
            let (_, left) = Datum::remove(&turn, &curve, removed);
            let (again, _) = Datum::remove(&turn, &left, removed);
            assert!(again.centre.norm() < 1e-18 && again.radius.abs() < 1e-18);
            assert!(turn.rms(&left) < turn.rms(&curve));
        }
    }
}
