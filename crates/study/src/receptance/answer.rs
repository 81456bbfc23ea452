//! Receptance at a tip as one JSON value, feed frame.
//!
//! Keys and units are a public contract: Hz, um/N, urad/N, urad/(N m), N/um, per cent, kg. Translation by a moment is the transpose of rotation by
//! a force, as the receptance is symmetric: um/(N m) of one are urad/N of the other.

use std::f64::consts::TAU;

use armill_core::dynamics::Mode;
use armill_core::dynamics::coupling::Swept;
use armill_core::nalgebra::{Complex, Matrix3, Matrix6};
use armill_core::units::{to_per_um, to_um, to_urad};
use schemars::JsonSchema;
use serde::Serialize;

use super::evaluate::{Evaluation, Question};
use crate::number::digits;

/// Significant digits.
const DIGITS: i32 = 7;
/// A fit that deviates by more is reported, per cent of the largest receptance.
const POOR_PERCENT: f64 = 5.0;

/// Receptance at the tip of a tool.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ReceptanceAnswer {
    /// What the tool assembly is attached to.
    pub machine: String,
    /// Name of the tool assembly.
    pub assembly: String,
    /// Its source.
    pub assembly_source: String,
    /// x, y and z of the feed frame: stiffness at the tip.
    pub directions: Vec<DirectionAnswer>,
    /// Modes of the tip, frequencies rising.
    pub modes: Vec<TipModeAnswer>,
    /// Largest deviation of the modes alone from the receptance in x, y, z, of the largest receptance of all directions; null without modes.
    pub fit_deviation_percent: Option<[f64; 3]>,
    /// Receptance at each frequency, rising.
    pub receptance: Vec<ReceptanceAtFrequency>,
    /// What was assumed or neglected.
    pub notes: Vec<String>,
}

/// Stiffness in one direction.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DirectionAnswer {
    /// `x`, `y` or `z`.
    pub direction: String,
    /// At rest.
    pub static_stiffness_n_per_um: f64,
    /// The least magnitude of force by displacement over the frequencies.
    pub least_dynamic_stiffness_n_per_um: f64,
    /// Where it is.
    pub at_frequency_hz: f64,
    /// The same at the spindle nose without the assembly; null if it does not move.
    pub nose_least_dynamic_stiffness_n_per_um: Option<f64>,
}

/// A mode of the tip.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TipModeAnswer {
    /// Undamped natural frequency.
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_percent: f64,
    /// Direction in which the tip moves.
    pub direction: [f64; 3],
    /// Modal mass in this direction.
    pub modal_mass_kg: f64,
    /// Modal stiffness in this direction.
    pub stiffness_n_per_um: f64,
}

/// Receptance at one frequency: rows are displacements along or about x, y, z, columns forces or moments.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ReceptanceAtFrequency {
    /// Frequency.
    pub frequency_hz: f64,
    /// Translation by a force, real part.
    pub translation_by_force_real_um_per_n: [[f64; 3]; 3],
    /// Its imaginary part.
    pub translation_by_force_imag_um_per_n: [[f64; 3]; 3],
    /// Rotation by a force, real part; transposed, translation by a moment, um/(N m).
    pub rotation_by_force_real_urad_per_n: [[f64; 3]; 3],
    /// Its imaginary part.
    pub rotation_by_force_imag_urad_per_n: [[f64; 3]; 3],
    /// Rotation by a moment, real part.
    pub rotation_by_moment_real_urad_per_n_m: [[f64; 3]; 3],
    /// Its imaginary part.
    pub rotation_by_moment_imag_urad_per_n_m: [[f64; 3]; 3],
}

/// The values of an evaluation.
pub fn answer(question: &Question, evaluation: &Evaluation) -> ReceptanceAnswer {
    let fit = evaluation.fit.as_ref();
    let deviation = fit.ok().map(|fit| fit.deviation.map(|part| number(100.0 * part)));
    let mut notes: Vec<String> = question.machine.notes.clone();
    notes.extend(question.assembly.note.clone());
    notes.extend(question.assembly.assumptions.iter().cloned());
    if let Err(why) = &evaluation.fit {
        notes.push(format!("the receptance has no modes: {why}"));
    }
    for (axis, percent) in ["x", "y", "z"].into_iter().zip(deviation.into_iter().flatten()) {
        if percent > POOR_PERCENT {
            notes.push(format!(
                "modes describe the receptance in {axis} only to {percent:.0} % of the largest value: modes outside the frequencies take part; widen --frequencies-hz"
            ));
        }
    }
    ReceptanceAnswer {
        machine: question.machine.name.clone(),
        assembly: question.assembly.name.clone(),
        assembly_source: question.assembly.source.clone(),
        directions: (0..3).filter_map(|axis| direction(evaluation, axis)).collect(),
        modes: fit.map_or_else(|_| Vec::new(), |fit| fit.modes.iter().map(mode).collect()),
        fit_deviation_percent: deviation,
        receptance: evaluation.swept.iter().map(at_frequency).collect(),
        notes,
    }
}

fn number(value: f64) -> f64 {
    digits(value, DIGITS)
}

/// Stiffness along axis `k`; `None` without frequencies.
fn direction(evaluation: &Evaluation, k: usize) -> Option<DirectionAnswer> {
    let most = |part: &dyn Fn(&Swept) -> f64| {
        let all = evaluation.swept.iter().map(|own| (own.w, part(own)));
        all.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (w, tip) = most(&|own| own.tip[(k, k)].norm())?;
    let (_, nose) = most(&|own| own.base[(k, k)].norm())?;
    Some(DirectionAnswer {
        direction: ["x", "y", "z"][k].to_owned(),
        static_stiffness_n_per_um: number(to_per_um(1.0 / evaluation.at_rest[(k, k)].norm())),
        least_dynamic_stiffness_n_per_um: number(to_per_um(1.0 / tip)),
        at_frequency_hz: number(w / TAU),
        nose_least_dynamic_stiffness_n_per_um: (nose > 0.0).then(|| number(to_per_um(1.0 / nose))),
    })
}

fn mode(own: &Mode) -> TipModeAnswer {
    let phi = own.shape.fixed_rows::<3>(0).into_owned();
    let (length, omega) = (phi.norm(), own.angular_frequency);
    TipModeAnswer {
        frequency_hz: number(own.frequency_hz()),
        damping_percent: number(100.0 * own.damping_ratio),
        direction: <[f64; 3]>::from(phi / length).map(number),
        modal_mass_kg: number(1.0 / (length * length)),
        stiffness_n_per_um: number(to_per_um(omega * omega / (length * length))),
    }
}

fn at_frequency(own: &Swept) -> ReceptanceAtFrequency {
    let block = |row: usize, column: usize| block(&own.tip, [row, column]);
    let of = |m: &Matrix3<Complex<f64>>, part: &dyn Fn(Complex<f64>) -> f64| {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| number(part(m[(i, j)]))))
    };
    let (translation, across, rotation) = (block(0, 0), block(3, 0), block(3, 3));
    ReceptanceAtFrequency {
        frequency_hz: number(own.w / TAU),
        translation_by_force_real_um_per_n: of(&translation, &|z| to_um(z.re)),
        translation_by_force_imag_um_per_n: of(&translation, &|z| to_um(z.im)),
        rotation_by_force_real_urad_per_n: of(&across, &|z| to_urad(z.re)),
        rotation_by_force_imag_urad_per_n: of(&across, &|z| to_urad(z.im)),
        rotation_by_moment_real_urad_per_n_m: of(&rotation, &|z| to_urad(z.re)),
        rotation_by_moment_imag_urad_per_n_m: of(&rotation, &|z| to_urad(z.im)),
    }
}

fn block(m: &Matrix6<Complex<f64>>, at: [usize; 2]) -> Matrix3<Complex<f64>> {
    m.fixed_view::<3, 3>(at[0], at[1]).into_owned()
}
