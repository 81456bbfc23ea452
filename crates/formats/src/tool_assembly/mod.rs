//! File of a tool assembly, format 1: TOML, holder and cutter as round beams from the spindle nose to the tip.
//!
//! | in the file | here |
//! |---|---|
//! | `[[segment]]`: `length_mm`, `diameter_mm`, `bore_mm` | a beam along z, m |
//! | `fluted`, `equivalent_diameter_mm` | the diameter of a beam with the stiffness of the fluted part |
//! | `material`, or `modulus_gpa`, `density_kg_per_m3`, `poisson_ratio`; `loss_factor` | Pa, kg/m^3 |
//! | `[segment.joint]`: `lateral_n_per_um`, `bending_n_m_per_rad`, ... | springs in front of the segment, N/m, N m/rad |
//! | `[spindle]`: `mass_kg`, `centre_mm`, `inertia_kg_m2` | a rigid body at the nose |
//!
//! `file` has the tables as written; here they are checked and converted to SI. All keys: `docs/guide/receptance.md`. Values of the materials: handbooks
//! (recalled); the loss factor as in Schmitz & Duncan 2005 (recalled).

mod file;

use armill_core::dynamics::coupling::joint::Spring;
use armill_core::dynamics::coupling::section::FLUTED;
use armill_core::dynamics::coupling::{BeamTheory, Body, Joint, Material, Section, Segment};
use armill_core::nalgebra::{Matrix3, Vector3};
use armill_core::units::{from_mm, from_um};

use self::file::{AssemblyFile, Beam, JointTable, MaterialName, SegmentTable, SpindleTable};
use crate::document::{Document, Problem, Problems};

/// Loss factor of a material if none is given.
pub const LOSS_FACTOR: f64 = 0.0015;
/// Poisson's ratio of a material if none is given.
const POISSON: f64 = 0.3;
/// GPa in Pa.
const PA_PER_GPA: f64 = 1e9;

/// Holder and cutter.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolAssembly {
    /// For people.
    pub name: String,
    /// Where the numbers come from.
    pub source: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// A rigid body at the spindle nose.
    pub spindle: Option<Body>,
    /// From the spindle nose to the tip; axis z.
    pub segments: Vec<Segment>,
    /// Names of the segments.
    pub names: Vec<String>,
    /// What was assumed.
    pub assumptions: Vec<String>,
}

/// The tool assembly of this file; `path` is what errors show.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(path: &str, text: &str) -> Result<ToolAssembly, Problems> {
    let document = Document::parse(path, text)?;
    let file: AssemblyFile = document.read()?;
    let mut problems = Vec::new();
    let theory = match file.beam {
        Beam::Timoshenko => BeamTheory::Timoshenko,
        Beam::Euler => BeamTheory::Euler,
    };
    let mut segments = Vec::new();
    for (index, table) in file.segment.iter().enumerate() {
        segments.extend(segment(&document, index, table, &mut problems).map(|own| Segment { theory, ..own }));
    }
    problems.extend(
        file.spindle
            .as_ref()
            .and_then(|table| impossible_inertia(&document, table)),
    );
    Problems::from(problems).into_result()?;
    Ok(ToolAssembly {
        assumptions: assumptions(&file),
        names: (file.segment.iter().enumerate())
            .map(|(index, table)| table.name.clone().unwrap_or_else(|| (index + 1).to_string()))
            .collect(),
        name: file.name,
        source: file.source,
        note: file.note,
        spindle: file.spindle.as_ref().map(body),
        segments,
    })
}

/// A segment in SI; `None` if it has a problem.
fn segment(
    document: &Document,
    index: usize,
    table: &SegmentTable,
    problems: &mut Vec<Problem>,
) -> Option<Segment> {
    let before = problems.len();
    let mut problem = |key: &str, message: String, hint: &str| {
        let path = format!("segment[{index}]{key}");
        problems.push(document.problem(&path, message, Some(hint)));
    };
    let outer_mm = match (table.fluted, table.equivalent_diameter_mm) {
        (false, Some(_)) => {
            let message = "`equivalent_diameter_mm` is given for a part without flutes".to_owned();
            problem(
                ".equivalent_diameter_mm",
                message,
                "add `fluted = true`, or remove it",
            );
            table.diameter_mm
        }
        (true, Some(equivalent)) if equivalent > table.diameter_mm => {
            let message = format!(
                "`equivalent_diameter_mm` ({equivalent}) is greater than `diameter_mm` ({})",
                table.diameter_mm
            );
            problem(".equivalent_diameter_mm", message, "about 0.8 of the diameter");
            table.diameter_mm
        }
        (true, Some(equivalent)) => equivalent,
        (true, None) => FLUTED * table.diameter_mm,
        (false, None) => table.diameter_mm,
    };
    let bore_mm = table.bore_mm.unwrap_or(0.0);
    if bore_mm >= outer_mm {
        let message =
            format!("`bore_mm` must be less than the outer diameter of {outer_mm} mm (got {bore_mm})");
        problem(
            ".bore_mm",
            message,
            "diameter of the bore; leave it out for a solid part",
        );
    }
    let given = [
        ("modulus_gpa", table.modulus_gpa.is_some()),
        ("density_kg_per_m3", table.density_kg_per_m3.is_some()),
        ("poisson_ratio", table.poisson_ratio.is_some()),
    ];
    let values = match (table.material, table.modulus_gpa, table.density_kg_per_m3) {
        (Some(name), _, _) => {
            for (key, _) in given.iter().filter(|(_, is_given)| *is_given) {
                let message = format!("`material` and `{key}` are both given");
                problem(&format!(".{key}"), message, "remove one of them");
            }
            named(name)
        }
        (None, Some(modulus), Some(density)) => [modulus, density, table.poisson_ratio.unwrap_or(POISSON)],
        (None, None, None) => {
            let message = "the segment has no material".to_owned();
            let hint =
                "give `material = \"steel\"` or `\"carbide\"`, or `modulus_gpa` and `density_kg_per_m3`";
            problem("", message, hint);
            named(MaterialName::Steel)
        }
        (None, modulus, _) => {
            let missing = if modulus.is_none() {
                "modulus_gpa"
            } else {
                "density_kg_per_m3"
            };
            problem(
                "",
                format!("`{missing}` is missing"),
                "modulus and density belong together",
            );
            named(MaterialName::Steel)
        }
    };
    let [modulus_gpa, density, poisson] = values;
    let is_fine = problems.len() == before;
    is_fine.then(|| Segment {
        length: from_mm(table.length_mm),
        section: Section {
            outer: from_mm(outer_mm),
            bore: from_mm(bore_mm),
        },
        material: Material {
            modulus: modulus_gpa * PA_PER_GPA,
            density,
            poisson,
            loss_factor: table.loss_factor.unwrap_or(LOSS_FACTOR),
        },
        theory: BeamTheory::Timoshenko,
        joint: table.joint.as_ref().map(joint),
    })
}

/// Modulus (GPa), density (kg/m^3), Poisson's ratio.
fn named(name: MaterialName) -> [f64; 3] {
    match name {
        MaterialName::Steel => [206.0, 7850.0, 0.3],
        MaterialName::Carbide => [580.0, 14_400.0, 0.22],
    }
}

fn joint(table: &JointTable) -> Joint {
    // N/um is N per 1e-6 m.
    let per_metre = |stiffness: Option<f64>| stiffness.map(|value| value / from_um(1.0));
    let spring = |stiffness: Option<f64>, damping: Option<f64>| Spring {
        stiffness,
        damping: damping.unwrap_or(0.0),
    };
    Joint {
        lateral: spring(per_metre(table.lateral_n_per_um), table.lateral_damping_n_s_per_m),
        axial: spring(per_metre(table.axial_n_per_um), table.axial_damping_n_s_per_m),
        bending: spring(table.bending_n_m_per_rad, table.bending_damping_n_m_s_per_rad),
        torsion: spring(table.torsion_n_m_per_rad, table.torsion_damping_n_m_s_per_rad),
        loss_factor: table.loss_factor.unwrap_or(0.0),
    }
}

fn body(table: &SpindleTable) -> Body {
    Body {
        mass: table.mass_kg,
        centre: Vector3::from(table.centre_mm.map(from_mm)),
        inertia: Matrix3::from_diagonal(&Vector3::from(table.inertia_kg_m2.unwrap_or([0.0; 3]))),
    }
}

/// No body has a principal inertia greater than the sum of the other two.
fn impossible_inertia(document: &Document, table: &SpindleTable) -> Option<Problem> {
    let inertia = table.inertia_kg_m2?;
    let sum: f64 = inertia.iter().sum();
    let largest = inertia.into_iter().fold(0.0, f64::max);
    (largest > (sum - largest) * (1.0 + 1e-9)).then(|| {
        let message = format!("`inertia_kg_m2` has {largest}, more than the sum of the other two");
        let hint = "no body has this: check units and order, x, y, z";
        document.problem("spindle.inertia_kg_m2", message, Some(hint))
    })
}

/// What the file leaves out and is assumed.
fn assumptions(file: &AssemblyFile) -> Vec<String> {
    let mut all = Vec::new();
    if file.segment.iter().any(|table| table.loss_factor.is_none()) {
        all.push(format!(
            "loss factor {LOSS_FACTOR} assumed for segments without `loss_factor`: the damping of a real tool is mostly that of its joints"
        ));
    }
    if file
        .segment
        .iter()
        .any(|table| table.fluted && table.equivalent_diameter_mm.is_none())
    {
        all.push(format!(
            "fluted parts have an equivalent diameter of {:.0} % of their diameter: assumed",
            100.0 * FLUTED
        ));
    }
    if file.segment.iter().all(|table| table.joint.is_none()) {
        all.push(
            "all joints of spindle, holder and cutter are rigid: real tools are more compliant and more damped".to_owned(),
        );
    }
    all
}

#[cfg(test)]
mod tests;
