//! The page of a run: what was measured, on what, the rates side by side, the goals, every row.
//!
//! ```text
//! what is measured · machine · rates side by side · goals · tool paths · missing peers and why · every row
//! ```
//!
//! A part without rows is left out. Rates are millions per second, in brackets the ratio to the yardstick.

use super::goals;
use super::row::{Row, digits};

/// The columns: work as named in `bench/src/work.rs`.
const WORKS: &[&str] = &["dev", "dev8", "C66", "ik8", "dev from angles", "C66 from angles"];
/// Whose rate is 1.
const YARDSTICK: &str = "plain Rust with trigonometry";

/// The beginning of the page, the same after every run.
const WHAT: &str = "\
# Performance

Written by `cargo xtask bench`; do not edit. Million poses per second, median of all rounds; in brackets the ratio to
plain Rust with trigonometry at the same work on one thread. All candidates work in the same run on the same 200 000
reachable poses of a Yaskawa MH12: tool axis horizontal, TCP on a vertical plane 1 m in front of the base and 250 mm from
the wrist centre, four force cases. Before they are timed all are checked to compute the same: armill within 1e-9 of the
plain version, peers within 1e-6. Rates mean nothing across machines; ratios do, within a few percent.

- **dev**: inverse kinematics of one branch, deviation under four forces, the largest in-plane part
- **dev8**: the same for all 8 branches
- **C66**: 6 x 6 compliance at the tool, inverse kinematics included
- **ik8**: joint angles of all 8 branches
- **from angles**: the same without inverse kinematics, joint angles given

*C++ by hand* does the work of armill's lanes with intrinsics for this one arm, branch, tool and plane, all compiled in;
*arithmetic alone* is what that code must calculate, with nothing to load, store or wait for. No program of this kind can
be faster on this processor.

The packaged libraries verify, treat singular cases or take any geometry; the plain version and the specialised numpy and
numba ones do not. Results are overwritten block by block: work is timed, not the memory.

## How each is run

As someone who knows it well would run it; where a loop written for this one arm is faster than armill, it may be used
where its limits do not matter: it has no joint limits, no flags for what is out of reach, singular or unverified, no
other branch, arm or tool, and no shares and uncertainties.

- **armill**: as users get it, without options of the compiler; instructions are chosen while it runs
- **plain Rust, rs-opw-kinematics, ik-geo, k**: `target-cpu=native`, release profile, arms made once, poses in their own types
- **parry3d-f64**: the same settings; shapes and their trees made once, `query::distance` of two shapes at their poses
- **numba**: `fastmath`, `error_model=\"numpy\"` (with Python's check for a division by zero the loop gets no vectors), poses as
  columns, output allocated once; with threads: `parallel` over contiguous blocks
- **numpy**: poses as columns, blocks of 8192, output allocated once
- **EAIK**: `IK_batched` on one thread
- **Pinocchio, C++ by hand**: `-O3 -march=native`, model and data made once
";

/// The whole page, Markdown.
pub fn page(rows: &[Row], skipped: &[String], machine: &[String]) -> String {
    let mut page = format!(
        "{WHAT}\n## Machine\n\n{}\n## Rates\n\n{}",
        list(machine),
        side_by_side(rows)
    );
    let goals = goals::table(rows);
    if !goals.is_empty() {
        page += &format!("\n## Goals\n\nRatios of rates in this run.\n\n{goals}");
    }
    let aims = goals::aims(rows);
    if !aims.is_empty() {
        page += &format!(
            "\n## Rates with an aim\n\nMillion a second on one thread, where no other program does the work; the aims are those of one core of a Zen\n5 processor.\n\n{aims}"
        );
    }
    let waits = goals::waits(rows);
    if !waits.is_empty() {
        page += &format!("\n## Tool paths\n\nOn one thread; no other program does this work.\n\n{waits}");
    }
    if !skipped.is_empty() {
        page += &format!("\n## Not measured\n\n{}", list(skipped));
    }
    page + &format!("\n## Every row\n\n{}", every_row(rows))
}

/// One item a line.
fn list(lines: &[String]) -> String {
    lines.iter().map(|line| format!("- {line}\n")).collect()
}

/// Who against work, for the work that several do.
fn side_by_side(rows: &[Row]) -> String {
    let mut table = format!("| who | {} |\n|---|", WORKS.join(" | "));
    table += &"--:|".repeat(WORKS.len());
    table.push('\n');
    let shared = |row: &&Row| WORKS.contains(&row.work.as_str());
    let mut who: Vec<(&str, usize)> = Vec::new();
    for row in rows.iter().filter(shared) {
        if !who.contains(&(&row.who, row.threads)) {
            who.push((&row.who, row.threads));
        }
    }
    for (who, threads) in who {
        let cells: Vec<String> = WORKS
            .iter()
            .map(|work| cell(rows, who, (threads, work)))
            .collect();
        let threads = if threads == 1 {
            ""
        } else {
            &format!(", {threads} threads")
        };
        table += &format!("| {who}{threads} | {} |\n", cells.join(" | "));
    }
    table
}

/// Rate and ratio to the yardstick, or nothing.
fn cell(rows: &[Row], who: &str, (threads, work): (usize, &str)) -> String {
    let rate = |who: &str, threads: usize| {
        let is = |row: &&Row| row.who == who && row.work == work && row.threads == threads;
        rows.iter().find(is).map(|row| row.median)
    };
    match (rate(who, threads), rate(YARDSTICK, 1)) {
        (None, _) => String::new(),
        (Some(ours), Some(yardstick)) => format!("{} ({}x)", digits(ours), digits(ours / yardstick)),
        (Some(ours), None) => digits(ours),
    }
}

/// All rows as they were printed, with quartiles and notes.
fn every_row(rows: &[Row]) -> String {
    let mut table =
        String::from("| who | work | threads | median | quartiles | note |\n|---|---|--:|--:|--:|---|\n");
    for row in rows {
        let [lower, upper] = row.quartiles.map(digits);
        table += &format!(
            "| {} | {} | {} | {} | {lower} - {upper} | {} |\n",
            row.who,
            row.work,
            row.threads,
            digits(row.median),
            row.note
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Row> {
        let lines = [
            "plain Rust with trigonometry\tdev\t1\t4.0\t3.9\t4.1\t",
            "armill evaluate\tdev\t2\t2.0\t1.9\t2.1\tverified",
            "armill, one pose\tforward\t1\t1.0\t1.0\t1.0\t",
        ];
        lines.into_iter().filter_map(Row::read).collect()
    }

    #[test]
    fn rates_are_next_to_their_ratio_to_the_yardstick() {
        let table = side_by_side(&rows());
        assert!(
            table.contains("| armill evaluate, 2 threads | 2.00 (0.500x) |  |"),
            "{table}"
        );
        assert!(!table.contains("one pose"), "{table}");
    }

    #[test]
    fn the_page_shows_every_row_and_what_was_not_measured() {
        let page = page(
            &rows(),
            &["EAIK: no module".to_owned()],
            &["processor: x".to_owned()],
        );
        for part in [
            "armill, one pose | forward",
            "- EAIK: no module",
            "- processor: x",
        ] {
            assert!(page.contains(part), "{part}");
        }
        assert!(!page.contains("## Goals"), "no goal has both sides");
    }
}
