//! Robot files with random errors: a robot or a problem is returned, and nothing panics.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::robot::inverse::posture_at;
use armill_formats::robot::armill;
use armill_formats::robot::format::{self, RobotReadOptions};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const FILES: [(&str, &str); 6] = [
    (
        "arm.urdf",
        include_str!("../../../../validation/urdf-forward/oblique.urdf"),
    ),
    ("/nowhere/arm.xacro", include_str!("../seeds/arm.xacro")),
    ("opw.yaml", include_str!("../seeds/arm.opw.yaml")),
    ("ur.yaml", include_str!("../seeds/arm.ur.yaml")),
    ("arm.dh", include_str!("../seeds/arm.dh")),
    ("arm.chain", include_str!("../seeds/arm.chain")),
];

/// Pieces that something may trip over.
const TRAPS: &[&str] = &[
    "0",
    "-1",
    "1e-320",
    "1e308",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "99999999999999999999",
    "",
    " ",
    "\"",
    "'",
    "<",
    ">",
    "</",
    "/>",
    "&",
    "&lt;",
    "&x;",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<?",
    "${",
    "}",
    "${}",
    "$(",
    "$(arg x)",
    "$(find a)",
    "${h",
    "${1/0}",
    "${h*",
    "${[1,2][5]}",
    "${'a'}",
    "${load_yaml('a')}",
    "xacro:",
    "<xacro:include filename=\"a\"/>",
    "<xacro:a/>",
    "name=\"\"",
    "(",
    ")",
    "[",
    "]",
    "{",
    ",",
    ";",
    "=",
    ":",
    "#",
    "\t",
    "\r",
    "\n",
    "\0",
    "\u{feff}",
    "é",
    "−",
    "°",
    "deg(",
    "deg(1)",
    "- ",
    "--",
    "*",
    "^",
    "+",
    "A3(",
    "Tz(",
    "q1",
    "fixed",
    "prismatic",
    "floating",
    "mimic",
    "tool0",
    "base",
];

fn config(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    }
}

/// Reads; a refusal says something, a robot can be posed, written and read again.
fn outcome(path: &str, bytes: &[u8]) -> Result<(), TestCaseError> {
    let shown = String::from_utf8_lossy(bytes);
    match format::read(Path::new(path), "arm", bytes, &RobotReadOptions::default()) {
        Err(problems) => {
            prop_assert!(!problems.as_slice().is_empty(), "{}", shown);
            prop_assert!(
                problems
                    .as_slice()
                    .iter()
                    .all(|problem| !problem.message().trim().is_empty())
            );
            prop_assert!(problems.to_string().contains(path), "{}\n{}", problems, shown);
        }
        Ok(found) => {
            let q = vec![0.1; found.robot.joints().len()];
            let pose = posture_at(&found.robot, &q, &Isometry::identity())
                .base_from_tool
                .to_homogeneous();
            prop_assert!(pose.iter().all(|value| value.is_finite()), "{}\n{}", pose, shown);
            let text = armill::write(&found);
            let again = armill::read("written.toml", "arm", &text)
                .map_err(|problems| TestCaseError::fail(format!("{problems}\n{text}\n{shown}")))?;
            let back = posture_at(&again.robot, &q, &Isometry::identity())
                .base_from_tool
                .to_homogeneous();
            prop_assert!((pose - back).norm() <= 1e-12 * pose.norm(), "{}\n{}", text, shown);
        }
    }
    Ok(())
}

#[test]
fn the_files_that_are_mutated_are_good() {
    for (path, text) in FILES {
        let found = format::read(
            Path::new(path),
            "arm",
            text.as_bytes(),
            &RobotReadOptions::default(),
        );
        assert!(found.is_ok(), "{}", found.unwrap_err());
        outcome(path, text.as_bytes()).unwrap();
    }
}

type Cuts = Vec<(prop::sample::Index, usize, prop::sample::Index)>;

fn cuts(most: usize) -> impl Strategy<Value = Cuts> {
    prop::collection::vec(
        (
            any::<prop::sample::Index>(),
            0_usize..14,
            any::<prop::sample::Index>(),
        ),
        1..most,
    )
}

fn with_traps(text: &str, cuts: &Cuts) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (at, length, trap) in cuts {
        let start = at.index(bytes.len() + 1);
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, TRAPS[trap.index(TRAPS.len())].bytes());
    }
    bytes
}

proptest! {
    #![proptest_config(config(300, 21))]

    #[test]
    fn pieces_replaced_by_traps_never_panic(cuts in cuts(4)) {
        for (path, text) in FILES {
            outcome(path, &with_traps(text, &cuts))?;
        }
    }

    #[test]
    fn bytes_of_any_kind_never_panic(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..6, prop::collection::vec(any::<u8>(), 0..4)), 1..4),
    ) {
        for (path, text) in FILES {
            let mut bytes = text.as_bytes().to_vec();
            for (at, length, put) in &cuts {
                let start = at.index(bytes.len() + 1);
                let end = (start + length).min(bytes.len());
                bytes.splice(start..end, put.iter().copied());
            }
            outcome(path, &bytes)?;
        }
    }

    #[test]
    fn numbers_replaced_by_other_numbers_never_panic(
        which in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..4),
    ) {
        const NUMBERS: &[&str] = &["0", "-0.0", "1", "-1", "90", "180", "360", "1e-9", "1e-320", "1e3", "1e6", "1e154", "1e308", "-1e308", "1e400", "nan"];
        for (path, text) in FILES {
            let mut text = text.to_owned();
            for (at, number) in &which {
                let digits: Vec<usize> = text.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
                let start = digits[at.index(digits.len())];
                let length = text[start..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(0);
                text.replace_range(start..start + length, NUMBERS[number.index(NUMBERS.len())]);
            }
            outcome(path, text.as_bytes())?;
        }
    }

    #[test]
    fn lines_moved_doubled_and_removed_never_panic(
        moves in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3), 1..5),
    ) {
        for (path, text) in FILES {
            let mut lines: Vec<&str> = text.lines().collect();
            for (from, to, kind) in &moves {
                let (from, to) = (from.index(lines.len()), to.index(lines.len()));
                match kind {
                    0 if lines.len() > 1 => { lines.remove(from); }
                    1 => lines.insert(to, lines[from]),
                    _ => lines.swap(from, to),
                }
            }
            outcome(path, lines.join("\n").as_bytes())?;
        }
    }

    #[test]
    fn any_text_is_refused_or_read(text in "\\PC{0,80}") {
        for (path, _) in FILES {
            outcome(path, text.as_bytes())?;
        }
    }
}
