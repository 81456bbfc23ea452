//! Cutter locations of real parts, read and compared with what a plain search of their lines finds.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use armill_core::nalgebra::{Point3, Rotation3, Vector3};
use armill_core::path::{Course, Move, Pace, Step};
use armill_formats::language::Language;
use armill_formats::toolpath::Summary;
use armill_formats::toolpath::apt::{self, AptReadOptions};
use armill_formats::toolpath::format::Format;

use crate::samples_folder::{files_below, samples};

struct Part {
    name: String,
    text: String,
    lines: Vec<String>,
    summary: Summary,
    steps: Vec<Step>,
}

fn parts() -> Vec<Part> {
    let Some(folder) = samples("toolpaths/apt") else {
        return Vec::new();
    };
    let mut files = files_below(&folder);
    files.retain(|file| file.extension().is_some_and(|ending| ending == "apt"));
    assert_eq!(files.len(), 11);
    let part = |file: std::path::PathBuf| {
        let bytes = std::fs::read(&file).expect("it can be read");
        let name = file.display().to_string();
        let mut steps = Vec::new();
        let summary = apt::read(&name, bytes.as_slice(), &AptReadOptions::default(), &mut |step| {
            steps.push(step);
        })
        .unwrap_or_else(|problems| panic!("{problems}"));
        let text = String::from_utf8(bytes).expect("they are ASCII");
        Part {
            name,
            lines: text.lines().map(str::to_owned).collect(),
            text,
            summary,
            steps,
        }
    };
    files.into_iter().map(part).collect()
}

impl Part {
    fn count(&self, begin: &str) -> u64 {
        self.text.lines().filter(|line| line.starts_with(begin)).count() as u64
    }

    fn moves(&self) -> Vec<Move> {
        let moves = self.steps.iter().filter_map(|step| match step {
            Step::Move(next) => Some(*next),
            Step::Operation(_) | Step::Command(_) => None,
        });
        moves.collect()
    }

    /// The numbers behind the slash of a line, from 1.
    fn numbers(&self, line: u32) -> Vec<f64> {
        let line = &self.lines[line as usize - 1];
        let (_, numbers) = line.split_once('/').expect("it has a slash");
        numbers
            .split(',')
            .map(|number| number.trim().parse().expect("a number"))
            .collect()
    }
}

#[test]
fn every_sample_is_read_and_nothing_in_it_is_unknown() {
    let parts = parts();
    for part in &parts {
        let mut notes = part.summary.notes.iter();
        assert!(
            notes.all(|note| note.contains(" was ignored ")),
            "{}: {:?}",
            part.name,
            part.summary.notes
        );
        assert_eq!(Format::of(Path::new("unnamed"), &part.text), Ok(Format::Apt));
    }
}

#[test]
fn points_arcs_and_ignored_words_are_as_many_as_their_lines() {
    let parts = parts();
    let mut total = [0; 4];
    for part in &parts {
        let summary = &part.summary;
        assert_eq!(summary.arcs, part.count("CIRCLE/"), "{}", part.name);
        for note in &summary.notes {
            let (word, noted) = note.split_once(" was ignored ").expect("no other notes");
            // CYCLE/INIT and CYCLE/CLEAR open a cycle, the others are the cycle.
            let begins: &[&str] = if word == "CYCLE" {
                &["CYCLE/INIT", "CYCLE/CLEAR"]
            } else {
                &[word]
            };
            let counted: u64 = begins.iter().map(|begin| part.count(begin)).sum();
            let count = match counted {
                1 => "once".to_owned(),
                2 => "twice".to_owned(),
                more => format!("{more} times"),
            };
            let first = part
                .lines
                .iter()
                .position(|line| begins.iter().any(|begin| line.starts_with(begin)));
            let first = first.expect("it is there") + 1;
            assert_eq!(
                noted,
                format!("{count}, first in line {first}"),
                "{word} in {}",
                part.name
            );
        }
        let tools = part.count("CUTTER/");
        let operations = part
            .steps
            .iter()
            .filter(|step| matches!(step, Step::Operation(_)))
            .count() as u64;
        assert_eq!(operations, summary.operations, "{}", part.name);
        assert!(operations >= tools, "{}", part.name);
        assert_eq!(part.moves().len() as u64, summary.moves, "{}", part.name);
        let full = |next: &Move| matches!(next.course, Course::Arc(arc) if arc.sweep == TAU);
        let counts = [
            part.count("GOTO/"),
            summary.arcs,
            part.moves().iter().filter(|next| full(next)).count() as u64,
            part.count("RAPID/"),
        ];
        total = std::array::from_fn(|k| total[k] + counts[k]);
    }
    if !parts.is_empty() {
        assert_eq!(total, [14_480, 1_896, 164, 1_754]);
    }
}

#[test]
fn moves_outside_cycles_end_at_the_points_of_the_file() {
    for part in parts() {
        let mut rapids = 0;
        for next in part.moves() {
            let written = part.numbers(next.line);
            let point = Point3::new(written[0], written[1], written[2]) * 1e-3;
            if (next.end - point).norm() < 1e-12 {
                rapids += u64::from(next.pace == Pace::Rapid);
            } else {
                // A move of a hole goes along the tool axis through the point.
                let off = next.end - point;
                let axis = next.axis.expect("SolidWorks always has an axis");
                assert!(off.cross(&axis).norm() < 1e-12, "{}:{}", part.name, next.line);
            }
        }
        assert!(rapids >= part.count("RAPID/"), "{}", part.name);
    }
}

#[test]
fn every_arc_turns_its_start_into_its_end_about_its_centre() {
    let mut large = 0;
    for part in parts() {
        let moves = part.moves();
        for pair in moves.windows(2) {
            let Course::Arc(arc) = pair[1].course else {
                continue;
            };
            let place = format!("{}:{}", part.name, pair[1].line);
            let (a, b) = (pair[0].end - arc.centre, pair[1].end - arc.centre);
            // 1e-5 mm: the six decimals of centre and ends.
            assert!((a.norm() - b.norm()).abs() < 1e-8, "{place}");
            assert!(
                (pair[1].end - pair[0].end).dot(&arc.axis).abs() < 1e-8,
                "a helix in {place}"
            );
            let turned = Rotation3::from_axis_angle(&arc.axis, arc.sweep) * a;
            assert!((turned - b).norm() < 2e-8, "{place}");
            assert!(arc.sweep > 0.0 && arc.sweep <= TAU, "{place}");
            large += u32::from(arc.sweep > PI + 1e-6 && arc.sweep < TAU - 1e-6);
        }
    }
    assert!(
        large == 14 || samples("toolpaths/apt").is_none(),
        "{large} arcs of more than half a turn"
    );
}

#[test]
fn the_tool_axis_is_the_third_column_of_the_local_system() {
    for part in parts() {
        let mut systems: Vec<(u32, Vector3<f64>)> = Vec::new();
        for (index, _) in part
            .text
            .lines()
            .enumerate()
            .filter(|(_, line)| line.starts_with("CSYS/"))
        {
            let line = index as u32 + 1;
            let numbers = part.numbers(line);
            systems.push((line, Vector3::new(numbers[2], numbers[6], numbers[10])));
        }
        for next in part.moves() {
            let (_, column) = systems[systems.partition_point(|(line, _)| *line < next.line) - 1];
            let axis = next.axis.expect("SolidWorks always has an axis").into_inner();
            // Six decimals of each of three numbers.
            assert!((axis - column).norm() < 2e-6, "{}:{}", part.name, next.line);
        }
    }
}

#[test]
fn holes_are_as_many_as_the_points_within_cycles() {
    for part in parts() {
        let (mut within, mut holes) = (false, 0);
        for line in part.text.lines() {
            match line {
                line if line.starts_with("CYCLE/OFF") => within = false,
                line if line.starts_with("CYCLE/D") => within = true,
                line if line.starts_with("GOTO/") => holes += usize::from(within),
                _ => {}
            }
        }
        // The moves of a hole have one line, and nothing else gives several moves.
        let moves = part.moves();
        let mut lines: Vec<u32> = moves
            .windows(2)
            .filter(|pair| pair[0].line == pair[1].line)
            .map(|pair| pair[0].line)
            .collect();
        lines.dedup();
        assert_eq!(lines.len(), holes, "{}", part.name);
    }
}

#[test]
fn feeds_are_those_of_the_lines_above() {
    for part in parts() {
        let lines: Vec<&str> = part.text.lines().collect();
        for next in part.moves() {
            let Pace::Feed(speed) = next.pace else { continue };
            let above = lines[..next.line as usize].iter().rev().find_map(|line| {
                line.split_once(if line.starts_with("CYCLE/D") {
                    "MMPM,"
                } else {
                    "FEDRAT/"
                })
            });
            let (_, given) = above.expect("a feed is given above");
            let given: f64 = given
                .split(',')
                .next()
                .and_then(|number| number.trim().parse().ok())
                .expect("a number");
            assert!(
                (speed * 6e4 - given).abs() < 1e-9 * given,
                "{}:{}",
                part.name,
                next.line
            );
        }
    }
}

#[test]
fn the_format_of_every_tool_path_and_robot_program_is_known() {
    let Some(samples) = samples("") else { return };
    let files = files_below(&samples.join("toolpaths/gcode"));
    let mut programs = 0;
    for file in files
        .iter()
        .filter(|file| file.extension().is_some_and(|e| e == "ngc" || e == "nc"))
    {
        let text = String::from_utf8_lossy(&std::fs::read(file).expect("it can be read")).into_owned();
        assert_eq!(Format::of(file, &text), Ok(Format::Gcode), "{}", file.display());
        programs += 1;
    }
    assert!(programs >= 100, "{programs} programs");
    let folder = samples.join("programs/same-poses-six-languages");
    // Not by its ending.
    let known = |name: &str| {
        let bytes = std::fs::read(folder.join(name)).expect("the sample is there");
        Format::of(Path::new("unnamed"), &String::from_utf8_lossy(&bytes))
    };
    for (name, language) in [
        ("ABB_RAPID_IRC5.mod", Language::Rapid),
        ("Fanuc_R30iA.LS", Language::Tp),
        ("KUKA_KRC2_DAT.src", Language::Krl),
        ("KUKA_KRC4.src", Language::Krl),
        ("KUKA_KRC4_DAT.src", Language::Krl),
        ("Motoman.JBI", Language::Inform),
        ("Universal_Robots_SCRIPT.script", Language::UrScript),
    ] {
        assert_eq!(known(name), Ok(Format::Robot(language)), "{name}");
    }
    // Moves of a VAL3 program look like those of URScript: its file name decides.
    let name = "Staubli_VAL3_simplified.pgx";
    let text = std::fs::read_to_string(folder.join(name)).expect("the sample is there");
    assert_eq!(
        Format::of(Path::new(name), &text),
        Ok(Format::Robot(Language::Val3))
    );
    // An unsupported language.
    let given = known("Comau_C5G.pdl").expect_err("Comau").to_string();
    assert!(given.contains("a robot program"), "{given}");
}
