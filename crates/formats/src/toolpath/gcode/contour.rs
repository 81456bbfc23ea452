//! The contour that the cutter follows: its pieces, their direction and their curvature.

use std::f64::consts::TAU;

use armill_core::nalgebra::{Point2, Vector2};

use super::canonical::{Canonical, Sense};

/// Ends nearer than this angle, rad, are the same: rounding of computed ends, 1e-6 mm on a radius of 1 m.
const SAME_END: f64 = 1e-9;

/// A piece of the contour.
#[derive(Clone, Copy, Debug)]
pub(super) enum Contour {
    Line,
    Arc { centre: Point2<f64>, sense: Sense },
}

/// A move of the contour.
pub(super) struct ContourMove {
    pub contour: Contour,
    /// Its beginning in the plane.
    pub from: Point2<f64>,
    /// Position across the plane at its beginning.
    pub across: f64,
    /// Ends where the contour does.
    pub call: Canonical,
}

/// A piece of the contour with its ends.
pub(super) struct Stretch {
    pub contour: Contour,
    pub from: Point2<f64>,
    pub to: Point2<f64>,
}

impl Stretch {
    /// Direction of the contour at a point of it.
    pub fn direction(&self, at: Point2<f64>) -> Vector2<f64> {
        match self.contour {
            Contour::Line => (self.to - self.from).normalize(),
            Contour::Arc { centre, sense } => left_of((at - centre).normalize()) * f64::from(sense.sign()),
        }
    }

    /// Curvature of the contour at a point of it, above zero to the left.
    pub fn bend(&self, at: Point2<f64>) -> f64 {
        match self.contour {
            Contour::Line => 0.0,
            Contour::Arc { centre, sense } => f64::from(sense.sign()) / (at - centre).norm(),
        }
    }
}

/// A vector turned by 90 deg to the left.
pub(super) fn left_of(t: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-t.y, t.x)
}

/// The angle from one radius to another in this sense, above zero, at most a turn.
pub(super) fn sweep(from: Vector2<f64>, to: Vector2<f64>, sense: Sense) -> f64 {
    let angle = from.perp(&to).atan2(from.dot(&to));
    let angle = angle * f64::from(sense.sign());
    match angle {
        angle if angle.abs() < SAME_END => TAU,
        angle if angle < 0.0 => angle + TAU,
        angle => angle,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_sweep_has_the_programmed_direction() {
        let (x, y) = (Vector2::x(), Vector2::y());
        assert_eq!(sweep(x, y, Sense::Counterclockwise), PI / 2.0);
        assert_eq!(sweep(x, y, Sense::Clockwise), 1.5 * PI);
        assert_eq!(sweep(x, x, Sense::Counterclockwise), TAU);
        assert_eq!(sweep(x, x, Sense::Clockwise), TAU);
    }
}
