//! Forced vibration under the teeth, and the error of the surface that it leaves.
//!
//! In a stable cut the displacement repeats with the teeth, so the surface of the tooth before is displaced alike: the regenerative term vanishes
//! and the vibration is the linear response to the force of the rigid cut.
//!
//! ```text
//! F(t) = sum over k of F_k e^(i k w_T t)        u(t) = sum over k of G(k w_T) F_k e^(i k w_T t)        w_T = 2 pi/T
//! wall on the left (up-milling): made at phi = 0,   error = u_y        on the right (down-milling): made at phi = 180 deg, error = -u_y
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `F`, `u` | force on the tool, displacement of its tip; feed frame | N, m |
//! | `G` | receptance at the tip (translation) | m/N |
//! | `error` | positive where the wall is deeper in the part than without vibration | m |
//!
//! With a helix the point of the edge at the height `z` makes the wall when the tip is ahead by the lag `psi(z)`. The error is evaluated at
//! [`HEIGHTS`] heights of the cylinder. The displacement of all heights is that of the tip. The mean force is included: `k = 0` is the static
//! deflection by the modes given.
//!
//! Runout is neglected. The force has [`STEPS`] values in a period and harmonics up to a quarter of them.
//!
//! Source: Altintas, Manufacturing Automation; Schmitz, Mann, Closed-form solutions for surface location error in milling, Int. J. Mach. Tools
//! Manuf. 46 (2006) 1369 \[both recalled\].

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, Vector3};

use crate::dynamics::{Mode, displacement};
use crate::load::{Cutter, CuttingError, Milling, Runout};

/// On which side of the feed the cut leaves a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallSide {
    /// Part on the left: up-milling.
    Left,
    /// Part on the right: down-milling.
    Right,
}

impl WallSide {
    /// The walls along the feed that this cut leaves: those that its engagement reaches.
    pub fn of(milling: &Milling) -> impl Iterator<Item = WallSide> + use<> {
        let radius = milling.cutter().radius();
        let [right, left] = milling.cut().engagement.edges();
        let reached = [
            (left >= radius, WallSide::Left),
            (right <= -radius, WallSide::Right),
        ];
        reached
            .into_iter()
            .filter_map(|(is_reached, side)| is_reached.then_some(side))
    }
}

/// Error of a wall: positive where it is deeper in the part (overcut).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceError {
    /// Side of the wall.
    pub side: WallSide,
    /// At the tip, m.
    pub at_tip: f64,
    /// Least along the cylinder, m.
    pub least: f64,
    /// Greatest along the cylinder, m.
    pub greatest: f64,
}

/// Harmonics of the force of the teeth on the tool, without runout.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothForces {
    /// `F_k` from 0 upwards, N, feed frame, over the angle of the spindle.
    harmonics: Vec<Vector3<Complex<f64>>>,
    cutter: Cutter,
    depth: f64,
}

impl SurfaceError {
    /// The largest along the cylinder by size, with its sign, m.
    pub fn largest(&self) -> f64 {
        if self.greatest.abs() >= self.least.abs() {
            self.greatest
        } else {
            self.least
        }
    }
}

/// The periodic vibration of the tip.
#[derive(Clone, Debug, PartialEq)]
pub struct Forced {
    /// Harmonics of the displacement from 0 upwards, m, feed frame, over the angle of the spindle.
    harmonics: Vec<Vector3<Complex<f64>>>,
    cutter: Cutter,
    depth: f64,
}

/// Values of the force in a period.
pub const STEPS: usize = 512;
/// Heights at which the error of the surface is evaluated.
pub const HEIGHTS: usize = 33;

impl ToothForces {
    /// Of this cut.
    ///
    /// # Errors
    /// As [`Milling::new`].
    pub fn new(milling: &Milling) -> Result<ToothForces, CuttingError> {
        let cutter = milling.cutter().with_runout(Runout::default())?;
        let even = Milling::new(cutter, *milling.law(), *milling.cut())?;
        let pitch = cutter.pitch();
        // Middles of the steps: no tooth enters or leaves exactly there.
        let middle = |step: usize| pitch * (step as f64 + 0.5) / STEPS as f64;
        let forces = even.forces_at((0..STEPS).map(middle));
        let turns: Vec<Complex<f64>> = (0..2 * STEPS)
            .map(|part| Complex::from_polar(1.0 / STEPS as f64, -TAU * part as f64 / (2 * STEPS) as f64))
            .collect();
        let harmonic = |order: usize| {
            let mut sum: Vector3<Complex<f64>> = Vector3::zeros();
            for (step, force) in forces.iter().enumerate() {
                let turn = turns[(order * (2 * step + 1)) % (2 * STEPS)];
                sum += force.map(|value| turn * value);
            }
            sum
        };
        Ok(ToothForces {
            harmonics: (0..=STEPS / 4).map(harmonic).collect(),
            cutter,
            depth: milling.cut().depth,
        })
    }
}

impl Forced {
    /// Of these modes (shapes in the feed frame) in this cut at this spindle speed (rad/s, above zero).
    ///
    /// # Errors
    /// As [`Milling::new`].
    pub fn new(modes: &[Mode], milling: &Milling, spindle: f64) -> Result<Forced, CuttingError> {
        Ok(Forced::under(&ToothForces::new(milling)?, modes, spindle))
    }

    /// Of these modes (shapes in the feed frame) under these forces at this spindle speed (rad/s, above zero).
    pub fn under(forces: &ToothForces, modes: &[Mode], spindle: f64) -> Forced {
        let passing = TAU / forces.cutter.pitch() * spindle;
        let harmonics = forces.harmonics.iter().enumerate();
        Forced {
            harmonics: harmonics
                .map(|(order, force)| displacement(modes, order as f64 * passing, force))
                .collect(),
            cutter: forces.cutter,
            depth: forces.depth,
        }
    }

    /// The same without the mean displacement.
    #[must_use]
    pub fn without_mean(mut self) -> Forced {
        if let Some(mean) = self.harmonics.first_mut() {
            *mean = Vector3::zeros();
        }
        self
    }

    /// Largest distance across the tool of the tip from its mean position, m.
    pub fn largest_in_plane(&self) -> f64 {
        let mean = self.mean().xy();
        let distances = self.path().into_iter().map(|u| (u.xy() - mean).norm());
        distances.fold(0.0, f64::max)
    }

    /// Displacement (m, feed frame) of the tip when tooth 0 at the tip is at this angle of the spindle (rad).
    pub fn at_angle(&self, angle: f64) -> Vector3<f64> {
        let turn = Complex::from_polar(1.0, TAU * angle / self.cutter.pitch());
        let mut power = Complex::new(1.0, 0.0);
        let mut sum = Vector3::zeros();
        for (order, harmonic) in self.harmonics.iter().enumerate() {
            // Harmonics of negative order are conjugate.
            let weight = if order == 0 { 1.0 } else { 2.0 };
            sum += harmonic.map(|part| (part * power).re * weight);
            power *= turn;
        }
        sum
    }

    /// Mean displacement, m, feed frame.
    pub fn mean(&self) -> Vector3<f64> {
        self.harmonics[0].map(|part| part.re)
    }

    /// Half the largest range of each component over a period, m, feed frame.
    pub fn amplitude(&self) -> Vector3<f64> {
        let path = self.path();
        let reduce = |f: fn(f64, f64) -> f64, start: f64| {
            path.iter()
                .fold(Vector3::repeat(start), |bound, u| bound.zip_map(u, f))
        };
        (reduce(f64::max, f64::MIN) - reduce(f64::min, f64::MAX)) * 0.5
    }

    /// Displacements over one period, in even steps of the spindle.
    pub fn path(&self) -> Vec<Vector3<f64>> {
        let turns: Vec<Complex<f64>> = (0..STEPS)
            .map(|step| Complex::from_polar(1.0, TAU * step as f64 / STEPS as f64))
            .collect();
        let mut powers = vec![Complex::new(1.0, 0.0); STEPS];
        let mut path = vec![self.mean(); STEPS];
        // Harmonics of negative order are conjugate.
        for harmonic in self.harmonics.iter().skip(1) {
            for ((power, turn), sum) in powers.iter_mut().zip(&turns).zip(&mut path) {
                *power *= turn;
                *sum += harmonic.map(|part| 2.0 * (part.re * power.re - part.im * power.im));
            }
        }
        path
    }

    /// Error of the wall on this side.
    pub fn surface_error(&self, side: WallSide) -> SurfaceError {
        let (angle, sign) = match side {
            WallSide::Left => (0.0, 1.0),
            WallSide::Right => (PI, -1.0),
        };
        let corner = self.cutter.corner_radius().min(self.depth);
        let error = |height: f64| sign * self.at_angle(angle + self.cutter.lag(height)).y;
        let heights = (0..HEIGHTS).map(|k| corner + (self.depth - corner) * k as f64 / (HEIGHTS - 1) as f64);
        let along: Vec<f64> = heights.map(error).collect();
        SurfaceError {
            side,
            at_tip: along[0],
            least: along.iter().copied().fold(f64::INFINITY, f64::min),
            greatest: along.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

#[cfg(test)]
mod tests;
