//! Deviation in space: a box of points, with the tool orientation of a plane.

use nalgebra::{Point3, Translation3, Vector3};

use super::plane::Counts;
use crate::frame::Isometry;
use crate::kernel::{Answers, Question, evaluate};
use crate::watch::{Cancelled, Watch};
use crate::workpiece::Plane;

/// A regular box of points; x runs first, then y, then z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxGrid {
    /// Base to box: its corner with the least coordinates, and its sides as axes.
    pub base_from_box: Isometry,
    /// Points along x, y, z of the box.
    pub counts: [usize; 3],
    /// Pitch, m.
    pub step: f64,
}

impl BoxGrid {
    /// The box of pitch `step` (m) about the origin of `base_from_centre`, along its axes, with the largest size within
    /// `half_size` (m).
    pub fn within(base_from_centre: &Isometry, half_size: [f64; 3], step: f64) -> BoxGrid {
        let steps = half_size.map(|half| (half / step + 1e-9).floor());
        let centre_from_corner = Translation3::from(Vector3::from(steps) * -step);
        BoxGrid {
            base_from_box: base_from_centre * centre_from_corner,
            counts: steps.map(|n| 2 * n as usize + 1),
            step,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Point `index`, m, base.
    pub fn point(&self, index: usize) -> Point3<f64> {
        let [nx, ny, _] = self.counts;
        let (x, y, z) = (index % nx, index / nx % ny, index / (nx * ny));
        self.base_from_box * Point3::from(Vector3::new(x as f64, y as f64, z as f64) * self.step)
    }

    /// The corner with the least coordinates, m, base.
    pub fn corner(&self) -> Point3<f64> {
        self.base_from_box.translation.vector.into()
    }
}

/// Answers in a box.
#[derive(Clone, Debug)]
pub struct VolumeMap {
    /// The box.
    pub grid: BoxGrid,
    /// The plane at every point: orientation only.
    pub plane: Plane,
    /// Results at each point, in the grid's order.
    pub answers: Answers,
}

impl VolumeMap {
    /// Counts the points for the tolerance `limit` (m).
    pub fn counts(&self, limit: f64) -> Counts {
        Counts::of(&self.answers, limit)
    }

    /// Volume of the points within the tolerance `limit` (m), m^3: each represents one cell of the pitch.
    pub fn volume_within(&self, limit: f64) -> f64 {
        self.counts(limit).within as f64 * self.grid.step.powi(3)
    }
}

/// The map of the box `grid` with the tool orientation of `plane`.
///
/// # Errors
/// [`Cancelled`] if the watch cancels.
pub fn volume_map(
    question: &Question<'_>,
    plane: Plane,
    grid: BoxGrid,
    watch: Watch<'_>,
) -> Result<VolumeMap, Cancelled> {
    let orientation = plane.base_from_tool(nalgebra::Point2::origin(), 0.0);
    let pose = |i: usize| Isometry::from_parts(grid.point(i).coords.into(), orientation.rotation);
    let answers = evaluate(question, grid.len(), pose, watch)?;
    Ok(VolumeMap { grid, plane, answers })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_points_run_along_x_first_from_the_least_corner() {
        let grid = BoxGrid::within(&Isometry::translation(1.0, 0.0, 0.5), [0.2, 0.1, 0.1], 0.1);
        assert_eq!(grid.counts, [5, 3, 3]);
        assert!((grid.point(0) - Point3::new(0.8, -0.1, 0.4)).norm() < 1e-15);
        assert!((grid.point(1) - Point3::new(0.9, -0.1, 0.4)).norm() < 1e-15);
        assert!((grid.point(44) - Point3::new(1.2, 0.1, 0.6)).norm() < 1e-15);
    }

    #[test]
    fn a_box_is_placed_along_the_axes_of_its_centre() {
        let turned = Isometry::new(Vector3::new(1.0, 0.2, 0.5), Vector3::new(0.3, -0.2, 0.5));
        let (grid, straight) = (
            BoxGrid::within(&turned, [0.2, 0.1, 0.1], 0.1),
            BoxGrid::within(&Isometry::identity(), [0.2, 0.1, 0.1], 0.1),
        );
        for index in 0..grid.len() {
            assert!((grid.point(index) - turned * straight.point(index)).norm() < 1e-15);
        }
        assert_eq!(grid.corner(), grid.point(0));
    }

    #[test]
    fn every_point_of_a_box_is_inside_and_unique() {
        let (centre, half, step) = (Point3::new(0.9, -0.2, 0.4), [0.21, 0.1, 0.34], 0.1);
        let grid = BoxGrid::within(&Isometry::translation(centre.x, centre.y, centre.z), half, step);
        assert_eq!((grid.len(), grid.is_empty()), (5 * 3 * 7, false));
        let points: Vec<_> = (0..grid.len()).map(|i| grid.point(i)).collect();
        for (index, point) in points.iter().enumerate() {
            let off = point - centre;
            assert!((0..3).all(|k| off[k].abs() <= half[k] + 1e-12), "{point}");
            let nearest = points[..index].iter().map(|other| (other - point).norm());
            assert!(nearest.fold(f64::INFINITY, f64::min) > 0.99 * step);
        }
        let middle: Vector3<f64> = points.iter().map(|point| point.coords).sum::<Vector3<f64>>();
        assert!((middle / points.len() as f64 - centre.coords).norm() < 1e-14);
    }
}
