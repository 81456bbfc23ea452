//! What a user must know before the numbers of a circular test are used.

use armill_core::measure::ballbar::Direction;

use super::analyse::{BallbarAnalysis, Centring, Question};
use super::answer::BallbarAnswer;

/// One sentence each: missing data, excluded or suspicious data, quantities that cannot be separated.
pub(super) fn warnings(
    question: &Question,
    found: &BallbarAnalysis<'_>,
    given: &BallbarAnswer,
) -> Vec<String> {
    let mut warnings = found.measured.notes.clone();
    let unused = found.measured.unused.iter();
    warnings.extend(unused.map(|of| format!("unused column: {of}")));
    for direction in Direction::BOTH {
        match found.test.of(direction).count() {
            0 => warnings.push(format!(
                "no {} run: G(b), D and H are not known, and steps cannot be separated from deviations common to both directions",
                direction.name()
            )),
            1 => warnings.push(format!(
                "only one {} run: its repeatability is not known",
                direction.name()
            )),
            _ => {}
        }
    }
    for run in given.runs.iter().filter(|run| !run.gaps_deg.is_empty()) {
        let gaps = run
            .gaps_deg
            .iter()
            .map(|[from, to]| format!("{from:.1} to {to:.1} deg"));
        warnings.push(format!(
            "{} has no samples from {}: its G and F are those of the arc, D and lobes are not known",
            run.name,
            gaps.collect::<Vec<_>>().join(" and from ")
        ));
    }
    if question.centring == Centring::LeastSquares && !found.is_centred {
        warnings.push(
            "no arc is long enough for a least-squares centre: radii are relative to the set-up".to_owned(),
        );
    }
    let dirt = given
        .outliers
        .iter()
        .filter(|outlier| !outlier.at_reversal)
        .count();
    if dirt > 0 {
        warnings.push(match question.without_outliers {
            true => format!("{dirt} outliers were excluded"),
            false => format!("{dirt} samples differ from their neighbours and are included: dirt (use --leave-out-outliers to exclude them), or the step at a reversal of a joint (`armill backlash` reports the joint)"),
        });
    }
    if given.runs.iter().any(|run| run.shown.circular_um.is_none()) {
        warnings.push("some runs have no circularity: their arc is too short".to_owned());
    }
    if let Some(lobes) = &found.lobes {
        let given = lobes.harmonics.len();
        if given < question.most_lobes {
            warnings.push(format!(
                "{given} lobes are reported, not {}: the samples are too far apart for more",
                question.most_lobes
            ));
        }
    }
    match &given.parts {
        None => warnings.push("too few samples for the parts of the deviation".to_owned()),
        Some(parts) => warnings.extend(parts.not_identifiable.iter().map(|set| match &set[..] {
            [one] => format!("{one} is not known: there are no samples to separate it"),
            set => format!("not separable: {}; the first has the sum", set.join(", ")),
        })),
    }
    warnings
}
