//! A program for ABB controllers: one module, or a main module that calls the routines of others.
//!
//! Tool and work object are data of the module, named by their numbers (`tool_2`, `wobj_1`): the data stored on the
//! controller under other names are not changed.

use armill_core::units::{from_mm, to_deg, to_mm, to_um};
use std::fmt::Write;

use super::spell::whole;
use crate::controller::Controller;
use crate::draft::{Blend, Draft, DraftPoint, DraftStep, FrameOn, Written, text_lines};
use crate::draft_check::{Bounds, DraftError, LONGEST_DWELL, UnitNames, avoid};
use crate::number::fixed;
use crate::posture::Configuration;
use crate::spelling::in_quoted_pieces;

/// `[recalled]` Longest identifier; `MOD_` precedes the name of a module, up to six characters follow that of a part.
const LONGEST_NAME: usize = 32;
const BEFORE_MODULE: usize = 4;
const PART: usize = 6;
/// Range of the numbers of tools and work objects, which appear only in names.
const MOST_FRAMES: u32 = 999;
/// Maximum number of statements in a module: larger modules load slowly; post processors write 10 to 30 thousand lines.
const MOST_STEPS: usize = 10_000;
/// Minimum acceleration along a path, m/s^2 `[recalled]`: below it `PathAccLim` raises ERR_ACC_TOO_LOW. Source of the
/// syntax of `PathAccLim` and of `WaitTime\InPos`: public RAPID code.
const LEAST_ACCELERATION: f64 = 0.1;
/// Decimals of joints, deg, of speeds, mm/s, of dwells, s, and of accelerations, m/s^2.
const JOINT: usize = 5;
const SPEED: usize = 3;
const DWELL: usize = 3;
const ACCELERATION: usize = 3;
/// Predefined speeds, mm/s `[recalled]`.
const SPEEDS: [u32; 24] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000,
    4000, 5000, 6000,
];
/// Distances of the zones of these programs, mm, in descending order. A zone never exceeds the requested distance, except
/// below the smallest one: a cut has no exact stops.
const ZONES: [f64; 20] = [
    200.0, 150.0, 100.0, 80.0, 60.0, 50.0, 40.0, 30.0, 20.0, 15.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05,
    0.02, 0.01,
];
/// Those with the name `z` and their distance `[recalled]`.
const PREDEFINED: [f64; 13] = [
    200.0, 150.0, 100.0, 80.0, 60.0, 50.0, 40.0, 30.0, 20.0, 15.0, 10.0, 5.0, 1.0,
];
/// Reorientation in a zone per distance, deg/mm, as in the predefined zone z1, `[FALSE,1,1,1,0.1,1,0.1]`. Fields: finep,
/// pzone_tcp, pzone_ori, pzone_eax (mm), zone_ori (deg), zone_leax (mm), zone_reax (deg). Source: public RAPID code.
const ZONE_DEG_PER_MM: f64 = 0.1;
/// Speed of joint moves at full joint speed, mm/s: joint moves of this language have the speed of the TCP.
const JOINT_MOVE_MM_S: f64 = 2000.0;
/// Longest line that the pendant shows `[recalled]`, characters.
const LONGEST_TEXT: usize = 40;
/// Value of an absent external axis.
const ABSENT: &str = "9E9";
/// Longest name of a mechanical unit, characters.
const LONGEST_UNIT: usize = 32;
/// Largest number of external axes.
const MOST_EXTERNAL: usize = 6;
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
    let is_split = draft.steps.len() > MOST_STEPS;
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
        external: MOST_EXTERNAL,
        units: Some(UnitNames {
            are: is_unit,
            rule: "it has letters, digits and underscores, at most 32, such as \"STN1\"",
        }),
        holds_part: true,
        frames: 0..=MOST_FRAMES,
        tools: 0..=MOST_FRAMES,
        longest_dwell: LONGEST_DWELL,
        least_acceleration: LEAST_ACCELERATION,
    };
    draft.check(&bounds)?;
    avoid(&draft.name, &bounds, WORDS)?;
    if draft.controller.sets_data() {
        let [tool, frame] = names(&draft.controller);
        avoid(&tool, &bounds, WORDS)?;
        avoid(&frame, &bounds, WORDS)?;
        if tool.eq_ignore_ascii_case(&frame) {
            return Err(DraftError::Data {
                language: bounds.language,
                reason: "tool and frame need different names",
            });
        }
    }
    let blends = draft.blends();
    let mut main = head(draft, &draft.name, &blends);
    main.push_str("    ConfJ\\On;\r\n    ConfL\\Off;\r\n    SingArea\\Wrist;\r\n");
    if let Some(acceleration) = draft.controller.acceleration {
        let limit = fixed(acceleration, ACCELERATION);
        _ = write!(
            main,
            "    PathAccLim TRUE\\AccMax:={limit},TRUE\\DecelMax:={limit};\r\n"
        );
    }
    for line in &draft.controller.header {
        _ = write!(main, "    {line}\r\n");
    }
    let mut files = Vec::new();
    let mut ahead = blends.iter();
    for (name, steps) in draft.parts(MOST_STEPS, "_") {
        let body = body(draft, steps, &mut ahead);
        match is_split {
            true => {
                _ = write!(main, "    {name};\r\n");
                let head = head(draft, &name, &blends);
                let part = format!("{head}{body}  ENDPROC\r\nENDMODULE\r\n");
                files.push((format!("{name}.mod"), ascii(&part)));
            }
            false => main.push_str(&body),
        }
    }
    for line in &draft.controller.footer {
        _ = write!(main, "    {line}\r\n");
    }
    main.push_str("  ENDPROC\r\nENDMODULE\r\n");
    files.insert(0, (format!("{}.mod", draft.name), ascii(&main)));
    Ok(Written {
        files,
        notes: notes(draft),
    })
}

/// Names of tool and work object.
fn names(controller: &Controller) -> [String; 2] {
    let given = |name: &Option<String>, otherwise: String| name.clone().unwrap_or(otherwise);
    [
        given(&controller.tool_name, format!("tool_{}", controller.tool_number)),
        given(
            &controller.frame_name,
            format!("wobj_{}", controller.frame_number),
        ),
    ]
}

/// A work object with this frame. On the table of a positioner the user frame is that of its mechanical unit, and the frame is the
/// object frame on it (ABB 3HAC021272-001, section 6.3). One that the robot holds has its user frame in the wrist frame
/// (ABB RAPID reference manual, `wobjdata`).
fn work_object(draft: &Draft, frame: &str) -> String {
    match draft.frame_on {
        FrameOn::Table => format!("[FALSE,FALSE,\"{}\",[[0,0,0],[1,0,0,0]],[{frame}]]", unit(draft)),
        FrameOn::Cell => format!("[FALSE,TRUE,\"\",[{frame}],[[0,0,0],[1,0,0,0]]]"),
        FrameOn::Flange => format!("[TRUE,TRUE,\"\",[{frame}],[[0,0,0],[1,0,0,0]]]"),
    }
}

/// Whether the robot holds the tool. The frame of a tool that it does not hold is in the world frame, and its load is that
/// of the gripper (ABB RAPID reference manual, `tooldata`).
fn holds_tool(draft: &Draft) -> &'static str {
    match draft.frame_on {
        FrameOn::Flange => "FALSE",
        FrameOn::Cell | FrameOn::Table => "TRUE",
    }
}

/// Name of the mechanical unit of the positioner.
fn unit(draft: &Draft) -> &str {
    draft.controller.positioner_unit.as_deref().unwrap_or("STN1")
}

/// Whether a mechanical unit may have this name.
fn is_unit(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_';
    (1..=LONGEST_UNIT).contains(&name.len()) && name.chars().all(fits)
}

/// A module up to the head of its routine.
fn head(draft: &Draft, name: &str, blends: &[Blend]) -> String {
    let mut out = format!("MODULE MOD_{name}\r\n");
    for line in draft.remark_lines() {
        _ = write!(out, "  ! {line}\r\n");
    }
    if draft.controller.sets_data() {
        let [tool_name, frame_name] = names(&draft.controller);
        let (mut tool, mut frame) = (String::new(), String::new());
        whole(&draft.flange_from_tool, &mut tool);
        whole(&draft.base_from_frame, &mut frame);
        _ = write!(
            out,
            "  LOCAL PERS tooldata {tool_name}:=[{},[{tool}],[1,[0,0,1],[1,0,0,0],0,0,0]];\r\n  \
             LOCAL PERS wobjdata {frame_name}:={};\r\n",
            holds_tool(draft),
            work_object(draft, &frame)
        );
    }
    let used = |zone: &f64| blends.iter().any(|blend| zone_of(blend.distance) == Some(*zone));
    for zone in ZONES
        .iter()
        .filter(|zone| !PREDEFINED.contains(zone) && used(zone))
    {
        let deg = fixed(zone * ZONE_DEG_PER_MM, SPEED);
        _ = write!(
            out,
            "  LOCAL PERS zonedata {}:=[FALSE,{zone},{zone},{zone},{deg},{zone},{deg}];\r\n",
            zone_name(*zone)
        );
    }
    _ = write!(out, "  PROC {name}()\r\n");
    out
}

/// The largest zone, mm, within this distance, m; the smallest one if all are larger; none for an exact stop.
fn zone_of(distance: f64) -> Option<f64> {
    let within = |zone: &&f64| distance >= from_mm(**zone * (1.0 - 1e-12));
    (distance > 0.0).then(|| {
        ZONES
            .iter()
            .find(within)
            .copied()
            .unwrap_or(ZONES[ZONES.len() - 1])
    })
}

fn zone_name(zone: f64) -> String {
    match PREDEFINED.contains(&zone) {
        true => format!("z{zone}"),
        false => format!("zone_{}um", to_um(from_mm(zone)).round()),
    }
}

fn body(draft: &Draft, steps: &[DraftStep], blends: &mut std::slice::Iter<'_, Blend>) -> String {
    let [tool, frame] = names(&draft.controller);
    let kept = format!("{tool}\\WObj:={frame}");
    let mut out = String::new();
    for step in steps {
        _ = match step {
            DraftStep::Move(point) => {
                let blend = blends.next().map_or(0.0, |blend| blend.distance);
                out.write_str(&line(draft, point, blend, &kept))
            }
            DraftStep::Comment(text) => text_lines(text).try_for_each(|line| write!(out, "    ! {line}\r\n")),
            DraftStep::Stop(text) => in_quoted_pieces(text, LONGEST_TEXT)
                .iter()
                .try_for_each(|line| write!(out, "    TPWrite \"{line}\";\r\n"))
                .and_then(|()| out.write_str("    Stop;\r\n")),
            DraftStep::Dwell(seconds) => {
                write!(out, "    WaitTime\\InPos,{};\r\n", fixed(*seconds, DWELL))
            }
            DraftStep::Statement(line) => write!(out, "    {line}\r\n"),
        };
    }
    out
}

fn line(draft: &Draft, point: &DraftPoint, blend: f64, kept: &str) -> String {
    let zone = zone_of(blend).map_or_else(|| "fine".to_owned(), zone_name);
    let external = external(draft, point);
    let Some(speed) = point.speed else {
        // A joint move is given in axes: its posture and its turns are unique.
        let speed = speed_of((draft.controller.joint_speed * JOINT_MOVE_MM_S).max(1.0));
        let joints = joints(point);
        return format!("    MoveAbsJ [{joints},{external}]\\NoEOffs,{speed},{zone},{kept};\r\n");
    };
    let mut target = String::new();
    whole(&point.frame_from_tool, &mut target);
    let confdata = confdata(point);
    let speed = speed_of(to_mm(speed));
    format!("    MoveL [{target},{confdata},{external}],{speed},{zone},{kept};\r\n")
}

/// The six external axes, deg or mm.
fn external(draft: &Draft, point: &DraftPoint) -> String {
    let given = point.external.iter().zip(&draft.external_slides);
    let given = given.map(|(value, slides)| {
        let value = if *slides { to_mm(*value) } else { to_deg(value) };
        fixed(value, JOINT)
    });
    let all: Vec<String> = given
        .chain(std::iter::repeat(ABSENT.to_owned()))
        .take(MOST_EXTERNAL)
        .collect();
    format!("[{}]", all.join(","))
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
    let [tool, frame] = names(&draft.controller);
    let mut notes = match draft.controller.sets_data() {
        true => vec![
            match draft.frame_on {
                FrameOn::Flange => format!(
                    "{tool} stands in the cell, and its frame is relative to the world frame, taken as that of the robot base; {frame} is \
                     on the flange: compare them with those of the controller"
                ),
                FrameOn::Cell | FrameOn::Table => format!(
                    "{tool} and {frame} are data of this module, relative to flange and robot base: compare them with those \
                     of the controller"
                ),
            },
            match draft.frame_on {
                FrameOn::Flange => format!(
                    "the load of {tool}, that of the gripper, is written as 1 kg: set mass, centre of gravity and inertia, and \
                     those of the part by GripLoad"
                ),
                FrameOn::Cell | FrameOn::Table => {
                    format!("the load of {tool} is written as 1 kg: set mass, centre of gravity and inertia")
                }
            },
        ],
        false => {
            let (mut tool_values, mut frame_values) = (String::new(), String::new());
            whole(&draft.flange_from_tool, &mut tool_values);
            whole(&draft.base_from_frame, &mut frame_values);
            vec![format!(
                "{tool} must be [{tool_values}] and {frame} [{frame_values}] on the controller, for which this program \
                 was made"
            )]
        }
    };
    if draft.frame_on == FrameOn::Table {
        notes.push(format!(
            "{frame} is coupled to the mechanical unit {}, whose user frame must be that of the robot file of the positioner: \
             compare them, and the senses and zeros of its axes, before the first run; the unit must be active",
            unit(draft)
        ));
    }
    notes.push(
        "SingArea\\Wrist lets the tool tilt where axes 4 and 6 are aligned; ConfL\\Off does not check postures along \
         the path"
            .to_owned(),
    );
    notes.push(
        "the first move goes to its joint positions from the robot's current posture: check for collisions"
            .to_owned(),
    );
    if draft.points().any(|point| point.branch.is_none()) {
        notes.push("cfx is written as 0, because the postures of this arm have no names".to_owned());
    }
    if !draft.external_slides.is_empty() {
        notes.push(
            "eax_a and further axes are the external axes from the ground on, those that carry the robot before those of \
             the positioner: check their order and zero"
                .to_owned(),
        );
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
            external: Vec::new(),
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
    fn predefined_speeds_are_used() {
        assert_eq!(speed_of(100.0), "v100");
        assert_eq!(speed_of(123.4567), "[123.457,500,5000,1000]");
    }

    #[test]
    fn zones_never_exceed_the_blend_and_only_a_stop_is_fine() {
        for (blend_mm, zone) in [
            (0.0, None),
            (0.001, Some("zone_10um")),
            (0.3, Some("zone_200um")),
            (0.99, Some("zone_500um")),
            (4.0, Some("zone_2000um")),
            (5.0, Some("z5")),
            (500.0, Some("z200")),
        ] {
            assert_eq!(
                zone_of(blend_mm * 1e-3).map(zone_name).as_deref(),
                zone,
                "{blend_mm}"
            );
        }
    }
}
