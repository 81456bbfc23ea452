//! What bounds a row whose goal is missed: counted operations, and a sentence.
//!
//! Counts come from `bench/instructions.tsv`, for the AVX2 path: those of AVX-512 are about half. A row that is missed and
//! not in the list is shown without a reason.

use super::instructions::{Count, recorded};
use super::row::digits;

/// The reason of a goal or aim.
struct Bound {
    /// Its text in `goals.rs`.
    row: &'static str,
    /// The function in `bench/benches/instructions.rs` that does the work.
    function: &'static str,
    why: &'static str,
}

const BOUNDS: &[Bound] = &[
    bound(
        "dev against C++ by hand",
        "lanes_dev",
        "Planes between short loops, which 36 % of the instructions load or store: arm, tool, branch and plane are given at run time. By hand they are compiled in and everything stays in registers; quotients and roots are the same.",
    ),
    bound(
        "dev against plain Rust with trigonometry",
        "lanes_dev",
        "The same loops as in the first row.",
    ),
    bound(
        "dev against blocked numpy",
        "lanes_dev",
        "The same loops as in the first row.",
    ),
    bound(
        "dev against trig-free numba",
        "lanes_dev",
        "The same: the loop of numba has arm, tool, branch and plane compiled in, and no limits and flags.",
    ),
    bound(
        "C66 with inverse against Pinocchio C++ without",
        "lanes_c66",
        "The 36 numbers that are written for each pose, 288 bytes. They are also filled with zeros once, which counts each byte as an instruction in a library.",
    ),
    bound(
        "ik8 against rs-opw-kinematics",
        "lanes_ik8",
        "The same lanes as in the next row.",
    ),
    bound(
        "ik8 against EAIK",
        "lanes_ik8",
        "Arithmetic: of the 799 instructions outside libraries 542 touch no memory. 48 angles from arc tangents of degree 10, their margins, and forward kinematics that verifies them.",
    ),
    bound(
        "dev, two threads against one",
        "lanes_dev",
        "Nothing that is shared: each thread reads 24 bytes a pose and writes only memory of its own. On a Xeon with two cores two threads make 2.0 times one (medians of 15 rounds, real-time priority); the quartiles of the row show the noise of the machine.",
    ),
    bound(
        "evaluate: angles, limits, shares, uncertainty, one posture",
        "kernel_evaluate",
        "What a map contains more than a deviation: 7 times the instructions of the lanes of dev. 264 bytes a point are filled and then written. New memory costs one page fault for 15.5 points (perf: 27 000 in the first two calls with 200 000 points, 5 in the 24 that follow), again where other work has returned it to the system. On a virtual machine whose host takes free memory back such a fault is expensive: among the other rows of a run on a Xeon 1.0 to 6.1 million points a second, alone 7.9.",
    ),
    bound(
        "the same as a map of 101 x 101",
        "map_of_one_posture",
        "The same as evaluate; poses are made from points of the plane.",
    ),
    bound(
        "the same, best of all postures",
        "map_of_the_best",
        "The same, with the envelopes of four more branches: 551 instructions, 8 quotients and 10 roots.",
    ),
    bound(
        "MH12 a micrometre off, map, one posture",
        "calibrated_map_of_one_posture",
        "Newton's iteration for the two flips: 34 quotients and 12 roots, and the frames of all links, which are 61 KB for a block and do not fit in the nearest cache of 48 KB: 43 % of the instructions load or store.",
    ),
    bound(
        "MH12 a micrometre off, map, best of all",
        "calibrated_map_of_the_best",
        "The same for eight branches, 1960 instructions and 16 quotients each: two steps of Newton, forward kinematics that verifies, and the envelope of each branch. 47 % of the instructions load or store.",
    ),
    bound(
        "MH12 with 18 springs, gravity and backlash, map, one posture",
        "backlash_map_of_one_posture",
        "Sums over 18 springs and six joints with backlash, part after part: half of the instructions load or store their planes. Quotients and roots are those of the drives alone.",
    ),
    bound(
        "UR10, all postures",
        "ur10_postures",
        "Eight branches of 11 quotients and 7 roots each, six arc tangents and six sines with cosines; 40 % of the instructions outside libraries load or store, mostly frames. Counted before a link was rotated and turned in one pass: 5.8 KB of zeros a link, in libraries here, are no longer filled.",
    ),
    bound(
        "iiwa 14, all postures",
        "iiwa_postures",
        "One pose at a time, its eight postures in the lanes of a vector: 46 % of the instructions outside libraries load or store, since a loop over eight lanes is one or two vectors long. 125 quotients and 29 roots take 16 and 4 vectors of eight numbers.",
    ),
    bound(
        "MH12 with an open wrist, all postures",
        "open_wrist_postures",
        "The number of descents: some 60 for a pose, see [lanes](theory/lanes.md#theoretical-limit). 58 % of the instructions load or store, mostly the matrices of eight descents.",
    ),
    bound(
        "placements, nothing pruned, points x cases",
        "placement",
        "Arithmetic: 31 of 49 instructions touch no memory, about 15 with AVX-512. 1000 million a second would be 15 000 million of them, almost four in each cycle at 4 GHz.",
    ),
    bound(
        "the same with 18 springs and gravity",
        "placement_with_springs",
        "Both flips of the wrist, which differ under gravity: 3034 instructions for a point under four cases. Half of those outside libraries load or store, mostly the parts of 18 springs.",
    ),
];

/// A reason.
const fn bound(row: &'static str, function: &'static str, why: &'static str) -> Bound {
    Bound { row, function, why }
}

/// What is above the table.
const WHAT: &str = "\
Counted by Callgrind for AVX2 ([`instructions.tsv`](../bench/instructions.tsv)): instructions of a pose (of placements, of a
point under one case), those of them that load or store, and the quotients and roots that are computed. A vector of AVX2 is one
instruction for four numbers, one of AVX-512 for eight. Libraries are those of the system: memory is reserved, filled and copied;
Callgrind counts each byte of long fills and copies as one instruction, a processor writes 32 or 64 at once.
";

/// Heading of the section, and of the one that it comes before.
const HEADING: &str = "## What bounds what is missed";
const NEXT: &str = "## Tool paths";

/// The page with this section for the rows that its tables call missed, in place of the section that it may have.
pub fn with_section(page: &str) -> String {
    let (before, rest) = page.split_once(HEADING).unwrap_or((page, ""));
    let after = rest.find(NEXT).map_or("", |at| &rest[at..]);
    let (before, after) = if rest.is_empty() {
        before.find(NEXT).map_or((before, ""), |at| before.split_at(at))
    } else {
        (before, after)
    };
    let missed: Vec<&str> = before
        .lines()
        .filter(|line| line.ends_with("| missed |"))
        .filter_map(|line| line.strip_prefix("| ")?.split(" | ").next())
        .collect();
    if missed.is_empty() {
        return format!("{before}{after}");
    }
    format!(
        "{}\n\n{HEADING}\n\n{WHAT}\n{}\n{after}",
        before.trim_end(),
        table(&missed)
    )
}

/// A table of the missed rows, Markdown.
fn table(missed: &[&str]) -> String {
    let lines: String = missed
        .iter()
        .map(|row| {
            let bound = BOUNDS.iter().find(|bound| bound.row == *row);
            let count = bound.and_then(|bound| recorded(bound.function));
            let why = bound.map_or("not counted", |bound| bound.why);
            format!("| {row} | {} | {why} |\n", cells(count.as_ref()))
        })
        .collect();
    format!(
        "| missed | instructions | in libraries | loads | stores | quotients | roots | what bounds it |\n|---|--:|--:|--:|--:|--:|--:|---|\n{lines}"
    )
}

/// The counts, empty where there are none.
fn cells(count: Option<&Count>) -> String {
    let operations = count.and_then(|count| count.operations);
    let numbers = [
        count.map(|count| count.per_pose),
        operations.map(|each| each.in_libraries),
        operations.map(|each| each.loads),
        operations.map(|each| each.stores),
        operations.map(|each| each.quotients),
        operations.map(|each| each.roots),
    ];
    numbers
        .map(|number| number.map_or_else(String::new, digits))
        .join(" | ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_section_names_each_missed_row_once_and_is_replaced() {
        let page = "# P\n\n## Goals\n\n| goal | x | |\n|---|--:|---|\n| a | 1.0 | met |\n| b | 2.0 | missed |\n\n## Tool paths\n\nend\n";
        let once = with_section(page);
        assert!(
            once.contains("| b |  |  |  |  |  |  | not counted |\n\n## Tool paths\n\nend\n"),
            "{once}"
        );
        assert!(!once.contains("| a |  |"), "{once}");
        assert_eq!(with_section(&once), once);
        let met = page.replace("missed", "met");
        assert_eq!(with_section(&met), met);
    }

    #[test]
    fn every_reason_belongs_to_a_goal() {
        let goals = include_str!("goals.rs");
        for bound in BOUNDS {
            assert!(goals.contains(&format!("\"{}\"", bound.row)), "{}", bound.row);
            assert!(bound.why.ends_with('.'), "{}", bound.row);
        }
    }
}
