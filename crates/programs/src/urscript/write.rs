//! A program for Universal Robots controllers: one `.script` file of any length.
//!
//! Targets are relative to a frame defined in the program, `pose_trans(frame, p[...])`. The controllers have no numbers
//! for frames and tools, so these appear only in remarks.

use std::fmt::Write;

use super::spell::whole;
use crate::draft::{Draft, DraftStep, Written, text_lines};
use crate::draft_check::{Bounds, DraftError, LEAST_ACCELERATION, LONGEST_DWELL, avoid};
use crate::number::fixed;
use crate::spelling::in_quoted_pieces;

/// Range of the numbers of frames and tools, which appear only in remarks.
const MOST_FRAMES: u32 = 999;
/// Decimals of joints, rad, of speeds, m/s, and of blends, m.
const JOINT: usize = 6;
const SPEED: usize = 6;
const BLEND: usize = 6;
/// Decimals of dwells, s.
const DWELL: usize = 3;
/// Acceleration of linear moves, m/s^2, unless the cell gives one. Source: the default of `movel` in public references.
const ACCELERATION: f64 = 1.2;
/// Greatest speed, rad/s, of the slowest joints of these arms, and the greatest acceleration of joint moves that is
/// written, rad/s^2 `[recalled]`.
const JOINT_SPEED: f64 = 2.09;
const JOINT_ACCELERATION: f64 = 14.0;
/// Joint acceleration relative to the maximum, unless the cell gives one: 1.4 rad/s^2. Source: the default of `movej` in
/// public references.
const JOINT_ACCELERATION_PART: f64 = 0.1;
/// Longest text of a message. Source of `popup(s, title, warning, error, blocking)`: the RoboDK posts.
const LONGEST_TEXT: usize = 120;
/// Reserved words.
const WORDS: &[&str] = &[
    "and",
    "break",
    "continue",
    "def",
    "elif",
    "else",
    "end",
    "enter_critical",
    "exit_critical",
    "False",
    "for",
    "global",
    "halt",
    "if",
    "join",
    "kill",
    "local",
    "movec",
    "movej",
    "movel",
    "movep",
    "not",
    "or",
    "p",
    "return",
    "run",
    "sec",
    "sleep",
    "sync",
    "thread",
    "True",
    "while",
    "xor",
];

/// Writes a program.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let bounds = Bounds {
        language: "URScript",
        longest_name: 64,
        names: "a letter, then letters, digits and underscores, at most 64 characters, and not a reserved word",
        external: 0,
        units: None,
        holds_part: false,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    };
    draft.check(&bounds)?;
    avoid(&draft.name, &bounds, WORDS)?;
    let controller = &draft.controller;
    let is_named = controller.frame_name.is_some();
    if !controller.sets_data() && !is_named {
        return Err(DraftError::Data {
            language: "URScript",
            reason: "frames have no numbers: give the name of the feature in the installation (frame_name)",
        });
    }
    let name = &draft.name;
    let mut out = format!("def {name}():\n");
    for line in draft.remark_lines() {
        _ = writeln!(out, "  # {line}");
    }
    _ = writeln!(
        out,
        "  # frame {} and tool {} for which this program was made",
        controller.frame_number, controller.tool_number
    );
    let frame = match &controller.frame_name {
        Some(name) if !controller.sets_data() => name.as_str(),
        _ => {
            out.push_str("  armill_frame = ");
            whole(&draft.base_from_frame, &mut out);
            out.push('\n');
            "armill_frame"
        }
    };
    if controller.sets_data() {
        out.push_str("  set_tcp(");
        whole(&draft.flange_from_tool, &mut out);
        out.push_str(")\n");
    }
    controller
        .header
        .iter()
        .for_each(|line| _ = writeln!(out, "  {line}"));
    out.push_str(&body(draft, frame));
    controller
        .footer
        .iter()
        .for_each(|line| _ = writeln!(out, "  {line}"));
    _ = write!(out, "end\n{name}()\n");
    Ok(Written {
        files: vec![(format!("{name}.script"), out.into_bytes())],
        notes: vec![
            match controller.sets_data() {
                true => "this program sets the tool but not its load: check the payload of the installation".to_owned(),
                false => {
                    let (mut tool, mut frame) = (String::new(), String::new());
                    whole(&draft.flange_from_tool, &mut tool);
                    whole(&draft.base_from_frame, &mut frame);
                    format!(
                        "the TCP of the installation must be {tool} and the feature {frame}, for which this program \
                         was made"
                    )
                }
            },
            "the first move goes to its joint positions from the robot's current posture: check for \
             collisions".to_owned(),
            "blends are limited to 0.45 of the distance to the next point, because controllers refuse larger \
             ones".to_owned(),
        ],
    })
}

/// The statements of the moves, and between them.
fn body(draft: &Draft, frame: &str) -> String {
    let controller = &draft.controller;
    let acceleration = fixed(controller.acceleration.unwrap_or(ACCELERATION), SPEED);
    let joint_pace = format!(
        "a={}, v={}",
        fixed(
            controller.joint_acceleration.unwrap_or(JOINT_ACCELERATION_PART) * JOINT_ACCELERATION,
            SPEED
        ),
        fixed(controller.joint_speed * JOINT_SPEED, SPEED)
    );
    let mut out = String::new();
    let mut blends = draft.blends().into_iter();
    for step in &draft.steps {
        _ = match step {
            DraftStep::Move(point) => {
                let blend = fixed(blends.next().map_or(0.0, |blend| blend.distance), BLEND);
                let is_exact = !blend.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
                let blend = if is_exact {
                    String::new()
                } else {
                    format!(", r={blend}")
                };
                match point.speed {
                    // A joint move is given in joints: its posture and its turns are unique.
                    None => {
                        let joints: Vec<String> =
                            point.joints.iter().map(|joint| fixed(*joint, JOINT)).collect();
                        writeln!(out, "  movej([{}], {joint_pace}{blend})", joints.join(", "))
                    }
                    Some(speed) => {
                        let mut pose = format!("pose_trans({frame}, ");
                        whole(&point.frame_from_tool, &mut pose);
                        let speed = fixed(speed, SPEED);
                        writeln!(out, "  movel({pose}), a={acceleration}, v={speed}{blend})")
                    }
                }
            }
            DraftStep::Comment(text) => text_lines(text).try_for_each(|line| writeln!(out, "  # {line}")),
            DraftStep::Stop(text) => {
                let text = in_quoted_pieces(text, LONGEST_TEXT).join(" ");
                writeln!(
                    out,
                    "  popup(\"{text}\", \"armill\", False, False, blocking=True)"
                )
            }
            DraftStep::Dwell(seconds) => writeln!(out, "  sleep({})", fixed(*seconds, DWELL)),
            DraftStep::Statement(line) => writeln!(out, "  {line}"),
        };
    }
    out
}
