//! `armill modes`: the modes of vibration of an arm in one posture, as text or as a [`ModesAnswer`] on stdout.
//!
//! ```text
//! maker/arm at A1 0.0  A2 -20.0 ..., TCP (x, y, z) mm in base_link
//!
//! mode    frequency  damping  tool moves along       modal mass  stiffness  deflects
//!    1       9.1 Hz    0.030  (0.05, 0.99, 0.10)       210 kg     0.7 N/um  A1 71 %, A2 20 %
//!
//! lowest mode 9.1 Hz: 71 % A1, moves the tool along y
//! ```

use armill_study::StudyError;
use armill_study::modes::{ModeAnswer, ModesAnswer, ModesQuestion};

use super::pose_subject::{PoseSubject, with_compliances};
use crate::arguments::ModesArguments;
use crate::arguments::numbers::finite;
use crate::outcome::Outcome;
use crate::terminal::print;

/// Finds the modes and prints them.
///
/// # Errors
/// No such robot; an invalid number or count; an arm without compliances or masses.
pub(crate) fn run(arguments: &ModesArguments) -> Result<Outcome, StudyError> {
    let mut subject = PoseSubject::named(&arguments.robot)?;
    let caution = with_compliances(
        arguments.compliance_rad_per_n_m.as_deref(),
        arguments.compliance_class.as_deref(),
        subject.robot(),
    )?;
    finite("--joints-deg", &arguments.joints_deg)?;
    let question = ModesQuestion {
        joints_deg: arguments.joints_deg.clone(),
        flange_from_tool: subject.flange_from_tool(arguments.tool_mm.as_deref())?,
        base: subject.base(arguments.base.as_deref())?,
        damping_ratio: arguments.damping_ratio,
        caution,
    };
    let answer = subject.modes(&question)?;
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// The result as text, see the documentation of this module.
fn as_text(answer: &ModesAnswer) -> String {
    let joints = answer.joint_names.iter().zip(&answer.joints_deg);
    let joints: Vec<String> = joints
        .map(|(name, q)| format!("{name} {}", significant(*q, 4)))
        .collect();
    let [x, y, z] = answer.tcp_mm;
    let mut lines = vec![
        format!(
            "{} at {}, TCP ({x:.1}, {y:.1}, {z:.1}) mm in {}",
            answer.robot,
            joints.join("  "),
            answer.base
        ),
        String::new(),
        format!(
            "{:>4}  {:>20}  {:>7}  {:<22}  {:>10}  {:>12}  {}",
            "mode", "frequency", "damping", "tool moves along", "modal mass", "stiffness", "deflects"
        ),
    ];
    lines.extend(
        answer
            .modes
            .iter()
            .enumerate()
            .map(|(index, mode)| row(index + 1, mode)),
    );
    lines.push(String::new());
    lines.extend(answer.modes.first().map(sentence));
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.push(format!("sources: armill robots {}", answer.robot));
    lines.join("\n")
}

/// A row of the table.
fn row(number: usize, mode: &ModeAnswer) -> String {
    let frequency = match mode.frequency_u_hz {
        Some(u) => format!(
            "{} Hz (u {})",
            significant(mode.frequency_hz, 4),
            significant(u, 2)
        ),
        None => format!("{} Hz", significant(mode.frequency_hz, 4)),
    };
    let direction = mode.direction.map_or_else(
        || "turns only".to_owned(),
        |[x, y, z]| format!("({x:.2}, {y:.2}, {z:.2})"),
    );
    let of = |value: Option<f64>, unit: &str| {
        value.map_or(String::new(), |value| format!("{} {unit}", significant(value, 3)))
    };
    format!(
        "{number:>4}  {frequency:>20}  {:>7.3}  {direction:<22}  {:>10}  {:>12}  {}",
        mode.damping_ratio,
        of(mode.modal_mass_along_kg, "kg"),
        of(mode.modal_stiffness_along_n_per_um, "N/um"),
        largest_shares(mode).join(", ")
    )
}

/// The lowest mode in words.
fn sentence(mode: &ModeAnswer) -> String {
    let shares = mode.shares.iter().max_by(|a, b| a.share.total_cmp(&b.share));
    let by = shares.map_or(String::new(), |largest| {
        format!("{:.0} % {}", 100.0 * largest.share, largest.contributor)
    });
    let moves = match mode.direction {
        None => "turns the tool about its tip".to_owned(),
        Some(direction) => {
            let along = ["x", "y", "z"]
                .into_iter()
                .zip(direction)
                .find(|(_, part)| part.abs() >= ALONG);
            let along = along.map_or_else(
                || {
                    let [x, y, z] = direction;
                    format!("({x:.2}, {y:.2}, {z:.2})")
                },
                |(axis, _)| axis.to_owned(),
            );
            format!("moves the tool along {along}")
        }
    };
    format!(
        "lowest mode {} Hz: {by}, {moves}",
        significant(mode.frequency_hz, 3)
    )
}

/// A direction whose component along an axis is at least this is called by the axis: within 18 degrees.
const ALONG: f64 = 0.95;

/// A number with at least this many significant digits, without an exponent.
fn significant(value: f64, digits: i32) -> String {
    let before_point = match value == 0.0 {
        true => 1,
        // unit: none, the number of digits before the point
        false => value.abs().log10().floor() as i32 + 1,
    };
    format!(
        "{value:.*}",
        usize::try_from(digits - before_point)
            .unwrap_or(0)
            .min(MOST_DECIMALS)
    )
}

/// More decimals are not shown.
const MOST_DECIMALS: usize = 9;

/// Contributors with five per cent or more, the largest first.
fn largest_shares(mode: &ModeAnswer) -> Vec<String> {
    let mut shares: Vec<_> = mode.shares.iter().filter(|part| part.share >= 0.05).collect();
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    shares
        .into_iter()
        .map(|part| format!("{} {:.0} %", part.contributor, 100.0 * part.share))
        .collect()
}
