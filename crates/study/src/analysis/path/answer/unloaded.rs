//! Displacements along a path in addition to those by the load: backlash and geometry.

use armill_core::optimize::reversals;
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::joint_order::joint_order;

/// Displacements in addition to those by the load; they are included in the deviations of the path.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct UnloadedAnswer {
    /// Largest displacement across the tool, all cases.
    pub max_in_plane_um: f64,
    /// Largest length of it.
    pub max_full_um: f64,
    /// Every joint with backlash.
    pub joints: Vec<JointBacklash>,
    /// Whether the arm differs from the nominal model of its controller.
    pub calibrated_robot: bool,
}

/// The backlash of one joint.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct JointBacklash {
    /// Its name.
    pub name: String,
    /// The whole backlash of a revolute joint.
    pub backlash_deg: Option<f64>,
    /// The whole backlash of a prismatic joint.
    pub backlash_mm: Option<f64>,
    /// Number of reversals of the joint on the cuts of the path.
    pub reversals: usize,
}

impl UnloadedAnswer {
    /// The displacements along this path; `None` if load and gravity alone move the tool.
    pub fn of(robot: &Robot, analysis: &PathAnalysis, found: &PathResult) -> Option<UnloadedAnswer> {
        let unloaded = found.along.backlash_geometry.as_ref()?;
        let cases = found.along.answers.case_count;
        let in_plane = |(at, moved): (usize, &armill_core::nalgebra::Vector3<f64>)| {
            let parts = analysis.track.parts(at / cases, moved);
            parts.along.hypot(parts.cross)
        };
        let turned_back = reversals(&analysis.track.path, &found.along.answers);
        let model = &analysis.setting.model;
        let mut with_backlash: Vec<_> = model.structure.joints_with_backlash().collect();
        let order = joint_order(robot);
        with_backlash.sort_by_key(|(joint, _)| order.iter().position(|other| other == joint));
        let play = with_backlash.into_iter().map(|(joint, backlash)| {
            let slides = robot.slides(joint);
            JointBacklash {
                name: robot.joints()[joint].name.clone(),
                backlash_deg: (!slides).then(|| to_deg(backlash.gap)),
                backlash_mm: slides.then_some(to_mm(backlash.gap)),
                reversals: turned_back[joint],
            }
        });
        Some(UnloadedAnswer {
            max_in_plane_um: to_um(
                unloaded
                    .displacements
                    .iter()
                    .enumerate()
                    .map(in_plane)
                    .fold(0.0, f64::max),
            ),
            max_full_um: to_um(
                unloaded
                    .displacements
                    .iter()
                    .map(armill_core::nalgebra::Vector3::norm)
                    .fold(0.0, f64::max),
            ),
            joints: play.collect(),
            calibrated_robot: model.actual.is_some(),
        })
    }
}
