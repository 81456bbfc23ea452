//! Whether a body keeps a demanded distance from bodies that do not move relative to each other: by bounds where they decide, else exactly.
//!
//! | body | decided by |
//! |---|---|
//! | capsule | the field of distances around the others, along its axis |
//! | box, cylinder | the same of a capsule around it, and of a capsule inside of it |
//! | mesh | its tree of boxes in the field: a node that is far enough is left out, a ball that is near enough is a conflict |
//!
//! What the field leaves undecided, a few millimetres around the demanded distance, is measured. The decision is exact but for rounding. Lengths in m.

use nalgebra::{IsometryMatrix3, Point3};

use super::bounds::Capsule;
use super::cell::Still;
use super::field::{Range, Thresholds};
use super::mesh::{Inside, Mesh};
use super::nearest::Triangle;
use super::shape::{Placed, Shape};

/// By how much a distance exceeds a demanded one: a measured distance is not known beyond this, m.
const MEASURED: f64 = 0.01;
/// Pieces of a triangle are not smaller than this, m.
const PIECE: f64 = 0.004;
/// An excess above this is not needed, m.
const WORTH: f64 = 0.04;
/// A node of a mesh that exceeds the demanded distance by this is not opened, m.
const FAR: f64 = 0.02;

/// By how much a distance exceeds the demanded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excess {
    /// A lower bound, m, where the distance is kept, else an upper bound, which is not above 0: no smaller motion changes the decision.
    pub by: f64,
    /// Whether the demanded distance is kept.
    pub is_kept: bool,
}

/// A body among others that do not move relative to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyAmong<'a> {
    /// Its shape.
    pub shape: &'a Shape,
    /// Of a mesh: the same surface in smaller triangles.
    pub pieces: Option<&'a Mesh>,
    /// Its frame in that of the others.
    pub others_from_body: IsometryMatrix3<f64>,
    /// The capsule around it, in the frame of the others.
    pub hull: Capsule,
}

impl Excess {
    /// Of a distance that was measured, m; negative where bodies overlap.
    pub(super) fn measured(distance: f64, least: f64) -> Excess {
        Excess {
            by: distance - least,
            is_kept: distance >= least && distance > 0.0,
        }
    }

    /// If a lower bound of the distance decides that it is kept.
    pub(super) fn kept(lower: f64, least: f64) -> Option<Excess> {
        Some(Excess::measured(lower, least)).filter(|excess| excess.is_kept)
    }

    /// If this range of a distance decides; `least`: see [`Still::excess`].
    fn of(range: Range, least: f64) -> Option<Excess> {
        if let Some(kept) = Excess::kept(range.lower, least) {
            return Some(kept);
        }
        (range.upper < least || range.upper <= 0.0).then_some(Excess {
            by: range.upper - least,
            is_kept: false,
        })
    }
}

impl Still {
    /// By how much the distance of a body from these exceeds `least`; it need not be known beyond `enough`. With `least` 0 the bodies must not touch.
    pub(super) fn excess(&self, body: &BodyAmong<'_>, thresholds: Thresholds) -> Excess {
        let least = thresholds.least;
        // A bound that is worth some steps along a path is not made better.
        let thresholds = Thresholds {
            least,
            enough: thresholds.enough.min(least + WORTH),
        };
        let around = self.field.range_of(&body.hull, &self.bodies, thresholds);
        match (body.shape, Excess::of(around, least)) {
            (_, Some(kept)) if kept.is_kept => kept,
            (Shape::Capsule(_), Some(conflict)) => conflict,
            (Shape::Capsule(capsule), None) => self.measured_capsule(capsule, body, least),
            (Shape::Mesh(mesh), _) => self.excess_of_mesh(body.pieces.unwrap_or(mesh), body, thresholds),
            (Shape::Box(_) | Shape::Cylinder(..), _) => {
                let inner = body
                    .shape
                    .inner()
                    .map(|inner| inner.moved(&body.others_from_body));
                let range = inner.map(|inner| self.field.range_of(&inner, &self.bodies, thresholds));
                // The body is larger: only a conflict of what is inside of it decides.
                let conflict = range.and_then(|range| Excess::of(range.upper_alone(), least));
                conflict.unwrap_or_else(|| self.measured(&body.shape.placed(&body.others_from_body), least))
            }
        }
    }

    /// The same, measured; not known beyond [`MEASURED`].
    fn measured(&self, body: &Placed, least: f64) -> Excess {
        let found = self.nearest(body, least + MEASURED, |_| true);
        let distance = found.map_or(least + MEASURED, |(found, _)| found.distance);
        Excess::measured(distance, least)
    }

    /// The same of a capsule, by its axis: where it overlaps the others, the excess is not above that of its axis.
    fn measured_capsule(&self, capsule: &Capsule, body: &BodyAmong<'_>, least: f64) -> Excess {
        let axis = Shape::Capsule(Capsule {
            radius: 0.0,
            ..*capsule
        });
        let radius = capsule.radius;
        let limit = least + radius + MEASURED;
        let found = self.nearest(&axis.placed(&body.others_from_body), limit, |_| true);
        let distance = found.map_or(limit, |(found, _)| found.distance) - radius;
        Excess::measured(distance, least)
    }

    fn excess_of_mesh(&self, pieces: &Mesh, body: &BodyAmong<'_>, thresholds: Thresholds) -> Excess {
        let least = thresholds.least;
        let frame = &body.others_from_body;
        // A body that the mesh encloses does not touch its surface.
        let encloses = |other: &Placed| pieces.contains(&frame.inverse_transform_point(&other.inner_point()));
        if self.bodies.iter().any(encloses) {
            return Excess {
                by: -least,
                is_kept: false,
            };
        }
        let mut found = thresholds.enough - least;
        // What the field leaves undecided is not farther away than this.
        let mut undecided = f64::INFINITY;
        // Nodes with the lower bound of their excess.
        let mut open = vec![(f64::NEG_INFINITY, 0_u32)];
        while let Some((bound, node)) = open.pop() {
            if bound >= found {
                continue;
            }
            let nodes = match pieces.inside(node) {
                Inside::Nodes(nodes) => nodes,
                // A leaf that keeps the distance by its bound.
                Inside::Triangles(_) if bound > 0.0 => {
                    found = found.min(bound);
                    continue;
                }
                Inside::Triangles(triangles) => {
                    for triangle in triangles {
                        match self.excess_of_triangle(&triangle.moved(frame), least) {
                            Ok(excess) if !excess.is_kept => return excess,
                            Ok(excess) => found = found.min(excess.by),
                            Err(upper) => undecided = undecided.min(upper),
                        }
                    }
                    continue;
                }
            };
            let mut ahead = [(0.0, 0); 2];
            for (ahead, node) in ahead.iter_mut().zip(nodes) {
                let (centre, radius) = pieces.ball(node);
                let far = least + FAR.min(found);
                match self.excess_of_ball((&(frame * centre), radius), Thresholds { least, enough: far }) {
                    Ok(excess) if !excess.is_kept => return excess,
                    Ok(excess) if excess.by >= FAR => {
                        found = found.min(excess.by);
                        *ahead = (f64::INFINITY, node);
                    }
                    Ok(excess) => *ahead = (excess.by, node),
                    Err(_) => *ahead = (f64::NEG_INFINITY, node),
                }
            }
            // The nearer one is taken first.
            if ahead[0].0 < ahead[1].0 {
                ahead.swap(0, 1);
            }
            open.extend(ahead.into_iter().filter(|(bound, _)| *bound < found));
        }
        if undecided == f64::INFINITY {
            return Excess {
                by: found,
                is_kept: true,
            };
        }
        // The nearest point may be in any of what is undecided, and is not farther away.
        let measured = self.nearest(&body.shape.placed(frame), undecided, |_| true);
        let distance = measured.map_or(undecided, |(nearest, _)| nearest.distance);
        Excess {
            by: found.min(distance - least),
            is_kept: distance >= least && distance > 0.0,
        }
    }

    /// The same of a part of a surface in a ball, a point of which is within its radius of its centre; if the field does not decide, what the
    /// distance does not exceed.
    fn excess_of_ball(&self, ball: (&Point3<f64>, f64), thresholds: Thresholds) -> Result<Excess, f64> {
        let (centre, radius) = ball;
        let range = self.field.range_at(centre, &self.bodies, thresholds.plus(radius));
        let range = Range {
            lower: range.lower - radius,
            upper: range.upper + radius,
        };
        Excess::of(range, thresholds.least).ok_or(range.upper)
    }

    /// The same of a triangle, which is halved until its pieces are small.
    fn excess_of_triangle(&self, triangle: &Triangle, least: f64) -> Result<Excess, f64> {
        let (centre, radius) = triangle.ball();
        let decided = self.excess_of_ball((&centre, radius), Thresholds { least, enough: least });
        if decided.is_ok() || radius < PIECE {
            return decided;
        }
        let [first, second] = triangle.halves();
        let first = self.excess_of_triangle(&first, least);
        if matches!(first, Ok(excess) if !excess.is_kept) {
            return first;
        }
        match (first, self.excess_of_triangle(&second, least)) {
            (Ok(first), Ok(second)) if second.is_kept && first.by < second.by => Ok(first),
            (Err(first), Err(second)) => Err(first.min(second)),
            (Err(first), Ok(second)) if second.is_kept => Err(first),
            (_, second) => second,
        }
    }
}
