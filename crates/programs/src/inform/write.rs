//! A draft as a relative job: positions in a user frame, RCONF for each; long programs are split.

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use crate::controller::Controller;
use crate::draft::{Blend, Draft, DraftPoint, DraftStep, Written, points};
use crate::draft_check::{Bounds, DraftError, LEAST_ACCELERATION};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::{in_pieces, in_quoted_pieces};

/// Maximum number of statements in one job; posts write 2000 to 9500 positions. Source: posts.
const MOST_STEPS: usize = 2000;

/// Maximum length of a remark. `[recalled]`
const LONGEST_REMARK: usize = 32;

/// Maximum length of a name: 8 on NX100, 32 later; three characters number the parts of a long program.
const LONGEST_NAME: [usize; 3] = [8, 32, 29];

/// Maximum length of a message on the pendant. Source: the RoboDK post, also for `MSG` and `PAUSE`.
const LONGEST_MESSAGE: usize = 25;

/// Decimals of a dwell, and the longest one, s. Source: the RoboDK post writes `TIMER T=1.00`; range `[recalled]`.
const DWELL: usize = 2;
const LONGEST_DWELL: f64 = 655.35;

/// Range of the tip speed, mm/s. `[recalled]`
const SPEEDS: [f64; 2] = [0.1, 1500.0];

const END: &str = "\r\n";

/// Writes `draft` as one job, or as several jobs called by a main job.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let split = draft.steps.len() > MOST_STEPS;
    draft.check(&Bounds {
        language: "Yaskawa INFORM",
        longest_name: if split { LONGEST_NAME[2] } else { LONGEST_NAME[1] },
        names: "a letter, then letters, digits and underscores, at most 32 characters; 29 if the program is split \
            into several jobs",
        // Those of a base axis or station are positions of another group, in pulses.
        external: 0,
        units: None,
        holds_part: false,
        frames: 1..=63,
        tools: 0..=63,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    })?;
    draft.check_speeds(|speed| to_mm(speed) >= SPEEDS[0] / 2.0)?;
    let parts: Vec<(String, &[DraftStep])> = draft.parts(MOST_STEPS, "").collect();
    let blends = draft.blends();
    let mut ahead = blends.iter();
    let main = split.then(|| file(&draft.name, main(draft, &parts)));
    let jobs: Vec<(String, Vec<u8>)> = parts
        .iter()
        .map(|(name, steps)| file(name, job(draft, name, steps, !split, &mut ahead)))
        .collect();
    let files = main.into_iter().chain(jobs).collect();
    Ok(Written {
        files,
        notes: notes(draft, split, &blends),
    })
}

fn file(name: &str, text: String) -> (String, Vec<u8>) {
    (format!("{name}.JBI"), text.into_bytes())
}

fn notes(draft: &Draft, split: bool, blends: &[Blend]) -> Vec<String> {
    let mut notes = vec![
        format!(
            "user frame {} on the controller must be, relative to the robot base: {}",
            draft.controller.frame_number,
            numbers(&draft.base_from_frame).join(" ")
        ),
        format!(
            "tool {} on the controller must be: {}",
            draft.controller.tool_number,
            numbers(&draft.flange_from_tool).join(" ")
        ),
        "the job is a relative job (ATTR RJ); some controllers need an option to load it".to_owned(),
        "MOVJ moves to a position with its RCONF, because pulses differ between robots: test these moves at low \
         speed"
            .to_owned(),
        "V= is in mm/s if the controller's parameter for it is set so".to_owned(),
    ];
    if blends.iter().any(|blend| blend.distance > 0.0) {
        notes.push(
            "moves along the path have PL=1: how far it rounds a corner is a parameter of the controller"
                .to_owned(),
        );
    }
    if draft.controller.acceleration.is_some() || draft.controller.joint_acceleration.is_some() {
        notes.push(
            "accelerations are not written: INFORM has percentages of the maximum (ACC=, DEC=)".to_owned(),
        );
    }
    if draft.points().any(|point| point.branch.is_none()) {
        notes.push("where no posture is given, RCONF says no flip, upper arm, front".to_owned());
    }
    if draft
        .points()
        .any(|point| point.speed.is_some_and(|speed| to_mm(speed) > SPEEDS[1]))
    {
        notes.push(format!(
            "speeds above {} mm/s are refused by most controllers",
            SPEEDS[1]
        ));
    }
    if draft.name.len() + if split { 3 } else { 0 } > LONGEST_NAME[0] {
        notes.push("controllers before DX100 allow names of at most 8 characters".to_owned());
    }
    notes
}

/// A pose in pieces that fit into remarks.
fn numbers(pose: &Isometry) -> [String; 4] {
    let numbers = Convention::Yaskawa.numbers_of(pose);
    let of = |at: usize| fixed(numbers[at], super::DECIMALS[at / 3]);
    [
        format!("X {} Y {}", of(0), of(1)),
        format!("Z {} mm,", of(2)),
        format!("Rx {} Ry {}", of(3), of(4)),
        format!("Rz {} deg", of(5)),
    ]
}

fn line(out: &mut String, text: &str) {
    out.push_str(text);
    out.push_str(END);
}

/// The header of the instructions, to NOP and the remarks.
fn instructions(draft: &Draft, attributes: &[&str], out: &mut String) {
    line(out, "//INST");
    // No time stamp: the same draft gives the same bytes.
    line(out, "///DATE 2000/01/01 00:00");
    for attribute in attributes {
        line(out, attribute);
    }
    line(out, "///GROUP1 RB1");
    line(out, "NOP");
    draft.remarks.iter().for_each(|remark| remarks(remark, out));
    let given = [
        (
            format!("USER {} from the base:", draft.controller.frame_number),
            &draft.base_from_frame,
        ),
        (
            format!("TOOL {} from the flange:", draft.controller.tool_number),
            &draft.flange_from_tool,
        ),
    ];
    for (what, pose) in given {
        for piece in std::iter::once(what).chain(numbers(pose)) {
            line(out, &format!("'{piece}"));
        }
    }
}

/// Statements of the cell.
fn statements(lines: &[String], out: &mut String) {
    lines.iter().for_each(|statement| line(out, statement));
}

/// The job that calls the parts of a long program.
fn main(draft: &Draft, parts: &[(String, &[DraftStep])]) -> String {
    let mut out = String::new();
    line(&mut out, "/JOB");
    line(&mut out, &format!("//NAME {}", draft.name));
    line(&mut out, "//POS");
    line(&mut out, "///NPOS 0,0,0,0,0,0");
    instructions(draft, &["///ATTR SC,RW"], &mut out);
    statements(&draft.controller.header, &mut out);
    for (name, _) in parts {
        line(&mut out, &format!("CALL JOB:{name}"));
    }
    statements(&draft.controller.footer, &mut out);
    line(&mut out, "END");
    out
}

/// A job with these steps; a single one also has the header and the footer of the cell.
fn job(
    draft: &Draft,
    name: &str,
    steps: &[DraftStep],
    is_single: bool,
    blends: &mut std::slice::Iter<'_, Blend>,
) -> String {
    let mut out = String::new();
    let controller = &draft.controller;
    line(&mut out, "/JOB");
    line(&mut out, &format!("//NAME {name}"));
    line(&mut out, "//POS");
    line(&mut out, &format!("///NPOS {},0,0,0,0,0", points(steps).count()));
    line(&mut out, &format!("///USER {}", controller.frame_number));
    line(&mut out, &format!("///TOOL {}", controller.tool_number));
    line(&mut out, "///POSTYPE USER");
    line(&mut out, "///RECTAN");
    let mut last = String::new();
    for (at, point) in points(steps).enumerate() {
        let rconf = rconf(point);
        if rconf != last {
            line(&mut out, &rconf);
            last = rconf;
        }
        let numbers: Vec<String> = Convention::Yaskawa
            .numbers_of(&point.frame_from_tool)
            .iter()
            .enumerate()
            .map(|(index, value)| fixed(*value, super::DECIMALS[index / 3]))
            .collect();
        line(&mut out, &format!("C{at:05}={}", numbers.join(",")));
    }
    let frame = format!("////FRAME USER {}", controller.frame_number);
    instructions(draft, &["///ATTR SC,RW,RJ", &frame], &mut out);
    if is_single {
        statements(&controller.header, &mut out);
    }
    let mut at = 0;
    for step in steps {
        match step {
            DraftStep::Move(point) => {
                let level = u32::from(blends.next().is_some_and(|blend| blend.distance > 0.0));
                let said = match point.speed {
                    Some(speed) => format!("MOVL C{at:05} V={} PL={level}", fixed(to_mm(speed), 1)),
                    None => {
                        let percent = Controller::percent(controller.joint_speed);
                        format!("MOVJ C{at:05} VJ={percent}.00 PL={level}")
                    }
                };
                line(&mut out, &said);
                at += 1;
            }
            DraftStep::Comment(text) => remarks(text, &mut out),
            DraftStep::Stop(text) => {
                remarks(text, &mut out);
                // A further message would replace this one.
                for piece in in_quoted_pieces(text, LONGEST_MESSAGE).iter().take(1) {
                    line(&mut out, &format!("MSG \"{piece}\""));
                }
                line(&mut out, "PAUSE");
            }
            DraftStep::Dwell(seconds) => {
                // Less than a hundredth of a second is not written as none.
                line(&mut out, &format!("TIMER T={}", fixed(seconds.max(0.01), DWELL)));
            }
            DraftStep::Statement(text) => line(&mut out, text),
        }
    }
    if is_single {
        statements(&controller.footer, &mut out);
    }
    line(&mut out, "END");
    out
}

/// A text as remarks.
fn remarks(text: &str, out: &mut String) {
    for piece in in_pieces(text, LONGEST_REMARK) {
        line(out, &format!("'{piece}"));
    }
}

/// Configuration: flip, elbow, shoulder, then whether axes R, T, S are rotated beyond 180 deg.
fn rconf(point: &DraftPoint) -> String {
    let configuration = point.branch.map(Configuration::of).unwrap_or_default();
    let set = |said: Option<bool>| i32::from(said.unwrap_or(false));
    let turned = |joint: usize| {
        let deg = to_deg(point.joints.get(joint).copied().unwrap_or(0.0));
        i32::from(!(deg > -180.0 && deg <= 180.0))
    };
    format!(
        "///RCONF {},{},{},{},{},{},0,0",
        1 - set(configuration.flip),
        set(configuration.lower),
        set(configuration.rear),
        turned(3),
        turned(5),
        turned(0)
    )
}
