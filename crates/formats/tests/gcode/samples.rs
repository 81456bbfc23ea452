//! LinuxCNC's programs: the canonical calls of its interpreter tests, the reasons of its refusals, and which of its
//! larger programs are read. The folder is named by ARMILL_SAMPLES; without it nothing here is checked.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use armill_core::nalgebra::Vector3;
use armill_core::path::{Course, Move, Step};
use armill_formats::toolpath::LengthUnit;
use armill_formats::toolpath::gcode::{self, Options, Refusal, Rotaries, ToolTable, interpret};

/// Interpreter tests: the program, the calls expected of it, its tool table.
const EXPECTED: &[(&str, &str, Option<&str>)] = &[
    ("ccomp/mill-g90g91g92/test.ngc", "expected", Some("test.tbl")),
    ("ccomp/mill-line-arc-entry/test.ngc", "expected", Some("test.tbl")),
    ("ccomp/mill-zchanges/test.ngc", "expected", Some("test.tbl")),
    ("interp/cam-nisley/cam.ngc", "expected", Some("test.tbl")),
    ("interp/crazy-paths/test.ngc", "expected", None),
    ("interp/flowsnake/flowsnake.ngc", "expected", None),
    ("interp/g10/g10-l1-l10/test.ngc", "expected", Some("test.tbl")),
    ("interp/g10/g10-l11/test.ngc", "expected", Some("test.tbl")),
    ("interp/g10/g10-l2-while-active/test.ngc", "expected", None),
    ("interp/g10/g10-l20-while-active/test.ngc", "expected", None),
    ("interp/g10/g10-with-g92/test.ngc", "expected", Some("test.tbl")),
    (
        "interp/g52/g52-g92-interaction/g52-g92-interaction.ngc",
        "expected",
        None,
    ),
    ("interp/g6164/test.ngc", "expected", None),
    ("interp/g81/g17/g98/g17-g98-g81.ngc", "expected", None),
    ("interp/g81/g17/g99/g17-g99-g81.ngc", "expected", None),
    ("interp/g81/g18/g98/g18-g98-g81.ngc", "expected", None),
    ("interp/g81/g18/g99/g18-g99-g81.ngc", "expected", None),
    ("interp/g81/g19/g98/g19-g98-g81.ngc", "expected", None),
    ("interp/g81/g19/g99/g19-g99-g81.ngc", "expected", None),
    (
        "interp/good/good-arc.big.imperial.center-format.ngc",
        "good-arc.big.imperial.center-format.ngc.expected",
        None,
    ),
    (
        "interp/good/good-arc.big.metric.center-format.ngc",
        "good-arc.big.metric.center-format.ngc.expected",
        None,
    ),
    (
        "interp/good/good-arc.medium.imperial.center-format.ngc",
        "good-arc.medium.imperial.center-format.ngc.expected",
        None,
    ),
    (
        "interp/good/good-arc.medium.metric.center-format.ngc",
        "good-arc.medium.metric.center-format.ngc.expected",
        None,
    ),
    (
        "interp/good/good-arc.small.imperial.center-format.ngc",
        "good-arc.small.imperial.center-format.ngc.expected",
        None,
    ),
    (
        "interp/good/good-arc.small.metric.center-format.ngc",
        "good-arc.small.metric.center-format.ngc.expected",
        None,
    ),
    ("interp/inside-corners/test.ngc", "expected", None),
    ("interp/inverse-time-with-comp/inverse.ngc", "expected", None),
    ("interp/rotation/abs-pts/test.ngc", "expected", Some("test.tbl")),
    ("interp/rotation/g28/g28.ngc", "expected", None),
    ("interp/rotation/g53/g53.ngc", "expected", None),
    ("interp/unit-conversion/test.ngc", "expected", None),
];

/// Interpreter tests that are left out, and why.
const LEFT_OUT: &[(&str, &str)] = &[
    ("ccomp/lathe-comp/expected", "tools with an orientation: a lathe"),
    (
        "interp/g52/g92-offset-persistence/expected",
        "three runs that hand a parameter file on from one to the next",
    ),
];

/// Calls that have no part in the path: our comments are our own, and the rest is housekeeping of the other program.
const NOT_COMPARED: &[&str] = &[
    "COMMENT",
    "ON_RESET",
    "FINISH",
    "SET_FEED_REFERENCE",
    "PALLET_SHUTTLE",
    "SET_TOOL_TABLE_ENTRY",
    "TOOL_CENTRE_CONTROL",
    "MACHINE_COORDINATES",
];

/// Both sides print four decimals, each rounded by half a unit of the last.
const LAST_DIGIT: f64 = 1.001e-4;

fn linuxcnc() -> Option<PathBuf> {
    let samples = std::env::var_os("ARMILL_SAMPLES");
    if samples.is_none() {
        println!("skipped: ARMILL_SAMPLES is not set");
    }
    samples.map(|folder| Path::new(&folder).join("toolpaths/gcode/linuxcnc"))
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("sample {}: {error}", path.display()))
}

fn text(path: &Path) -> String {
    String::from_utf8_lossy(&bytes(path)).into_owned()
}

/// The calls of an expected output: `   12 N..... CALL(arguments)`.
fn expected_calls(text: &str) -> Vec<String> {
    text.lines()
        .filter_map(|line| line.split_once("N..... "))
        .map(|(_, call)| call.trim().to_owned())
        .filter(|call| compared(call))
        .collect()
}

fn compared(call: &str) -> bool {
    let name = call.split('(').next().unwrap_or_default();
    !NOT_COMPARED.contains(&name)
}

/// Whether two calls say the same: words and blanks as they are, numbers to their last digit.
fn agree(ours: &str, theirs: &str) -> bool {
    let parts = |call: &str| -> Vec<String> {
        call.split(|c: char| c.is_whitespace() || matches!(c, ',' | '(' | ')' | '"'))
            .filter(|part| !part.is_empty())
            .map(str::to_owned)
            .collect()
    };
    let (ours, theirs) = (parts(ours), parts(theirs));
    ours.len() == theirs.len()
        && ours
            .iter()
            .zip(&theirs)
            .all(|(one, other)| match (one.parse::<f64>(), other.parse::<f64>()) {
                (Ok(one), Ok(other)) => (one - other).abs() < LAST_DIGIT,
                _ => one == other,
            })
}

/// The simulated machine of those tests counts its tool table and parameters in inches.
fn simulated(table: Option<&Path>) -> Options<'static> {
    Options {
        machine_unit: LengthUnit::Inch,
        tools: table.map(|path| ToolTable::read("tbl", &text(path), LengthUnit::Inch).unwrap()),
        ..Options::default()
    }
}

#[test]
fn canonical_calls_are_those_of_the_other_interpreter() {
    let Some(folder) = linuxcnc() else { return };
    let mut wrong = Vec::new();
    let mut count = 0;
    for (program, expected, table) in EXPECTED {
        let program = folder.join("tests").join(program);
        let beside = program.parent().unwrap();
        let options = simulated(table.map(|table| beside.join(table)).as_deref());
        let mut ours = Vec::new();
        let told = interpret(&mut bytes(&program).as_slice(), &options, &mut |call, line| {
            ours.push((call.to_string(), line));
            Ok(())
        });
        if let Some(fault) = told.faults.first() {
            wrong.push(format!("{}:{}: {}", program.display(), fault.line, fault.refusal));
            continue;
        }
        ours.retain(|(call, _)| compared(call));
        let mut theirs = expected_calls(&text(&beside.join(expected)));
        if program.ends_with("abs-pts/test.ngc") {
            // Of this one only the messages are kept.
            ours.retain(|(call, _)| call.starts_with("MESSAGE"));
            theirs.retain(|call| call.starts_with("MESSAGE"));
        }
        count += theirs.len();
        let differs = ours
            .iter()
            .zip(&theirs)
            .position(|((ours, _), theirs)| !agree(ours, theirs));
        if let Some(at) = differs {
            wrong.push(format!(
                "{}:{}: call {at} is {}, expected {}",
                program.display(),
                ours[at].1,
                ours[at].0,
                theirs[at]
            ));
        } else if ours.len() != theirs.len() {
            wrong.push(format!(
                "{}: {} calls, expected {}",
                program.display(),
                ours.len(),
                theirs.len()
            ));
        }
    }
    println!("{count} calls of {} programs compared", EXPECTED.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_interpreter_test_is_forgotten() {
    let Some(folder) = linuxcnc() else { return };
    let folder = folder.join("tests");
    let mut known: BTreeSet<PathBuf> = LEFT_OUT.iter().map(|(file, _)| PathBuf::from(file)).collect();
    for (program, expected, _) in EXPECTED {
        known.insert(Path::new(program).parent().unwrap().join(expected));
    }
    let found: BTreeSet<PathBuf> = files(&folder)
        .into_iter()
        .filter(|file| file.to_string_lossy().ends_with("expected"))
        .map(|file| file.strip_prefix(&folder).unwrap().to_owned())
        .collect();
    assert_eq!(found, known);
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

type Reason = fn(&Refusal) -> bool;

/// What must be refused, and the reason in our words.
const BAD: &[(&str, Reason)] = &[
    ("a-in-canned-cycle.ngc", |it| {
        matches!(it, Refusal::RotaryInCycle { word: 'A' })
    }),
    ("a-in-canned-cycle2.ngc", |it| {
        matches!(it, Refusal::RotaryInCycle { word: 'A' })
    }),
    ("bad-arc.big.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.big.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.medium.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.medium.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.small.imperial.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("bad-arc.small.metric.center-format.ngc", |it| {
        matches!(it, Refusal::ArcRadii { .. })
    }),
    ("ccomp-arcexit.ngc", |it| {
        matches!(it, Refusal::ArcAfterCompensation)
    }),
    ("ccomp-gouging.ngc", |it| matches!(it, Refusal::Gouging { .. })),
    ("exists-1.ngc", |it| matches!(it, Refusal::ExpectedParameter)),
    ("exists-2.ngc", |it| matches!(it, Refusal::Expected(']'))),
    (
        "exists-3.ngc",
        |it| matches!(it, Refusal::ParameterOutOfRange(value, _) if *value == 99999.0),
    ),
    (
        "exists-4.ngc",
        |it| matches!(it, Refusal::UnknownFunction(name) if name == "foo"),
    ),
    ("exists-5.ngc", |it| matches!(it, Refusal::NameOpen)),
    ("exists-6.ngc", |it| matches!(it, Refusal::NotANumber(_))),
    ("exists-7.ngc", |it| matches!(it, Refusal::Expected(']'))),
    ("g64-m19-r-ambiguous.ngc", |it| {
        matches!(it, Refusal::WordAmbiguous('R'))
    }),
    ("g64-r-on-g61.ngc", |it| matches!(it, Refusal::WordUnused('R'))),
    ("nested.ngc", |it| matches!(it, Refusal::NestedSubroutine)),
    (
        "no-feed-rate.ngc",
        |it| matches!(it, Refusal::NoFeed(code) if code == "G1"),
    ),
    ("no-ijr.ngc", |it| matches!(it, Refusal::ArcWithoutCentre)),
    (
        "probe-no-axes.ngc",
        |it| matches!(it, Refusal::AxesMissing(code) if code == "G38.2"),
    ),
];

#[test]
fn what_the_other_interpreter_refuses_is_refused_for_the_same_reason() {
    let Some(folder) = linuxcnc() else { return };
    let folder = folder.join("tests/interp/bad");
    let options = Options {
        unit: LengthUnit::Inch,
        ..simulated(None)
    };
    let mut wrong = Vec::new();
    for (file, reason) in BAD {
        let told = interpret(
            &mut bytes(&folder.join(file)).as_slice(),
            &options,
            &mut |_, _| Ok(()),
        );
        match told.faults.first() {
            Some(fault) if reason(&fault.refusal) => {}
            Some(fault) => wrong.push(format!("{file}:{}: {}", fault.line, fault.refusal)),
            None => wrong.push(format!("{file}: accepted")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let known: BTreeSet<&str> = BAD.iter().map(|(file, _)| *file).collect();
    for file in files(&folder) {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        assert!(
            !name.ends_with(".ngc") || known.contains(name.as_str()),
            "{name} is not in the table"
        );
    }
}

fn five_axes(file: &str) -> Option<Rotaries> {
    if file.contains("xyzac") {
        Some(Rotaries::table_ac())
    } else if file.contains("xyzbc") {
        Some(Rotaries::table_bc())
    } else {
        None
    }
}

/// Programs of the folders `nc_files`, `configs` and `tests/trajectory-planner` that are refused: the first problem.
const REFUSED: &[(&str, &str)] = &[
    ("nc_files/comp-g1.ngc", "p:27:1: diameter of tool 4 is not told"),
    ("nc_files/comp.ngc", "p:12:5: diameter of tool 1 is not told"),
    (
        "nc_files/daisy.ngc",
        "p:63:19: cut with A at 7.341617023617251 deg and no tool-centre control",
    ),
    (
        "nc_files/hole-circle.ngc",
        "p:10:18: ^ is not read: polar words and spindle numbers are not understood",
    ),
    ("nc_files/mmount.ngc", "p:42:1: diameter of tool 4 is not told"),
    (
        "nc_files/nurbs/G5/butterfly-xy.ngc",
        "p:12:1: G5.2 is not read: splines and NURBS are not expanded",
    ),
    (
        "nc_files/plasmac/imperial_circles.ngc",
        "p:13:1: parameter #<_hal[plasmac.cut-feed-rate]> was never set",
    ),
    (
        "nc_files/plasmac/metric_circles.ngc",
        "p:13:1: parameter #<_hal[plasmac.cut-feed-rate]> was never set",
    ),
    (
        "nc_files/polar.ngc",
        "p:10:1: ^ is not read: polar words and spindle numbers are not understood",
    ),
    (
        "nc_files/spiral.ngc",
        "p:9:8: @ is not read: polar words and spindle numbers are not understood",
    ),
    (
        "nc_files/systems.ngc",
        "p:15:1: G5.1 is not read: splines and NURBS are not expanded",
    ),
    (
        "bridgemill/5axisgui.ngc",
        "p:18:27: word W is used by no code of this block",
    ),
    (
        "demos/xyzab-tdr-demo.ngc",
        "p:10:12: parameter #<_hal[xyzab_tdr_kins.x-rot-point]> was never set",
    ),
    (
        "demos/xyzac_switchkins.ngc",
        "p:2:1: subroutine xyzac_switchkins_sub is not known",
    ),
    (
        "demos/xyzac_switchkins_test_1.ngc",
        "p:7:1: cut with C at 90 deg and no tool-centre control",
    ),
    (
        "demos/xyzac_switchkins_test_3.ngc",
        "p:5:1: cut with C at 90 deg and no tool-centre control",
    ),
    (
        "demos/xyzbc_switchkins.ngc",
        "p:2:1: subroutine xyzbc_switchkins_sub is not known",
    ),
    (
        "demos/incremental_repetition.ngc",
        "p:1:1: G69 is not read: tilted planes need the machine's kinematics",
    ),
    (
        "demos/incremental_repetition_back_and_forth.ngc",
        "p:1:1: G69 is not read: tilted planes need the machine's kinematics",
    ),
    (
        "demos/incremental_repetition_g533.ngc",
        "p:1:1: G69 is not read: tilted planes need the machine's kinematics",
    ),
    (
        "demos/simple_example.ngc",
        "p:1:1: G69 is not read: tilted planes need the machine's kinematics",
    ),
];

/// Programs that only hold a subroutine.
const WITHOUT_CUTS: &[&str] = &[
    "ngcgui_lib/helix.ngc",
    "demos/circular_pocket.ngc",
    "demos/square.ngc",
];

#[test]
fn every_larger_program_is_read_or_refused_for_the_reason_named() {
    let Some(folder) = linuxcnc() else { return };
    let mut wrong = Vec::new();
    let mut read = 0;
    for part in ["nc_files", "configs", "tests/trajectory-planner"] {
        for file in files(&folder.join(part)) {
            let name = file.strip_prefix(&folder).unwrap().to_string_lossy().into_owned();
            if !name.ends_with(".ngc") {
                continue;
            }
            let options = Options {
                rotaries: five_axes(&name),
                ..simulated(None)
            };
            let outcome = gcode::read("p", &mut bytes(&file).as_slice(), &options, &mut |_| {});
            let known = REFUSED.iter().find(|(file, _)| name.ends_with(file));
            match (outcome, known) {
                (Ok(summary), None) => {
                    read += 1;
                    let none = WITHOUT_CUTS.iter().any(|file| name.ends_with(file));
                    if (summary.cuts == 0) != none {
                        wrong.push(format!("{name}: {} cuts", summary.cuts));
                    }
                }
                (Ok(_), Some((_, said))) => wrong.push(format!("{name}: read, not refused with `{said}`")),
                (Err(problems), known) => {
                    let first = problems.as_slice().first().unwrap().to_string();
                    if known.is_none_or(|(_, said)| first != *said) {
                        wrong.push(format!("    (\"{name}\", \"{first}\"),"));
                    }
                }
            }
        }
    }
    println!("{read} programs read");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn moves(file: &Path, options: &Options<'_>) -> Vec<Move> {
    let mut moves = Vec::new();
    let summary = gcode::read("p", &mut bytes(file).as_slice(), options, &mut |step| {
        if let Step::Move(next) = step {
            moves.push(next);
        }
    });
    assert!(summary.unwrap_or_else(|problems| panic!("{problems}")).moves as usize == moves.len());
    moves
}

const FIVE_AXES: &str = "configs/sim/axis/vismach/5axis/table-rotary-tilting/demos";

/// Plunges and retracts along the tool axis: between a rapid and a cut, the rotary axes at rest and the tool tilted.
fn plunges_along_axis(path: &Path, rotaries: Rotaries) -> usize {
    let options = Options {
        rotaries: Some(rotaries),
        ..Options::default()
    };
    let along = |pair: &&[Move]| {
        let [before, next] = pair else { return false };
        let (Some(from), Some(axis)) = (before.axis, next.axis) else {
            return false;
        };
        let way = next.end - before.end;
        // Coordinates and angles are written to 1 um and 0.001 deg: over 1.5 mm that is below 0.001 rad. 0.01 leaves
        // room for feet of plunges that were put on a surface, and is far less than the tilt.
        from == axis
            && axis.z < 0.9999
            && before.pace.cuts() != next.pace.cuts()
            && way.norm() > 1.5e-3
            && way.cross(&axis).norm() < 0.01 * way.norm()
    };
    moves(path, &options).windows(2).filter(along).count()
}

#[test]
fn plunges_run_along_the_tool_axis_of_the_part() {
    let Some(folder) = linuxcnc() else { return };
    for (file, table, head, expected) in [
        (
            "impeller-7bl-xyzac.ngc",
            Rotaries::table_ac(),
            Rotaries::head_ca(),
            29,
        ),
        ("boat-xyzbc.ngc", Rotaries::table_bc(), Rotaries::head_cb(), 9),
    ] {
        let path = folder.join(FIVE_AXES).join(file);
        assert_eq!(plunges_along_axis(&path, table), expected, "{file}");
        assert_eq!(
            plunges_along_axis(&path, head),
            0,
            "{file}: on another machine they do not"
        );
    }
}

/// Quarters of a turn and axes, worked out by hand; the names and remarks of the files say otherwise.
#[test]
fn arcs_sweep_as_they_should_in_every_plane() {
    let Some(folder) = linuxcnc() else { return };
    let folder = folder.join("tests/trajectory-planner/circular-arcs/nc_files/arc-feed");
    for (file, expected) in [
        ("full_xy.ngc", &[(3.0, Vector3::z())][..]),
        ("full_xz.ngc", &[(1.0, -Vector3::x())]),
        ("full_yz.ngc", &[(3.0, -Vector3::y()), (1.0, Vector3::y())]),
    ] {
        let mut arcs = Vec::new();
        for next in moves(&folder.join(file), &Options::default()) {
            if let Course::Arc(arc) = next.course {
                arcs.push(arc);
            }
        }
        assert_eq!(arcs.len(), expected.len(), "{file}");
        for (arc, (quarters, axis)) in arcs.iter().zip(expected) {
            // Ends in inches: a few roundings.
            assert!(
                (arc.sweep - quarters * PI / 2.0).abs() < 1e-14,
                "{file}: {}",
                arc.sweep
            );
            assert_eq!(arc.axis.into_inner(), *axis, "{file}");
        }
    }
}
