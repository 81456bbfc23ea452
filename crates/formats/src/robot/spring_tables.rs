//! Tables that robot files and studies share: springs and masses, given in their own units, checked, converted to SI.
//!
//! | table | content | in the core |
//! |---|---|---|
//! | `[[spring]]` with `about` | rad/(N m) about an axis of the attachment | one spring |
//! | `[[spring]]` with `along` | um/N along an axis of the attachment | one spring, m/N |
//! | `[[spring]]` with `compliance_matrix` | 6 x 6, SI, in the axes of the attachment | up to six springs |
//! | `[[mass]]` | kg, centre of mass in mm in the frame of the attachment, inertia in kg m^2 | one mass, m |
//!
//! An attachment is `base`, a joint's name, `flange` or `tool`. A joint of one of these names hides that part of the
//! arm.

use armill_core::nalgebra::{Matrix3, Matrix6, Point3, Vector3};
use armill_core::robot::spring::springs_of;
use armill_core::robot::{Attachment, Axis, JointCompliance, Mass, Spring};
use armill_core::units::{from_mm, from_um};
use schemars::JsonSchema;
use serde::Deserialize;

use super::body_inertia::not_of_a_body;

/// A coordinate axis of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AxisName {
    /// (1, 0, 0)
    X,
    /// (0, 1, 0)
    Y,
    /// (0, 0, 1)
    Z,
}

impl AxisName {
    /// The axis of the core.
    pub fn axis(self) -> Axis {
        match self {
            AxisName::X => Axis::X,
            AxisName::Y => Axis::Y,
            AxisName::Z => Axis::Z,
        }
    }
}

/// The direction of a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringKind {
    /// The drive of a revolute joint.
    Drive,
    /// The drive of a prismatic joint.
    PrismaticDrive,
    /// About this axis of the attachment.
    About(Axis),
    /// Along this axis of the attachment.
    Along(Axis),
}

impl SpringKind {
    /// The name in covariances of a spring at the attachment `at`: `A2`, `A2 about x`.
    pub fn name_at(self, at: &str) -> String {
        match self {
            SpringKind::Drive | SpringKind::PrismaticDrive => at.to_owned(),
            SpringKind::About(axis) => format!("{at} about {}", axis.letter()),
            SpringKind::Along(axis) => format!("{at} along {}", axis.letter()),
        }
    }
}

/// One direction in which an arm deflects in addition to its drives, or a whole 6 x 6 compliance at one attachment.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringTable {
    /// Attachment: `base`, a joint's name (frame right after its motion), `flange` or `tool`.
    pub at: String,
    /// It turns about this axis of the attachment.
    pub about: Option<AxisName>,
    /// It slides along this axis of the attachment.
    pub along: Option<AxisName>,
    /// Compliance about the axis.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_rad_per_n_m: Option<f64>,
    /// Standard uncertainty of the compliance about the axis.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub compliance_u_rad_per_n_m: Option<f64>,
    /// Compliance along the axis.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_um_per_n: Option<f64>,
    /// Standard uncertainty of the compliance along the axis.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub compliance_u_um_per_n: Option<f64>,
    /// 6 x 6 in place of an axis: translation first, in the axes of the attachment, m/N, 1/N, rad/(N m).
    // unit: SI matrix
    #[schemars(inner(inner(range(min = -1.0, max = 1.0))))]
    pub compliance_matrix: Option<[[f64; 6]; 6]>,
    /// Source: the key of a source, in a study in words.
    pub source: String,
}

/// A body with mass.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MassTable {
    /// Attachment: `base`, a joint's name (the link after it), `flange` or `tool`.
    pub at: String,
    /// Mass.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub mass_kg: f64,
    /// Standard uncertainty of the mass, and of the inertia with it, in per cent; not known if left out.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub mass_u_percent: Option<f64>,
    /// Centre of mass in the frame of the attachment.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub centre_mm: [f64; 3],
    /// Inertia about the centre of mass in the axes of the attachment, 3 x 3; a point if left out. Only vibration depends on it.
    #[schemars(inner(inner(range(min = -1e9, max = 1e9))))]
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// Source: the key of a source, in a study in words.
    pub source: String,
}

/// What is wrong with a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpringTableError {
    /// Key inside the table; `None` for the table itself.
    pub key: Option<&'static str>,
    /// What is wrong.
    pub message: String,
    /// What to try.
    pub hint: String,
}

impl SpringTableError {
    /// What is wrong at `key`, or with the table as a whole.
    fn new(
        key: impl Into<Option<&'static str>>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> SpringTableError {
        SpringTableError {
            key: key.into(),
            message: message.into(),
            hint: hint.into(),
        }
    }

    /// Where it is in a document whose path to the table is `table`.
    pub fn path_in(&self, table: &str) -> String {
        match self.key {
            None => table.to_owned(),
            Some(key) => format!("{table}.{key}"),
        }
    }
}

/// The attachment that `at` names on an arm with these joints.
///
/// `joints` are the names of the arm's joints, base to flange; capitals count.
///
/// # Errors
/// A name that is none of them.
pub fn attachment(at: &str, joints: &[&str]) -> Result<Attachment, SpringTableError> {
    if let Some(joint) = joints.iter().position(|name| *name == at) {
        return Ok(Attachment::Joint(joint));
    }
    match at {
        "base" => Ok(Attachment::Base),
        "flange" => Ok(Attachment::Flange),
        "tool" => Ok(Attachment::Tool),
        _ => {
            let hint = format!("`base`, `flange`, `tool`, or a joint: {}", joints.join(", "));
            Err(SpringTableError::new(
                "at",
                format!("`{at}` is not a part of the arm"),
                hint,
            ))
        }
    }
}

impl SpringTable {
    /// How others name this spring: `A2 about x`; `None` for a whole matrix.
    pub fn name(&self) -> Option<String> {
        let kind = match (self.about, self.along) {
            (Some(axis), None) => SpringKind::About(axis.axis()),
            (None, Some(axis)) => SpringKind::Along(axis.axis()),
            _ => return None,
        };
        Some(kind.name_at(&self.at))
    }

    /// The springs of the core: one, or up to six for a matrix.
    ///
    /// `joints` are the names of the arm's joints. A standard uncertainty that is not given is zero.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn springs(&self, joints: &[&str]) -> Result<Vec<Spring>, SpringTableError> {
        let attachment = attachment(&self.at, joints)?;
        let turning = self.compliance_rad_per_n_m.is_some() || self.compliance_u_rad_per_n_m.is_some();
        let sliding = self.compliance_um_per_n.is_some() || self.compliance_u_um_per_n.is_some();
        if let Some(matrix) = &self.compliance_matrix {
            if self.about.is_some() || self.along.is_some() || turning || sliding {
                return Err(SpringTableError::new(
                    "compliance_matrix",
                    "a spring has either an axis or a whole matrix",
                    "write two [[spring]] tables",
                ));
            }
            let matrix = Matrix6::from_fn(|i, j| matrix[i][j]);
            return springs_of(attachment, &matrix).map_err(|refused| {
                let hint = "6 rows of 6 numbers, symmetric, such as diag(m/N, m/N, m/N, rad/(N m), ...)";
                SpringTableError::new("compliance_matrix", refused.to_string(), hint)
            });
        }
        let (axis, value, u) = match (self.about, self.along) {
            (Some(axis), None) if !sliding => {
                (axis, self.compliance_rad_per_n_m, self.compliance_u_rad_per_n_m)
            }
            (None, Some(axis)) if !turning => {
                let si = |um: Option<f64>| um.map(from_um);
                (axis, si(self.compliance_um_per_n), si(self.compliance_u_um_per_n))
            }
            (Some(_), None) | (None, Some(_)) => {
                return Err(SpringTableError::new(
                    None,
                    "the unit of the compliance does not fit the axis",
                    "`about` takes `compliance_rad_per_n_m`, `along` takes `compliance_um_per_n`",
                ));
            }
            _ => {
                return Err(SpringTableError::new(
                    None,
                    "a spring turns `about` an axis or slides `along` one",
                    "write about = \"x\", along = \"x\", or compliance_matrix = [...]",
                ));
            }
        };
        let Some(value) = value else {
            return Err(SpringTableError::new(
                None,
                "the spring has no compliance",
                "write compliance_rad_per_n_m or compliance_um_per_n",
            ));
        };
        let compliance = JointCompliance {
            value,
            standard_uncertainty: u.unwrap_or(0.0),
        };
        let axis: Vector3<f64> = axis.axis().unit();
        Ok(vec![if self.about.is_some() {
            Spring::about(attachment, axis, compliance)
        } else {
            Spring::along(attachment, axis, compliance)
        }])
    }
}

impl MassTable {
    /// The mass of the core.
    ///
    /// `joints` are the names of the arm's joints.
    ///
    /// # Errors
    /// An attachment that the arm does not have; an inertia that no body has.
    pub fn mass(&self, joints: &[&str]) -> Result<Mass, SpringTableError> {
        let inertia = self.inertia_kg_m2.map(|rows| Matrix3::from_fn(|i, j| rows[i][j]));
        if let Some(refused) = inertia.as_ref().and_then(not_of_a_body) {
            let hint = "3 rows of 3 numbers, symmetric, about the centre of mass: [[Ixx, Ixy, Ixz], ...], with Ixy = -sum m x y";
            return Err(SpringTableError::new("inertia_kg_m2", refused, hint));
        }
        Ok(Mass {
            attachment: attachment(&self.at, joints)?,
            mass: self.mass_kg,
            centre: Point3::from(from_mm(Vector3::from(self.centre_mm))),
            inertia,
            relative_uncertainty: self.mass_u_percent.map_or(0.0, |percent| percent / 100.0),
        })
    }
}
