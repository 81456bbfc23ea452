//! A program for KUKA controllers: one `.src` file, or a main file that calls the parts of a long program.
//!
//! Frame and tool are selected by their numbers, for the load and the pendant, and then set to the values for which the
//! program was made: the data stored on the controller under these numbers are not changed.

use std::fmt::Write;

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use super::aggregate::whole;
use crate::controller::Controller;
use crate::draft::{Blend, Draft, DraftPoint, DraftStep, FrameOn, Written, text_lines};
use crate::draft_check::{Bounds, DraftError, LEAST_ACCELERATION, LONGEST_DWELL, UnitNames, avoid};
use crate::number::fixed;
use crate::text::latin1;

/// `[recalled]` Longest name of a module; number of frames and tools of newer systems, older ones have 32 and 16.
const LONGEST_NAME: usize = 24;
const MOST_FRAMES: u32 = 128;
/// Maximum number of statements in a module: larger modules load slowly and are refused by older systems `[recalled]`.
const MOST_STEPS: usize = 5000;
/// Numbers of external kinematic systems: MACHINE_DEF[1] is the robot.
const MACHINES: std::ops::RangeInclusive<u32> = 2..=16;
/// E1 to E6.
const MOST_EXTERNAL: usize = 6;
/// The name of a part is that of the main program, an underscore and up to four digits.
const PART: usize = 5;
/// Decimals of axes, deg and mm; of a frame or tool, mm and deg; of speeds, m/s; of blends, mm.
const AXIS: usize = 5;
const FRAME: [usize; 2] = [4, 6];
const SPEED: usize = 6;
const BLEND: usize = 3;
/// Decimals of a dwell, s.
const DWELL: usize = 3;
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
    let is_split = draft.steps.len() > MOST_STEPS;
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
        external: MOST_EXTERNAL,
        units: Some(UnitNames {
            are: |unit| unit.parse().is_ok_and(|number: u32| MACHINES.contains(&number)),
            rule: "it is the number of its MACHINE_DEF, 2 to 16",
        }),
        holds_part: false,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    };
    draft.check(&bounds)?;
    avoid(&draft.name, &bounds, WORDS)?;
    let mut main = head(draft);
    let mut parts = Vec::new();
    let mut body = Body::new(draft);
    for (name, steps) in draft.parts(MOST_STEPS, "_") {
        let text = body.of(steps);
        if is_split {
            _ = write!(main, "{name}()\r\n");
            parts.push((
                format!("{name}.src"),
                latin1(&format!("&ACCESS RVP\r\n&REL 1\r\nDEF {name}()\r\n{text}END\r\n")),
            ));
        } else {
            main.push_str(&text);
        }
    }
    for line in &draft.controller.footer {
        _ = write!(main, "{line}\r\n");
    }
    main.push_str("END\r\n");
    parts.insert(0, (format!("{}.src", draft.name), latin1(&main)));
    Ok(Written {
        files: parts,
        notes: notes(draft),
    })
}

/// The start-up fold of the controller: it checks stops (interrupt 3) and sets the defaults of motion. Source: public
/// programs and posts, which also have `BAS(#VEL_PTP,n)` and `BAS(#ACC_PTP,n)` in per cent, `$ACC.CP` in m/s^2,
/// `$APO.CDIS` in mm with `C_DIS`, `WAIT SEC` and `HALT`.
const START: &str = ";FOLD INI\r\n;FOLD BASISTECH INI\r\n\
     GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )\r\nINTERRUPT ON 3\r\nBAS (#INITMOV,0 )\r\n\
     ;ENDFOLD (BASISTECH INI)\r\n;ENDFOLD (INI)\r\n$ADVANCE=3\r\n";

fn head(draft: &Draft) -> String {
    let (name, controller) = (&draft.name, &draft.controller);
    let mut out = format!("&ACCESS RVP\r\n&REL 1\r\nDEF {name}()\r\n");
    for line in draft.remark_lines() {
        _ = write!(out, "; {line}\r\n");
    }
    out.push_str(START);
    let (frame, tool) = (controller.frame_number, controller.tool_number);
    _ = write!(out, "BAS(#BASE,{frame})\r\nBAS(#TOOL,{tool})\r\n");
    if controller.sets_data() {
        _ = write!(
            out,
            "; base {frame} and tool {tool} as this program was made with them\r\n$BASE={}\r\n$TOOL={}\r\n",
            base(draft),
            set(&draft.flange_from_tool)
        );
    }
    _ = write!(
        out,
        "BAS(#VEL_PTP,{})\r\n",
        Controller::percent(controller.joint_speed)
    );
    if let Some(part) = controller.joint_acceleration {
        _ = write!(out, "BAS(#ACC_PTP,{})\r\n", Controller::percent(part));
    }
    if let Some(acceleration) = controller.acceleration {
        _ = write!(out, "$ACC.CP={}\r\n", fixed(acceleration, SPEED));
    }
    for line in &controller.header {
        _ = write!(out, "{line}\r\n");
    }
    out
}

/// The base; one on the table of a positioner moves with it: `EK` couples it to the external kinematic system.
fn base(draft: &Draft) -> String {
    let frame = set(&draft.base_from_frame);
    match draft.frame_on {
        FrameOn::Table => {
            let unit = unit(draft);
            format!("EK(MACHINE_DEF[{unit}].ROOT,MACHINE_DEF[{unit}].MECH_TYPE,{frame})")
        }
        FrameOn::Cell | FrameOn::Flange => frame,
    }
}

/// Number of the external kinematic system.
fn unit(draft: &Draft) -> &str {
    draft.controller.positioner_unit.as_deref().unwrap_or("2")
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

fn axes(draft: &Draft, point: &DraftPoint) -> String {
    let arm = point.joints.iter().zip(super::aggregate::AXES);
    let arm = arm.map(|(joint, name)| format!("{name} {}", fixed(to_deg(joint), AXIS)));
    let all: Vec<String> = arm.chain(external(draft, point)).collect();
    let kind = if point.external.is_empty() {
        "AXIS"
    } else {
        "E6AXIS"
    };
    format!("{{{kind}: {}}}", all.join(","))
}

/// E1 to E6, deg or mm.
fn external<'a>(draft: &'a Draft, point: &'a DraftPoint) -> impl Iterator<Item = String> + 'a {
    let axes = point.external.iter().zip(&draft.external_slides).enumerate();
    axes.map(|(index, (value, slides))| {
        let value = if *slides { to_mm(*value) } else { to_deg(value) };
        format!("E{} {}", index + 1, fixed(value, AXIS))
    })
}

/// Writes steps; remembers the last speed and blend.
struct Body<'a> {
    draft: &'a Draft,
    blends: std::vec::IntoIter<Blend>,
    speed: Option<String>,
    blend: Option<String>,
}

impl<'a> Body<'a> {
    fn new(draft: &'a Draft) -> Body<'a> {
        Body {
            draft,
            blends: draft.blends().into_iter(),
            speed: None,
            blend: None,
        }
    }

    fn of(&mut self, steps: &[DraftStep]) -> String {
        let mut out = String::new();
        for step in steps {
            _ = match step {
                DraftStep::Move(point) => {
                    self.take(point, &mut out);
                    Ok(())
                }
                DraftStep::Comment(text) => text_lines(text).try_for_each(|line| write!(out, "; {line}\r\n")),
                DraftStep::Stop(text) => text_lines(text)
                    .try_for_each(|line| write!(out, "; STOP: {line}\r\n"))
                    .and_then(|()| out.write_str("HALT\r\n")),
                DraftStep::Dwell(seconds) => write!(out, "WAIT SEC {}\r\n", fixed(*seconds, DWELL)),
                DraftStep::Statement(line) => write!(out, "{line}\r\n"),
            };
        }
        out
    }

    fn take(&mut self, point: &DraftPoint, out: &mut String) {
        let blend = self.blends.next().map_or(0.0, |blend| blend.distance);
        // A joint move is given in axes: its posture and its turns are unique.
        let Some(speed) = point.speed else {
            _ = write!(out, "PTP {}\r\n", axes(self.draft, point));
            return;
        };
        let mut pose = String::new();
        whole(&Convention::Kuka.numbers_of(&point.frame_from_tool), &mut pose);
        let external: String = external(self.draft, point)
            .map(|axis| format!(",{axis}"))
            .collect();
        pose.insert_str(pose.len() - 1, &external);
        let speed = fixed(speed, SPEED);
        if self.speed.as_ref() != Some(&speed) {
            _ = write!(out, "$VEL.CP={speed}\r\n");
            self.speed = Some(speed);
        }
        let blend = fixed(to_mm(blend), BLEND);
        let is_exact = !blend.bytes().any(|digit| matches!(digit, b'1'..=b'9'));
        if !is_exact && self.blend.as_ref() != Some(&blend) {
            _ = write!(out, "$APO.CDIS={blend}\r\n");
            self.blend = Some(blend);
        }
        _ = write!(out, "LIN {pose}{}\r\n", if is_exact { "" } else { " C_DIS" });
    }
}

fn notes(draft: &Draft) -> Vec<String> {
    let (frame, tool) = (draft.controller.frame_number, draft.controller.tool_number);
    let data = match draft.controller.sets_data() {
        true if draft.frame_on == FrameOn::Table => {
            let unit = unit(draft);
            format!(
                "$BASE is coupled to the external kinematic system of MACHINE_DEF[{unit}], whose frame at its table must be \
                 that of the robot file of the positioner: compare them, and the senses and zeros of its axes, before the \
                 first run"
            )
        }
        true => format!(
            "$BASE and $TOOL are set to the values of this program, relative to $ROBROOT; BASE_DATA[{frame}] and \
             TOOL_DATA[{tool}] of the controller are not changed: compare them"
        ),
        false => format!(
            "BASE_DATA[{frame}] must be {}{} and TOOL_DATA[{tool}] {} on the controller, for which this program was made",
            set(&draft.base_from_frame),
            match draft.frame_on {
                FrameOn::Table => " on the table of the positioner",
                FrameOn::Cell | FrameOn::Flange => "",
            },
            set(&draft.flange_from_tool)
        ),
    };
    let mut notes = vec![
        data,
        format!("the load is that of tool {tool} on the controller: check it"),
        "the first move goes to its axis positions from the robot's current posture: check for collisions"
            .to_owned(),
    ];
    if !draft.external_slides.is_empty() {
        notes.push(
            "E1 and further axes are the external axes from the ground on, those that carry the robot before those of the \
             positioner: check their order and zero"
                .to_owned(),
        );
    }
    notes
}
