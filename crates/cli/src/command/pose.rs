//! `armill pose`: all postures of one pose, as text or as a [`PoseAnswer`] on stdout.
//!
//! `--joints-deg`, or `--at-mm` with `--axis` (or `--tilt-deg`) and `--spin-deg`, gives the pose of the tool;
//! `--tool-mm` its position relative to the flange, `--wrench-n` the load; `--compliance-...` replaces the values of
//! the robot file. `--drawing` draws the postures found.
//!
//! ```text
//! yaskawa/mh12, positions in base_link
//!
//! front elbow-up no-flip                                            a posture, named by its branch
//!   joints      S 0.000  L 11.600 ...   (inside limits, ...)        the signs and zeros of the robot file
//!   TCP         (x, y, z) mm                                        relative to --base
//!   clearance   a mm, body and body                                 in the cell of a study: the nearest bodies
//!   compliance  a, b, c µm/N in its principal directions, softest along (x, y, z)
//!   deviation   (x, y, z) µm, ... µm long (standard uncertainty (x, y, z) µm)
//!   by joint    S 1.20  L 3.40 ... µm                               magnitudes of the contributions: they need not add up
//! ```
//!
//! A pose without a posture gets the reason instead of postures; this is a result, not an error.

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::spatial::Wrench;
use armill_core::units::{from_deg, from_mm};
use armill_core::workpiece::Plane;
use armill_study::StudyError;
use armill_study::joint_unit::JointUnit;
use armill_study::output::posture_drawing;
use armill_study::pose::{At, PoseAnswer, PoseQuestion, PostureAnswer};
use armill_study::uncertainty_words::NOT_KNOWN;

use super::pose_subject::{PoseSubject, with_compliances};
use crate::arguments::PoseArguments;
use crate::arguments::numbers::{finite, three, three_or_six};
use crate::outcome::Outcome;
use crate::terminal::print;

/// Finds all postures of the pose and prints them.
///
/// # Errors
/// No such robot; an invalid number or count; compliances that do not fit the robot; a drawing that
/// cannot be written.
pub(crate) fn run(arguments: &PoseArguments) -> Result<Outcome, StudyError> {
    let mut subject = PoseSubject::find(arguments)?;
    let caution = with_compliances(
        arguments.compliance_rad_per_n_m.as_deref(),
        arguments.compliance_class.as_deref(),
        subject.robot(),
    )?;
    let question = PoseQuestion {
        at: at(arguments)?,
        flange_from_tool: subject.flange_from_tool(arguments.tool_mm.as_deref())?,
        wrench: arguments.wrench_n.as_deref().map(wrench).transpose()?,
        load_dependent: arguments.load_dependent,
        reference_joints_deg: reference(arguments)?,
        base: subject.base(arguments.base.as_deref())?,
        caution,
        home_deg: arguments.home_deg.clone(),
    };
    finite("--home-deg", question.home_deg.as_deref().unwrap_or_default())?;
    let answer = subject.answer(&question)?;
    if let Some(file) = &arguments.drawing {
        let drawing = posture_drawing(&subject.robot().robot, &question.flange_from_tool, &answer);
        super::drawing::write(&arguments.writing.writer("pose"), file, &drawing)?;
    }
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// Joint positions at which the tool was measured; finite, their count is checked by the study.
fn reference(arguments: &PoseArguments) -> Result<Option<Vec<f64>>, StudyError> {
    let joints = arguments.reference_joints_deg.clone();
    finite("--reference-joints-deg", joints.as_deref().unwrap_or_default())?;
    Ok(joints)
}

/// Pose of the tool: joints if given, otherwise the TCP in m with its axis and spin. Without `--axis` the tool
/// is perpendicular to a plane at the origin of the base, tilted by `--tilt-deg` (upright without it).
fn at(arguments: &PoseArguments) -> Result<At, StudyError> {
    if let Some(joints) = &arguments.joints_deg {
        finite("--joints-deg", joints)?;
        return Ok(At::JointsDeg(joints.clone()));
    }
    let tcp = from_mm(three("--at-mm", arguments.at_mm.as_deref().unwrap_or_default())?);
    let tilt_deg = arguments.tilt_deg.unwrap_or(0.0);
    finite("--tilt-deg", &[tilt_deg])?;
    let axis = match &arguments.axis {
        Some(axis) => Unit::try_new(three("--axis", axis)?, 1e-12)
            .ok_or_else(|| StudyError::value("--axis 0,0,0 has no direction", "such as --axis 0,0,-1"))?,
        None => Plane::tilted(Point3::origin(), from_deg(tilt_deg)).tool_axis(),
    };
    let spin_deg = arguments.spin_deg.unwrap_or(0.0);
    finite("--spin-deg", &[spin_deg])?;
    Ok(At::Tool {
        tcp: tcp.into(),
        axis,
        spin: from_deg(spin_deg),
    })
}

/// The load: force in N and moment in N m on the tool at the TCP, base axes.
fn wrench(values: &[f64]) -> Result<Wrench, StudyError> {
    let [fx, fy, fz, mx, my, mz] = three_or_six("--wrench-n", Some(values))?;
    Ok(Wrench {
        force: Vector3::new(fx, fy, fz),
        moment: Vector3::new(mx, my, mz),
    })
}

/// The result as text, see the documentation of this module.
fn as_text(answer: &PoseAnswer) -> String {
    let mut lines = vec![format!("{}, positions in {}", answer.robot, answer.base)];
    if answer.model.len() > 1 {
        lines.push(format!("model: {}", answer.model.join("; ")));
    }
    lines.extend(answer.unreachable.iter().map(|miss| miss.message.clone()));
    for posture in &answer.postures {
        lines.push(String::new());
        lines.extend(posture_text(answer, posture));
    }
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.push(format!("sources: armill robots {}", answer.robot));
    lines.join("\n")
}

/// The lines of one posture; unknown values have no line.
fn posture_text(answer: &PoseAnswer, posture: &PostureAnswer) -> Vec<String> {
    let three = |v: &[f64; 3]| {
        let [x, y, z] = v.map(without_minus_zero);
        format!("({x:.2}, {y:.2}, {z:.2})")
    };
    let joints = answer
        .joint_names
        .iter()
        .zip(&answer.joint_units)
        .zip(&posture.joints_deg)
        .map(|((name, unit), q)| {
            let slides = if *unit == JointUnit::SLIDING.name {
                " mm"
            } else {
                ""
            };
            format!("{name} {:.3}{slides}", without_minus_zero(*q))
        });
    let unit_of = |joint: &String| {
        let found = answer.joint_names.iter().position(|name| name == joint);
        found.map_or("", |index| answer.joint_units[index])
    };
    let joints = joints.collect::<Vec<_>>().join("  ");
    let mut lines = vec![posture.branch.clone()];
    let limits = match (&posture.limit_joint, posture.limit_margin_deg) {
        (Some(joint), Some(margin)) if posture.within_limits => {
            format!(
                "inside limits, smallest margin {joint}, {margin:.1} {}",
                unit_of(joint)
            )
        }
        (Some(joint), Some(margin)) => {
            format!("OUTSIDE LIMITS, {joint} by {:.1} {}", -margin, unit_of(joint))
        }
        _ => "limits not known".to_owned(),
    };
    lines.push(format!("  joints      {joints}   ({limits})"));
    lines.push(format!("  TCP         {} mm", three(&posture.tool.xyz_mm)));
    if let Some((least, [first, second])) = posture.clearance_mm.zip(posture.nearest.as_ref()) {
        lines.push(match least > 0.0 {
            true => format!("  clearance   {least:.2} mm, {first} and {second}"),
            false => format!("  COLLISION   {first} and {second}"),
        });
    }
    lines.extend(posture.singularity.iter().map(|s| format!("  SINGULAR    {s}")));
    if let Some(stiffness) = &posture.stiffness {
        let [a, b, c] = stiffness.principal_um_per_n;
        lines.push(format!(
            "  compliance  {a:.2}, {b:.2}, {c:.2} µm/N in its principal directions, softest along {}",
            three(&stiffness.principal_direction[0])
        ));
    }
    lines.extend(posture.unstable.iter().map(|why| format!("  UNSTABLE    {why}")));
    if let (Some(deviation), Some(shares)) = (&posture.deviation_um, &posture.joint_share_um) {
        let length = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        lines.push(format!(
            "  deviation   {} µm, {:.2} µm long (standard uncertainty {})",
            three(deviation),
            length(deviation),
            posture
                .deviation_u_um
                .as_ref()
                .map_or_else(|| NOT_KNOWN.to_owned(), |u| format!("{} µm", three(u)))
        ));
        let shares = answer
            .contributors
            .iter()
            .zip(shares)
            .map(|(name, share)| format!("{name} {:.2}", length(share)));
        lines.push(format!(
            "  by joint    {} µm",
            shares.collect::<Vec<_>>().join("  ")
        ));
    }
    lines
}

/// Avoids -0.000: numbers smaller than half of the third decimal are 0.
fn without_minus_zero(value: f64) -> f64 {
    if value.abs() < 5e-4 { 0.0 } else { value }
}
