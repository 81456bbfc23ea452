//! Modes of all sets of FRFs.

use armill_core::dynamics::modal_fit::{FitError, FitOptions, Frf, ModalFit, connected, fit};
use armill_study::StudyError;

use super::axes::Axes;
use super::question::{FrfQuestion, ReadFrfs};

/// Modes of one set: FRFs that share points.
#[derive(Clone, Debug)]
pub struct FittedSet {
    /// Places of its FRFs among those that were read.
    pub places: Vec<usize>,
    /// Its FRFs.
    pub frfs: Vec<Frf>,
    /// The band of the fit, rad/s.
    pub band: [f64; 2],
    /// Modes and residuals.
    pub fit: ModalFit,
}

/// Modes of all sets, and the point of the tip.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The sets.
    pub sets: Vec<FittedSet>,
    /// The point of the tip.
    pub tip: i64,
    /// FRFs of sets in which no mode is found.
    pub without_modes: Vec<String>,
    /// Directions of the measured axes in the feed frame; none: X, Y, Z are x, y, z.
    pub axes: Option<Axes>,
}

/// Fits the modes of each set.
///
/// # Errors
/// No drive point, or several without `--point`; too few frequencies in the band; no mode.
pub fn fit_all(read: &ReadFrfs, question: &FrfQuestion) -> Result<Fitted, StudyError> {
    let tip = tip(&read.frfs, question)?;
    let (mut sets, mut without_modes) = (Vec::new(), Vec::new());
    let mut refused = None;
    for places in connected(&read.frfs) {
        let frfs: Vec<Frf> = places.iter().map(|place| read.frfs[*place].clone()).collect();
        let band = question.band.unwrap_or_else(|| common_band(&frfs));
        let options = FitOptions {
            band,
            modes: question.modes,
            seeks_weak: true,
        };
        let problem = |error: FitError| {
            StudyError::value(
                format!("{}: {error}", names(&frfs)),
                "choose the band with --band-hz LOW,HIGH: it must contain the peaks of the FRFs",
            )
        };
        let fit = match fit(&frfs, &options) {
            Ok(fit) => fit,
            // Another set may have modes: an axis along which the tip is stiff has none.
            Err(FitError::NoMode) => {
                without_modes.push(names(&frfs));
                refused = refused.or(Some(problem(FitError::NoMode)));
                continue;
            }
            Err(error) => return Err(problem(error)),
        };
        sets.push(FittedSet {
            places,
            frfs,
            band,
            fit,
        });
    }
    if let Some(refused) = refused.filter(|_| sets.is_empty()) {
        return Err(refused);
    }
    Ok(Fitted {
        sets,
        without_modes,
        tip,
        axes: question.axes.clone(),
    })
}

/// The names of FRFs: `1X/1X`.
fn names(frfs: &[Frf]) -> String {
    let all: Vec<String> = frfs
        .iter()
        .map(|frf| format!("{}/{}", frf.response, frf.reference))
        .collect();
    all.join(", ")
}

fn common_band(frfs: &[Frf]) -> [f64; 2] {
    let ends = frfs.iter().map(|frf| {
        let (first, last) = (frf.angular_frequencies.first(), frf.angular_frequencies.last());
        [first.copied().unwrap_or(0.0), last.copied().unwrap_or(0.0)]
    });
    ends.fold([0.0, f64::INFINITY], |[low, high], [first, last]| {
        [low.max(first), high.min(last)]
    })
}

fn tip(frfs: &[Frf], question: &FrfQuestion) -> Result<i64, StudyError> {
    let mut points: Vec<i64> = frfs
        .iter()
        .filter(|frf| frf.is_drive_point())
        .map(|frf| frf.response.point)
        .collect();
    points.sort_unstable();
    points.dedup();
    if let Some(point) = question.point {
        let is_measured = frfs
            .iter()
            .any(|frf| frf.response.point == point || frf.reference.point == point);
        return match is_measured {
            true => Ok(point),
            false => Err(StudyError::value(
                format!("--point {point}: no FRF has this point"),
                format!("the FRFs are {}", names(frfs)),
            )),
        };
    }
    match points[..] {
        [point] => Ok(point),
        [] => Err(StudyError::value(
            format!("no drive point among {}", names(frfs)),
            "one FRF with force and displacement at the same point in the same direction gives the modal mass",
        )),
        _ => Err(StudyError::value(
            format!("drive points at the points {points:?}"),
            "give the point of the tip with --point",
        )),
    }
}
