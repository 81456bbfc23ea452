//! The recommended measures as values and sentences.

use armill_study::analysis::words::micrometres;
use armill_study::answer::{LimitsAnswer, SearchAnswer, StatisticsAnswer};
use armill_study::uncertainty_words::u_in_words;
use serde::Serialize;

use super::stability::StabilityAdvice;
use crate::compensate::ErrorAnswer;
use crate::place::PlacementAnswer;

/// Recommended measures for a path.
#[derive(Clone, Debug, Serialize)]
pub struct AdviceAnswer {
    /// Version of this format.
    pub format: u32,
    /// The path.
    pub analysis: String,
    /// What to do, in sentences.
    pub advice: Vec<String>,
    /// The steps, each with its result.
    pub steps: Vec<StepAnswer>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// The path as the study has it.
    pub nominal: StatisticsAnswer,
    /// With all that is advised but compensation.
    pub recommended: StatisticsAnswer,
    /// The search for a place.
    pub placement: PlacementAnswer,
    /// Whether the part should move there.
    pub moves: bool,
    /// Spin of the tool and branches along the path; none if they improve nothing.
    pub turns: Option<SearchAnswer>,
    /// Stretches out of tolerance nevertheless, the worst first.
    pub out_of_tolerance: Vec<StretchAnswer>,
    /// Deviation of the tool from the path there, compensated.
    pub compensated: ErrorAnswer,
    /// Standard uncertainty of the compensated deviation, where it is largest: what remains after compensation; none
    /// where it is not known.
    pub compensated_u_um: Option<f64>,
    /// What keeps the tolerance everywhere, of a program.
    pub limits: Option<LimitsAnswer>,
    /// Whether these limits include the vibration of the cut and demand that it is stable.
    pub limits_are_stable: bool,
    /// By how much all forces may grow until the tolerance is used up; below 1 they must shrink.
    pub force_factor: Option<f64>,
    /// What makes the cut stable; none where it is reliably stable, or its stability is not known.
    pub stability: Option<StabilityAdvice>,
    /// Whether the joint compliances are assumed, not measured.
    pub compliance_assumed: bool,
}

/// Consecutive points out of tolerance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StretchAnswer {
    /// Line of the first, of a program.
    pub first_line: u32,
    /// Line of the last.
    pub last_line: u32,
    /// Its start along the path.
    pub from_mm: f64,
    /// Where it ends.
    pub to_mm: f64,
    /// How many points.
    pub points: usize,
    /// Points of them without posture.
    pub unreachable: usize,
    /// Largest in-plane deviation.
    pub max_in_plane_um: f64,
    /// Largest contributor at the worst of them; none if that is not among the worst of the path.
    pub mostly_by: Option<String>,
}

/// One step: what, how much, how certain, what it costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepAnswer {
    /// `nominal`, `placement`, `spin` or `compensation`.
    pub step: &'static str,
    /// Whether it is advised; the nominal path is.
    pub is_advised: bool,
    /// Largest in-plane deviation with this step and those advised before it; of the compensation the deviation from the
    /// path in any direction.
    pub largest_um: Option<f64>,
    /// Mean in-plane deviation; none of the compensation.
    pub mean_um: Option<f64>,
    /// Points within the tolerance over all points; none of the compensation.
    pub fraction_within: Option<f64>,
    /// Decrease of the objective by the step; none of the nominal path.
    pub gain_um: Option<f64>,
    /// Its standard uncertainty; none if not known.
    pub gain_u_um: Option<f64>,
    /// What the step costs.
    pub costs: &'static str,
}

impl AdviceAnswer {
    /// Recommended measures.
    pub(super) fn sentences(&self) -> Vec<String> {
        let um = |of: &StatisticsAnswer| {
            of.max_in_plane_um
                .map_or("no permitted posture".to_owned(), |um| {
                    format!("{} µm", micrometres(um))
                })
        };
        let share = |of: &StatisticsAnswer| format!("{:.1} %", 100.0 * of.fraction_within);
        let limit = micrometres(self.tolerance_um);
        let mut steps = Vec::new();
        if self.moves {
            steps.push(format!("place the part at {}", self.placement.place_in_words()));
        }
        if let Some(turns) = &self.turns {
            steps.push(format!(
                "use a tool spin of {}{} along the path, with {}",
                turns.turn_in_words(),
                turns.freedoms_in_words(),
                turns.gain_in_words()
            ));
        }
        if steps.is_empty() {
            steps.push("keep part and tool; nothing better was found".to_owned());
        }
        let mut lines = vec![format!(
            "{}: {}; {} of the path is then within {limit} µm, largest deviation {} (nominal: {}, {}{}).",
            self.analysis,
            steps.join(" and "),
            share(&self.recommended),
            um(&self.recommended),
            share(&self.nominal),
            um(&self.nominal),
            self.placement.collision_in_words(&self.placement.nominal),
        )];
        lines.extend(self.steps.iter().filter_map(StepAnswer::sentence));
        lines.extend(self.out_of_tolerance_text());
        lines.push(format!(
            "Compensated (`armill compensate`), the predicted largest deviation from the path is {} µm ({} from robot and force); it costs a new program.",
            micrometres(self.compensated.max_um),
            u_in_words(self.compensated_u_um),
        ));
        lines.extend(self.stability.iter().flat_map(StabilityAdvice::sentences));
        lines.extend(self.permitted_text());
        if self.compliance_assumed {
            lines.push(
                "The joint compliances are assumed, not measured: use the ranking, not the absolute numbers."
                    .to_owned(),
            );
        }
        lines
    }

    /// The stretches out of tolerance, and why.
    fn out_of_tolerance_text(&self) -> Option<String> {
        let given: Vec<String> = self
            .out_of_tolerance
            .iter()
            .take(3)
            .map(|stretch| {
                let why = match (stretch.unreachable, &stretch.mostly_by) {
                    (unreachable, _) if unreachable > 0 => format!("no posture at {unreachable} points"),
                    (_, Some(by)) => format!(
                        "up to {} µm, largest contribution: {by}",
                        micrometres(stretch.max_in_plane_um)
                    ),
                    (_, None) => format!("up to {} µm", micrometres(stretch.max_in_plane_um)),
                };
                format!("{:.0} to {:.0} mm ({why})", stretch.from_mm, stretch.to_mm)
            })
            .collect();
        let more = match self.out_of_tolerance.len() {
            0 => return None,
            count if count > given.len() => " and others",
            _ => "",
        };
        Some(format!(
            "The tolerance is not met from {}{more}.",
            given.join(", from ")
        ))
    }

    /// The permitted cut, or the permitted forces.
    fn permitted_text(&self) -> Option<String> {
        let limit = micrometres(self.tolerance_um);
        let stable = match self.limits_are_stable {
            true => ", with its vibration, and stable",
            false => "",
        };
        let cut = self
            .limits
            .as_ref()
            .and_then(|limits| limits.axial_depth.as_ref());
        if let Some(depth) = cut {
            return Some(format!(
                "Without compensation, the depth of cut to be within {limit} µm{stable} everywhere is {} {:.2} mm (line {}).",
                depth.verdict, depth.value, depth.line
            ));
        }
        let factor = self.force_factor?;
        Some(match factor < 1.0 {
            true => format!(
                "Without compensation, the path is within {limit} µm everywhere with {factor:.2} times these forces."
            ),
            false => format!("The path is within the tolerance with up to {factor:.1} times these forces."),
        })
    }
}

impl StepAnswer {
    /// Gain, uncertainty and price of a placement or a spin.
    fn sentence(&self) -> Option<String> {
        let what = match self.step {
            "placement" => "Placement",
            "spin" => "Spin of the tool",
            _ => return None,
        };
        if self.gain_um? == 0.0 && !self.is_advised {
            return Some(format!("{what}: keep it; none of those searched is better."));
        }
        let gain = self.gain_in_words()?;
        Some(match self.is_advised {
            true => format!("{what}: {gain}; it costs {}.", self.costs),
            false => format!(
                "{what}: keep it; the best that was found gives {gain}, which is no significant gain, and costs {}.",
                self.costs
            ),
        })
    }

    /// "27 µm less ± 12.8 µm (k = 2)"; none of a step without a gain.
    pub(super) fn gain_in_words(&self) -> Option<String> {
        let gain = self.gain_um?;
        let by = match gain < 0.0 {
            true => format!("{} µm more", micrometres(-gain)),
            false => format!("{} µm less", micrometres(gain)),
        };
        let certain = match self.gain_u_um {
            Some(u) => format!("± {} µm (k = 2)", micrometres(2.0 * u)),
            None => "of unknown uncertainty".to_owned(),
        };
        Some(format!("{by} {certain}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_has_its_gain_its_uncertainty_and_its_price() {
        let step = StepAnswer {
            step: "placement",
            is_advised: true,
            largest_um: Some(40.0),
            mean_um: None,
            fraction_within: None,
            gain_um: Some(25.0),
            gain_u_um: Some(4.0),
            costs: "a new set-up of the part",
        };
        assert_eq!(
            step.sentence().unwrap(),
            "Placement: 25 µm less ± 8 µm (k = 2); it costs a new set-up of the part."
        );
        let kept = StepAnswer {
            is_advised: false,
            gain_u_um: None,
            ..step.clone()
        };
        assert!(
            kept.sentence()
                .unwrap()
                .contains("keep it; the best that was found gives 25 µm less of unknown")
        );
        let nominal = StepAnswer {
            step: "nominal",
            ..step
        };
        assert_eq!(nominal.sentence(), None);
    }
}
