//! The active parts of the stiffness model, in words.
//!
//! ```text
//! drive springs; 6 further springs; torque curves of A2; gravity compensator of A2;
//! gravity, relative to the posture where the tool was set; load-dependent stiffness; covariance of the compliances;
//! backlash of L, U; the calibrated arm; repeatability in the uncertainty;
//! model error of 9.4 % in the uncertainty
//! ```
//!
//! An answer has those of its own model, in this order.

use armill_core::robot::{Mass, Robot, Structure};
use armill_core::source::StiffnessModel;
use armill_core::units::to_um;

use crate::body_answers::attachment_name;
use crate::number::without_rounding;

/// The parts of `model` on this robot, the drive springs first.
pub fn parts(robot: &Robot, model: &StiffnessModel) -> Vec<String> {
    let structure = &model.structure;
    let name = |joint: usize| robot.joints()[joint].name.clone();
    let mut parts = vec!["drive springs".to_owned()];
    match structure.springs.len() {
        0 => {}
        1 => parts.push("1 further spring".to_owned()),
        n => parts.push(format!("{n} further springs")),
    }
    let curved: Vec<String> = (0..robot.joints().len())
        .filter(|joint| structure.curve(*joint).is_some())
        .map(name)
        .collect();
    if !curved.is_empty() {
        parts.push(format!("torque curves of {}", curved.join(", ")));
    }
    if let Some(compensator) = &structure.compensator {
        parts.push(format!("gravity compensator of {}", name(compensator.joint)));
    }
    if model.gravity.is_some() {
        parts.push("gravity, relative to the posture where the tool was set".to_owned());
    }
    if model.load_dependent {
        parts.push("load-dependent stiffness".to_owned());
    }
    if structure.covariance.is_some() {
        parts.push("covariance of the compliances".to_owned());
    }
    let backlash: Vec<String> = structure
        .joints_with_backlash()
        .map(|(joint, _)| name(joint))
        .collect();
    if !backlash.is_empty() {
        parts.push(format!("backlash of {}", backlash.join(", ")));
    }
    if model.actual.is_some() {
        parts.push("the calibrated arm".to_owned());
    }
    if let Some(thermal) = model.thermal {
        let growth = without_rounding(to_um(thermal.growth));
        parts.push(format!("thermal growth of the links by {growth} um/m"));
    }
    if let Some(learnt) = &structure.learnt {
        parts.push(format!("residual learnt from {} poses", learnt.poses()));
    }
    if structure.repeatability > 0.0 {
        parts.push("repeatability in the uncertainty".to_owned());
    }
    if structure.model_error > 0.0 {
        parts.push(format!(
            "model error of {} % in the uncertainty",
            without_rounding(structure.model_error * 100.0)
        ));
    }
    parts
}

/// Effects that the model neglects although the robot file specifies them.
///
/// A warning: masses are known, but the posture where the tool was set is not. Uncertain masses are for vibration.
pub fn left_out(model: &StiffnessModel) -> Option<String> {
    let known = |mass: &&Mass| mass.relative_uncertainty == 0.0;
    let masses = model.structure.masses.iter().filter(known).count();
    (model.gravity.is_none() && masses > 0).then(|| {
        let known = if masses == 1 {
            "1 mass is"
        } else {
            &format!("{masses} masses are")
        };
        format!("{known} known, but gravity is neglected: give the posture where the tool was set (`[gravity]`) to include it.")
    })
}

/// Attachments with an uncertain mass, each with its relative standard uncertainty, such as `A1 (45 %)`.
pub fn uncertain_masses(robot: &Robot, structure: &Structure) -> Vec<String> {
    let uncertain = structure
        .masses
        .iter()
        .filter(|mass| mass.relative_uncertainty > 0.0);
    let words = uncertain.map(|mass| {
        let at = attachment_name(robot, mass.attachment);
        format!("{at} ({:.0} %)", 100.0 * mass.relative_uncertainty)
    });
    words.collect()
}
