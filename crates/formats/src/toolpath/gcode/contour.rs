//! The contour that the cutter follows: its pieces, their direction and their curvature.

use armill_core::nalgebra::{Point2, Vector2};

use super::canonical::{Canonical, Sense};

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
