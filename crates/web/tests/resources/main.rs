//! One server over a thousand studies: what is closed leaves neither memory nor open files behind.
//!
//! A program of its own, since memory and open files are those of the whole process.

// Tests and their helper functions fail by a panic.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]
#![cfg(target_os = "linux")]

#[allow(dead_code)]
#[path = "../server/client.rs"]
mod client;

use std::time::{Duration, Instant};

use serde_json::json;

use client::{PATIENCE, STUDY, Served, folder, serve};

/// Studies after which memory and files are noted: caches are then full, and more jobs have ended than are kept.
const FIRST: usize = 400;
const ALL: usize = 1000;
/// Growth that is not a leak: texts are so long that those of 600 studies would take 120 MB.
const MOST_GROWTH_KB: u64 = 60_000;

/// Resident memory of this process, kB, and how many files it has open.
fn resources() -> (u64, usize) {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))
        .unwrap();
    let kilobytes = line.split_whitespace().next().unwrap().parse().unwrap();
    (kilobytes, std::fs::read_dir("/proc/self/fd").unwrap().count())
}

/// Waits until `happens`.
fn wait_until(what: &str, happens: impl Fn() -> bool) {
    let begun = Instant::now();
    while !happens() {
        assert!(begun.elapsed() < 2 * PATIENCE, "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Begins a run, cancels it if requested, and waits for its end.
fn job(served: &Served, text: &str, cancelled: bool) {
    let options = json!({ "no_pictures": true });
    let begun = served.post(
        "/api/jobs",
        json!({ "kind": "run", "text": text, "options": options }),
    );
    assert_eq!(begun.status, 202, "{}", begun.text());
    let path = format!("/api/jobs/{}", begun.json()["id"].as_str().unwrap());
    if cancelled {
        served.analysis("DELETE", &path, b"");
    }
    let state = || served.get(&path).json()["state"].as_str().unwrap().to_owned();
    wait_until("a job does not end", || {
        !matches!(state().as_str(), "waiting" | "running")
    });
    // An event stream of a job that has ended ends too.
    assert_eq!(served.get(&format!("{path}/events")).status, 200);
}

#[test]
fn a_thousand_studies_leave_neither_memory_nor_open_files_behind() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let remark = "# a remark of a study that is as long as no other\n".repeat(4000);
    let mut after_first = (0, 0);
    for round in 0..ALL {
        let tolerance = format!("title = \"Study {round}\"\ntolerance_um = {}", 10 + round);
        let text = STUDY
            .replace("tolerance_um = 100 # of the drawing", &tolerance)
            .replace("step_mm = 20", "step_mm = 100");
        let text = format!("{text}{remark}");
        let checked = served.post("/api/check", json!({ "text": text }));
        assert_eq!(checked.status, 200, "{}", checked.text());
        for request in ["/api/answer", "/api/values", "/api/scene"] {
            let answer = served.post(request, json!({ "text": text, "analysis": "plate" }));
            assert_eq!(answer.status, 200, "{request}: {}", answer.text());
        }
        // One that is refused.
        let wrong = served.post(
            "/api/answer",
            json!({ "text": format!("{text}wrong = 1"), "analysis": "plate" }),
        );
        assert_ne!(wrong.status, 200);
        if round % 7 == 0 {
            job(&served, &text, round % 2 == 0);
        }
        if round + 1 == FIRST {
            after_first = resources();
        }
    }
    let (kilobytes, files) = resources();
    println!("kB and open files: {after_first:?} after {FIRST} studies, {kilobytes} and {files} after {ALL}");
    assert!(
        kilobytes < after_first.0 + MOST_GROWTH_KB,
        "{kilobytes} kB after {} kB",
        after_first.0
    );
    wait_until("files are open that were not", || resources().1 <= after_first.1);
    let jobs = served.get("/api/jobs").json();
    assert!(jobs["jobs"].as_array().map(Vec::len) <= Some(52), "{jobs}");
}
