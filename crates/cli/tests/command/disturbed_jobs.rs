//! Every command that writes files, killed half-way, on a full disk, and twice at once in one folder: what is there is final, and
//! the same command after it gives what an undisturbed one gives. `run` and `place` have tests of their own in `killed`.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::cell::{ARMILL, Cell};
use crate::{calibrate, compensate, identify, journal, learn, machined_part, motion};

/// A path with a table of placements.
const RING: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 40
plane = { centre_mm = [1000, 0, 800], tilt_deg = 0, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
load = { cases_n = [[3, 5, 5]] }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 20
"#;

/// A command with the files that it reads.
struct Job {
    cell: Cell,
    arguments: &'static [&'static str],
}

fn jobs() -> Vec<Job> {
    let of_study = |arguments| Job {
        cell: Cell::with_study(RING),
        arguments,
    };
    let of_folder = |folder, arguments| Job {
        cell: Cell::of(folder),
        arguments,
    };
    vec![
        of_study(&["posture", "study.toml", "--step-deg", "30", "--out", "out"]),
        of_study(&["advise", "study.toml", "--x-mm", "900,1100", "--out", "out"]),
        Job {
            cell: compensate::cell("file = \"ring.ngc\", limits = false", ""),
            arguments: &[
                "compensate",
                "study.toml",
                "--program",
                "ring.jbi",
                "--out",
                "out",
            ],
        },
        Job {
            cell: machined_part::slot(),
            arguments: &["run", "study.toml", "--out", "out"],
        },
        of_folder(
            learn::cell(1.0),
            &[
                "learn",
                "poses.csv",
                "--robot",
                "lever.toml",
                "--out",
                "mine.toml",
                "--drawing",
                "errors.svg",
            ],
        ),
        of_folder(
            journal::cell(),
            &[
                "journal",
                "journal.toml",
                "--work",
                "work.csv",
                "--next",
                "3",
                "--out",
                "mine.toml",
            ],
        ),
        of_folder(
            calibrate::folder(),
            &[
                "calibrate",
                "poses.csv",
                "--robot",
                "lever.toml",
                "--out",
                "mine.toml",
                "--residuals",
                "left.csv",
                "--drawing",
                "errors.svg",
            ],
        ),
        of_folder(
            identify::folder(),
            &[
                "identify",
                "tests.csv",
                "--robot",
                "yaskawa/mh12",
                "--tool-mm",
                "0,60,150",
                "--unknowns",
                "drives",
                "--out",
                "mine.toml",
            ],
        ),
        of_folder(
            motion::folder(),
            &[
                "motion",
                "stops.csv",
                "--compare",
                "slow.csv",
                "--robot",
                "arm.toml",
                "--tool-mm",
                "0,0,0",
                "--zone-mm",
                "0",
                "--out",
                "mine.toml",
            ],
        ),
    ]
}

/// Shares of the time of an undisturbed run at which a job is killed; `ARMILL_KILLS` is their number.
fn moments() -> Vec<f64> {
    let count = std::env::var("ARMILL_KILLS").map_or(2, |count| count.parse().expect("ARMILL_KILLS=100"));
    (0..count)
        .map(|k| (0.9 + f64::from(k) * 0.618_033_988_75).fract())
        .collect()
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(ARMILL);
    command.args(arguments).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

/// All files below a folder by their paths, but those whose names show that they are of armill alone: lock, list of its files, unfinished.
fn tree(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy();
            if path.is_dir() {
                folders.push(path);
            } else if !name.starts_with(".armill-") {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                files.insert(name, std::fs::read(path).unwrap());
            }
        }
    }
    files
}

/// The same files, but for how many rounds of a search an earlier run had done: a killed search is taken up.
fn results(mut files: BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    files.retain(|name, _| !name.ends_with(".rounds"));
    for (name, bytes) in &mut files {
        if name.ends_with(".json") {
            let mut answer: Value =
                serde_json::from_slice(bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
            forget_rounds(&mut answer);
            *bytes = answer.to_string().into_bytes();
        }
    }
    files
}

fn forget_rounds(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            // And the sums of the files that have it.
            keys.retain(|key, _| key != "rounds_taken_up" && key != "files");
            keys.values_mut().for_each(forget_rounds);
        }
        Value::Array(items) => items.iter_mut().for_each(forget_rounds),
        _ => {}
    }
}

/// A new folder with these files.
fn with(files: &BTreeMap<String, Vec<u8>>) -> Cell {
    let cell = Cell::new();
    for (name, bytes) in files {
        cell.file(name, bytes);
    }
    cell
}

/// What a job gives that nothing disturbs.
struct Undisturbed {
    arguments: &'static [&'static str],
    given: BTreeMap<String, Vec<u8>>,
    results: BTreeMap<String, Vec<u8>>,
    took: Duration,
}

impl Undisturbed {
    fn of(Job { cell, arguments }: &Job) -> Undisturbed {
        let given = tree(cell.path());
        let begun = Instant::now();
        let ended = start(cell.path(), arguments).wait().unwrap();
        let took = begun.elapsed();
        assert!(ended.success(), "{arguments:?}");
        let results = results(tree(cell.path()));
        assert!(results.len() > given.len(), "{arguments:?} writes nothing");
        Undisturbed {
            arguments,
            given,
            results,
            took,
        }
    }

    /// How many files a disturbed job has left; each of them is final.
    fn left(&self, folder: &Path, disturbance: &str) -> usize {
        let left = results(tree(folder));
        for (name, bytes) in &left {
            assert!(
                self.results.get(name) == Some(bytes),
                "{:?} {disturbance}: `{name}` is not final",
                self.arguments
            );
        }
        left.len() - self.given.len()
    }

    /// The same command after a disturbance gives the same files.
    fn again(&self, folder: &Path, disturbance: &str) {
        let again = start(folder, self.arguments).wait().unwrap();
        assert!(again.success(), "{:?} again after {disturbance}", self.arguments);
        let differ = results(tree(folder)) != self.results;
        assert!(
            !differ,
            "{:?} again after {disturbance} gives other files",
            self.arguments
        );
    }
}

#[test]
fn a_killed_job_leaves_final_files_and_can_be_repeated() {
    for job in jobs() {
        let undisturbed = Undisturbed::of(&job);
        let mut left_by_kills = Vec::new();
        for moment in moments() {
            let killed = with(&undisturbed.given);
            let mut child = start(killed.path(), job.arguments);
            std::thread::sleep(undisturbed.took.mul_f64(moment));
            child.kill().unwrap();
            child.wait().unwrap();
            let disturbance = format!("a kill at {moment:.3}");
            left_by_kills.push(undisturbed.left(killed.path(), &disturbance));
            undisturbed.again(killed.path(), &disturbance);
        }
        let of = undisturbed.results.len() - undisturbed.given.len();
        println!(
            "{}: files left by each kill {left_by_kills:?} of {of}",
            job.arguments[0]
        );
    }
}

/// A limit of the size of files stands for a disk that becomes full: the system refuses the rest of the bytes.
#[cfg(target_os = "linux")]
#[test]
fn on_a_full_disk_a_job_says_so_and_can_be_repeated() {
    for job in jobs() {
        let undisturbed = Undisturbed::of(&job);
        let full = with(&undisturbed.given);
        let output = Command::new("sh")
            // In units of 512 bytes. Without the signal the program sees the refusal itself, as on a full disk.
            .args(["-c", "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"", ARMILL])
            .args(job.arguments)
            .current_dir(full.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        let disturbance = format!("on a full disk, which says: {said}");
        assert_eq!(output.status.code(), Some(2), "{:?} {disturbance}", job.arguments);
        assert!(
            said.contains("cannot write") && !said.contains("panicked"),
            "{:?} {disturbance}",
            job.arguments
        );
        undisturbed.left(full.path(), &disturbance);
        undisturbed.again(full.path(), &disturbance);
    }
}

#[test]
fn two_jobs_at_once_in_one_folder_leave_the_files_of_one() {
    for job in jobs() {
        let undisturbed = Undisturbed::of(&job);
        let shared = with(&undisturbed.given);
        let spawn = || {
            let mut command = Command::new(ARMILL);
            command.args(job.arguments).current_dir(shared.path());
            command.stdout(Stdio::null()).stderr(Stdio::piped());
            command.spawn().unwrap()
        };
        let ended = [spawn(), spawn()].map(|child| child.wait_with_output().unwrap());
        let said: Vec<_> = ended
            .iter()
            .map(|output| String::from_utf8_lossy(&output.stderr))
            .collect();
        let codes = ended.each_ref().map(|output| output.status.code());
        assert!(
            codes.contains(&Some(0)) && codes.iter().all(|code| matches!(code, Some(0 | 2))),
            "{:?}: {codes:?}, {said:?}",
            job.arguments
        );
        let differ = results(tree(shared.path())) != undisturbed.results;
        assert!(
            !differ,
            "two of {:?} give other files: {codes:?}, {said:?}",
            job.arguments
        );
    }
}
