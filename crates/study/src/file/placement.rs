//! `place`: the permitted placements of the part, and the objective.
//!
//! ```text
//! reference_from_part = (x, y, z) Rz(heading) Ry(tilt) R Rz(roll)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x, y, z` | centre of the plane, relative to the reference frame of the study | m |
//! | `heading` | about z of that frame, relative to the present placement | rad |
//! | `tilt` | about its y; absolute for a plane given by `tilt_deg`, else relative to the present placement | rad |
//! | `rail` | position of the rail under the robot: its first prismatic joint | m |
//! | `roll` | about the normal of the plane, relative to the present placement | rad |
//! | `R` | axes of the part as in the study (without their tilt, if they are given by it) | - |

use armill_core::optimize::RankBy;
use armill_core::robot::BranchPattern;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::posture_search::{ComponentName, ObjectiveName};

/// The permitted placements of the part and the objective, for `armill place`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaceTable {
    /// Name of the path that is placed; required if the study has several.
    pub analysis: Option<String>,
    /// Least and greatest x of the plane's centre.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub x_mm: Option<[f64; 2]>,
    /// Its y.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub y_mm: Option<[f64; 2]>,
    /// Its z.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub z_mm: Option<[f64; 2]>,
    /// Least and greatest heading: rotation of the part about the vertical, relative to its present placement.
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub heading_deg: Option<[f64; 2]>,
    /// Least and greatest tilt: absolute as `plane.tilt_deg`, or for a plane given by `rotation_deg` relative to it.
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub tilt_deg: Option<[f64; 2]>,
    /// Least and greatest rotation of the part about the normal of the plane, relative to its present placement.
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub roll_deg: Option<[f64; 2]>,
    /// Least and greatest spin of the tool, constant along the path, relative to its present value.
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub spin_deg: Option<[f64; 2]>,
    /// Range of the rail under the robot: its first prismatic joint.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub rail_mm: Option<[f64; 2]>,
    /// Available fixtures, in place of x, y, z, heading and tilt.
    #[schemars(length(max = 1000))]
    #[serde(default)]
    pub fixture: Vec<FixtureTable>,
    /// Permitted branches: words of a branch, or `any`; if left out, those that the study permits.
    pub branch: Option<String>,
    /// Component of the deviation that is evaluated; `in-plane` if left out.
    pub component: Option<ComponentName>,
    /// The objective; `worst` if left out.
    pub objective: Option<ObjectiveName>,
    /// Criterion that placements are compared by: the nominal objective, the objective plus two standard uncertainties,
    /// or the probability that it is within the tolerance; `nominal` if left out.
    pub rank_by: Option<RankByName>,
    /// Distance of every joint from its limits, of the elbow from stretched and of the wrist from straight; 0 if left
    /// out.
    #[schemars(range(min = 0.0, max = 90.0))]
    pub margin_deg: Option<f64>,
    /// Least angle by which the wrist is bent; 3 if left out.
    #[schemars(range(min = 0.0, max = 80.0))]
    pub least_wrist_deg: Option<f64>,
}

/// Criterion that placements are compared by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RankByName {
    /// The nominal value of the objective.
    Nominal,
    /// The objective plus two standard uncertainties.
    PlusTwoSigma,
    /// The probability that the objective is within the tolerance.
    WithinTolerance,
}

impl RankByName {
    /// As the core knows it; `tolerance` in m.
    pub fn rank_by(self, tolerance: f64) -> RankBy {
        match self {
            RankByName::Nominal => RankBy::Nominal,
            RankByName::PlusTwoSigma => RankBy::PlusTwoSigma,
            RankByName::WithinTolerance => RankBy::WithinTolerance(tolerance),
        }
    }
}

/// A place that the cell has for parts.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixtureTable {
    /// What it is called.
    pub name: String,
    /// Position of the centre of the plane in this fixture.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: [f64; 3],
    /// Its tilt, as `plane.tilt_deg`.
    #[schemars(range(min = -180.0, max = 180.0))]
    pub tilt_deg: Option<f64>,
    /// Its turns, as `plane.rotation_deg`.
    #[schemars(inner(range(min = -360.0, max = 360.0)))]
    pub rotation_deg: Option<[f64; 3]>,
}

/// What is wrong with a table, and what to do: its key, a sentence, a hint.
pub type Fault = (String, String, &'static str);

impl PlaceTable {
    /// Bounds by their keys.
    pub fn bounds(&self) -> [(&'static str, Option<[f64; 2]>); 8] {
        [
            ("x_mm", self.x_mm),
            ("y_mm", self.y_mm),
            ("z_mm", self.z_mm),
            ("heading_deg", self.heading_deg),
            ("tilt_deg", self.tilt_deg),
            ("roll_deg", self.roll_deg),
            ("spin_deg", self.spin_deg),
            ("rail_mm", self.rail_mm),
        ]
    }

    /// Whether anything may move.
    pub fn is_free(&self) -> bool {
        !self.fixture.is_empty() || self.bounds().iter().any(|(_, bounds)| bounds.is_some())
    }

    /// What this table says, and what it leaves open as `other` says.
    #[must_use]
    pub fn or(self, other: PlaceTable) -> PlaceTable {
        PlaceTable {
            analysis: self.analysis.or(other.analysis),
            x_mm: self.x_mm.or(other.x_mm),
            y_mm: self.y_mm.or(other.y_mm),
            z_mm: self.z_mm.or(other.z_mm),
            heading_deg: self.heading_deg.or(other.heading_deg),
            tilt_deg: self.tilt_deg.or(other.tilt_deg),
            roll_deg: self.roll_deg.or(other.roll_deg),
            spin_deg: self.spin_deg.or(other.spin_deg),
            rail_mm: self.rail_mm.or(other.rail_mm),
            fixture: if self.fixture.is_empty() {
                other.fixture
            } else {
                self.fixture
            },
            branch: self.branch.or(other.branch),
            component: self.component.or(other.component),
            objective: self.objective.or(other.objective),
            rank_by: self.rank_by.or(other.rank_by),
            margin_deg: self.margin_deg.or(other.margin_deg),
            least_wrist_deg: self.least_wrist_deg.or(other.least_wrist_deg),
        }
    }

    /// Everything that is wrong with it.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (key, bounds) in self.bounds() {
            let Some([least, greatest]) = bounds else { continue };
            if least > greatest {
                faults.push((
                    key.to_owned(),
                    format!("`{key}` ranges from {least} to {greatest}: the range is empty"),
                    "give the least first, then the greatest, such as [700, 1300]",
                ));
            } else if key == "tilt_deg" && least.abs().max(greatest.abs()) > 180.0 {
                faults.push((
                    key.to_owned(),
                    format!("`{key}` ranges from {least} to {greatest} deg"),
                    "from -180 to 180, as plane.tilt_deg",
                ));
            } else if key.ends_with("_deg") && greatest - least > 360.0 {
                faults.push((
                    key.to_owned(),
                    format!("`{key}` spans {} deg", greatest - least),
                    "a full turn at most, such as [-180, 180]",
                ));
            }
            let of_place = !["roll_deg", "spin_deg", "rail_mm"].contains(&key);
            if of_place && !self.fixture.is_empty() {
                faults.push((
                    key.to_owned(),
                    format!("`{key}` cannot be combined with fixtures, which determine the placement"),
                    "remove one of them; roll_deg, spin_deg and rail_mm can be combined with fixtures",
                ));
            }
        }
        for (index, fixture) in self.fixture.iter().enumerate() {
            if fixture.tilt_deg.is_some() && fixture.rotation_deg.is_some() {
                faults.push((
                    format!("fixture[{index}].rotation_deg"),
                    format!(
                        "fixture `{}` has both `tilt_deg` and `rotation_deg`",
                        fixture.name
                    ),
                    "remove one",
                ));
            }
            if self.fixture[..index]
                .iter()
                .any(|other| other.name == fixture.name)
            {
                faults.push((
                    format!("fixture[{index}].name"),
                    format!("there are two fixtures `{}`", fixture.name),
                    "give each a unique name",
                ));
            }
        }
        if let Some(words) = self.branch.as_deref().filter(|words| *words != ANY)
            && let Err(message) = crate::naming::branch_choice(words, BranchPattern::default())
        {
            faults.push(("branch".to_owned(), message, "or write `any`"));
        }
        faults
    }
}

/// All branches.
pub const ANY: &str = "any";
