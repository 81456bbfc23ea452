//! A tool on a move, and whether it reaches a point: on a line by golden sections of time, else by bisection with the largest speed of a point of the tool as a bound.

use armill_core::nalgebra::{Point3, Rotation3, Unit, Vector3};
use armill_core::path::{Course, Move};

/// A flat, ball or bull nose end mill; m.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub radius: f64,
    pub corner: f64,
    pub length: f64,
}

impl Body {
    /// Distance of a point from the body, negative inside; it is never greater than the true one, and has its sign. `rho` is the distance from the axis, `h` the
    /// height above the tip.
    pub fn distance(&self, rho: f64, h: f64) -> f64 {
        let (out, down) = (rho - (self.radius - self.corner), self.corner - h);
        let sides = (rho - self.radius).max(-h).max(h - self.length);
        match out > 0.0 && down > 0.0 {
            true => sides.max(out.hypot(down) - self.corner),
            false => sides,
        }
    }
}

/// A move of the program.
#[derive(Clone, Debug)]
pub struct MovingTool {
    body: Body,
    start: Point3<f64>,
    end: Point3<f64>,
    course: Course,
    first_axis: Unit<Vector3<f64>>,
    /// Turn of the tool axis: direction and angle, rad.
    turn: Option<(Unit<Vector3<f64>>, f64)>,
    /// Length of the way of the tip, m.
    way: f64,
    /// Speed of the fastest point of the tool, m per move.
    speed: f64,
    /// Line of the program.
    pub line: u32,
    pub is_rapid: bool,
}

/// Time is bisected until the tool moves by less, m.
const RESOLUTION: f64 = 2e-9;

impl MovingTool {
    /// A move of a tool from `start`.
    pub fn new(body: Body, start: Point3<f64>, axes: [Unit<Vector3<f64>>; 2], to: &Move) -> MovingTool {
        let turn = Rotation3::rotation_between(&axes[0], &axes[1]).and_then(|turn| turn.axis_angle());
        let mut moving = MovingTool {
            body,
            start,
            end: to.end,
            course: to.course,
            first_axis: axes[0],
            turn,
            way: 0.0,
            speed: 0.0,
            line: to.line,
            is_rapid: !to.pace.cuts(),
        };
        let way = match to.course {
            Course::Line => (to.end - start).norm(),
            Course::Arc(arc) => {
                let out = start - arc.centre;
                let radius = out.cross(&arc.axis).norm();
                // What the arc leaves of the way to the end is spread along it.
                let rest = to.end - moving.on_arc(1.0);
                radius * arc.sweep + rest.norm()
            }
        };
        moving.way = way;
        moving.speed = way + turn.map_or(0.0, |(_, angle)| angle) * body.length.hypot(body.radius);
        moving
    }

    /// The start of an arc, turned about its axis.
    fn on_arc(&self, part: f64) -> Point3<f64> {
        let Course::Arc(arc) = self.course else {
            return self.start;
        };
        arc.centre + Rotation3::from_axis_angle(&arc.axis, arc.sweep * part) * (self.start - arc.centre)
    }

    /// Whether the tip moves.
    pub fn has_length(&self) -> bool {
        self.way > 0.0
    }

    /// Length of the way of the tip, m.
    pub fn way(&self) -> f64 {
        self.way
    }

    /// Whether its tool is rounded.
    pub fn has_ball(&self) -> bool {
        self.body.corner > 0.0
    }

    /// Its tool.
    pub fn body(&self) -> Body {
        self.body
    }

    /// Tip and axis at a part of the move.
    pub fn pose(&self, part: f64) -> (Point3<f64>, Vector3<f64>) {
        let tip = match self.course {
            Course::Line => self.start + (self.end - self.start) * part,
            Course::Arc(_) => self.on_arc(part) + (self.end - self.on_arc(1.0)) * part,
        };
        let axis = match self.turn {
            None => self.first_axis.into_inner(),
            Some((about, angle)) => {
                Rotation3::from_axis_angle(&about, angle * part) * self.first_axis.into_inner()
            }
        };
        (tip, axis)
    }

    /// Distance of a point from the tool at a part of the move.
    fn distance(&self, point: &Point3<f64>, part: f64) -> f64 {
        let (tip, axis) = self.pose(part);
        let off = point - tip;
        let h = off.dot(&axis);
        self.body.distance((off - axis * h).norm(), h)
    }

    /// Whether the tool reaches a point between these parts of the move.
    pub fn reaches(&self, point: &Point3<f64>, parts: [f64; 2]) -> bool {
        if self.is_straight() {
            return self.least_on_line(point, parts, 0.0) <= 0.0;
        }
        let mut open = vec![parts];
        while let Some([from, to]) = open.pop() {
            let middle = 0.5 * (from + to);
            let distance = self.distance(point, middle);
            if distance <= 0.0 {
                return true;
            }
            let nearer = self.speed * 0.5 * (to - from);
            if distance <= nearer && nearer > RESOLUTION {
                open.extend([[from, middle], [middle, to]]);
            }
        }
        false
    }

    /// The least distance of a point from the tool on the move if it is less than `least`, m: to a nanometre or two.
    pub fn least_distance(&self, point: &Point3<f64>, mut least: f64) -> f64 {
        if self.is_straight() {
            return least.min(self.least_on_line(point, [0.0, 1.0], f64::NEG_INFINITY));
        }
        let mut open = vec![[0.0, 1.0]];
        while let Some([from, to]) = open.pop() {
            let middle = 0.5 * (from + to);
            let distance = self.distance(point, middle);
            least = least.min(distance);
            let nearer = self.speed * 0.5 * (to - from);
            if distance - nearer < least && nearer > RESOLUTION {
                open.extend([[from, middle], [middle, to]]);
            }
        }
        least
    }

    /// Whether the tool moves along a line without a turn of its axis.
    fn is_straight(&self) -> bool {
        matches!(self.course, Course::Line) && self.turn.is_none()
    }

    /// The least distance on a line, to the resolution; or one that is not above `enough`. The body is convex, so the distance is a convex function of time.
    fn least_on_line(&self, point: &Point3<f64>, [mut from, mut to]: [f64; 2], enough: f64) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let at = |part: f64| self.distance(point, part);
        let mut inner = [to - GOLDEN * (to - from), from + GOLDEN * (to - from)];
        let mut values = inner.map(at);
        let mut least = at(from).min(at(to)).min(values[0]).min(values[1]);
        while least > enough && self.speed * (to - from) > RESOLUTION {
            if values[0] < values[1] {
                to = inner[1];
                inner = [to - GOLDEN * (to - from), inner[0]];
                values = [at(inner[0]), values[0]];
            } else {
                from = inner[0];
                inner = [inner[1], from + GOLDEN * (to - from)];
                values = [values[1], at(inner[1])];
            }
            least = least.min(values[0]).min(values[1]);
            // No point of the tool comes nearer than this.
            if enough.is_finite() && least - self.speed * (to - from) > enough {
                break;
            }
        }
        least
    }

    /// Pieces of the move on which no point of the tool moves by more than twice `most` (m), with the box around the tool on each.
    pub fn boxes(&self, most: f64) -> impl Iterator<Item = ([f64; 2], [Point3<f64>; 2])> {
        let count = (0.5 * self.speed / most).ceil().max(1.0);
        (0..count as usize).map(move |piece| {
            let part = |k: f64| (piece as f64 + k) / count;
            let (tip, axis) = self.pose(part(0.5));
            let top = tip + axis * self.body.length;
            let out = 0.5 * self.speed / count;
            let across = axis.map(|along| self.body.radius * (1.0 - along * along).max(0.0).sqrt() + out);
            (
                [part(0.0), part(1.0)],
                [tip.inf(&top) - across, tip.sup(&top) + across],
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use armill_core::path::{Arc, Pace};

    use super::*;

    const BALL: Body = Body {
        radius: 0.002,
        corner: 0.002,
        length: 0.02,
    };

    fn to(end: [f64; 3], course: Course) -> Move {
        Move {
            end: end.into(),
            axis: None,
            spin: None,
            course,
            pace: Pace::Unknown,
            line: 1,
        }
    }

    #[test]
    fn a_ball_on_a_line_is_as_far_as_its_centre_is_less_its_radius() {
        let up = Vector3::z_axis();
        let next = to([0.01, 0.0, 0.0], Course::Line);
        let moving = MovingTool::new(BALL, Point3::origin(), [up; 2], &next);
        for (point, expected) in [
            ([0.005, 0.003, 0.0], 0.003_f64.hypot(0.002) - 0.002),
            ([-0.001, 0.0, -0.001], 0.001_f64.hypot(0.003) - 0.002),
            ([0.004, 0.0, 0.002], -0.002),
        ] {
            let least = moving.least_distance(&point.into(), f64::INFINITY);
            assert!((least - expected).abs() < 4e-9, "{point:?}: {least}");
            assert_eq!(moving.reaches(&point.into(), [0.0, 1.0]), expected < 0.0);
        }
    }

    #[test]
    fn a_tool_that_turns_about_its_tip_reaches_a_sector() {
        let (up, over) = (
            Vector3::z_axis(),
            Unit::new_normalize(Vector3::new(1.0, 0.0, -1.0)),
        );
        let next = to([0.0; 3], Course::Line);
        let moving = MovingTool::new(BALL, Point3::origin(), [up, over], &next);
        for (point, reached) in [
            ([0.0139, 0.0, 0.0139], true),
            ([0.0143, 0.0, 0.0143], false),
            ([0.0139, 0.00199, 0.0], true),
            ([0.0139, 0.00201, 0.0], false),
            ([-0.003, 0.0, 0.01], false),
        ] {
            assert_eq!(moving.reaches(&point.into(), [0.0, 1.0]), reached, "{point:?}");
        }
    }

    #[test]
    fn a_flat_end_mill_on_an_arc_leaves_its_middle() {
        let body = Body { corner: 0.0, ..BALL };
        let arc = Arc {
            centre: Point3::origin(),
            axis: Vector3::z_axis(),
            sweep: std::f64::consts::TAU,
        };
        let next = to([0.01, 0.0, 0.0], Course::Arc(arc));
        let moving = MovingTool::new(body, Point3::new(0.01, 0.0, 0.0), [Vector3::z_axis(); 2], &next);
        for turn in 0..16 {
            let (sin, cos) = (f64::from(turn) * 0.4).sin_cos();
            for (radius, reached) in [
                (0.00799, false),
                (0.00801, true),
                (0.01199, true),
                (0.01201, false),
            ] {
                let point = Point3::new(radius * cos, radius * sin, 1e-4);
                assert_eq!(moving.reaches(&point, [0.0, 1.0]), reached, "{radius} {turn}");
            }
        }
    }
}
