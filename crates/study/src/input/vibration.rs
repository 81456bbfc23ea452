//! Vibration: the table `vibration` of the study, and the modes of the tool that it names.

use std::path::Path;

use armill_core::load::Milling;
use armill_core::nalgebra::Rotation3;
use armill_core::stability::NamedMode;
use armill_formats::input;
use armill_formats::modal::{self, ModalData};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::StudyError;

/// Asks for the lowest mode and the stable depth of cut at each point.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VibrationTable {
    /// Damping ratio of the modes of the arm, in place of what the robot file gives.
    #[schemars(range(min = 0.0, max = 0.99))]
    pub damping_ratio: Option<f64>,
    /// File of modal data of the tool, relative to the study: modes at the tip of the cutter in addition to those of the arm.
    pub tool_modes: Option<String>,
    /// Maps and volumes, with the cut of the study: direction of the feed on the plane, from its y' towards z'; 0 if left out.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub feed_deg: Option<f64>,
    /// Whether the cut must be stable, as a demanded clearance must be kept: placements and searches for postures avoid points where it is
    /// not, and the tolerance is not met there.
    pub must_be_stable: Option<bool>,
}

/// What is asked of the vibration at each point, SI.
#[derive(Clone, Debug, Default)]
pub struct VibrationSetting {
    /// Modes of the tool at its tip, in the feed frame.
    pub tool_modes: Vec<NamedMode>,
    /// What they are and where they come from.
    pub tool_modes_from: Option<String>,
    /// The cut at every point of a map or volume, if its stable depth is asked for.
    pub on_plane: Option<CutAtPoint>,
    /// Whether the cut must be stable.
    pub must_be_stable: bool,
}

/// A cut with one direction of the feed.
#[derive(Clone, Copy, Debug)]
pub struct CutAtPoint {
    /// The cut.
    pub milling: Milling,
    /// Spindle speed, rad/s.
    pub spindle: f64,
    /// Axes of the feed frame in base.
    pub base_from_feed: Rotation3<f64>,
}

/// Deepest limit of the depth that is sought, in diameters of the cutter and in programmed depths.
const DEEPEST: [f64; 2] = [2.0, 3.0];

impl CutAtPoint {
    /// Deepest limit of the depth that is sought, m.
    pub fn deepest_sought(&self) -> f64 {
        deepest_sought(&self.milling)
    }
}

/// Deepest limit of the depth that is sought for this cut, m.
pub fn deepest_sought(milling: &Milling) -> f64 {
    let [of_diameter, of_depth] = DEEPEST;
    (of_diameter * milling.cutter().diameter()).max(of_depth * milling.cut().depth)
}

/// The modal data of this file.
///
/// # Errors
/// A file that cannot be read, or all its problems.
pub fn modes_of(path: &Path) -> Result<ModalData, StudyError> {
    let shown = path.display().to_string();
    let text = input::read_text(path).map_err(|error| {
        StudyError::value(
            format!("{shown}: {error}"),
            "give a file of modal data, see docs/guide/stability.md",
        )
    })?;
    Ok(modal::read(&shown, &text)?)
}
