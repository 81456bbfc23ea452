//! A robot file with the stiffness and the lost motion that a log showed.
//!
//! Compliance at the joint: `c/u`, with the torsion `c` per torque of the motor and the gear ratio `u`. Lost motion: the step at a reversal, where it is negative; it is the least value, since friction hides a part of it.

use armill_core::robot::Robot;
use armill_core::units::from_urad;
use armill_formats::robot::armill::{
    Identified, IdentifiedSpring, JointBacklash, MeasuredBacklash, with_backlash, with_springs,
};
use armill_formats::robot::spring_tables::SpringKind;
use armill_study::StudyError;

use super::answer::DrivesAnswer;

/// The file `text` (at `path`) of `robot` with the compliances and the lost motion that were found, at least three standard uncertainties from 0.
///
/// Joints of which nothing was found keep what the file has.
///
/// # Errors
/// Nothing was found; a file that is not TOML, or that no longer reads with these values.
pub fn robot_file(
    robot: &Robot,
    [path, text]: [&str; 2],
    answer: &DrivesAnswer,
) -> Result<String, StudyError> {
    let name = |joint: usize| robot.joints()[joint - 1].name.clone();
    let springs: Vec<IdentifiedSpring> = answer
        .joints
        .iter()
        .filter_map(|joint| {
            let stiffness = joint.stiffness_nm_per_rad?;
            Some(IdentifiedSpring {
                at: name(joint.joint),
                kind: SpringKind::Drive,
                compliance: 1.0 / stiffness.value,
                standard_uncertainty: stiffness.u / stiffness.value.powi(2),
            })
        })
        .collect();
    let joints: Vec<JointBacklash> = answer
        .joints
        .iter()
        .filter_map(|joint| {
            let (gap, step) = joint.lost_motion_urad.zip(joint.reversal_urad)?;
            Some(JointBacklash {
                joint: name(joint.joint),
                turns: true,
                gap: from_urad(gap),
                standard_uncertainty: from_urad(step.u),
            })
        })
        .collect();
    if springs.is_empty() && joints.is_empty() {
        return Err(StudyError::value(
            format!(
                "{}: neither a stiffness nor lost motion was found; no robot file is written",
                answer.file
            ),
            "give the gear ratios (--gear), and a log of both encoders with larger torques and more reversals",
        ));
    }
    let place = answer.file.clone();
    let what = |of: &str| {
        format!(
            "{of} found by armill in a log of {:.1} s of motor and link encoders",
            answer.duration_s
        )
    };
    let mut written = text.to_owned();
    if !springs.is_empty() {
        let identified = Identified {
            springs,
            covariance: Vec::new(),
            model_error: None,
            what: what("compliances of the drives"),
            place: place.clone(),
        };
        written = with_springs(path, &written, &identified)?;
    }
    if !joints.is_empty() {
        let measured = MeasuredBacklash {
            joints,
            what: what("lost motion, its least value,"),
            place,
        };
        written = with_backlash(path, &written, &measured)?;
    }
    Ok(written)
}
