//! armill's own material file, format 1: TOML, cutting forces of a material with a source for every number.
//!
//! A material has sets of mechanistic coefficients (N/mm2, N/mm), each identified by one source with one tool, and
//! sets of Kienzle values. A set may lack a coefficient; no force is computed from it then. Where several sets of one
//! material are whole, their mean is the value of the material, and their scatter its uncertainty.
//!
//! `file` has the tables as written; here they are checked and converted to SI.
//!
//! | in the file | here |
//! |---|---|
//! | `ktc_n_per_mm2`, `krc_n_per_mm2`, `kac_n_per_mm2` | `Ktc`, `Krc`, `Kac`: force over the section of a chip, Pa |
//! | `kte_n_per_mm`, `kre_n_per_mm`, `kae_n_per_mm` | `Kte`, `Kre`, `Kae`: force over the length of the edge, N/m |
//! | `kc1_n_per_mm2`, `mc_exponent` | `kc1` (Pa), `mc`: specific force of a chip 1 mm thick, and how it falls |
//!
//! Tangential, radial, axial in this order. All keys: `docs/guide/material-file.md`.

mod file;

use armill_core::load::SetStatistics;
use armill_core::nalgebra::{Vector2, Vector6};

use self::file::{KienzleTable, MaterialFile, MechanisticTable};
use crate::document::{Document, Problem, Problems};
use crate::sources::{self, Source};

/// N/mm2 in Pa.
const PA_PER_N_PER_MM2: f64 = 1e6;
/// N/mm in N/m.
const N_PER_M_PER_N_PER_MM: f64 = 1e3;

/// What is known of the forces that a material takes to cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// For people.
    pub name: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Sets of mechanistic coefficients, in the order of the file.
    pub mechanistic: Vec<MechanisticSet>,
    /// Sets of Kienzle values, in the order of the file.
    pub kienzle: Vec<KienzleSet>,
    /// Every source, by key.
    pub sources: Vec<Source>,
}

/// Mechanistic coefficients as one source gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanisticSet {
    /// With which tool they were identified.
    pub tool: String,
    /// Ktc, Krc, Kac (Pa), Kte, Kre, Kae (N/m); `None` where the source has none.
    pub coefficients: [Option<f64>; 6],
    /// Key of the source.
    pub source: String,
    /// What to make of them.
    pub note: Option<String>,
}

/// Kienzle values as one source gives them, at 0 deg rake.
#[derive(Clone, Debug, PartialEq)]
pub struct KienzleSet {
    /// Group of VDI 3323, if the source goes by them.
    pub group: Option<u8>,
    /// Strength, hardness or treatment that they are valid for.
    pub condition: Option<String>,
    /// Cutting force over the section of a chip 1 mm thick, Pa.
    pub specific_force: f64,
    /// How fast it falls with the thickness.
    pub exponent: f64,
    /// Key of the source.
    pub source: String,
}

impl Material {
    /// The whole sets of mechanistic coefficients together: Ktc, Krc, Kac (Pa), Kte, Kre, Kae (N/m).
    ///
    /// `None` where no set is whole.
    pub fn mechanistic(&self) -> Option<SetStatistics<6>> {
        let whole = self.mechanistic.iter().filter_map(MechanisticSet::whole);
        SetStatistics::of(&whole.collect::<Vec<_>>())
    }

    /// The sets of Kienzle values together: `kc1` (Pa) and `mc`.
    ///
    /// `None` where there is none. Sets of different groups and conditions are put together all the same.
    pub fn kienzle(&self) -> Option<SetStatistics<2>> {
        let sets = self.kienzle.iter();
        let values = sets.map(|set| Vector2::new(set.specific_force, set.exponent));
        SetStatistics::of(&values.collect::<Vec<_>>())
    }

    /// Sources of the sets that [`Material::mechanistic`] is made of.
    pub fn mechanistic_sources(&self) -> Vec<&Source> {
        let whole = self.mechanistic.iter().filter(|set| set.whole().is_some());
        let keys: Vec<&str> = whole.map(|set| set.source.as_str()).collect();
        self.sources_called(&keys)
    }

    /// Sources of the sets that [`Material::kienzle`] is made of.
    pub fn kienzle_sources(&self) -> Vec<&Source> {
        let keys: Vec<&str> = self.kienzle.iter().map(|set| set.source.as_str()).collect();
        self.sources_called(&keys)
    }

    /// The sources with these keys, once each, in the order of their keys.
    fn sources_called(&self, keys: &[&str]) -> Vec<&Source> {
        let called = |source: &&Source| keys.contains(&source.key.as_str());
        self.sources.iter().filter(called).collect()
    }
}

impl MechanisticSet {
    /// All six coefficients, if the source has all.
    fn whole(&self) -> Option<Vector6<f64>> {
        let mut whole = Vector6::zeros();
        for (place, coefficient) in whole.iter_mut().zip(self.coefficients) {
            *place = coefficient?;
        }
        Some(whole)
    }
}

/// The material of this file; `path` is what errors show.
///
/// In SI. Not checked: whether a coefficient is likely for its material, beyond the range that the schema allows.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(path: &str, text: &str) -> Result<Material, Problems> {
    let document = Document::parse(path, text)?;
    let file: MaterialFile = document.read()?;
    Problems::from(problems(&document, &file)).into_result()?;
    Ok(Material {
        name: file.name,
        note: file.note,
        mechanistic: file.mechanistic.into_iter().map(mechanistic_set).collect(),
        kienzle: file.kienzle.into_iter().map(kienzle_set).collect(),
        sources: sources::listed(file.sources),
    })
}

/// What no schema can say of a material file.
fn problems(document: &Document, file: &MaterialFile) -> Vec<Problem> {
    let mut problems = Vec::new();
    if file.mechanistic.is_empty() && file.kienzle.is_empty() {
        let hint = "add a table [[mechanistic]] or [[kienzle]]";
        problems.push(document.problem("name", "the material has no cutting force", Some(hint)));
    }
    for (index, table) in file.mechanistic.iter().enumerate() {
        if table.coefficients().iter().all(Option::is_none) {
            let hint = "give ktc_n_per_mm2 and its like, or remove the table";
            let path = format!("mechanistic[{index}]");
            problems.push(document.problem(&path, "the set has no coefficient", Some(hint)));
        }
    }
    problems.extend(sources::problems(document, &file.sources));
    problems
}

/// A set in SI: the first three coefficients by the section of a chip, the others by the length of the edge.
fn mechanistic_set(table: MechanisticTable) -> MechanisticSet {
    let mut coefficients = table.coefficients();
    let (shear, edge) = coefficients.split_at_mut(3);
    for coefficient in shear.iter_mut().flatten() {
        *coefficient *= PA_PER_N_PER_MM2;
    }
    for coefficient in edge.iter_mut().flatten() {
        *coefficient *= N_PER_M_PER_N_PER_MM;
    }
    MechanisticSet {
        tool: table.tool,
        coefficients,
        source: table.source,
        note: table.note,
    }
}

/// A set in SI; the exponent is a pure number.
fn kienzle_set(table: KienzleTable) -> KienzleSet {
    KienzleSet {
        group: table.group,
        condition: table.condition,
        specific_force: table.kc1_n_per_mm2 * PA_PER_N_PER_MM2,
        exponent: table.mc_exponent,
        source: table.source,
    }
}

#[cfg(test)]
mod tests;
