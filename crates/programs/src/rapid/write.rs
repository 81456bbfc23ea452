//! A program for ABB controllers: one module, or a main module that calls the routines of others.
//!
//! Tool and work object are data of the module, named by their numbers (`tool_2`, `wobj_1`): the data stored on the
//! controller under other names are not changed.

use armill_core::units::{from_mm, to_deg, to_mm};
use std::fmt::Write;

use super::spell::whole;
use crate::draft::{Bounds, Draft, DraftError, DraftPoint, Written};
use crate::number::fixed;
use crate::posture::Configuration;

/// `[recalled]` Longest identifier; `MOD_` precedes the name of a module, up to six characters follow that of a part.
const LONGEST_NAME: usize = 32;
const BEFORE_MODULE: usize = 4;
const PART: usize = 6;
/// Range of the numbers of tools and work objects, which appear only in names.
const MOST_FRAMES: u32 = 999;
/// Maximum number of moves in a module: larger modules load slowly [formats.md: 10 to 30 thousand lines].
const MOST_MOVES: usize = 10_000;
/// Decimals of joints, deg, and of speeds, mm/s.
const JOINT: usize = 5;
const SPEED: usize = 3;
/// Predefined speeds, mm/s `[recalled]`.
const SPEEDS: [u32; 24] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000,
    4000, 5000, 6000,
];
/// Predefined zones: name and maximum distance of the path from the target, mm `[recalled]`.
const ZONES: [(&str, f64); 15] = [
    ("z200", 200.0),
    ("z150", 150.0),
    ("z100", 100.0),
    ("z80", 80.0),
    ("z60", 60.0),
    ("z50", 50.0),
    ("z40", 40.0),
    ("z30", 30.0),
    ("z20", 20.0),
    ("z15", 15.0),
    ("z10", 10.0),
    ("z5", 5.0),
    ("z1", 1.0),
    ("z0", 0.3),
    ("fine", 0.0),
];
/// Values of absent external axes.
const ABSENT: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
/// Reserved words `[recalled]`.
const WORDS: &[&str] = &[
    "ALIAS",
    "AND",
    "BACKWARD",
    "CASE",
    "CONNECT",
    "CONST",
    "DEFAULT",
    "DIV",
    "DO",
    "ELSE",
    "ELSEIF",
    "ENDFOR",
    "ENDFUNC",
    "ENDIF",
    "ENDMODULE",
    "ENDPROC",
    "ENDRECORD",
    "ENDTEST",
    "ENDTRAP",
    "ENDWHILE",
    "ERROR",
    "EXIT",
    "FALSE",
    "FOR",
    "FROM",
    "FUNC",
    "GOTO",
    "IF",
    "INOUT",
    "LOCAL",
    "MOD",
    "MODULE",
    "MOVEABSJ",
    "MOVEC",
    "MOVEJ",
    "MOVEL",
    "NOSTEPIN",
    "NOT",
    "NOVIEW",
    "OR",
    "PERS",
    "PROC",
    "RAISE",
    "READONLY",
    "RECORD",
    "RETRY",
    "RETURN",
    "STEP",
    "SYSMODULE",
    "TASK",
    "TEST",
    "THEN",
    "TO",
    "TRAP",
    "TRUE",
    "TRYNEXT",
    "UNDO",
    "VAR",
    "VIEWONLY",
    "WHILE",
    "WITH",
    "XOR",
    "num",
    "bool",
    "string",
    "pos",
    "orient",
    "pose",
    "fine",
    "tool0",
    "wobj0",
    "load0",
    "Stop",
    "Set",
    "Reset",
    "Offs",
    "RelTool",
    "Load",
    "Open",
    "Close",
];

/// Writes a program.
///
/// # Errors
/// Values outside the ranges of the language or its controllers.
pub fn write(draft: &Draft) -> Result<Written, DraftError> {
    let is_split = draft.points.len() > MOST_MOVES;
    let bounds = Bounds {
        language: "ABB RAPID",
        longest_name: LONGEST_NAME - BEFORE_MODULE - if is_split { PART } else { 0 },
        names: match is_split {
            true => {
                "letters, digits and underscores, at most 22 because it is written in parts, and not a reserved word"
            }
            false => {
                "a letter, then letters, digits and underscores, at most 28 characters, and not a reserved word"
            }
        },
        joints: 6..=6,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
    };
    draft.check(&bounds)?;
    draft.avoid(&bounds, WORDS)?;
    let kept = format!("tool_{}\\WObj:=wobj_{}", draft.tool_number, draft.frame_number);
    let mut main = head(draft, &draft.name);
    main.push_str("    ConfJ\\On;\r\n    ConfL\\Off;\r\n    SingArea\\Wrist;\r\n");
    let mut files = Vec::new();
    for (name, points) in draft.parts(MOST_MOVES, "_") {
        let mut body = String::new();
        for point in points {
            match draft.is_first(point) {
                // The first move is given in joints: its posture is unique.
                true => {
                    _ = write!(
                        main,
                        "    MoveAbsJ [{},{ABSENT}]\\NoEOffs,v200,fine,{kept};\r\n",
                        joints(point)
                    );
                }
                false => body.push_str(&line(point, draft.blend(point), &kept)),
            }
        }
        match is_split {
            true => {
                _ = write!(main, "    {name};\r\n");
                let part = format!("{}{body}  ENDPROC\r\nENDMODULE\r\n", head(draft, &name));
                files.push((format!("{name}.mod"), ascii(&part)));
            }
            false => main.push_str(&body),
        }
    }
    main.push_str("  ENDPROC\r\nENDMODULE\r\n");
    files.insert(0, (format!("{}.mod", draft.name), ascii(&main)));
    Ok(Written {
        files,
        notes: notes(draft),
    })
}

/// A module up to the head of its routine.
fn head(draft: &Draft, name: &str) -> String {
    let mut out = format!("MODULE MOD_{name}\r\n");
    for line in draft.remark_lines() {
        _ = write!(out, "  ! {line}\r\n");
    }
    let (mut tool, mut frame) = (String::new(), String::new());
    whole(&draft.flange_from_tool, &mut tool);
    whole(&draft.base_from_frame, &mut frame);
    _ = write!(
        out,
        "  LOCAL PERS tooldata tool_{}:=[TRUE,[{tool}],[1,[0,0,1],[1,0,0,0],0,0,0]];\r\n  \
         LOCAL PERS wobjdata wobj_{}:=[FALSE,TRUE,\"\",[{frame}],[[0,0,0],[1,0,0,0]]];\r\n  \
         PROC {name}()\r\n",
        draft.tool_number, draft.frame_number
    );
    out
}

fn line(point: &DraftPoint, blend: f64, kept: &str) -> String {
    let mut target = String::new();
    whole(&point.frame_from_tool, &mut target);
    let target = format!("[{target},{},{ABSENT}]", confdata(point));
    let zone = ZONES
        .iter()
        .find(|(_, radius)| blend >= from_mm(radius * (1.0 - 1e-12)));
    let zone = zone.map_or("fine", |(name, _)| name);
    match point.speed {
        Some(speed) => format!("    MoveL {target},{},{zone},{kept};\r\n", speed_of(to_mm(speed))),
        None => format!("    MoveJ {target},v200,{zone},{kept};\r\n"),
    }
}

/// A speeddata: a predefined one, or one with the predefined rotation speed, deg/s `[recalled]`.
fn speed_of(mm_s: f64) -> String {
    let ready = SPEEDS.iter().find(|ready| f64::from(**ready) == mm_s);
    ready.map_or_else(
        || format!("[{},500,5000,1000]", fixed(mm_s, SPEED)),
        |ready| format!("v{ready}"),
    )
}

fn joints(point: &DraftPoint) -> String {
    let joints: Vec<String> = point
        .joints
        .iter()
        .map(|joint| fixed(to_deg(joint), JOINT))
        .collect();
    format!("[{}]", joints.join(","))
}

/// The quarter turns of axes 1, 4 and 6, and the posture.
fn confdata(point: &DraftPoint) -> String {
    let quarter = |axis: usize| (to_deg(point.joints[axis]) / 90.0).floor() as i64;
    let cfx = point.branch.map_or(0, |branch| cfx(Configuration::of(branch)));
    format!("[{},{},{},{cfx}]", quarter(0), quarter(3), quarter(5))
}

/// 4 rear, 2 lower, 1 flip.
fn cfx(configuration: Configuration) -> u32 {
    4 * u32::from(configuration.rear == Some(true))
        + 2 * u32::from(configuration.lower == Some(true))
        + u32::from(configuration.flip == Some(true))
}

fn ascii(text: &str) -> Vec<u8> {
    text.chars()
        .map(|c| if c.is_ascii() { c as u8 } else { b'?' })
        .collect()
}

fn notes(draft: &Draft) -> Vec<String> {
    let (frame, tool) = (draft.frame_number, draft.tool_number);
    let mut notes = vec![
        format!(
            "tool_{tool} and wobj_{frame} are data of this module, relative to flange and robot base: compare them \
             with those of the controller"
        ),
        format!("the load of tool_{tool} is written as 1 kg: set mass, centre of gravity and inertia"),
        "SingArea\\Wrist lets the tool tilt where axes 4 and 6 are aligned; ConfL\\Off does not check postures along \
         the path".to_owned(),
        "the first move goes to its joint positions from the robot's current posture: check for collisions".to_owned(),
    ];
    if draft.points.iter().any(|point| point.branch.is_none()) {
        notes.push("cfx is written as 0, because the postures of this arm have no names".to_owned());
    }
    notes
}

#[cfg(test)]
mod tests {
    use armill_core::nalgebra::Isometry3;
    use armill_core::robot::Branch;

    use super::*;

    fn point(joints_deg: [f64; 6], branch: Branch) -> DraftPoint {
        DraftPoint {
            frame_from_tool: Isometry3::identity(),
            joints: joints_deg.map(f64::to_radians).to_vec(),
            branch: Some(branch),
            speed: None,
            blend: 0.0,
        }
    }

    #[test]
    fn confdata_is_that_of_the_sample() {
        // ABB_RAPID_IRC5.mod: the move behind these joints has [0,0,-1,1]; axis 5 is below zero, arm in front, elbow
        // up.
        let joints = [22.509530, 5.585340, 8.157170, 67.511430, -24.426890, -64.062580];
        assert_eq!(confdata(&point(joints, Branch::ALL[1])), "[0,0,-1,1]");
        let turned = [-0.1, 0.0, 0.0, 180.5, 0.0, -302.5];
        assert_eq!(confdata(&point(turned, Branch::ALL[0])), "[-1,2,-4,0]");
    }

    #[test]
    fn every_posture_has_its_own_number() {
        let mut all: Vec<u32> = Branch::ALL
            .iter()
            .map(|branch| cfx(Configuration::of(*branch)))
            .collect();
        all.sort_unstable();
        assert_eq!(all, (0..8).collect::<Vec<_>>());
    }

    #[test]
    fn predefined_speeds_are_used_and_zones_never_exceed_the_blend() {
        assert_eq!(speed_of(100.0), "v100");
        assert_eq!(speed_of(123.4567), "[123.457,500,5000,1000]");
        for (blend_mm, zone) in [
            (0.0, "fine"),
            (0.2, "fine"),
            (0.3, "z0"),
            (0.99, "z0"),
            (4.0, "z1"),
            (500.0, "z200"),
        ] {
            let point = point([0.0; 6], Branch::ALL[0]);
            assert!(
                line(&point, blend_mm * 1e-3, "tool").contains(&format!(",v200,{zone},")),
                "{blend_mm}"
            );
        }
    }
}
