//! Results of the software of the ball-bar, with the value of armill for comparison where both have the same quantity.

use armill_core::measure::ballbar::parts::Term;
use armill_core::units::to_um;
use armill_formats::measurement::ballbar::Feature;
use armill_study::measured::circular_test::MeasuredTest;
use serde::Serialize;

use super::analyse::BallbarAnalysis;
use super::answer::BallbarAnswer;

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

/// All results in the files, without the values of armill.
pub(super) fn results(measured: &MeasuredTest) -> Vec<ResultsAnswer> {
    let of = measured.results.iter().map(|(file, results)| {
        let feature = |feature: &Feature| FeatureAnswer {
            name: feature.name.clone(),
            value: feature.value,
            unit: feature.unit.clone(),
            ours: None,
        };
        ResultsAnswer {
            file: file.clone(),
            test: results.test.clone(),
            machine: results.machine.clone(),
            date: results.date.clone(),
            plane: results.plane.clone(),
            features: results.features.iter().map(feature).collect(),
            without_number: results.without_number.clone(),
        }
    });
    of.collect()
}

/// Adds the values of armill to those of the software of the ball-bar.
pub(super) fn add_own_values(given: &mut BallbarAnswer, found: &BallbarAnalysis<'_>) {
    let [a, b] = &given.axes;
    // The reversal of that name: given ones may be added to those of the axes, or replace them.
    let step = |axis: &str, side: &str| {
        let name = format!("{axis}{side}");
        let index = found.requested.reversals.iter().position(|of| of.name == name)?;
        let part = found.parts.as_ref()?.alone(Term::Reversal(index))?;
        Some(to_um(part.value))
    };
    let squareness = given.parts.as_ref().and_then(|parts| parts.squareness_urad);
    let ours = [
        ("AF_CIRCULARITY", "um", given.circular_bidirectional_um),
        ("AF_SQUARENESS", "um/m", squareness),
        ("AF_BACKLASH_A_POS", "um", step(a, "+")),
        ("AF_BACKLASH_A_NEG", "um", step(a, "-")),
        ("AF_BACKLASH_B_POS", "um", step(b, "+")),
        ("AF_BACKLASH_B_NEG", "um", step(b, "-")),
    ];
    for feature in given.results.iter_mut().flat_map(|results| &mut results.features) {
        let of = ours
            .iter()
            .find(|(name, unit, _)| *name == feature.name && *unit == feature.unit);
        feature.ours = of.and_then(|(.., value)| *value);
    }
}
