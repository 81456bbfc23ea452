//! Samples moves: within a tolerance of the arc, and with a maximum distance between points.
//!
//! A chord over the angle `phi` of a circle of radius `r` deviates from it by `r (1 - cos(phi / 2))`; the pieces of a
//! move are equal. The tool axis turns evenly from that of the move before to its own; so does the spin, in the shorter
//! direction. If whole orientations are given, the tool turns evenly about one axis, `R(t) = R_0 exp(t log(R_0^-1
//! R_1))`, as robot controllers do: separate spins would jump where the tool passes the direction without a defined
//! spin zero.

use std::f64::consts::TAU;

use nalgebra::{Point3, Rotation3, Unit, UnitQuaternion, Vector3};

use super::program::{Arc, Course, GivenSpin, Move, Pace};

/// Sampling of moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Largest distance of a chord from its arc, m.
    pub chord_error: f64,
    /// Longest distance between points of a cutting move, m.
    pub step: f64,
}

/// A point of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Position, m.
    pub at: Point3<f64>,
    /// The tool, from the tip towards the spindle, if given in the program.
    pub axis: Option<Unit<Vector3<f64>>>,
    /// Normal of the surface that is cut, out of the part, where the tool leans from it; `None`: the tool axis.
    pub normal: Option<Unit<Vector3<f64>>>,
    /// Turn of the tool about its axis, if given in the program.
    pub spin: Option<GivenSpin>,
    /// Feed direction.
    pub direction: Unit<Vector3<f64>>,
    /// Distance along all cutting moves before, m.
    pub along: f64,
    /// Speed of the move that ends here.
    pub pace: Pace,
    /// Line of the program.
    pub line: u32,
}

/// Samples one move after the other.
#[derive(Clone, Debug)]
pub struct Sampler {
    sampling: Sampling,
    state: Option<ToolState>,
    along: f64,
}

/// State of the tool after the moves so far.
#[derive(Clone, Copy, Debug)]
struct ToolState {
    at: Point3<f64>,
    axis: Option<Unit<Vector3<f64>>>,
    spin: Option<GivenSpin>,
    /// Whether the last move was a cut that ended here: its end is a point already.
    cutting: bool,
}

impl Sampler {
    /// Before the first move.
    pub fn new(sampling: Sampling) -> Sampler {
        Sampler {
            sampling,
            state: None,
            along: 0.0,
        }
    }

    /// Number of points that [`Sampler::points`] would return for `next`; the largest number on overflow.
    pub fn count(&self, next: &Move) -> usize {
        let axis = next.axis.or(self.state.and_then(|state| state.axis));
        let from = self.state.filter(|_| next.pace.cuts());
        from.map_or(0, |from| {
            match MovePath::of(&from, next, axis).pieces(&self.sampling) {
                0 => 0,
                pieces => pieces.saturating_add(usize::from(!from.cutting)),
            }
        })
    }

    /// Calls `out` with the points of the next move: of a cut its start, unless a cut ended there, and then one at the
    /// end of each piece; of a rapid none. The first move of a program sets the position of the tip and has no points.
    pub fn points(&mut self, next: &Move, out: impl FnMut(PathPoint)) {
        let sampling = self.sampling;
        self.cut(next, |way| way.pieces(&sampling), out);
    }

    /// As [`Sampler::points`], with a given number of pieces: for moves whose ends have been changed slightly.
    pub fn points_in(&mut self, next: &Move, pieces: usize, out: impl FnMut(PathPoint)) {
        self.cut(next, |_| pieces, out);
    }

    fn cut(&mut self, next: &Move, pieces: impl Fn(&MovePath) -> usize, mut out: impl FnMut(PathPoint)) {
        let axis = next.axis.or(self.state.and_then(|state| state.axis));
        let spin = next.spin.or(self.state.and_then(|state| state.spin));
        if let Some(from) = self.state.filter(|_| next.pace.cuts()) {
            let way = MovePath::of(&from, next, axis);
            let pieces = if way.length > 0.0 { pieces(&way) } else { 0 };
            if pieces == 0 {
                // A move of zero length: nothing is cut, and there is no direction. If the tool is turned there, the
                // next cut has a separate start point.
                let turned = matches!(spin, Some(GivenSpin::Orientation(_))) && spin != from.spin;
                let cutting = from.cutting && !turned;
                self.state = Some(ToolState {
                    axis,
                    spin,
                    cutting,
                    ..from
                });
                return;
            }
            for piece in usize::from(from.cutting)..=pieces {
                let part = piece as f64 / pieces as f64;
                let spin = spin.map(|spin| spun(from.spin, spin, part));
                out(PathPoint {
                    at: way.at(part),
                    axis: match spin {
                        Some(GivenSpin::Orientation(turned)) => Some(spindle(&turned)),
                        Some(GivenSpin::Angle(_)) | None => way.axis(part),
                    },
                    normal: None,
                    spin,
                    direction: way.direction(part),
                    along: self.along + way.length * part,
                    pace: next.pace,
                    line: next.line,
                });
            }
            self.along += way.length;
        }
        self.state = Some(ToolState {
            at: next.end,
            axis,
            spin,
            cutting: next.pace.cuts() && self.state.is_some(),
        });
    }
}

/// The spin between the one before and `to`, in the shorter direction; `to` everywhere where the two are given in
/// different ways.
fn spun(from: Option<GivenSpin>, to: GivenSpin, part: f64) -> GivenSpin {
    match (from, to) {
        (Some(GivenSpin::Angle(from)), GivenSpin::Angle(to)) => {
            let by = to - from;
            GivenSpin::Angle(to - (by - TAU * (by / TAU).round()) * (1.0 - part))
        }
        (Some(GivenSpin::Orientation(from)), GivenSpin::Orientation(to)) if part < 1.0 && from != to => {
            GivenSpin::Orientation(from.try_slerp(&to, part, f64::MIN_POSITIVE).unwrap_or(to))
        }
        _ => to,
    }
}

/// From the tip towards the spindle, of a tool of this orientation.
fn spindle(path_from_tool: &UnitQuaternion<f64>) -> Unit<Vector3<f64>> {
    -(path_from_tool * Vector3::z_axis())
}

/// One move in detail.
struct MovePath {
    from: Point3<f64>,
    end: Point3<f64>,
    length: f64,
    bend: Option<Bend>,
    axes: Option<Axes>,
}

/// Rotation of the tool from one axis to the next.
struct Axes {
    before: Unit<Vector3<f64>>,
    after: Unit<Vector3<f64>>,
    /// Axis and angle, rad; `None` where both are the same or opposite.
    turn: Option<(Unit<Vector3<f64>>, f64)>,
}

/// The arc of a move; the difference of its end is spread along it.
struct Bend {
    arc: Arc,
    /// From the axis to the start, across the axis, m.
    arm: Vector3<f64>,
    /// Difference between the end of the exact arc and the end of the move: rise of a helix and rounding of the
    /// program, m.
    rest: Vector3<f64>,
}

impl MovePath {
    fn of(from: &ToolState, next: &Move, axis: Option<Unit<Vector3<f64>>>) -> MovePath {
        let chord = next.end - from.at;
        let bend = match next.course {
            Course::Line => None,
            Course::Arc(arc) => {
                let out = from.at - arc.centre;
                let arm = out - arc.axis.into_inner() * out.dot(&arc.axis);
                let turned = Rotation3::from_axis_angle(&arc.axis, arc.sweep) * arm;
                Some(Bend {
                    arc,
                    arm,
                    rest: chord - (turned - arm),
                })
            }
        };
        let length = bend.as_ref().map_or(chord.norm(), |bend| {
            (bend.arm.norm() * bend.arc.sweep).hypot(bend.rest.norm())
        });
        let axes = from.axis.or(axis).zip(axis).map(|(before, after)| {
            let turn = Rotation3::rotation_between(&before, &after).and_then(|turn| turn.axis_angle());
            Axes { before, after, turn }
        });
        MovePath {
            from: from.at,
            end: next.end,
            length,
            bend,
            axes,
        }
    }

    fn pieces(&self, sampling: &Sampling) -> usize {
        // A small tolerance, so that 10 mm by 1 mm gives ten pieces and not eleven.
        let by_step = (self.length / sampling.step - 1e-9).ceil();
        let by_chord = self.bend.as_ref().map_or(0.0, |bend| {
            let cosine = 1.0 - sampling.chord_error / bend.arm.norm();
            // At least four chords per turn, however small the arc.
            let most = (2.0 * cosine.max(-1.0).acos()).min(0.25 * TAU);
            (bend.arc.sweep / most - 1e-9).ceil()
        });
        if self.length > 0.0 {
            by_step.max(by_chord).max(1.0) as usize
        } else {
            0
        }
    }

    fn at(&self, part: f64) -> Point3<f64> {
        if part == 1.0 {
            return self.end;
        }
        match &self.bend {
            None => self.from + (self.end - self.from) * part,
            Some(bend) => {
                let turned = bend.turned(part);
                self.from + (turned - bend.arm) + bend.rest * part
            }
        }
    }

    fn direction(&self, part: f64) -> Unit<Vector3<f64>> {
        let along = match &self.bend {
            None => self.end - self.from,
            Some(bend) => bend.arc.axis.cross(&bend.turned(part)) * bend.arc.sweep + bend.rest,
        };
        Unit::new_normalize(along)
    }

    fn axis(&self, part: f64) -> Option<Unit<Vector3<f64>>> {
        let axes = self.axes.as_ref()?;
        Some(match axes.turn {
            Some((about, angle)) if part < 1.0 => {
                Rotation3::from_axis_angle(&about, angle * part) * axes.before
            }
            None if part < 1.0 => axes.before,
            _ => axes.after,
        })
    }
}

impl Bend {
    fn turned(&self, part: f64) -> Vector3<f64> {
        Rotation3::from_axis_angle(&self.arc.axis, self.arc.sweep * part) * self.arm
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cut(end: [f64; 3], course: Course) -> Move {
        Move {
            end: end.into(),
            axis: None,
            spin: None,
            course,
            pace: Pace::Feed(0.01),
            line: 1,
        }
    }

    fn start(end: [f64; 3]) -> Move {
        Move {
            pace: Pace::Rapid,
            ..cut(end, Course::Line)
        }
    }

    fn points(sampling: Sampling, moves: &[Move]) -> Vec<PathPoint> {
        let (mut sampler, mut points) = (Sampler::new(sampling), Vec::new());
        for next in moves {
            sampler.points(next, |point| points.push(point));
        }
        points
    }

    fn half_turn(end: [f64; 3]) -> Move {
        let arc = Arc {
            centre: Point3::new(0.0, 0.0, 5.0),
            axis: Vector3::z_axis(),
            sweep: TAU / 2.0,
        };
        cut(end, Course::Arc(arc))
    }

    const FINE: Sampling = Sampling {
        chord_error: 1e-6,
        step: 1e-3,
    };

    #[test]
    fn a_line_has_its_start_once_and_points_no_farther_apart_than_the_step() {
        let moves = [
            start([0.0, 0.0, 0.0]),
            cut([0.01, 0.0, 0.0], Course::Line),
            cut([0.01, 0.0045, 0.0], Course::Line),
        ];
        let points = points(FINE, &moves);
        assert_eq!(points.len(), 11 + 5);
        let mut sampler = Sampler::new(FINE);
        let counted = moves.map(|next| {
            let count = sampler.count(&next);
            sampler.points(&next, |_| ());
            count
        });
        assert_eq!(counted, [0, 11, 5]);
        assert!((points[15].along - 0.0145).abs() < 1e-15);
        assert_eq!(points[10].direction, Vector3::x_axis());
        assert_eq!(points[11].direction, Vector3::y_axis());
    }

    #[test]
    fn the_number_of_points_saturates_on_overflow() {
        let moves = [start([0.05, 0.0, 0.0]), half_turn([-0.05, 0.0, 0.01])];
        for (chord_error, step) in [(1e-6, 1e-33), (1e-33, 1.0), (1e-33, f64::MIN_POSITIVE)] {
            let mut sampler = Sampler::new(Sampling { chord_error, step });
            sampler.points(&moves[0], |_| ());
            assert_eq!(sampler.count(&moves[1]), usize::MAX);
        }
    }

    #[test]
    fn chords_are_within_the_chord_error_of_a_helix() {
        for chord_error in [1e-7, 1e-5, 1e-3] {
            let sampling = Sampling {
                chord_error,
                step: 1.0,
            };
            let moves = [start([0.05, 0.0, 0.0]), half_turn([-0.05, 0.0, 0.01])];
            let points = points(sampling, &moves);
            for pair in points.windows(2) {
                let middle = nalgebra::center(&pair[0].at, &pair[1].at);
                assert!(0.05 - middle.xy().coords.norm() < chord_error * (1.0 + 1e-9));
                assert!((pair[1].at.xy().coords.norm() - 0.05).abs() < 1e-15);
            }
            let last = points.last().unwrap();
            assert!((last.along - (TAU / 2.0 * 0.05).hypot(0.01)).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_agree_with_finite_differences() {
        let moves = [start([0.05, 0.0, 0.0]), half_turn([-0.05, 0.0, 0.01])];
        let points = points(FINE, &moves);
        for three in points.windows(3) {
            let secant = (three[2].at - three[0].at).normalize();
            // The secant of a circle is parallel to the tangent in the middle.
            assert!((secant - three[1].direction.into_inner()).norm() < 1e-4);
        }
    }

    #[test]
    fn an_arc_ends_where_the_program_says_even_if_its_radii_differ() {
        let moves = [start([0.05, 0.0, 0.0]), half_turn([-0.05001, 0.0, 0.0])];
        let points = points(FINE, &moves);
        assert_eq!(points.last().unwrap().at, Point3::new(-0.05001, 0.0, 0.0));
        let widest = points.windows(2).map(|p| (p[1].at - p[0].at).norm());
        assert!(widest.fold(0.0, f64::max) < 1.01e-3);
    }

    #[test]
    fn rapids_have_no_points_and_the_cut_after_one_begins_with_its_start() {
        let moves = [
            cut([0.0, 0.0, 0.0], Course::Line),
            start([0.0, 0.0, 0.1]),
            cut([0.001, 0.0, 0.1], Course::Line),
            start([0.2, 0.0, 0.1]),
            cut([0.2, 0.001, 0.1], Course::Line),
        ];
        let points = points(FINE, &moves);
        let xs: Vec<f64> = points.iter().map(|point| point.at.x).collect();
        assert_eq!(xs, [0.0, 0.001, 0.2, 0.2]);
        assert!((points[3].along - 0.002).abs() < 1e-18);
    }

    #[test]
    fn the_tool_turns_evenly_from_one_axis_to_the_next() {
        let tilted = Move {
            axis: Some(Vector3::x_axis()),
            ..cut([0.01, 0.0, 0.0], Course::Line)
        };
        let upright = Move {
            axis: Some(Vector3::z_axis()),
            ..start([0.0, 0.0, 0.0])
        };
        let points = points(FINE, &[upright, tilted]);
        let angles: Vec<f64> = points
            .iter()
            .map(|p| p.axis.unwrap().angle(&Vector3::z_axis()).to_degrees())
            .collect();
        for (i, angle) in angles.iter().enumerate() {
            assert!((angle - 9.0 * i as f64).abs() < 1e-9, "{angles:?}");
        }
    }

    #[test]
    fn a_move_of_zero_length_has_no_points() {
        let moves = [
            start([0.0; 3]),
            cut([0.0; 3], Course::Line),
            cut([0.002, 0.0, 0.0], Course::Line),
        ];
        let points = points(FINE, &moves);
        assert_eq!(points.len(), 3);
        assert!(points.iter().all(|p| p.direction == Vector3::x_axis()));
    }

    #[test]
    fn the_spin_turns_evenly_in_the_shorter_direction_and_stays_where_none_is_given() {
        let spun = |deg: Option<f64>, at: Move| Move {
            spin: deg.map(|deg| GivenSpin::Angle(deg.to_radians())),
            ..at
        };
        let moves = [
            spun(Some(350.0), start([0.0; 3])),
            spun(Some(10.0), cut([4e-3, 0.0, 0.0], Course::Line)),
            spun(None, cut([5e-3, 0.0, 0.0], Course::Line)),
        ];
        let sampling = Sampling {
            chord_error: 1e-5,
            step: 1e-3,
        };
        let given: Vec<f64> = points(sampling, &moves)
            .iter()
            .map(|point| match point.spin {
                Some(GivenSpin::Angle(spin)) => spin.to_degrees(),
                other => panic!("{other:?}"),
            })
            .collect();
        // From 350 deg on to 370 deg, given as 10.
        let expected = [-10.0, -5.0, 0.0, 5.0, 10.0, 10.0];
        assert_eq!(given.len(), expected.len());
        for (given, expected) in given.iter().zip(expected) {
            assert!((given - expected).abs() < 1e-12, "{given} and {expected}");
        }
        let silent = [start([0.0; 3]), cut([4e-3, 0.0, 0.0], Course::Line)];
        assert!(points(sampling, &silent).iter().all(|point| point.spin.is_none()));
    }

    /// The tool in this orientation.
    fn oriented(orientation: UnitQuaternion<f64>, at: Move) -> Move {
        Move {
            axis: Some(spindle(&orientation)),
            spin: Some(GivenSpin::Orientation(orientation)),
            ..at
        }
    }

    #[test]
    fn whole_orientations_turn_evenly_about_one_axis_through_the_direction_without_spin_zero() {
        // The tool swings through base y, where spin zero jumps by half a turn.
        let begin = UnitQuaternion::from_euler_angles(-1.4, 0.0, 0.3);
        let by = Vector3::new(-0.35, 0.1, 0.4);
        let end = begin * UnitQuaternion::from_scaled_axis(by);
        let moves = [
            oriented(begin, start([0.0; 3])),
            oriented(end, cut([0.01, 0.0, 0.0], Course::Line)),
        ];
        // The same orientation given twice is the same at every point, to the bit.
        let still = [moves[0], oriented(begin, cut([0.01, 0.0, 0.0], Course::Line))];
        let mut spins = points(FINE, &still).into_iter().map(|point| point.spin);
        assert!(spins.all(|spin| spin == still[0].spin));
        let points = points(FINE, &moves);
        assert_eq!(points.len(), 11);
        for (index, point) in points.iter().enumerate() {
            let Some(GivenSpin::Orientation(found)) = point.spin else {
                panic!("{point:?}");
            };
            let requested = begin * UnitQuaternion::from_scaled_axis(by * (index as f64 / 10.0));
            // The exponential is another way to the same; both have some rounding.
            assert!((found.inverse() * requested).vector().norm() < 1e-14);
            assert_eq!(point.axis, Some(spindle(&found)));
        }
    }

    #[test]
    fn a_tool_that_turns_in_place_starts_a_new_cut_there() {
        let turned = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
        let moves = [
            oriented(UnitQuaternion::identity(), start([0.0; 3])),
            oriented(UnitQuaternion::identity(), cut([0.01, 0.0, 0.0], Course::Line)),
            oriented(turned, cut([0.01, 0.0, 0.0], Course::Line)),
            oriented(turned, cut([0.01, 0.0, 0.0], Course::Line)),
            oriented(turned, cut([0.02, 0.0, 0.0], Course::Line)),
        ];
        let mut sampler = Sampler::new(FINE);
        let counted: usize = moves
            .iter()
            .map(|next| {
                let count = sampler.count(next);
                sampler.points(next, |_| ());
                count
            })
            .sum();
        let points = points(FINE, &moves);
        assert_eq!((points.len(), counted), (11 + 11, 22));
        assert_eq!(
            (points[10].at, points[10].along),
            (points[11].at, points[11].along)
        );
        assert_eq!(points[11].spin, Some(GivenSpin::Orientation(turned)));
    }

    #[test]
    fn a_slightly_moved_cut_keeps_its_points_if_their_number_is_given() {
        let moves = [start([0.0; 3]), cut([0.01 + 1e-7, 0.0, 0.0], Course::Line)];
        let mut sampler = Sampler::new(FINE);
        let mut points = Vec::new();
        sampler.points_in(&moves[0], 0, |point| points.push(point));
        assert_eq!(sampler.count(&moves[1]), 12);
        sampler.points_in(&moves[1], 10, |point| points.push(point));
        assert_eq!(points.len(), 11);
        assert_eq!(points[10].at, moves[1].end);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn points_are_as_many_as_counted_no_farther_apart_than_the_step_and_ever_farther_along(
            ends in proptest::collection::vec((-0.02..0.02, -0.02..0.02, -0.01..0.01, 0_u8..3), 1..8),
            step in 2e-4..5e-3,
        ) {
            let sampling = Sampling { chord_error: 1e-5, step };
            let mut sampler = Sampler::new(sampling);
            let (mut along, mut at) = (0.0, None::<Point3<f64>>);
            for (x, y, z, kind) in ends {
                let end = [x, y, z];
                let next = match kind {
                    0 => start(end),
                    1 => cut(end, Course::Line),
                    // The difference is spread along the arc, whatever the ends are.
                    _ => cut(end, Course::Arc(Arc {
                        centre: Point3::new(0.03, -0.04, 0.0),
                        axis: Vector3::z_axis(),
                        sweep: 0.8,
                    })),
                };
                let counted = sampler.count(&next);
                let mut points = Vec::new();
                sampler.points(&next, |point| points.push(point));
                prop_assert_eq!(points.len(), counted);
                for point in &points {
                    let by = point.along - along;
                    prop_assert!(by >= 0.0 && by <= step * (1.0 + 1e-6), "{}", by);
                    // A line starts where the move before has ended, and its points have the distances along it.
                    if let Some(before) = at.filter(|_| kind == 1) {
                        prop_assert!(((point.at - before).norm() - by).abs() < 1e-12);
                    }
                    (along, at) = (point.along, Some(point.at));
                }
                if let Some(last) = points.last() {
                    prop_assert_eq!(last.at, next.end);
                    prop_assert!((last.direction.norm() - 1.0).abs() < 1e-12);
                }
                at = Some(next.end);
            }
        }
    }

    #[test]
    fn a_turning_tool_is_half_way_in_the_middle_and_an_opposite_axis_waits() {
        let with = |axis: Vector3<f64>, at: Move| Move {
            axis: Some(Unit::new_normalize(axis)),
            ..at
        };
        let (a, b) = (Vector3::new(0.1, 0.2, 1.0), Vector3::new(-0.4, 0.3, 0.8));
        let coarse = Sampling {
            chord_error: 1e-5,
            step: 5e-3,
        };
        let middle = |to: Vector3<f64>| {
            let moves = [
                with(a, start([0.0; 3])),
                with(to, cut([0.01, 0.0, 0.0], Course::Line)),
            ];
            points(coarse, &moves)[1].axis.unwrap().into_inner()
        };
        let half = (a.normalize() + b.normalize()).normalize();
        assert!((middle(b) - half).norm() < 1e-12);
        // No rotation axis is defined: the direction stays, and ends as given.
        assert!((middle(-a) - a.normalize()).norm() < 1e-12);
    }
}
