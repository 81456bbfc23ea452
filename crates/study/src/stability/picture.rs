//! The picture of the lobes.

use armill_report::StabilityPlot;

use super::answer::StabilityAnswer;

/// Deepest cut of the picture in multiples of the lowest limit, and of the programmed depth.
const SHOWN: [f64; 2] = [8.0, 1.5];

/// The lobes with the programmed cut.
pub fn picture(answer: &StabilityAnswer) -> StabilityPlot {
    let depths = answer
        .lobes
        .iter()
        .map(|lobe| lobe.depth_mm.unwrap_or(f64::INFINITY));
    let shown = answer.lowest_depth_mm.map(|lowest| {
        (SHOWN[0] * lowest)
            .max(SHOWN[1] * answer.depth_mm)
            .min(answer.deepest_mm)
    });
    StabilityPlot {
        title: format!("Stability of the cut of {}", answer.path),
        subtitle: format!("{}; {}", answer.modes_from, answer.verdict),
        speeds_rpm: answer.lobes.iter().map(|lobe| lobe.speed_rpm).collect(),
        depths_mm: depths.collect(),
        deepest_mm: shown,
        mode_coupling_mm: answer.mode_coupling_depth_mm,
        programmed: Some([answer.spindle_rpm, answer.depth_mm]),
    }
}
