//! Learnt residual: what the model of an arm leaves of its measured positions, as a Gaussian process of the joint positions.
//!
//! ```text
//! k(q, q') = exp(-1/2 sum_j d_j^2 / l_j^2)      d_j = 2 sin((q_j - q'_j) / 2) of revolute joints, q_j - q'_j of prismatic ones
//! C = K + n^2 I      s_c^2 = y_c' C^-1 y_c / N
//! mean_c(q) = k(q)' C^-1 y_c      u_c^2(q) = s_c^2 (1 - k(q)' C^-1 k(q) + n^2)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `y_c` | component c of the residuals: measured minus modelled position of the tool, `N` poses | m |
//! | `l_j` | length scale of joint j | rad (chord of the unit circle), m |
//! | `n` | scatter between neighbouring poses, relative to `s_c` | 1 |
//! | `s_c` | standard deviation of component c over all postures | m |
//!
//! Components: along the axes of the base, or of the base rotated with the first joint: errors of the joints behind it rotate
//! with it. Far from every measured posture the mean is zero and `u_c` is `s_c sqrt(1 + n^2)`: nothing is corrected there, and the
//! uncertainty is that of an arm without correction. The scatter is part of `u_c`: with it the next measured pose is predicted.
//!
//! Valid for the measured point of the flange: rotations are not learnt, so that the residual of a much longer tool is unknown.
//! Source: Rasmussen and Williams, Gaussian Processes for Machine Learning, MIT Press 2006, equations 2.23, 2.24, 5.1.

use std::sync::Arc;

use nalgebra::{Rotation3, Unit, Vector3};

/// Most poses of a learnt residual: an evaluation takes their square.
pub const MOST_POSES: usize = 2000;
/// Largest residual, m: a larger one is not of an arm that has been calibrated.
pub const LARGEST_RESIDUAL: f64 = 0.1;
/// Added to the diagonal, so that poses measured twice do not make it singular.
const JITTER: f64 = 1e-10;

/// The axes of the components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LearntAxes {
    /// Of the base.
    Base,
    /// Of the base rotated with the first joint.
    FirstJoint,
}

impl LearntAxes {
    /// These axes at `q`, in the base.
    fn at(self, first: Option<FirstJoint>, q: &[f64]) -> Rotation3<f64> {
        match (self, first, q.first()) {
            (LearntAxes::FirstJoint, Some(first), Some(q)) => {
                Rotation3::from_axis_angle(&first.axis, first.sign * q)
            }
            _ => Rotation3::identity(),
        }
    }
}

/// What the process needs of the kinematics of an arm.
#[derive(Clone, Debug)]
pub(super) struct LearntKinematics {
    /// Whether each joint is prismatic.
    pub slides: Vec<bool>,
    /// The first joint, if it turns.
    pub first: Option<FirstJoint>,
    /// Whether the arm stands on its base, without links before the first joint that move.
    pub is_on_base: bool,
}

impl LearntKinematics {
    /// Components of the residuals along these axes, m.
    pub fn components(&self, poses: &[ResidualAt], axes: LearntAxes) -> Vec<Vector3<f64>> {
        let along = |pose: &ResidualAt| axes.at(self.first, &pose.joints).inverse() * pose.residual;
        poses.iter().map(along).collect()
    }
}

/// The settings of a Gaussian process.
#[derive(Clone, Debug, PartialEq)]
pub struct LearntSettings {
    /// Length scale of each joint, rad (m).
    pub lengths: Vec<f64>,
    /// Scatter between neighbouring poses relative to the standard deviation over all postures.
    pub noise: f64,
    /// The axes of the components.
    pub axes: LearntAxes,
}

/// A posture and the residual there.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualAt {
    /// Controller coordinates, rad or m.
    pub joints: Vec<f64>,
    /// Measured minus modelled position, m, base.
    pub residual: Vector3<f64>,
}

/// Why a residual cannot be learnt or used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LearntError {
    /// Too few or too many poses.
    #[error("{0} poses: from {FEWEST_POSES} to {MOST_POSES} are needed")]
    Poses(usize),
    /// A pose of another robot, or with a number that is not valid.
    #[error("pose number {}: {what}", .index + 1)]
    Pose {
        /// From 0.
        index: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// A length scale or scatter out of range.
    #[error("{0} is {1}: a number from 1e-3 to 1e4 is needed")]
    Setting(&'static str, f64),
    /// Another number of length scales than joints.
    #[error("{lengths} length scales for {joints} joints")]
    Lengths {
        /// Given.
        lengths: usize,
        /// Of the robot.
        joints: usize,
    },
    /// All residuals are zero.
    #[error("all residuals are zero: there is nothing to learn")]
    Nothing,
    /// An arm whose joints are not those that were measured.
    #[error("a learnt residual is not known of an arm with a positioner or with the part in its hand")]
    Ground,
}

/// Fewest poses.
pub const FEWEST_POSES: usize = 8;

/// The residual of an arm as a function of its joint positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Learnt {
    settings: LearntSettings,
    slides: Vec<bool>,
    first: Option<FirstJoint>,
    /// Features of each pose, one row after the other.
    features: Arc<Vec<f64>>,
    width: usize,
    /// Rows of the Cholesky factor of `C`, up to the diagonal.
    factor: Arc<Vec<f64>>,
    /// `C^-1 y`, one per pose.
    weights: Arc<Vec<Vector3<f64>>>,
    /// `s_c`, m.
    deviation: Vector3<f64>,
    /// Shift of the mean, in standard uncertainties along each axis: 0 but for an uncertain input.
    shift: Vector3<f64>,
}

/// A revolute first joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FirstJoint {
    pub axis: Unit<Vector3<f64>>,
    pub sign: f64,
}

/// The residual in a posture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearntResidual {
    /// Displacement of the tool, m, base.
    pub mean: Vector3<f64>,
    /// Its independent standard uncertainties, m, base.
    pub uncertainty: [Vector3<f64>; 3],
}

impl Learnt {
    /// The process with these settings, given these residuals of an arm with these kinematics.
    pub(super) fn of(
        arm: LearntKinematics,
        poses: &[ResidualAt],
        settings: LearntSettings,
    ) -> Result<Learnt, LearntError> {
        check(&arm, poses, &settings)?;
        let y = arm.components(poses, settings.axes);
        let mut learnt = Learnt {
            slides: arm.slides,
            first: arm.first,
            features: Arc::default(),
            width: 0,
            factor: Arc::default(),
            weights: Arc::default(),
            deviation: Vector3::zeros(),
            shift: Vector3::zeros(),
            settings,
        };
        let mut features = Vec::new();
        for pose in poses {
            learnt.put_features(&pose.joints, &mut features);
        }
        learnt.width = features.len() / poses.len();
        learnt.features = Arc::new(features);
        learnt.factor = Arc::new(learnt.factor_of(poses.len()));
        let mut weights = y.clone();
        learnt.solve_lower(&mut weights);
        learnt.solve_upper(&mut weights);
        let sums = y.iter().zip(&weights).map(|(y, w)| y.component_mul(w));
        let variance = sums.sum::<Vector3<f64>>() / poses.len() as f64;
        learnt.deviation = variance.map(|variance| variance.max(0.0).sqrt());
        learnt.weights = Arc::new(weights);
        match learnt.deviation.norm() > 0.0 {
            true => Ok(learnt),
            false => Err(LearntError::Nothing),
        }
    }

    /// The settings.
    pub fn settings(&self) -> &LearntSettings {
        &self.settings
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.slides.len()
    }

    /// Number of poses.
    pub fn poses(&self) -> usize {
        self.weights.len()
    }

    /// Standard deviation over all postures along each of the axes, m.
    pub fn deviation(&self) -> Vector3<f64> {
        self.deviation
    }

    /// This residual with its mean shifted by one standard uncertainty along axis `component`, in every posture.
    pub fn shifted(&self, component: usize) -> Learnt {
        Learnt {
            shift: self.shift + Vector3::ith(component, 1.0),
            ..self.clone()
        }
    }

    /// This residual with its mean shifted by these numbers of standard uncertainties along its axes, in every posture.
    pub fn shifted_by(&self, by: &Vector3<f64>) -> Learnt {
        Learnt {
            shift: self.shift + by,
            ..self.clone()
        }
    }

    /// The mean residual (m, base) at the joint positions `q`, rad (m).
    pub fn mean(&self, q: &[f64]) -> Vector3<f64> {
        if self.shift != Vector3::zeros() {
            return self.at(q).mean;
        }
        let near = self.near(q);
        self.axes_at(q) * self.mean_by(&near)
    }

    /// Residual and uncertainty at the joint positions `q`, rad (m).
    pub fn at(&self, q: &[f64]) -> LearntResidual {
        let mut near = self.near(q);
        let (axes, mean) = (self.axes_at(q), self.mean_by(&near));
        self.solve_lower(&mut near);
        let explained: f64 = near.iter().map(|v| v * v).sum();
        let scale = ((1.0 - explained).max(0.0) + self.settings.noise.powi(2)).sqrt();
        let u = self.deviation * scale;
        let along = |c: usize| axes * (Vector3::ith(c, 1.0) * u[c]);
        LearntResidual {
            mean: axes * (mean + u.component_mul(&self.shift)),
            uncertainty: [along(0), along(1), along(2)],
        }
    }

    /// Nearness to the measured postures: 0 where nothing was measured, 1 at a measured posture without scatter.
    pub fn weight(&self, q: &[f64]) -> f64 {
        let mut near = self.near(q);
        self.solve_lower(&mut near);
        near.iter().map(|v| v * v).sum()
    }

    fn mean_by(&self, near: &[f64]) -> Vector3<f64> {
        near.iter()
            .zip(self.weights.iter())
            .map(|(k, weight)| weight * *k)
            .sum()
    }

    /// `k(q)`.
    fn near(&self, q: &[f64]) -> Vec<f64> {
        let mut own = Vec::with_capacity(self.width);
        self.put_features(q, &mut own);
        let rows = self.features.chunks_exact(self.width);
        rows.map(|row| (-0.5 * squared_distance(row, &own)).exp())
            .collect()
    }

    /// Adds the features of a posture, in units of the length scales: their distance is that of the kernel.
    fn put_features(&self, q: &[f64], features: &mut Vec<f64>) {
        for ((q, length), slides) in q.iter().zip(&self.settings.lengths).zip(&self.slides) {
            match slides {
                true => features.push(q / length),
                false => features.extend([q.cos() / length, q.sin() / length]),
            }
        }
    }

    /// The axes of the components at `q`.
    fn axes_at(&self, q: &[f64]) -> Rotation3<f64> {
        self.settings.axes.at(self.first, q)
    }

    /// Cholesky factor of `C`, row by row.
    fn factor_of(&self, count: usize) -> Vec<f64> {
        let diagonal = 1.0 + self.settings.noise.powi(2) + JITTER;
        let mut factor: Vec<f64> = Vec::with_capacity(count * (count + 1) / 2);
        for i in 0..count {
            let start = factor.len();
            let own = &self.features[i * self.width..(i + 1) * self.width];
            for j in 0..i {
                let other = &self.features[j * self.width..(j + 1) * self.width];
                let k = (-0.5 * squared_distance(own, other)).exp();
                let above = row(&factor, j);
                let sum = dot(&factor[start..], &above[..j]);
                factor.push((k - sum) / above[j]);
            }
            let own = &factor[start..];
            let left = diagonal - dot(own, own);
            factor.push(left.max(JITTER).sqrt());
        }
        factor
    }

    /// Solves `L x = b` in place.
    fn solve_lower<T>(&self, b: &mut [T])
    where
        T: Copy + std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T> + std::iter::Sum,
    {
        for i in 0..b.len() {
            let l = row(&self.factor, i);
            let sum: T = b[..i].iter().zip(l).map(|(b, l)| *b * *l).sum();
            b[i] = (b[i] - sum) * (1.0 / l[i]);
        }
    }

    /// Solves `L' x = b` in place.
    fn solve_upper(&self, b: &mut [Vector3<f64>]) {
        for i in (0..b.len()).rev() {
            let l = row(&self.factor, i);
            b[i] /= l[i];
            let own = b[i];
            for (b, l) in b[..i].iter_mut().zip(l) {
                *b -= own * *l;
            }
        }
    }
}

/// Row `i` of a triangle that is stored row by row.
fn row(factor: &[f64], i: usize) -> &[f64] {
    let start = i * (i + 1) / 2;
    &factor[start..=start + i]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Range of length scales and scatter.
const SETTINGS: std::ops::RangeInclusive<f64> = 1e-3..=1e4;

fn check(arm: &LearntKinematics, poses: &[ResidualAt], settings: &LearntSettings) -> Result<(), LearntError> {
    let joints = arm.slides.len();
    if !arm.is_on_base {
        return Err(LearntError::Ground);
    }
    if settings.lengths.len() != joints {
        let lengths = settings.lengths.len();
        return Err(LearntError::Lengths { lengths, joints });
    }
    let lengths = settings.lengths.iter().map(|length| ("a length scale", *length));
    for (what, value) in lengths.chain([("the scatter", settings.noise)]) {
        if !SETTINGS.contains(&value) {
            return Err(LearntError::Setting(what, value));
        }
    }
    if !(FEWEST_POSES..=MOST_POSES).contains(&poses.len()) {
        return Err(LearntError::Poses(poses.len()));
    }
    for (index, pose) in poses.iter().enumerate() {
        let what = if pose.joints.len() != joints {
            "it has another number of joints than the robot"
        } else if !pose.joints.iter().all(|q| q.is_finite()) {
            "it contains a joint position that is not finite"
        } else if pose.residual.iter().all(|part| part.abs() <= LARGEST_RESIDUAL) {
            continue;
        } else {
            "its residual is not a number up to 100 mm"
        };
        return Err(LearntError::Pose { index, what });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
