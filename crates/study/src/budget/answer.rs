//! The budget in numbers with their units.
//!
//! Deviations are radial, outwards positive; angles count from +y' of the plane towards z', the way in which the circle
//! is cut. Percentages of what is explained are of the measured mean square; below 0 a curve is worse than none.

use armill_core::budget::turn::largest;
use armill_core::budget::{Comparison, Contribution, Datum, Origin, Share, WavePair};
use schemars::JsonSchema;
use serde::Serialize;

use super::combine::{Beside, Combined};
use crate::file::experiment::Experiment;
use crate::file::path::PathAnalysis;

/// What the error of a circle is made of.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BudgetAnswer {
    /// Name of the path.
    pub analysis: String,
    /// Posture asked for: words of a branch, or `best`.
    pub branch: String,
    /// Nominal radius of the circle.
    pub radius_mm: f64,
    /// The files that were measured, and what they are of.
    pub files: Vec<FileAnswer>,
    /// What every curve counts from.
    pub datum: DatumAnswer,
    /// Angles at which curves are compared.
    pub angles: usize,
    /// How much of a turn they cover.
    pub arc_deg: f64,
    /// Each part of the error.
    pub contributions: Vec<ContributionAnswer>,
    /// Load cases that the deviation under load was predicted for.
    pub load_cases: usize,
    /// Least and greatest deviation that the load makes of all of them, from the nominal circle.
    pub load_envelope_um: [f64; 2],
    /// Standard deviation of ball-bar runs the same way; where no way has two, of the arm as robot file or study tell it;
    /// none where neither does.
    pub repeatability_um: Option<f64>,
    /// What they make together.
    pub sums: SumsAnswer,
    /// What is predicted of the path without load beside what the ball-bar saw; none where either is missing.
    pub without_load: Option<WithoutLoadAnswer>,
    /// The part beside them; none where it was not measured.
    pub part: Option<PartAnswer>,
    /// What a user must know, each a sentence.
    pub warnings: Vec<String>,
    /// Where definitions and methods come from.
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

/// What curves count from.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DatumAnswer {
    /// `least-squares` of each curve, or `as-measured`.
    pub centre: &'static str,
    /// Likewise.
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
    /// Standard uncertainty of the bias, root mean square round the circle, where it is known.
    pub bias_u_um: Option<f64>,
    /// Root mean square of the standard deviation of one cut.
    pub scatter_um: f64,
    /// Centre that was taken off, along y' and z'.
    pub centre_um: [f64; 2],
    /// Radius that was taken off, beyond the nominal one.
    pub radius_um: f64,
    /// What it explains of the part alone; none without part or bias.
    pub explained_alone_percent: Option<f64>,
    /// What the others explain without it, likewise.
    pub explained_without_percent: Option<f64>,
}

/// The path without load, predicted (gravity, backlash, geometry) and measured the way it was cut.
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
    /// How alike the shapes are.
    pub likeness_percent: Option<f64>,
}

/// What the parts make together.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SumsAnswer {
    /// Largest bias of what the load does.
    pub load_um: f64,
    /// Largest bias of the path without load, the way it was cut.
    pub unloaded_um: f64,
    /// Largest sum of biases, added with their signs at every angle.
    pub as_functions_um: f64,
    /// The same with twice the scatter.
    pub with_scatter_um: f64,
    /// Standard uncertainty of the biases together, root mean square round the circle, as far as it is known.
    pub u_um: f64,
    /// Root of the squares of `load_um` and `unloaded_um`.
    pub root_sum_square_um: f64,
    /// `load_um` and `unloaded_um` added plainly, as the paper does.
    pub plain_um: f64,
}

/// The part beside its prediction.
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
    /// Centre in the axes of its file, where deviations count from it.
    pub centre_mm: Option<[f64; 2]>,
    /// Radius beyond the nominal one, where it was taken off.
    pub radius_um: f64,
    /// Standard uncertainty of a point, as the study tells it.
    pub u_um: f64,
    /// How much of its mean square all contributions explain.
    pub explained_percent: f64,
    /// How much could be explained: the rest is known scatter.
    pub explainable_percent: f64,
    /// How alike the shapes are, whatever the size: 100 alike, 0 unlike, -100 upside down.
    pub likeness_percent: Option<f64>,
    /// The size that would explain most, of the predicted one.
    pub best_size_percent: Option<f64>,
    /// Of all turns of the prediction round the circle those at which it is as like the part.
    pub turns_as_good_percent: Option<f64>,
    /// What is not explained.
    pub residual: ResidualAnswer,
    /// Waves of less amplitude are none: they have no phase, and no share.
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
    /// Root mean square beyond all known scatter and uncertainty: what has another cause.
    pub beyond_known_um: f64,
}

/// One wave of the part and of its prediction.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WaveAnswer {
    /// A turn.
    pub waves: usize,
    /// Amplitude of the part.
    pub measured_um: f64,
    /// Its phase: a crest lies at this over `waves`; none where there is no wave.
    pub measured_phase_deg: Option<f64>,
    /// Amplitude of the prediction.
    pub predicted_um: f64,
    /// Its phase, likewise.
    pub predicted_phase_deg: Option<f64>,
    /// Phase of the prediction beyond that of the part, where both are there.
    pub phase_difference_deg: Option<f64>,
    /// How much of this wave of the part is explained; none where there is no wave.
    pub explained_percent: Option<f64>,
}

/// A part of which less than this is explained is not understood, percent.
const LITTLE: f64 = 50.0;
/// A prediction that is as good at more of its turns than this may be so by chance, percent.
const BY_CHANCE: f64 = 5.0;
/// What a centre that is taken off to first order may leave untold, um.
const SECOND_ORDER_UM: f64 = 1.0;

const SOURCES: [&str; 3] = [
    "scatter as variances, uncertainty: JCGM 100 (GUM)",
    "plain sum of the load's and the path's largest deviation: section 5 of the paper in docs/notation.md",
    "theory: docs/theory/budget.md",
];

/// What `combined` says.
pub fn answer(experiment: &Experiment, path: &PathAnalysis, combined: &Combined) -> BudgetAnswer {
    let um = |value: f64| value * 1e6;
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
        radius_mm: experiment.radius * 1e3,
        files: files(experiment, path),
        datum: DatumAnswer {
            centre: datum(experiment.removed.centre),
            radius: datum(experiment.removed.radius),
        },
        angles: combined.turn.angle().len(),
        arc_deg: combined.turn.arc().to_degrees(),
        contributions: contributions
            .map(|(index, (one, datum))| contribution(combined, (one, datum), shares.map(|all| all[index])))
            .collect(),
        load_cases: combined.cases,
        load_envelope_um: [
            um(least.iter().copied().fold(f64::MAX, f64::min)),
            um(greatest.iter().copied().fold(f64::MIN, f64::max)),
        ],
        repeatability_um: combined.repeatability.map(um),
        sums: SumsAnswer {
            load_um: um(sums.of_origin[0]),
            unloaded_um: um(sums.of_origin[1]),
            as_functions_um: um(sums.largest),
            with_scatter_um: um(sums.largest_with_scatter),
            u_um: um(sums.u),
            root_sum_square_um: um(sums.root_sum_square),
            plain_um: um(sums.plain),
        },
        without_load: combined
            .without_load
            .as_ref()
            .map(|beside| without_load(combined, beside)),
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
    combined: &Combined,
    (one, datum): (&Contribution, &Datum),
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
        largest_um: most * 1e6,
        largest_at_deg: turn.angle()[at].to_degrees(),
        rms_um: turn.rms(&one.bias) * 1e6,
        bias_u_um: one.u.map(|u| u * 1e6),
        scatter_um: turn.rms(&one.scatter) * 1e6,
        centre_um: [datum.centre.x * 1e6, datum.centre.y * 1e6],
        radius_um: datum.radius * 1e6,
        explained_alone_percent: share.map(|share| share.alone * 100.0),
        explained_without_percent: share.map(|share| share.without * 100.0),
    }
}

fn without_load(combined: &Combined, beside: &Beside) -> WithoutLoadAnswer {
    let turn = &combined.turn;
    let most = |curve: &[f64]| {
        let (at, most) = largest(curve);
        (most * 1e6, turn.angle()[at].to_degrees())
    };
    let [(predicted_um, predicted_at_deg), (measured_um, measured_at_deg)] =
        [most(&beside.predicted), most(&beside.measured)];
    WithoutLoadAnswer {
        predicted_um,
        predicted_at_deg,
        predicted_rms_um: turn.rms(&beside.predicted) * 1e6,
        measured_um,
        measured_at_deg,
        measured_rms_um: turn.rms(&beside.measured) * 1e6,
        explained_percent: beside.agreement.explained * 100.0,
        likeness_percent: beside.agreement.likeness.map(|share| share * 100.0),
    }
}

fn part(experiment: &Experiment, combined: &Combined, given: &Comparison) -> PartAnswer {
    let at_deg = |at: usize| combined.turn.angle()[at].to_degrees();
    let of_file = experiment.part.as_ref();
    let (at, most) = largest(&given.measured);
    let percent = |share: f64| share * 100.0;
    PartAnswer {
        points: of_file.map_or(0, |part| part.points),
        largest_um: most * 1e6,
        largest_at_deg: at_deg(at),
        rms_um: given.measured_rms * 1e6,
        centre_mm: of_file
            .and_then(|part| part.centre)
            .map(|centre| centre.map(|m| m * 1e3)),
        radius_um: given.datum.radius * 1e6,
        u_um: of_file.map_or(0.0, |part| part.u * 1e6),
        explained_percent: percent(given.together.explained),
        explainable_percent: percent(given.explainable),
        likeness_percent: given.together.likeness.map(percent),
        best_size_percent: given.together.gain.map(percent),
        turns_as_good_percent: given.turns_as_good.map(percent),
        residual: ResidualAnswer {
            rms_um: given.together.residual_rms * 1e6,
            largest_um: given.together.residual_largest.1 * 1e6,
            largest_at_deg: at_deg(given.together.residual_largest.0),
            beyond_known_um: given.beyond_known * 1e6,
        },
        least_wave_um: given.least_wave * 1e6,
        waves: given
            .waves
            .iter()
            .map(|pair| wave(pair, given.least_wave))
            .collect(),
    }
}

fn wave(pair: &WavePair, least: f64) -> WaveAnswer {
    let given = pair.given(least);
    let deg = |phase: Option<f64>| phase.map(f64::to_degrees);
    WaveAnswer {
        waves: pair.measured.waves,
        measured_um: pair.measured.amplitude * 1e6,
        measured_phase_deg: deg(given.measured_phase),
        predicted_um: pair.predicted.amplitude * 1e6,
        predicted_phase_deg: deg(given.predicted_phase),
        phase_difference_deg: deg(given.phase_difference),
        explained_percent: given.explained.map(|share| share * 100.0),
    }
}

/// Whether the path without load is a prediction.
fn is_predicted(combined: &Combined) -> bool {
    let moves = |one: &Contribution| one.bias.iter().any(|by| *by != 0.0);
    let of_path = |one: &Contribution| one.origin == Origin::Unloaded && moves(one);
    combined.has_cut_way.is_none() && combined.balance.contributions.iter().any(of_path)
}

/// What was taken for granted, and what the numbers do not bear.
fn warnings(experiment: &Experiment, combined: &Combined, given: &BudgetAnswer) -> Vec<String> {
    let mut warnings = experiment.notes.clone();
    match combined.has_cut_way {
        None if is_predicted(combined) => warnings.push(
            "no ball-bar test: the path without load is predicted from gravity, backlash and geometry alone".to_owned(),
        ),
        None => warnings.push(
            "no ball-bar test: what the path does without load is left out, and the part holds it".to_owned(),
        ),
        Some(false) => warnings.push(
            "no ball-bar run goes the way that is cut: that of the other way stands for it, with its reversals".to_owned(),
        ),
        Some(true) if !combined.both_ways => warnings.push(
            "the ball-bar went one way alone: what turns with the way is not told apart".to_owned(),
        ),
        Some(true) => {}
    }
    if combined.has_cut_way.is_some() && combined.repeatability.is_none() {
        warnings
            .push("no way of the ball-bar has two runs: nothing tells how well the path repeats".to_owned());
    }
    if combined.cases > 1 && !combined.cases_are_given {
        warnings.push("the mean force makes the bias; the greatest stands in the envelope alone".to_owned());
    }
    let moved = combined
        .balance
        .datums
        .first()
        .map_or(0.0, |datum| datum.centre.norm());
    let second = 1e6 * moved * moved / (2.0 * experiment.radius);
    if second > SECOND_ORDER_UM {
        warnings.push(format!(
            "the load moves the centre by {:.2} mm: taken off to first order, up to {second:.1} um of it are left",
            moved * 1e3
        ));
    }
    if combined.turn.arc() < 0.999 * std::f64::consts::TAU {
        warnings.push(format!(
            "{:.0} deg of the turn are known: all numbers are those of that arc",
            given.arc_deg
        ));
    }
    let Some(part) = &given.part else {
        let no_part = match experiment.part {
            None => "no part was measured: nothing tells whether the budget is right",
            Some(_) => "the part shows nothing beside its datum: nothing is left to be explained",
        };
        warnings.push(no_part.to_owned());
        return warnings;
    };
    let by_chance = part.turns_as_good_percent.filter(|percent| *percent > BY_CHANCE);
    if let Some(percent) = by_chance {
        warnings.push(format!(
            "turned round the circle the prediction is as like the part at {percent:.0} % of all angles: the likeness may be chance, or zero_deg wrong"
        ));
    } else if part.explained_percent < LITTLE {
        warnings.push(format!(
            "{:.0} % of the part are explained: equal sizes of prediction and part would be no agreement",
            part.explained_percent
        ));
    }
    warnings
}
