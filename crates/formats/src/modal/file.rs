//! The file of modal data as written: its tables and keys.

use schemars::JsonSchema;
use serde::Deserialize;

/// The file of modal data.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModalFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    pub _format: u32,
    /// What was measured, for people.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Where the numbers come from.
    #[schemars(length(min = 1))]
    pub source: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// The modes.
    #[schemars(length(min = 1, max = 200))]
    pub mode: Vec<ModeTable>,
}

/// A mode at the tip of the cutter.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModeTable {
    /// Name in results; its number in the file if left out.
    #[schemars(length(min = 1, max = 100))]
    pub name: Option<String>,
    /// Undamped natural frequency.
    #[schemars(range(min = 0.1, max = 1e5))]
    pub frequency_hz: f64,
    /// Its standard uncertainty.
    #[schemars(range(min = 0.0, max = 1e5))]
    pub frequency_u_hz: Option<f64>,
    /// Damping ratio, in per cent of critical damping.
    #[schemars(range(min = 0.01, max = 90.0))]
    pub damping_percent: Option<f64>,
    /// Its standard uncertainty, in the same unit.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub damping_u_percent: Option<f64>,
    /// Damping ratio, in place of per cent.
    #[schemars(range(min = 1e-4, max = 0.9))]
    pub damping_ratio: Option<f64>,
    /// Direction in which the tip moves: along the feed, to its left, from part to spindle. Its length has no effect.
    #[schemars(inner(range(min = -1e3, max = 1e3)))]
    pub direction: [f64; 3],
    /// Modal mass in this direction.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub modal_mass_kg: Option<f64>,
    /// Modal stiffness in this direction.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub stiffness_n_per_um: Option<f64>,
    /// Standard uncertainty of modal mass or stiffness, in per cent of it.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub stiffness_u_percent: Option<f64>,
}
