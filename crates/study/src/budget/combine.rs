//! Predicted and measured curves of one circle, at the angles that all of them have.
//!
//! | contribution | origin | bias | scatter of one cut |
//! |---|---|---|---|
//! | deviation under load | load | effect of the load: its mean force, or the mean of the given cases | between these cases |
//! | vibration under the teeth | load | with `[vibration]` and a cut with one wall: error of the wall, without its mean; u from the modes | - |
//! | predicted | unloaded | without a ball-bar: gravity, backlash and geometry of the study | - |
//! | rounded corners, joints that follow late | unloaded | without a ball-bar: the motion of the study; u from the lag | - |
//! | both directions | unloaded | mean of clockwise and anticlockwise runs | - |
//! | reversal | unloaded | half of the difference of the cutting direction from the other | - |
//! | repeatability | unloaded | - | of runs of the same direction; without a ball-bar, from the robot file or the study |
//!
//! A cut and a measured force have a mean and a greatest force: the mean is the bias, the greatest is reported as the
//! end of the envelope. Given cases are equally probable. A ball-bar measures gravity, backlash, geometry and the motion
//! at its own feed: if there is a ball-bar test, their prediction is not part of a sum; that of the first three is
//! reported for comparison.

use armill_core::budget::turn::Turn;
use armill_core::budget::unloaded::known_angles;
use armill_core::budget::{Agreement, Balance, Contribution, Datum, Origin, agreement, balance, unloaded};
use armill_core::load::PathLoad;
use armill_core::measure::ballbar::profile::{STATIONS, station};
use armill_core::measure::ballbar::{CircularTest, Direction, Profile};
use armill_core::watch::Watch;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::budget::parts::{DeviationParts, parts};
use crate::error::StudyError;
use crate::file::experiment::Experiment;
use crate::file::resolve::Study;

/// Curves at common angles. SI.
#[derive(Clone, Debug)]
pub struct CombinedCurves {
    /// The angles.
    pub turn: Turn,
    /// The budget.
    pub balance: Balance,
    /// Least and greatest deviation under load over all cases at each angle, from the nominal circle.
    pub envelope: [Vec<f64>; 2],
    /// Load cases.
    pub cases: usize,
    /// Whether these are given and equally probable; otherwise the first is the mean and the second the greatest force.
    pub cases_are_given: bool,
    /// Whether the cutting direction was measured without load; `None` if nothing was measured.
    pub has_cut_way: Option<bool>,
    /// Whether both directions were measured.
    pub both_ways: bool,
    /// Standard deviation of runs of the same direction; none if no direction has two.
    pub repeatability: Option<f64>,
    /// The path without load, predicted and measured in the cutting direction; none if either is missing.
    pub without_load: Option<UnloadedPath>,
}

/// A predicted curve and the measured one, both from their datum. m
#[derive(Clone, Debug)]
pub struct UnloadedPath {
    /// Predicted.
    pub predicted: Vec<f64>,
    /// Measured.
    pub measured: Vec<f64>,
    /// How the first explains the second.
    pub agreement: Agreement,
}

/// Greatest number of harmonics reported.
pub const MOST_WAVES: usize = 12;

/// Combines the measurements with the result for the path.
///
/// # Errors
/// A path that is not reached everywhere; curves that have too few angles in common; those of a run.
pub fn combine(
    study: &Study,
    experiment: &Experiment,
    path: &PathAnalysis,
    found: &PathResult,
    watch: Watch<'_>,
) -> Result<CombinedCurves, StudyError> {
    if found.radial.is_empty() {
        return Err(StudyError::value(
            format!(
                "{}: a circle that is not reached everywhere has no budget",
                experiment.analysis
            ),
            "another posture, or another place of the plane",
        ));
    }
    let part = experiment.part.as_ref().map(|part| Profile::of(&part.run));
    let own: Vec<f64> = match &part {
        Some(part) => part.samples().map(|(angle, _)| angle).collect(),
        None => (0..STATIONS).map(station).collect(),
    };
    let test = experiment.test.as_ref();
    let common = test.map_or_else(|| own.clone(), |test| known_angles(test, &own));
    let turn = Turn::new(common).map_err(|error| {
        StudyError::value(
            format!("{}: of the measurements {error}", experiment.analysis),
            "full turns, a sample every 15 degrees or more",
        )
    })?;
    let cases_are_given = matches!(path.load, PathLoad::Cases(_));
    let biased = if cases_are_given { found.radial.len() } else { 1 };
    let DeviationParts {
        load,
        without,
        motion,
        vibration,
        uncertainties,
    } = parts(study, path, found, biased, watch)?;
    let cases: Vec<Vec<f64>> = load.iter().map(|case| turn.of_even(case)).collect();
    let without = without.map(|given| {
        (
            turn.of_even(&given.outward),
            uncertainty(&given.uncertainties, &turn, experiment),
        )
    });
    let mut contributions = vec![Contribution {
        u: uncertainty(&uncertainties, &turn, experiment),
        ..under_load(&cases[..biased])
    }];
    contributions.extend(vibration.map(|(outward, changes)| Contribution {
        origin: Origin::Load,
        ..of_unloaded(
            "vibration under the teeth",
            turn.of_even(&outward),
            uncertainty(&changes, &turn, experiment),
        )
    }));
    let (mut has_cut_way, mut both_ways) = (None, false);
    let (mut without_load, mut measured_scatter) = (None, None);
    if let Some(test) = test {
        let seen = of_test(test, &turn, experiment)?;
        has_cut_way = Some(seen.has_cut_way);
        both_ways = seen.reversal.is_some();
        measured_scatter = seen.scatter;
        without_load = without.and_then(|(predicted, _)| unloaded_path(&turn, &predicted, &seen, experiment));
        contributions.extend(contributions_of(seen));
    } else {
        if let Some((bias, u)) = without {
            contributions.push(of_unloaded("path without load, predicted", bias, u));
        }
        contributions.extend(of_motion(path, motion, &turn, experiment));
    }
    let stated = Some(path.setting.model.structure.repeatability).filter(|given| *given > 0.0);
    let repeatability = measured_scatter.or(stated);
    contributions.extend(repeatability.map(|given| scattering(given, turn.angle().len())));
    // Every angle is one of the part's own.
    let measured: Option<Vec<f64>> =
        part.and_then(|part| turn.angle().iter().map(|angle| part.at(*angle)).collect());
    let u = experiment.part.as_ref().map_or(0.0, |part| part.u);
    let at = |k: usize| cases.iter().map(move |case| case[k]);
    let extreme = |of: fn(f64, f64) -> f64, begin: f64| -> Vec<f64> {
        (0..turn.angle().len()).map(|k| at(k).fold(begin, of)).collect()
    };
    Ok(CombinedCurves {
        envelope: [extreme(f64::min, f64::MAX), extreme(f64::max, f64::MIN)],
        cases: cases.len(),
        cases_are_given,
        has_cut_way,
        both_ways,
        repeatability,
        without_load,
        balance: balance(
            &turn,
            contributions,
            measured.as_deref().map(|curve| (curve, u)),
            experiment.removed,
            MOST_WAVES,
        ),
        turn,
    })
}

/// The effect of the load: the mean of these cases, equally probable, and their scatter.
fn under_load(taken: &[Vec<f64>]) -> Contribution {
    let count = taken.len() as f64;
    let mean = |k: usize| taken.iter().map(|case| case[k]).sum::<f64>() / count;
    let angles = taken[0].len();
    let bias: Vec<f64> = (0..angles).map(mean).collect();
    let scatter = |k: usize| {
        let squares = taken.iter().map(|case| (case[k] - bias[k]).powi(2));
        (squares.sum::<f64>() / count).sqrt()
    };
    Contribution {
        name: "deviation under load".to_owned(),
        origin: Origin::Load,
        scatter: (0..angles).map(scatter).collect(),
        bias,
        u: None,
    }
}

/// Standard uncertainty (m) of the effect of the load, root mean square over the circle: that of the curves of all
/// independent unknowns, from their datum; `None` if nothing is known of it.
fn uncertainty(uncertainties: &[Vec<f64>], turn: &Turn, experiment: &Experiment) -> Option<f64> {
    let of = |curve: &Vec<f64>| {
        let (_, form) = Datum::remove(turn, &turn.of_even(curve), experiment.removed);
        turn.rms(&form)
    };
    let u = uncertainties.iter().map(of).fold(0.0, f64::hypot);
    // Without an uncertain input nothing is known of it.
    (u > 0.0).then_some(u)
}

/// The path without load as predicted and as measured by the ball-bar, in the cutting direction.
fn unloaded_path(
    turn: &Turn,
    predicted: &[f64],
    seen: &armill_core::budget::Unloaded,
    experiment: &Experiment,
) -> Option<UnloadedPath> {
    let reversal = seen.reversal.as_ref();
    let cut_way = |k: usize| seen.mean[k] + reversal.map_or(0.0, |by| by[k]);
    let measured: Vec<f64> = (0..seen.mean.len()).map(cut_way).collect();
    let form = |curve: &[f64]| Datum::remove(turn, curve, experiment.removed).1;
    let (predicted, measured) = (form(predicted), form(&measured));
    Some(UnloadedPath {
        agreement: agreement(turn, &predicted, &measured)?,
        predicted,
        measured,
    })
}

/// The path without load, in parts.
fn of_test(
    test: &CircularTest,
    turn: &Turn,
    experiment: &Experiment,
) -> Result<armill_core::budget::Unloaded, StudyError> {
    // A circle of a study is cut in the direction of increasing angle.
    let seen = unloaded(test, turn, Direction::Anticlockwise, experiment.removed);
    seen.ok_or_else(|| {
        StudyError::value(
            "the runs of the ball-bar have no angle in common",
            "measure full turns",
        )
    })
}

/// Those parts as contributions, without their scatter.
fn contributions_of(seen: armill_core::budget::Unloaded) -> Vec<Contribution> {
    let mean = match seen.reversal {
        Some(_) => "path without load, both directions",
        None => "path without load",
    };
    let mut parts = vec![of_unloaded(mean, seen.mean, seen.u)];
    parts.extend(seen.reversal.map(|bias| of_unloaded("reversal", bias, seen.u)));
    parts
}

/// A part of the path without load, and its standard uncertainty (m).
fn of_unloaded(name: &str, bias: Vec<f64>, u: Option<f64>) -> Contribution {
    Contribution {
        name: name.to_owned(),
        origin: Origin::Unloaded,
        scatter: vec![0.0; bias.len()],
        bias,
        u,
    }
}

/// Rounded corners, if there are any, and joints that follow late.
fn of_motion(
    path: &PathAnalysis,
    motion: Option<[Vec<f64>; 2]>,
    turn: &Turn,
    experiment: &Experiment,
) -> Vec<Contribution> {
    let Some((motion, setting)) = motion.zip(path.setting.motion.as_ref()) else {
        return Vec::new();
    };
    let [blending, servo] = motion;
    let by_lag: Vec<f64> = servo.iter().map(|by| by * setting.known_lag_u()).collect();
    let u = uncertainty(&[by_lag], turn, experiment);
    let late = of_unloaded("joints that follow late", turn.of_even(&servo), u);
    let is_rounded = blending.iter().any(|by| *by != 0.0);
    let rounded = is_rounded.then(|| of_unloaded("rounded corners", turn.of_even(&blending), None));
    rounded.into_iter().chain([late]).collect()
}

/// Scatter that is the same at all of `count` angles: a standard deviation, m.
fn scattering(deviation: f64, count: usize) -> Contribution {
    Contribution {
        scatter: vec![deviation; count],
        ..of_unloaded("repeatability", vec![0.0; count], None)
    }
}
