//! The deviation where the arm will work: predicted, and how uncertain it is after the measurements.
//!
//! A deviation that is the same displacement and rotation at all points vanishes when the workpiece is located by the robot, or the
//! measured part by best fit; it is taken out, of the deviation and of its covariance:
//!
//! ```text
//! d' = (1 - Q Q') d        V = tr ((1 - Q Q') G C G' (1 - Q Q'))        u_rms = sqrt (V / n)
//! ```
//!
//! with `G` the derivatives of the deviation of `n` points with respect to the parameters, `C` their covariance, and `Q` an orthonormal basis of the six
//! small displacements of a rigid body.

use nalgebra::{DMatrix, Vector3};

use super::measurement::{Campaign, Condition, Known, Observed, Positions};
use super::parameter::Knowledge;
use super::state::{Model, residual};
use crate::calibrate::MeasuredPose;
use crate::frame::Isometry;
use crate::robot::Robot;
use crate::robot::forward::forward;

/// A point of the work.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPoint {
    /// Joint positions, controller, rad or m.
    pub joints: Vec<f64>,
    /// Load on the tool and directions of the last motions.
    pub condition: Condition,
}

/// Points where the deviation matters.
#[derive(Clone, Debug)]
pub struct Work {
    campaign: Campaign,
    /// Displacements of a rigid body at all points, orthonormal columns.
    rigid: DMatrix<f64>,
}

impl Work {
    /// These points, with the tip of the tool at `flange_from_tool`. `None` without points, or of points with other numbers of joints.
    pub fn new(robot: &Robot, flange_from_tool: Isometry, points: &[WorkPoint]) -> Option<Work> {
        let joints = robot.joints().len();
        let fits =
            |point: &WorkPoint| point.joints.len() == joints && point.condition.directions.len() == joints;
        if points.is_empty() || !points.iter().all(fits) {
            return None;
        }
        let tool = nalgebra::Point3::from(flange_from_tool.translation.vector);
        let at = |point: &WorkPoint| (forward(robot, &point.joints).base_from_flange * tool).coords;
        let tips: Vec<Vector3<f64>> = points.iter().map(at).collect();
        let pose = |(point, tip): (&WorkPoint, &Vector3<f64>)| MeasuredPose {
            joints: point.joints.clone(),
            position: *tip,
            rotation: None,
        };
        Some(Work {
            campaign: Campaign::Positions(Positions {
                poses: points.iter().zip(&tips).map(pose).collect(),
                conditions: points.iter().map(|point| point.condition.clone()).collect(),
                flange_from_point: flange_from_tool,
                point: Known::Exactly,
                standard_uncertainty: 1.0,
                turn_length: 1.0,
                observed: Observed::Coordinates,
            }),
            rigid: rigid(&tips),
        })
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.rigid.nrows() / 3
    }

    /// Predicted deviation of each point from its nominal position, base, m: displacements of the whole removed.
    pub fn deviation(&self, robot: &Robot, knowledge: &[Knowledge]) -> Vec<Vector3<f64>> {
        // The measured position is the nominal one: the residual is the deviation with the other sign.
        let all = -residual(&self.rows(robot, knowledge));
        let left = &all - &self.rigid * self.rigid.tr_mul(&all);
        left.as_slice()
            .chunks_exact(3)
            .map(Vector3::from_column_slice)
            .collect()
    }

    /// Derivatives of the deviations, one column per parameter, displacements of the whole removed.
    pub(super) fn derivatives(&self, robot: &Robot, knowledge: &[Knowledge]) -> DMatrix<f64> {
        let rows = self.rows(robot, knowledge);
        let all = rows.columns(0, knowledge.len());
        all - &self.rigid * self.rigid.tr_mul(&all)
    }

    /// Root mean square over the points of the standard uncertainty of the deviation (of its length), m, with this covariance of `knowledge`.
    pub fn uncertainty(&self, robot: &Robot, knowledge: &[Knowledge], covariance: &DMatrix<f64>) -> f64 {
        let derivatives = self.derivatives(robot, knowledge);
        let variance = (&derivatives * covariance).component_mul(&derivatives).sum();
        (variance.max(0.0) / self.points() as f64).sqrt()
    }

    fn rows(&self, robot: &Robot, knowledge: &[Knowledge]) -> DMatrix<f64> {
        let campaigns = std::slice::from_ref(&self.campaign);
        let Campaign::Positions(positions) = &self.campaign else {
            return DMatrix::zeros(0, knowledge.len() + 1);
        };
        let model = Model::new(robot, knowledge, campaigns);
        model.rows(&model.at(positions.flange_from_point), 0)
    }
}

/// Covariance of knowledge that is not correlated, as before any measurement.
pub fn independent(knowledge: &[Knowledge]) -> DMatrix<f64> {
    let variance = |known: &Knowledge| known.deviation * known.deviation;
    DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(
        knowledge.len(),
        knowledge.iter().map(variance),
    ))
}

/// Orthonormal displacements of a rigid body at `tips`, one column each; fewer of points on a line.
fn rigid(tips: &[Vector3<f64>]) -> DMatrix<f64> {
    let centre = tips.iter().sum::<Vector3<f64>>() / tips.len() as f64;
    let mut all = DMatrix::zeros(3 * tips.len(), 6);
    for (k, tip) in tips.iter().enumerate() {
        all.fixed_view_mut::<3, 3>(3 * k, 0).fill_with_identity();
        // A rotation by w moves the tip by w x (p - centre).
        all.fixed_view_mut::<3, 3>(3 * k, 3)
            .copy_from(&(centre - tip).cross_matrix());
    }
    let parts = all.svd(true, false);
    let largest = parts.singular_values.max();
    let kept: Vec<usize> = (0..parts.singular_values.len())
        .filter(|k| parts.singular_values[*k] > 1e-9 * largest)
        .collect();
    parts
        .u
        .map_or_else(|| DMatrix::zeros(3 * tips.len(), 0), |u| u.select_columns(&kept))
}
