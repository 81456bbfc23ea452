//! The journal as written: its tables and keys.

use schemars::JsonSchema;
use serde::Deserialize;

/// The journal of an arm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JournalFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    pub _format: u32,
    /// Robot of the library, or robot file, as known before any measurement.
    #[schemars(length(min = 1))]
    pub robot: String,
    /// Tip of the tool in the flange frame.
    pub tool_mm: [f64; 3],
    /// What is known of an arm of this kind where the robot file says nothing.
    #[serde(default)]
    pub prior: PriorTable,
    /// Measurements, in the order in which they were made.
    #[schemars(length(min = 1, max = 10_000))]
    pub measurement: Vec<MeasurementTable>,
}

/// Standard deviations of arms of this kind.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PriorTable {
    /// Of lengths of the chain from nominal.
    #[schemars(range(min = 1e-6, max = 1e3))]
    pub length_mm: f64,
    /// Of angles of the chain from nominal.
    #[schemars(range(min = 1e-6, max = 45))]
    pub angle_deg: f64,
    /// Of compliances and backlash that the robot file gives without an uncertainty: a factor.
    #[schemars(range(min = 1.001, max = 100))]
    pub factor: f64,
}

impl Default for PriorTable {
    fn default() -> PriorTable {
        PriorTable {
            length_mm: 0.5,
            angle_deg: 0.05,
            factor: 2.0,
        }
    }
}

/// One measurement.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MeasurementTable {
    /// Day, as 2026-11-24.
    pub date: String,
    /// Temperature of the arm.
    #[schemars(range(min = -50, max = 100))]
    // unit: deg C
    pub temperature_c: f64,
    /// What was measured.
    pub kind: KindWord,
    /// Its table, relative to the journal.
    #[schemars(length(min = 1))]
    pub file: String,
    /// Checksum of the file, so that a changed file is noticed.
    pub sha256: Option<String>,
    /// Standard uncertainty of a measured coordinate or distance; load tests state theirs in the file.
    #[schemars(range(min = 1e-3, max = 1e5))]
    pub u_um: Option<f64>,
    /// Of a ball-bar: whether its length is known, so that its readings are distances; otherwise only their differences count.
    pub calibrated: Option<bool>,
    /// The measured point in the flange frame, approximately; the tip of the tool without it.
    pub point_mm: Option<[f64; 3]>,
    /// For people.
    pub note: Option<String>,
}

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum KindWord {
    /// Positions of features of a part that the tool cut, in any frame of the part.
    Part,
    /// Positions of a reflector or target on the tool, in any frame; the point is found with the arm.
    Tracker,
    /// Displacements under load.
    LoadTests,
    /// Distances of a point on the tool from a fixed pivot.
    BallBar,
}
