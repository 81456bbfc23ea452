//! The picture of measured and fitted FRFs.

use std::f64::consts::TAU;

use armill_core::dynamics::modal_fit::Frf;
use armill_core::nalgebra::Complex;
use armill_core::units::{to_deg, to_um};
use armill_report::{FrfCurve, FrfPlot, FrfStyle};

use super::fitted::{Fitted, FittedSet};
use super::question::ReadFrfs;

/// FRFs that are drawn at most: more cannot be distinguished.
const MOST_DRAWN: usize = 6;
/// Points of a fitted line.
const LINE: usize = 800;

/// Measured points, fitted lines within their bands, coherence, modes.
pub fn picture(read: &ReadFrfs, fitted: &Fitted) -> FrfPlot {
    let mut curves = Vec::new();
    let mut modes_hz = Vec::new();
    let mut drawn = 0;
    for set in &fitted.sets {
        modes_hz.extend(set.fit.modes.iter().map(|mode| mode.angular_frequency / TAU));
        for (index, frf) in set.frfs.iter().enumerate() {
            if drawn == MOST_DRAWN {
                break;
            }
            let name = format!("{}/{}", frf.response, frf.reference);
            curves.push(FrfCurve {
                name: format!("{name} measured"),
                style: FrfStyle::Points,
                coherences: read.coherences[set.places[index]].clone(),
                ..curve(&frf.angular_frequencies, &frf.receptance, drawn)
            });
            curves.push(FrfCurve {
                name: format!("{name} fitted"),
                ..fitted_curve(set, frf, index, drawn)
            });
            drawn += 1;
        }
    }
    let all: usize = fitted.sets.iter().map(|set| set.frfs.len()).sum();
    let shown = match all > drawn {
        true => format!("; the first {drawn} of {all} FRFs"),
        false => String::new(),
    };
    FrfPlot {
        title: "Measured and fitted receptance".to_owned(),
        subtitle: format!("{}{shown}", read.files.join(", ")),
        curves,
        modes_hz,
    }
}

/// The fitted receptance of FRF `index` of a set within its band.
fn fitted_curve(set: &FittedSet, frf: &Frf, index: usize, colour: usize) -> FrfCurve {
    let own = frf.within(set.band).angular_frequencies;
    let (Some(first), Some(last)) = (own.first(), own.last()) else {
        return FrfCurve::default();
    };
    let ratio = last / first;
    let mut frequencies: Vec<f64> = (0..=LINE)
        .map(|k| first * ratio.powf(k as f64 / LINE as f64))
        .collect();
    // Peaks are narrower than the distance of the points.
    frequencies.extend(set.fit.modes.iter().map(|mode| mode.angular_frequency));
    frequencies.sort_by(f64::total_cmp);
    let values: Vec<Complex<f64>> = frequencies
        .iter()
        .map(|w| set.fit.receptance(index, *w))
        .collect();
    curve(&frequencies, &values, colour)
}

fn curve(frequencies: &[f64], values: &[Complex<f64>], colour: usize) -> FrfCurve {
    FrfCurve {
        colour,
        frequencies_hz: frequencies.iter().map(|w| w / TAU).collect(),
        magnitudes_um_per_n: values.iter().map(|h| to_um(h.norm())).collect(),
        phases_deg: values.iter().map(|h| to_deg(h.arg())).collect(),
        ..FrfCurve::default()
    }
}
