//! What a program holds, counted while it is read.

use armill_core::nalgebra::{Point3, Rotation3};
use armill_core::path::{Course, Move, Pace};

use super::options::Warnings;

/// What a program holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Lines that were read.
    pub lines: u32,
    /// Moves, the first among them.
    pub moves: u64,
    /// Moves that cut.
    pub cuts: u64,
    /// Arcs among them.
    pub arcs: u64,
    /// Operations.
    pub operations: u64,
    /// Cuts at a speed that the program does not tell.
    pub feeds_untold: u64,
    /// Least and greatest x, y, z of the cuts, m.
    pub bounds: Option<[Point3<f64>; 2]>,
    /// Whether a move tells the tool axis.
    pub tool_axis_told: bool,
    /// What has no part in the path, or was taken for granted.
    pub warnings: Warnings,
}

impl Summary {
    pub(super) fn count(&mut self, from: Option<Point3<f64>>, next: &Move) {
        self.moves += 1;
        let Some(from) = from.filter(|_| next.pace.cuts()) else {
            return;
        };
        self.cuts += 1;
        self.feeds_untold += u64::from(next.pace == Pace::Untold);
        self.reach(from);
        self.reach(next.end);
        let Course::Arc(arc) = next.course else { return };
        self.arcs += 1;
        let arm = from - arc.centre;
        let arm = arm - arc.axis.into_inner() * arm.dot(&arc.axis);
        let aside = arc.axis.cross(&arm);
        for coordinate in 0..3 {
            // The arc c + arm cos + aside sin is farthest where its derivative is zero, and half a turn on.
            let first = aside[coordinate]
                .atan2(arm[coordinate])
                .rem_euclid(std::f64::consts::PI);
            for angle in [first, first + std::f64::consts::PI] {
                if angle < arc.sweep {
                    let part = (next.end - from).dot(&arc.axis) * angle / arc.sweep;
                    let turned = Rotation3::from_axis_angle(&arc.axis, angle) * arm;
                    let height = arc.axis.into_inner() * ((from - arc.centre).dot(&arc.axis) + part);
                    self.reach(arc.centre + turned + height);
                }
            }
        }
    }

    fn reach(&mut self, at: Point3<f64>) {
        let [least, greatest] = self.bounds.unwrap_or([at, at]);
        self.bounds = Some([least.inf(&at), greatest.sup(&at)]);
    }
}
