//! Alignment of measured points to a nominal surface: the best fit by steps of least squares, and what it removes.
//!
//! ```text
//! min over the motion M of  sum of w (d(M p) - r)^2
//! step:  d + n (u + v x (M p - c)) - r,   solved for u and v; foot points are found again after each step
//! covariance of (u, v):  s^2 (J^T W J)^-1,   s^2 = sum of w (d - r)^2 / (n - 6)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `p`, `w` | measured point and its weight | m, - |
//! | `d`, `n` | deviation from the surface and its direction there | m, - |
//! | `r` | radius of the probe, if points are its centres | m |
//! | `u`, `v` | displacement, rotation about the centre `c` of the moved points | m, rad |
//!
//! The search is local: the start must be within a fraction of the smallest feature. Motions that the surface does not determine (a
//! plane slides along itself) are left as at the start and reported. Where the errors of neighbouring points are correlated,
//! the covariance is too small.
//! Source: Y. Chen, G. Medioni, Object modelling by registration of multiple range images, Image and Vision Computing 10,
//! 1992.

use nalgebra::{Matrix6, Point3, UnitQuaternion, Vector3, Vector6};
use rayon::prelude::*;

use super::error::FormError;
use super::plane::known;
use super::profile::NormalDeviation;
use super::surface::{FootPoint, NominalSurface};
use crate::frame::Isometry;

/// Points of the first steps.
const FEW: usize = 20_000;
/// Maximum number of steps.
const MOST_ROUNDS: usize = 60;
/// A step that moves no point by more than this part of their extent is the last.
const SETTLED: f64 = 1e-8;
/// Of few points a step below this part is sufficient.
const NEARLY_SETTLED: f64 = 1e-6;
/// Motions whose effect on deviations is below this part of that of the most effective one are not determined.
const FREE: f64 = 1e-5;
/// Points within this distance of each other are one place, m.
const ONE_PLACE: f64 = 1e-9;
/// Points that one thread takes at a time; sums are in this order, whatever the number of threads.
const POINTS_AT_ONCE: usize = 4_096;

/// What is given in addition to points and surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignmentOptions {
    /// Points are the centres of a probe of this radius, outside of the part, m.
    pub probe_radius: f64,
    /// Points farther from the surface than this are left out, m.
    pub farthest: f64,
}

impl Default for AlignmentOptions {
    fn default() -> AlignmentOptions {
        AlignmentOptions {
            probe_radius: 0.0,
            farthest: f64::INFINITY,
        }
    }
}

/// The motion that an alignment applies to measured points: what it hides from a map of deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// From measured points to the frame of the surface.
    pub motion: Isometry,
    /// Centre of the moved points, m.
    pub centre: Point3<f64>,
    /// Displacement of that centre relative to the start, m.
    pub translation: Vector3<f64>,
    /// Rotation vector relative to the start, rad.
    pub rotation: Vector3<f64>,
    /// Root mean square of the deviations at the start, m.
    pub rms_before: f64,
    /// The same after alignment, m.
    pub rms_after: f64,
    /// Covariance of displacement of the centre (m) and rotation (rad); zero along motions that are not determined.
    pub covariance: Matrix6<f64>,
    /// Motions that the surface does not determine, orthonormal: displacement in extents of the points, rotation in rad.
    pub free: Vec<Vector6<f64>>,
    /// Number of points used.
    pub used: usize,
    /// Number of points farther than the limit.
    pub left_out: usize,
    /// Steps done.
    pub rounds: usize,
}

impl Alignment {
    /// The part of the deviation that alignment removes at a point of the surface with this normal, m: to first order.
    pub fn removed(&self, at: &Point3<f64>, normal: &Vector3<f64>) -> f64 {
        -normal.dot(&(self.translation + self.rotation.cross(&(at - self.centre))))
    }
}

/// Deviations of moved points in order; `None` where the surface is farther than the limit.
pub fn deviations(
    points: &[Point3<f64>],
    surface: &NominalSurface,
    motion: &Isometry,
    options: &AlignmentOptions,
) -> Vec<Option<NormalDeviation>> {
    let of = |point: &Point3<f64>| {
        let foot = surface.foot(&(motion * point), options.farthest)?.deviation;
        Some(NormalDeviation {
            deviation: foot.deviation - options.probe_radius,
            ..foot
        })
    };
    points.par_iter().map(of).collect()
}

/// Measured points with weights, each above 0; all 1 without weights.
#[derive(Clone, Copy, Debug)]
pub struct WeightedPoints<'a> {
    /// m
    pub points: &'a [Point3<f64>],
    /// One for each point.
    pub weights: Option<&'a [f64]>,
}

impl WeightedPoints<'_> {
    fn weight(&self, index: usize) -> f64 {
        self.weights.map_or(1.0, |weights| weights[index])
    }

    fn check(&self) -> Result<(), FormError> {
        known(self.points, 6)?;
        let Some(weights) = self.weights else {
            return Ok(());
        };
        if weights.len() != self.points.len() {
            return Err(FormError::Lengths {
                needed: self.points.len(),
                given: weights.len(),
            });
        }
        match weights
            .iter()
            .position(|weight| !(*weight > 0.0 && weight.is_finite()))
        {
            Some(index) => Err(FormError::NotFinite { index }),
            None => Ok(()),
        }
    }
}

/// The motion near `start` that brings points nearest to the surface.
///
/// # Errors
/// Fewer than six points within the limit, values that are not finite, weights that are not above 0, no convergence.
pub fn best_fit(
    measured: WeightedPoints<'_>,
    surface: &NominalSurface,
    start: &Isometry,
    options: &AlignmentOptions,
) -> Result<Alignment, FormError> {
    measured.check()?;
    let mut search = Search {
        measured,
        surface,
        options,
        nearest: vec![usize::MAX; measured.points.len()],
    };
    let stride = measured.points.len().div_ceil(FEW);
    let mut motion = *start;
    let before = search.sums(&motion, 1)?;
    let mut rounds = 0;
    for (stride, settled) in [(stride, NEARLY_SETTLED), (1, SETTLED)] {
        if stride == 1 && settled == NEARLY_SETTLED {
            continue;
        }
        loop {
            let sums = search.sums(&motion, stride)?;
            let step = Step::of(&sums);
            rounds += 1;
            motion = step.applied(&sums, &motion);
            if step.size() <= settled {
                break;
            }
            if rounds >= MOST_ROUNDS {
                return Err(FormError::NotFound { rounds });
            }
        }
    }
    let after = search.sums(&motion, 1)?;
    let step = Step::of(&after);
    let relative = motion * start.inverse();
    // The centre before the motion relative to the start.
    let from = relative.inverse_transform_point(&after.centre);
    Ok(Alignment {
        motion,
        centre: after.centre,
        translation: after.centre - from,
        rotation: relative.rotation.scaled_axis(),
        rms_before: before.rms(),
        rms_after: after.rms(),
        covariance: step.covariance(&after),
        free: step.free,
        used: after.count,
        left_out: measured.points.len() - after.count,
        rounds,
    })
}

struct Search<'a> {
    measured: WeightedPoints<'a>,
    surface: &'a NominalSurface,
    options: &'a AlignmentOptions,
    /// Triangle of each point's last foot.
    nearest: Vec<usize>,
}

/// Sums over points; rotations are about the centre, in displacements at the extent.
struct Sums {
    normal: Matrix6<f64>,
    right: Vector6<f64>,
    squares: f64,
    weights: f64,
    count: usize,
    centre: Point3<f64>,
    extent: f64,
}

impl Sums {
    fn rms(&self) -> f64 {
        (self.squares / self.weights).sqrt()
    }
}

impl Search<'_> {
    /// The sums over every `stride`-th point.
    fn sums(&mut self, motion: &Isometry, stride: usize) -> Result<Sums, FormError> {
        let (surface, options, measured) = (self.surface, self.options, self.measured);
        let chosen: Vec<usize> = (0..measured.points.len()).step_by(stride).collect();
        let nearest = &self.nearest;
        let foot = |index: &usize| {
            surface.foot_near(
                &(motion * measured.points[*index]),
                options.farthest,
                nearest[*index],
            )
        };
        let feet: Vec<Option<FootPoint>> = chosen.par_iter().with_min_len(64).map(foot).collect();
        for (index, foot) in chosen.iter().zip(&feet) {
            if let Some(foot) = foot {
                self.nearest[*index] = foot.triangle;
            }
        }
        let used: Vec<(usize, FootPoint)> = chosen
            .iter()
            .zip(feet)
            .filter_map(|(index, foot)| Some((*index, foot?)))
            .collect();
        if used.len() < 6 {
            return Err(FormError::TooFew {
                needed: 6,
                given: used.len(),
            });
        }
        let moved = |index: usize| motion * measured.points[index];
        let sum: Vector3<f64> = used.iter().map(|(index, _)| moved(*index).coords).sum();
        let centre = Point3::from(sum / used.len() as f64);
        let extent = used
            .iter()
            .map(|(index, _)| (moved(*index) - centre).norm())
            .fold(0.0, f64::max);
        if extent <= ONE_PLACE {
            return Err(FormError::Undetermined);
        }
        let mut sums = Sums {
            normal: Matrix6::zeros(),
            right: Vector6::zeros(),
            squares: 0.0,
            weights: 0.0,
            count: used.len(),
            centre,
            extent,
        };
        let block = |used: &[(usize, FootPoint)]| {
            let (mut normal, mut right, mut squares, mut weights) =
                (Matrix6::zeros(), Vector6::zeros(), 0.0, 0.0);
            for (index, foot) in used {
                let weight = measured.weight(*index);
                let off = foot.deviation.deviation - options.probe_radius;
                let direction = foot.deviation.normal;
                let turn = (moved(*index) - centre).cross(&direction) / extent;
                let row = Vector6::new(direction.x, direction.y, direction.z, turn.x, turn.y, turn.z);
                normal += row * row.transpose() * weight;
                right -= row * (off * weight);
                squares += off * off * weight;
                weights += weight;
            }
            (normal, right, squares, weights)
        };
        let blocks: Vec<_> = used.par_chunks(POINTS_AT_ONCE).map(block).collect();
        for (normal, right, squares, weights) in blocks {
            sums.normal += normal;
            sums.right += right;
            sums.squares += squares;
            sums.weights += weights;
        }
        Ok(sums)
    }
}

/// A small motion: displacement, and rotation in displacements at the extent.
struct Step {
    by: Vector6<f64>,
    inverse: Matrix6<f64>,
    free: Vec<Vector6<f64>>,
    extent: f64,
}

impl Step {
    fn of(sums: &Sums) -> Step {
        let eigen = sums.normal.symmetric_eigen();
        let most = eigen.eigenvalues.max();
        let mut inverse = Matrix6::zeros();
        let mut free = Vec::new();
        for k in 0..6 {
            let direction = eigen.eigenvectors.column(k).into_owned();
            match eigen.eigenvalues[k] > FREE * FREE * most {
                true => inverse += direction * direction.transpose() / eigen.eigenvalues[k],
                false => free.push(direction),
            }
        }
        Step {
            by: inverse * sums.right,
            inverse,
            free,
            extent: sums.extent,
        }
    }

    /// In extents of the points.
    fn size(&self) -> f64 {
        self.by.amax() / self.extent
    }

    fn applied(&self, sums: &Sums, motion: &Isometry) -> Isometry {
        let [u, v] =
            [self.by.fixed_rows::<3>(0), self.by.fixed_rows::<3>(3)].map(nalgebra::Matrix::into_owned);
        let turn = UnitQuaternion::from_scaled_axis(v / self.extent);
        let centre = sums.centre.coords;
        let about = Isometry::from_parts((centre + u - turn * centre).into(), turn);
        about * motion
    }

    /// Covariance of the displacement of the centre and the rotation, m and rad.
    fn covariance(&self, sums: &Sums) -> Matrix6<f64> {
        let determined = 6 - self.free.len();
        let freedom = sums.count.saturating_sub(determined).max(1) as f64;
        // A factor of all weights cancels.
        let variance = sums.squares / freedom;
        let scale = Matrix6::from_diagonal(&Vector6::from_fn(
            |k, _| if k < 3 { 1.0 } else { 1.0 / self.extent },
        ));
        scale * self.inverse * scale * variance
    }
}

#[cfg(test)]
mod tests;
