//! Hostile numbers and bytes through the command line: every run ends, within limits of memory and time, with a
//! result or an
//! refusal.
//!
//! Links and files of the user are in `guarded`; parsers are fuzzed by `cargo xtask fuzz`.

use std::process::Command;

use crate::cell::{ARMILL, Cell, SMALL};

/// A run may take so much address space, kB, and processor time, s.
const MEMORY_KB: u32 = 4 << 20;
const TIME_S: u32 = 20;

/// Runs armill within bounds; `case` is for the message of a failure.
fn bounded(cell: &Cell, words: &str, case: &str) {
    let line = format!("ulimit -v {MEMORY_KB}; ulimit -t {TIME_S}; exec {ARMILL} {words}");
    let output = Command::new("sh")
        .args(["-c", &line])
        .current_dir(cell.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        matches!(output.status.code(), Some(0 | 2)),
        "{case}: {:?}\n{said}",
        output.status
    );
    if output.status.code() == Some(0) {
        let answer: Result<serde_json::Value, _> = serde_json::from_slice(&output.stdout);
        assert!(answer.is_ok(), "{case}: no JSON");
    }
}

/// Where numbers are in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let digit = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(at) = text[from..].find(|c: char| c.is_ascii_digit() || c == '-') {
        let start = from + at;
        let end = start + text[start..].find(|c| !digit(c)).unwrap_or(text.len() - start);
        found.push(start..end);
        from = end;
    }
    found
}

#[test]
fn any_number_of_a_study_that_follows_a_program_ends_in_an_answer_or_a_refusal() {
    let program = r#"
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[[analysis]]
kind = "path"
name = "ring"
[analysis.program]
file = "ring.ngc"
step_mm = 2
chord_error_mm = 0.02
spin_deg = 10
part_from_path_mm_deg = [1, 2, 3, 4, 5, 6]
"#;
    let text = format!("{SMALL}{program}");
    let cell = Cell::new();
    cell.file(
        "ring.ngc",
        "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG2 X10 Y0 I5 J0\nM2\n",
    );
    for place in numbers(&text) {
        for value in ["1e-30", "1e-320", "-1e-9", "0", "1e9", "1e308"] {
            let mut changed = text.clone();
            changed.replace_range(place.clone(), value);
            cell.file("study.toml", &changed);
            let line = changed[..place.start].lines().count();
            bounded(&cell, "check . --json", &format!("line {line}: {value}"));
        }
    }
}

#[test]
fn any_bytes_of_a_yaml_file_that_a_xacro_loads_end_in_an_answer_or_a_refusal() {
    let arm = r#"<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="w" value="${xacro.load_yaml('v.yaml')['a']}"/>
<link name="base"/><link name="tip"/>
<joint name="j" type="revolute"><origin xyz="0 0 ${w}" rpy="0 0 0"/><parent link="base"/><child link="tip"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="0"/></joint></robot>"#;
    let cell = Cell::new();
    cell.file("arm.xacro", arm);
    let deep: String = (0..3000).map(|k| format!("{}a:\n", " ".repeat(k))).collect();
    let bomb: String = ('b'..='j')
        .zip('a'..)
        .map(|(name, last)| format!("{name}: &{name} [{}]\n", vec![format!("*{last}"); 9].join(",")))
        .collect();
    let seeds = [
        "a: 0.5\nb: [1, 2, {c: 3}]\nd: &x [1, 2]\ne: *x\nf: !degrees 90\n".to_owned(),
        format!("a: &a [\"x\",\"x\"]\n{bomb}"),
        deep,
        format!("{}{}", "[".repeat(20_000), "]".repeat(20_000)),
    ];
    let tokens = [
        "&a", "*a", "[", "{", ": ", "\n  ", "- ", "!!", "\"", "\u{1b}", "1e999", "${", "<<: *x\n",
    ];
    // A linear congruential generator: the same bytes on every machine.
    let mut state = 7_u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    for (number, seed) in seeds.iter().enumerate() {
        bounded_yaml(&cell, seed.as_bytes(), &format!("seed {number}"));
        for change in 0..25 {
            let mut bytes = seed.clone().into_bytes();
            let at = next(bytes.len());
            match next(3) {
                0 => bytes.truncate(at),
                1 => bytes[at] ^= 1 << next(8),
                _ => {
                    bytes.splice(at..at, tokens[next(tokens.len())].bytes());
                }
            }
            bounded_yaml(&cell, &bytes, &format!("seed {number}, change {change}"));
        }
    }
}

fn bounded_yaml(cell: &Cell, bytes: &[u8], case: &str) {
    cell.file("v.yaml", bytes);
    bounded(cell, "robots arm.xacro --json", case);
}
