//! Accuracy and repeatability of poses.
//!
//! With attained positions `x_j` of `n` cycles, their barycentre `m` and the commanded position `c`:
//!
//! | quantity | formula | unit |
//! |---|---|---|
//! | AP, accuracy | `norm(m - c)` | m |
//! | RP, repeatability | `mean l + 3 S_l`, `l_j = norm(x_j - m)`, `S_l` with `n - 1` | m |
//! | AP of orientation | angle from the commanded to the mean orientation | rad |
//! | RP of orientation | `3 S` of the rotations about each axis, from the mean orientation | rad |
//! | vAP, variation with direction | largest distance of barycentres of different approach directions | m |
//!
//! Rotations are given as rotation vectors about axes x, y, z of the reference frame of the positions: for small
//! rotations they are the differences of the three angles.
//!
//! Source: ISO 9283:1998, 7.2, from memory: read the standard before claiming conformity; `docs/theory/calibration.md`.

use nalgebra::{UnitQuaternion, Vector3};

/// Number of cycles required by the standard.
pub const CYCLES: usize = 30;

/// An attained pose: position (m) and, if it was measured, orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attained {
    /// m
    pub position: Vector3<f64>,
    /// In the same axes.
    pub turn: Option<UnitQuaternion<f64>>,
}

/// Result of the cycles of one pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAccuracy {
    /// `n`
    pub cycles: usize,
    /// `m - c`, m.
    pub offset: Vector3<f64>,
    /// Barycentre, m.
    pub barycentre: Vector3<f64>,
    /// RP, m; `None` of one cycle.
    pub repeatability: Option<f64>,
    /// Rotation vector from the commanded to the mean orientation, rad; `None` where an orientation is missing.
    pub turn_offset: Option<Vector3<f64>>,
    /// RP of the rotations about x, y, z, rad; `None` of one cycle, or where an orientation is missing.
    pub turn_repeatability: Option<Vector3<f64>>,
}

impl PoseAccuracy {
    /// AP, m.
    pub fn accuracy(&self) -> f64 {
        self.offset.norm()
    }
}

/// Accuracy and repeatability of a pose; `None` without a cycle.
pub fn pose_accuracy(commanded: &Attained, cycles: &[Attained]) -> Option<PoseAccuracy> {
    if cycles.is_empty() {
        return None;
    }
    let count = cycles.len() as f64;
    let barycentre = cycles.iter().map(|cycle| cycle.position).sum::<Vector3<f64>>() / count;
    let distances: Vec<f64> = cycles
        .iter()
        .map(|cycle| (cycle.position - barycentre).norm())
        .collect();
    let mean = distances.iter().sum::<f64>() / count;
    let scatter = |of: &dyn Fn(usize) -> f64| {
        let squares: f64 = (0..cycles.len()).map(|j| of(j) * of(j)).sum();
        3.0 * (squares / (count - 1.0)).sqrt()
    };
    let many = cycles.len() > 1;
    let turns: Option<Vec<UnitQuaternion<f64>>> = cycles.iter().map(|cycle| cycle.turn).collect();
    let turned = turns.zip(commanded.turn).map(|(turns, commanded)| {
        let mean = mean_turn(&turns);
        let from_mean: Vec<Vector3<f64>> = turns
            .iter()
            .map(|turn| (turn * mean.inverse()).scaled_axis())
            .collect();
        ((mean * commanded.inverse()).scaled_axis(), from_mean)
    });
    Some(PoseAccuracy {
        cycles: cycles.len(),
        offset: barycentre - commanded.position,
        barycentre,
        repeatability: many.then(|| mean + scatter(&|j| distances[j] - mean)),
        turn_offset: turned.as_ref().map(|(offset, _)| *offset),
        turn_repeatability: turned
            .filter(|_| many)
            .map(|(_, from_mean)| Vector3::from_fn(|axis, _| scatter(&|j| from_mean[j][axis]))),
    })
}

/// vAP: the largest distance (m) of these barycentres; 0 of one.
pub fn multi_directional_variation(barycentres: &[Vector3<f64>]) -> f64 {
    let apart = |a: usize| (0..a).map(move |b| (barycentres[a] - barycentres[b]).norm());
    (0..barycentres.len()).flat_map(apart).fold(0.0, f64::max)
}

/// The mean of orientations that are near each other: rotation vectors from it sum to zero.
fn mean_turn(turns: &[UnitQuaternion<f64>]) -> UnitQuaternion<f64> {
    let mut mean = turns[0];
    // Each round leaves an error of the third power of the spread.
    for _ in 0..4 {
        let sum: Vector3<f64> = turns
            .iter()
            .map(|turn| (turn * mean.inverse()).scaled_axis())
            .sum();
        mean = UnitQuaternion::from_scaled_axis(sum / turns.len() as f64) * mean;
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, z: f64) -> Attained {
        Attained {
            position: Vector3::new(x, y, z),
            turn: None,
        }
    }

    #[test]
    fn accuracy_and_repeatability_are_those_computed_by_hand() {
        let found = pose_accuracy(&at(0.0, 0.0, 0.0), &[at(1.0, 1.0, 0.0), at(3.0, 1.0, 0.0)]).unwrap();
        assert_eq!(found.offset, Vector3::new(2.0, 1.0, 0.0));
        assert!((found.accuracy() - 5f64.sqrt()).abs() < 1e-15);
        // Both 1 from the barycentre: no scatter of the distances.
        assert!((found.repeatability.unwrap() - 1.0).abs() < 1e-15);
        let three = [at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0)];
        let found = pose_accuracy(&at(1.0, 0.0, 0.0), &three).unwrap();
        // Distances 1, 1, 2: mean 4/3, deviations -1/3, -1/3, 2/3, S = sqrt(6/9/2).
        assert!((found.repeatability.unwrap() - (4.0 / 3.0 + 3.0 * (1.0f64 / 3.0).sqrt())).abs() < 1e-14);
        assert_eq!(found.turn_offset, None);
    }

    #[test]
    fn rotations_are_reported_by_their_mean_and_scatter_about_each_axis() {
        let turned = |x: f64| Attained {
            position: Vector3::zeros(),
            turn: Some(UnitQuaternion::from_scaled_axis(Vector3::x() * x)),
        };
        let found = pose_accuracy(&turned(0.1), &[turned(0.2), turned(0.4)]).unwrap();
        assert!((found.turn_offset.unwrap() - Vector3::x() * 0.2).norm() < 1e-12);
        let expected = Vector3::x() * (3.0 * 0.02f64.sqrt());
        assert!((found.turn_repeatability.unwrap() - expected).norm() < 1e-12);
    }

    #[test]
    fn one_cycle_has_no_repeatability_and_none_no_accuracy() {
        let found = pose_accuracy(&at(0.0, 0.0, 0.0), &[at(0.0, 1.0, 0.0)]).unwrap();
        assert_eq!((found.accuracy(), found.repeatability), (1.0, None));
        assert_eq!(pose_accuracy(&at(0.0, 0.0, 0.0), &[]), None);
    }

    #[test]
    fn variation_with_direction_is_the_largest_distance() {
        let centres = [0.0, 2.0, -1.0].map(|x| Vector3::new(x, 0.0, 0.0));
        assert_eq!(multi_directional_variation(&centres), 3.0);
        assert_eq!(multi_directional_variation(&centres[..1]), 0.0);
    }
}
