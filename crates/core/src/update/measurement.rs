//! Campaigns of measurements: positions of a point, its distances from a pivot (ball-bar), and load tests.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::calibrate::{MeasuredPose, ParameterSet, Question, Refusal, fit};
use crate::frame::Isometry;
use crate::identify::LoadTest;
use crate::robot::Robot;
use crate::spatial::Wrench;

/// Measurements that were taken together.
#[derive(Clone, Debug, PartialEq)]
pub enum Campaign {
    /// Positions of a point on the tool, by a tracker, a probe, or of features that the tool cut.
    Positions(Positions),
    /// Displacements under load. Their readings state their uncertainties.
    LoadTests(Vec<LoadTest>),
}

/// Measured positions of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    /// Joint positions and position of the point, in any frame; with a rotation all or none.
    pub poses: Vec<MeasuredPose>,
    /// What acted on the arm at each pose.
    pub conditions: Vec<Condition>,
    /// The point on the flange: approximate, or known.
    pub flange_from_point: Isometry,
    /// Whether the point is known, as the tip of a tool that cut.
    pub point: Known,
    /// Standard uncertainty of a coordinate, m.
    pub standard_uncertainty: f64,
    /// Weight of rotations: metres per radian.
    pub turn_length: f64,
    /// What was measured of these positions.
    pub observed: Observed,
}

/// What was measured of a position.
#[derive(Clone, Debug, PartialEq)]
pub enum Observed {
    /// Its coordinates, as the poses have them.
    Coordinates,
    /// Its coordinate along a normal in the frame of the poses, one for each pose: the position of a surface that the tool has left.
    AlongNormals(Vec<Vector3<f64>>),
    /// Its distance from a pivot; the positions of the poses are not used.
    Distances(Distances),
}

/// Readings of a ball-bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Distances {
    /// Distance at each pose, m.
    pub lengths: Vec<f64>,
    /// The pivot, approximately; base, m.
    pub pivot: Vector3<f64>,
    /// Whether the length of the bar is known; otherwise only differences between readings are.
    pub is_calibrated: bool,
}

/// Whether something is known or to be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// It is exactly as given.
    Exactly,
    /// It is approximately as given, and found from the measurements.
    Approximately,
}

/// What acted on the arm when a position was measured, or when the feature was cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Load on the tool at the point, base axes; the weight of the arm belongs to its geometry.
    pub wrench: Wrench,
    /// Direction of the last motion of each joint in the coordinates of the controller: -1, 1, or 0 where it is not known.
    pub directions: Vec<f64>,
}

impl Condition {
    /// No load, and directions that are not known.
    pub fn unloaded(robot: &Robot) -> Condition {
        Condition {
            wrench: Wrench::from_force(Vector3::zeros()),
            directions: vec![0.0; robot.joints().len()],
        }
    }

    /// Side on which each link is within its backlash, in the coordinates of the chain: it lags behind its motor.
    pub(super) fn sides(&self, robot: &Robot) -> Vec<f64> {
        let joints = 0..robot.joints().len();
        let at_rest = vec![0.0; robot.joints().len()];
        let moved = |joint| robot.theta(joint, &self.directions) - robot.theta(joint, &at_rest);
        joints
            .map(|joint| match moved(joint) {
                0.0 => 0.0,
                moved => -f64::signum(moved),
            })
            .collect()
    }
}

impl Campaign {
    /// Number of measured numbers.
    pub fn rows(&self) -> usize {
        match self {
            Campaign::Positions(positions) => {
                match &positions.observed {
                    Observed::Distances(distances) => {
                        return distances.lengths.len() - usize::from(!distances.is_calibrated);
                    }
                    Observed::AlongNormals(normals) => return normals.len(),
                    Observed::Coordinates => {}
                }
                let turned = positions
                    .poses
                    .iter()
                    .filter(|pose| pose.rotation.is_some())
                    .count();
                3 * (positions.poses.len() + turned)
            }
            Campaign::LoadTests(tests) => tests.iter().map(|test| test.readings.len()).sum(),
        }
    }

    /// Whether the direction of the last motion of a joint is known.
    pub fn reverses(&self) -> bool {
        match self {
            Campaign::Positions(positions) => {
                let known = |condition: &Condition| condition.directions.iter().any(|side| *side != 0.0);
                positions.conditions.iter().any(known)
            }
            Campaign::LoadTests(_) => false,
        }
    }
}

impl Positions {
    /// The frame of the measurements and the point on the flange, by the nominal chain.
    ///
    /// # Errors
    /// Poses that a calibration refuses.
    pub(super) fn placed(&self, robot: &Robot) -> Result<[Isometry; 2], Refusal> {
        if let Observed::Distances(distances) = &self.observed {
            return Ok([distances.pivot_from_base(), self.flange_from_point]);
        }
        let question = |requested| Question {
            requested,
            flange_from_point: self.flange_from_point,
            turn_length: self.turn_length,
            prior: None,
        };
        let found = match self.point {
            Known::Exactly => fit(robot, &self.poses, &question(ParameterSet::Base)),
            // Where the poses hardly determine the point, it stays where it is said to be.
            Known::Approximately => fit(robot, &self.poses, &question(ParameterSet::BaseAndTool))
                .or_else(|_| fit(robot, &self.poses, &question(ParameterSet::Base))),
        }?;
        Ok([found.tracker_from_base, found.flange_from_point])
    }
}

/// Rows along the normals, from `rows` of the coordinates.
pub(super) fn rows_along(normals: &[Vector3<f64>], rows: &DMatrix<f64>) -> DMatrix<f64> {
    let mut along = DMatrix::zeros(normals.len(), rows.ncols());
    for (k, normal) in normals.iter().enumerate() {
        along
            .row_mut(k)
            .copy_from(&(normal.transpose() * rows.rows(3 * k, 3)));
    }
    along
}

impl Distances {
    /// The base in a frame at the pivot, with the axes of the base.
    fn pivot_from_base(&self) -> Isometry {
        Isometry::from_parts((-self.pivot).into(), Default::default())
    }

    /// How far the pivot of this frame is from where it was said to be, m.
    pub(super) fn moved(&self, pivot_from_base: &Isometry) -> Vector3<f64> {
        pivot_from_base.translation.vector + self.pivot
    }

    /// Rows of the distances, from `rows` of the coordinates from the pivot, which were said to be zero: the residual is last.
    ///
    /// A bar of unknown length leaves the differences between readings, in an orthonormal basis (Helmert).
    pub(super) fn rows(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let last = rows.ncols() - 1;
        let mut of_lengths = DMatrix::zeros(self.lengths.len(), last + 1);
        for (k, length) in self.lengths.iter().enumerate() {
            let here = rows.rows(3 * k, 3);
            let from_pivot = -here.column(last);
            let distance = from_pivot.norm();
            if distance > 0.0 {
                of_lengths
                    .row_mut(k)
                    .copy_from(&(from_pivot.transpose() / distance * here));
            }
            of_lengths[(k, last)] = length - distance;
        }
        if self.is_calibrated {
            return of_lengths;
        }
        let mut sum = of_lengths.row(0).into_owned();
        let mut differences = DMatrix::zeros(self.lengths.len() - 1, last + 1);
        for k in 1..self.lengths.len() {
            let (count, next) = (k as f64, of_lengths.row(k));
            let difference = (&sum - next * count) / (count * (count + 1.0)).sqrt();
            differences.row_mut(k - 1).copy_from(&difference);
            sum += next;
        }
        differences
    }
}

/// The point whose distances from these are closest to one another, by linear least squares; what the points leave open (points of a plane: the
/// distance from it) is that of their middle. None without points.
pub fn pivot_of(points: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    if points.is_empty() {
        return None;
    }
    let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    // |p|^2 - 2 p.c = constant, about the middle; the mean takes the constant.
    let from_middle: Vec<Vector3<f64>> = points.iter().map(|point| point - middle).collect();
    let mean = from_middle.iter().map(Vector3::norm_squared).sum::<f64>() / points.len() as f64;
    let a = DMatrix::from_fn(points.len(), 3, |row, column| 2.0 * from_middle[row][column]);
    let b = DVector::from_fn(points.len(), |row, _| from_middle[row].norm_squared() - mean);
    let svd = a.svd(true, true);
    let least = FLAT * svd.singular_values.max();
    let centre = svd.solve(&b, least).ok()?;
    let centre = middle + Vector3::new(centre[0], centre[1], centre[2]);
    centre.iter().all(|value| value.is_finite()).then_some(centre)
}

/// Points whose extent in a direction is below this part of their largest do not determine the pivot there.
const FLAT: f64 = 1e-2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pivot_of_a_circle_is_in_its_plane_and_that_of_a_sphere_its_centre() {
        let centre = Vector3::new(1.0, -0.4, 0.3);
        let circle: Vec<Vector3<f64>> = (0..20)
            .map(|k| {
                let angle = 0.2 * f64::from(k);
                centre + 0.15 * Vector3::new(angle.cos(), 0.8 * angle.sin(), 0.6 * angle.sin())
            })
            .collect();
        let off = (pivot_of(&circle).unwrap() - centre).norm();
        assert!(off < 1e-12, "{off}");
        let sphere: Vec<Vector3<f64>> = (0..20)
            .map(|k| {
                let (a, b) = (0.9 * f64::from(k), 0.1 * f64::from(k));
                centre + 0.15 * Vector3::new(a.cos() * b.cos(), a.sin() * b.cos(), b.sin())
            })
            .collect();
        let off = (pivot_of(&sphere).unwrap() - centre).norm();
        assert!(off < 1e-12, "{off}");
        assert_eq!(pivot_of(&[]), None);
    }

    #[test]
    fn differences_of_readings_do_not_depend_on_the_length_of_the_bar() {
        let rows = DMatrix::from_row_slice(
            9,
            2,
            &[
                1.0, -0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, -0.5,
            ],
        );
        let distances = |offset: f64, is_calibrated| Distances {
            lengths: [0.31, 0.22, 0.5].map(|length| length + offset).to_vec(),
            pivot: Vector3::zeros(),
            is_calibrated,
        };
        let known = distances(0.0, true).rows(&rows);
        // Along x, against y, along z; readings less distances.
        let expected = DMatrix::from_row_slice(3, 2, &[1.0, 0.01, -2.0, 0.02, 4.0, 0.0]);
        assert!((known - expected).norm() < 1e-15);
        let [here, longer] = [0.0, 0.1].map(|offset| distances(offset, false).rows(&rows));
        assert!((&here - longer).norm() < 1e-15 && here.nrows() == 2);
        // The sum of squares is that about the mean: 0.01, 0.02, 0 about 0.01.
        assert!((here.column(1).norm_squared() - 2e-4).abs() < 1e-17);
    }
}
