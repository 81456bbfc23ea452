//! The workpiece: its plane, the split of a deviation on it, and grids of points.
//!
//! On a plane tilted by `alpha` from the vertical about base +y (paper, section 3.7):
//!
//! ```text
//! y' = (0, 1, 0)    z' = (sin alpha, 0, cos alpha)    n = (-cos alpha, 0, sin alpha)
//! ```
//!
//! `alpha = 0`: a vertical plate facing the robot, tool along +x; 90 deg: a horizontal plate facing up, tool
//! pointing down. The part frame is right-handed: x_part = -y', y_part = z', z_part = n, origin at the centre.
//! The tool axis is opposite to the outward normal n. m, rad.

use nalgebra::{Matrix3, Point2, Point3, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::frame::{Isometry, tool_orientation};

/// Tool axes that differ by less (no unit) are equal: rounding in the source of the poses.
const SAME_WAY: f64 = 1e-9;

/// The outward normal of the planes perpendicular to all these tools: opposite to their common axis; base z without
/// tools.
///
/// # Errors
/// The index of the first tool with another axis than the first.
pub fn common_normal(
    base_from_tool: impl IntoIterator<Item = Isometry>,
) -> Result<Unit<Vector3<f64>>, usize> {
    let mut axes = base_from_tool.into_iter().map(|pose| pose * Vector3::z_axis());
    let Some(first) = axes.next() else {
        return Ok(Vector3::z_axis());
    };
    let other = axes.position(|axis| (axis.into_inner() - first.into_inner()).amax() > SAME_WAY);
    other.map_or(Ok(-first), |index| Err(index + 1))
}

/// A plane of the workpiece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Origin at the plane's centre, z its outward normal.
    pub base_from_part: Isometry,
}

impl Plane {
    /// The plane through `centre` (m, base) tilted by `tilt` (rad) from the vertical about base +y.
    pub fn tilted(centre: Point3<f64>, tilt: f64) -> Plane {
        let (sin, cos) = tilt.sin_cos();
        let axes = Matrix3::from_columns(&[
            -Vector3::y(),
            Vector3::new(sin, 0.0, cos),
            Vector3::new(-cos, 0.0, sin),
        ]);
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Plane {
            base_from_part: Isometry::from_parts(centre.coords.into(), rotation),
        }
    }

    /// Outward normal, base basis.
    pub fn normal(&self) -> Unit<Vector3<f64>> {
        Unit::new_unchecked(self.base_from_part * Vector3::z())
    }

    /// Tool axis: opposite to the normal.
    pub fn tool_axis(&self) -> Unit<Vector3<f64>> {
        -self.normal()
    }

    /// The point of base at in-plane coordinates `at` (m, part x and y).
    pub fn at(&self, at: Point2<f64>) -> Point3<f64> {
        self.base_from_part * Point3::new(at.x, at.y, 0.0)
    }

    /// The tool pose at in-plane coordinates `at` (m, part x and y) with `spin` (rad) about the tool axis.
    pub fn base_from_tool(&self, at: Point2<f64>, spin: f64) -> Isometry {
        Isometry::from_parts(
            self.at(at).coords.into(),
            tool_orientation(self.tool_axis(), spin),
        )
    }

    /// A base vector (for example a deviation) in the part frame: in-plane x and y, then along the normal.
    pub fn in_part(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.base_from_part.inverse_transform_vector(vector)
    }
}

/// A deviation split on a plane, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// Length of the whole deviation.
    pub full: f64,
    /// Length of its part in the plane.
    pub in_plane: f64,
    /// Component along the outward normal, signed.
    pub normal: f64,
}

impl Split {
    /// The split of `deviation` (m, base) on a plane with this outward normal.
    pub fn of(deviation: &Vector3<f64>, normal: Unit<Vector3<f64>>) -> Split {
        let along = deviation.dot(&normal);
        let in_plane = (deviation - normal.into_inner() * along).norm();
        Split {
            full: deviation.norm(),
            in_plane,
            normal: along,
        }
    }
}

/// A regular grid of points on a plane, symmetric about its centre; rows along part y, columns along part x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Points along part x.
    pub columns: usize,
    /// Points along part y.
    pub rows: usize,
    /// Pitch, m.
    pub step: f64,
}

impl Grid {
    /// The largest grid of pitch `step` (m) within `half_size` (m, part x and y).
    pub fn within(half_size: [f64; 2], step: f64) -> Grid {
        // A small tolerance, so that 0.4 / 0.1 gives four steps and not three.
        let points = |half: f64| 2 * (half / step + 1e-9).floor() as usize + 1;
        Grid {
            columns: points(half_size[0]),
            rows: points(half_size[1]),
            step,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether it has no point at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Coordinate of column or row `index` of `count`, m.
    pub fn coordinate(&self, index: usize, count: usize) -> f64 {
        (index as f64 - 0.5 * (count as f64 - 1.0)) * self.step
    }

    /// In-plane coordinates (m) of point `index`; points run along part x first.
    pub fn point(&self, index: usize) -> Point2<f64> {
        Point2::new(
            self.coordinate(index % self.columns, self.columns),
            self.coordinate(index / self.columns, self.rows),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn tools_with_one_axis_are_perpendicular_to_one_plane() {
        let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.5), 0.7);
        let poses = |spins: &[f64]| -> Vec<Isometry> {
            spins
                .iter()
                .map(|spin| plane.base_from_tool(Point2::new(*spin, -0.1), *spin))
                .collect()
        };
        let normal = common_normal(poses(&[0.0, 1.0, -2.5])).unwrap();
        assert!((normal.into_inner() - plane.normal().into_inner()).norm() < 1e-15);
        let mut turned = poses(&[0.0, 1.0, 2.0]);
        turned[1] = Plane::tilted(Point3::origin(), 0.7 + 1e-6).base_from_tool(Point2::origin(), 0.0);
        assert_eq!(common_normal(turned), Err(1));
        assert_eq!(common_normal([]), Ok(Vector3::z_axis()));
    }

    #[test]
    fn vertical_plate_faces_the_robot_and_horizontal_plate_faces_up() {
        let centre = Point3::new(1.0, 0.0, 0.8);
        assert!((Plane::tilted(centre, 0.0).normal().into_inner() + Vector3::x()).norm() < 1e-15);
        assert!((Plane::tilted(centre, FRAC_PI_2).normal().into_inner() - Vector3::z()).norm() < 1e-15);
    }

    #[test]
    fn split_agrees_with_equation_11_of_the_paper() {
        // arctan(dz/dx) = beta + 90 deg - alpha; normal = vXZ sin beta (x' = n), z' = vXZ cos beta.
        let alpha: f64 = 0.6;
        let d: Vector3<f64> = Vector3::new(20e-6, -30e-6, 45e-6);
        let beta = d.z.atan2(d.x) - FRAC_PI_2 + alpha;
        let v = d.x.hypot(d.z);
        let split = Split::of(&d, Plane::tilted(Point3::origin(), alpha).normal());
        assert!((split.normal - v * beta.sin()).abs() < 1e-18);
        assert!((split.in_plane - (v * beta.cos()).hypot(d.y)).abs() < 1e-18);
    }

    #[test]
    fn grid_is_symmetric_and_includes_both_edges() {
        let grid = Grid::within([0.4, 0.2], 0.1);
        assert_eq!((grid.columns, grid.rows), (9, 5));
        assert!((grid.point(0) - Point2::new(-0.4, -0.2)).norm() < 1e-15);
        assert!((grid.point(44) - Point2::new(0.4, 0.2)).norm() < 1e-15);
    }

    #[test]
    fn part_frame_is_right_handed_with_z_along_the_normal() {
        let plane = Plane::tilted(Point3::new(0.8, 0.1, 0.7), 0.4);
        let x = plane.base_from_part * Vector3::x();
        let y = plane.base_from_part * Vector3::y();
        assert!((x.cross(&y) - plane.normal().into_inner()).norm() < 1e-15);
        assert!((x + Vector3::y()).norm() < 1e-15);
    }
}
