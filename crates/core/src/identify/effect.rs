//! Effect of each unknown in each test, and its derivatives.
//!
//! `reading = sum_k c_k g_k(tau_k) a_k`, `tau_k = s_k(force point) . w`, with `a_k` the displacement of the measured
//! point per unit of unknown `k` (or the turn about a joint's axis).
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `c_k`, `g_k` | size of the unknown, its force law (see `unknown`) | |
//! | `s_k` | its screw, base axes | m, rad per unit |
//! | `w` | wrench on the tool at the force point | N, N m |
//!
//! Source: linear in `c`, see `docs/theory/identification.md`; derivatives by the points checked by differences.

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::load_test::{LoadTest, Measured};
use super::prior::typical_sizes;
use super::unknown::Unknown;
use crate::robot::forward::{forward, joint_axis};
use crate::robot::{Attachment, Robot};
use crate::spatial::{Twist, Wrench};

/// A test with the quantities given by its posture.
#[derive(Clone, Debug)]
pub struct Effects {
    flange: Matrix3<f64>,
    screws: Vec<Twist>,
    joint_axes: Vec<Vector3<f64>>,
    wrench: Wrench,
    points: [Vector3<f64>; 2],
    measured: Vec<Measured>,
}

/// The unknowns: sizes, and shifts of the two points from their stated positions.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// `c`, one per unknown.
    pub sizes: Vec<f64>,
    /// Shift of the force point, m, flange frame.
    pub force_shift: Vector3<f64>,
    /// Shift of the measured point, m, flange frame.
    pub measured_shift: Vector3<f64>,
}

impl State {
    /// Sizes, with both points at their stated positions.
    pub fn of_sizes(sizes: Vec<f64>) -> State {
        State {
            sizes,
            force_shift: Vector3::zeros(),
            measured_shift: Vector3::zeros(),
        }
    }

    /// The middle of the typical prior.
    pub fn typical(unknowns: &[Unknown]) -> State {
        State::of_sizes(typical_sizes(unknowns))
    }
}

impl Effects {
    /// The effects of `unknowns` in `test`.
    pub fn of(robot: &Robot, unknowns: &[Unknown], test: &LoadTest) -> Effects {
        let frames = forward(robot, &test.joints);
        let joints = 0..robot.joints().len();
        Effects {
            flange: *frames.base_from_flange.rotation.matrix(),
            screws: unknowns.iter().map(|u| u.screw_at_flange(&frames)).collect(),
            joint_axes: joints.map(|index| joint_axis(robot, &frames, index)).collect(),
            wrench: test.wrench,
            points: [test.force_point, test.measured_point],
            measured: test.readings.iter().map(|reading| reading.what).collect(),
        }
    }

    /// Torque (N m; N) of the wrench about each unknown, with the force at its stated point.
    pub fn torques(&self) -> Vec<f64> {
        let lever = self.flange * self.points[0];
        self.screws
            .iter()
            .map(|s| s.moved(lever).dot(&self.wrench))
            .collect()
    }

    /// The readings that `state` predicts, m or rad.
    pub fn readings(&self, unknowns: &[Unknown], state: &State) -> Vec<f64> {
        let jacobian = self.jacobian(unknowns, state);
        (0..self.measured.len())
            .map(|row| predicted(&jacobian, row, state))
            .collect()
    }

    /// Derivatives of the readings: by the sizes, then by the force shift, then by the measured shift.
    pub fn jacobian(&self, unknowns: &[Unknown], state: &State) -> DMatrix<f64> {
        let count = unknowns.len();
        let mut jacobian = DMatrix::zeros(self.measured.len(), count + 6);
        let force_lever = self.flange * (self.points[0] + state.force_shift);
        let lever = self.flange * (self.points[1] + state.measured_shift);
        for (k, (unknown, screw)) in unknowns.iter().zip(&self.screws).enumerate() {
            let torque = screw.moved(force_lever).dot(&self.wrench);
            let (way, slope) = unknown.force_law(torque);
            let moved = screw.moved(lever).linear;
            // Moving the force by e changes the torque by w . (e x F) = e . (F x w).
            let by_force = self.flange.transpose() * self.wrench.force.cross(&screw.angular);
            // Moving the measured point by e changes the displacement by w x e.
            let by_measured = screw.angular.cross_matrix() * self.flange;
            for (row, measured) in self.measured.iter().enumerate() {
                let part = match *measured {
                    Measured::Displacement(axis) => {
                        for j in 0..3 {
                            jacobian[(row, count + 3 + j)] +=
                                state.sizes[k] * way * by_measured[(axis.index(), j)];
                        }
                        moved[axis.index()]
                    }
                    Measured::Turn(joint) if unknown.attachment == Attachment::Joint(joint) => {
                        screw.angular.dot(&self.joint_axes[joint])
                    }
                    Measured::Turn(_) => 0.0,
                };
                jacobian[(row, k)] = way * part;
                for j in 0..3 {
                    jacobian[(row, count + j)] += state.sizes[k] * slope * by_force[j] * part;
                }
            }
        }
        jacobian
    }
}

/// The reading in `row` of a jacobian, m or rad: linear in the sizes.
pub(super) fn predicted(jacobian: &DMatrix<f64>, row: usize, state: &State) -> f64 {
    let parts = state.sizes.iter().enumerate();
    parts.map(|(k, size)| jacobian[(row, k)] * size).sum()
}

#[cfg(test)]
mod tests {
    use super::super::unknown::{bending, drives, lost_motion, tool};
    use super::*;
    use crate::robot::chain::{Amount, Axis, Motion};
    use crate::robot::joint::{Joint, JointCompliance};
    use crate::source::elastic;

    fn arm() -> Robot {
        let about = |axis, joint| Motion::About(axis, Amount::Joint(joint));
        let along = |axis, by| Motion::Along(axis, Amount::Constant(by));
        let motions = vec![
            along(Axis::Z, 0.4),
            about(Axis::Z, 0),
            along(Axis::X, 0.2),
            about(Axis::Y, 1),
            along(Axis::X, 0.7),
            about(Axis::X, 2),
        ];
        Robot::new("arm", motions, ["a", "b", "c"].map(Joint::plain).to_vec()).unwrap()
    }

    fn test() -> LoadTest {
        let reading = |what| super::super::load_test::Reading {
            what,
            value: 0.0,
            standard_uncertainty: 1e-5,
        };
        LoadTest {
            joints: vec![0.3, -0.6, 1.0],
            wrench: Wrench {
                force: Vector3::new(30.0, -80.0, -200.0),
                moment: Vector3::new(2.0, 1.0, -3.0),
            },
            force_point: Vector3::new(0.1, 0.05, 0.3),
            measured_point: Vector3::new(0.12, 0.02, 0.25),
            readings: [Axis::X, Axis::Y, Axis::Z]
                .map(Measured::Displacement)
                .into_iter()
                .chain([Measured::Turn(1)])
                .map(reading)
                .collect(),
        }
    }

    #[test]
    fn drives_only_deflect_as_in_the_elastic_source() {
        let (robot, mut test) = (arm(), test());
        test.measured_point = test.force_point;
        let sizes = vec![2e-6, 3e-6, 1e-5];
        let frames = forward(&robot, &test.joints);
        let tcp = frames.base_from_flange * nalgebra::Point3::from(test.force_point);
        let screws = crate::robot::jacobian::screws_at(&robot, &frames, &tcp);
        let joints: Vec<_> = sizes
            .iter()
            .map(|value| JointCompliance {
                value: *value,
                standard_uncertainty: 0.0,
            })
            .collect();
        let expected = elastic::displacement(&screws, &joints, &test.wrench);
        let unknowns = drives(&robot);
        let state = State::of_sizes(sizes.clone());
        let found = Effects::of(&robot, &unknowns, &test).readings(&unknowns, &state);
        for axis in 0..3 {
            assert!((found[axis] - expected[axis]).abs() < 1e-15, "{found:?}");
        }
        let turn = sizes[1] * screws[1].dot(&test.wrench);
        assert!((found[3] - turn).abs() < 1e-15);
    }

    #[test]
    fn derivatives_match_differences() {
        let (robot, test) = (arm(), test());
        let unknowns = [
            drives(&robot),
            bending(&robot),
            tool(),
            lost_motion(&robot, &[20.0, 20.0, 20.0]),
        ]
        .concat();
        let state = State {
            sizes: (0..unknowns.len()).map(|k| 1e-6 * (1.0 + k as f64)).collect(),
            force_shift: Vector3::new(0.01, 0.02, -0.03),
            measured_shift: Vector3::new(-0.02, 0.01, 0.04),
        };
        let effects = Effects::of(&robot, &unknowns, &test);
        let jacobian = effects.jacobian(&unknowns, &state);
        let here = effects.readings(&unknowns, &state);
        // Forward differences: error about step times curvature, relative to displacements of 1e-3 m.
        let step = 1e-7;
        for j in 0..6 {
            let mut moved = state.clone();
            if j < 3 {
                moved.force_shift[j] += step;
            } else {
                moved.measured_shift[j - 3] += step;
            }
            let there = effects.readings(&unknowns, &moved);
            for row in 0..4 {
                let difference = (there[row] - here[row]) / step;
                let exact = jacobian[(row, unknowns.len() + j)];
                assert!((difference - exact).abs() < 1e-8, "{difference} against {exact}");
            }
        }
    }
}
