//! The summary of the vibration at the points of an analysis, with its sentence and its warning.

use std::f64::consts::TAU;

use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::points::{ForcedVibration, SeriesVibration};
use super::worst::WorstCut;
use crate::analysis::rows::Rows;
use crate::analysis::words::micrometres;

/// The vibration at the points of an analysis.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct VibrationAnswer {
    /// Least and greatest frequency of the lowest mode of the arm; none without modes of the arm.
    pub lowest_mode_hz: Option<[f64; 2]>,
    /// Where it is least, in the reference frame.
    pub lowest_mode_at_mm: Option<[f64; 3]>,
    /// Stability and vibration of the cut; none without a cut.
    pub cut: Option<CutVibrationAnswer>,
}

/// Stability of a cut along the points of an analysis, and its vibration.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CutVibrationAnswer {
    /// Whether the programmed depth is stable at every point: below the limit of mean directional factors, and at the point nearest to its
    /// limit by semi-discretisation too.
    pub is_stable: bool,
    /// Whether the study demands that it is (`must_be_stable`).
    pub is_demanded: bool,
    /// The verdict as a sentence.
    pub verdict: String,
    /// Source of depth and engagement: `cut` (the table of the study or the program), or `stock`.
    pub engagement: &'static str,
    /// Points with a cut.
    pub points: usize,
    /// Of these, points whose depth is not below its limit.
    pub unstable_points: usize,
    /// The point nearest to its limit: the largest programmed depth over the stable depth. In the reference frame.
    pub at_mm: [f64; 3],
    /// Its line, of a program.
    pub line: Option<u32>,
    /// Programmed axial depth there.
    pub depth_mm: f64,
    /// Spindle speed there.
    pub spindle_rpm: f64,
    /// Stable depth there by mean directional factors, the least of the column `stable_depth_mm` if the depth is the same everywhere; none if
    /// it is deeper than what was sought.
    pub stable_depth_mm: Option<f64>,
    /// The same by semi-discretisation.
    pub semi_discretisation_depth_mm: Option<f64>,
    /// Frequency of chatter at this limit.
    pub chatter_frequency_hz: Option<f64>,
    /// The mode with the largest part in it.
    pub cause: Option<String>,
    /// Relative standard uncertainty of the limit; none where it is not known.
    pub depth_u_percent: Option<f64>,
    /// Probability that the programmed cut is stable there; none where the uncertainty is not known.
    pub probability_stable: Option<f64>,
    /// Largest vibration of the tool across its axis under the teeth, from its mean position; none if it was not evaluated.
    pub largest_vibration_um: Option<f64>,
    /// Largest error of a wall by it, by size; positive where the wall is deeper in the part.
    pub largest_surface_error_um: Option<f64>,
    /// Largest programmed depth over the stable depth.
    // unit: none, a ratio
    pub utilisation: f64,
}

/// Below this probability that a cut is stable, a warning is given: two standard uncertainties.
pub const LEAST_PROBABILITY: f64 = 0.977;

impl VibrationAnswer {
    /// Of a series; none if the study does not ask for the vibration. `line`: that of a point, of a program.
    pub fn of(
        rows: &Rows<'_>,
        engagement: &'static str,
        line: &dyn Fn(usize) -> Option<u32>,
    ) -> Option<VibrationAnswer> {
        let series = rows.vibration?;
        let hz = |index: usize| Some(series.points[index]?.lowest? / TAU);
        let mut lowest: Option<(usize, [f64; 2])> = None;
        for (index, here) in (0..series.points.len()).filter_map(|index| Some((index, hz(index)?))) {
            lowest = Some(match lowest {
                None => (index, [here; 2]),
                Some((at, [least, greatest])) => {
                    let at = if here < least { index } else { at };
                    (at, [least.min(here), greatest.max(here)])
                }
            });
        }
        Some(VibrationAnswer {
            lowest_mode_hz: lowest.map(|(_, range)| range),
            lowest_mode_at_mm: lowest.map(|(index, _)| rows.at_mm[index]),
            cut: series
                .worst
                .as_ref()
                .map(|worst| CutVibrationAnswer::of(series, worst, rows, engagement, line(worst.index))),
        })
    }

    /// Lowest mode and verdict, as further sentences; empty without either.
    pub fn sentence(&self) -> String {
        let mode = self
            .lowest_mode_hz
            .map(|[least, greatest]| match greatest - least < 0.05 {
                true => format!(" The lowest mode of the arm is at {least:.1} Hz."),
                false => format!(" The lowest mode of the arm is at {least:.1} to {greatest:.1} Hz."),
            });
        let cut = self.cut.as_ref().map(|cut| {
            let forced = cut.largest_vibration_um.map_or_else(String::new, |um| {
                format!(
                    " Under its teeth the tool vibrates by up to {} µm about its mean position.",
                    micrometres(um)
                )
            });
            format!(" The cut is {}.{forced}", cut.verdict)
        });
        mode.into_iter().chain(cut).collect()
    }

    /// Whether the cut is as stable as the study demands.
    pub fn meets_demand(&self) -> bool {
        let mut cut = self.cut.iter();
        cut.all(|cut| cut.is_stable || !cut.is_demanded)
    }

    /// The warning of a cut that is not stable, or only within its uncertainty.
    pub fn warning(&self, name: &str) -> Option<String> {
        let cut = self.cut.as_ref()?;
        if !cut.is_stable {
            return Some(format!(
                "{name}: the cut chatters, and no deviation of this answer is valid there: it is {}.",
                cut.verdict
            ));
        }
        let probability = cut.probability_stable?;
        (probability < LEAST_PROBABILITY).then(|| {
            format!(
                "{name}: the cut may chatter: it is stable only within the uncertainty of its limit, with a probability of {:.1} %; it is {}.",
                100.0 * probability,
                cut.verdict
            )
        })
    }
}

impl CutVibrationAnswer {
    fn of(
        series: &SeriesVibration,
        worst: &WorstCut,
        rows: &Rows<'_>,
        engagement: &'static str,
        line: Option<u32>,
    ) -> CutVibrationAnswer {
        let depth = worst.cut.milling.cut().depth;
        let unstable = series.unstable();
        let boundary = worst.limit.as_ref().map(|limit| limit.boundary);
        let decisive = worst.exact.or(boundary);
        let largest = |of: fn(&ForcedVibration) -> Option<f64>| {
            let all = series.cuts().filter_map(|(_, cut)| of(&cut.forced?));
            all.reduce(|a, b| if b.abs() > a.abs() { b } else { a })
                .map(to_um)
        };
        let found = CutVibrationAnswer {
            is_stable: worst.is_stable && unstable == 0,
            is_demanded: rows.setting.must_be_stable(),
            verdict: String::new(),
            engagement,
            points: series.cuts().count(),
            unstable_points: unstable,
            at_mm: rows.at_mm[worst.index],
            line,
            depth_mm: to_mm(depth),
            spindle_rpm: worst.cut.spindle * 60.0 / TAU,
            stable_depth_mm: boundary.map(|boundary| to_mm(boundary.depth)),
            semi_discretisation_depth_mm: worst.exact.map(|exact| to_mm(exact.depth)),
            chatter_frequency_hz: decisive.map(|limit| limit.angular_frequency / TAU),
            cause: worst.cause().map(str::to_owned),
            depth_u_percent: worst.relative_uncertainty().map(|u| 100.0 * u),
            probability_stable: worst.probability_stable(),
            largest_vibration_um: largest(|forced| Some(forced.amplitude)),
            largest_surface_error_um: largest(|forced| forced.wall),
            utilisation: series
                .cuts()
                .map(|(_, cut)| cut.utilisation())
                .fold(0.0, f64::max),
        };
        CutVibrationAnswer {
            verdict: found.in_words(),
            ..found
        }
    }

    /// `stable with 2.0 mm at 12000 rpm; unstable above 8.3 mm at (1, 2, 3) mm: arm mode 2 (83 % A2) at 9.1 Hz`.
    fn in_words(&self) -> String {
        let begin = match (self.is_stable, self.unstable_points) {
            (true, _) => "stable".to_owned(),
            (false, 0) => "unstable".to_owned(),
            (false, count) => format!("unstable at {count} of {} points", self.points),
        };
        let [x, y, z] = self.at_mm;
        let line = self
            .line
            .map_or_else(String::new, |line| format!(", line {line}"));
        let limit = self.semi_discretisation_depth_mm.or(self.stable_depth_mm);
        let limit = match (limit, &self.cause, self.chatter_frequency_hz) {
            (Some(limit), Some(cause), Some(hz)) => {
                format!(
                    "unstable above {limit:.3} mm at ({x:.0}, {y:.0}, {z:.0}) mm{line}: {cause} at {hz:.1} Hz"
                )
            }
            _ => "no limit of the depth was found".to_owned(),
        };
        let certain = self.probability_stable.map_or_else(String::new, |probability| {
            format!(" (stable with a probability of {:.1} %)", 100.0 * probability)
        });
        format!(
            "{begin} with {:.3} mm at {:.0} rpm{certain}; {limit}",
            self.depth_mm, self.spindle_rpm
        )
    }
}
