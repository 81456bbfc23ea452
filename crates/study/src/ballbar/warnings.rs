//! What a user must know before the numbers of a circular test are used.

use armill_core::measure::ballbar::Direction;

use super::analyse::{Centring, Found, Question};
use super::answer::BallbarAnswer;
use super::read::Measured;

/// Each a sentence: what is missing, what was doubted, what cannot be told apart.
pub(super) fn warnings(
    measured: &Measured,
    question: &Question,
    (found, given): (&Found, &BallbarAnswer),
) -> Vec<String> {
    let mut warnings = measured.notes.clone();
    let unused = measured.unused.iter();
    warnings.extend(unused.map(|of| format!("a column was passed over, {of}")));
    for direction in Direction::BOTH {
        match found.test.of(direction).count() {
            0 => warnings.push(format!(
                "no {} run: G(b), D and H are not told, and steps not parted from what is the same both ways",
                direction.name()
            )),
            1 => warnings.push(format!(
                "one {} run alone: nothing tells how well it repeats",
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
            "{} has no samples from {}: its G and F are those of the arc, D and lobes are not told",
            run.name,
            gaps.collect::<Vec<_>>().join(" and from ")
        ));
    }
    if question.centring == Centring::LeastSquares && !found.is_centred {
        warnings.push(
            "no arc is long enough for a least-squares centre: radii are counted from the set-up".to_owned(),
        );
    }
    let dirt = given
        .outliers
        .iter()
        .filter(|outlier| !outlier.at_reversal)
        .count();
    if dirt > 0 {
        warnings.push(match question.without_outliers {
            true => format!("{dirt} outliers were left out"),
            false => format!("{dirt} samples are off their neighbours and count: dirt (--leave-out-outliers leaves them out), or the step of a joint that turns back there (`armill backlash` tells which)"),
        });
    }
    if given.runs.iter().any(|run| run.shown.circular_um.is_none()) {
        warnings
            .push("no ring is the narrowest about some runs: their arc is too short for its form".to_owned());
    }
    if let Some(lobes) = &found.lobes {
        let given = lobes.harmonics.len();
        if given < question.most_lobes {
            warnings.push(format!(
                "{given} lobes are told, not {}: the samples are too far apart for more",
                question.most_lobes
            ));
        }
    }
    match &given.parts {
        None => warnings.push("too few samples for the parts of the deviation".to_owned()),
        Some(parts) => warnings.extend(parts.not_identifiable.iter().map(|set| match &set[..] {
            [one] => format!("nothing is known of the {one}: no samples beside it"),
            set => format!("not told apart: {}; the first holds the sum", set.join(", ")),
        })),
    }
    warnings
}
