//! Ball-bar circles in front of an MH12, and the question that follows them.

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::measure::ballbar::joints::Circle;
use armill_core::nalgebra::{Point2, Point3};
use armill_core::path::Placing;
use armill_core::robot::{BranchPattern, JointCompliance, Robot};
use armill_core::source::{Arm, StiffnessModel};
use armill_core::workpiece::Plane;

/// m
pub const RADIUS: f64 = 0.1;

pub fn tool() -> Isometry {
    Isometry::translation(0.03, -0.02, 0.15)
}

/// A question for the arm with these drives, in any branch.
pub fn question<'a>(
    robot: &'a Robot,
    (compliance, model): (&'a [JointCompliance], &'a StiffnessModel),
    tool: &'a Isometry,
) -> Question<'a> {
    let arm = Arm {
        robot,
        compliance,
        model,
        flange_from_tool: tool,
    };
    Question {
        choice: BranchChoice::Of(BranchPattern::default()),
        ..Question::unloaded(arm, None)
    }
}

pub fn circle(centre: [f64; 3], tilt_deg: f64) -> Circle {
    let plane = Plane::tilted(Point3::from(centre), f64::to_radians(tilt_deg));
    Circle {
        placing: Placing::on_plane(&plane),
        centre: Point2::origin(),
        radius: RADIUS,
    }
}

/// Three circles away from the middle of the MH12, in planes of different tilt: they make all its joints identifiable.
pub fn three() -> [Circle; 3] {
    [
        circle([0.85, 0.25, 0.45], 90.0),
        circle([0.75, -0.35, 0.75], 0.0),
        circle([0.7, 0.45, 0.55], 40.0),
    ]
}
