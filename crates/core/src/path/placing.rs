//! Position of a path in the cell, and turn of the tool on it.
//!
//! | frame | origin and axes |
//! |---|---|
//! | `path` | the zero of the program |
//! | `feed` | TCP; x in the feed direction (across the tool), z from the tip towards the spindle, y to the left |
//!
//! The tool's z has the opposite direction, from the spindle to the tip. Where the tip moves along the tool axis (a
//! plunge), x of the feed frame is x of the tool.

use nalgebra::{Isometry3, Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

use super::program::GivenSpin;
use super::sampler::PathPoint;
use crate::frame::{Isometry, tool_orientation};
use crate::load::Advance;
use crate::workpiece::Plane;

/// How the tool is turned about its own axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spin {
    /// By this angle (rad) from the orientation of [`tool_orientation`].
    Fixed(f64),
    /// By this angle (rad) from x of the tool along the feed.
    AlongFeed(f64),
    /// As given in the program at each point, plus this angle (rad): from [`tool_orientation`], or from the whole
    /// orientation if given; by this angle alone where the program gives no spin.
    Given(f64),
}

impl Spin {
    /// The constant part, rad: it turns the tool about its axis at all points alike.
    pub fn angle(self) -> f64 {
        match self {
            Spin::Fixed(angle) | Spin::AlongFeed(angle) | Spin::Given(angle) => angle,
        }
    }
}

/// A path in the cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Base to path.
    pub base_from_path: Isometry,
    /// Tool direction where the program gives none: from the tip towards the spindle, path axes.
    pub axis: Unit<Vector3<f64>>,
    /// Whether the tool keeps the direction `axis` for the whole program.
    pub keeps_axis: bool,
    /// How the tool is turned.
    pub spin: Spin,
}

/// Below this sine of the angle between feed and tool the move is a plunge.
const PLUNGE: f64 = 1e-6;

impl Placing {
    /// A path on `plane`: path axes are those of the part, the tool is against the plane's normal, without spin.
    pub fn on_plane(plane: &Plane) -> Placing {
        Placing {
            base_from_path: plane.base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: true,
            spin: Spin::Fixed(0.0),
        }
    }

    /// The tool at `point`, from the tip towards the spindle, base.
    pub fn spindle(&self, point: &PathPoint) -> Unit<Vector3<f64>> {
        self.base_from_path.rotation * self.path_spindle(point)
    }

    /// The same, path.
    pub fn path_spindle(&self, point: &PathPoint) -> Unit<Vector3<f64>> {
        point.axis.filter(|_| !self.keeps_axis).unwrap_or(self.axis)
    }

    /// Outward normal of the surface that is cut at `point`, base: the tool axis, unless the tool leans from it.
    pub fn normal(&self, point: &PathPoint) -> Unit<Vector3<f64>> {
        self.base_from_path.rotation * point.normal.unwrap_or_else(|| self.path_spindle(point))
    }

    /// The tool pose at `point`.
    pub fn base_from_tool(&self, point: &PathPoint) -> Isometry {
        let axis = -self.spindle(point);
        let rotation = match self.spin {
            Spin::Fixed(angle) => tool_orientation(axis, angle),
            Spin::Given(angle) => match point.spin {
                Some(GivenSpin::Orientation(reported)) => self.oriented(&reported, axis, angle),
                Some(GivenSpin::Angle(reported)) => tool_orientation(axis, angle + reported),
                None => tool_orientation(axis, angle),
            },
            Spin::AlongFeed(angle) => {
                let tool = axis.into_inner();
                let x = self
                    .across(point, &self.spindle(point))
                    .unwrap_or_else(|| self.unspun_x(point));
                let axes = Matrix3::from_columns(&[x, tool.cross(&x), tool]);
                let along = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
                UnitQuaternion::from_axis_angle(&axis, angle) * along
            }
        };
        let tip = self.base_from_path * point.at;
        Isometry3::from_parts(tip.coords.into(), rotation)
    }

    /// The orientation `path_from_tool` in base, turned about the tool by `angle`; by the shortest rotation where the
    /// tool keeps another direction than given.
    fn oriented(
        &self,
        path_from_tool: &UnitQuaternion<f64>,
        axis: Unit<Vector3<f64>>,
        angle: f64,
    ) -> UnitQuaternion<f64> {
        let reported = self.base_from_path.rotation * path_from_tool;
        let kept = match self.keeps_axis {
            false => Some(reported),
            true => UnitQuaternion::rotation_between(&(reported * Vector3::z()), &axis)
                .map(|over| over * reported),
        };
        let about_axis = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        kept.map_or_else(|| tool_orientation(axis, angle), |kept| kept * about_axis)
    }

    /// Axes of the feed frame at `point`, in base.
    pub fn base_from_feed(&self, point: &PathPoint) -> Rotation3<f64> {
        self.along_feed(point, self.spindle(point))
    }

    /// Axes of the surface that is cut at `point`, in base: those of the feed frame, unless the tool leans from the normal
    /// of the surface; then z is this normal.
    pub fn base_from_surface(&self, point: &PathPoint) -> Rotation3<f64> {
        self.along_feed(point, self.normal(point))
    }

    /// Axes with this z, base, and x along the feed.
    fn along_feed(&self, point: &PathPoint, z: Unit<Vector3<f64>>) -> Rotation3<f64> {
        let x = self
            .across(point, &z)
            .unwrap_or_else(|| self.base_from_tool(point) * Vector3::x());
        Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z.into_inner()]))
    }

    /// Advance of the tool at `point`: across its axis, on a ramp, along it.
    pub fn advance(&self, point: &PathPoint) -> Advance {
        Advance::of(
            &(self.base_from_path.rotation * point.direction),
            &self.spindle(point),
        )
    }

    /// Where the tip goes across the direction `z`, base; `None` along it.
    fn across(&self, point: &PathPoint, z: &Unit<Vector3<f64>>) -> Option<Vector3<f64>> {
        across(&(self.base_from_path.rotation * point.direction), z)
    }

    fn unspun_x(&self, point: &PathPoint) -> Vector3<f64> {
        tool_orientation(-self.spindle(point), 0.0) * Vector3::x()
    }
}

/// The part of `feed` across `z`, of length 1; `None` along it.
pub(super) fn across(feed: &Unit<Vector3<f64>>, z: &Unit<Vector3<f64>>) -> Option<Vector3<f64>> {
    let feed = feed.into_inner();
    (feed - z.into_inner() * feed.dot(z)).try_normalize(PLUNGE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::from_xyz_and_fixed_angles;
    use crate::path::Pace;
    use nalgebra::Point3;

    fn point(direction: Vector3<f64>, axis: Option<Vector3<f64>>) -> PathPoint {
        PathPoint {
            at: Point3::new(0.1, 0.2, 0.3),
            axis: axis.map(Unit::new_normalize),
            normal: None,
            spin: None,
            direction: Unit::new_normalize(direction),
            along: 0.0,
            pace: Pace::Feed(0.01),
            line: 1,
        }
    }

    fn placing(spin: Spin) -> Placing {
        Placing {
            base_from_path: from_xyz_and_fixed_angles(
                Vector3::new(1.0, -0.2, 0.5),
                Vector3::new(0.3, -0.8, 2.0),
            ),
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin,
        }
    }

    #[test]
    fn a_path_on_a_plane_has_the_tool_poses_of_the_plane() {
        let plane = Plane::tilted(Point3::new(0.9, -0.3, 0.7), 0.6);
        let point = point(Vector3::x(), None);
        let point = PathPoint {
            at: Point3::new(0.1, 0.2, 0.0),
            ..point
        };
        let of_plane = plane.base_from_tool(point.at.xy(), 0.0);
        assert_eq!(Placing::on_plane(&plane).base_from_tool(&point), of_plane);
    }

    #[test]
    fn the_tool_points_against_the_axis_given_in_the_program() {
        let tilted = Vector3::new(0.2, 0.1, 1.0);
        for spin in [Spin::Fixed(0.4), Spin::AlongFeed(-1.0)] {
            let placing = placing(spin);
            let pose = placing.base_from_tool(&point(Vector3::x(), Some(tilted)));
            let reported = placing.base_from_path * tilted.normalize();
            assert!((pose * Vector3::z() + reported).norm() < 1e-14);
            assert!(
                (pose.translation.vector - (placing.base_from_path * Point3::new(0.1, 0.2, 0.3)).coords)
                    .norm()
                    < 1e-15
            );
            let upright = Placing {
                keeps_axis: true,
                ..placing
            };
            let pose = upright.base_from_tool(&point(Vector3::x(), Some(tilted)));
            assert!((pose * Vector3::z() + placing.base_from_path * Vector3::z()).norm() < 1e-14);
        }
    }

    #[test]
    fn along_the_feed_x_of_the_tool_goes_where_the_tip_goes() {
        let placing = placing(Spin::AlongFeed(0.0));
        // Ramping down: the feed leaves the plane across the tool.
        let point = point(Vector3::new(0.6, 0.8, -0.5), None);
        let x = placing.base_from_tool(&point) * Vector3::x();
        assert!((x - placing.base_from_path * Vector3::new(0.6, 0.8, 0.0)).norm() < 1e-14);
    }

    #[test]
    fn the_feed_frame_is_right_handed_with_y_to_the_left() {
        let placing = placing(Spin::Fixed(0.7));
        let axes = placing.base_from_feed(&point(Vector3::x(), None));
        assert!((axes.matrix().determinant() - 1.0).abs() < 1e-14);
        // Seen from the spindle, left of x is y of the path.
        assert!((axes * Vector3::y() - placing.base_from_path * Vector3::y()).norm() < 1e-14);
    }

    #[test]
    fn a_plunge_takes_x_from_the_tool() {
        for spin in [Spin::Fixed(0.7), Spin::AlongFeed(0.7)] {
            let placing = placing(spin);
            let point = point(-Vector3::z(), None);
            let (axes, pose) = (placing.base_from_feed(&point), placing.base_from_tool(&point));
            assert!((axes * Vector3::x() - pose * Vector3::x()).norm() < 1e-14);
        }
    }

    #[test]
    fn a_whole_orientation_is_that_of_the_tool_in_the_cell() {
        let reported = UnitQuaternion::from_euler_angles(2.0, -0.4, 1.0);
        let axis = -(reported * Vector3::z());
        let point = PathPoint {
            spin: Some(GivenSpin::Orientation(reported)),
            ..point(Vector3::x(), Some(axis))
        };
        let given = placing(Spin::Given(0.0));
        let apart =
            |one: UnitQuaternion<f64>, other: UnitQuaternion<f64>| (one.inverse() * other).vector().norm();
        let pose = given.base_from_tool(&point);
        assert!(apart(pose.rotation, given.base_from_path.rotation * reported) < 1e-15);
        assert!((pose * Vector3::z() + given.spindle(&point).into_inner()).norm() < 1e-14);
        let more = placing(Spin::Given(0.7)).base_from_tool(&point);
        let turned = pose.rotation * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.7);
        assert!(apart(more.rotation, turned) < 1e-14);
        // With a fixed direction it gets there by the shortest rotation: by the angle between the axes, and no more.
        let upright = Placing {
            keeps_axis: true,
            ..given
        };
        let kept = upright.base_from_tool(&point);
        assert!((kept * Vector3::z() + upright.spindle(&point).into_inner()).norm() < 1e-14);
        let angle = kept.rotation.angle_to(&pose.rotation);
        assert!((angle - axis.angle(&Vector3::z())).abs() < 1e-12);
    }

    #[test]
    fn a_given_spin_is_added_to_the_fixed_one() {
        let reported = PathPoint {
            spin: Some(GivenSpin::Angle(0.3)),
            ..point(Vector3::x(), Some(Vector3::new(0.2, 0.1, 1.0)))
        };
        let given = placing(Spin::Given(0.4)).base_from_tool(&reported);
        let fixed = placing(Spin::Fixed(0.7)).base_from_tool(&reported);
        assert!((given.to_homogeneous() - fixed.to_homogeneous()).norm() < 1e-14);
        // By the right hand about the tool, which points from the spindle to the tip.
        let unspun = placing(Spin::Given(-0.3)).base_from_tool(&reported);
        let axis = Unit::new_normalize(unspun * Vector3::z());
        let turned = UnitQuaternion::from_axis_angle(&axis, 0.7) * unspun.rotation;
        assert!(turned.angle_to(&given.rotation) < 1e-7);
    }
}
