//! Descents: convergence, fixed joints, and redundant joints.

use nalgebra::{DMatrix, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::robot::Robot;

fn goal(robot: &Robot, theta: &[f64]) -> Requested {
    Requested::new(&robot.chain().base_from_flange(theta))
}

/// Chain positions of the middle of the ranges, off by up to `by`.
fn near_middle(robot: &Robot, stream: &mut Stream, by: f64) -> Vec<f64> {
    let middles = robot.middles();
    let q: Vec<f64> = middles
        .iter()
        .map(|middle| middle + stream.between(-by, by))
        .collect();
    (0..q.len()).map(|i| robot.theta(i, &q)).collect()
}

#[test]
fn near_the_pose_every_step_squares_the_error() {
    let mut stream = Stream(2);
    for robot in [arms::other::oblique(), arms::other::iiwa14()] {
        let chain = robot.chain();
        let mut descent = Descent::new(chain);
        let mut squared = 0;
        for _ in 0..30 {
            let there = near_middle(&robot, &mut stream, 1.0);
            if descent.dependent(chain, &there) {
                continue;
            }
            let goal = goal(&robot, &there);
            let mut theta: Vec<f64> = there.iter().map(|t| t + stream.between(-0.02, 0.02)).collect();
            let mut size = descent.error(chain, &goal, &theta).norm();
            while size > 1e-6 {
                let error = descent.error(chain, &goal, &theta);
                descent.linearise(chain);
                let step = descent.least_squares(&error, 1e-2 * size * size);
                descent.try_step(&theta, |column| column.dot(&step));
                theta.copy_from_slice(&descent.trial);
                let after = descent.error(chain, &goal, &theta).norm();
                // Second derivatives of some units through an inverse of up to 300: mostly far less.
                assert!(after < 3e3 * size * size + 1e-14, "{size} -> {after}");
                assert!(after < size);
                size = after;
                squared += 1;
            }
        }
        assert!(squared > 30, "{squared} steps");
    }
}

#[test]
fn a_pose_that_is_already_reached_changes_no_bit() {
    let robot = arms::other::oblique();
    let theta = near_middle(&robot, &mut Stream(3), 1.0);
    let mut found = theta.clone();
    Descent::new(robot.chain())
        .reach(robot.chain(), &goal(&robot, &theta), &mut found)
        .unwrap();
    assert_eq!(found, theta);
}

#[test]
fn a_fixed_joint_keeps_every_bit() {
    let robot = arms::other::iiwa14();
    let chain = robot.chain();
    let mut descent = Descent::new(chain);
    let mut stream = Stream(4);
    let mut reached = 0;
    for _ in 0..40 {
        let there = near_middle(&robot, &mut stream, 1.2);
        let goal = goal(&robot, &there);
        let mut theta: Vec<f64> = there.iter().map(|t| t + stream.between(-0.1, 0.1)).collect();
        let fixed = theta[2];
        if descent.reach_with_fixed(chain, &goal, 2, &mut theta).is_ok() {
            assert!(descent.error(chain, &goal, &theta).norm() < 1e-9);
            reached += 1;
        }
        assert_eq!(theta[2].to_bits(), fixed.to_bits());
        // No lasting effect: the next descent moves all joints.
        assert_eq!(descent.still, None);
    }
    assert!(reached > 30, "{reached} of 40");
}

#[test]
fn redundant_joints_end_where_no_self_motion_leads_nearer_home() {
    let robot = arms::other::iiwa14();
    let chain = robot.chain();
    let mut descent = Descent::new(chain);
    let mut stream = Stream(6);
    let mut settled = 0;
    for _ in 0..30 {
        let home = near_middle(&robot, &mut stream, 0.8);
        let there: Vec<f64> = home.iter().map(|t| t + stream.between(-0.3, 0.3)).collect();
        let goal = goal(&robot, &there);
        let mut theta = there.clone();
        descent.reach_near(chain, &goal, &home, &mut theta).unwrap();
        assert!(descent.error(chain, &goal, &theta).norm() < 1e-9);
        let distance = |theta: &[f64]| -> f64 { theta.iter().zip(&home).map(|(a, b)| (a - b).powi(2)).sum() };
        assert!(distance(&theta) <= distance(&there) + 1e-9);
        // The self-motion: the null space of all columns.
        descent.error(chain, &goal, &theta);
        descent.linearise(chain);
        let j = DMatrix::from_fn(6, 7, |row, column| descent.columns[column][row]);
        let eigen = (j.transpose() * &j).symmetric_eigen();
        let own = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
        assert!((&j * &own).norm() < 1e-7);
        let pull: f64 = own
            .iter()
            .zip(theta.iter().zip(&home))
            .map(|(n, (t, h))| n * (h - t))
            .sum();
        // Pulls end below 1e-6, each half of what is left.
        settled += usize::from(pull.abs() < 1e-5);
    }
    assert!(settled >= 29, "{settled} of 30");
}

#[test]
fn joints_are_dependent_where_the_singular_values_say_so() {
    let robot = arms::mh12();
    let chain = robot.chain();
    let mut descent = Descent::new(chain);
    let mut stream = Stream(7);
    let mut counts = [0, 0];
    for _ in 0..400 {
        let mut theta = near_middle(&robot, &mut stream, 1.5);
        // From a straight wrist to one that is bent by half a radian.
        theta[4] = 10f64.powf(stream.between(-4.0, -0.3));
        let found = descent.dependent(chain, &theta);
        let j = DMatrix::from_fn(6, 6, |row, column| descent.columns[column][row]);
        let squares = (&j * j.transpose()).symmetric_eigenvalues();
        let condition = (squares.sum() * squares.map(|s| 1.0 / s).sum()).sqrt();
        // The least square has lost eps times the condition squared.
        if (condition / DEPENDENT - 1.0).abs() > 1e-3 {
            assert_eq!(found, condition > DEPENDENT, "{condition}");
            counts[usize::from(found)] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
    assert!(
        !descent.dependent(chain, &[0.0; 5]),
        "five joints never span all directions"
    );
}

#[test]
fn a_pose_out_of_reach_is_not_found_and_the_remaining_error_is_reported() {
    let robot = arms::other::oblique();
    let mut descent = Descent::new(robot.chain());
    let far = Requested::new(&Isometry::translation(9.0, 0.0, 0.0));
    let mut theta = vec![0.1; 6];
    let miss = descent.reach(robot.chain(), &far, &mut theta).unwrap_err();
    let Unreachable::NotFound { by, .. } = miss else {
        panic!("{miss}");
    };
    let flange = robot.chain().base_from_flange(&theta).translation.vector;
    assert!((by - (flange - Vector3::x() * 9.0).norm()).abs() < 1e-9, "{by}");
}
