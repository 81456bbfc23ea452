//! The calls that its interpreter prints, against ours.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use armill_formats::toolpath::gcode::interpret;

use super::{bytes, linuxcnc, simulated, text};
use crate::samples_folder::files_below;

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
    "FEED_RATE_IN_NEW_UNIT",
];

/// Both sides print four decimals, each rounded by half a unit of the last.
const LAST_DIGIT: f64 = 1.001e-4;

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

#[test]
fn canonical_calls_are_those_of_the_other_interpreter() {
    let Some(folder) = linuxcnc() else { return };
    let mut wrong = Vec::new();
    let mut count = 0;
    for (program, expected, table) in EXPECTED {
        let program = folder.join("tests").join(program);
        let directory = program.parent().unwrap();
        let options = simulated(table.map(|table| directory.join(table)).as_deref());
        let mut ours = Vec::new();
        let found = interpret(&mut bytes(&program).as_slice(), &options, &mut |call, line| {
            ours.push((call.to_string(), line));
            Ok(())
        });
        if let Some(fault) = found.faults.first() {
            wrong.push(format!("{}:{}: {}", program.display(), fault.line, fault.refusal));
            continue;
        }
        ours.retain(|(call, _)| compared(call));
        let mut theirs = expected_calls(&text(&directory.join(expected)));
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
    let found: BTreeSet<PathBuf> = files_below(&folder)
        .into_iter()
        .filter(|file| file.to_string_lossy().ends_with("expected"))
        .map(|file| file.strip_prefix(&folder).unwrap().to_owned())
        .collect();
    assert_eq!(found, known);
}
