//! Lines and turns: what closed forms read off a chain, and the angles they carry.
//!
//! An axis is a line: a point on it (m) and its unit direction, both told at chain zero in base.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Unit, Vector3};

use super::super::chain::{Chain, Motion};

/// How far (rad, m) a geometry may stray from the ideal and still be solved in closed form.
pub(super) const IDEAL: f64 = 1e-9;

/// The axis of a turning joint at chain zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Any point on it, m.
    pub point: Point3<f64>,
    /// Its unit direction, by the right hand of the chain position.
    pub axis: Vector3<f64>,
}

impl Line {
    /// The same line told by its point nearest to `other`.
    pub fn told_near(self, other: Point3<f64>) -> Line {
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

/// The axes of a chain of `N` turning joints; `None` for any other.
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

/// An arm whose axis 2 is perpendicular to axis 1: x to the front, y along axis 2, z along axis 1 and up; origin on axis 1
/// at the height of axis 2.
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

/// `value` if it is more than rounding.
pub(super) fn up_to_noise(value: f64) -> Option<f64> {
    (value.abs() > IDEAL).then_some(value)
}

/// An angle as its cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub cos: f64,
    pub sin: f64,
}

impl Turn {
    pub const ZERO: Turn = Turn { cos: 1.0, sin: 0.0 };

    /// The angle of the vector (`x`, `y`); zero where it has no length.
    pub fn new(x: f64, y: f64) -> Turn {
        let length = (x * x + y * y).sqrt();
        if length > 0.0 {
            Turn {
                cos: x / length,
                sin: y / length,
            }
        } else {
            Turn::ZERO
        }
    }

    /// The angle `angle`, rad.
    pub fn by(angle: f64) -> Turn {
        let (sin, cos) = angle.sin_cos();
        Turn { cos, sin }
    }

    pub fn angle(self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// This angle minus another.
    pub fn less(self, other: Turn) -> Turn {
        Turn {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        }
    }

    /// A vector turned about z by less this angle.
    pub fn back_about_z(self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * v.x + self.sin * v.y,
            self.cos * v.y - self.sin * v.x,
            v.z,
        )
    }

    /// A vector turned about y by less this angle.
    pub fn back_about_y(self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * v.x - self.sin * v.z,
            v.y,
            self.sin * v.x + self.cos * v.z,
        )
    }

    /// A vector turned about y by this angle.
    pub fn about_y(self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.cos * v.x + self.sin * v.z,
            v.y,
            self.cos * v.z - self.sin * v.x,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skew_lines_are_nearest_where_their_common_normal_stands() {
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
}
