//! The drill of a program: its size, the material, and what the program does not specify.
//!
//! Thrust and torque are those of the lips alone, by Kienzle's law of the material and a ratio of the force normal to a
//! lip. The chisel edge is left out, and every answer says so.

use std::f64::consts::TAU;

use armill_core::path::Drill;
use armill_core::units::{from_deg, from_mm};
use armill_formats::material::Material;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::analysis::path::cut::{kienzle, material, one_set_remark};
use crate::input::problem_log::ProblemLog;

/// A twist drill that enters the part where the program moves along its axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrillTable {
    /// Name of a material of the library.
    pub material: String,
    /// Its diameter.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub diameter_mm: f64,
    /// Full angle of its point; 118 if left out.
    #[schemars(range(min = 30.0, max = 180.0))]
    pub point_deg: Option<f64>,
    /// Feed, if the program does not specify it.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub feed_mm_per_min: Option<f64>,
    /// Spindle speed, if the program does not specify it.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub spindle_rpm: Option<f64>,
    /// Force normal to a lip over the cutting force, and its standard uncertainty.
    pub normal_ratio: Option<[f64; 2]>,
    /// Standard uncertainty of the specific force, in place of the scatter of the material's sets.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub u_percent: Option<f64>,
}

/// A drill with all that thrust and torque need.
#[derive(Clone, Debug)]
pub struct DrillCut {
    /// The drill for the core.
    pub drill: Drill,
    /// The material.
    pub material: Material,
    /// Notes for the user on it.
    pub remarks: Vec<String>,
}

/// Default point angle of a twist drill, deg.
const POINT_DEG: f64 = 118.0;
/// Default ratio of normal to cutting force on a lip, with its standard uncertainty: wide, since it follows
/// rake, point and wear.
const NORMAL_RATIO: [f64; 2] = [0.5, 0.2];

/// The drill of the table at this key; `None` if it has problems.
pub fn resolve(log: &mut ProblemLog<'_>, key: &str, table: &DrillTable) -> Option<DrillCut> {
    let of_material = format!("{key}.material");
    let material = material(log, &of_material, &table.material)?;
    let Some(together) = material.kienzle() else {
        let message = format!("{} has no specific cutting force", material.name);
        log.problem(&of_material, message, "use another material");
        return None;
    };
    let mut remarks = vec![
        "thrust and torque of a drill are an estimate without its chisel edge, which can double the thrust where no pilot \
         hole is; the way from the retract plane to the part counts as drilled"
            .to_owned(),
    ];
    let relative = table.u_percent.map(|percent| percent / 100.0);
    if together.covariance.is_none() && relative.is_none() {
        remarks.push(one_set_remark(&material.name));
    }
    if table.normal_ratio.is_none() {
        remarks.push(format!(
            "the force normal to a lip is assumed as {} +- {} of the cutting force, since the study does not specify it.",
            NORMAL_RATIO[0], NORMAL_RATIO[1]
        ));
    }
    let normal = table.normal_ratio.unwrap_or(NORMAL_RATIO);
    let law = kienzle(&together, relative, [normal, [0.0, 0.0]]);
    let law = law
        .map_err(|error| log.problem(key, error.to_string(), "check the number"))
        .ok()?;
    Some(DrillCut {
        drill: Drill {
            diameter: from_mm(table.diameter_mm),
            point_angle: from_deg(table.point_deg.unwrap_or(POINT_DEG)),
            law,
            feed: table
                .feed_mm_per_min
                .filter(|feed| *feed > 0.0)
                .map(|feed| from_mm(feed) / 60.0),
            spindle: table.spindle_rpm.map(|speed| speed * TAU / 60.0),
        },
        material,
        remarks,
    })
}
