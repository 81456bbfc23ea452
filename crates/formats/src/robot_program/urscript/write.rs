//! A program for controllers of Universal Robots: one `.script`, whatever its length.
//!
//! Targets are told in a frame of the program itself, `pose_trans(frame, p[...])`; controllers have no numbers of frames
//! and tools, so the remarks alone tell these.

use std::fmt::Write;

use super::spell::whole;
use crate::robot_program::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::robot_program::number::fixed;

/// Numbers of frames and tools, which remarks alone tell.
const MOST_FRAMES: u32 = 999;
/// Decimals of joints, rad, of speeds, m/s, and of blends, m.
const JOINT: usize = 6;
const SPEED: usize = 6;
const BLEND: usize = 6;
/// What moves take beside their targets, below what the maker's manual takes when nothing is told `[recalled]`: m/s^2,
/// rad/s^2, rad/s.
const ACCELERATION: &str = "a=1.2";
const JOINT_PACE: &str = "a=1.4, v=0.5";
/// A blend takes less than half of the way to either neighbour: controllers refuse circles that overlap.
const PART_OF_WAY: f64 = 0.45;
/// Words of the language.
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
/// What the language or its controllers cannot hold.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let bounds = Bounds {
        language: "URScript",
        longest_name: 64,
        names: "a letter, then letters, digits and underscores, at most 64 in all, and no word of the language",
        joints: 6..=6,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
    };
    draft.check(&bounds)?;
    draft.avoid(&bounds, WORDS)?;
    let name = &draft.name;
    let mut out = format!("def {name}():\n");
    for line in draft.remark_lines() {
        _ = writeln!(out, "  # {line}");
    }
    _ = writeln!(
        out,
        "  # frame {} and tool {} as this program was made with them",
        draft.frame_number, draft.tool_number
    );
    out.push_str("  armill_frame = ");
    whole(&draft.base_from_frame, &mut out);
    out.push_str("\n  set_tcp(");
    whole(&draft.flange_from_tool, &mut out);
    out.push_str(")\n");
    for (index, point) in draft.points.iter().enumerate() {
        let mut pose = "pose_trans(armill_frame, ".to_owned();
        whole(&point.frame_from_tool, &mut pose);
        pose.push(')');
        let joints: Vec<String> = point.joints.iter().map(|joint| fixed(*joint, JOINT)).collect();
        let joints = joints.join(", ");
        _ = match point.speed {
            // The first by joints: no posture is left to choose.
            _ if index == 0 => writeln!(out, "  movej([{joints}], {JOINT_PACE})"),
            None => writeln!(out, "  movej(get_inverse_kin({pose}, [{joints}]), {JOINT_PACE})"),
            Some(speed) => {
                let (speed, blend) = (fixed(speed, SPEED), blend(&draft.points, index));
                writeln!(out, "  movel({pose}, {ACCELERATION}, v={speed}{blend})")
            }
        };
    }
    _ = write!(out, "end\n{name}()\n");
    Ok(Written {
        files: vec![(format!("{name}.script"), out.into_bytes())],
        notes: vec![
            "the tool is set by this program, its load is not: check the payload of the installation".to_owned(),
            "the first move goes to its joints from wherever the robot stands: mind what is in between".to_owned(),
            "blends are written no larger than 0.45 of the way to the next point, for controllers refuse more".to_owned(),
        ],
    })
}

/// The blend of a point; none where it stops, at the ends, and where neighbours are too near.
fn blend(points: &[DraftPoint], index: usize) -> String {
    let place = |index: usize| {
        points
            .get(index)
            .map(|point| point.frame_from_tool.translation.vector)
    };
    let (Some(before), Some(here), Some(next)) =
        (place(index.wrapping_sub(1)), place(index), place(index + 1))
    else {
        return String::new();
    };
    let nearest = (here - before).norm().min((next - here).norm());
    let blend = fixed(points[index].blend.min(PART_OF_WAY * nearest), BLEND);
    match blend.bytes().any(|byte| matches!(byte, b'1'..=b'9')) {
        true => format!(", r={blend}"),
        false => String::new(),
    }
}
