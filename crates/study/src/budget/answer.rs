//! The budget in numbers with their units.
//!
//! Deviations are radial, positive outwards; angles are from +y' of the plane towards z', the direction in which the
//! circle is cut. Explained percentages are of the measured mean square; below 0 a curve is worse than none.

use armill_core::budget::turn::largest;
use armill_core::budget::{Comparison, Contribution, Datum, Origin, Share, WavePair};
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::budget::combine::{CombinedCurves, UnloadedPath};
use crate::file::experiment::Experiment;

/// Contributions to the error of a circle.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BudgetAnswer {
    /// Name of the path.
    pub analysis: String,
    /// Requested posture: words of a branch, or `best`.
    pub branch: String,
    /// Nominal radius of the circle.
    pub radius_mm: f64,
    /// The measured files, and their kind.
    pub files: Vec<FileAnswer>,
    /// Datum of all curves.
    pub datum: DatumAnswer,
    /// Angles at which curves are compared.
    pub angles: usize,
    /// The arc that they cover.
    pub arc_deg: f64,
    /// Each part of the error.
    pub contributions: Vec<ContributionAnswer>,
    /// Load cases that the deviation under load was predicted for.
    pub load_cases: usize,
    /// Least and greatest deviation under load over all cases, from the nominal circle.
    pub load_envelope_um: [f64; 2],
    /// Standard deviation of ball-bar runs of the same direction; if no direction has two, that of the robot file or
    /// study; none if neither gives it.
    pub repeatability_um: Option<f64>,
    /// Their combinations.
    pub sums: SumsAnswer,
    /// The path without load, predicted and measured by the ball-bar; none if either is missing.
    pub without_load: Option<WithoutLoadAnswer>,
    /// The measured part; none if it was not measured.
    pub part: Option<PartAnswer>,
    /// What a user must know, each a sentence.
    pub warnings: Vec<String>,
    /// Sources of definitions and methods.
    pub sources: Vec<&'static str>,
}

/// A file that was measured.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FileAnswer {
    /// Its name, relative to the study.
    pub file: String,
    /// `part`, `path without load` or `forces`.
    pub of: &'static str,
}

/// Datum of the curves.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DatumAnswer {
    /// `least-squares` of each curve, or `as-measured`.
    pub centre: &'static str,
    /// The same values.
    pub radius: &'static str,
}

/// One part of the error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ContributionAnswer {
    /// What it is.
    pub name: String,
    /// `load` or `unloaded`.
    pub origin: &'static str,
    /// Largest bias by size, from its datum.
    pub largest_um: f64,
    /// Where.
    pub largest_at_deg: f64,
    /// Root mean square of the bias.
    pub rms_um: f64,
    /// Standard uncertainty of the bias, root mean square over the circle, if known.
    pub bias_u_um: Option<f64>,
    /// Root mean square of the standard deviation of one cut.
    pub scatter_um: f64,
    /// Centre that was removed, along y' and z'.
    pub centre_um: [f64; 2],
    /// Radius that was removed, relative to the nominal one.
    pub radius_um: f64,
    /// Percentage of the part explained by it alone; none without part or bias.
    pub explained_alone_percent: Option<f64>,
    /// Percentage explained by the others without it; none without part or bias.
    pub explained_without_percent: Option<f64>,
}

/// The path without load, predicted (gravity, backlash, geometry) and measured in the cutting direction.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WithoutLoadAnswer {
    /// Largest predicted by size, from its datum.
    pub predicted_um: f64,
    /// Where.
    pub predicted_at_deg: f64,
    /// Root mean square.
    pub predicted_rms_um: f64,
    /// Largest measured by size, from its datum.
    pub measured_um: f64,
    /// Where.
    pub measured_at_deg: f64,
    /// Root mean square.
    pub measured_rms_um: f64,
    /// How much of the measured mean square is predicted.
    pub explained_percent: f64,
    /// Similarity of the shapes.
    pub likeness_percent: Option<f64>,
}

/// Their combinations.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SumsAnswer {
    /// Largest bias of the load.
    pub load_um: f64,
    /// Largest bias of the path without load, in the cutting direction.
    pub unloaded_um: f64,
    /// Largest sum of biases, added with their signs at every angle.
    pub as_functions_um: f64,
    /// The same with twice the scatter.
    pub with_scatter_um: f64,
    /// Standard uncertainty of the combined bias, root mean square over the circle, as far as it is known; none if
    /// nothing is.
    pub u_um: Option<f64>,
    /// Root of the squares of `load_um` and `unloaded_um`.
    pub root_sum_square_um: f64,
    /// `load_um` and `unloaded_um` added plainly, as the paper does.
    pub plain_um: f64,
}

/// The part and its prediction.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PartAnswer {
    /// Points in its file.
    pub points: usize,
    /// Largest deviation by size, from its datum.
    pub largest_um: f64,
    /// Where.
    pub largest_at_deg: f64,
    /// Root mean square.
    pub rms_um: f64,
    /// Centre in the axes of its file, if deviations are measured from it.
    pub centre_mm: Option<[f64; 2]>,
    /// Radius relative to the nominal one, if it was removed.
    pub radius_um: f64,
    /// Standard uncertainty of a point, from the study; none if it is not known.
    pub u_um: Option<f64>,
    /// Percentage of its mean square explained by all contributions.
    pub explained_percent: f64,
    /// Percentage that can be explained: the rest is known scatter.
    pub explainable_percent: f64,
    /// Similarity of the shapes, independent of their size: 100 equal, 0 unrelated, -100 inverted.
    pub likeness_percent: Option<f64>,
    /// The scale of the prediction that explains most.
    pub best_size_percent: Option<f64>,
    /// Of all turns of the prediction round the circle those at which it is as like the part.
    pub turns_as_good_percent: Option<f64>,
    /// What is not explained.
    pub residual: ResidualAnswer,
    /// Harmonics of less amplitude have no phase and no percentage.
    pub least_wave_um: f64,
    /// Wave by wave.
    pub waves: Vec<WaveAnswer>,
}

/// What is not explained.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ResidualAnswer {
    /// Root mean square.
    pub rms_um: f64,
    /// Largest by size.
    pub largest_um: f64,
    /// Where.
    pub largest_at_deg: f64,
    /// Root mean square beyond all known scatter and uncertainty: from another cause.
    pub beyond_known_um: f64,
}

/// One harmonic of the part and of its prediction.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WaveAnswer {
    /// A turn.
    pub waves: usize,
    /// Amplitude of the part.
    pub measured_um: f64,
    /// Its phase: a crest is at this over `waves`; none if there is no such harmonic.
    pub measured_phase_deg: Option<f64>,
    /// Amplitude of the prediction.
    pub predicted_um: f64,
    /// Its phase; none if there is no such harmonic.
    pub predicted_phase_deg: Option<f64>,
    /// Phase of the prediction relative to that of the part, if both have one.
    pub phase_difference_deg: Option<f64>,
    /// Percentage of this harmonic of the part that is explained; none if there is no such harmonic.
    pub explained_percent: Option<f64>,
}

/// A part of which less than this is explained is not understood, percent.
const LITTLE: f64 = 50.0;
/// A prediction that is as good at more of its rotations than this may agree by chance, percent.
const BY_CHANCE: f64 = 5.0;
/// Error of removing a centre to first order that need not be reported, um.
const SECOND_ORDER_UM: f64 = 1.0;

const SOURCES: [&str; 3] = [
    "scatter as variances, uncertainty: JCGM 100 (GUM)",
    "plain sum of the load's and the path's largest deviation: section 5 of the paper in docs/notation.md",
    "theory: docs/theory/budget.md",
];

/// The result for `combined`.
pub fn answer(experiment: &Experiment, path: &PathAnalysis, combined: &CombinedCurves) -> BudgetAnswer {
    let (balance, sums) = (&combined.balance, &combined.balance.sums);
    let shares = balance.comparison.as_ref().map(|given| &given.shares[..]);
    let datum = |is_removed: bool| {
        if is_removed {
            "least-squares"
        } else {
            "as-measured"
        }
    };
    let contributions = balance.contributions.iter().zip(&balance.datums).enumerate();
    let [least, greatest] = &combined.envelope;
    let mut given = BudgetAnswer {
        analysis: experiment.analysis.clone(),
        branch: path.setting.branch(),
        radius_mm: to_mm(experiment.radius),
        files: files(experiment, path),
        datum: DatumAnswer {
            centre: datum(experiment.removed.centre),
            radius: datum(experiment.removed.radius),
        },
        angles: combined.turn.angle().len(),
        arc_deg: to_deg(combined.turn.arc()),
        contributions: contributions
            .map(|(index, (one, datum))| contribution(combined, one, datum, shares.map(|all| all[index])))
            .collect(),
        load_cases: combined.cases,
        load_envelope_um: [
            to_um(least.iter().copied().fold(f64::MAX, f64::min)),
            to_um(greatest.iter().copied().fold(f64::MIN, f64::max)),
        ],
        repeatability_um: combined.repeatability.map(to_um),
        sums: SumsAnswer {
            load_um: to_um(sums.of_origin[0]),
            unloaded_um: to_um(sums.of_origin[1]),
            as_functions_um: to_um(sums.largest),
            with_scatter_um: to_um(sums.largest_with_scatter),
            u_um: (sums.u > 0.0).then(|| to_um(sums.u)),
            root_sum_square_um: to_um(sums.root_sum_square),
            plain_um: to_um(sums.plain),
        },
        without_load: combined
            .without_load
            .as_ref()
            .map(|path| without_load(combined, path)),
        part: balance
            .comparison
            .as_ref()
            .map(|given| part(experiment, combined, given)),
        warnings: Vec::new(),
        sources: SOURCES.to_vec(),
    };
    given.warnings = warnings(experiment, combined, &given);
    given
}

/// What was measured, file by file.
fn files(experiment: &Experiment, path: &PathAnalysis) -> Vec<FileAnswer> {
    let file = |of: &'static str| {
        move |file: &String| FileAnswer {
            file: file.clone(),
            of,
        }
    };
    let forces = path.measured.as_deref().map(|forces| &forces.table.file);
    let part = experiment.table.part.iter().map(file("part"));
    part.chain(experiment.table.ballbar.iter().map(file("path without load")))
        .chain(forces.into_iter().map(file("forces")))
        .collect()
}

fn contribution(
    combined: &CombinedCurves,
    one: &Contribution,
    datum: &Datum,
    share: Option<Share>,
) -> ContributionAnswer {
    let turn = &combined.turn;
    let (at, most) = largest(&one.bias);
    let share = share.filter(|_| most > 0.0);
    ContributionAnswer {
        name: one.name.clone(),
        origin: match one.origin {
            Origin::Load => "load",
            Origin::Unloaded => "unloaded",
        },
        largest_um: to_um(most),
        largest_at_deg: to_deg(turn.angle()[at]),
        rms_um: to_um(turn.rms(&one.bias)),
        bias_u_um: one.u.map(to_um),
        scatter_um: to_um(turn.rms(&one.scatter)),
        centre_um: [to_um(datum.centre.x), to_um(datum.centre.y)],
        radius_um: to_um(datum.radius),
        explained_alone_percent: share.map(|share| share.alone * 100.0),
        explained_without_percent: share.map(|share| share.without * 100.0),
    }
}

fn without_load(combined: &CombinedCurves, path: &UnloadedPath) -> WithoutLoadAnswer {
    let turn = &combined.turn;
    let most = |curve: &[f64]| {
        let (at, most) = largest(curve);
        (to_um(most), to_deg(turn.angle()[at]))
    };
    let [(predicted_um, predicted_at_deg), (measured_um, measured_at_deg)] =
        [most(&path.predicted), most(&path.measured)];
    WithoutLoadAnswer {
        predicted_um,
        predicted_at_deg,
        predicted_rms_um: to_um(turn.rms(&path.predicted)),
        measured_um,
        measured_at_deg,
        measured_rms_um: to_um(turn.rms(&path.measured)),
        explained_percent: path.agreement.explained * 100.0,
        likeness_percent: path.agreement.likeness.map(|share| share * 100.0),
    }
}

fn part(experiment: &Experiment, combined: &CombinedCurves, given: &Comparison) -> PartAnswer {
    let at_deg = |at: usize| to_deg(combined.turn.angle()[at]);
    let of_file = experiment.part.as_ref();
    let (at, most) = largest(&given.measured);
    let percent = |share: f64| share * 100.0;
    PartAnswer {
        points: of_file.map_or(0, |part| part.points),
        largest_um: to_um(most),
        largest_at_deg: at_deg(at),
        rms_um: to_um(given.measured_rms),
        centre_mm: of_file
            .and_then(|part| part.centre)
            .map(|centre| centre.map(to_mm)),
        radius_um: to_um(given.datum.radius),
        u_um: of_file.map(|part| to_um(part.u)).filter(|u| *u > 0.0),
        explained_percent: percent(given.together.explained),
        explainable_percent: percent(given.explainable),
        likeness_percent: given.together.likeness.map(percent),
        best_size_percent: given.together.gain.map(percent),
        turns_as_good_percent: given.turns_as_good.map(percent),
        residual: ResidualAnswer {
            rms_um: to_um(given.together.residual_rms),
            largest_um: to_um(given.together.residual_largest.1),
            largest_at_deg: at_deg(given.together.residual_largest.0),
            beyond_known_um: to_um(given.beyond_known),
        },
        least_wave_um: to_um(given.least_wave),
        waves: given
            .waves
            .iter()
            .map(|pair| wave(pair, given.least_wave))
            .collect(),
    }
}

fn wave(pair: &WavePair, least: f64) -> WaveAnswer {
    let given = pair.reported(least);
    let deg = |phase: Option<f64>| phase.map(to_deg);
    WaveAnswer {
        waves: pair.measured.waves,
        measured_um: to_um(pair.measured.amplitude),
        measured_phase_deg: deg(given.measured_phase),
        predicted_um: to_um(pair.predicted.amplitude),
        predicted_phase_deg: deg(given.predicted_phase),
        phase_difference_deg: deg(given.phase_difference),
        explained_percent: given.explained.map(|share| share * 100.0),
    }
}

/// Whether the path without load is a prediction.
fn is_predicted(combined: &CombinedCurves) -> bool {
    let moves = |one: &Contribution| one.bias.iter().any(|by| *by != 0.0);
    let of_path = |one: &Contribution| one.origin == Origin::Unloaded && moves(one);
    combined.has_cut_way.is_none() && combined.balance.contributions.iter().any(of_path)
}

/// Assumptions, and limits of the numbers.
fn warnings(experiment: &Experiment, combined: &CombinedCurves, given: &BudgetAnswer) -> Vec<String> {
    let mut warnings = experiment.notes.clone();
    match combined.has_cut_way {
        None if is_predicted(combined) => warnings.push(
            "no ball-bar test: the path without load is predicted only from gravity, backlash and geometry".to_owned(),
        ),
        None => warnings.push(
            "no ball-bar test: the deviation without load is not included, but the part contains it".to_owned(),
        ),
        Some(false) => warnings.push(
            "no ball-bar run in the cutting direction: the other direction is used, with its reversals".to_owned(),
        ),
        Some(true) if !combined.both_ways => warnings.push(
            "ball-bar runs in one direction only: deviations that depend on the direction cannot be separated".to_owned(),
        ),
        Some(true) => {}
    }
    if combined.has_cut_way.is_some() && combined.repeatability.is_none() {
        warnings.push(
            "no direction of the ball-bar has two runs: the repeatability of the path is not known"
                .to_owned(),
        );
    }
    if combined.cases > 1 && !combined.cases_are_given {
        warnings.push(
            "the bias is that of the mean force; the greatest force is only included in the envelope"
                .to_owned(),
        );
    }
    let moved = combined
        .balance
        .datums
        .first()
        .map_or(0.0, |datum| datum.centre.norm());
    let second = 1e6 * moved * moved / (2.0 * experiment.radius);
    if second > SECOND_ORDER_UM {
        warnings.push(format!(
            "the load moves the centre by {:.2} mm: it is removed to first order, up to {second:.1} um remain",
            to_mm(moved)
        ));
    }
    if combined.turn.arc() < 0.999 * std::f64::consts::TAU {
        warnings.push(format!(
            "only {:.0} deg of the circle are known: all numbers are those of that arc",
            given.arc_deg
        ));
    }
    let Some(part) = &given.part else {
        let no_part = match experiment.part {
            None => "no part was measured: the budget cannot be verified",
            Some(_) => "the part has no deviation from its datum: there is nothing to explain",
        };
        warnings.push(no_part.to_owned());
        return warnings;
    };
    let by_chance = part.turns_as_good_percent.filter(|percent| *percent > BY_CHANCE);
    if let Some(percent) = by_chance {
        warnings.push(format!(
            "rotated about the circle the prediction agrees as well with the part at {percent:.0} % of all angles: the agreement may be by chance, or zero_deg is wrong"
        ));
    } else if part.explained_percent < LITTLE {
        warnings.push(format!(
            "{:.0} % of the part are explained: similar sizes of prediction and part are not an agreement",
            part.explained_percent
        ));
    }
    warnings
}
