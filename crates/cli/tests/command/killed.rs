//! A study killed half-way: no file of it is half-written, and a run after it gives what an undisturbed one gives.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::cell::{ARMILL, Cell, SMALL, files_in, what_is_half};

/// Moments at which a run is killed, evenly over the time that an undisturbed one takes.
const MOMENTS: u32 = 8;

/// Two asks: enough files to be killed among, few enough to be drawn often.
const ASKS: &str = r#"
[[ask]]
kind = "map"
name = "plate"

[[ask]]
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

/// Files under their own names; a temporary one that a killed run could not remove is told apart by its name.
fn finished_files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let temporary = |name: &str| name.starts_with(".armill-");
    files_in(folder)
        .into_iter()
        .filter(|(name, _)| !temporary(name))
        .collect()
}

#[test]
fn a_killed_run_leaves_no_half_file_and_can_be_repeated() {
    let cell = Cell::with_study(&format!("{SMALL}{ASKS}"));
    let begun = Instant::now();
    assert!(start(&cell, "undisturbed").wait().unwrap().success());
    let whole_time = begun.elapsed();
    let undisturbed = finished_files(&cell.at("undisturbed"));
    assert!(undisturbed.len() > 20);

    let mut caught = Vec::new();
    for moment in 0..MOMENTS {
        let out = format!("killed {moment}");
        let mut child = start(&cell, &out);
        std::thread::sleep(whole_time * moment / MOMENTS);
        child.kill().unwrap();
        child.wait().unwrap();
        let left = finished_files(&cell.at(&out));
        let half: Vec<String> = left
            .iter()
            .filter_map(|(name, bytes)| what_is_half(name, bytes))
            .collect();
        assert!(half.is_empty(), "after {moment}/{MOMENTS}: {half:?}");
        // What is there is what would have been there: every file is final when it gets its name.
        for (name, bytes) in &left {
            let whole = undisturbed.iter().find(|(other, _)| other == name);
            assert!(
                whole.is_some_and(|(_, whole)| whole == bytes),
                "after {moment}/{MOMENTS}: {name}"
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
fn a_run_killed_over_an_older_answer_never_leaves_that_answer_beside_its_own_tables() {
    let cell = Cell::with_study(&format!("{SMALL}{ASKS}"));
    assert!(start(&cell, "out").wait().unwrap().success());
    let older = finished_files(&cell.at("out"));
    cell.file(
        "study.toml",
        format!("{}{ASKS}", SMALL.replace("limit_um = 130", "limit_um = 10")),
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
    // A million points: several seconds of work before the first file.
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.2"));
    for wait in [300, 900] {
        let mut child = start(&cell, "out");
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().unwrap();
        assert!(!child.wait().unwrap().success(), "it was over within {wait} ms");
        assert_eq!(finished_files(&cell.at("out")), []);
    }
}
