//! Results of the software of the ball-bar, with the value of armill for comparison where both have the same quantity.

use armill_core::measure::ballbar::parts::Term;
use armill_core::units::to_um;
use armill_formats::measurement::ballbar::Feature;
use serde::Serialize;

use super::analyse::BallbarAnalysis;

/// Results of the software of the ball-bar.
#[derive(Clone, Debug, Serialize)]
pub struct ResultsAnswer {
    /// Its file.
    pub file: String,
    /// What was planned.
    pub test: Option<String>,
    /// On which machine.
    pub machine: Option<String>,
    /// When.
    pub date: Option<String>,
    /// In which plane.
    pub plane: Option<String>,
    /// Each result as the file has it.
    pub features: Vec<FeatureAnswer>,
    /// Names of results without a number.
    pub without_number: Vec<String>,
}

/// One result of the software of the ball-bar, and the value of armill.
#[derive(Clone, Debug, Serialize)]
pub struct FeatureAnswer {
    /// As the file calls it.
    pub name: String,
    /// As the file has it.
    // unit: given by the field `unit`
    pub value: f64,
    /// The unit of both.
    pub unit: String,
    /// Value of armill in that unit, if it has the same quantity; definitions and signs may differ.
    // unit: given by the field `unit`
    pub ours: Option<f64>,
}

/// All results in the files, with the values of armill where both have the same quantity.
///
/// `axes` are the names of those of the plane; G(b) and squareness are those of the answer.
pub(super) fn results(
    found: &BallbarAnalysis<'_>,
    axes: &[String; 2],
    circular_um: Option<f64>,
    squareness_urad: Option<f64>,
) -> Vec<ResultsAnswer> {
    let [a, b] = axes;
    // The reversal of that name: given ones may be added to those of the axes, or replace them.
    let step = |axis: &str, side: &str| {
        let name = format!("{axis}{side}");
        let index = found.requested.reversals.iter().position(|of| of.name == name)?;
        let part = found.parts.as_ref()?.alone(Term::Reversal(index))?;
        Some(to_um(part.value))
    };
    let own_values = [
        ("AF_CIRCULARITY", "um", circular_um),
        ("AF_SQUARENESS", "um/m", squareness_urad),
        ("AF_BACKLASH_A_POS", "um", step(a, "+")),
        ("AF_BACKLASH_A_NEG", "um", step(a, "-")),
        ("AF_BACKLASH_B_POS", "um", step(b, "+")),
        ("AF_BACKLASH_B_NEG", "um", step(b, "-")),
    ];
    let feature = |feature: &Feature| {
        let own = own_values
            .iter()
            .find(|(name, unit, _)| *name == feature.name && *unit == feature.unit);
        FeatureAnswer {
            name: feature.name.clone(),
            value: feature.value,
            unit: feature.unit.clone(),
            ours: own.and_then(|(.., value)| *value),
        }
    };
    let of = found
        .measured
        .results
        .iter()
        .map(|(file, results)| ResultsAnswer {
            file: file.clone(),
            test: results.test.clone(),
            machine: results.machine.clone(),
            date: results.date.clone(),
            plane: results.plane.clone(),
            features: results.features.iter().map(feature).collect(),
            without_number: results.without_number.clone(),
        });
    of.collect()
}
