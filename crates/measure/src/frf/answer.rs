//! Modes from FRFs as one JSON value.
//!
//! Keys and units are a public contract: Hz, per cent, kg, N/um, um/N, deg. `_u_` is a standard uncertainty.

use std::f64::consts::TAU;

use armill_core::dynamics::modal_fit::{FittedMode, MeasuredShape, NoShape, shape_of};
use armill_core::nalgebra::{Matrix3, Vector3};
use armill_core::units::{to_deg, to_per_um, to_um};
use armill_study::number::digits;
use serde::Serialize;

use super::fitted::{Fitted, FittedSet};
use super::question::ReadFrfs;

/// Significant digits.
const DIGITS: i32 = 7;
/// Residues that deviate by a larger phase are reported, deg.
const COMPLEX_DEG: f64 = 10.0;
/// FRFs of which less is described are reported, per cent.
const POOR_PERCENT: f64 = 95.0;

/// Modes of measured FRFs.
#[derive(Clone, Debug, Serialize)]
pub struct FrfModesAnswer {
    /// The files.
    pub files: Vec<String>,
    /// The point whose directions and modal masses are given.
    pub tip_point: i64,
    /// The FRFs, in the order of the files.
    pub frfs: Vec<FrfAnswer>,
    /// The modes, frequencies rising.
    pub modes: Vec<FrfModeAnswer>,
    /// Ignored columns and datasets, each with its file.
    pub unused: Vec<String>,
    /// What to know of these numbers.
    pub notes: Vec<String>,
}

/// An FRF and its fit.
#[derive(Clone, Debug, Serialize)]
pub struct FrfAnswer {
    /// Its file.
    pub file: String,
    /// Point and direction of the response.
    pub response: String,
    /// Point and direction of the force.
    pub reference: String,
    /// FRFs of different sets share no point and direction; each set has its own modes.
    pub set: usize,
    /// Band of the fit.
    pub band_hz: [f64; 2],
    /// Frequencies in it.
    pub frequencies: usize,
    /// Part of the weighted sum of squares that modes and residuals describe.
    pub explained_percent: f64,
    /// Root mean square of measured less fitted receptance.
    pub residual_um_per_n: f64,
    /// Correlation of the residuals of neighbouring frequencies.
    pub residual_correlation: f64,
    /// Compliance of the modes above the band.
    pub upper_residual_um_per_n: f64,
    /// Inverse mass of the modes below the band.
    pub lower_residual_per_kg: f64,
}

/// A mode.
#[derive(Clone, Debug, Serialize)]
pub struct FrfModeAnswer {
    /// The set of FRFs that determine it.
    pub set: usize,
    /// Undamped natural frequency.
    pub frequency_hz: f64,
    /// Its standard uncertainty.
    pub frequency_u_hz: f64,
    /// Damping ratio.
    pub damping_percent: f64,
    /// Its standard uncertainty, in the same unit.
    pub damping_u_percent: f64,
    /// Shape at the measured points, normalised by mass; empty if there is none.
    pub shape: Vec<ShapeAnswer>,
    /// Direction in which the tip moves; null if the mode has no shape there.
    pub direction: Option<[f64; 3]>,
    /// Modal mass in this direction.
    pub modal_mass_kg: Option<f64>,
    /// Modal stiffness in this direction.
    pub stiffness_n_per_um: Option<f64>,
    /// Its standard uncertainty.
    pub stiffness_u_percent: Option<f64>,
    /// Mean phase deviation of its residues from those of a real mode; null if not determined.
    pub phase_deviation_deg: Option<f64>,
    /// Modal phase collinearity, 0 to 1; null if not determined.
    pub phase_collinearity: Option<f64>,
    /// Why it has no direction and modal mass; null if it has.
    pub without_shape: Option<String>,
}

/// Shape at a point in a direction.
#[derive(Clone, Debug, Serialize)]
pub struct ShapeAnswer {
    /// Point and direction.
    pub at: String,
    /// Shape, 1/sqrt(kg).
    pub value_per_sqrt_kg: f64,
    /// Its standard uncertainty.
    pub u_per_sqrt_kg: f64,
}

/// The result.
pub fn answer(read: &ReadFrfs, fitted: &Fitted) -> FrfModesAnswer {
    let mut frfs: Vec<(usize, FrfAnswer)> = Vec::new();
    let mut modes = Vec::new();
    for (number, set) in fitted.sets.iter().enumerate() {
        for (index, place) in set.places.iter().enumerate() {
            frfs.push((*place, frf(read, set, index, number + 1)));
        }
        modes.extend(set.fit.modes.iter().map(|own| mode(own, set, number + 1, fitted)));
    }
    frfs.sort_by_key(|(place, _)| *place);
    modes.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let frfs: Vec<FrfAnswer> = frfs.into_iter().map(|(_, own)| own).collect();
    FrfModesAnswer {
        files: read.files.clone(),
        tip_point: fitted.tip,
        notes: notes(read, &frfs, &modes, fitted),
        frfs,
        modes,
        unused: read.unused.clone(),
    }
}

fn number(value: f64) -> f64 {
    digits(value, DIGITS)
}

fn frf(read: &ReadFrfs, set: &FittedSet, index: usize, number_of_set: usize) -> FrfAnswer {
    let (own, fit) = (&set.frfs[index], &set.fit.frfs[index]);
    FrfAnswer {
        file: read.files[read.file_of[set.places[index]]].clone(),
        response: own.response.to_string(),
        reference: own.reference.to_string(),
        set: number_of_set,
        band_hz: set.band.map(|w| number(w / TAU)),
        frequencies: own.within(set.band).angular_frequencies.len(),
        explained_percent: number(100.0 * fit.explained),
        residual_um_per_n: number(to_um(fit.residual)),
        residual_correlation: number(fit.correlation),
        upper_residual_um_per_n: number(to_um(fit.upper)),
        lower_residual_per_kg: number(fit.lower),
    }
}

fn mode(own: &FittedMode, set: &FittedSet, number_of_set: usize, fitted: &Fitted) -> FrfModeAnswer {
    let tip = fitted.tip;
    let turn = fitted
        .axes
        .as_ref()
        .map_or_else(Matrix3::identity, |axes| axes.feed_from_measured);
    let found = shape_of(own, &set.frfs);
    let at_tip = found.as_ref().map_err(NoShape::to_string).and_then(|shape| {
        tip_shape(shape, tip, &turn)
            .ok_or_else(|| format!("point {tip} does not move in this mode, or is not measured"))
    });
    let omega = own.angular_frequency;
    let shape = found.as_ref().ok();
    FrfModeAnswer {
        set: number_of_set,
        frequency_hz: number(omega / TAU),
        frequency_u_hz: number(own.angular_frequency_u / TAU),
        damping_percent: number(100.0 * own.damping_ratio),
        damping_u_percent: number(100.0 * own.damping_ratio_u),
        shape: shape.map_or_else(Vec::new, shape_answer),
        direction: at_tip
            .as_ref()
            .ok()
            .map(|tip| <[f64; 3]>::from(tip.direction).map(number)),
        modal_mass_kg: at_tip.as_ref().ok().map(|tip| number(1.0 / tip.length.powi(2))),
        stiffness_n_per_um: at_tip
            .as_ref()
            .ok()
            .map(|tip| number(to_per_um(omega * omega / tip.length.powi(2)))),
        stiffness_u_percent: at_tip.as_ref().ok().map(|tip| number(200.0 * tip.u / tip.length)),
        phase_deviation_deg: own.phase_deviation.map(|angle| number(to_deg(angle))),
        phase_collinearity: own.collinearity.map(number),
        without_shape: at_tip.err(),
    }
}

fn shape_answer(shape: &MeasuredShape) -> Vec<ShapeAnswer> {
    let parts = shape.dofs.iter().zip(&shape.shape).enumerate();
    parts
        .map(|(index, (dof, value))| ShapeAnswer {
            at: dof.to_string(),
            value_per_sqrt_kg: number(*value),
            u_per_sqrt_kg: number(shape.covariance[(index, index)].max(0.0).sqrt()),
        })
        .collect()
}

/// Shape at the tip.
struct TipShape {
    direction: Vector3<f64>,
    /// Length of the shape, 1/sqrt(kg), and its standard uncertainty.
    length: f64,
    u: f64,
}

/// The shape at a point, turned into the feed frame; `None` where it does not move.
fn tip_shape(shape: &MeasuredShape, point: i64, turn: &Matrix3<f64>) -> Option<TipShape> {
    let (mut phi, mut covariance) = (Vector3::zeros(), Matrix3::zeros());
    let of_tip = || (0..shape.dofs.len()).filter(|k| shape.dofs[*k].point == point);
    for k in of_tip() {
        phi[shape.dofs[k].axis] = shape.shape[k];
        for l in of_tip() {
            covariance[(shape.dofs[k].axis, shape.dofs[l].axis)] = shape.covariance[(k, l)];
        }
    }
    let (phi, covariance) = (turn * phi, turn * covariance * turn.transpose());
    let length = phi.norm();
    let direction = phi.try_normalize(f64::MIN_POSITIVE)?;
    Some(TipShape {
        direction,
        length,
        u: direction.dot(&(covariance * direction)).max(0.0).sqrt(),
    })
}

fn notes(read: &ReadFrfs, frfs: &[FrfAnswer], modes: &[FrfModeAnswer], fitted: &Fitted) -> Vec<String> {
    let sets = fitted.sets.len();
    let mut notes = read.notes.clone();
    notes.push(match &fitted.axes {
        None => "directions are those of the measurement: X is taken as along the feed, Y as to its left, Z as from part to spindle".to_owned(),
        Some(axes) => format!(
            "directions of the modes are in the feed frame, by --axes: {}; shapes and FRFs are named as measured",
            axes.words
        ),
    });
    notes.push(
        "standard uncertainties are those of the noise; errors of calibration of hammer and sensor, and the mass of the sensor, are not included"
            .to_owned(),
    );
    if sets > 1 {
        notes.push(format!(
            "the FRFs are {sets} sets without a common point and direction: each has its own modes; a cross FRF (force along X, response along Y) would connect them"
        ));
    }
    for names in &fitted.without_modes {
        notes.push(format!(
            "no mode of vibration is found in {names} within the band: left out"
        ));
    }
    for own in frfs.iter().filter(|own| own.explained_percent < POOR_PERCENT) {
        notes.push(format!(
            "modes and residuals describe only {:.1} % of {}/{}: limit the band, or give the number of modes",
            own.explained_percent, own.response, own.reference
        ));
    }
    for own in modes {
        let at = own.frequency_hz;
        if let Some(why) = &own.without_shape {
            notes.push(format!("the mode at {at:.1} Hz has no modal mass: {why}"));
        }
        if let Some(angle) = own.phase_deviation_deg.filter(|angle| *angle > COMPLEX_DEG) {
            notes.push(format!(
                "the mode at {at:.1} Hz is complex (mean phase deviation {angle:.0} deg): it is described by a real mode only in part"
            ));
        }
    }
    notes
}
