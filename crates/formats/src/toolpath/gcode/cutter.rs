//! Cutter compensation: the path of the cutter centre at an offset from the programmed contour.
//!
//! Each piece of the contour is moved by the radius `r` to the side of the cutter: a line along its normal, an arc to
//! the radius `R - r` inside and `R + r` outside. Where two pieces leave a gap (convex corner) an arc of radius `r`
//! about the corner joins them; where they cross (concave corner) both end at the crossing. The first piece leads
//! from the bare contour to the end of the moved one: a line straight there, an arc on the circle that keeps its
//! direction at the end. So each piece waits for the next.
//!
//! | symbol | meaning |
//! |---|---|
//! | `P` | corner of the contour |
//! | `t`, `n` | direction along the contour, and to its left |
//! | `side` | 1 where the cutter is left of the contour, -1 right |
//!
//! Source: the geometry of offset curves; entry moves: NISTIR 6556, appendix B, "cutter radius compensation".

use std::f64::consts::TAU;

use armill_core::nalgebra::{Point2, Vector2};

use super::canonical::{ArcFeed, Canonical, Plane, Sense};
use super::contour::{Contour, ContourMove, Stretch, left_of, sweep};
use super::refusal::Refusal;

/// Directions closer than this, rad, go on straight: the gap or overlap is `r` times that, below a thousandth of `r`.
const TANGENT: f64 = 1e-3;
/// Directions nearer to opposite than this, rad, turn back: there bends of the radius of the cutter outweigh the
/// corner.
const TURNING_BACK: f64 = 0.05;
/// Calls that may wait for the next piece.
const MOST_WAITING: usize = 10_000;
/// A crossing that is outside its piece by this fraction of the cutter radius is rounding, not gouging.
const OUTSIDE: f64 = 1e-6;

/// What receives canonical calls, each with its line of the program.
pub(super) type Out<'a> = &'a mut dyn FnMut(Canonical, u32) -> Result<(), Refusal>;

/// Line or circle of an offset piece, in the plane.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Line {
        towards: Vector2<f64>,
    },
    Circle {
        centre: Point2<f64>,
        radius: f64,
        sense: Sense,
        /// Whole turns before the last one, rad.
        before: f64,
    },
}

/// A moved piece that has come, and may still end elsewhere.
#[derive(Clone, Debug)]
struct Piece {
    shape: Shape,
    start: Point2<f64>,
    end: Point2<f64>,
    corner: Point2<f64>,
    /// Of the contour, at its end.
    leaves: Vector2<f64>,
    /// Curvature of the contour, to the left.
    bend: f64,
    call: Canonical,
    line: u32,
}

/// Active compensation: the plane, the cutter, and the position of its centre.
#[derive(Clone, Copy, Debug)]
struct Active {
    side: f64,
    radius: f64,
    plane: Plane,
    /// Whether no piece was moved yet.
    entering: bool,
    /// Position of the cutter centre.
    at: Point2<f64>,
}

/// Cutter compensation and the calls that wait for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Cutter {
    active: Option<Active>,
    /// The last move, which the next may shorten.
    piece: Option<Piece>,
    /// Calls behind it, in order, with their lines.
    waiting: Vec<(Canonical, u32)>,
    /// Whether it was ended and no move has come since.
    leaving: bool,
    /// Line of the program being read.
    pub line: u32,
}

impl Piece {
    /// Whether `at`, a point of its line or circle, is between its start and its end, within a length of `slack`.
    fn contains(&self, at: Point2<f64>, slack: f64) -> bool {
        match self.shape {
            Shape::Line { towards } => {
                (at - self.start).dot(&towards) >= -slack && (at - self.end).dot(&towards) <= slack
            }
            Shape::Circle {
                centre,
                radius,
                sense,
                before,
            } => {
                let turn = |from: Point2<f64>, to: Point2<f64>| sweep(from - centre, to - centre, sense);
                let slack = slack / radius;
                let (whole, part) = (turn(self.start, self.end) + before, turn(self.start, at));
                part <= whole + slack || part >= TAU - slack
            }
        }
    }
}

impl Cutter {
    /// Whether moves are moved aside; a cutter without radius moves nothing.
    pub fn is_on(&self) -> bool {
        self.active.is_some()
    }

    /// Begins with a cutter of this radius on the left; a negative radius is on the right.
    pub fn begin(&mut self, plane: Plane, left_radius: f64) -> Result<(), Refusal> {
        if self.is_on() {
            return Err(Refusal::CompensationOn);
        }
        if plane == Plane::Yz {
            return Err(Refusal::CompensationPlane);
        }
        self.leaving = false;
        // A cutter without radius follows the contour itself.
        self.active = (left_radius != 0.0).then_some(Active {
            side: left_radius.signum(),
            radius: left_radius.abs(),
            plane,
            entering: true,
            at: Point2::origin(),
        });
        Ok(())
    }

    /// Ends it: the last piece ends at the offset end of its contour.
    pub fn end(&mut self, out: Out<'_>) -> Result<(), Refusal> {
        self.leaving |= self.active.take().is_some();
        self.flush(out)
    }

    /// Gives a call on, or keeps it behind the piece that waits.
    ///
    /// # Errors
    /// Too many calls between two moves.
    pub fn pass(&mut self, call: Canonical, out: Out<'_>) -> Result<(), Refusal> {
        if self.piece.is_none() {
            return out(call, self.line);
        }
        if self.waiting.len() >= MOST_WAITING {
            return Err(Refusal::CompensationWaits { limit: MOST_WAITING });
        }
        self.waiting.push((call, self.line));
        Ok(())
    }

    /// Gives out all that waits.
    pub fn flush(&mut self, out: Out<'_>) -> Result<(), Refusal> {
        if let Some(Piece { call, line, .. }) = self.piece.take() {
            out(call, line)?;
        }
        for (call, line) in self.waiting.drain(..) {
            out(call, line)?;
        }
        Ok(())
    }

    /// Follows a move of the contour.
    ///
    /// It waits until the next one shows where it ends; the piece that waited is given out. A rapid is moved as a cut
    /// is.
    ///
    /// # Errors
    /// An arc inside which the cutter does not fit, a corner that it does not reach, an arc right after the end.
    pub fn follow(&mut self, next: ContourMove, out: Out<'_>) -> Result<(), Refusal> {
        let ContourMove {
            contour,
            from,
            across,
            mut call,
        } = next;
        let arc = matches!(contour, Contour::Arc { .. });
        let Some(mut active) = self.active else {
            if std::mem::take(&mut self.leaving) && arc {
                return Err(Refusal::ArcAfterCompensation);
            }
            return out(call, self.line);
        };
        let to = end_in(&call, active.plane);
        if !arc && (to - from).norm() == 0.0 {
            // A move only across the plane: at the same offset from the contour.
            let offset = if active.entering { to } else { active.at };
            end_at(&mut call, active.plane, offset);
            return self.pass(call, out);
        }
        let stretch = Stretch { contour, from, to };
        let mut next = moved(&active, &stretch, call)?;
        next.line = self.line;
        if active.entering {
            enter(&mut next, &stretch);
            active.entering = false;
        } else if let Some(last) = self.piece.as_mut() {
            let arrives = stretch.direction(from);
            match corner(last, arrives, stretch.bend(from), &active) {
                Corner::None => next.start = last.end,
                Corner::Concave => {
                    let at = meeting(last, &next, arrives, active.radius)?;
                    self.end_last_at(at, active.plane);
                    next.start = at;
                }
                Corner::Convex => {
                    let arc = ArcFeed {
                        plane: active.plane,
                        end: next.start.into(),
                        centre: last.corner.into(),
                        turns: if active.side > 0.0 { -1 } else { 1 },
                        across,
                        rotary: rotary_of(&last.call),
                    };
                    self.flush(out)?;
                    out(Canonical::ArcFeed(arc), self.line)?;
                }
            }
        }
        self.flush(out)?;
        active.at = next.end;
        self.active = Some(active);
        self.piece = Some(next);
        Ok(())
    }

    /// Ends the piece that waits earlier, and what moves across the plane behind it.
    fn end_last_at(&mut self, at: Point2<f64>, plane: Plane) {
        if let Some(last) = &mut self.piece {
            last.end = at;
            end_at(&mut last.call, plane, at);
        }
        for (call, _) in &mut self.waiting {
            if let Canonical::StraightFeed(_) | Canonical::StraightTraverse(_) = call {
                end_at(call, plane, at);
            }
        }
    }
}

/// How two offset pieces are joined.
enum Corner {
    /// They go on straight.
    None,
    /// They cross.
    Concave,
    /// They leave a gap.
    Convex,
}

/// The corner between a piece and one that `arrives` there with this bend, seen from the side of the cutter.
fn corner(last: &Piece, arrives: Vector2<f64>, bend: f64, active: &Active) -> Corner {
    let cross = last.leaves.perp(&arrives);
    let onward = last.leaves.dot(&arrives) > 0.0;
    if cross.abs() < TANGENT && onward {
        return Corner::None;
    }
    // Where the contour turns back on itself, its curvature decides on which side it continues: a radius from the
    // corner.
    let bends = match !onward && cross.abs() < TURNING_BACK {
        true => cross - (last.bend + bend) * active.radius / 2.0,
        false => cross,
    };
    match bends * active.side > 0.0 {
        true => Corner::Concave,
        false => Corner::Convex,
    }
}

/// Where two pieces cross, if the cutter comes that far on both.
fn meeting(last: &Piece, next: &Piece, arrives: Vector2<f64>, radius: f64) -> Result<Point2<f64>, Refusal> {
    let slack = OUTSIDE * radius;
    crossing(last, next, arrives)
        .filter(|at| last.contains(*at, slack) && next.contains(*at, slack))
        .ok_or(Refusal::Gouging { radius })
}

/// The offset piece, without regard to the previous one.
fn moved(active: &Active, stretch: &Stretch, mut call: Canonical) -> Result<Piece, Refusal> {
    let Stretch { contour, from, to } = *stretch;
    let (arrives, leaves) = (stretch.direction(from), stretch.direction(to));
    let offset = active.side * active.radius;
    let start = from + left_of(arrives) * offset;
    let end = to + left_of(leaves) * offset;
    let shape = match contour {
        Contour::Line => Shape::Line { towards: arrives },
        Contour::Arc { centre, sense } => {
            let arc = (to - centre).norm();
            let inside = (active.side > 0.0) == (sense == Sense::Counterclockwise);
            let radius = if inside {
                arc - active.radius
            } else {
                arc + active.radius
            };
            if radius <= 0.0 {
                return Err(Refusal::ArcInsideCutter {
                    arc,
                    radius: active.radius,
                });
            }
            Shape::Circle {
                centre,
                radius,
                sense,
                before: match &call {
                    Canonical::ArcFeed(arc) => TAU * f64::from(arc.turns.abs() - 1),
                    _ => 0.0,
                },
            }
        }
    };
    end_at(&mut call, active.plane, end);
    Ok(Piece {
        shape,
        start,
        end,
        corner: to,
        leaves,
        bend: stretch.bend(to),
        call,
        line: 0,
    })
}

/// Lets the first piece begin on the bare contour.
fn enter(piece: &mut Piece, stretch: &Stretch) {
    let Stretch { contour, from, .. } = *stretch;
    piece.start = from;
    let (
        Contour::Arc { centre, .. },
        Shape::Circle {
            centre: on,
            radius: around,
            ..
        },
    ) = (contour, &mut piece.shape)
    else {
        return;
    };
    // The centre stays on the radius to the end, at u from it: |from - end - u w| = u with w towards the old centre.
    let w = (centre - piece.end).normalize();
    let chord = from - piece.end;
    let u = chord.norm_squared() / (2.0 * chord.dot(&w));
    if !u.is_finite() {
        return;
    }
    let centre = piece.end + w * u;
    (*on, *around) = (centre, u.abs());
    if let Canonical::ArcFeed(arc) = &mut piece.call {
        arc.centre = centre.into();
    }
}

/// Where two pieces cross: next to their corner, on the side where both become shorter.
fn crossing(last: &Piece, next: &Piece, arrives: Vector2<f64>) -> Option<Point2<f64>> {
    let inwards = arrives - last.leaves;
    let best = |[one, other]: [Point2<f64>; 2]| {
        let key = |at: Point2<f64>| {
            let from_corner = at - last.corner;
            (from_corner.dot(&inwards) < 0.0, from_corner.norm_squared())
        };
        if key(one) <= key(other) { one } else { other }
    };
    match (last.shape, next.shape) {
        (Shape::Line { towards: t1 }, Shape::Line { towards: t2 }) => {
            // How far along the first line the second is met; not finite where they are parallel.
            let along = (next.start - last.end).perp(&t2) / t1.perp(&t2);
            along.is_finite().then(|| last.end + t1 * along)
        }
        (Shape::Line { towards }, Shape::Circle { centre, radius, .. }) => {
            line_and_circle(last.end, towards, centre, radius).map(best)
        }
        (Shape::Circle { centre, radius, .. }, Shape::Line { towards }) => {
            line_and_circle(next.start, towards, centre, radius).map(best)
        }
        (
            Shape::Circle {
                centre: c1,
                radius: r1,
                ..
            },
            Shape::Circle {
                centre: c2,
                radius: r2,
                ..
            },
        ) => {
            // The chord that both circles share crosses the line of their centres at `along`, half of it is
            // `height.sqrt()`.
            let between = c2 - c1;
            let d = between.norm();
            let along = (d * d + r1 * r1 - r2 * r2) / (2.0 * d);
            let height = r1 * r1 - along * along;
            if d == 0.0 || height < 0.0 {
                return None;
            }
            let foot = c1 + between * (along / d);
            let aside = left_of(between) * (height.sqrt() / d);
            Some(best([foot + aside, foot - aside]))
        }
    }
}

/// Intersection of a line and a circle; `None` if they do not intersect.
fn line_and_circle(
    through: Point2<f64>,
    towards: Vector2<f64>,
    centre: Point2<f64>,
    radius: f64,
) -> Option<[Point2<f64>; 2]> {
    let foot = through + towards * (centre - through).dot(&towards);
    let height = radius * radius - (foot - centre).norm_squared();
    (height >= 0.0).then(|| [foot + towards * height.sqrt(), foot - towards * height.sqrt()])
}

/// Where a move ends in the plane.
fn end_in(call: &Canonical, plane: Plane) -> Point2<f64> {
    let [first, second, _] = plane.axes();
    match call {
        Canonical::StraightFeed(end) | Canonical::StraightTraverse(end) => {
            Point2::new(end[first], end[second])
        }
        Canonical::ArcFeed(arc) => arc.end.into(),
        _ => Point2::origin(),
    }
}

/// Lets a move end elsewhere in the plane.
fn end_at(call: &mut Canonical, plane: Plane, at: Point2<f64>) {
    let [first, second, _] = plane.axes();
    match call {
        Canonical::StraightFeed(end) | Canonical::StraightTraverse(end) => {
            end[first] = at.x;
            end[second] = at.y;
        }
        Canonical::ArcFeed(arc) => arc.end = at.into(),
        _ => {}
    }
}

/// A, B, C at the end of a move.
fn rotary_of(call: &Canonical) -> [f64; 3] {
    match call {
        Canonical::StraightFeed([.., a, b, c]) | Canonical::StraightTraverse([.., a, b, c]) => [*a, *b, *c],
        Canonical::ArcFeed(arc) => arc.rotary,
        _ => [0.0; 3],
    }
}
