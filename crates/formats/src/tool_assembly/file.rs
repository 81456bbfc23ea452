//! The file of a tool assembly as written: its tables and keys.

use schemars::JsonSchema;
use serde::Deserialize;

/// The file of a tool assembly.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct AssemblyFile {
    /// Version of the format: 1.
    #[schemars(range(min = 1, max = 1))]
    #[serde(rename = "format")]
    pub _format: u32,
    /// What it is, for people.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Where the numbers come from.
    #[schemars(length(min = 1))]
    pub source: String,
    /// What a user should know before trusting the numbers.
    pub note: Option<String>,
    /// Theory of bending.
    #[serde(default)]
    pub beam: Beam,
    /// Rigid body between flange and spindle nose, in addition to the masses of the robot.
    pub spindle: Option<SpindleTable>,
    /// Uniform parts of holder and cutter, from the spindle nose to the tip.
    #[schemars(length(min = 1, max = 100))]
    pub segment: Vec<SegmentTable>,
}

/// Theory of bending.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Beam {
    /// With shear and rotary inertia.
    #[default]
    Timoshenko,
    /// Euler and Bernoulli, for slender beams.
    Euler,
}

/// A rigid body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SpindleTable {
    /// Its mass.
    #[schemars(range(min = 1e-6, max = 1e5))]
    pub mass_kg: f64,
    /// Its centre relative to the spindle nose, axes of the nose: z towards the tip.
    #[schemars(inner(range(min = -1e4, max = 1e4)))]
    pub centre_mm: [f64; 3],
    /// Inertia about its centre about x, y, z; a point if left out.
    #[schemars(inner(range(min = 0.0, max = 1e5)))]
    pub inertia_kg_m2: Option<[f64; 3]>,
}

/// A material whose values are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum MaterialName {
    /// 206 GPa, 7850 kg/m3, 0.3.
    Steel,
    /// Cemented carbide: 580 GPa, 14400 kg/m3, 0.22.
    Carbide,
}

/// A uniform part.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SegmentTable {
    /// Name in messages; its number in the file if left out.
    #[schemars(length(min = 1, max = 100))]
    pub name: Option<String>,
    /// Length.
    #[schemars(range(min = 0.01, max = 1e4))]
    pub length_mm: f64,
    /// Outer diameter; of a fluted part the diameter of the cutter.
    #[schemars(range(min = 0.01, max = 1e3))]
    pub diameter_mm: f64,
    /// Diameter of the bore; solid if left out.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub bore_mm: Option<f64>,
    /// Whether it has flutes: its equivalent diameter is 80 % of the diameter.
    #[serde(default)]
    pub fluted: bool,
    /// Equivalent diameter of a fluted part, in place of 80 %.
    #[schemars(range(min = 0.01, max = 1e3))]
    pub equivalent_diameter_mm: Option<f64>,
    /// Material, in place of modulus, density and Poisson's ratio.
    pub material: Option<MaterialName>,
    /// Young's modulus.
    #[schemars(range(min = 1e-3, max = 2e3))]
    pub modulus_gpa: Option<f64>,
    /// Density.
    #[schemars(range(min = 1.0, max = 3e4))]
    pub density_kg_per_m3: Option<f64>,
    /// Poisson's ratio; 0.3 if left out.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub poisson_ratio: Option<f64>,
    /// Loss factor of the material; 0.0015 if left out.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss_factor: Option<f64>,
    /// Elastic connection to the part before (to the spindle, of the first segment); rigid if left out.
    pub joint: Option<JointTable>,
}

/// An elastic connection; what is left out is rigid.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    /// Stiffness across the axis.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub lateral_n_per_um: Option<f64>,
    /// Stiffness along the axis.
    #[schemars(range(min = 1e-3, max = 1e6))]
    pub axial_n_per_um: Option<f64>,
    /// Stiffness about directions across the axis.
    #[schemars(range(min = 1.0, max = 1e10))]
    pub bending_n_m_per_rad: Option<f64>,
    /// Stiffness about the axis.
    #[schemars(range(min = 1.0, max = 1e10))]
    pub torsion_n_m_per_rad: Option<f64>,
    /// Viscous damping across the axis.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub lateral_damping_n_s_per_m: Option<f64>,
    /// Viscous damping along the axis.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub axial_damping_n_s_per_m: Option<f64>,
    /// Viscous damping about directions across the axis.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub bending_damping_n_m_s_per_rad: Option<f64>,
    /// Viscous damping about the axis.
    #[schemars(range(min = 0.0, max = 1e7))]
    pub torsion_damping_n_m_s_per_rad: Option<f64>,
    /// Loss factor of all stiffnesses; 0 if left out.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub loss_factor: Option<f64>,
}
