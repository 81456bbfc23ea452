//! The advice as measures that can be applied one by one.

use armill_study::analysis::words::micrometres;
use armill_study::answer::LimitAnswer;
use armill_study::live::{ChangedValue, ProcessValues};
use armill_study::number::decimals;
use armill_study::uncertainty_words::u_in_words;

use super::answer::AdviceAnswer;
use crate::measure::Measure;

/// In the order of the steps, then the permitted cut and the compensation; `placement`: the
/// changes of the placement; `process`: that of the study; `searches`: whether
/// the study has a search for spins already, whose options are to stay.
pub(super) fn measures(
    answer: &AdviceAnswer,
    placement: Vec<ChangedValue>,
    process: Option<&ProcessValues>,
    searches: bool,
) -> Vec<Measure> {
    let name = || Some(answer.analysis.clone());
    let gain_of = |step: &str| answer.steps.iter().find(|one| one.step == step)?.gain_in_words();
    let mut all = Vec::new();
    if answer.moves {
        all.push(Measure {
            measure: "placement",
            sentence: with_gain(
                format!("Place the part at {}", answer.placement.place_in_words()),
                gain_of("placement"),
            ),
            analysis: name(),
            changes: placement,
        });
    }
    if let Some(turns) = answer.turns.as_ref().filter(|_| !searches) {
        all.push(Measure {
            measure: "spin",
            sentence: with_gain(
                format!(
                    "Use a tool spin of {}{} along the path",
                    turns.turn_in_words(),
                    turns.freedoms_in_words()
                ),
                gain_of("spin"),
            ),
            analysis: None,
            changes: vec![search_of_postures()],
        });
    }
    all.extend(spindle_speed(answer, process));
    all.extend(permitted_cut(answer, process));
    all.push(Measure {
        measure: "compensation",
        sentence: format!(
            "Compensate: the predicted largest deviation from the path is then {} µm ({} from robot and force)",
            micrometres(answer.compensated.max_um),
            u_in_words(answer.compensated_u_um),
        ),
        analysis: name(),
        changes: Vec::new(),
    });
    all
}

/// The change that makes a study search spins and branches along its paths.
pub fn search_of_postures() -> ChangedValue {
    ChangedValue {
        key: "posture.search".to_owned(),
        value: serde_json::json!({}),
        whole: true,
    }
}

fn with_gain(what: String, gain: Option<String>) -> String {
    match gain {
        Some(gain) => format!("{what}: {gain}"),
        None => what,
    }
}

/// Another spindle speed with the same feed per tooth, of values that the study gives.
fn spindle_speed(answer: &AdviceAnswer, process: Option<&ProcessValues>) -> Option<Measure> {
    let (speed, process) = (answer.stability.as_ref()?.speed.as_ref()?, process?);
    let elsewhere = &process.given_elsewhere;
    if elsewhere.spindle.is_some() || elsewhere.feed.is_some() {
        return None;
    }
    let change = |key: &str, value: f64| ChangedValue {
        key: format!("{}.{key}", process.key),
        value: decimals(value * speed.times, 1).into(),
        whole: process.whole,
    };
    let [after, before] = speed.stable_depth_mm;
    Some(Measure {
        measure: "spindle",
        sentence: format!(
            "Use a spindle speed of {:.0} rpm with the same feed per tooth: the least stable depth rises from {before:.3} to {after:.3} mm",
            speed.spindle_rpm
        ),
        analysis: Some(answer.analysis.clone()),
        changes: vec![
            change("spindle_rpm", process.spindle_rpm?),
            change("feed_mm_per_min", process.feed_mm_per_min?),
        ],
    })
}

/// The greatest depths and feed without compensation, of values that the study gives.
fn permitted_cut(answer: &AdviceAnswer, process: Option<&ProcessValues>) -> Vec<Measure> {
    let (Some(limits), Some(process)) = (&answer.limits, process) else {
        return Vec::new();
    };
    let tolerance = micrometres(answer.tolerance_um);
    let (elsewhere, in_mm) = (&process.given_elsewhere, |limit: &LimitAnswer| limit.value);
    let cuts = elsewhere.depths.is_none();
    let depth = limits.axial_depth.as_ref().filter(|_| cuts);
    let is_given = process.radial_depth_mm.is_some();
    let width = limits.radial_depth.as_ref().filter(|_| cuts && is_given);
    let teeth = process
        .flutes
        .filter(|_| elsewhere.feed.is_none() && elsewhere.spindle.is_none());
    let per_minute = teeth.zip(process.spindle_rpm).map(|(z, rpm)| f64::from(z) * rpm);
    let feed = limits.feed_per_tooth.as_ref().zip(per_minute);
    let all = [
        depth.map(|limit| Permitted::of(limit, "axial_depth", "a depth of cut", [in_mm(limit), 0.01])),
        width.map(|limit| Permitted::of(limit, "radial_depth", "a width of cut", [in_mm(limit), 0.01])),
        feed.map(|(limit, teeth)| Permitted::of(limit, "feed", "a feed", [in_mm(limit) * teeth, 1.0])),
    ];
    let measure = |permitted: Permitted<'_>| {
        let (unit, key) = match permitted.measure {
            "axial_depth" => ("mm", "axial_depth_mm"),
            "radial_depth" => ("mm", "radial_depth_mm"),
            _ => ("mm/min", "feed_mm_per_min"),
        };
        let value = decimals(permitted.value, 2);
        Measure {
            measure: permitted.measure,
            sentence: format!(
                "Without compensation, {} of up to {value} {unit} is within {tolerance} µm everywhere (line {})",
                permitted.what, permitted.line
            ),
            analysis: Some(answer.analysis.clone()),
            changes: vec![ChangedValue {
                key: format!("{}.{key}", process.key),
                value: value.into(),
                whole: process.whole,
            }],
        }
    };
    let permitted = all
        .into_iter()
        .flatten()
        .filter(|permitted| permitted.value > 0.0);
    permitted.map(measure).collect()
}

/// A limit of the cut.
struct Permitted<'a> {
    measure: &'static str,
    what: &'a str,
    value: f64,
    line: u32,
}

impl<'a> Permitted<'a> {
    /// Rounded down to a multiple of `step`: what is applied is permitted. 0 if not all of it was evaluated.
    fn of(
        limit: &LimitAnswer,
        measure: &'static str,
        what: &'a str,
        [value, step]: [f64; 2],
    ) -> Permitted<'a> {
        let is_limit = limit.verdict == "up to";
        Permitted {
            measure,
            what,
            value: if is_limit {
                (value / step).floor() * step
            } else {
                0.0
            },
            line: limit.line,
        }
    }
}
