//! The goals: the rate of armill relative to that of another program, and, where no other program does the work, the
//! time limit. A goal is shown once all of it was measured.
//!
//! A ratio is ours over theirs, both the median rates of one run on one machine. `must` is what armill
//! promises, `stretch` what it could reach; below `must` a goal is missed. Missed goals are reported, not failed: a
//! busy machine misses them too.

use super::row::{Row, digits};

/// The row: how its name begins and ends (with a version between), the work, the threads.
struct Side {
    begins: &'static str,
    ends: &'static str,
    work: &'static str,
    threads: usize,
}

/// One goal.
struct Goal {
    text: &'static str,
    ours: Side,
    theirs: Side,
    /// The ratio below which the goal is missed.
    must: f64,
    /// The ratio from which it is more than reached.
    stretch: f64,
}

/// A rate that no other program of this run can be compared with.
struct Aim {
    text: &'static str,
    row: Side,
    /// The rate below which the aim is missed, and from which it is more than reached, million points a second.
    must: f64,
    stretch: f64,
}

/// Rates on one core of a Zen 5 processor.
const AIMS: &[Aim] = &[
    aim(
        "evaluate: angles, limits, shares, uncertainty, one posture",
        side("armill evaluate", "evaluate", "dev"),
        60.0,
        100.0,
    ),
    aim(
        "the same as a map of 101 x 101",
        side("armill, map", "", "one posture"),
        60.0,
        100.0,
    ),
    aim(
        "the same, best of all postures",
        side("armill, map", "", "best of all 8"),
        25.0,
        40.0,
    ),
    aim(
        "MH12 a micrometre off, map, one posture",
        side("armill, MH12 a micrometre", "", "map, one posture"),
        15.0,
        40.0,
    ),
    aim(
        "MH12 a micrometre off, map, best of all",
        side("armill, MH12 a micrometre", "", "map, best of all"),
        5.0,
        15.0,
    ),
    aim(
        "MH12 with 18 springs, gravity and backlash, map, one posture",
        side("armill, MH12 with springs", "", "map, one posture"),
        10.0,
        30.0,
    ),
    aim("UR10, all postures", side("armill, UR10", "", "ik8"), 5.0, 15.0),
    aim("iiwa 14, all postures", side("armill, iiwa", "", "ik8"), 1.0, 4.0),
    aim(
        "MH12 with an open wrist, all postures",
        side("armill, MH12 with an open", "", "ik8"),
        0.1,
        0.5,
    ),
    aim(
        "placements, nothing pruned, points x cases",
        side("armill placement", "", "placement x point x case, one tool axis"),
        1000.0,
        1500.0,
    ),
    aim(
        "the same with 18 springs and gravity",
        side(
            "armill placement",
            "",
            "placement x point x case, 18 springs and gravity",
        ),
        100.0,
        300.0,
    ),
    aim(
        "arm of capsules, 1000 triangles, 10 mm kept along moves",
        side(CLEARANCE, "", "arm of capsules, check along moves"),
        1.0,
        2.0,
    ),
    aim(
        "arm of 20 000 triangles, 1000 triangles, 10 mm kept along moves",
        side(CLEARANCE, "", "arm of meshes, check along moves"),
        0.1,
        0.3,
    ),
];

/// The rows of distances, and those of their peer.
const CLEARANCE: &str = "armill clearance";
const PARRY: &str = "parry3d-f64";

/// An aim.
const fn aim(text: &'static str, row: Side, must: f64, stretch: f64) -> Aim {
    Aim {
        text,
        row,
        must,
        stretch,
    }
}

/// How rows of armill's lanes begin, without the back end.
const LANES: &str = "armill lanes f64";
/// The row of the Python package, and its work on many poses.
const PACKAGE: &str = "armill for Python";
const MANY: &str = "dev from angles, a million poses a call";
/// The row of the version that anyone would write.
const PLAIN: &str = "plain Rust with trigonometry";

/// A side on one thread.
const fn side(begins: &'static str, ends: &'static str, work: &'static str) -> Side {
    Side {
        begins,
        ends,
        work,
        threads: 1,
    }
}

/// The widest lanes of armill on one thread.
const fn lanes(work: &'static str) -> Side {
    side(LANES, LANES, work)
}

const GOALS: &[Goal] = &[
    Goal {
        text: "dev against C++ by hand",
        ours: lanes("dev"),
        theirs: side("C++ by hand", "", "dev"),
        must: 0.95,
        stretch: 1.1,
    },
    Goal {
        text: "one pose, all postures, against rs-opw-kinematics",
        ours: side("armill postures", "postures", "ik8"),
        theirs: side("rs-opw-kinematics", "", "ik8"),
        must: 1.5,
        stretch: 3.0,
    },
    Goal {
        text: "dev against plain Rust with trigonometry",
        ours: lanes("dev"),
        theirs: side(PLAIN, PLAIN, "dev"),
        must: 50.0,
        stretch: 70.0,
    },
    Goal {
        text: "dev against blocked numpy",
        ours: lanes("dev"),
        theirs: side("numpy", "blocked", "dev"),
        must: 75.0,
        stretch: 100.0,
    },
    Goal {
        text: "dev against trig-free numba",
        ours: lanes("dev"),
        theirs: side("numba", "trig-free", "dev"),
        must: 1.0,
        stretch: 1.15,
    },
    Goal {
        text: "C66 with inverse against Pinocchio C++ without",
        ours: lanes("C66"),
        theirs: side("Pinocchio", "C++", "C66 from angles"),
        must: 40.0,
        stretch: 65.0,
    },
    Goal {
        text: "ik8 against ik-geo",
        ours: lanes("ik8"),
        theirs: side("ik-geo", "", "ik8"),
        must: 30.0,
        stretch: 60.0,
    },
    Goal {
        text: "ik8 against rs-opw-kinematics",
        ours: lanes("ik8"),
        theirs: side("rs-opw-kinematics", "", "ik8"),
        must: 50.0,
        stretch: 100.0,
    },
    Goal {
        text: "ik8 against EAIK",
        ours: lanes("ik8"),
        theirs: side("EAIK", "", "ik8"),
        must: 80.0,
        stretch: 150.0,
    },
    Goal {
        text: "dev, two threads against one",
        ours: Side {
            threads: 2,
            ..lanes("dev")
        },
        theirs: lanes("dev"),
        must: 1.9,
        stretch: 1.97,
    },
    Goal {
        text: "Python, deviation at joint positions, 100 000 poses a call, against Rust",
        ours: side(PACKAGE, PACKAGE, "dev from angles"),
        theirs: side("armill evaluate_at_joints", "", "dev from angles"),
        must: 0.95,
        stretch: 1.0,
    },
    Goal {
        text: "Python, a million poses a call, two threads against one",
        ours: Side {
            threads: 2,
            ..side(PACKAGE, PACKAGE, MANY)
        },
        theirs: side(PACKAGE, PACKAGE, MANY),
        must: 1.8,
        stretch: 1.95,
    },
    Goal {
        text: "distance of a capsule and a mesh of 512 triangles against parry3d",
        ours: side(CLEARANCE, "", "capsule, mesh of 512"),
        theirs: side(PARRY, "", "capsule, mesh of 512"),
        must: 10.0,
        stretch: 20.0,
    },
    Goal {
        text: "distance of a capsule and a mesh of 32 768 triangles against parry3d",
        ours: side(CLEARANCE, "", "capsule, mesh of 32 768"),
        theirs: side(PARRY, "", "capsule, mesh of 32 768"),
        must: 100.0,
        stretch: 300.0,
    },
    Goal {
        text: "distance of two meshes of 2048 triangles against parry3d",
        ours: side(CLEARANCE, "", "meshes of 2048"),
        theirs: side(PARRY, "", "meshes of 2048"),
        must: 20.0,
        stretch: 50.0,
    },
    Goal {
        text: "distance of a cylinder and a box against parry3d",
        ours: side(CLEARANCE, "", "cylinder, box"),
        theirs: side(PARRY, "", "cylinder, box"),
        must: 0.5,
        stretch: 1.0,
    },
    Goal {
        text: "dev, AVX2 path against the widest",
        ours: side("armill lanes f64 AVX2", "", "dev"),
        theirs: lanes("dev"),
        must: 0.4,
        stretch: 0.5,
    },
];

/// A goal without another program to compare with: a million points on one thread.
struct Wait {
    text: &'static str,
    ours: Side,
    /// Most seconds for a million points.
    most_s: f64,
}

/// A goal of one row of armill.
const fn path(text: &'static str, who: &'static str, work: &'static str, most_s: f64) -> Wait {
    Wait {
        text,
        ours: side(who, who, work),
        most_s,
    }
}

/// Whose rows those of reading are.
const PROGRAM: &str = "armill, tool path program";

const WAITS: &[Wait] = &[
    path("G-code of short straight cuts read", PROGRAM, "G-code read", 10.0),
    path("APT of GOTOs read", PROGRAM, "APT read", 10.0),
    path("a path in CSV read", PROGRAM, "CSV path read", 10.0),
    path(
        "deviation along a path, a load case in the feed frame",
        "armill along_path",
        "along a path",
        2.0,
    ),
    // 0.7 G a second.
    path(
        "places of a path searched, points x cases of all places",
        "armill placement",
        "placement x point x case, search for the least largest",
        1.0 / 700.0,
    ),
];

/// What a million points took, as a Markdown table; empty if none was measured.
pub fn waits(rows: &[Row]) -> String {
    let mut lines = String::new();
    for wait in WAITS {
        // Rates are in millions a second.
        let Some(seconds) = wait.ours.rate(rows).map(|rate| 1.0 / rate) else {
            continue;
        };
        let verdict = if seconds <= wait.most_s { "met" } else { "missed" };
        lines += &format!(
            "| {} | {} | {} | {verdict} |\n",
            wait.text,
            digits(seconds),
            digits(wait.most_s)
        );
    }
    if lines.is_empty() {
        return lines;
    }
    format!("| a million points | seconds | at most | |\n|---|--:|--:|---|\n{lines}")
}

/// The rates of `rows` that have an aim, as a Markdown table; empty if there is none.
pub fn aims(rows: &[Row]) -> String {
    let mut lines = String::new();
    for aim in AIMS {
        if let Some(rate) = aim.row.rate(rows) {
            lines += &format!(
                "| {} | {} | {} | {} | {} |\n",
                aim.text,
                digits(rate),
                digits(aim.must),
                digits(aim.stretch),
                verdict(rate, aim.must, aim.stretch),
            );
        }
    }
    if lines.is_empty() {
        return lines;
    }
    format!("| work | measured | must | stretch | |\n|---|--:|--:|--:|---|\n{lines}")
}

fn verdict(measured: f64, must: f64, stretch: f64) -> &'static str {
    if measured >= stretch {
        "beyond"
    } else if measured >= must {
        "met"
    } else {
        "missed"
    }
}

/// The goals of which both sides are in `rows`, as a Markdown table; empty if there is none.
pub fn table(rows: &[Row]) -> String {
    let mut lines = String::new();
    for goal in GOALS {
        let (Some(ours), Some(theirs)) = (goal.ours.rate(rows), goal.theirs.rate(rows)) else {
            continue;
        };
        let ratio = ours / theirs;
        let verdict = verdict(ratio, goal.must, goal.stretch);
        lines += &format!(
            "| {} | {} | {} | {} | {verdict} |\n",
            goal.text,
            digits(ratio),
            digits(goal.must),
            digits(goal.stretch),
        );
    }
    if lines.is_empty() {
        return lines;
    }
    format!("| goal | measured | must | stretch | |\n|---|--:|--:|--:|---|\n{lines}")
}

impl Side {
    /// The median rate of the first row that this side means, million a second.
    fn rate(&self, rows: &[Row]) -> Option<f64> {
        let is = |row: &&Row| {
            row.who.starts_with(self.begins)
                && row.who.ends_with(self.ends)
                && row.work == self.work
                && row.threads == self.threads
        };
        rows.iter().find(is).map(|row| row.median)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(lines: &[&str]) -> Vec<Row> {
        lines
            .iter()
            .filter_map(|line| Row::read(&format!("{line}\t1\t1\t")))
            .collect()
    }

    #[test]
    fn a_goal_shows_once_both_sides_were_measured() {
        let plain = "plain Rust with trigonometry\tdev\t1\t4.0";
        assert_eq!(table(&rows(&[plain])), "");
        let both = table(&rows(&[plain, "armill lanes f64\tdev\t1\t240.0"]));
        assert!(both.contains("| 60.0 | 50.0 | 70.0 | met |"), "{both}");
    }

    #[test]
    fn an_aim_is_a_rate_and_shows_once_it_was_measured() {
        assert_eq!(aims(&rows(&["armill, UR10\tmap, one posture\t1\t9.0"])), "");
        let table = aims(&rows(&["armill, UR10\tik8\t1\t9.0"]));
        assert!(table.contains("| 9.00 | 5.00 | 15.0 | met |"), "{table}");
    }

    #[test]
    fn a_variant_of_the_lanes_does_not_pass_for_them() {
        let avx2 = "armill lanes f64 AVX2\tdev\t1\t100.0";
        assert_eq!(
            table(&rows(&[avx2, "plain Rust with trigonometry\tdev\t1\t4.0"])),
            ""
        );
        let both = table(&rows(&["armill lanes f64\tdev\t1\t200.0", avx2]));
        assert!(both.contains("| 0.500 | 0.400 | 0.500 | beyond |"), "{both}");
    }

    #[test]
    fn a_wait_is_the_time_of_a_million_points() {
        let slow = "armill along_path\talong a path\t1\t0.4";
        let other = "armill along_path\talong a path, cutting forces\t1\t4.0";
        assert_eq!(waits(&rows(&[other])), "");
        let table = waits(&rows(&[
            other,
            slow,
            "armill, tool path program\tAPT read\t1\t0.5",
        ]));
        assert!(table.contains("| 2.50 | 2.00 | missed |"), "{table}");
        assert!(
            table.contains("| APT of GOTOs read | 2.00 | 10.0 | met |"),
            "{table}"
        );
    }

    #[test]
    fn versions_in_names_do_not_matter_but_variants_do() {
        let lanes = "armill lanes f64\tdev\t1\t300.0";
        let numpy = "numpy 2.4.6, blocked\tdev\t1\t3.0";
        let other = "numpy 2.4.6, blocked, trig-free\tdev\t1\t30.0";
        assert!(table(&rows(&[lanes, other, numpy])).contains("| 100 | 75.0 | 100 | beyond |"));
    }
}
