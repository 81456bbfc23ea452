//! What a tool assembly is attached to: the nose of a spindle on an arm, or one whose modes are measured.
//!
//! ```text
//! v_nose = v + w x d        shape of a mode at the nose from that at the TCP, which is at the distance -d
//! ```

use armill_core::dynamics::{Mode, receptance};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Complex, Matrix3, Matrix6, Rotation3, Vector3};
use armill_core::source::{Arm, ArmState, StiffnessModel};
use armill_formats::modal::ModalData;
use armill_formats::robot::RobotDescription;

use crate::file::resolve::Study;
use crate::joint_order::joint_positions;
use crate::modes::{known_compliance, needs_mass, with_damping};
use crate::pose::first_setting;
use crate::{StudyError, stability};

/// An arm and the nose of its spindle.
#[derive(Clone, Debug)]
pub struct ArmAtNose {
    /// Joint positions, deg (mm).
    pub joints_deg: Vec<f64>,
    /// Flange to spindle nose; its z axis is that of the tool assembly, towards the tip.
    pub flange_from_nose: Isometry,
    /// Damping ratio of every mode in place of what the robot file gives.
    pub damping_ratio: Option<f64>,
    /// The warning for assumed compliances, if they are.
    pub caution: Option<String>,
}

/// What a tool assembly is attached to: modes at the nose, axes of the nose.
#[derive(Clone, Debug)]
pub struct Machine {
    /// What it is.
    pub name: String,
    /// Modes at the nose.
    modes: Vec<Mode>,
    /// Compliance without mass, SI.
    static_compliance: Matrix6<f64>,
    /// What to know of them.
    pub notes: Vec<String>,
}

impl Machine {
    /// A rigid one.
    pub fn rigid() -> Machine {
        Machine {
            name: "a rigid spindle nose".to_owned(),
            modes: Vec::new(),
            static_compliance: Matrix6::zeros(),
            notes: vec!["the spindle nose is rigid: the arm is not included".to_owned()],
        }
    }

    /// One whose modes were measured at the nose, in the feed frame.
    pub fn measured(data: ModalData, feed_from_nose: &Rotation3<f64>) -> Machine {
        let mut notes = vec![
            "the modal data of the spindle nose have no rotation: it is taken as rigid against moments"
                .to_owned(),
        ];
        notes.extend(data.note);
        Machine {
            name: format!("{} ({})", data.name, data.source),
            modes: (data.modes.iter())
                .map(|named| named.mode.in_axes(feed_from_nose))
                .collect(),
            static_compliance: Matrix6::zeros(),
            notes,
        }
    }

    /// An arm in a posture.
    ///
    /// # Errors
    /// A wrong number of joints; unknown compliances; an arm without masses, or where nothing vibrates.
    pub fn arm(described: &RobotDescription, arm: &ArmAtNose) -> Result<Machine, StudyError> {
        let model = StiffnessModel {
            structure: described.robot.structure().clone(),
            ..StiffnessModel::DRIVES.clone()
        };
        of_arm(described, arm, &model, &arm.flange_from_nose)
    }

    /// The arm of a study, with the springs and masses of its tool, which are those of the spindle.
    ///
    /// # Errors
    /// As of [`Machine::arm`]; a study without analyses.
    pub fn arm_of_study(study: &Study, arm: &ArmAtNose) -> Result<Machine, StudyError> {
        let setting = first_setting(study)?;
        let mut machine = of_arm(&study.robot, arm, &setting.model, &setting.flange_from_tool)?;
        machine.notes.push(
            "springs and masses of the tool of the study are taken as those of the spindle: without holder and cutter".to_owned(),
        );
        Ok(machine)
    }

    /// Receptance at the nose at `w` (rad/s), axes of the nose, SI.
    pub fn receptance(&self, w: f64) -> Matrix6<Complex<f64>> {
        receptance(&self.modes, w) + self.static_compliance.map(|part| Complex::new(part, 0.0))
    }
}

/// The modal data of this file, as a machine.
///
/// # Errors
/// A file that cannot be read, or its problems.
pub fn measured_in(path: &std::path::Path, feed_from_nose: &Rotation3<f64>) -> Result<Machine, StudyError> {
    Ok(Machine::measured(stability::modes_of(path)?, feed_from_nose))
}

fn of_arm(
    described: &RobotDescription,
    arm: &ArmAtNose,
    model: &StiffnessModel,
    flange_from_tool: &Isometry,
) -> Result<Machine, StudyError> {
    let robot = &described.robot;
    let q = joint_positions(robot, &arm.joints_deg)?;
    let mut model = model.clone();
    model.load_dependent = false;
    with_damping(&mut model, arm.damping_ratio)?;
    let compliance = known_compliance(robot)?;
    needs_mass(robot, &model)?;
    let setting = Arm {
        robot,
        compliance,
        model: &model,
        flange_from_tool,
    };
    let mut state = ArmState::new(setting);
    state.set_joints(&q);
    let found = state
        .modes()
        .map_err(|error| StudyError::value(error.to_string(), ""))?;
    if found.modes.is_empty() {
        return Err(StudyError::value(
            "no mass moves when the joints and springs of the arm deflect: it has no modes",
            "add [[mass]] at the links behind the joints that deflect",
        ));
    }
    let tool_from_nose = flange_from_tool.inverse() * arm.flange_from_nose;
    let base_from_nose = state.base_from_tool().rotation * tool_from_nose.rotation.to_rotation_matrix();
    let distance = state.base_from_tool().rotation * tool_from_nose.translation.vector;
    let shift = to_nose(&distance, &base_from_nose);
    let modes = found.modes.iter().map(|mode| Mode {
        shape: shift * mode.at_tool.shape,
        ..mode.at_tool
    });
    let mut notes: Vec<String> = arm.caution.iter().chain(&described.note).cloned().collect();
    if model.structure.damping.is_none() {
        notes.push(format!(
            "damping ratio {} assumed for every mode of the arm",
            armill_core::dynamics::modes::ASSUMED_DAMPING
        ));
    }
    Ok(Machine {
        name: format!("{} in the given posture", robot.name()),
        modes: modes.collect(),
        static_compliance: shift * found.static_compliance * shift.transpose(),
        notes,
    })
}

/// Takes a twist of the TCP (base) to the nose, at `distance` from it (m, base), in the axes of the nose.
fn to_nose(distance: &Vector3<f64>, base_from_nose: &Rotation3<f64>) -> Matrix6<f64> {
    let turn: Matrix3<f64> = base_from_nose.inverse().into_inner();
    let mut all = Matrix6::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
    // w x d = -d x w
    all.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-(turn * distance.cross_matrix()));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use armill_core::nalgebra::Vector6;

    #[test]
    fn a_turn_of_the_tool_moves_the_nose_across() {
        // About base z by 1 rad, nose 0.2 m along base x: it moves by 0.2 m along base y, which is x of the nose.
        let base_from_nose = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        let found = to_nose(&Vector3::new(0.2, 0.0, 0.0), &base_from_nose)
            * Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert!(
            (found - Vector6::new(0.2, 0.0, 0.0, 0.0, 0.0, 1.0)).norm() < 1e-15,
            "{found}"
        );
    }
}
