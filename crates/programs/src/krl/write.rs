//! A program for KUKA controllers: one `.src` file, or a main file that calls the parts of a long program.
//!
//! Frame and tool are selected by their numbers, for the load and the pendant, and then set to the values for which the
//! program was made: the data stored on the controller under these numbers are not changed.

use std::fmt::Write;

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use super::aggregate::whole;
use crate::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::text::latin1;

/// `[recalled]` Longest name of a module; number of frames and tools of newer systems, older ones have 32 and 16.
const LONGEST_NAME: usize = 24;
const MOST_FRAMES: u32 = 128;
/// Maximum number of moves in a module: larger modules load slowly and are refused by older systems `[recalled]`.
const MOST_MOVES: usize = 5000;
/// The name of a part is that of the main program, an underscore and up to four digits.
const PART: usize = 5;
/// Decimals of axes, deg; of a frame or tool, mm and deg; of speeds, m/s; of blends, mm.
const AXIS: usize = 5;
const FRAME: [usize; 2] = [4, 6];
const SPEED: usize = 6;
const BLEND: usize = 3;
/// Reserved words `[recalled]`.
const WORDS: &[&str] = &[
    "AND",
    "ANIN",
    "ANOUT",
    "B_AND",
    "BAS",
    "BOOL",
    "BRAKE",
    "CASE",
    "CHANNEL",
    "CHAR",
    "CIRC",
    "CIRC_REL",
    "CONFIRM",
    "CONST",
    "CONTINUE",
    "DECL",
    "DEF",
    "DEFAULT",
    "DEFDAT",
    "DEFFCT",
    "DIGIN",
    "DO",
    "ELSE",
    "END",
    "ENDDAT",
    "ENDFCT",
    "ENDFOR",
    "ENDIF",
    "ENDLOOP",
    "ENDSWITCH",
    "ENDWHILE",
    "ENUM",
    "EXIT",
    "EXT",
    "FALSE",
    "FOR",
    "FRAME",
    "GLOBAL",
    "GOTO",
    "HALT",
    "IF",
    "IMPORT",
    "INT",
    "INTERRUPT",
    "LIN",
    "LIN_REL",
    "LOOP",
    "NOT",
    "OR",
    "POS",
    "PTP",
    "PTP_REL",
    "PULSE",
    "REAL",
    "REPEAT",
    "RESUME",
    "RETURN",
    "SIGNAL",
    "SPLINE",
    "STRUC",
    "SWITCH",
    "THEN",
    "TO",
    "TRIGGER",
    "TRUE",
    "UNTIL",
    "WAIT",
    "WHILE",
];

/// Writes a program.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let is_split = draft.points.len() > MOST_MOVES;
    let bounds = Bounds {
        language: "KUKA KRL",
        longest_name: LONGEST_NAME - if is_split { PART } else { 0 },
        names: match is_split {
            true => {
                "letters, digits and underscores, at most 19 because it is written in parts, and not a reserved word"
            }
            false => {
                "a letter, then letters, digits and underscores, at most 24 characters, and not a reserved word"
            }
        },
        joints: 6..=6,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
    };
    draft.check(&bounds)?;
    draft.avoid(&bounds, WORDS)?;
    let mut main = head(draft);
    let mut parts = Vec::new();
    let mut modal = Modal::default();
    for (name, points) in draft.parts(MOST_MOVES, "_") {
        let mut body = String::new();
        for point in points {
            match draft.is_first(point) {
                // The first move is given in axes: its posture is unique.
                true => _ = write!(main, "PTP {}\r\n", axes(&point.joints)),
                false => modal.take(point, draft.blend(point), &mut body),
            }
        }
        if is_split {
            _ = write!(main, "{name}()\r\n");
            parts.push((
                format!("{name}.src"),
                latin1(&format!("&ACCESS RVP\r\n&REL 1\r\nDEF {name}()\r\n{body}END\r\n")),
            ));
        } else {
            main.push_str(&body);
        }
    }
    main.push_str("END\r\n");
    parts.insert(0, (format!("{}.src", draft.name), latin1(&main)));
    Ok(Written {
        files: parts,
        notes: notes(draft),
    })
}

fn head(draft: &Draft) -> String {
    let name = &draft.name;
    let mut out = format!("&ACCESS RVP\r\n&REL 1\r\nDEF {name}()\r\n");
    for line in draft.remark_lines() {
        _ = write!(out, "; {line}\r\n");
    }
    let (frame, tool) = (draft.frame_number, draft.tool_number);
    _ = write!(
        out,
        ";FOLD INI\r\nBAS(#INITMOV,0)\r\n;ENDFOLD (INI)\r\n$ADVANCE=3\r\n\
         BAS(#BASE,{frame})\r\nBAS(#TOOL,{tool})\r\n\
         ; base {frame} and tool {tool} as this program was made with them\r\n\
         $BASE={}\r\n$TOOL={}\r\n",
        set(&draft.base_from_frame),
        set(&draft.flange_from_tool)
    );
    out
}

/// A frame or a tool.
fn set(pose: &Isometry) -> String {
    let numbers: Vec<String> = Convention::Kuka
        .numbers_of(pose)
        .iter()
        .zip(super::aggregate::POSE)
        .enumerate()
        .map(|(index, (number, name))| format!("{name} {}", fixed(*number, FRAME[index / 3])))
        .collect();
    format!("{{FRAME: {}}}", numbers.join(","))
}

fn axes(joints: &[f64]) -> String {
    let axes: Vec<String> = joints
        .iter()
        .zip(super::aggregate::AXES)
        .map(|(joint, name)| format!("{name} {}", fixed(to_deg(joint), AXIS)))
        .collect();
    format!("{{AXIS: {}}}", axes.join(","))
}

/// Last written speed and blend.
#[derive(Default)]
struct Modal {
    speed: Option<String>,
    blend: Option<String>,
}

impl Modal {
    fn take(&mut self, point: &DraftPoint, blend: f64, out: &mut String) {
        let mut pose = String::new();
        whole(&Convention::Kuka.numbers_of(&point.frame_from_tool), &mut pose);
        let Some(speed) = point.speed else {
            let posture = point.branch.map_or(String::new(), |branch| {
                let (status, turn) = (status(Configuration::of(branch)), turn(&point.joints));
                format!(",S {status},T {turn}")
            });
            pose.insert_str(pose.len() - 1, &posture);
            _ = write!(out, "PTP {pose}\r\n");
            return;
        };
        let speed = fixed(speed, SPEED);
        if self.speed.as_ref() != Some(&speed) {
            _ = write!(out, "$VEL.CP={speed}\r\n");
            self.speed = Some(speed);
        }
        let mut approximated = "";
        if blend > 0.0 {
            let blend = fixed(to_mm(blend), BLEND);
            if self.blend.as_ref() != Some(&blend) {
                _ = write!(out, "$APO.CDIS={blend}\r\n");
                self.blend = Some(blend);
            }
            approximated = " C_DIS";
        }
        _ = write!(out, "LIN {pose}{approximated}\r\n");
    }
}

/// S: bit 0 rear, bit 1 not lower, bit 2 flip.
fn status(configuration: Configuration) -> u32 {
    u32::from(configuration.rear == Some(true))
        + 2 * u32::from(configuration.lower == Some(false))
        + 4 * u32::from(configuration.flip == Some(true))
}

/// T: bit i where axis i + 1 is below zero.
fn turn(joints: &[f64]) -> u32 {
    joints
        .iter()
        .enumerate()
        .map(|(axis, joint)| u32::from(*joint < 0.0) << axis)
        .sum()
}

fn notes(draft: &Draft) -> Vec<String> {
    let (frame, tool) = (draft.frame_number, draft.tool_number);
    let mut notes = vec![
        format!(
            "$BASE and $TOOL are set to the values of this program, relative to $ROBROOT; BASE_DATA[{frame}] and \
             TOOL_DATA[{tool}] of the controller are not changed: compare them"
        ),
        format!("the load is that of tool {tool} on the controller: check it"),
        "the first move goes to its axis positions from the robot's current posture: check for collisions"
            .to_owned(),
    ];
    let unsaid = draft
        .points
        .iter()
        .skip(1)
        .any(|point| point.speed.is_none() && point.branch.is_none());
    if unsaid {
        notes.push(
            "joint moves are written without S and T, because the postures of this arm have no names"
                .to_owned(),
        );
    }
    notes
}

#[cfg(test)]
mod tests {
    use armill_core::robot::Branch;

    use super::*;

    #[test]
    fn status_and_turn_are_those_of_the_sample() {
        // Siemens_Sinumerik.mpf of the six languages gives STAT=2 TU=57 for these axes, deg; 57 is T with its six bits
        // the other way round.
        let joints = [-46.18419, -6.77518, -20.54925, 71.38674, 49.58727, -302.54752].map(f64::to_radians);
        assert_eq!(turn(&joints), 0b10_0111);
        assert_eq!(turn(&joints).reverse_bits() >> 26, 57);
        assert_eq!(status(Configuration::of(Branch::ALL[0])), 2);
    }

    #[test]
    fn every_posture_has_its_own_status() {
        let mut all: Vec<u32> = Branch::ALL
            .iter()
            .map(|branch| status(Configuration::of(*branch)))
            .collect();
        all.sort_unstable();
        assert_eq!(all, (0..8).collect::<Vec<_>>());
    }
}
