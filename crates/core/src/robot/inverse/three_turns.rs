//! Positions of three revolute joints that bring a point to a given point: up to four, by a quartic.
//!
//! Joint 3 moves the point on a circle `f`, joint 1 takes its goal back on a circle `g`; joint 2 turns one into the
//! other if both are equally far along axis 2 and equally far from a point `o2` of it:
//!
//! ```text
//! z2 . (f - o2) = z2 . (g - o2)        |f - o2|^2 = |g - o2|^2
//! ```
//!
//! Both are linear in `u = (1, cos theta3, sin theta3)` and in `x = (cos theta1, sin theta1)`, so `B x = A u`, and
//! `|x| = 1` leaves an equation for joint 3 alone that needs no inverse of `B`:
//!
//! ```text
//! F(theta3) = |adj(B) A u|^2 - det(B)^2 = 0
//! ```
//!
//! It is of fourth degree in `tan((theta3 - tau)/2)`, `tau` chosen so that no root is large. Where axes 1 and 2
//! meet or are parallel, `B` is singular and `F` a square: of a combination of both rows, which has two roots. Joint 1
//! then has two positions for each. Where they nearly meet, the roots of `F` are nearly double, and found as extrema.
//! The result is refined by Newton's iteration on all three joints.
//!
//! Lengths m, angles rad; axes are given at chain zero. Source: D. L. Pieper, "The Kinematics of Manipulators under
//! Computer Control", Stanford 1968; as circles: A. J. Elias, J. T. Wen 2025 (subproblem 5).

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use nalgebra::{Matrix3, Point3, Vector3};

use super::lines::Line;
use super::roots::real_roots;

/// Extrema of `F` this near to zero are roots: a pose a nanometre beyond the stretched arm is still reached.
const TOUCHING: f64 = 1e-8;
/// Determinant of the scaled `B` below which joint 1 is not computed from it.
const SINGULAR: f64 = 1e-2;
/// Determinant of the scaled `B` that is zero but for rounding.
const ROUNDED: f64 = 1e-12;
/// The scaled circle of joint 1 below which the goal is on axis 1, and joint 1 is free.
const ON_AXIS: f64 = 1e-9;
/// Maximum number of steps of Newton's iteration.
const MOST_STEPS: usize = 24;
/// Steps that do not halve the miss before a goal of an exact arm is given up as out of reach: towards a double root
/// they quarter it.
const PATIENCE: usize = 3;
/// Miss (relative to the arm's length) within rounding, and that which is not a solution.
const ROUNDING: f64 = 1e-15;
const MISSED: f64 = 1e-10;
/// Determinant of the scaled Jacobian below which a position of an arm with slack is near the end of a branch:
/// there 10 mm may move a joint by a tenth of a radian. And the distance (rad) to both sides at which other postures
/// are searched.
const END_OF_BRANCH: f64 = 0.02;
const ASIDE: f64 = 0.15;
/// Positions nearer than this (rad) are one.
const SAME: f64 = 1e-7;

/// Three revolute joints and a point that they carry.
#[derive(Clone, Debug)]
pub(super) struct ThreeTurns {
    lines: [Line; 3],
    end: Point3<f64>,
    /// A length of the arm, m.
    length: f64,
}

impl ThreeTurns {
    /// Joints about these axes that carry the point `end`, all at chain zero.
    pub fn new(mut lines: [Line; 3], end: Point3<f64>) -> ThreeTurns {
        // Points of the axes near to each other keep the squares small.
        lines[2] = lines[2].with_point_near(end);
        lines[1] = lines[1].with_point_near(lines[2].point);
        lines[0] = lines[0].with_point_near(lines[1].point);
        let [o1, o2, o3] = lines.map(|line| line.point);
        let length = (o2 - o1).norm() + (o3 - o2).norm() + (end - o3).norm();
        ThreeTurns { lines, end, length }
    }

    /// Whether the point can move in every direction: some of these positions move it in three directions.
    pub fn moves_freely(&self) -> bool {
        let spans = |k: i32| {
            let angle = |prime: f64| (f64::from(k) * prime).sin() * 3.0;
            let columns = self.place(&[angle(1.3), angle(1.7), angle(2.9)]).1;
            columns.determinant().abs() / self.length.powi(3)
        };
        // Some hundredths for common arms; rounding for axes that meet in one point.
        self.length > 0.0 && (1..8).map(spans).fold(0.0, f64::max) > 1e-6
    }

    /// Positions that bring the point to `goal`. A free joint 1 stays at `kept`.
    ///
    /// With `slack` (m) they are starting values for an arm that differs by as much: also of goals that are out of
    /// reach by less, and near the end of a branch to both sides of it, since two postures may be there or none.
    pub fn bring_to(&self, goal: &Point3<f64>, slack: f64, kept: f64) -> Vec<[f64; 3]> {
        let pair = Circles::of(self, goal);
        let touching = TOUCHING + 4.0 * slack / self.length;
        let mut found: Vec<[f64; 3]> = Vec::with_capacity(4);
        for theta3 in pair.third(touching) {
            for theta1 in pair.first(theta3, kept).into_iter().flatten() {
                let mut theta = [theta1, self.second(goal, theta1, theta3), theta3];
                let patience = if slack > 0.0 { MOST_STEPS } else { PATIENCE };
                let missed = self.follow(&mut theta, goal, patience);
                let known = found.iter().any(|other| {
                    other.iter().zip(&theta).all(|(a, b)| {
                        let turns = (a - b) / TAU;
                        (turns - turns.round()).abs() * TAU < SAME
                    })
                });
                if known || missed >= slack.max(MISSED * self.length) {
                    continue;
                }
                found.push(theta);
                if slack > 0.0 {
                    found.extend(self.next_to_end_of_branch(&theta).into_iter().flatten());
                }
            }
        }
        found
    }

    /// Positions to both sides of `theta`, along the direction that hardly moves the point, if it is near the end of a
    /// branch.
    fn next_to_end_of_branch(&self, theta: &[f64; 3]) -> [Option<[f64; 3]>; 2] {
        let columns = self.place(theta).1 / self.length;
        if columns.determinant().abs() > END_OF_BRANCH {
            return [None, None];
        }
        let squares = (columns.transpose() * columns).symmetric_eigen();
        let still = squares.eigenvectors.column(squares.eigenvalues.imin());
        [ASIDE, -ASIDE].map(|aside| Some(std::array::from_fn(|i| theta[i] + aside * still[i])))
    }

    /// Joint 2, for joints 1 and 3.
    fn second(&self, goal: &Point3<f64>, theta1: f64, theta3: f64) -> f64 {
        let axis = &self.lines[1];
        let f = self.lines[2].turned(theta3, &self.end) - axis.point;
        let g = self.lines[0].turned(-theta1, goal) - axis.point;
        let across = axis.axis.cross(&f);
        axis.axis
            .dot(&f.cross(&g))
            .atan2(across.dot(&axis.axis.cross(&g)))
    }

    /// Position of the point, and its velocity by each joint.
    fn place(&self, theta: &[f64; 3]) -> (Point3<f64>, Matrix3<f64>) {
        let mut columns = Matrix3::zeros();
        let mut end = self.end;
        for i in (0..3).rev() {
            let line = &self.lines[i];
            let turn = line.rotation(theta[i]);
            columns.set_column(i, &line.axis.cross(&(end - line.point)));
            columns = turn * columns;
            end = line.point + turn * (end - line.point);
        }
        (end, columns)
    }

    /// Newton's iteration, damped by the squared miss, until `patience` steps did not halve it; gives the miss (m) that
    /// is left.
    fn follow(&self, theta: &mut [f64; 3], goal: &Point3<f64>, patience: usize) -> f64 {
        let miss = |end: &Point3<f64>| (goal - end) / self.length;
        let (end, mut columns) = self.place(theta);
        let mut away = miss(&end);
        let (mut damping, mut idle) = (1e-2, 0);
        for _ in 0..MOST_STEPS {
            if away.norm() < ROUNDING || damping > 1e6 || idle == patience {
                break;
            }
            let j = columns / self.length;
            let lambda = damping * away.norm_squared() + 1e-15;
            let gram = j * j.transpose() + Matrix3::from_diagonal_element(lambda);
            let Some(factor) = gram.cholesky() else { break };
            let step = j.transpose() * factor.solve(&away);
            let trial = [theta[0] + step.x, theta[1] + step.y, theta[2] + step.z];
            let (end, next) = self.place(&trial);
            let left = miss(&end);
            if left.norm() > 0.5 * away.norm() {
                idle += 1;
            }
            if left.norm_squared() < away.norm_squared() {
                (*theta, away, columns) = (trial, left, next);
                damping *= 0.1;
            } else {
                damping = f64::max(damping, 1e-3) * 100.0;
            }
        }
        away.norm() * self.length
    }
}

/// The two equations between joints 1 and 3, scaled: `b x = a u`.
struct Circles {
    a: [Vector3<f64>; 2],
    b: [[f64; 2]; 2],
}

impl Circles {
    fn of(arm: &ThreeTurns, goal: &Point3<f64>) -> Circles {
        let [first, second, third] = &arm.lines;
        let z2 = second.axis;
        // f - o2 = m3 + cos theta3 e3 + sin theta3 s3, and g - o2 = m1 + cos theta1 e1 - sin theta1 s1.
        let circle = |line: &Line, point: &Point3<f64>| {
            let from = point - line.point;
            let along = line.axis * line.axis.dot(&from);
            (
                line.point + along - second.point,
                from - along,
                line.axis.cross(&from),
            )
        };
        let (m3, e3, s3) = circle(third, &arm.end);
        let (m1, e1, s1) = circle(first, goal);
        let squares = m3.norm_squared() + e3.norm_squared() - m1.norm_squared() - e1.norm_squared();
        let length = arm.length;
        let a = [
            Vector3::new(z2.dot(&(m3 - m1)), z2.dot(&e3), z2.dot(&s3)),
            Vector3::new(0.5 * squares, m3.dot(&e3), m3.dot(&s3)) / length,
        ];
        let b = [
            [z2.dot(&e1), -z2.dot(&s1)],
            [m1.dot(&e1) / length, -m1.dot(&s1) / length],
        ];
        Circles {
            a: a.map(|row| row / length),
            b: b.map(|row| row.map(|entry| entry / length)),
        }
    }

    /// Size of `b`.
    fn size(&self) -> f64 {
        self.b
            .iter()
            .flatten()
            .map(|entry| entry * entry)
            .sum::<f64>()
            .sqrt()
    }

    /// Determinant of `b` over the square of its size: half at most.
    fn determinant(&self) -> f64 {
        let [[b11, b12], [b21, b22]] = self.b;
        (b11 * b22 - b12 * b21) / self.size().powi(2)
    }

    /// Positions of joint 3.
    fn third(&self, touching: f64) -> Vec<f64> {
        let size = self.size();
        if size < ON_AXIS {
            let longer = self.a[0].yz().norm() >= self.a[1].yz().norm();
            let row = if longer { self.a[0] } else { self.a[1] };
            return either_turn(row.yz().into(), -row.x).to_vec();
        }
        let [[b11, b12], [b21, b22]] = self.b.map(|row| row.map(|entry| entry / size));
        let [first, second] = self.a;
        let (p, q) = (first * b22 - second * b12, second * b11 - first * b21);
        if self.determinant().abs() < ROUNDED {
            // Both are multiples of the same row.
            let row = if p.norm() > q.norm() { p } else { q };
            let most = row.yz().norm();
            // The root of what F may be off.
            let beyond = row.x.abs() - most > touching.sqrt() * (row.x.abs() + most);
            return if beyond {
                Vec::new()
            } else {
                either_turn(row.yz().into(), -row.x).to_vec()
            };
        }
        let det_squared = (self.determinant() * size).powi(2);
        let at = |row: &Vector3<f64>, [cos, sin]: [f64; 2]| row.x + row.y * cos + row.z * sin;
        let f = |turn: [f64; 2]| at(&p, turn).powi(2) + at(&q, turn).powi(2) - det_squared;
        // Opposite to tau, where the tangent has no value, F is as far from zero as at any of eight points.
        let quarters = |[cos, sin]: [f64; 2]| [[cos, sin], [-sin, cos], [-cos, -sin], [sin, -cos]];
        let [cos, sin] = [[1.0, 0.0], [FRAC_1_SQRT_2; 2]]
            .into_iter()
            .flat_map(quarters)
            .map(|turn| (f(turn).abs(), turn))
            .max_by(|(x, _), (y, _)| x.total_cmp(y))
            .map_or([1.0, 0.0], |(_, [cos, sin])| [-cos, -sin]);
        let tau = sin.atan2(cos);
        // Of each row the parabola in t = tan((theta3 - tau)/2) that it is after multiplying by 1 + t^2.
        let parabola = |row: &Vector3<f64>| {
            let (k1, k2) = (row.y * cos + row.z * sin, row.z * cos - row.y * sin);
            [row.x + k1, 2.0 * k2, row.x - k1]
        };
        let square = |[c, b, a]: [f64; 3]| [c * c, 2.0 * b * c, 2.0 * a * c + b * b, 2.0 * a * b, a * a];
        let (p, q, unit) = (
            square(parabola(&p)),
            square(parabola(&q)),
            square([1.0, 0.0, 1.0]),
        );
        let quartic: [f64; 5] = std::array::from_fn(|i| p[i] + q[i] - det_squared * unit[i]);
        let angle = |t: f64| tau + 2.0 * t.atan();
        real_roots(&quartic, touching).into_iter().map(angle).collect()
    }

    /// Positions of joint 1 for one of joint 3.
    fn first(&self, theta3: f64, kept: f64) -> [Option<f64>; 2] {
        if self.size() < ON_AXIS {
            return [Some(kept), None];
        }
        let (sin, cos) = theta3.sin_cos();
        let right = self.a.map(|row| row.x + row.y * cos + row.z * sin);
        let [[b11, b12], [b21, b22]] = self.b;
        if self.determinant().abs() > SINGULAR {
            let x = (b22 * right[0] - b12 * right[1], b11 * right[1] - b21 * right[0]);
            let sense = self.determinant().signum();
            return [Some((sense * x.1).atan2(sense * x.0)), None];
        }
        // Only one combination of the rows is well conditioned: that of the longer row.
        let longer = usize::from(b11.hypot(b12) < b21.hypot(b22));
        either_turn(self.b[longer], right[longer]).map(Some)
    }
}

/// Both angles with `x cos + y sin = right`; the nearest to it where there is none.
fn either_turn([x, y]: [f64; 2], right: f64) -> [f64; 2] {
    let length = x.hypot(y);
    let middle = y.atan2(x);
    let half = if length > 0.0 {
        (right / length).clamp(-1.0, 1.0).acos()
    } else {
        0.0
    };
    [middle + half, middle - half]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(point: [f64; 3], axis: [f64; 3]) -> Line {
        Line {
            point: point.into(),
            axis: Vector3::from(axis).normalize(),
        }
    }

    fn arms() -> Vec<(&'static str, ThreeTurns)> {
        let z = [0.0, 0.0, 1.0];
        let y = [0.0, 1.0, 0.0];
        let at = |x: f64, h: f64| [x, 0.0, h];
        vec![
            (
                "nothing special",
                ThreeTurns::new(
                    [
                        line([0.0; 3], z),
                        line([0.15, 0.1, 0.4], [0.3, 1.0, 0.2]),
                        line([0.2, -0.1, 1.0], [-0.4, 0.8, 0.5]),
                    ],
                    Point3::new(0.9, 0.2, 1.1),
                ),
            ),
            (
                "axes 1 and 2 meet",
                ThreeTurns::new(
                    [line([0.0; 3], z), line(at(0.0, 0.4), y), line(at(0.0, 1.0), y)],
                    Point3::new(0.7, 0.0, 1.1),
                ),
            ),
            (
                "axes 1 and 2 meet, the rest is askew",
                ThreeTurns::new(
                    [
                        line([0.0; 3], z),
                        line(at(0.0, 0.4), y),
                        line([0.0, 0.1, 1.0], [0.3, 1.0, 0.1]),
                    ],
                    Point3::new(0.7, 0.2, 1.1),
                ),
            ),
            (
                "axes 2 and 3 parallel",
                ThreeTurns::new(
                    [line([0.0; 3], z), line(at(0.2, 0.4), y), line(at(0.2, 1.0), y)],
                    Point3::new(0.7, 0.03, 1.1),
                ),
            ),
            (
                "axes 1 and 2 parallel",
                ThreeTurns::new(
                    [line([0.0; 3], z), line(at(0.5, 0.4), z), line(at(0.9, 0.4), y)],
                    Point3::new(1.2, 0.1, 0.4),
                ),
            ),
            (
                "axes 2 and 3 meet",
                ThreeTurns::new(
                    [
                        line([0.0; 3], z),
                        line(at(0.3, 0.4), y),
                        line(at(0.3, 0.4), [1.0, 0.0, 0.2]),
                    ],
                    Point3::new(0.8, 0.3, 0.4),
                ),
            ),
        ]
    }

    #[test]
    fn the_positions_of_a_goal_are_among_those_found() {
        for (name, arm) in arms() {
            assert!(arm.moves_freely(), "{name}");
            let (mut most, mut returned) = (0, 0);
            for k in 1..=2000 {
                let angle = |step: f64| 3.1 * (2.0 * (f64::from(k) * step).fract() - 1.0);
                let theta = [angle(0.819_173), angle(0.671_044), angle(0.549_700)];
                let (goal, columns) = arm.place(&theta);
                let found = arm.bring_to(&goal, 0.0, 0.0);
                for other in &found {
                    let away = (arm.place(other).0 - goal).norm();
                    assert!(away < 2e-10, "{name}: {away}");
                }
                most = most.max(found.len());
                let same = |other: &[f64; 3]| {
                    let away = other.iter().zip(theta).map(|(a, b)| (0.5 * (a - b)).sin().abs());
                    away.fold(0.0, f64::max) < 1e-6
                };
                let folded = columns.determinant().abs() < 1e-4;
                assert!(folded || found.iter().any(same), "{name}: {theta:?} {found:?}");
                returned += usize::from(found.iter().any(same));
            }
            assert!(returned >= 1980, "{name}: {returned}");
            assert_eq!(most, 4, "{name}");
        }
    }

    #[test]
    fn a_stretched_arm_is_solved_and_a_goal_beyond_it_is_not() {
        let (_, arm) = arms().remove(1);
        // Elbow at (0, 1.0), end at (0.7, 1.1): 0.6 m and sqrt(0.5) m from the shoulder at 0.4 m height.
        let reach = 0.6 + 0.5_f64.sqrt();
        let direction = Vector3::new(0.6, 0.48, 0.64);
        let shoulder = Point3::new(0.0, 0.0, 0.4);
        let at = |distance: f64| arm.bring_to(&(shoulder + direction * distance), 0.0, 0.0);
        for short in [0.0, 1e-16, 1e-12] {
            assert!(
                !at(reach - short).is_empty() && !at(reach + short).is_empty(),
                "{short}"
            );
        }
        assert!(at(reach + 1e-6).is_empty());
        let beyond = shoulder + direction * (reach + 1e-2);
        assert!(!arm.bring_to(&beyond, 0.02, 0.0).is_empty());
    }

    #[test]
    fn a_goal_on_axis_1_does_not_move_joint_1() {
        let (_, arm) = arms().remove(1);
        let found = arm.bring_to(&Point3::new(0.0, 0.0, 1.2), 0.0, 0.7);
        assert!(
            found.len() >= 2 && found.iter().all(|theta| (theta[0] - 0.7).abs() < 1e-12),
            "{found:?}"
        );
    }

    #[test]
    fn axes_that_nearly_meet_have_the_positions_of_those_that_meet() {
        for apart in [1e-14, 1e-13, 1e-12, 1e-11, 1e-9, 1e-7] {
            let (y, z) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
            let axes = [
                line([0.0; 3], z),
                line([apart, 0.0, 0.4], y),
                line([0.1, 0.0, 1.0], y),
            ];
            let arm = ThreeTurns::new(axes, Point3::new(0.7, 0.05, 1.1));
            for k in 1..=200 {
                let theta = [0.7, 1.9, 3.1].map(|step| 3.0 * (f64::from(k) * step).sin());
                let (goal, columns) = arm.place(&theta);
                let folded = columns.determinant().abs() < 1e-3;
                let same =
                    |other: &[f64; 3]| (0..3).all(|i| (0.5 * (other[i] - theta[i])).sin().abs() < 1e-6);
                assert!(
                    folded || arm.bring_to(&goal, 0.0, 0.0).iter().any(same),
                    "{apart} {theta:?}"
                );
            }
        }
    }

    #[test]
    fn axes_through_one_point_do_not_move_freely() {
        let through = |axis| line([0.0, 0.0, 0.4], axis);
        let lines = [
            through([0.0, 0.0, 1.0]),
            through([0.0, 1.0, 0.0]),
            through([1.0, 0.2, 0.0]),
        ];
        assert!(!ThreeTurns::new(lines, Point3::new(0.5, 0.0, 0.7)).moves_freely());
    }
}
