//! The input numbers of the result, each with its source.
//!
//! Load, tool and tolerance are those of the first map of the answer, else of the first path, box or set of holes. A
//! long source that repeats from row to row is given once.

use armill_report::html::Input;

use crate::analysis::cells::input;
use crate::answer::{SettingAnswer, StudyAnswer};
use crate::file::resolve::Study;
use crate::joint_unit::JointUnit;
use crate::output::report::cut;
use crate::output::report::sources::{THE_STUDY, place};
use crate::uncertainty_words::plus_minus;

/// Robot and compliances, load or cut, tolerance, tool, stiffness model.
pub(super) fn rows(study: &Study, answer: &StudyAnswer) -> Vec<Input> {
    let mut inputs = robot(study, answer);
    let settings = answer
        .maps
        .iter()
        .map(|map| &map.setting)
        .chain(answer.paths.iter().map(|path| &path.setting))
        .chain(answer.volumes.iter().map(|volume| &volume.setting))
        .chain(answer.holes.iter().map(|holes| &holes.setting));
    let first = settings.into_iter().next();
    inputs.extend(first.into_iter().flat_map(forces));
    inputs.extend(cut::rows(study, answer));
    inputs.extend(first.into_iter().flat_map(|setting| others(answer, setting)));
    for index in (1..inputs.len()).rev() {
        if inputs[index].source.len() > LONG && inputs[index].source == inputs[index - 1].source {
            AS_ABOVE.clone_into(&mut inputs[index].source);
        }
    }
    inputs
}

/// A longer source is given once, not in consecutive rows.
const LONG: usize = 40;
/// The text that replaces it.
const AS_ABOVE: &str = "as above";

/// Robot and chain, then the compliance of each joint with its uncertainty.
fn robot(study: &Study, answer: &StudyAnswer) -> Vec<Input> {
    let first = study.robot.joint_notes.first();
    let chain = first.and_then(|joint| joint.source.clone()).unwrap_or_default();
    let mut inputs = vec![input(
        "robot",
        format!("{} ({})", answer.robot.title, answer.robot.name),
        "",
        &place(answer, &chain),
    )];
    for joint in &answer.robot.joints {
        let (unit, value, u) = match joint.compliance_um_per_n {
            Some(value) => (JointUnit::SLIDING, value, joint.compliance_u_um_per_n),
            None => (
                JointUnit::TURNING,
                joint.compliance_rad_per_n_m.unwrap_or_default(),
                joint.compliance_u_rad_per_n_m,
            ),
        };
        let value = format!("{value:.3e} {}", plus_minus(u.map(|u| format!("{u:.1e}"))));
        let assumed = if answer.robot.compliance_assumed {
            ", assumed"
        } else {
            ""
        };
        let name = format!("compliance of joint {}{assumed}", joint.name);
        let source = place(answer, &joint.compliance_source);
        inputs.push(input(&name, value, unit.compliance_name, &source));
    }
    inputs
}

/// The given cases; none if forces come with a path.
fn forces(setting: &SettingAnswer) -> Vec<Input> {
    let source = setting.load_source.as_deref().unwrap_or(THE_STUDY);
    let force = |(i, force): (usize, &[f64; 3])| {
        let value = format!("({}, {}, {})", force[0], force[1], force[2]);
        input(&format!("force on the tool, case {}", i + 1), value, "N", source)
    };
    setting.cases_n.iter().enumerate().map(force).collect()
}

/// Tolerance, tool, plane, stiffness model and frame.
fn others(answer: &StudyAnswer, setting: &SettingAnswer) -> Vec<Input> {
    let programs_alone = answer.maps.is_empty() && answer.paths.iter().all(|path| path.program.is_some());
    let tolerance = if programs_alone {
        "tolerance, across the tool"
    } else {
        "tolerance, in plane"
    };
    vec![
        input(tolerance, format!("{}", setting.tolerance_um), "µm", THE_STUDY),
        input(
            "tool centre point from the flange",
            format!("{:.1}", setting.tool_length_mm),
            "mm",
            THE_STUDY,
        ),
        input(
            "centre of the plane",
            format!(
                "({}, {}, {})",
                setting.centre_mm[0], setting.centre_mm[1], setting.centre_mm[2]
            ),
            "mm",
            THE_STUDY,
        ),
        orientation(setting),
        input("stiffness model", setting.model.join("; "), "", "robot and study"),
        input("reference frame", setting.base.clone(), "", THE_STUDY),
    ]
}

/// Tilt of the plane, or its normal where it is given by a rotation.
fn orientation(setting: &SettingAnswer) -> Input {
    let [x, y, z] = setting.normal_axis;
    match setting.tilt_deg {
        Some(tilt) => input("tilt of the plane", format!("{tilt}"), "deg", THE_STUDY),
        None => input("normal of the plane", format!("({x}, {y}, {z})"), "", THE_STUDY),
    }
}
