//! The stiffness model of an analysis: that of the robot file, and what the study adds to it.
//!
//! | key | meaning |
//! |---|---|
//! | robot file | springs, masses, compensator, torque curves, covariance, backlash, repeatability, learnt residual |
//! | `[[tool.spring]]`, `[[tool.mass]]` | compliances and masses of holder, spindle and tool |
//! | `tool.stick_out_mm` and related keys | a cutter that bends like a clamped bar, two springs |
//! | `[gravity]` | joint positions when the tool was set, and the direction of gravity |
//! | `repeatability_mm` | how the arm scatters, in place of the robot file's |
//! | `load_dependent` | whether the load acts on the deflected arm |
//! | `[thermal]` | thermal growth of the links since the calibration |
//! | `calibrated_robot` | the calibrated geometry, if the controller uses a nominal model |

use std::sync::Arc;

use armill_core::nalgebra::Vector3;
use armill_core::robot::spring::cutter_springs;
use armill_core::robot::{Robot, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Gravity, StiffnessModel, ThermalGrowth, repeatability};
use armill_core::units::from_mm;
use armill_formats::robot::spring_tables::SpringTableError;

use crate::error::StudyError;
use crate::input::problem_log::ProblemLog;
use crate::input::tables::{CutterMaterial, GravityTable, ThermalTable, ToolTable};
use crate::joint_order::joint_positions;

/// What the study adds to the stiffness model of the robot file, as written.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessTables<'a> {
    /// Gravity.
    pub gravity: Option<&'a GravityTable>,
    /// Thermal growth of the links.
    pub thermal: Option<&'a ThermalTable>,
    /// Whether the load acts on the deflected arm.
    pub load_dependent: bool,
    /// Pose repeatability RP of ISO 9283.
    pub repeatability_mm: Option<f64>,
}

/// The model of `robot`, which is in truth the `actual` one, with this tool; `None` if something is wrong with it.
pub fn model(
    log: &mut ProblemLog<'_>,
    given: &StiffnessTables<'_>,
    tool: Option<&ToolTable>,
    robot: &Robot,
    actual: Option<&Arc<Robot>>,
) -> Option<StiffnessModel> {
    // All problems are reported, so whether there are new ones is evaluated at the end.
    let before = log.problems.len();
    let mut structure = robot.structure().clone();
    if let Some(pose_mm) = given.repeatability_mm {
        structure.repeatability = repeatability::deviation_of(from_mm(pose_mm));
    }
    if let Some(tool) = tool {
        add_tool(log, tool, robot, &mut structure);
    }
    let gravity = given
        .gravity
        .and_then(|table| gravity(log, table, robot, &structure));
    if given.load_dependent && gravity.is_some() && !robot.chain().ground().is_base() {
        let message = "a load-dependent equilibrium with gravity is not known of a robot with a positioner or with the part in its hand";
        log.problem("load_dependent", message, "remove one of the three");
    }
    (log.problems.len() == before).then_some(StiffnessModel {
        structure,
        gravity,
        load_dependent: given.load_dependent,
        actual: actual.cloned(),
        thermal: given
            .thermal
            .map(|table| ThermalGrowth::new(table.expansion_per_k, table.difference_k, table.u_k)),
    })
}

impl ToolTable {
    /// Sources of its springs and masses, each once.
    pub fn sources(&self) -> Vec<String> {
        let of_springs = self.spring.iter().map(|spring| &spring.source);
        let all = of_springs.chain(self.mass.iter().map(|mass| &mass.source));
        let mut sources: Vec<String> = Vec::new();
        for source in all {
            if !sources.contains(source) {
                sources.push(source.clone());
            }
        }
        sources
    }
}

/// Adds springs and masses of the tool, and the cutter if its stick-out is given.
fn add_tool(log: &mut ProblemLog<'_>, tool: &ToolTable, robot: &Robot, structure: &mut Structure) {
    let joints: Vec<&str> = robot.joints().iter().map(|joint| joint.name.as_str()).collect();
    let ground = robot.chain().ground();
    let of_stand = ["flange", "tool"];
    let held = tool.spring.iter().map(|table| ("spring", &table.at));
    let held = held.chain(tool.mass.iter().map(|table| ("mass", &table.at)));
    if ground.part_is_in_hand()
        && let Some((kind, at)) = held.into_iter().find(|(_, at)| !of_stand.contains(&at.as_str()))
    {
        let message =
            format!("a {kind} of the tool is at `{at}`, but the tool is not on the robot: it holds the part");
        log.problem("tool", message, "`flange` (the mount of the tool) or `tool`");
        return;
    }
    let mut report = |table: String, fault: SpringTableError| {
        log.problem(&fault.path_in(&table), fault.message, &fault.hint);
    };
    for (index, table) in tool.spring.iter().enumerate() {
        match table.springs(&joints) {
            Ok(springs) => structure
                .springs
                .extend(springs.iter().map(|spring| ground.spring_of_arm(spring))),
            Err(fault) => report(format!("tool.spring[{index}]"), fault),
        }
    }
    for (index, table) in tool.mass.iter().enumerate() {
        match table.mass(&joints) {
            Ok(mass) => structure.masses.push(ground.mass_of_arm(&mass)),
            Err(fault) => report(format!("tool.mass[{index}]"), fault),
        }
    }
    let hint =
        "stick_out_mm = 40, diameter_mm = 10, material = \"carbide\" (or \"hss\", or modulus_gpa = 600)";
    match (tool.stick_out_mm, tool.diameter_mm) {
        (Some(length), Some(diameter)) => match (tool.material, tool.modulus_gpa) {
            (None, Some(gpa)) => structure.springs.extend(cutter(length, diameter, gpa)),
            (Some(material), None) => structure
                .springs
                .extend(cutter(length, diameter, modulus(material))),
            _ => log.problem(
                "tool.stick_out_mm",
                "the cutter needs either a `material` or a `modulus_gpa`",
                hint,
            ),
        },
        (None, None) if tool.material.is_none() && tool.modulus_gpa.is_none() => {}
        _ => log.problem(
            "tool",
            "the bending of a cutter requires stick-out, diameter and material",
            hint,
        ),
    }
}

/// The two springs of a cutter, from mm and GPa.
fn cutter(length_mm: f64, diameter_mm: f64, modulus_gpa: f64) -> [armill_core::robot::Spring; 2] {
    cutter_springs(from_mm(length_mm), from_mm(diameter_mm), modulus_gpa * 1e9)
}

/// Young's modulus, GPa: usual values of cutting-tool handbooks; grades differ by some 10 %.
fn modulus(material: CutterMaterial) -> f64 {
    match material {
        CutterMaterial::Carbide => 600.0,
        CutterMaterial::Hss => 215.0,
    }
}

/// The gravity of `[gravity]`, in base; a problem where it would move nothing, has no direction, or counts joints
/// wrongly.
fn gravity(
    log: &mut ProblemLog<'_>,
    table: &GravityTable,
    robot: &Robot,
    structure: &Structure,
) -> Option<Gravity> {
    let reference = match joint_positions(robot, &table.reference_joints_deg) {
        Ok(reference) => Some(reference),
        Err(StudyError::Value { message, .. }) => {
            let hint = "the joint positions when the tool was set, base to flange";
            log.problem("gravity.reference_joints_deg", message, hint);
            None
        }
        Err(_) => None,
    };
    if structure.masses.is_empty() && structure.compensator.is_none() {
        let message = "gravity has no effect: neither robot nor tool has a mass";
        let hint = "add [[mass]] to the robot file, or [[tool.mass]] for spindle and payload";
        log.problem("gravity", message, hint);
    }
    let direction = Vector3::from(table.direction.unwrap_or([0.0, 0.0, -1.0])).try_normalize(1e-9);
    if direction.is_none() {
        let hint = "[0, 0, -1] for an arm on the floor, [0, 0, 1] under the ceiling";
        log.problem(
            "gravity.direction",
            "the direction of gravity has zero length",
            hint,
        );
    }
    Some(Gravity {
        acceleration: direction? * FREE_FALL,
        reference: reference?,
    })
}
