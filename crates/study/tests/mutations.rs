//! Study texts with random slips: whatever is written, armill answers or says what is wrong, and never panics.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_study::answer::answer;
use armill_study::file::resolve::{Study, read};
use armill_study::output::{self, OutputOptions, StudyResults};
use armill_study::run::{point_count, run};
use armill_study::{ErrorKind, StudyError};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A study that uses every table of the format.
const GOOD: &str = r#"format = 1
title = "Everything"
question = "Is it within the tolerance?"
robot = "yaskawa/mh12"
base = "base_link"
tolerance_um = 60
[compliance]
rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6]
u_rad_per_n_m = [1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7]
source = "a guess"
assumed = true
[tool]
flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]
[plane]
centre_mm = [900, 0, 800]
tilt_deg = 0
half_size_mm = [100, 50]
step_mm = 50
[load]
frame = "base"
cases_n = [[3, -5, 5], [3, 5, 5]]
moments_n_m = [[0, 0, 1], [0, 0, 2]]
source = "none"
[posture]
branch = "front elbow-up"
[[analysis]]
kind = "map"
name = "plate"
plane.rotation_deg = [90, 0, 90]
plane.half_size_mm = 80
[[analysis]]
kind = "sections"
name = "tilts"
tilts_deg = [0, 30]
posture.branch = "best"
[[analysis]]
kind = "sections"
distances_mm = [800, 900]
[[analysis]]
kind = "volume"
box = { centre_mm = [900, 0, 800], half_size_mm = [50, 50, 50], step_mm = 50 }
[[analysis]]
kind = "path"
name = "circle"
circle = { centre_mm = [0, 20], radius_mm = 40 }
step_mm = 20
[[analysis]]
kind = "path"
line = { from_mm = [0, 0], to_mm = [50, 0] }
[[analysis]]
kind = "path"
polyline_mm = [[0, 0], [50, 0], [50, 50]]
[[analysis]]
kind = "path"
rectangle = { centre_mm = [0, 0], size_mm = [60, 40] }
[[analysis]]
kind = "holes"
posture.search = { turns_deg = [-90, 90], step_deg = 30, component = "in-plane", least_wrist_deg = 3 }
holes = { at_mm = [[0, 0, 0], [20, 0, 5]], normals = [[0, 0, 1]], part_from_holes_mm_deg = [0, 0, 0, 0, 0, 0] }
[[statement]]
text = "within 0.1 mm"
source = "a paper"
at_most_um = 100
of = ["plate", "circle"]
"#;

/// Values that something may trip over.
const TRAPS: &[&str] = &[
    "0",
    "-0.0",
    "-1",
    "1",
    "1e-9",
    "1e-320",
    "1e9",
    "1e10",
    "1e154",
    "1e200",
    "1e308",
    "-1e308",
    "1e400",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999",
    "0x7f",
    "1_000",
    "true",
    "[]",
    "[[]]",
    "[[], []]",
    "{}",
    "\"\"",
    "\"best\"",
    "\"\\u0000\"",
    "'''\n'''",
    "1979-05-27",
    "89.999999999",
    "90",
    "180",
    "360",
    "1e6",
];

/// Numbers that a study may well contain, at the edge of what is sensible.
const EDGES: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-9",
    "-1e-9",
    "1e-320",
    "1e6",
    "-1e6",
    "1e9",
    "-1e9",
    "25",
    "50",
    "89.999999999",
    "90",
    "-90",
    "180",
    "400",
];

/// A study of more points than this is not run: other tests are about size.
const MOST_POINTS: usize = 3000;

fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    }
}

/// The byte ranges of all numbers of a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let part_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    let mut ranges = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..]
        .find(|c: char| c.is_ascii_digit() || c == '-')
        .map(|found| at + found)
    {
        let end = text[start..]
            .find(|c: char| !part_of_number(c) && c != 'e')
            .map_or(text.len(), |found| start + found);
        if text[..start].ends_with([' ', '[']) && text[start..end].parse::<f64>().is_ok() {
            ranges.push(start..end);
        }
        at = end.max(start + 1);
    }
    ranges
}

fn with_traps(list: &[&str], traps: &[(prop::sample::Index, prop::sample::Index)]) -> String {
    let mut text = GOOD.to_owned();
    for (which, trap) in traps {
        let ranges = numbers(&text);
        text.replace_range(which.get(&ranges).clone(), list[trap.index(list.len())]);
    }
    text
}

fn study(text: &[u8]) -> Result<Study, StudyError> {
    read("study.toml", Path::new("/nowhere"), text)
}

/// Reads, and runs what can be read; a refusal must be the user's to mend and say something.
fn outcome(text: &[u8]) -> Result<(), TestCaseError> {
    let shown = String::from_utf8_lossy(text).into_owned();
    let study = match study(text) {
        Ok(study) => study,
        Err(error) => {
            prop_assert_eq!(error.kind(), ErrorKind::InvalidInput, "{}", error);
            prop_assert!(!error.to_string().trim().is_empty());
            return Ok(());
        }
    };
    if point_count(&study) > MOST_POINTS {
        return Ok(());
    }
    let found = run(&study, Watch::NONE).map_err(|error| TestCaseError::fail(format!("{error}\n{shown}")))?;
    let answer = answer(&study, &found);
    let json = output::json(&answer).map_err(|error| TestCaseError::fail(format!("{error}\n{shown}")))?;
    prop_assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok());
    for map in &answer.maps {
        let c = map.counts;
        let points = c.within
            + c.above_tolerance
            + c.out_of_reach
            + c.no_posture_inside_limits
            + c.not_found
            + c.unverified;
        prop_assert_eq!(points, map.grid.points, "{}\n{}", map.name, shown);
        prop_assert!(
            map.max_in_plane_um.is_none_or(f64::is_finite),
            "{}\n{}",
            map.name,
            shown
        );
    }
    Ok(())
}

#[test]
fn the_text_that_is_mutated_is_good() {
    let study = study(GOOD.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(study.analyses.len(), 9);
    assert!(numbers(GOOD).len() > 60, "{:?}", numbers(GOOD));
    outcome(GOOD.as_bytes()).unwrap();
}

#[test]
fn lists_longer_than_a_person_writes_are_refused() {
    let tilts: String = (0..1001)
        .map(|index| format!("{}, ", f64::from(index) * 0.1))
        .collect();
    let analyses = "[[analysis]]\nkind = \"map\"\n".repeat(201);
    for (text, most) in [
        (
            GOOD.replace("tilts_deg = [0, 30]", &format!("tilts_deg = [{tilts}]")),
            "1000",
        ),
        (format!("{GOOD}{analyses}"), "200"),
    ] {
        let given = study(text.as_bytes()).unwrap_err().to_string();
        assert!(given.contains(most) && given.contains("entries"), "{given}");
    }
}

proptest! {
    #![proptest_config(config(400, 11))]

    #[test]
    fn numbers_replaced_by_traps_never_panic(
        traps in prop::collection::vec(any::<(prop::sample::Index, prop::sample::Index)>(), 1..4),
    ) {
        outcome(with_traps(TRAPS, &traps).as_bytes())?;
        outcome(with_traps(EDGES, &traps).as_bytes())?;
    }

    #[test]
    fn removed_and_inserted_bytes_never_panic(
        cuts in prop::collection::vec((0..GOOD.len(), 0_usize..12, prop::collection::vec(any::<u8>(), 0..4)), 1..5),
    ) {
        let mut text = GOOD.as_bytes().to_vec();
        for (at, length, bytes) in cuts {
            let start = at.min(text.len());
            let end = (start + length).min(text.len());
            text.splice(start..end, bytes);
        }
        outcome(&text)?;
    }

    #[test]
    fn lines_moved_doubled_and_removed_never_panic(
        moves in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3), 1..5),
    ) {
        let mut lines: Vec<&str> = GOOD.lines().collect();
        for (from, to, kind) in moves {
            let (from, to) = (from.index(lines.len()), to.index(lines.len()));
            match kind {
                0 => { lines.remove(from); }
                1 => lines.insert(to, lines[from]),
                _ => lines.swap(from, to),
            }
        }
        outcome(lines.join("\n").as_bytes())?;
    }
}

proptest! {
    #![proptest_config(config(50, 12))]

    /// What can be run can be written: a study that was read never ends as a fault of armill.
    #[test]
    fn results_can_be_written_as_tables(
        traps in prop::collection::vec(any::<(prop::sample::Index, prop::sample::Index)>(), 1..3),
    ) {
        let text = with_traps(EDGES, &traps);
        let Ok(study) = study(text.as_bytes()) else { return Ok(()) };
        prop_assume!(point_count(&study) <= MOST_POINTS);
        let found = run(&study, Watch::NONE).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let answer = answer(&study, &found);
        let results = StudyResults { study: &study, done: &found, answer: &answer };
        let written = output::write(results, &out, OutputOptions::TABLES, &|_| ());
        prop_assert!(written.is_ok(), "{}\n{}", written.unwrap_err(), text);
    }
}

proptest! {
    #![proptest_config(config(6, 13))]

    #[test]
    fn results_can_be_drawn(
        traps in prop::collection::vec(any::<(prop::sample::Index, prop::sample::Index)>(), 1..3),
    ) {
        let text = with_traps(EDGES, &traps);
        let Ok(mut study) = study(text.as_bytes()) else { return Ok(()) };
        prop_assume!(point_count(&study) <= MOST_POINTS);
        // One of each kind is enough to draw.
        study.analyses.truncate(2);
        let found = run(&study, Watch::NONE).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let answer = answer(&study, &found);
        let results = StudyResults { study: &study, done: &found, answer: &answer };
        let written = output::write(results, &out, OutputOptions::USUAL, &|_| ());
        prop_assert!(written.is_ok(), "{}\n{}", written.unwrap_err(), text);
    }
}
