//! A draft as a listing: frame and tool are set through a register, joint moves are given in joints; long programs are
//! split.

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use super::position::KEYS;
use crate::controller::Controller;
use crate::draft::{Blend, Draft, DraftPoint, DraftStep, Written, points};
use crate::draft_check::{Bounds, DraftError, LEAST_ACCELERATION};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::in_pieces;

/// Maximum number of statements in one program. `[recalled]`
const MOST_STEPS: usize = 5000;

/// Largest number of extended axes of the group of the arm. `[recalled]` Source of their spelling, `E1=   0.000  mm`: the
/// RoboDK post.
const MOST_EXTERNAL: usize = 3;

/// Maximum length of a remark, of a message, and of the comment in the header. `[recalled]` Source of `MESSAGE[..]` and
/// `PAUSE`: the RoboDK post.
const LONGEST_REMARK: usize = 30;
const LONGEST_MESSAGE: usize = 24;
const LONGEST_COMMENT: usize = 16;

/// Maximum length of a name: 8 on old controllers, 36 since R-30iA; three characters number the parts of a long
/// program. `[recalled]`
const LONGEST_NAME: [usize; 3] = [8, 36, 33];

/// The register through which frame and tool are set.
const REGISTER: u32 = 9;

/// Decimals of a dwell, and the longest one, s. Source: public listings have `WAIT    .50(sec)`; range `[recalled]`.
const DWELL: usize = 2;
const LONGEST_DWELL: f64 = 327.67;

/// Maximum tip speed, mm/s. Source: FANUC's manual of options.
const FASTEST: f64 = 2000.0;

const END: &str = "\r\n";

/// Writes `draft` as one listing, or as several listings called by a main one.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let split = draft.steps.len() > MOST_STEPS;
    let bounds = Bounds {
        language: "FANUC TP",
        longest_name: if split { LONGEST_NAME[2] } else { LONGEST_NAME[1] },
        names: "a letter, then letters, digits and underscores, at most 36 characters; 33 if the program is split \
            into several parts",
        external: MOST_EXTERNAL,
        units: None,
        holds_part: false,
        frames: 1..=9,
        tools: 1..=10,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    };
    draft.check(&bounds)?;
    let is_single = |line: &str| !trimmed(line).contains(';');
    draft.check_statements(
        &bounds,
        is_single,
        "`;` ends a statement: write the rest as another statement",
    )?;
    draft.check_speeds(|speed| feed(speed).is_some())?;
    let parts: Vec<(String, &[DraftStep])> = draft.parts(MOST_STEPS, "").collect();
    let footer = || draft.controller.footer.iter().map(|line| statement(line));
    let mut files = Vec::new();
    if split {
        let calls = parts.iter().map(|(part, _)| format!("  CALL {part} ;"));
        let lines: Vec<String> = head(draft).into_iter().chain(calls).chain(footer()).collect();
        files.push(listing(draft, &draft.name, &lines, ""));
    }
    let blends = draft.blends();
    let mut ahead = blends.iter();
    for (name, steps) in &parts {
        let mut lines = if split { chosen(draft) } else { head(draft) };
        lines.extend(body(draft, steps, &mut ahead));
        if !split {
            lines.extend(footer());
        }
        files.push(listing(draft, name, &lines, &positions(draft, steps)));
    }
    Ok(Written {
        files,
        notes: notes(draft, split, &blends),
    })
}

/// A statement of the cell, in a line of a listing.
fn statement(line: &str) -> String {
    format!("  {} ;", trimmed(line))
}

/// A statement without the semicolon at its end.
fn trimmed(line: &str) -> &str {
    let line = line.trim();
    line.strip_suffix(';').unwrap_or(line).trim_end()
}

fn notes(draft: &Draft, split: bool, blends: &[Blend]) -> Vec<String> {
    let (frame, tool) = (draft.controller.frame_number, draft.controller.tool_number);
    let data = match draft.controller.sets_data() {
        true => format!(
            "the program sets user frame {frame} and tool {tool} through PR[{REGISTER}] and overwrites them: make sure \
             that they are not used elsewhere"
        ),
        false => format!(
            "UFRAME[{frame}] must be {} and UTOOL[{tool}] {} on the controller, for which this program was made",
            numbers(&draft.base_from_frame),
            numbers(&draft.flange_from_tool)
        ),
    };
    let mut notes = vec![
        data,
        "joint moves are given in joints as this arm's controller reports them (FANUC measures axis 3 from the \
         horizontal): test them at low speed"
            .to_owned(),
        "CONFIG has the turns of axes 1, 4 and 6; check that the controller uses the same axes".to_owned(),
        "to load listings (.LS) the controller needs the ASCII upload option".to_owned(),
    ];
    if blends.iter().any(|blend| blend.is_full) {
        notes.push(
            "moves between which the path hardly turns have CNT100, corners CNT0: how far CNT rounds a corner depends \
             on the speed"
                .to_owned(),
        );
    }
    if draft.points().any(|point| point.branch.is_none()) {
        notes.push("where no posture is given, CONFIG says no flip, up, front".to_owned());
    }
    if draft
        .points()
        .any(|point| point.speed.is_some_and(|speed| to_mm(speed) > FASTEST))
    {
        notes.push(format!("speeds above {FASTEST} mm/s are refused by controllers"));
    }
    if draft.controller.acceleration.is_some() {
        notes.push(
            "TP has no acceleration in m/s^2: it is not written; ACC after a move is a percentage of the maximum"
                .to_owned(),
        );
    }
    if draft.name.len() + if split { 3 } else { 0 } > LONGEST_NAME[0] {
        notes.push("old controllers allow names of at most 8 characters".to_owned());
    }
    notes
}

/// A pose in the convention of the controller.
fn numbers(pose: &Isometry) -> String {
    let all: Vec<String> = Convention::Fanuc
        .numbers_of(pose)
        .iter()
        .map(|value| fixed(*value, super::DECIMALS))
        .collect();
    format!("({})", all.join(", "))
}

/// Remarks, the values of frame and tool, and their selection.
fn head(draft: &Draft) -> Vec<String> {
    let mut lines = Vec::new();
    for remark in &draft.remarks {
        for piece in in_pieces(&remark.replace(';', ","), LONGEST_REMARK) {
            lines.push(format!("  !{piece} ;"));
        }
    }
    let mut set = |what: &str, number: u32, pose: &Isometry| {
        for (element, value) in (1..).zip(Convention::Fanuc.numbers_of(pose)) {
            let said = fixed(value, super::DECIMALS);
            let said = if said.starts_with('-') {
                format!("({said})")
            } else {
                said
            };
            lines.push(format!("  PR[{REGISTER},{element}]={said} ;"));
        }
        lines.push(format!("  {what}[{number}]=PR[{REGISTER}] ;"));
    };
    if draft.controller.sets_data() {
        set("UFRAME", draft.controller.frame_number, &draft.base_from_frame);
        set("UTOOL", draft.controller.tool_number, &draft.flange_from_tool);
    }
    lines.extend(chosen(draft));
    lines.extend(draft.controller.header.iter().map(|line| statement(line)));
    lines
}

fn chosen(draft: &Draft) -> Vec<String> {
    vec![
        format!("  UFRAME_NUM={} ;", draft.controller.frame_number),
        format!("  UTOOL_NUM={} ;", draft.controller.tool_number),
    ]
}

fn body(draft: &Draft, steps: &[DraftStep], blends: &mut std::slice::Iter<'_, Blend>) -> Vec<String> {
    let mut lines = Vec::new();
    let mut position = 0;
    for step in steps {
        match step {
            DraftStep::Move(point) => {
                position += 1;
                lines.push(line(draft, point, position, blends.next()));
            }
            DraftStep::Comment(text) => {
                lines.extend(remarks(text, LONGEST_REMARK, |piece| format!("  !{piece} ;")));
            }
            DraftStep::Stop(text) => {
                let text = text.replace(['[', ']'], " ");
                lines.extend(remarks(&text, LONGEST_MESSAGE, |piece| {
                    format!("  MESSAGE[{piece}] ;")
                }));
                lines.push("  PAUSE ;".to_owned());
            }
            DraftStep::Dwell(seconds) => {
                // Less than a hundredth of a second is not written as none.
                let seconds = seconds.max(0.01);
                lines.push(format!("  WAIT {}(sec) ;", fixed(seconds, DWELL)));
            }
            DraftStep::Statement(text) => lines.push(statement(text)),
        }
    }
    lines
}

/// A text in pieces of at most this length, each as a line.
fn remarks(text: &str, longest: usize, line: impl Fn(String) -> String) -> Vec<String> {
    in_pieces(&text.replace(';', ","), longest)
        .into_iter()
        .map(line)
        .collect()
}

fn line(draft: &Draft, point: &DraftPoint, position: usize, blend: Option<&Blend>) -> String {
    let end = match blend {
        Some(blend) if blend.is_full => "CNT100",
        Some(blend) if blend.distance > 0.0 => "CNT0",
        _ => "FINE",
    };
    match point.speed.and_then(feed) {
        Some(speed) => format!("L P[{position}] {speed} {end} ;"),
        None => {
            let controller = &draft.controller;
            let acceleration = controller
                .joint_acceleration
                .map_or_else(String::new, |part| format!(" ACC{}", Controller::percent(part)));
            let speed = Controller::percent(controller.joint_speed);
            format!("J P[{position}] {speed}% {end}{acceleration} ;")
        }
    }
}

/// A speed in m/s as controllers write it: a whole number in the coarser unit that fits; `None` if it is too slow.
fn feed(speed: f64) -> Option<String> {
    let mm_per_second = to_mm(speed);
    let cm_per_minute = (mm_per_second * 6.0).round();
    if (mm_per_second - mm_per_second.round()).abs() < 1e-6 && mm_per_second >= 0.5 {
        return Some(format!("{}mm/sec", fixed(mm_per_second, 0)));
    }
    (cm_per_minute >= 1.0).then(|| format!("{}cm/min", fixed(cm_per_minute, 0)))
}

fn positions(draft: &Draft, steps: &[DraftStep]) -> String {
    let mut out = String::new();
    let controller = &draft.controller;
    let numbers = format!(
        "\tUF : {}, UT : {},",
        controller.frame_number, controller.tool_number
    );
    for (at, point) in points(steps).enumerate() {
        out.push_str(&format!("P[{}]{{{END}   GP1:{END}", at + 1));
        let external = point.external.iter().zip(&draft.external_slides);
        let external = (1..).zip(external).map(|(axis, (value, slides))| match slides {
            true => format!("E{axis}= {:>9}  mm", fixed(to_mm(*value), super::DECIMALS)),
            false => format!("E{axis}= {:>9} deg", fixed(to_deg(value), super::DECIMALS)),
        });
        let (head, fields): (String, Vec<String>) = match point.speed {
            // A joint move is given in joints: its posture and its turns are unique.
            None => (
                format!("{numbers}\t"),
                (1..)
                    .zip(&point.joints)
                    .map(|(axis, value)| format!("J{axis}= {:>9} deg", fixed(to_deg(value), super::DECIMALS)))
                    .collect(),
            ),
            Some(_) => (
                format!("{numbers}\t\tCONFIG : '{}',", configuration(point)),
                KEYS.iter()
                    .zip(Convention::Fanuc.numbers_of(&point.frame_from_tool))
                    .enumerate()
                    .map(|(index, (key, value))| {
                        let unit = if index < 3 { " mm" } else { "deg" };
                        format!("{key} = {:>9} {unit}", fixed(value, super::DECIMALS))
                    })
                    .collect(),
            ),
        };
        let fields: Vec<String> = fields.into_iter().chain(external).collect();
        let rows: Vec<String> = fields
            .chunks(3)
            .map(|row| format!("\t{}", row.join(",\t")))
            .collect();
        out.push_str(&format!(
            "{head}{END}{}{END}}};{END}",
            rows.join(&format!(",{END}"))
        ));
    }
    out
}

/// Configuration: flip, elbow, shoulder, then the turns of axes 1, 4, 6.
fn configuration(point: &DraftPoint) -> String {
    let said = point.branch.map(Configuration::of).unwrap_or_default();
    let letter = |set: Option<bool>, [not, yes]: [char; 2]| if set == Some(true) { yes } else { not };
    let turn = |joint: usize| {
        let deg = to_deg(point.joints.get(joint).copied().unwrap_or(0.0));
        let turns = ((deg.abs() + 180.0) / 360.0).floor();
        fixed(turns.copysign(deg), 0)
    };
    format!(
        "{} {} {}, {}, {}, {}",
        letter(said.flip, ['N', 'F']),
        letter(said.lower, ['U', 'D']),
        letter(said.rear, ['T', 'B']),
        turn(0),
        turn(3),
        turn(5)
    )
}

/// A listing with these lines and positions.
fn listing(draft: &Draft, name: &str, lines: &[String], positions: &str) -> (String, Vec<u8>) {
    let comment = in_pieces(draft.remarks.first().map_or("", String::as_str), LONGEST_COMMENT);
    let comment = comment
        .first()
        .map_or("", String::as_str)
        .replace('"', "'")
        .replace(';', ",");
    // No time stamp: the same draft gives the same bytes.
    let date = "DATE 00-01-01  TIME 00:00:00";
    let count = lines.len();
    let head = [
        format!("/PROG  {name}"),
        "/ATTR".to_owned(),
        "OWNER\t\t= MNEDITOR;".to_owned(),
        format!("COMMENT\t\t= \"{comment}\";"),
        "PROG_SIZE\t= 0;".to_owned(),
        format!("CREATE\t\t= {date};"),
        format!("MODIFIED\t= {date};"),
        "FILE_NAME\t= ;".to_owned(),
        "VERSION\t\t= 0;".to_owned(),
        format!("LINE_COUNT\t= {count};"),
        "MEMORY_SIZE\t= 0;".to_owned(),
        "PROTECT\t\t= READ_WRITE;".to_owned(),
        "TCD:  STACK_SIZE\t= 0,".to_owned(),
        "      TASK_PRIORITY\t= 50,".to_owned(),
        "      TIME_SLICE\t= 0,".to_owned(),
        "      BUSY_LAMP_OFF\t= 0,".to_owned(),
        "      ABORT_REQUEST\t= 0,".to_owned(),
        "      PAUSE_REQUEST\t= 0;".to_owned(),
        "DEFAULT_GROUP\t= 1,*,*,*,*;".to_owned(),
        "CONTROL_CODE\t= 00000000 00000000;".to_owned(),
        "/MN".to_owned(),
    ];
    let mut out = String::new();
    let numbered = (1..)
        .zip(lines)
        .map(|(number, line)| format!("{number:>4}:{line}"));
    for line in head.into_iter().chain(numbered) {
        out.push_str(&line);
        out.push_str(END);
    }
    out.push_str(&format!("/POS{END}{positions}/END{END}"));
    (format!("{name}.LS"), out.into_bytes())
}
