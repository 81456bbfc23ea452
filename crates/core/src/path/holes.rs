//! Holes: single points, each with the direction of the tool into the part.
//!
//! As points of a path each starts a new cut (all at the same distance along the cuts), and its direction is along the
//! tool. Everything that applies to a path also applies to holes, and no result depends on their order.
//!
//! | symbol | meaning | frame |
//! |---|---|---|
//! | `at` | position of the tip at the end of the hole, m | path |
//! | `axis` | out of the part, from the tip towards the spindle | path |

use nalgebra::{Point3, Unit, Vector3};

use super::placing::Placing;
use super::program::Pace;
use super::sampled::SampledPath;
use super::sampler::PathPoint;
use crate::load::Advance;

/// Plunges whose ends differ by less than this across the tool are one hole, m: the error of reading a coordinate.
const SAME_PLACE: f64 = 1e-6;

/// One hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// Position of the tip at its end, m.
    pub at: Point3<f64>,
    /// Out of the part.
    pub axis: Unit<Vector3<f64>>,
    /// Line of the file.
    pub line: u32,
}

/// These holes as points, in their order; without feed and spindle speed.
pub fn path_of_holes(holes: &[Hole]) -> SampledPath {
    let point = |hole: &Hole| PathPoint {
        at: hole.at,
        axis: Some(hole.axis),
        normal: None,
        spin: None,
        direction: -hole.axis,
        along: 0.0,
        pace: Pace::Unknown,
        line: hole.line,
    };
    SampledPath {
        points: holes.iter().map(point).collect(),
        moves: holes.len(),
        ..SampledPath::default()
    }
}

/// The holes of a drilling program: the end of every cut along the tool axis that is not followed by a cut across it.
/// Feed and spindle are those of the program.
///
/// Consecutive pecks at one position are one hole, as deep as the deepest.
pub fn drilled_holes(path: &SampledPath, placing: &Placing) -> SampledPath {
    let mut holes = SampledPath {
        moves: path.moves,
        ..SampledPath::default()
    };
    let all: Vec<_> = path.with_operations().collect();
    for (index, point, operation) in &all {
        if placing.advance(point) != Advance::Plunge {
            continue;
        }
        let next = all.get(index + 1).filter(|(next, ..)| !path.begins(*next));
        let goes_on = next.map(|(_, next, _)| placing.advance(next));
        if matches!(goes_on, Some(Advance::Plunge | Advance::Level | Advance::Ramp(_))) {
            continue;
        }
        let hole = PathPoint {
            along: 0.0,
            ..**point
        };
        let out = placing.path_spindle(point).into_inner();
        if let Some(before) = holes.points.last_mut()
            && placing.path_spindle(before).into_inner() == out
        {
            let by = hole.at - before.at;
            if (by - out * by.dot(&out)).norm() <= SAME_PLACE {
                if by.dot(&out) < 0.0 {
                    *before = hole;
                }
                continue;
            }
        }
        let known = holes.operations.last().map(|(_, operation)| operation);
        if let Some(begun) = operation
            && known != Some(begun)
        {
            holes.operations.push((holes.points.len(), (*begun).clone()));
        }
        holes.points.push(hole);
    }
    holes
}

#[cfg(test)]
mod tests {
    use super::super::program::{Course, Move, Operation, Step};
    use super::super::{PathBuilder, Sampling, Spin};
    use super::*;
    use crate::frame::Isometry;

    fn placing() -> Placing {
        Placing {
            base_from_path: Isometry::translation(1.0, 0.0, 0.5),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::Fixed(0.0),
        }
    }

    /// The path through these ends (mm), each at the feed unless it is a rapid.
    fn path(ends: &[([f64; 3], bool)]) -> SampledPath {
        let sampling = Sampling {
            chord_error: 1e-5,
            step: 1e-3,
        };
        let mut builder = PathBuilder::new(sampling, 10_000);
        for (line, (end, rapid)) in ends.iter().enumerate() {
            if line == 0 {
                builder.take(Step::Operation(Operation {
                    tool: Some(3),
                    ..Operation::default()
                }));
            }
            builder.take(Step::Move(Move {
                end: Point3::from(Vector3::from(*end) * 1e-3),
                axis: None,
                spin: None,
                course: Course::Line,
                pace: if *rapid { Pace::Rapid } else { Pace::Feed(0.002) },
                line: line as u32 + 1,
            }));
        }
        builder.finish().unwrap()
    }

    #[test]
    fn pecks_are_one_hole_and_a_plunge_followed_by_milling_is_not_a_hole() {
        let program = path(&[
            ([0.0, 0.0, 5.0], true),
            // Two pecks.
            ([0.0, 0.0, -4.0], false),
            ([0.0, 0.0, 5.0], true),
            ([0.0, 0.0, -3.5], true),
            ([0.0, 0.0, -9.0], false),
            ([0.0, 0.0, 5.0], true),
            // Another hole, fed out again.
            ([20.0, 0.0, 5.0], true),
            ([20.0, 0.0, -6.0], false),
            ([20.0, 0.0, 5.0], false),
            // A pocket.
            ([40.0, 0.0, 5.0], true),
            ([40.0, 0.0, -2.0], false),
            ([60.0, 0.0, -2.0], false),
        ]);
        let holes = drilled_holes(&program, &placing());
        let ends: Vec<[f64; 3]> = holes
            .points
            .iter()
            .map(|point| point.at.coords.map(|c| (c * 1e3).round()).into())
            .collect();
        assert_eq!(ends, [[0.0, 0.0, -9.0], [20.0, 0.0, -6.0]]);
        assert_eq!(holes.points.iter().map(|p| p.line).collect::<Vec<_>>(), [5, 8]);
        assert!((0..2).all(|index| holes.begins(index)));
        assert_eq!(holes.operations.len(), 1);
        assert_eq!(holes.points[0].pace, Pace::Feed(0.002));
    }

    #[test]
    fn a_list_of_holes_goes_in_along_each_axis_and_starts_a_cut_at_each() {
        let tilted = Unit::new_normalize(Vector3::new(0.6, 0.0, 0.8));
        let holes = [Vector3::z_axis(), tilted].map(|axis| Hole {
            at: Point3::new(0.1, 0.0, 0.0),
            axis,
            line: 7,
        });
        let path = path_of_holes(&holes);
        for (point, hole) in path.points.iter().zip(&holes) {
            assert_eq!(placing().advance(point), Advance::Plunge);
            assert_eq!(placing().path_spindle(point), hole.axis);
        }
        assert!((0..2).all(|index| path.begins(index)));
        assert_eq!(path.stretches().count(), 2);
    }
}
