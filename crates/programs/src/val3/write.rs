//! A draft as a project: data with frame, tool and points, and programs with the moves; long programs are split.

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use crate::controller::Controller;
use crate::draft::{Blend, Draft, DraftPoint, DraftStep, Written, text_lines};
use crate::draft_check::{Bounds, DraftError, LEAST_ACCELERATION, LONGEST_DWELL};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::{in_pieces, in_quoted_pieces};

/// Maximum number of lines in one program. `[recalled]`
const MOST_LINES: usize = 2000;

/// Longest remark, and line of a message.
const LONGEST_REMARK: usize = 100;
const LONGEST_MESSAGE: usize = 40;

/// Decimals of a dwell, s. Source: the RoboDK posts, `delay(1.000)` and `waitEndMove()`.
const DWELL: usize = 3;

/// Minimum speed that is not written as zero, mm/s.
const SLOWEST: f64 = 0.0005;

/// Decimals of joints, deg. Source: posts.
const JOINT_DECIMALS: usize = 5;

const END: &str = "\r\n";

/// The first bytes of a file, as the manufacturer's suite writes them.
const HEAD: &str = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\r\n";

/// Writes `draft` as the files of a project.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    draft.check(&Bounds {
        language: "Staubli VAL3",
        longest_name: 31,
        names: "a letter, then letters, digits and underscores, at most 31 characters",
        external: 0,
        units: None,
        holds_part: false,
        frames: 0..=99,
        tools: 0..=99,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    })?;
    draft.check_speeds(|speed| to_mm(speed) >= SLOWEST)?;
    if !draft.controller.sets_data() {
        return Err(DraftError::Data {
            language: "Staubli VAL3",
            reason: "a project contains its own frame and tool: data = \"program\"",
        });
    }
    let moves = Moves::of(draft);
    let lines = body(draft, &moves);
    let mut programs = Vec::new();
    if lines.len() > MOST_LINES {
        let parts: Vec<(String, &[String])> = (1..)
            .map(|number| format!("part{number:03}"))
            .zip(lines.chunks(MOST_LINES))
            .collect();
        let calls: Vec<String> = parts.iter().map(|(name, _)| format!("call {name}()")).collect();
        programs.push(("start".to_owned(), started(draft, &calls)));
        programs.extend(parts.into_iter().map(|(name, lines)| (name, lines.to_vec())));
    } else {
        programs.push(("start".to_owned(), started(draft, &lines)));
    }
    programs.push(("stop".to_owned(), vec!["resetMotion()".to_owned()]));
    let mut files = vec![
        (
            format!("{}.pjx", draft.name),
            project(draft, &programs).into_bytes(),
        ),
        (format!("{}.dtx", draft.name), data(draft, &moves).into_bytes()),
    ];
    files.extend(
        programs
            .iter()
            .map(|(name, lines)| (format!("{name}.pgx"), program(name, lines).into_bytes())),
    );
    Ok(Written {
        files,
        notes: notes(draft),
    })
}

fn notes(draft: &Draft) -> Vec<String> {
    let mut notes = vec![
        format!(
            "frame fFrame[{}] and tool tTool[{}] are in the project's data as specified: check that they match the \
             cell",
            draft.controller.frame_number, draft.controller.tool_number
        ),
        "copy the files to a folder with the project's name, for controllers with s7 or later".to_owned(),
        "joint moves are given in joints as this arm's controller reports them: test them at low speed"
            .to_owned(),
    ];
    if draft.controller.acceleration.is_some() {
        notes.push("the acceleration is not written: VAL3 has percentages of the maximum".to_owned());
    }
    if draft.points().any(|point| point.branch.is_none()) {
        notes.push(
            "where no posture is given, points keep the posture of the previous point (ssame, esame, wsame)"
                .to_owned(),
        );
    }
    notes
}

/// Speed and blend as written in the data: mm/s, none for a joint move; mm.
type Pace = (Option<String>, String);

/// The moves of a draft as data: each with the index of its target and of its pace.
struct Moves<'a> {
    /// Targets of joint moves.
    joints: Vec<&'a DraftPoint>,
    /// Targets of linear moves.
    points: Vec<&'a DraftPoint>,
    /// Every combination of speed and blend, once, in the order of first use.
    paces: Vec<Pace>,
    /// For each move the index of its target and of its pace.
    indices: Vec<[usize; 2]>,
}

impl<'a> Moves<'a> {
    fn of(draft: &'a Draft) -> Moves<'a> {
        let mut moves = Moves {
            joints: Vec::new(),
            points: Vec::new(),
            paces: Vec::new(),
            indices: Vec::new(),
        };
        let mut known = std::collections::BTreeMap::new();
        let blends: Vec<Blend> = draft.blends();
        for (point, blend) in draft.points().zip(blends) {
            let pace = (
                point.speed.map(|speed| fixed(to_mm(speed), 3)),
                fixed(to_mm(blend.distance), 3),
            );
            let at = *known.entry(pace.clone()).or_insert_with(|| {
                moves.paces.push(pace);
                moves.paces.len() - 1
            });
            let targets = match point.speed {
                Some(_) => &mut moves.points,
                None => &mut moves.joints,
            };
            targets.push(point);
            moves.indices.push([targets.len() - 1, at]);
        }
        moves
    }
}

/// The lines of all steps.
fn body(draft: &Draft, moves: &Moves<'_>) -> Vec<String> {
    let tool = format!("tTool[{}]", draft.controller.tool_number);
    let mut indices = moves.indices.iter();
    let mut lines = Vec::new();
    for step in &draft.steps {
        match step {
            DraftStep::Move(point) => {
                let [target, pace] = indices.next().copied().unwrap_or_default();
                lines.push(match point.speed {
                    Some(_) => format!("nTraj=movel(pPoint[{target}],{tool},mSpeed[{pace}])"),
                    // A joint move is given in joints: its posture and its turns are unique.
                    None => format!("nTraj=movej(jJoint[{target}],{tool},mSpeed[{pace}])"),
                });
            }
            DraftStep::Comment(text) => lines.extend(text_lines(text).map(remark)),
            DraftStep::Stop(text) => {
                // A key of the pendant continues the program: `get` waits for it, `popUpMsg` does not `[recalled]`.
                lines.extend(["waitEndMove()", "userPage()", "cls()"].map(str::to_owned));
                let pieces = in_quoted_pieces(text, LONGEST_MESSAGE);
                lines.extend(pieces.iter().map(|piece| format!("putln(\"{piece}\")")));
                lines.push("nTraj=get()".to_owned());
            }
            DraftStep::Dwell(seconds) => {
                lines.push("waitEndMove()".to_owned());
                lines.push(format!("delay({})", fixed(*seconds, DWELL)));
            }
            DraftStep::Statement(line) => lines.push(line.clone()),
        }
    }
    lines
}

fn remark(text: &str) -> String {
    format!("// {text}")
}

/// The lines of the main program of a project.
fn started(draft: &Draft, lines: &[String]) -> Vec<String> {
    let remarks = draft
        .remarks
        .iter()
        .flat_map(|text| in_pieces(text, LONGEST_REMARK))
        .map(|piece| remark(&piece));
    let controller = &draft.controller;
    remarks
        .chain(controller.header.iter().cloned())
        .chain(lines.iter().cloned())
        .chain(["waitEndMove()".to_owned()])
        .chain(controller.footer.iter().cloned())
        .collect()
}

fn joined(lines: &[String]) -> String {
    let mut out = HEAD.to_owned();
    for line in lines {
        out.push_str(line);
        out.push_str(END);
    }
    out
}

fn project(draft: &Draft, programs: &[(String, Vec<String>)]) -> String {
    let mut lines = vec![
        "<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">".to_owned(),
        "  <Parameters version=\"s7.3.1\" stackSize=\"5000\" millimeterUnit=\"true\" />".to_owned(),
        "  <Programs>".to_owned(),
    ];
    lines.extend(
        programs
            .iter()
            .map(|(name, _)| format!("    <Program file=\"{name}.pgx\" />")),
    );
    lines.extend([
        "  </Programs>".to_owned(),
        "  <Database>".to_owned(),
        format!("    <Data file=\"{}.dtx\" />", draft.name),
        "  </Database>".to_owned(),
        "  <Libraries>".to_owned(),
        "  </Libraries>".to_owned(),
        "</Project>".to_owned(),
    ]);
    joined(&lines)
}

fn program(name: &str, code: &[String]) -> String {
    let access = if name == "stop" { "private" } else { "public" };
    let mut lines = vec![
        "<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">"
            .to_owned(),
        format!("  <Program name=\"{name}\" access=\"{access}\">"),
        "    <Code><![CDATA[begin".to_owned(),
    ];
    // `]]>` would end the code; a blank between the characters has no meaning.
    lines.extend(
        code.iter()
            .map(|line| format!("  {}", line.replace("]]>", "]] >"))),
    );
    lines.extend(["end]]></Code>", "  </Program>", "</Programs>"].map(str::to_owned));
    joined(&lines)
}

fn data(draft: &Draft, moves: &Moves<'_>) -> String {
    let controller = &draft.controller;
    let frame = format!("{} fatherId=\"world[0]\"", attributes(&draft.base_from_frame));
    let tool = format!("{} fatherId=\"flange[0]\"", attributes(&draft.flange_from_tool));
    let mut lines = vec![
        "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">"
            .to_owned(),
        "  <Datas>".to_owned(),
    ];
    array(
        &mut lines,
        "fFrame",
        "frame",
        &[(controller.frame_number as usize, frame)],
    );
    let joints = moves.joints.iter().map(|point| {
        let deg = point
            .joints
            .iter()
            .map(|joint| fixed(to_deg(joint), JOINT_DECIMALS));
        let said: Vec<String> = (1..)
            .zip(deg)
            .map(|(axis, deg)| format!("j{axis}=\"{deg}\""))
            .collect();
        said.join(" ")
    });
    let joints: Vec<(usize, String)> = joints.enumerate().collect();
    array(&mut lines, "jJoint", "jointRx", &joints);
    let paces: Vec<(usize, String)> = moves
        .paces
        .iter()
        .map(|pace| described(controller, pace))
        .enumerate()
        .collect();
    array(&mut lines, "mSpeed", "mdesc", &paces);
    lines.push(
        "    <Data name=\"nTraj\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\" />"
            .to_owned(),
    );
    let points: Vec<(usize, String)> = moves
        .points
        .iter()
        .map(|point| {
            format!(
                "{} {} fatherId=\"fFrame[{}]\"",
                attributes(&point.frame_from_tool),
                posture(point),
                controller.frame_number
            )
        })
        .enumerate()
        .collect();
    array(&mut lines, "pPoint", "pointRx", &points);
    array(
        &mut lines,
        "tTool",
        "tool",
        &[(controller.tool_number as usize, tool)],
    );
    lines.extend(["  </Datas>", "</Database>"].map(str::to_owned));
    joined(&lines)
}

/// The attributes of a motion descriptor; 99999 is no limit of the speed of the tip.
fn described(controller: &Controller, (tip, blend): &Pace) -> String {
    let is_exact = !blend.bytes().any(|digit| matches!(digit, b'1'..=b'9'));
    let kind = if is_exact { "off" } else { "cartesian" };
    let (vel, accel, tip) = match tip {
        Some(tip) => (100, 100, tip.as_str()),
        None => (
            Controller::percent(controller.joint_speed),
            controller.joint_acceleration.map_or(100, Controller::percent),
            "99999",
        ),
    };
    format!(
        "accel=\"{accel}\" vel=\"{vel}\" decel=\"{accel}\" tmax=\"{tip}\" rmax=\"99999\" blend=\"{kind}\" \
         leave=\"{blend}\" reach=\"{blend}\""
    )
}

/// An array of data, its values by their keys.
fn array(lines: &mut Vec<String>, name: &str, kind: &str, values: &[(usize, String)]) {
    let size = values.last().map_or(1, |(key, _)| key + 1);
    lines.push(format!(
        "    <Data name=\"{name}\" access=\"private\" xsi:type=\"array\" type=\"{kind}\" size=\"{size}\">"
    ));
    lines.extend(
        values
            .iter()
            .map(|(key, value)| format!("      <Value key=\"{key}\" {value} />")),
    );
    lines.push("    </Data>".to_owned());
}

fn attributes(pose: &Isometry) -> String {
    let numbers = Convention::Staubli.numbers_of(pose);
    let said: Vec<String> = super::KEYS
        .iter()
        .zip(numbers)
        .enumerate()
        .map(|(index, (key, value))| format!("{key}=\"{}\"", fixed(value, super::DECIMALS[index / 3])))
        .collect();
    said.join(" ")
}

fn posture(point: &DraftPoint) -> String {
    let said = point.branch.map(Configuration::of).unwrap_or_default();
    let word = |set: Option<bool>, [same, not, yes]: [&'static str; 3]| match set {
        None => same,
        Some(false) => not,
        Some(true) => yes,
    };
    format!(
        "shoulder=\"{}\" elbow=\"{}\" wrist=\"{}\"",
        word(said.rear, ["ssame", "lefty", "righty"]),
        word(said.lower, ["esame", "epositive", "enegative"]),
        word(said.flip, ["wsame", "wpositive", "wnegative"])
    )
}
