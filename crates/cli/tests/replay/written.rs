//! The programs that `armill compensate` writes, run by the interpreters and compared with its table of points.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::checks::{
    ANGLE_DEG, Cut, CutPoint, Matches, POSITION_MM, blends_apart, clear, feeds, follows, no_stop_in_cut,
    within_limits,
};
use crate::event::{Action, Event, JointTarget, LinearMove, Reference};
use crate::expect::same_within;
use crate::pose::Pose;
use crate::replay::{Language, run, run_folder};

/// X, Y, Z in mm and A, B, C in deg of the plane of the study, which is the user frame of its programs.
const FRAME: [f64; 6] = [1700.0, 200.0, 900.0, -90.0, 0.0, 0.0];
const TOOL: [f64; 6] = [0.0, 90.0, 260.0, 0.0, 0.0, 0.0];

/// Language, file of the program, and whether moves inside of the cut are blended.
///
/// A distance of 0.2 mm is less than the smallest zone of ABB, which is written as an exact stop.
const PROGRAMS: [(Language, &str, bool); 6] = [
    (Language::Krl, "krl/pocket.src", true),
    (Language::Rapid, "rapid/pocket.mod", false),
    (Language::Inform, "inform/pocket.jbi", true),
    (Language::Tp, "tp/pocket.ls", true),
    (Language::UrScript, "urscript/pocket.script", true),
    (Language::Val3, "val3/pocket.pjx", true),
];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Writes the program of the example study in this language; the folder that it is in.
fn write(folder: &Path, program: &str) -> PathBuf {
    let out = Command::new(env!("CARGO_BIN_EXE_armill"))
        .current_dir(folder)
        .arg("compensate")
        .arg(repository().join("studies/r2000ic-pocket"))
        .args(["--out", "out", "--program", program])
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    folder.join(program).parent().unwrap().to_owned()
}

/// Rows of the table of commanded points.
fn commanded(table: &Path) -> Vec<CutPoint> {
    let text = std::fs::read_to_string(table).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let [x, y, z, i, j, k, feed, rapid] =
        ["x_mm", "y_mm", "z_mm", "i", "j", "k", "feed_mm_per_min", "rapid"].map(column);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |column: usize| cells[column].parse::<f64>().unwrap();
            CutPoint {
                position_mm: [x, y, z].map(number),
                axis: [i, j, k].map(number),
                feed_mm_per_s: cells[feed].parse().ok().map(|feed: f64| feed / 60.0),
                rapid: cells[rapid] == "1",
            }
        })
        .collect()
}

/// Limits of the axes, deg, from the file of the robot.
fn limits() -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(repository().join("robots/fanuc/r2000ic.toml")).unwrap();
    text.lines()
        .filter_map(|line| {
            line.strip_prefix("limits_deg = [")?
                .strip_suffix(']')?
                .split_once(',')
        })
        .map(|(from, to)| (from.trim().parse().unwrap(), to.trim().parse().unwrap()))
        .collect()
}

/// That a frame is the one of the study, where the program gives it.
#[track_caller]
fn same_reference(found: &Reference, expected: [f64; 6]) {
    if let Some(pose) = found.pose {
        let expected = Pose::kuka(expected);
        assert!(
            pose.distance_mm(&expected) < 1e-3 && pose.angle_deg(&expected) < 1e-3,
            "{found:?}"
        );
    }
}

/// All checks of one program; its events, and the frame of the part where targets are not given in it.
fn check(language: Language, program: &str, blended: bool) -> (Vec<Event>, Option<Pose>) {
    let folder = tempfile::tempdir().unwrap();
    let at = write(folder.path(), program);
    let fail = |error: crate::source::ReplayError| -> ! { panic!("{language:?}: {error}") };
    let events: Vec<Event> = run_folder(language, &at, "pocket").unwrap_or_else(|error| fail(error));
    let cut = Cut {
        points: commanded(&folder.path().join("out/pocket.commanded.csv")),
        // Universal Robots has no user frames: its targets are in the base of the robot.
        frame: (language == Language::UrScript).then(|| Pose::kuka(FRAME)),
        clearance_mm: 10.0,
        // 5 um between path and program, and what its numbers round.
        chord_mm: 0.007,
    };
    let matches: Matches = follows(&events, &cut).unwrap_or_else(|error| fail(error));
    clear(&events, &cut, &matches).unwrap_or_else(|error| fail(error));
    let limits = limits();
    assert_eq!(limits.len(), 6);
    within_limits(&events, &limits).unwrap_or_else(|error| fail(error));
    // FANUC has whole mm/s.
    feeds(&events, &cut, &matches, 0.05).unwrap_or_else(|error| fail(error));
    if language == Language::UrScript {
        blends_apart(&events).unwrap_or_else(|error| fail(error));
    }
    if blended {
        no_stop_in_cut(&events, &cut, &matches).unwrap_or_else(|error| fail(error));
    }
    for event in &events {
        if let Action::Linear(linear) = &event.action {
            if cut.frame.is_none() {
                same_reference(&linear.base, FRAME);
            }
            same_reference(&linear.tool, TOOL);
        }
    }
    (events, cut.frame)
}

/// Poses of the lines, in the frame of the part.
fn line_poses((events, frame): &(Vec<Event>, Option<Pose>)) -> Vec<Pose> {
    let in_part = |linear: &LinearMove| match frame {
        Some(frame) => frame.inverse().then(&linear.base.pose.unwrap()).then(&linear.to),
        None => linear.to,
    };
    events
        .iter()
        .filter_map(|event| event.action.linear())
        .map(in_part)
        .collect()
}

/// Axes of the joint moves that give them, deg.
fn axes((events, _): &(Vec<Event>, Option<Pose>)) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for event in events {
        if let Action::Joint(joint) = &event.action
            && let JointTarget::Axes(axes) = &joint.to
        {
            all.push(axes.clone());
        }
    }
    all
}

#[test]
fn the_programs_of_all_languages_follow_the_table_and_each_other() {
    let all = PROGRAMS.map(|(language, program, blended)| check(language, program, blended));
    let expected = line_poses(&all[0]);
    // Enough for a circle of 40 mm in chords of 5 um.
    assert!(expected.len() > 1000);
    for (events, (language, ..)) in all.iter().zip(PROGRAMS) {
        let found = line_poses(events);
        assert_eq!(found.len(), expected.len(), "{language:?}");
        for (one, other) in found.iter().zip(&expected) {
            // The spin about the axis of the tool too.
            same_within(one, other, POSITION_MM, ANGLE_DEG);
        }
        // Yaskawa has no axes: pulses differ from robot to robot.
        if language != Language::Inform {
            for (one, other) in axes(events).iter().flatten().zip(axes(&all[0]).iter().flatten()) {
                assert!((one - other).abs() < ANGLE_DEG, "{language:?}: {one} {other}");
            }
            assert_eq!(axes(events).len(), axes(&all[0]).len(), "{language:?}");
        }
    }
}

#[test]
fn a_written_program_with_one_changed_number_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let at = write(folder.path(), "pocket.src").join("pocket.src");
    let text = std::fs::read_to_string(&at).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let cuts: Vec<usize> = (0..lines.len())
        .filter(|index| lines[*index].starts_with("LIN"))
        .collect();
    let changed = cuts[cuts.len() / 2];
    lines[changed] = lines[changed]
        .replacen("{X ", "{X 1", 1)
        .replacen("{X 1-", "{X -1", 1);
    let events = run(Language::Krl, &[("pocket.src", lines.join("\n"))], "pocket").unwrap();
    let cut = Cut {
        points: commanded(&folder.path().join("out/pocket.commanded.csv")),
        frame: None,
        clearance_mm: 10.0,
        chord_mm: 0.007,
    };
    let found = follows(&events, &cut).unwrap_err();
    assert_eq!(found.place.line, changed + 1, "{found}");
}
