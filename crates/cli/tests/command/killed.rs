//! A study killed half-way: no file of it is half-written, and a run after it gives what an undisturbed one gives.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::cell::{ARMILL, Cell, SMALL, files_in, what_is_half};

/// Moments at which a run is killed, shares of the time that an undisturbed one takes, scattered by the golden ratio: the
/// first is 0, which is before the end on any machine. `ARMILL_KILLS=100` runs more than the few that every test run has
/// time for. No assertion depends on what a kill catches.
fn moments() -> Vec<f64> {
    let count = std::env::var("ARMILL_KILLS").map_or(4, |count| count.parse().expect("ARMILL_KILLS=100"));
    (0..count)
        .map(|k| (f64::from(k) * 0.618_033_988_75).fract())
        .collect()
}

/// Two analyses: enough files to be interrupted between, few enough to be drawn often.
const ANALYSES: &str = r#"
[[analysis]]
kind = "map"
name = "plate"

[[analysis]]
kind = "path"
name = "groove"
circle.radius_mm = 60
step_mm = 20
"#;

fn start(cell: &Cell, out: &str) -> Child {
    let mut command = Command::new(ARMILL);
    command
        .args(["run", "study.toml", "--out", out])
        .current_dir(cell.path());
    command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Files under their own names; a temporary one that a killed run could not remove is recognised by its name.
fn finished_files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let temporary = |name: &str| name.starts_with(".armill-");
    files_in(folder)
        .into_iter()
        .filter(|(name, _)| !temporary(name))
        .collect()
}

#[test]
fn a_killed_run_leaves_no_partial_file_and_can_be_repeated() {
    let cell = Cell::with_study(&format!("{SMALL}{ANALYSES}"));
    let begun = Instant::now();
    assert!(start(&cell, "undisturbed").wait().unwrap().success());
    let whole_time = begun.elapsed();
    let undisturbed = finished_files(&cell.at("undisturbed"));
    assert!(undisturbed.len() > 20);

    let mut caught = Vec::new();
    for (k, moment) in moments().into_iter().enumerate() {
        let out = format!("killed {k}");
        let mut child = start(&cell, &out);
        std::thread::sleep(whole_time.mul_f64(moment));
        child.kill().unwrap();
        child.wait().unwrap();
        let left = finished_files(&cell.at(&out));
        let half: Vec<String> = left
            .iter()
            .filter_map(|(name, bytes)| what_is_half(name, bytes))
            .collect();
        assert!(half.is_empty(), "after {moment:.3}: {half:?}");
        // What is there is what would have been there: every file is final when it gets its name.
        for (name, bytes) in &left {
            let whole = undisturbed.iter().find(|(other, _)| other == name);
            assert!(
                whole.is_some_and(|(_, whole)| whole == bytes),
                "after {moment:.3}: {name}"
            );
        }
        if left.iter().any(|(name, _)| name == "result.json") {
            assert_eq!(
                left.len(),
                undisturbed.len(),
                "result.json came before other files"
            );
        }
        caught.push(left.len());
    }
    println!("files left by each kill: {caught:?} of {}", undisturbed.len());
    assert!(
        caught.iter().any(|left| *left < undisturbed.len()),
        "every run was over before it was killed"
    );

    let most = caught
        .iter()
        .enumerate()
        .filter(|(_, left)| **left < undisturbed.len())
        .max_by_key(|(_, left)| **left);
    for moment in [0, most.unwrap().0] {
        let out = format!("killed {moment}");
        assert!(start(&cell, &out).wait().unwrap().success());
        assert!(
            finished_files(&cell.at(&out)) == undisturbed,
            "a run into `{out}` differs from an undisturbed one"
        );
    }
}

#[test]
fn a_run_killed_over_an_older_result_never_leaves_that_result_with_its_own_tables() {
    let cell = Cell::with_study(&format!("{SMALL}{ANALYSES}"));
    assert!(start(&cell, "out").wait().unwrap().success());
    let older = finished_files(&cell.at("out"));
    cell.file(
        "study.toml",
        format!(
            "{}{ANALYSES}",
            SMALL.replace("tolerance_um = 130", "tolerance_um = 10")
        ),
    );
    let begun = Instant::now();
    assert!(start(&cell, "newer").wait().unwrap().success());
    let whole_time = begun.elapsed();
    let newer = finished_files(&cell.at("newer"));

    for moment in 1..=4 {
        for (name, bytes) in &older {
            cell.file(&format!("out/{name}"), bytes);
        }
        let mut child = start(&cell, "out");
        std::thread::sleep(whole_time * moment / 5);
        child.kill().unwrap();
        child.wait().unwrap();
        let left = finished_files(&cell.at("out"));
        let answered = left.iter().any(|(name, _)| name == "result.json");
        assert!(
            !answered || left == older || left == newer,
            "after {moment}/5: files of two runs with an answer"
        );
    }
}

#[test]
fn a_run_killed_while_it_computes_has_written_nothing() {
    // A million points: it computes for a while after it has locked its folder, and before the first file.
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.2"));
    let mut child = start(&cell, "out");
    let begun = Instant::now();
    while !cell.at("out/.armill-lock").exists() {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before it locked its folder"
        );
        assert!(
            begun.elapsed() < Duration::from_secs(300),
            "no lock in five minutes"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success());
    assert_eq!(finished_files(&cell.at("out")), []);
}

#[test]
fn a_repeatedly_killed_search_ends_at_the_same_placement() {
    let ring = "[[analysis]]\nkind = \"path\"\nname = \"groove\"\ncircle.radius_mm = 60\nstep_mm = 20\n";
    let free =
        "[place]\nx_mm = [700, 1200]\nz_mm = [500, 1100]\ntilt_deg = [-30, 60]\nroll_deg = [-90, 90]\n";
    let cell = Cell::with_study(&format!("{SMALL}{ring}{free}"));
    let place = |out: &str| {
        let mut command = Command::new(ARMILL);
        command
            .args(["place", "study.toml", "--out", out])
            .current_dir(cell.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command.spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(place("undisturbed").wait().unwrap().success());
    let whole_time = begun.elapsed();
    // Only the reported number of rounds completed before may differ.
    let found = |out: &str| {
        let mut files = finished_files(&cell.at(out));
        for (name, bytes) in &mut files {
            let mut change = |key: &str| {
                let mut answer: serde_json::Value = serde_json::from_slice(bytes).unwrap();
                *answer.pointer_mut(key).unwrap() = 0.into();
                *bytes = answer.to_string().into_bytes();
            };
            match name.as_str() {
                "placement.json" => change("/rounds_taken_up"),
                // Its sum.
                "result.json" => change("/files/placement.json"),
                _ => {}
            }
        }
        files
    };
    let undisturbed = found("undisturbed");
    let mut ended = 0;
    for moment in moments() {
        let mut child = place("killed");
        std::thread::sleep(whole_time.mul_f64(moment));
        child.kill().unwrap();
        child.wait().unwrap();
        let left = finished_files(&cell.at("killed"));
        let half = |(name, bytes): &(String, Vec<u8>)| what_is_half(name, bytes);
        let half: Vec<String> = left
            .iter()
            .filter(|file| !is_journal(&file.0))
            .filter_map(half)
            .collect();
        assert!(half.is_empty(), "after {moment:.3}: {half:?}");
        if left.iter().any(|(name, _)| name == "result.json") {
            assert!(found("killed") == undisturbed, "after {moment:.3}");
            std::fs::remove_dir_all(cell.at("killed")).unwrap();
            ended += 1;
        }
    }
    println!("{ended} searches came to their end, over several kills each");
    assert!(place("killed").wait().unwrap().success());
    assert!(found("killed") == undisturbed);
}

/// Whether a file is the notes of a search that is on its way: it grows line by line, and a line cut short is left out.
fn is_journal(name: &str) -> bool {
    name.ends_with(".rounds")
}
