//! The answer on the stability of a cut, in mm, µm, Hz and rpm, with the verdict as a sentence.

use std::f64::consts::TAU;

use armill_core::nalgebra::Vector3;
use armill_core::stability::{Boundary, Instability, SurfaceError, WallSide};
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::evaluate::Evaluation;
use super::question::{Question, is_thin};

/// The stability of a cut.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StabilityAnswer {
    /// Name of the path whose cut it is.
    pub path: String,
    /// What the modes are, and where they come from.
    pub modes_from: String,
    /// The modes.
    pub modes: Vec<ModeAnswer>,
    /// Programmed spindle speed.
    pub spindle_rpm: f64,
    /// Programmed axial depth.
    pub depth_mm: f64,
    /// Feed per tooth.
    pub feed_mm_per_tooth: f64,
    /// Whether vibrations of the programmed cut decay.
    pub is_stable: bool,
    /// The verdict as a sentence.
    pub verdict: String,
    /// Limit of the depth at the programmed speed; none if it is deeper than what was sought.
    pub stable_depth_mm: Option<f64>,
    /// How the cut becomes unstable there: `hopf` (chatter), `flip` (period doubling) or `fold`.
    pub instability: Option<String>,
    /// Frequency of chatter at this limit.
    pub chatter_frequency_hz: Option<f64>,
    /// The mode with the largest part in it.
    pub cause: Option<String>,
    /// The same limit by mean directional factors, as in `lobes`.
    pub zeroth_order_depth_mm: Option<f64>,
    /// Limit without regeneration: mode coupling alone.
    pub mode_coupling_depth_mm: Option<f64>,
    /// Frequency of mode coupling; 0 is static divergence.
    pub mode_coupling_frequency_hz: Option<f64>,
    /// The mode with the largest part in it.
    pub mode_coupling_cause: Option<String>,
    /// Which of `stable_depth_mm`, the limit of the verdict, and `mode_coupling_depth_mm` is lower: `regeneration` or `mode coupling`.
    pub lower_limit: Option<String>,
    /// Lowest limit at any speed, beyond the range of the lobes too.
    pub critical_depth_mm: Option<f64>,
    /// Lowest limit within the range of the lobes.
    pub lowest_depth_mm: Option<f64>,
    /// Relative standard uncertainty of the limit at the programmed speed.
    pub depth_u_percent: Option<f64>,
    /// Probability that the programmed cut is stable, from the stated uncertainties.
    pub probability_stable: Option<f64>,
    /// Speeds at which the limit is a local maximum, the deepest first.
    pub preferred_speeds: Vec<PreferredSpeed>,
    /// Spindle speed below which process damping, which is not modelled, makes limits deeper.
    pub conservative_below_rpm: Option<f64>,
    /// Vibration under the teeth, at the tip.
    pub vibration: VibrationAnswer,
    /// The limit over the spindle speed, zeroth-order solution.
    pub lobes: Vec<LobeAnswer>,
    /// Deepest limit sought.
    pub deepest_mm: f64,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A mode.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ModeAnswer {
    /// Its name.
    pub name: String,
    /// Undamped natural frequency.
    pub frequency_hz: f64,
    /// Damping ratio in per cent.
    pub damping_percent: f64,
}

/// The limit at one speed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LobeAnswer {
    /// Spindle speed.
    pub speed_rpm: f64,
    /// Limit of the depth; none if it is deeper than what was sought.
    pub depth_mm: Option<f64>,
    /// Frequency of chatter at the limit.
    pub chatter_frequency_hz: Option<f64>,
    /// The mode with the largest part in it.
    pub cause: Option<String>,
}

/// A speed at which the limit is a local maximum.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PreferredSpeed {
    /// Spindle speed.
    pub speed_rpm: f64,
    /// Limit of the depth there; none if it is deeper than what was sought.
    pub depth_mm: Option<f64>,
}

/// Vibration under the teeth, without chatter.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct VibrationAnswer {
    /// Half the range in a period of the teeth: along the feed, to its left, along the tool.
    pub amplitude_um: [f64; 3],
    /// Mean displacement by the modes given, in the same axes.
    pub mean_um: [f64; 3],
    /// Error of each wall.
    pub walls: Vec<WallAnswer>,
}

/// Surface location error: positive where the wall is deeper in the part.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WallAnswer {
    /// `left` or `right` of the feed.
    pub side: &'static str,
    /// At the tip of the tool.
    pub at_tip_um: f64,
    /// Least along the edge.
    pub least_um: f64,
    /// Greatest along the edge.
    pub greatest_um: f64,
}

/// Most preferred speeds that are listed.
const MOST_PREFERRED: usize = 5;
/// Waves of chatter from tooth to tooth from which process damping is usual. Source: Tunc, Budak 2012, lobes beyond about the tenth [recalled].
const DAMPED_WAVES: f64 = 10.0;
/// Difference of the two solutions, in parts, from which it is reported.
const DIFFERENT: f64 = 0.2;

/// The answer of this evaluation.
pub fn answer(question: &Question, found: &Evaluation) -> StabilityAnswer {
    let depth = question.milling.cut().depth;
    let name = |boundary: &Boundary| {
        question
            .modes
            .get(boundary.mode)
            .map_or_else(String::new, |mode| mode.name.clone())
    };
    let boundary = found.boundary.as_ref().map(|(boundary, _)| boundary);
    let zeroth = found.zeroth.as_ref().map(|zeroth| zeroth.boundary);
    let lower_limit = match (boundary, &found.mode_coupling) {
        (None, None) => None,
        (Some(b), Some(coupling)) if coupling.depth < b.depth => Some("mode coupling"),
        (None, Some(_)) => Some("mode coupling"),
        (Some(_), _) => Some("regeneration"),
    };
    let lobes: Vec<LobeAnswer> = found
        .lobes
        .iter()
        .map(|lobe| LobeAnswer {
            speed_rpm: to_rpm(lobe.spindle),
            depth_mm: lobe.boundary.map(|boundary| to_mm(boundary.depth)),
            chatter_frequency_hz: lobe.boundary.map(|boundary| to_hz(boundary.angular_frequency)),
            cause: lobe.boundary.as_ref().map(name),
        })
        .collect();
    let lowest = lobes
        .iter()
        .filter_map(|lobe| lobe.depth_mm)
        .min_by(f64::total_cmp);
    let flutes = f64::from(question.milling.cutter().flutes());
    StabilityAnswer {
        path: question.path.clone(),
        modes_from: question.modes_from.clone(),
        modes: question
            .modes
            .iter()
            .map(|mode| ModeAnswer {
                name: mode.name.clone(),
                frequency_hz: to_hz(mode.mode.angular_frequency),
                damping_percent: 100.0 * mode.mode.damping_ratio,
            })
            .collect(),
        spindle_rpm: to_rpm(question.spindle),
        depth_mm: to_mm(depth),
        feed_mm_per_tooth: to_mm(question.milling.cut().feed),
        is_stable: found.programmed.is_stable(),
        verdict: verdict(question, found, boundary.map(name)),
        stable_depth_mm: boundary.map(|boundary| to_mm(boundary.depth)),
        instability: found
            .boundary
            .map(|(_, instability)| word(instability).to_owned()),
        chatter_frequency_hz: boundary.map(|boundary| to_hz(boundary.angular_frequency)),
        cause: boundary.map(name),
        zeroth_order_depth_mm: zeroth.map(|boundary| to_mm(boundary.depth)),
        mode_coupling_depth_mm: found.mode_coupling.map(|boundary| to_mm(boundary.depth)),
        mode_coupling_frequency_hz: found
            .mode_coupling
            .map(|boundary| to_hz(boundary.angular_frequency)),
        mode_coupling_cause: found.mode_coupling.as_ref().map(name),
        lower_limit: lower_limit.map(str::to_owned),
        critical_depth_mm: found.critical.map(|boundary| to_mm(boundary.depth)),
        lowest_depth_mm: lowest,
        depth_u_percent: found.zeroth.as_ref().map(|zeroth| 100.0 * zeroth.of_log_depth),
        probability_stable: probability(question, found),
        preferred_speeds: preferred(&lobes, lowest),
        conservative_below_rpm: boundary
            .map(|boundary| 60.0 * to_hz(boundary.angular_frequency) / (DAMPED_WAVES * flutes)),
        vibration: vibration(found),
        lobes,
        deepest_mm: to_mm(question.deepest),
        notes: notes(question, found),
    }
}

/// Probability from the relative uncertainty of the zeroth-order limit about the limit of the semi-discretisation.
fn probability(question: &Question, found: &Evaluation) -> Option<f64> {
    let (zeroth, (boundary, _)) = (found.zeroth.as_ref()?, found.boundary.as_ref()?);
    let shifted = zeroth.clone().about(*boundary);
    (zeroth.of_log_depth > 0.0).then(|| shifted.probability_stable(question.milling.cut().depth))
}

fn verdict(question: &Question, found: &Evaluation, cause: Option<String>) -> String {
    let [rpm, depth] = [to_rpm(question.spindle), to_mm(question.milling.cut().depth)];
    let begin = match found.programmed.is_stable() {
        true => format!("stable at {rpm:.0} rpm and {depth:.3} mm"),
        false => format!("unstable at {rpm:.0} rpm and {depth:.3} mm"),
    };
    let limit = match (&found.boundary, cause) {
        (Some((boundary, instability)), Some(cause)) => format!(
            "the limit is {:.3} mm: {} of mode {cause} at {:.1} Hz",
            to_mm(boundary.depth),
            match instability {
                Instability::Hopf => "chatter",
                Instability::Flip => "period doubling",
                Instability::Fold => "divergence",
            },
            to_hz(boundary.angular_frequency)
        ),
        _ => format!("there is no limit up to {:.3} mm", to_mm(question.deepest)),
    };
    format!("{begin}; {limit}")
}

fn word(instability: Instability) -> &'static str {
    match instability {
        Instability::Hopf => "hopf",
        Instability::Flip => "flip",
        Instability::Fold => "fold",
    }
}

/// Local maxima of the limit, the deepest first; without the lowest.
fn preferred(lobes: &[LobeAnswer], lowest: Option<f64>) -> Vec<PreferredSpeed> {
    let depth = |lobe: &LobeAnswer| lobe.depth_mm.unwrap_or(f64::INFINITY);
    let mut found: Vec<PreferredSpeed> = lobes
        .windows(3)
        .filter(|three| depth(&three[1]) > depth(&three[0]) && depth(&three[1]) >= depth(&three[2]))
        .filter(|three| lowest.is_none_or(|lowest| depth(&three[1]) > 1.05 * lowest))
        .map(|three| PreferredSpeed {
            speed_rpm: three[1].speed_rpm,
            depth_mm: three[1].depth_mm,
        })
        .collect();
    let of = |speed: &PreferredSpeed| speed.depth_mm.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| of(b).total_cmp(&of(a)));
    found.truncate(MOST_PREFERRED);
    found
}

fn vibration(found: &Evaluation) -> VibrationAnswer {
    let um = |vector: Vector3<f64>| [0, 1, 2].map(|axis| to_um(vector[axis]));
    VibrationAnswer {
        amplitude_um: um(found.forced.amplitude()),
        mean_um: um(found.forced.mean()),
        walls: found.walls.iter().map(wall).collect(),
    }
}

fn wall(error: &SurfaceError) -> WallAnswer {
    WallAnswer {
        side: match error.side {
            WallSide::Left => "left",
            WallSide::Right => "right",
        },
        at_tip_um: to_um(error.at_tip),
        least_um: to_um(error.least),
        greatest_um: to_um(error.greatest),
    }
}

fn notes(question: &Question, found: &Evaluation) -> Vec<String> {
    let mut notes = question.remarks.clone();
    let zeroth = found.zeroth.as_ref().map(|zeroth| zeroth.boundary.depth);
    let exact = found.boundary.map(|(boundary, _)| boundary.depth);
    match (zeroth, exact) {
        (Some(zeroth), Some(exact)) if (zeroth / exact - 1.0).abs() > DIFFERENT => notes.push(format!(
            "Lobes from mean directional factors are not accurate in this cut: at the programmed speed they give {:.3} mm in place of {:.3} mm.",
            to_mm(zeroth),
            to_mm(exact)
        )),
        (None, Some(_)) | (Some(_), None) => notes.push(
            "Lobes from mean directional factors are not accurate in this cut: at the programmed speed only one of the two solutions has a limit."
                .to_owned(),
        ),
        _ => {}
    }
    if let Some(coupling) = found
        .mode_coupling
        .filter(|coupling| coupling.depth < question.milling.cut().depth)
    {
        notes.push(format!(
            "The depth exceeds the limit by mode coupling, {:.3} mm: it is stable only as far as each tooth cuts the waves of the tooth before.",
            to_mm(coupling.depth)
        ));
    }
    if question.milling.cutter().runout().offset > 0.0 {
        notes.push("The runout of the cutter is neglected: every tooth cuts the same chip.".to_owned());
    }
    if is_thin(&question.milling) {
        notes.push(
            "The feed per tooth is below 0.005 mm: edges plough there, and limits are uncertain.".to_owned(),
        );
    }
    if found
        .zeroth
        .as_ref()
        .is_some_and(|zeroth| zeroth.of_log_depth == 0.0)
    {
        notes.push(
            "No uncertainty is known: give frequency_u_hz, damping_u_percent and stiffness_u_percent of the modes for a probability."
                .to_owned(),
        );
    }
    notes.push("Not modelled: process damping, loss of contact, vibration of the part.".to_owned());
    notes
}

/// rad/s in rpm.
fn to_rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

/// rad/s in Hz.
fn to_hz(angular: f64) -> f64 {
    angular / TAU
}
