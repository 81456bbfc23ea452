//! Shapes of bodies that robot files and studies share: boxes, cylinders, capsules.
//!
//! | key | solid |
//! |---|---|
//! | `box_mm = { from, to }` | along the axes of the frame, between two opposite corners |
//! | `cylinder_mm = { from, to, diameter }` | with flat ends, between the centres of its ends |
//! | `capsule_mm = { from, to, diameter }` | all within half the diameter of a segment |
//!
//! Coordinates in mm, in the frame of the body; m in the core.

use armill_core::clearance::{Bounds, Capsule, Segment, Shape};
use armill_core::nalgebra::Point3;
use armill_core::units::from_mm;
use schemars::JsonSchema;
use serde::Deserialize;

/// Smallest size of a body: 1 um.
const LEAST_MM: f64 = 1e-3;

/// A box along the axes of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxTable {
    /// One corner.
    // unit: mm
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub from: [f64; 3],
    /// The opposite corner.
    // unit: mm
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub to: [f64; 3],
}

/// A cylinder or a capsule.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoundTable {
    /// One end of its axis.
    // unit: mm
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub from: [f64; 3],
    /// The other end.
    // unit: mm
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub to: [f64; 3],
    /// Its diameter.
    // unit: mm
    #[schemars(range(min = 0.001, max = 1e6))]
    pub diameter: f64,
}

/// What is wrong with a shape: a message and a hint.
pub type ShapeFault = (String, &'static str);

impl BoxTable {
    /// The shape in the core, m.
    ///
    /// # Errors
    /// A box without volume.
    pub fn shape(&self) -> Result<Shape, ShapeFault> {
        let [from, to] = [self.from, self.to].map(point);
        let bounds = Bounds::of([from, to]);
        if 2.0 * bounds.half().min() < from_mm(LEAST_MM) {
            let message = format!("the box from {:?} to {:?} has no volume", self.from, self.to);
            return Err((message, "two opposite corners, different in x, y and z"));
        }
        Ok(Shape::Box(bounds))
    }
}

impl RoundTable {
    /// A cylinder in the core, m.
    ///
    /// # Errors
    /// Ends at the same point.
    pub fn cylinder(&self) -> Result<Shape, ShapeFault> {
        let axis = self.axis();
        if 2.0 * axis.half_length() < from_mm(LEAST_MM) {
            let message = format!("the ends of the cylinder are both at {:?}", self.from);
            return Err((message, "the centres of its two ends"));
        }
        Ok(Shape::Cylinder(axis, from_mm(0.5 * self.diameter)))
    }

    /// A capsule in the core, m; a ball where its ends are the same.
    pub fn capsule(&self) -> Shape {
        Shape::Capsule(Capsule {
            axis: self.axis(),
            radius: from_mm(0.5 * self.diameter),
        })
    }

    fn axis(&self) -> Segment {
        Segment {
            from: point(self.from),
            to: point(self.to),
        }
    }
}

fn point(mm: [f64; 3]) -> Point3<f64> {
    Point3::from(mm.map(from_mm))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_in_any_order_are_the_same_box() {
        let [a, b] = [[1.0, -2.0, 30.0], [-4.0, 5.0, 0.0]];
        for (from, to) in [(a, b), (b, a)] {
            let Ok(Shape::Box(bounds)) = (BoxTable { from, to }).shape() else {
                panic!("a box");
            };
            assert_eq!(bounds.least, Point3::new(-0.004, -0.002, 0.0));
            assert_eq!(bounds.greatest, Point3::new(0.001, 0.005, 0.03));
        }
    }

    #[test]
    fn shapes_without_volume_are_refused() {
        let flat = BoxTable {
            from: [0.0; 3],
            to: [10.0, 10.0, 0.0],
        };
        assert!(flat.shape().unwrap_err().0.contains("no volume"));
        let disc = RoundTable {
            from: [1.0; 3],
            to: [1.0; 3],
            diameter: 5.0,
        };
        assert!(disc.cylinder().is_err());
        assert!(matches!(disc.capsule(), Shape::Capsule(ball) if ball.radius == 0.0025));
    }
}
