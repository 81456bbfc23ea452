//! A program for Universal Robots controllers: one `.script` file of any length.
//!
//! Targets are relative to a frame defined in the program, `pose_trans(frame, p[...])`. The controllers have no numbers
//! for frames and tools, so these appear only in remarks.

use std::fmt::Write;

use super::spell::whole;
use crate::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::number::fixed;

/// Range of the numbers of frames and tools, which appear only in remarks.
const MOST_FRAMES: u32 = 999;
/// Decimals of joints, rad, of speeds, m/s, and of blends, m.
const JOINT: usize = 6;
const SPEED: usize = 6;
const BLEND: usize = 6;
/// Parameters of moves, below the defaults in the manufacturer's manual `[recalled]`: m/s^2, rad/s^2, rad/s.
const ACCELERATION: &str = "a=1.2";
const JOINT_PACE: &str = "a=1.4, v=0.5";
/// A blend radius is less than half of the distance to either neighbour: controllers refuse overlapping blends.
const PART_OF_WAY: f64 = 0.45;
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
        "  # frame {} and tool {} for which this program was made",
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
            // The first move is given in joints: its posture is unique.
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
            "this program sets the tool but not its load: check the payload of the installation".to_owned(),
            "the first move goes to its joint positions from the robot's current posture: check for \
             collisions".to_owned(),
            "blends are limited to 0.45 of the distance to the next point, because controllers refuse larger \
             ones".to_owned(),
        ],
    })
}

/// The blend of a point; none for an exact stop, at the ends, and if neighbours are too close.
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
