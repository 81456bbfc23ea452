//! Stability of milling by first-order semi-discretisation: multipliers of one period of the teeth, any directional factors.
//!
//! ```text
//! d2eta_m/dt2 + 2 zeta_m omega_m deta_m/dt + omega_m^2 eta_m = phi_m^T A(t) (u(t) - u(t - T)),   u = sum of phi_m eta_m
//! ```
//!
//! A period `T` of the teeth has `k` steps. In each step `A` is its mean over the step and the force is linear in time between the values
//! at its ends, so that modes have a closed transition (`modal_step`). The displacement at the end of a step appears in its own
//! force; as that acts through the tip alone, a system of 3 equations is solved in each step. The state is the modes at the begin of the period
//! and the displacement at the tip one period ago at those ends of steps where a tooth cuts: its transition over one period has the Floquet
//! multipliers as eigenvalues. The largest is found without forming the matrix (`arnoldi`).
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `eta_m`, `phi_m` | coordinate and shape (translation at the tip) of mode `m`, normalised by mass | m sqrt(kg), 1/sqrt(kg) |
//! | `A`, `T` | directional matrix ([`crate::load::Milling::directional_over_pitch`]), period of the teeth | N/m, s |
//! | `mu` | multiplier: growth over one period; the cut is stable if all are inside the unit circle | - |
//!
//! A multiplier that leaves the circle at a complex value is a secondary Hopf bifurcation (chatter at a frequency that is no multiple of half
//! the tooth passing frequency), at -1 a period doubling (flip), at +1 a fold. The error falls with the square of the step.
//!
//! Not modelled: loss of contact (an unstable cut grows without bound here), process damping, runout.
//!
//! Source: Insperger, Stepan, Updated semi-discretization method, Int. J. Numer. Meth. Engng 61 (2004) 117; with the present displacement
//! interpolated as the delayed one: Ding, Zhu, Zhang, Ding, Full-discretization, Int. J. Mach. Tools Manuf. 50 (2010) 502 \[both recalled\].

use std::f64::consts::TAU;

use nalgebra::{Complex, DVector, Matrix3, Vector3};

use super::arnoldi::dominant;
use super::cut_of_any_depth::CutOfAnyDepth;
use super::modal_step::ModalStep;
use super::zeroth_order::Boundary;
use crate::dynamics::Mode;
use crate::load::{CuttingError, Milling};

/// How a cut becomes unstable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instability {
    /// Complex multipliers: quasi-periodic chatter.
    Hopf,
    /// A multiplier of -1: every second tooth cuts alike.
    Flip,
    /// A multiplier of +1: the periodic cut loses its position.
    Fold,
}

/// The multiplier of largest modulus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floquet {
    /// With a nonnegative imaginary part.
    pub multiplier: Complex<f64>,
    /// How the cut is unstable, or would become so.
    pub instability: Instability,
}

/// PeriodSteps of a period from given ones, or as many as the modes need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeriodSteps {
    /// A quarter of a radian of the fastest mode in each, from 40 to 800; more, to 3000, if fewer than 40 of them are in the cut.
    ByFastestMode,
    /// This many, at least 1.
    Given(usize),
}

/// The transition over one period.
struct Period {
    shapes: Vec<Vector3<f64>>,
    omegas: Vec<f64>,
    transitions: Vec<ModalStep>,
    steps: Vec<Step>,
    /// Displacement at the tip by a force at the end of a step, m/N.
    compliance: Matrix3<f64>,
    /// Position of the tip at the begin of each step in the state; `None` where no tooth cuts on either side.
    stored: Vec<Option<usize>>,
    dimension: usize,
    /// Displacement at the tip that one unit of the scaled state stands for, m.
    unit: f64,
}

/// Mean directional matrix, and the inverse of `1 - compliance` times it; `None` where no tooth cuts.
type Step = Option<[Matrix3<f64>; 2]>;

/// Turn of the fastest mode in a step, rad, and bounds of the number of steps.
const TURN: f64 = 0.25;
const STEPS: [f64; 2] = [40.0, 800.0];
/// Least number of steps in which a tooth cuts, and most steps for that.
const IN_CUT: usize = 40;
const MOST_STEPS: usize = 3000;
/// Imaginary part over modulus below which a multiplier is real.
const REAL: f64 = 1e-5;
/// Depths tried in geometric steps, the least over the deepest, and halvings of the interval found.
const DEPTHS: usize = 28;
const LEAST_DEPTH: f64 = 3e-3;
const HALVINGS: usize = 16;
/// Halvings of the least depth while it is unstable.
const MOST_LOWERED: usize = 20;

impl Floquet {
    /// Whether vibrations decay.
    pub fn is_stable(&self) -> bool {
        self.multiplier.norm() < 1.0
    }

    /// Angular frequency of chatter (rad/s) for this period of the teeth (s): of those with this multiplier the one closest, relative to it, to
    /// a mode; with the index of that mode.
    pub fn frequency(&self, modes: &[Mode], period: f64) -> (f64, usize) {
        let (base, passing) = (self.multiplier.arg() / period, TAU / period);
        let mut best = (f64::INFINITY, 0.0, 0);
        for (index, mode) in modes.iter().enumerate() {
            let omega = mode.angular_frequency;
            for sign in [1.0, -1.0] {
                let turns = ((omega - sign * base) / passing).round();
                let w = (turns * passing + sign * base).abs();
                let distance = (w / omega - 1.0).abs();
                if distance < best.0 {
                    best = (distance, w, index);
                }
            }
        }
        (best.1, best.2)
    }
}

/// The multiplier of largest modulus of these modes (shapes in the feed frame) in this cut at this spindle speed (rad/s, above zero).
pub fn floquet(modes: &[Mode], milling: &Milling, spindle: f64, steps: PeriodSteps) -> Floquet {
    let period = Period::new(modes, milling, spindle, steps);
    let multiplier = dominant(period.dimension, |state| period.transition(state));
    let instability = match multiplier.im.abs() > REAL * multiplier.norm() {
        true => Instability::Hopf,
        false if multiplier.re < 0.0 => Instability::Flip,
        false => Instability::Fold,
    };
    Floquet {
        multiplier,
        instability,
    }
}

/// The lowest boundary of stability at this spindle speed (rad/s), with its instability; `None` if it is deeper than `deepest` (m).
///
/// Depths are tried in 28 geometric steps, so that an unstable interval narrower than a fifth of its depth may be missed.
///
/// # Errors
/// As [`Milling::new`].
pub fn boundary(
    modes: &[Mode],
    cutting: &CutOfAnyDepth,
    spindle: f64,
    deepest: f64,
) -> Result<Option<(Boundary, Instability)>, CuttingError> {
    let at = |depth: f64| -> Result<Floquet, CuttingError> {
        Ok(floquet(
            modes,
            &cutting.at_depth(depth)?,
            spindle,
            PeriodSteps::ByFastestMode,
        ))
    };
    let mut low = LEAST_DEPTH * deepest;
    for _ in 0..MOST_LOWERED {
        if at(low)?.is_stable() {
            break;
        }
        low *= 0.5;
    }
    let factor = (deepest / low).powf(1.0 / DEPTHS as f64);
    let mut high = low;
    let mut unstable = None;
    for _ in 0..DEPTHS {
        high = low * factor;
        let found = at(high)?;
        if !found.is_stable() {
            unstable = Some(found);
            break;
        }
        low = high;
    }
    let Some(mut found) = unstable else {
        return Ok(None);
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let here = at(middle)?;
        if here.is_stable() {
            low = middle;
        } else {
            (high, found) = (middle, here);
        }
    }
    let (angular_frequency, mode) = found.frequency(modes, cutting.pitch() / spindle);
    let boundary = Boundary {
        depth: 0.5 * (low + high),
        angular_frequency,
        mode,
    };
    Ok(Some((boundary, found.instability)))
}

impl Period {
    fn new(modes: &[Mode], milling: &Milling, spindle: f64, steps: PeriodSteps) -> Period {
        let duration = milling.cutter().pitch() / spindle;
        let directional = match steps {
            PeriodSteps::Given(count) => milling.directional_over_pitch(count.max(1)),
            PeriodSteps::ByFastestMode => {
                let fastest = modes
                    .iter()
                    .map(|mode| mode.angular_frequency)
                    .fold(0.0, f64::max);
                let count = (fastest * duration / TURN).ceil().clamp(STEPS[0], STEPS[1]) as usize;
                let first = milling.directional_over_pitch(count);
                let cuts = first.iter().filter(|step| step.amax() > 0.0).count();
                match cuts {
                    0 | IN_CUT.. => first,
                    _ => milling.directional_over_pitch((count * IN_CUT / cuts).min(MOST_STEPS)),
                }
            }
        };
        let count = directional.len();
        let h = duration / count as f64;
        let transitions: Vec<ModalStep> = modes.iter().map(|mode| ModalStep::new(mode, h)).collect();
        let shapes: Vec<Vector3<f64>> = modes
            .iter()
            .map(|mode| mode.shape.fixed_rows::<3>(0).into())
            .collect();
        let of_mode = |(shape, step): (&Vector3<f64>, &ModalStep)| shape * shape.transpose() * step.last[0];
        let compliance: Matrix3<f64> = shapes.iter().zip(&transitions).map(of_mode).sum();
        let steps: Vec<Step> = directional
            .into_iter()
            .map(|directional| {
                let inverse = (Matrix3::identity() - compliance * directional).try_inverse();
                inverse
                    .filter(|_| directional.amax() > 0.0)
                    .map(|inverse| [directional, inverse])
            })
            .collect();
        let mut dimension = 2 * modes.len();
        let mut stored = vec![None; count];
        for (index, place) in stored.iter_mut().enumerate() {
            let before = index > 0 && steps[index - 1].is_some();
            if before || steps[index].is_some() {
                *place = Some(dimension);
                dimension += 3;
            }
        }
        let omegas: Vec<f64> = modes.iter().map(|mode| mode.angular_frequency).collect();
        let reach = shapes
            .iter()
            .zip(&omegas)
            .map(|(shape, omega)| shape.norm() / omega);
        Period {
            unit: reach.fold(f64::MIN_POSITIVE, f64::max),
            shapes,
            omegas,
            transitions,
            steps,
            compliance,
            stored,
            dimension,
        }
    }

    fn tip(&self, modal: &[[f64; 2]]) -> Vector3<f64> {
        self.shapes.iter().zip(modal).map(|(shape, x)| shape * x[0]).sum()
    }

    /// The state one period later. Of mode `m` it has `omega_m (eta_m, v_m/omega_m)`.
    fn transition(&self, state: &DVector<f64>) -> DVector<f64> {
        let mut next = DVector::zeros(self.dimension);
        let mut modal: Vec<[f64; 2]> = self
            .omegas
            .iter()
            .enumerate()
            .map(|(m, omega)| [state[2 * m] / omega, state[2 * m + 1] / omega])
            .collect();
        let end_before = self.tip(&modal);
        let before = |index: usize| match self.stored.get(index) {
            Some(Some(place)) => state.fixed_rows::<3>(*place) * self.unit,
            _ => end_before,
        };
        for (index, step) in self.steps.iter().enumerate() {
            let tip = self.tip(&modal);
            if let Some(place) = self.stored[index] {
                next.fixed_rows_mut::<3>(place).copy_from(&(tip / self.unit));
            }
            let force = step.map(|[directional, _]| directional * (tip - before(index)));
            for ((x, transition), shape) in modal.iter_mut().zip(&self.transitions).zip(&self.shapes) {
                let load = force.map_or(0.0, |force| shape.dot(&force));
                let [[a, b], [c, d]] = transition.free;
                let [p, q] = transition.first;
                *x = [a * x[0] + b * x[1] + p * load, c * x[0] + d * x[1] + q * load];
            }
            if let Some([directional, inverse]) = step {
                let delayed = before(index + 1);
                let tip = inverse * (self.tip(&modal) - self.compliance * (directional * delayed));
                let force = directional * (tip - delayed);
                for ((x, transition), shape) in modal.iter_mut().zip(&self.transitions).zip(&self.shapes) {
                    let load = shape.dot(&force);
                    x[0] += transition.last[0] * load;
                    x[1] += transition.last[1] * load;
                }
            }
        }
        for ((m, x), omega) in modal.iter().enumerate().zip(&self.omegas) {
            next[2 * m] = x[0] * omega;
            next[2 * m + 1] = x[1] * omega;
        }
        next
    }
}

#[cfg(test)]
mod tests;
