//! Lines and rotations: the input of the closed forms, and angles as cosine and sine.
//!
//! An axis is a line: a point on it (m) and its unit direction, both at chain zero in base.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Unit, Vector3};

use super::super::chain::{Chain, Motion};
use crate::numbers::Real;

/// Greatest deviation (rad, m) of a geometry from the ideal that is still solved in closed form.
pub(super) const IDEAL: f64 = 1e-9;

/// The largest deviations of axes from those of an ideal arm.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisDeviation {
    /// rad
    angle: f64,
    /// m
    distance: f64,
}

/// Axes of an arm that may deviate in the same sense.
const IN_ONE_SENSE: f64 = 4.0;

impl AxisDeviation {
    /// The largest of these sines of angles and distances (m).
    pub fn of<const A: usize, const D: usize>(sines: [f64; A], distances: [f64; D]) -> AxisDeviation {
        AxisDeviation {
            angle: sines.into_iter().fold(0.0, f64::max),
            distance: distances.into_iter().fold(0.0, f64::max),
        }
    }

    /// The larger of both, compared by number.
    pub fn largest(self) -> f64 {
        self.angle.max(self.distance)
    }

    /// How far (m) an arm of this length (m) may reach beyond the ideal one; more than zero.
    pub fn slack(self, length: f64) -> f64 {
        IN_ONE_SENSE * (self.distance + self.angle * length).max(IDEAL)
    }
}

/// The axis of a revolute joint at chain zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Any point on it, m.
    pub point: Point3<f64>,
    /// Its unit direction, by the right hand of the chain position.
    pub axis: Vector3<f64>,
}

impl Line {
    /// The same line, with its point nearest to `other`.
    pub fn with_point_near(self, other: Point3<f64>) -> Line {
        Line {
            point: self.point + self.axis * (other - self.point).dot(&self.axis),
            axis: self.axis,
        }
    }

    /// Distance of a point from this line, m.
    pub fn distance(&self, point: Point3<f64>) -> f64 {
        (point - self.point).cross(&self.axis).norm()
    }

    /// The point of this line nearest to `other`; `None` where they are parallel within 3e-5 rad.
    pub fn nearest_to(&self, other: &Line) -> Option<Point3<f64>> {
        let normal = self.axis.cross(&other.axis);
        let n2 = normal.norm_squared();
        if n2 < IDEAL {
            return None;
        }
        let between = other.point - self.point;
        Some(self.point + self.axis * (between.cross(&other.axis).dot(&normal) / n2))
    }

    /// A turn by `angle` (rad) about the direction of this line.
    pub fn rotation(&self, angle: f64) -> Rotation3<f64> {
        Rotation3::from_axis_angle(&Unit::new_unchecked(self.axis), angle)
    }

    /// A point after a turn by `angle` (rad) about this line.
    pub fn turned(&self, angle: f64, point: &Point3<f64>) -> Point3<f64> {
        self.point + self.rotation(angle) * (point - self.point)
    }

    /// Another line after a turn by `angle` (rad) about this one.
    pub fn carried(&self, angle: f64, other: &Line) -> Line {
        Line {
            point: self.turned(angle, &other.point),
            axis: self.rotation(angle) * other.axis,
        }
    }
}

/// The axes of a chain of `N` revolute joints; `None` for any other.
pub(super) fn lines_at_zero<const N: usize>(chain: &Chain) -> Option<[Line; N]> {
    let (mut axes, mut origin) = (Matrix3::identity(), Vector3::zeros());
    let mut lines = Vec::with_capacity(N);
    for link in chain.links() {
        link.before.advance(&mut axes, &mut origin);
        match link.motion {
            Motion::About(axis, _) => lines.push(Line {
                point: origin.into(),
                axis: axes.column(axis.index()).into_owned(),
            }),
            Motion::Along(..) => return None,
        }
    }
    lines.try_into().ok()
}

/// An arm whose axis 2 is perpendicular to axis 1: x to the front, y along axis 2, z along axis 1 and up; origin on
/// axis 1 at the height of axis 2.
pub(super) fn base_from_arm(lines: &[Line; 6], wrist: Point3<f64>) -> IsometryMatrix3<f64> {
    let (z1, z2) = (lines[0].axis, lines[1].axis);
    let up = z1 * sense_of(z1.z);
    let centre = lines[0].point + up * (lines[1].point - lines[0].point).dot(&up);
    // The front is where base x points; if it points along axis 2, where the wrist is.
    let forwards = z2.cross(&up);
    let front = up_to_noise(forwards.x).or_else(|| up_to_noise((wrist - centre).dot(&forwards)));
    let y = z2 * sense_of(front.unwrap_or(1.0));
    let axes = Matrix3::from_columns(&[y.cross(&up), y, up]);
    IsometryMatrix3::from_parts(centre.into(), Rotation3::from_matrix_unchecked(axes))
}

/// `axis` without its part along the unit vector `other`, of unit length.
pub(super) fn across(axis: Vector3<f64>, other: &Vector3<f64>) -> Vector3<f64> {
    (axis - other * axis.dot(other)).normalize()
}

/// 1 for values that are not negative, otherwise -1.
pub(super) fn sense_of(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

/// `value` if it is above rounding.
pub(super) fn up_to_noise(value: f64) -> Option<f64> {
    (value.abs() > IDEAL).then_some(value)
}

/// An angle as its cosine and sine; a number, or one lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn<R = f64> {
    pub cos: R,
    pub sin: R,
}

impl Turn {
    pub const ZERO: Turn = Turn { cos: 1.0, sin: 0.0 };

    /// The angle `angle`, rad.
    pub fn by(angle: f64) -> Turn {
        let (sin, cos) = angle.sin_cos();
        Turn { cos, sin }
    }

    pub fn angle(self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// A vector turned about z by less this angle.
    pub fn back_about_z(self, v: Vector3<f64>) -> Vector3<f64> {
        let (x, y) = self.back(v.x, v.y);
        Vector3::new(x, y, v.z)
    }

    /// A vector turned about y by less this angle.
    pub fn back_about_y(self, v: Vector3<f64>) -> Vector3<f64> {
        let (z, x) = self.back(v.z, v.x);
        Vector3::new(x, v.y, z)
    }

    /// A vector turned about y by this angle.
    pub fn about_y(self, v: Vector3<f64>) -> Vector3<f64> {
        let forth = Turn {
            sin: -self.sin,
            ..self
        };
        forth.back_about_y(v)
    }
}

impl<R: Real> Turn<R> {
    /// The angle of the vector (`x`, `y`); zero where it has no length.
    #[inline(always)]
    pub fn new(x: R, y: R) -> Self {
        let length = x.mul_add(x, y * y).sqrt();
        let has_length = length > R::of(0.0);
        Turn {
            cos: R::either(has_length, x / length, R::of(1.0)),
            sin: R::either(has_length, y / length, R::of(0.0)),
        }
    }

    /// The same in every lane.
    #[inline(always)]
    pub fn of(turn: Turn) -> Self {
        Turn {
            cos: R::of(turn.cos),
            sin: R::of(turn.sin),
        }
    }

    /// This angle minus another.
    #[inline(always)]
    pub fn less(self, other: Self) -> Self {
        let (cos, sin) = other.back(self.cos, self.sin);
        Turn { cos, sin }
    }

    /// The plane vector (`x`, `y`) turned by less this angle.
    #[inline(always)]
    pub fn back(self, x: R, y: R) -> (R, R) {
        (
            self.cos.mul_add(x, self.sin * y),
            self.cos.mul_add(y, -(self.sin * x)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skew_lines_are_nearest_at_their_common_normal() {
        let along_x = Line {
            point: Point3::new(-4.0, 0.0, 0.0),
            axis: Vector3::x(),
        };
        let along_y = Line {
            point: Point3::new(2.0, 7.0, 0.5),
            axis: Vector3::y(),
        };
        let nearest = along_x.nearest_to(&along_y).unwrap();
        assert!((nearest - Point3::new(2.0, 0.0, 0.0)).norm() < 1e-15);
        assert_eq!(along_y.distance(nearest), 0.5);
        assert!(along_x.nearest_to(&along_x).is_none());
    }

    #[test]
    fn turning_back_undoes_turning() {
        let (turn, v) = (Turn::by(0.7), Vector3::new(0.3, -0.2, 0.9));
        assert!((turn.back_about_y(turn.about_y(v)) - v).norm() < 1e-15);
        let quarter = Turn::by(std::f64::consts::FRAC_PI_2);
        assert!((quarter.back_about_z(Vector3::y()) - Vector3::x()).norm() < 1e-15);
        assert!((quarter.less(turn).angle() + turn.angle() - quarter.angle()).abs() < 1e-15);
    }

    /// Lines of an arm that hangs from a tilted beam.
    fn lines() -> [Line; 6] {
        lines_at_zero(crate::arms::hung().chain()).unwrap()
    }

    #[test]
    fn points_on_a_line_are_not_moved_by_its_rotation() {
        for line in lines() {
            let on = line.point + line.axis * 0.7;
            assert!((line.turned(1.3, &on) - on).norm() < 1e-15);
            let point = Point3::new(0.3, 2.0, -0.4);
            assert!((line.distance(line.turned(1.3, &point)) - line.distance(point)).abs() < 1e-14);
            assert!((line.turned(-1.3, &line.turned(1.3, &point)) - point).norm() < 1e-14);
        }
    }

    #[test]
    fn a_line_with_another_point_is_the_same_line() {
        let other = Point3::new(0.3, 2.0, -0.4);
        for line in lines() {
            let given = line.with_point_near(other);
            assert!(line.distance(given.point) < 1e-14 && given.axis == line.axis);
            // No point of the line is nearer.
            assert!(((other - given.point).norm() - line.distance(other)).abs() < 1e-14);
        }
    }

    #[test]
    fn a_carried_line_keeps_its_angle_and_distance_to_the_axis() {
        let [a, b, ..] = lines();
        let there = a.carried(0.9, &b);
        assert!((there.axis.dot(&a.axis) - b.axis.dot(&a.axis)).abs() < 1e-15);
        assert!((a.distance(there.point) - a.distance(b.point)).abs() < 1e-14);
        let back = a.carried(-0.9, &there);
        assert!((back.axis - b.axis).norm() < 1e-15 && (back.point - b.point).norm() < 1e-15);
    }

    #[test]
    fn the_arm_frame_is_on_axis_1_at_the_height_of_axis_2_with_y_along_it() {
        let lines = lines();
        let wrist = lines[3].nearest_to(&lines[4]).unwrap();
        let frame = base_from_arm(&lines, wrist);
        let m = frame.rotation.matrix();
        assert!((m * m.transpose() - Matrix3::identity()).norm() < 1e-14 && m.determinant() > 0.0);
        let (y, up) = (m.column(1), m.column(2));
        assert!(y.cross(&lines[1].axis).norm() < 1e-14 && up.cross(&lines[0].axis).norm() < 1e-14);
        assert!(up.z > 0.0);
        let origin = Point3::from(frame.translation.vector);
        assert!(lines[0].distance(origin) < 1e-14);
        assert!((lines[1].point - origin).dot(&up).abs() < 1e-14);
    }

    #[test]
    fn a_chain_with_prismatic_joints_or_another_number_has_no_such_lines() {
        let railed = crate::arms::other::on_rail(&crate::arms::mh12());
        assert!(lines_at_zero::<7>(railed.chain()).is_none());
        assert!(lines_at_zero::<6>(crate::arms::other::iiwa14().chain()).is_none());
        assert!(lines_at_zero::<7>(crate::arms::other::iiwa14().chain()).is_some());
    }

    #[test]
    fn small_values_are_none_and_zero_has_a_sense() {
        assert_eq!(
            (up_to_noise(0.9 * IDEAL), up_to_noise(-1.1 * IDEAL)),
            (None, Some(-1.1 * IDEAL))
        );
        assert_eq!((sense_of(0.0), sense_of(-1e-300)), (1.0, -1.0));
        let zero = Turn::new(0.0, 0.0);
        assert_eq!((zero.cos, zero.sin), (1.0, 0.0));
        assert!((across(Vector3::new(1.0, 5.0, 0.0), &Vector3::y()) - Vector3::x()).norm() < 1e-15);
    }
}
