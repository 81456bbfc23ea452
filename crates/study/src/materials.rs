//! What is known of a material, as JSON: `armill materials`, `armill materials NAME`. Units are those of the file.

use armill_formats::material::{KienzleSet, Material, MechanisticSet};
use armill_formats::sources::Source;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::StudyError;
use crate::library;
use crate::number::without_rounding;

/// Size of the units of the six mechanistic coefficients in SI: N/mm2 of the chip, N/mm of the edge.
const MECHANISTIC: [f64; 6] = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3];
/// The same of Kienzle's two values.
const KIENZLE: [f64; 2] = [1e6, 1.0];

/// A row of the list of materials.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MaterialRow {
    /// Its name in the library.
    pub name: String,
    /// For people.
    pub title: String,
    /// Whole sets of mechanistic coefficients: those that forces are computed from.
    pub mechanistic_sets: usize,
    /// Sets of Kienzle values.
    pub kienzle_sets: usize,
    /// Sets of mechanistic coefficients, parts of sets included.
    #[serde(skip)]
    pub mechanistic_listed: usize,
}

impl MaterialRow {
    /// The rows of the library.
    ///
    /// # Errors
    /// A file of the library that cannot be read.
    pub fn all() -> Result<Vec<MaterialRow>, StudyError> {
        let row = |name| Ok(MaterialRow::of(name, &library::find_material(name)?));
        library::MATERIALS.iter().map(|entry| row(entry.name)).collect()
    }

    /// The row of a material that the library calls `name`.
    pub fn of(name: &str, found: &Material) -> MaterialRow {
        MaterialRow {
            name: name.to_owned(),
            title: found.name.clone(),
            mechanistic_sets: found.mechanistic().map_or(0, |together| together.sets),
            kienzle_sets: found.kienzle().map_or(0, |together| together.sets),
            mechanistic_listed: found.mechanistic.len(),
        }
    }
}

/// Everything that is known of one material.
#[derive(Clone, Debug, Serialize)]
pub struct MaterialDetails {
    /// Its name in the library.
    pub name: String,
    /// For people.
    pub title: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Every set of mechanistic coefficients.
    pub mechanistic: Vec<MechanisticDetails>,
    /// Every set of Kienzle values.
    pub kienzle: Vec<KienzleDetails>,
    /// What forces are computed from.
    pub used: Used,
    /// Sources of the numbers.
    pub sources: Vec<Source>,
}

/// A set of mechanistic coefficients; a key is omitted if the source does not give the coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct MechanisticDetails {
    /// Shear, tangential.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ktc_n_per_mm2: Option<f64>,
    /// Shear, radial.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub krc_n_per_mm2: Option<f64>,
    /// Shear, axial.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kac_n_per_mm2: Option<f64>,
    /// Edge, tangential.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kte_n_per_mm: Option<f64>,
    /// Edge, radial.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kre_n_per_mm: Option<f64>,
    /// Edge, axial.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kae_n_per_mm: Option<f64>,
    /// With which tool they were identified.
    pub tool: String,
    /// Key of the source.
    pub source: String,
    /// A note on them.
    pub note: Option<String>,
}

/// A set of Kienzle values, at 0 deg rake.
#[derive(Clone, Debug, Serialize)]
pub struct KienzleDetails {
    /// Cutting force over the section of a chip 1 mm thick.
    pub kc1_n_per_mm2: f64,
    /// How fast it falls with the thickness.
    pub mc_exponent: f64,
    /// Group of VDI 3323, if the source uses them.
    pub group: Option<u8>,
    /// Strength, hardness or treatment for which they are valid.
    pub condition: Option<String>,
    /// Key of the source.
    pub source: String,
}

/// What forces are computed from: the mean of whole sets, and the standard deviation of one set among them (`spread`),
/// which of a single set is not known.
#[derive(Clone, Debug, Serialize)]
pub struct Used {
    /// Of the mechanistic law; none without a whole set.
    pub mechanistic: Option<UsedMechanistic>,
    /// Of Kienzle's law; none without a set.
    pub kienzle: Option<UsedKienzle>,
}

/// The mechanistic coefficients that forces are computed from.
#[derive(Clone, Debug, Serialize)]
pub struct UsedMechanistic {
    /// How many sets.
    pub sets: usize,
    /// Shear, tangential.
    pub ktc_n_per_mm2: f64,
    /// Its spread.
    pub spread_ktc_n_per_mm2: Option<f64>,
    /// Shear, radial.
    pub krc_n_per_mm2: f64,
    /// Its spread.
    pub spread_krc_n_per_mm2: Option<f64>,
    /// Shear, axial.
    pub kac_n_per_mm2: f64,
    /// Its spread.
    pub spread_kac_n_per_mm2: Option<f64>,
    /// Edge, tangential.
    pub kte_n_per_mm: f64,
    /// Its spread.
    pub spread_kte_n_per_mm: Option<f64>,
    /// Edge, radial.
    pub kre_n_per_mm: f64,
    /// Its spread.
    pub spread_kre_n_per_mm: Option<f64>,
    /// Edge, axial.
    pub kae_n_per_mm: f64,
    /// Its spread.
    pub spread_kae_n_per_mm: Option<f64>,
}

/// The Kienzle values that forces are computed from.
#[derive(Clone, Debug, Serialize)]
pub struct UsedKienzle {
    /// How many sets.
    pub sets: usize,
    /// Cutting force over the section of a chip 1 mm thick.
    pub kc1_n_per_mm2: f64,
    /// Its spread.
    pub spread_kc1_n_per_mm2: Option<f64>,
    /// How fast it falls with the thickness.
    pub mc_exponent: f64,
    /// Its spread.
    pub spread_mc_exponent: Option<f64>,
}

impl MaterialDetails {
    /// Everything that is known of the material that the library calls `name`.
    pub fn of(name: &str, found: &Material) -> MaterialDetails {
        MaterialDetails {
            name: name.to_owned(),
            title: found.name.clone(),
            note: found.note.clone(),
            mechanistic: found.mechanistic.iter().map(MechanisticDetails::of).collect(),
            kienzle: found.kienzle.iter().map(KienzleDetails::of).collect(),
            used: Used {
                mechanistic: UsedMechanistic::of(found),
                kienzle: UsedKienzle::of(found),
            },
            sources: found.sources.clone(),
        }
    }
}

impl MechanisticDetails {
    /// A set as in its file.
    fn of(set: &MechanisticSet) -> MechanisticDetails {
        let given = |i: usize| set.coefficients[i].map(|value| without_rounding(value / MECHANISTIC[i]));
        MechanisticDetails {
            ktc_n_per_mm2: given(0),
            krc_n_per_mm2: given(1),
            kac_n_per_mm2: given(2),
            kte_n_per_mm: given(3),
            kre_n_per_mm: given(4),
            kae_n_per_mm: given(5),
            tool: set.tool.clone(),
            source: set.source.clone(),
            note: set.note.clone(),
        }
    }

    /// Ktc, Krc, Kac, Kte, Kre, Kae.
    pub fn coefficients(&self) -> [Option<f64>; 6] {
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

impl KienzleDetails {
    /// A set as in its file.
    fn of(set: &KienzleSet) -> KienzleDetails {
        KienzleDetails {
            kc1_n_per_mm2: without_rounding(set.specific_force / KIENZLE[0]),
            mc_exponent: without_rounding(set.exponent / KIENZLE[1]),
            group: set.group,
            condition: set.condition.clone(),
            source: set.source.clone(),
        }
    }
}

impl UsedMechanistic {
    /// `None` if no set is complete.
    fn of(found: &Material) -> Option<UsedMechanistic> {
        let together = found.mechanistic()?;
        let mean = |i: usize| without_rounding(together.mean[i] / MECHANISTIC[i]);
        let spread = |i: usize| {
            let covariance = together.covariance?;
            Some(without_rounding(covariance[(i, i)].sqrt() / MECHANISTIC[i]))
        };
        Some(UsedMechanistic {
            sets: together.sets,
            ktc_n_per_mm2: mean(0),
            spread_ktc_n_per_mm2: spread(0),
            krc_n_per_mm2: mean(1),
            spread_krc_n_per_mm2: spread(1),
            kac_n_per_mm2: mean(2),
            spread_kac_n_per_mm2: spread(2),
            kte_n_per_mm: mean(3),
            spread_kte_n_per_mm: spread(3),
            kre_n_per_mm: mean(4),
            spread_kre_n_per_mm: spread(4),
            kae_n_per_mm: mean(5),
            spread_kae_n_per_mm: spread(5),
        })
    }

    /// Mean and spread of Ktc, Krc, Kac, Kte, Kre, Kae.
    pub fn coefficients(&self) -> [(f64, Option<f64>); 6] {
        [
            (self.ktc_n_per_mm2, self.spread_ktc_n_per_mm2),
            (self.krc_n_per_mm2, self.spread_krc_n_per_mm2),
            (self.kac_n_per_mm2, self.spread_kac_n_per_mm2),
            (self.kte_n_per_mm, self.spread_kte_n_per_mm),
            (self.kre_n_per_mm, self.spread_kre_n_per_mm),
            (self.kae_n_per_mm, self.spread_kae_n_per_mm),
        ]
    }
}

impl UsedKienzle {
    /// `None` if there is no set.
    fn of(found: &Material) -> Option<UsedKienzle> {
        let together = found.kienzle()?;
        let mean = |i: usize| without_rounding(together.mean[i] / KIENZLE[i]);
        let spread = |i: usize| {
            let covariance = together.covariance?;
            Some(without_rounding(covariance[(i, i)].sqrt() / KIENZLE[i]))
        };
        Some(UsedKienzle {
            sets: together.sets,
            kc1_n_per_mm2: mean(0),
            spread_kc1_n_per_mm2: spread(0),
            mc_exponent: mean(1),
            spread_mc_exponent: spread(1),
        })
    }

    /// Mean and spread of kc1.1 and mc.
    pub fn values(&self) -> [(f64, Option<f64>); 2] {
        [
            (self.kc1_n_per_mm2, self.spread_kc1_n_per_mm2),
            (self.mc_exponent, self.spread_mc_exponent),
        ]
    }
}
