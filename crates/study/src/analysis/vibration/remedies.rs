//! What makes a cut stable, or more reliably so: another spindle speed with the same feed per tooth, or a smaller depth.
//!
//! ```text
//! reliable depth    b exp(-k u)                        with the coverage factor k = 2
//! other speeds      local maxima of the limit from half to twice the programmed speed, the deepest first
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `b` | limit of the depth at the point that is nearest to it | m |
//! | `u` | standard uncertainty of its logarithm | - |
//!
//! Speeds are those of that point; whether they suit all points is for the caller to evaluate.

use armill_core::map::COVERAGE;
use armill_core::stability::named_mode::modes;
use armill_core::stability::{CutOfAnyDepth, StabilityLobes};

use super::worst::WorstCut;

/// Range of the speeds, over the programmed one.
const RANGE: [f64; 2] = [0.5, 2.0];
/// Speeds that are evaluated.
const SPEEDS: usize = 500;
/// Speeds that are proposed at most.
const MOST: usize = 5;

impl WorstCut {
    /// Depth that is stable beyond the uncertainty of its limit, m; none where no limit or no uncertainty is known.
    pub fn reliable_depth(&self) -> Option<f64> {
        let u = self.relative_uncertainty()?;
        let limit = self.exact.or(self.limit.as_ref().map(|limit| limit.boundary))?;
        Some(limit.depth * (-COVERAGE * u).exp())
    }

    /// Spindle speeds (rad/s) at which the limit is a local maximum above the present one, the deepest first.
    pub fn preferred_speeds(&self) -> Vec<f64> {
        let deepest = self.cut.deepest_sought();
        let cut = CutOfAnyDepth::new(&self.cut.milling);
        let Ok(lobes) = StabilityLobes::new(&modes(&self.modes), &cut, deepest) else {
            return Vec::new();
        };
        let [low, high] = RANGE.map(|part| part * self.cut.spindle);
        let speeds: Vec<f64> = (0..SPEEDS)
            .map(|k| low + (high - low) * k as f64 / (SPEEDS - 1) as f64)
            .collect();
        let depths: Vec<f64> = lobes
            .at_speeds(&speeds)
            .iter()
            .map(|lobe| lobe.boundary.map_or(deepest, |limit| limit.depth))
            .collect();
        let here = self.limit.as_ref().map_or(deepest, |limit| limit.boundary.depth);
        let mut found: Vec<(f64, f64)> = (1..SPEEDS - 1)
            .filter(|k| depths[*k] > depths[k - 1] && depths[*k] >= depths[k + 1] && depths[*k] > here)
            .map(|k| (depths[k], speeds[k]))
            .collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
        found.truncate(MOST);
        found.into_iter().map(|(_, speed)| speed).collect()
    }
}
