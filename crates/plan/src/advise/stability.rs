//! What makes the cut of a path stable: another spindle speed, or a smaller depth.
//!
//! A speed is advised where its gain of the stable depth exceeds the uncertainty of the limit (k = 2), and the cut is then stable at every point of
//! the path. The feed per tooth stays.

use std::f64::consts::TAU;

use armill_core::path::LoadedTrack;
use armill_core::robot::Robot;
use armill_core::units::to_mm;
use armill_study::analysis::path::PathAnalysis;
use armill_study::analysis::path::run::PathResult;
use armill_study::analysis::path::vibration::{stability, stability_at_speed};
use armill_study::analysis::vibration::answer::LEAST_PROBABILITY;
use armill_study::analysis::vibration::{SeriesVibration, VibrationAnswer};
use serde::Serialize;

/// What makes a cut stable, or more reliably so.
#[derive(Clone, Debug, Serialize)]
pub struct StabilityAdvice {
    /// The cut as programmed, as a sentence.
    pub verdict: String,
    /// Programmed depth at the point that is nearest to its limit.
    pub depth_mm: f64,
    /// Another spindle speed; none if no gain exceeds its uncertainty.
    pub speed: Option<SpeedAdvice>,
    /// Depth that is stable beyond the uncertainty of its limit (k = 2) at the programmed speed; none where that is not known.
    pub reliable_depth_mm: Option<f64>,
}

/// Another spindle speed with the same feed per tooth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedAdvice {
    /// The speed at the point that is nearest to its limit.
    pub spindle_rpm: f64,
    /// Factor on spindle speeds and feeds.
    // unit: none, a ratio
    pub times: f64,
    /// Least stable depth along the path, and with the programmed speed.
    pub stable_depth_mm: [f64; 2],
}

impl StabilityAdvice {
    /// For a path with this result and the vibration along it; none where its cut is reliably stable, or not evaluated.
    pub(super) fn of(
        robot: &Robot,
        analysis: &PathAnalysis,
        found: &PathResult,
        series: Option<&SeriesVibration>,
        summary: Option<&VibrationAnswer>,
    ) -> Option<StabilityAdvice> {
        let (worst, cut) = (series?.worst.as_ref()?, summary?.cut.as_ref()?);
        let is_reliable = cut
            .probability_stable
            .is_none_or(|probability| probability >= LEAST_PROBABILITY);
        if cut.is_stable && is_reliable {
            return None;
        }
        let followed = LoadedTrack {
            track: &analysis.track,
            load: &found.along.load,
        };
        let answers = &found.along.answers;
        let before = stability(robot, analysis, followed, answers)?.worst?;
        let speeds = worst.preferred_speeds().into_iter().filter_map(|speed| {
            let times = speed / worst.cut.spindle;
            let after = stability_at_speed(robot, analysis, followed, answers, times)?;
            let limit = after.worst?;
            let gain = (before.utilisation() / limit.utilisation()).ln();
            // Both limits have this uncertainty; that they share its causes makes the gain more certain.
            let u = worst.relative_uncertainty().unwrap_or(0.0) * 2_f64.sqrt();
            (after.unstable == 0 && gain > 2.0 * u).then_some((limit, times))
        });
        let best = speeds.reduce(|best, other| {
            if other.0.utilisation() < best.0.utilisation() {
                other
            } else {
                best
            }
        });
        Some(StabilityAdvice {
            verdict: cut.verdict.clone(),
            depth_mm: cut.depth_mm,
            speed: best.map(|(limit, times)| SpeedAdvice {
                spindle_rpm: worst.cut.spindle * times * 60.0 / TAU,
                times,
                stable_depth_mm: [to_mm(limit.stable_depth()), to_mm(before.stable_depth())],
            }),
            reliable_depth_mm: worst.reliable_depth().map(to_mm),
        })
    }

    /// The cut, and each change with its effect.
    pub(super) fn sentences(&self) -> Vec<String> {
        let mut lines = vec![format!("The cut is {}.", self.verdict)];
        lines.extend(self.speed.as_ref().map(|speed| {
            let [after, before] = speed.stable_depth_mm;
            format!(
                "Spindle speed: {:.0} rpm with the same feed per tooth raises the least stable depth from {before:.3} to {after:.3} mm; it costs a new program.",
                speed.spindle_rpm
            )
        }));
        if self.speed.is_none() {
            lines.push(
                "Spindle speed: keep it; no speed from half to twice the programmed one gains more than the uncertainty of the limit and is stable everywhere."
                    .to_owned(),
            );
        }
        lines.extend(self.reliable_depth_mm.map(|depth| {
            format!("Depth: up to {depth:.3} mm is stable beyond the uncertainty of the limit (k = 2) at the programmed speed.")
        }));
        lines
    }
}
