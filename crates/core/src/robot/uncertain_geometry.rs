//! Uncertainty of the geometry: small motions of the chain after its joints, which are zero on average and known with a covariance.
//!
//! ```text
//! S = sum_k l_k l_k'        d_k = sum_i l_ki t_i        t_i = (a, 0) along an axis a, (a x (p - o), a) about it
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `S` | covariance of the small motions | m, rad |
//! | `l_k` | the small motions by one standard uncertainty of the independent input `k` | m, rad |
//! | `t_i` | displacement of the point `p` by the small motion `i` along or about an axis through `o`, the origin of the joint that it follows | m/m, m/rad, rad/rad |
//! | `d_k` | displacement of the point by one standard uncertainty of input `k` | m, rad |
//!
//! The frame of a joint is that after its motion, as in [`crate::calibrate`]. First order: a small motion does not change the effect of another.
//!
//! Source: law of propagation, JCGM 100:2008, 5.2.2; columns of a calibration: Everett, Driels and Mooring 1987.

use nalgebra::{DMatrix, DVector, IsometryMatrix3, Matrix6xX, Point3, SymmetricEigen};

use crate::spatial::Twist;

/// Independent inputs with less than this part of the largest variance are left out.
const NEGLIGIBLE: f64 = 1e-14;
/// A covariance may deviate from symmetry and sign by the rounding of its printed numbers, relative to its largest entry.
const PRINTED: f64 = 1e-9;
/// Largest standard uncertainty of a small motion, m or rad: larger ones are not small.
pub const LARGEST_SMALL_MOTION: f64 = 0.1;

/// A small motion of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SmallMotion {
    /// Index of the joint that it follows.
    pub after: usize,
    /// Along x, y, z: 0, 1, 2; about x, y, z: 3, 4, 5; of the axes of the joint after its motion.
    pub component: usize,
}

/// Why an uncertainty of the geometry is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UncertainGeometryError {
    /// A covariance of another number of motions.
    #[error("the covariance of {motions} small motions has {rows} rows and {columns} columns")]
    Size {
        /// Small motions.
        motions: usize,
        /// Rows of the matrix.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
    /// A motion after a joint that does not exist, about a seventh axis, or twice.
    #[error("small motion number {} is after no joint of the arm, has no axis, or is named twice", .0 + 1)]
    Motion(usize),
    /// An entry that is not finite, not symmetric or too large, or a negative variance.
    #[error(
        "the covariance of the geometry is not symmetric, negative in a direction, or above ({LARGEST_SMALL_MOTION} m or rad)^2"
    )]
    Covariance,
}

/// What is known of the geometry of an arm beyond its values.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertainGeometry {
    motions: Vec<SmallMotion>,
    /// One column per independent input: the motions by one standard uncertainty of it.
    inputs: DMatrix<f64>,
    /// Shift along each input, in standard uncertainties: 0 but for an uncertain input.
    shift: DVector<f64>,
}

impl UncertainGeometry {
    /// Of these small motions with this covariance (m, rad), in their order.
    ///
    /// # Errors
    /// See [`UncertainGeometryError`]; the joints are checked by [`Structure::check`](super::Structure::check).
    pub fn new(
        motions: Vec<SmallMotion>,
        covariance: &DMatrix<f64>,
    ) -> Result<UncertainGeometry, UncertainGeometryError> {
        if covariance.nrows() != motions.len() || covariance.ncols() != motions.len() {
            return Err(UncertainGeometryError::Size {
                motions: motions.len(),
                rows: covariance.nrows(),
                columns: covariance.ncols(),
            });
        }
        let is_new =
            |(k, motion): (usize, &SmallMotion)| motion.component < 6 && !motions[..k].contains(motion);
        if let Some(wrong) = motions.iter().enumerate().position(|motion| !is_new(motion)) {
            return Err(UncertainGeometryError::Motion(wrong));
        }
        let rounding = PRINTED * covariance.amax();
        let largest = LARGEST_SMALL_MOTION * LARGEST_SMALL_MOTION;
        let is_sound = covariance.iter().all(|entry| entry.abs() <= largest)
            && (covariance - covariance.transpose()).amax() <= rounding;
        if !is_sound {
            return Err(UncertainGeometryError::Covariance);
        }
        let axes = SymmetricEigen::new(covariance.clone());
        if axes.eigenvalues.iter().any(|variance| *variance < -rounding) {
            return Err(UncertainGeometryError::Covariance);
        }
        let least = NEGLIGIBLE * covariance.amax();
        let kept: Vec<usize> = (0..motions.len())
            .filter(|k| axes.eigenvalues[*k] > least)
            .collect();
        let inputs = DMatrix::from_fn(motions.len(), kept.len(), |row, column| {
            let k = kept[column];
            axes.eigenvectors[(row, k)] * axes.eigenvalues[k].sqrt()
        });
        Ok(UncertainGeometry {
            motions,
            shift: DVector::zeros(inputs.ncols()),
            inputs,
        })
    }

    /// The small motions.
    pub fn motions(&self) -> &[SmallMotion] {
        &self.motions
    }

    /// Number of independent inputs.
    pub fn inputs(&self) -> usize {
        self.inputs.ncols()
    }

    /// Covariance of the small motions, m and rad, in their order.
    pub fn covariance(&self) -> DMatrix<f64> {
        &self.inputs * self.inputs.transpose()
    }

    /// This geometry with its small motions changed by one standard uncertainty of independent input `input`.
    #[must_use]
    pub fn shifted(&self, input: usize) -> UncertainGeometry {
        let mut shifted = self.clone();
        shifted.shift[input] += 1.0;
        shifted
    }

    /// This geometry with its small motions changed by these numbers of standard uncertainties, one for each independent input.
    ///
    /// # Panics
    /// If there is another number of them.
    #[must_use]
    pub fn shifted_by(&self, inputs: &[f64]) -> UncertainGeometry {
        assert_eq!(inputs.len(), self.inputs(), "one number for each input");
        let mut shifted = self.clone();
        shifted.shift += DVector::from_column_slice(inputs);
        shifted
    }

    /// The small motions of the shift, m and rad: zeros but for an uncertain input.
    pub fn shift_of_motions(&self) -> DVector<f64> {
        &self.inputs * &self.shift
    }

    /// The same of an arm whose joints follow `joints` others.
    #[must_use]
    pub fn behind(&self, joints: usize) -> UncertainGeometry {
        let mut behind = self.clone();
        for motion in &mut behind.motions {
            motion.after += joints;
        }
        behind
    }

    /// Displacement of `point` (m, rad, base) by one standard uncertainty of each independent input; `joints` are the frames of the joints after their motion, in base.
    pub fn displacements(&self, joints: &[IsometryMatrix3<f64>], point: &Point3<f64>) -> Vec<Twist> {
        let moved = self.effects(joints, point) * &self.inputs;
        (moved.column_iter())
            .map(|column| twist_of(&column.into_owned()))
            .collect()
    }

    /// Displacement of `point` (m, rad, base) by the shift: none but for an uncertain input.
    pub fn shift(&self, joints: &[IsometryMatrix3<f64>], point: &Point3<f64>) -> Twist {
        if self.shift.iter().all(|by| *by == 0.0) {
            return Twist::ZERO;
        }
        twist_of(&(self.effects(joints, point) * (&self.inputs * &self.shift)))
    }

    /// Displacement of `point` by each small motion, one column each: linear, then angular.
    fn effects(&self, joints: &[IsometryMatrix3<f64>], point: &Point3<f64>) -> Matrix6xX<f64> {
        let mut effects = Matrix6xX::zeros(self.motions.len());
        for (mut column, motion) in effects.column_iter_mut().zip(&self.motions) {
            let frame = &joints[motion.after];
            let axis = frame.rotation.matrix().column(motion.component % 3).into_owned();
            if motion.component < 3 {
                column.fixed_rows_mut::<3>(0).copy_from(&axis);
            } else {
                let arm = point.coords - frame.translation.vector;
                column.fixed_rows_mut::<3>(0).copy_from(&axis.cross(&arm));
                column.fixed_rows_mut::<3>(3).copy_from(&axis);
            }
        }
        effects
    }
}

fn twist_of(column: &nalgebra::Vector6<f64>) -> Twist {
    Twist {
        linear: column.fixed_rows::<3>(0).into_owned(),
        angular: column.fixed_rows::<3>(3).into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;
    use crate::arms;
    use crate::robot::chain::{Amount, Axis, Motion};
    use crate::robot::forward::forward;
    use crate::robot::{Robot, RobotError};

    fn every_motion() -> Vec<SmallMotion> {
        let of = |after| (0..6).map(move |component| SmallMotion { after, component });
        (0..5).flat_map(of).collect()
    }

    /// A covariance of full rank, of some 0.1 mm and 0.1 mrad.
    fn covariance(size: usize) -> DMatrix<f64> {
        let root = DMatrix::from_fn(size, size, |i, j| 1e-5 * ((3 * i + 7 * j) as f64).sin());
        &root * root.transpose() + DMatrix::identity(size, size) * 1e-9
    }

    /// The arm with these small motions in its chain.
    fn moved(robot: &Robot, motions: &[SmallMotion], by: &DVector<f64>) -> Result<Robot, RobotError> {
        let mut chain = Vec::new();
        for motion in robot.chain().motions() {
            chain.push(*motion);
            let Amount::Joint(joint) = motion.amount() else {
                continue;
            };
            for (small, by) in motions
                .iter()
                .zip(by.iter())
                .filter(|(small, _)| small.after == joint)
            {
                let (axis, amount) = (Axis::ALL[small.component % 3], Amount::Constant(*by));
                chain.push(match small.component < 3 {
                    true => Motion::Along(axis, amount),
                    false => Motion::About(axis, amount),
                });
            }
        }
        Robot::new("moved", chain, robot.joints().to_vec())
    }

    #[test]
    fn inputs_add_up_to_the_covariance_and_move_the_tool_as_motions_of_the_chain_do() {
        let (robot, motions) = (arms::mh12(), every_motion());
        let geometry = UncertainGeometry::new(motions.clone(), &covariance(30)).unwrap();
        assert_eq!(geometry.inputs(), 30);
        assert!((geometry.covariance() - covariance(30)).amax() < 1e-12 * covariance(30).amax());
        let mut stream = arms::Stream(5);
        let joints = stream.joints(&robot);
        let tool = Point3::new(0.05, -0.1, 0.2);
        let at = |robot: &Robot| {
            let flange = forward(robot, &joints).base_from_flange;
            (
                flange * tool,
                UnitQuaternion::from_rotation_matrix(&flange.rotation),
            )
        };
        let frames = forward(&robot, &joints);
        let (point, _) = at(&robot);
        for (k, expected) in geometry
            .displacements(&frames.base_from_joint, &point)
            .iter()
            .enumerate()
        {
            let by = geometry.inputs.column(k).into_owned();
            // Central differences: what is left is of third order in motions of 0.1 mm and 0.1 mrad.
            let (there, turn) = at(&moved(&robot, &motions, &by).unwrap());
            let (back, turned_back) = at(&moved(&robot, &motions, &-by).unwrap());
            let linear: Vector3<f64> = (there - back) / 2.0;
            let angular = (turn * turned_back.inverse()).scaled_axis() / 2.0;
            assert!(expected.linear.norm() > 1e-6, "{k}");
            assert!((linear - expected.linear).norm() < 1e-9, "{k}");
            assert!((angular - expected.angular).norm() < 1e-9, "{k}");
            let shift = geometry.shifted(k).shift(&frames.base_from_joint, &point);
            assert!((shift.linear - expected.linear).norm() < 1e-15, "{k}");
            assert!((shift.angular - expected.angular).norm() < 1e-15, "{k}");
        }
        assert_eq!(geometry.shift(&frames.base_from_joint, &point), Twist::ZERO);
        let behind = geometry.behind(2);
        assert_eq!(
            behind.motions()[0],
            SmallMotion {
                after: 2,
                component: 0
            }
        );
    }

    #[test]
    fn a_known_combination_has_no_uncertainty() {
        // Two lengths along one line, of which the sum is known.
        let motions = vec![
            SmallMotion {
                after: 1,
                component: 2,
            },
            SmallMotion {
                after: 2,
                component: 2,
            },
        ];
        let covariance = DMatrix::from_row_slice(2, 2, &[1e-8, -1e-8, -1e-8, 1e-8]);
        let geometry = UncertainGeometry::new(motions, &covariance).unwrap();
        assert_eq!(geometry.inputs(), 1);
        let robot = arms::mh12();
        let stretched = forward(&robot, &[0.0; 6]);
        let [moved] = geometry.displacements(&stretched.base_from_joint, &stretched.origin(5))[..] else {
            panic!()
        };
        // Stretched, both are vertical.
        assert!(moved.linear.norm() < 1e-15 && moved.angular.norm() == 0.0);
        let bent = forward(&robot, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let [moved] = geometry.displacements(&bent.base_from_joint, &bent.origin(5))[..] else {
            panic!()
        };
        // 0.1 mm one way and back at an angle of 1 rad.
        assert!(
            (moved.linear.norm() - 2e-4 * 0.5_f64.sin()).abs() < 1e-12,
            "{moved:?}"
        );
    }

    #[test]
    fn covariances_and_motions_that_are_none_are_refused() {
        let motions = vec![
            SmallMotion {
                after: 1,
                component: 2,
            },
            SmallMotion {
                after: 2,
                component: 4,
            },
        ];
        let of = |entries: &[f64; 4]| {
            UncertainGeometry::new(motions.clone(), &DMatrix::from_row_slice(2, 2, entries)).unwrap_err()
        };
        for wrong in [
            [1e-8, 1e-9, 2e-9, 1e-8],
            [1e-8, 2e-8, 2e-8, 1e-8],
            [f64::NAN, 0.0, 0.0, 1e-8],
            [0.02, 0.0, 0.0, 1e-8],
        ] {
            assert_eq!(of(&wrong), UncertainGeometryError::Covariance, "{wrong:?}");
        }
        let one = DMatrix::identity(1, 1) * 1e-8;
        let two = DMatrix::identity(2, 2) * 1e-8;
        let (motions, rows, columns) = (2, 1, 1);
        assert_eq!(
            UncertainGeometry::new(motions_of([2, 4]), &one),
            Err(UncertainGeometryError::Size {
                motions,
                rows,
                columns
            })
        );
        assert_eq!(
            UncertainGeometry::new(motions_of([2, 6]), &two),
            Err(UncertainGeometryError::Motion(1))
        );
        assert_eq!(
            UncertainGeometry::new(motions_of([2, 2]), &two),
            Err(UncertainGeometryError::Motion(1))
        );
    }

    fn motions_of(components: [usize; 2]) -> Vec<SmallMotion> {
        components
            .map(|component| SmallMotion { after: 1, component })
            .to_vec()
    }
}
