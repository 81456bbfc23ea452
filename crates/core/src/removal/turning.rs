//! Moves of a tool, and the pieces with a fixed axis that stand for a move whose axis turns.
//!
//! The tip of a move goes straight, the axis turns evenly by the angle `Delta` in the plane of both axes. Each of `n` pieces has
//! the axis of its middle, and moves so that the point of the axis at half the height of the tool is where it belongs at both ends.
//! In between, no point of the tool is farther from where it belongs than
//!
//! ```text
//! e = L Delta / (2 n) + h_m (Delta / n)^2 / 8
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `L` | largest distance of a point of the tool from that point of the axis | m |
//! | `h_m` | half the height of the tool | m |
//! | `Delta`, `n` | angle between both axes, number of pieces | rad, - |
//!
//! The first term is the turn within a piece, at most `Delta / (2 n)` either way; the second the chord of the arc of that point. So
//! the swept solid is within `e` of the one computed and the other way round. `n` is the least with `e` below the
//! tolerance.
//!
//! Source: \[derived\].

use nalgebra::{Point3, Unit, Vector3};

use super::tool_solid::ToolSolid;

/// A straight move of the tip of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolMove {
    /// Tip at the start and at the end, in the frame of the part, m.
    pub ends: [Point3<f64>; 2],
    /// Tool axis from the tip towards the spindle, at the start and at the end.
    pub axes: [Unit<Vector3<f64>>; 2],
    /// Its index, by which the surface that it makes is known; less than 2^31.
    pub index: u32,
    /// Whether it is a rapid, which must not touch material.
    pub is_rapid: bool,
}

/// A piece of a move with a fixed axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) ends: [Point3<f64>; 2],
    pub(super) axis: Unit<Vector3<f64>>,
    /// Index of its move.
    pub(super) index: u32,
    /// Place of its move in the list.
    pub(super) place: u32,
}

/// Axes that differ by less, rad, are one.
const STRAIGHT: f64 = 1e-9;

impl ToolMove {
    /// Angle between both axes, rad.
    pub fn turn(&self) -> f64 {
        let [first, last] = &self.axes;
        first.cross(last).norm().atan2(first.dot(last))
    }

    /// Number of pieces with a fixed axis, so that no point of the tool is farther than `tolerance` (m) from where it belongs.
    pub fn pieces(&self, tool: &ToolSolid, tolerance: f64) -> usize {
        let turn = self.turn();
        if turn <= STRAIGHT {
            return 1;
        }
        let middle = middle_height(tool);
        // e <= tolerance is a quadratic inequality of the turn within a piece.
        let (b, c) = (0.5 * tool.reach_from(middle), 0.125 * middle);
        let most = 2.0 * tolerance / (b + (b * b + 4.0 * c * tolerance).sqrt());
        (turn / most).ceil().max(1.0) as usize
    }

    /// These pieces; `place` is that of the move in its list.
    pub(super) fn strokes(
        &self,
        tool: &ToolSolid,
        tolerance: f64,
        place: u32,
    ) -> impl Iterator<Item = Stroke> {
        let (count, turn, middle) = (self.pieces(tool, tolerance), self.turn(), middle_height(tool));
        let own = *self;
        let axis = move |part: f64| {
            let [first, last] = own.axes;
            if turn <= STRAIGHT {
                return first;
            }
            let (one, other) = (((1.0 - part) * turn).sin(), (part * turn).sin());
            Unit::new_normalize(first.into_inner() * one + last.into_inner() * other)
        };
        (0..count).map(move |piece| {
            let part = |k: f64| (piece as f64 + k) / count as f64;
            let fixed = axis(part(0.5));
            let tip = |k: f64| {
                if turn <= STRAIGHT {
                    return own.ends[k as usize];
                }
                let at = own.ends[0] + (own.ends[1] - own.ends[0]) * part(k);
                at + (axis(part(k)).into_inner() - fixed.into_inner()) * middle
            };
            Stroke {
                ends: [tip(0.0), tip(1.0)],
                axis: fixed,
                index: own.index,
                place,
            }
        })
    }
}

/// Half the height of the tool: the point of the axis that is where it belongs, m above the tip.
fn middle_height(tool: &ToolSolid) -> f64 {
    let [low, high] = tool.heights();
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;
    use crate::load::EndMillBody;

    #[test]
    fn no_point_of_a_turning_tool_is_farther_from_its_piece_than_the_tolerance() {
        let tool = ToolSolid::end_mill(&EndMillBody::new(0.01, 0.0).unwrap(), 0.03).unwrap();
        for (turn, tolerance) in [(0.02_f64, 5e-5), (0.3, 5e-5), (1.2, 2e-4), (0.001, 5e-5)] {
            let first = Unit::new_normalize(Vector3::new(0.2, 0.1, 1.0));
            let about = Unit::new_normalize(first.cross(&Vector3::new(0.4, 1.0, 0.1)));
            let motion = ToolMove {
                ends: [Point3::new(0.01, 0.02, 0.03), Point3::new(0.02, 0.015, 0.035)],
                axes: [first, Rotation3::from_axis_angle(&about, turn) * first],
                index: 7,
                is_rapid: false,
            };
            assert!((motion.turn() - turn).abs() < 1e-12);
            let strokes: Vec<Stroke> = motion.strokes(&tool, tolerance, 3).collect();
            assert_eq!(strokes.len(), motion.pieces(&tool, tolerance));
            let mut worst = 0.0_f64;
            for (piece, stroke) in strokes.iter().enumerate() {
                assert_eq!((stroke.index, stroke.place), (7, 3));
                for step in 0..=10 {
                    let within = f64::from(step) / 10.0;
                    let part = (piece as f64 + within) / strokes.len() as f64;
                    // The true pose: turned about the normal of both axes.
                    let turned = Rotation3::from_axis_angle(&about, part * turn);
                    let tip = motion.ends[0] + (motion.ends[1] - motion.ends[0]) * part;
                    let piece_tip = stroke.ends[0] + (stroke.ends[1] - stroke.ends[0]) * within;
                    let back = Rotation3::rotation_between(&(turned * first), &stroke.axis).unwrap();
                    for height in [0.0, 0.015, 0.03] {
                        for angle in 0..12 {
                            let across =
                                Rotation3::from_axis_angle(&first, f64::from(30 * angle).to_radians())
                                    * about;
                            let off = turned * (first.into_inner() * height + across.into_inner() * 0.005);
                            let error = (tip + off) - (piece_tip + back * off);
                            worst = worst.max(error.norm());
                        }
                    }
                }
            }
            assert!(worst <= tolerance, "{turn}: {worst}");
            // The bound is near the truth: not twice as many pieces as needed.
            assert!(strokes.len() < 3 || worst > 0.5 * tolerance, "{turn}: {worst}");
        }
    }

    #[test]
    fn a_fixed_axis_is_one_piece_with_the_ends_of_the_move() {
        let tool = ToolSolid::end_mill(&EndMillBody::new(0.01, 0.0).unwrap(), 0.03).unwrap();
        let ends = [Point3::new(0.1, 0.2, 0.3), Point3::new(-0.1, 0.7, 0.3)];
        let motion = ToolMove {
            ends,
            axes: [Vector3::z_axis(); 2],
            index: 0,
            is_rapid: false,
        };
        let strokes: Vec<Stroke> = motion.strokes(&tool, 1e-9, 0).collect();
        assert_eq!((strokes.len(), strokes[0].axis), (1, Vector3::z_axis()));
        assert_eq!(strokes[0].ends, ends);
    }
}
