//! The material file as written: its tables and keys.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::sources::SourceTable;

/// The material file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    pub _format: u32,
    /// What it is, for people.
    #[schemars(length(min = 1))]
    pub name: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Mechanistic coefficients, one table a set.
    #[serde(default)]
    pub mechanistic: Vec<MechanisticTable>,
    /// Kienzle values, one table a set.
    #[serde(default)]
    pub kienzle: Vec<KienzleTable>,
    /// Where the numbers come from, by key.
    pub sources: SourceTable,
}

/// Coefficients of shear (tangential, radial, axial) and of the edge, as one source gives them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MechanisticTable {
    /// The tool that they were identified with.
    pub tool: String,
    /// Key of the source.
    pub source: String,
    /// Tangential force over the section of the chip.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub ktc_n_per_mm2: Option<f64>,
    /// Radial force over the section of the chip.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub krc_n_per_mm2: Option<f64>,
    /// Axial force over the section of the chip, positive as a right-hand helix makes it.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub kac_n_per_mm2: Option<f64>,
    /// Tangential force over the length of the edge.
    #[schemars(range(min = -1e4, max = 1e4))]
    pub kte_n_per_mm: Option<f64>,
    /// Radial force over the length of the edge.
    #[schemars(range(min = -1e4, max = 1e4))]
    pub kre_n_per_mm: Option<f64>,
    /// Axial force over the length of the edge.
    #[schemars(range(min = -1e4, max = 1e4))]
    pub kae_n_per_mm: Option<f64>,
    /// What to make of them.
    pub note: Option<String>,
}

impl MechanisticTable {
    /// As the file has them: N/mm2, then N/mm.
    pub(super) fn coefficients(&self) -> [Option<f64>; 6] {
        [
            self.ktc_n_per_mm2,
            self.krc_n_per_mm2,
            self.kac_n_per_mm2,
            self.kte_n_per_mm,
            self.kre_n_per_mm,
            self.kae_n_per_mm,
        ]
    }
}

/// Kienzle values at 0 deg rake, as one source gives them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct KienzleTable {
    /// Key of the source.
    pub source: String,
    /// Material group of VDI 3323.
    #[schemars(range(min = 1, max = 41))]
    pub group: Option<u8>,
    /// Strength, hardness or treatment that they are valid for.
    pub condition: Option<String>,
    /// Specific cutting force of a chip 1 mm thick.
    #[schemars(range(min = 1.0, max = 1e5))]
    pub kc1_n_per_mm2: f64,
    /// Exponent of the chip thickness.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub mc_exponent: f64,
}
