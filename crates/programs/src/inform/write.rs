//! A draft as a relative job: positions in a user frame, RCONF for each; long programs are split.

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use crate::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::in_pieces;

/// Maximum number of positions in one job; posts write 2000 to 9500. Source: posts.
const MOST_POSITIONS: usize = 2000;

/// Maximum length of a remark. `[recalled]`
const LONGEST_REMARK: usize = 32;

/// Maximum length of a name: 8 on NX100, 32 later; three characters number the parts of a long program.
const LONGEST_NAME: [usize; 3] = [8, 32, 29];

/// Joint speed in percent of the maximum: slow, for a first approach.
const JOINT_SPEED: &str = "VJ=10.00";

/// Range of the tip speed, mm/s. `[recalled]`
const SPEEDS: [f64; 2] = [0.1, 1500.0];

const END: &str = "\r\n";

/// Writes `draft` as one job, or as several jobs called by a main job.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let split = draft.points.len() > MOST_POSITIONS;
    draft.check(&Bounds {
        language: "Yaskawa INFORM",
        longest_name: if split { LONGEST_NAME[2] } else { LONGEST_NAME[1] },
        names: "a letter, then letters, digits and underscores, at most 32 characters; 29 if the program is split \
            into several jobs",
        joints: 6..=6,
        frames: 1..=63,
        tools: 0..=63,
    })?;
    draft.check_speeds(|speed| to_mm(speed) >= SPEEDS[0] / 2.0)?;
    let parts: Vec<(String, &[DraftPoint])> = draft.parts(MOST_POSITIONS, "").collect();
    let main = split.then(|| file(&draft.name, main(draft, &parts)));
    let jobs = parts
        .iter()
        .map(|(name, points)| file(name, job(draft, name, points)));
    let files = main.into_iter().chain(jobs).collect();
    Ok(Written {
        files,
        notes: notes(draft, split),
    })
}

fn file(name: &str, text: String) -> (String, Vec<u8>) {
    (format!("{name}.JBI"), text.into_bytes())
}

fn notes(draft: &Draft, split: bool) -> Vec<String> {
    let mut notes = vec![
        format!(
            "user frame {} on the controller must be, relative to the robot base: {}",
            draft.frame_number,
            numbers(&draft.base_from_frame).join(" ")
        ),
        format!(
            "tool {} on the controller must be: {}",
            draft.tool_number,
            numbers(&draft.flange_from_tool).join(" ")
        ),
        "the job is a relative job (ATTR RJ); some controllers need an option to load it".to_owned(),
        "the first move is MOVJ to a position with its RCONF, because pulses differ between robots: \
         test it at low speed"
            .to_owned(),
        "V= is in mm/s if the controller's parameter for it is set so".to_owned(),
    ];
    if draft.points.iter().any(|point| point.blend > 0.0) {
        notes.push(
            "moves without exact stop have PL=1: the blend distance is a parameter of the controller"
                .to_owned(),
        );
    }
    if draft.points.iter().any(|point| point.branch.is_none()) {
        notes.push("where no posture is given, RCONF says no flip, upper arm, front".to_owned());
    }
    if draft
        .points
        .iter()
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
    for remark in &draft.remarks {
        for piece in in_pieces(remark, LONGEST_REMARK) {
            line(out, &format!("'{piece}"));
        }
    }
    let given = [
        (
            format!("USER {} from the base:", draft.frame_number),
            &draft.base_from_frame,
        ),
        (
            format!("TOOL {} from the flange:", draft.tool_number),
            &draft.flange_from_tool,
        ),
    ];
    for (what, pose) in given {
        for piece in std::iter::once(what).chain(numbers(pose)) {
            line(out, &format!("'{piece}"));
        }
    }
}

/// The job that calls the parts of a long program.
fn main(draft: &Draft, parts: &[(String, &[DraftPoint])]) -> String {
    let mut out = String::new();
    line(&mut out, "/JOB");
    line(&mut out, &format!("//NAME {}", draft.name));
    line(&mut out, "//POS");
    line(&mut out, "///NPOS 0,0,0,0,0,0");
    instructions(draft, &["///ATTR SC,RW"], &mut out);
    for (name, _) in parts {
        line(&mut out, &format!("CALL JOB:{name}"));
    }
    line(&mut out, "END");
    out
}

/// A job with these points.
fn job(draft: &Draft, name: &str, points: &[DraftPoint]) -> String {
    let mut out = String::new();
    line(&mut out, "/JOB");
    line(&mut out, &format!("//NAME {name}"));
    line(&mut out, "//POS");
    line(&mut out, &format!("///NPOS {},0,0,0,0,0", points.len()));
    line(&mut out, &format!("///USER {}", draft.frame_number));
    line(&mut out, &format!("///TOOL {}", draft.tool_number));
    line(&mut out, "///POSTYPE USER");
    line(&mut out, "///RECTAN");
    let mut last = String::new();
    for (at, point) in points.iter().enumerate() {
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
    let frame = format!("////FRAME USER {}", draft.frame_number);
    instructions(draft, &["///ATTR SC,RW,RJ", &frame], &mut out);
    for (at, point) in points.iter().enumerate() {
        let level = if draft.blend(point) > 0.0 { 1 } else { 0 };
        let said = match draft.tip_speed(point) {
            Some(speed) => format!("MOVL C{at:05} V={} PL={level}", fixed(to_mm(speed), 1)),
            None => format!("MOVJ C{at:05} {JOINT_SPEED} PL={level}"),
        };
        line(&mut out, &said);
    }
    line(&mut out, "END");
    out
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
