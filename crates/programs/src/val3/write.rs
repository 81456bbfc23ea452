//! A draft as a project: data with frame, tool and points, and programs with the moves; long programs are split.

use armill_core::frame::Isometry;
use armill_core::units::{to_deg, to_mm};
use armill_formats::convention::Convention;

use crate::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::in_pieces;

/// Maximum number of moves in one program. `[recalled]`
const MOST_MOVES: usize = 2000;

const LONGEST_REMARK: usize = 100;

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
        joints: 6..=6,
        frames: 0..=99,
        tools: 0..=99,
    })?;
    draft.check_speeds(|speed| to_mm(speed) >= SLOWEST)?;
    let speeds = speeds(draft);
    let moves = moves(draft, &speeds);
    let mut programs = Vec::new();
    if moves.len() > MOST_MOVES {
        let parts: Vec<(String, &[String])> = (1..)
            .map(|number| format!("part{number:03}"))
            .zip(moves.chunks(MOST_MOVES))
            .collect();
        let calls: Vec<String> = parts.iter().map(|(name, _)| format!("call {name}()")).collect();
        programs.push(("start".to_owned(), started(draft, &calls)));
        programs.extend(parts.into_iter().map(|(name, moves)| (name, moves.to_vec())));
    } else {
        programs.push(("start".to_owned(), started(draft, &moves)));
    }
    programs.push(("stop".to_owned(), vec!["resetMotion()".to_owned()]));
    let mut files = vec![
        (
            format!("{}.pjx", draft.name),
            project(draft, &programs).into_bytes(),
        ),
        (format!("{}.dtx", draft.name), data(draft, &speeds).into_bytes()),
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
            draft.frame_number, draft.tool_number
        ),
        "copy the files to a folder with the project's name, for controllers with s7 or later".to_owned(),
        "the first point is given in joints as this arm's controller reports them: test it at low speed"
            .to_owned(),
    ];
    if draft.points.iter().any(|point| point.branch.is_none()) {
        notes.push(
            "where no posture is given, points keep the posture of the previous point (ssame, esame, wsame)"
                .to_owned(),
        );
    }
    notes
}

/// Speed and blend as written in the data: mm/s, mm.
type Pace = (Option<String>, String);

fn pace(draft: &Draft, point: &DraftPoint) -> Pace {
    (
        point.speed.map(|speed| fixed(to_mm(speed), 3)),
        fixed(to_mm(draft.blend(point)), 3),
    )
}

/// Every combination of speed and blend, once, in the order of first use.
fn speeds(draft: &Draft) -> Vec<Pace> {
    let mut found: Vec<Pace> = Vec::new();
    let mut known = std::collections::BTreeSet::new();
    for point in draft.points.iter().skip(1) {
        let pace = pace(draft, point);
        if known.insert(pace.clone()) {
            found.push(pace);
        }
    }
    found
}

fn moves(draft: &Draft, speeds: &[Pace]) -> Vec<String> {
    let places: std::collections::BTreeMap<&Pace, usize> = speeds.iter().zip(0..).collect();
    let tool = format!("tTool[{}]", draft.tool_number);
    let first = format!("nTraj=movej(jStart[0],{tool},mNomSpeed[0])");
    let rest = draft.points.iter().skip(1).enumerate().map(|(at, point)| {
        let word = if point.speed.is_some() { "movel" } else { "movej" };
        let pace = places.get(&pace(draft, point)).copied().unwrap_or_default();
        format!("nTraj={word}(pPoint[{at}],{tool},mSpeed[{pace}])")
    });
    std::iter::once(first).chain(rest).collect()
}

/// The lines of the main program of a project.
fn started(draft: &Draft, lines: &[String]) -> Vec<String> {
    let remarks = draft
        .remarks
        .iter()
        .flat_map(|remark| in_pieces(remark, LONGEST_REMARK));
    // Text that would end the code is split.
    let remarks = remarks.map(|piece| format!("// {}", piece.replace("]]>", "]] >")));
    let end = ["waitEndMove()".to_owned()];
    remarks.chain(lines.iter().cloned()).chain(end).collect()
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
    lines.extend(code.iter().map(|line| format!("  {line}")));
    lines.extend(["end]]></Code>", "  </Program>", "</Programs>"].map(str::to_owned));
    joined(&lines)
}

fn data(draft: &Draft, speeds: &[Pace]) -> String {
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
        &[(draft.frame_number as usize, frame)],
    );
    let start: Vec<String> = draft.points.first().map_or_else(Vec::new, |point| {
        let deg = point
            .joints
            .iter()
            .map(|joint| fixed(to_deg(joint), JOINT_DECIMALS));
        (1..)
            .zip(deg)
            .map(|(axis, deg)| format!("j{axis}=\"{deg}\""))
            .collect()
    });
    array(&mut lines, "jStart", "jointRx", &[(0, start.join(" "))]);
    let described = |tip: &str, vel: u32, blend: &str| {
        let kind = if blend == "0.000" { "off" } else { "cartesian" };
        format!(
            "accel=\"100\" vel=\"{vel}\" decel=\"100\" tmax=\"{tip}\" rmax=\"99999\" blend=\"{kind}\" \
             leave=\"{blend}\" reach=\"{blend}\""
        )
    };
    array(
        &mut lines,
        "mNomSpeed",
        "mdesc",
        &[(0, described("99999", 10, "0.000"))],
    );
    let paces: Vec<(usize, String)> = speeds
        .iter()
        .map(|(tip, blend)| match tip {
            Some(tip) => described(tip, 100, blend),
            None => described("99999", 10, blend),
        })
        .enumerate()
        .collect();
    array(&mut lines, "mSpeed", "mdesc", &paces);
    lines.push(
        "    <Data name=\"nTraj\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\" />"
            .to_owned(),
    );
    let points: Vec<(usize, String)> = draft
        .points
        .iter()
        .skip(1)
        .map(|point| {
            format!(
                "{} {} fatherId=\"fFrame[{}]\"",
                attributes(&point.frame_from_tool),
                posture(point),
                draft.frame_number
            )
        })
        .enumerate()
        .collect();
    array(&mut lines, "pPoint", "pointRx", &points);
    array(&mut lines, "tTool", "tool", &[(draft.tool_number as usize, tool)]);
    lines.extend(["  </Datas>", "</Database>"].map(str::to_owned));
    joined(&lines)
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
