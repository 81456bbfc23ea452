//! Jobs: to their end, cancelled, told as they go; and how the server stops.

use std::io::{BufRead, BufReader, Write};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::client::{PATIENCE, STUDY, Served, folder, serve};

/// The job, once it has ended.
fn ended(served: &Served, id: &str) -> Value {
    let begun = Instant::now();
    loop {
        let job = served.get(&format!("/api/jobs/{id}")).json();
        let state = job["state"].as_str().unwrap();
        if !matches!(state, "waiting" | "running") {
            return job;
        }
        assert!(begun.elapsed() < 2 * PATIENCE, "{job}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn begin(served: &Served, job: Value) -> String {
    let begun = served.post("/api/jobs", job);
    assert_eq!(begun.status, 202, "{}", begun.text());
    begun.json()["id"].as_str().unwrap().to_owned()
}

#[test]
fn a_run_leaves_its_files_and_the_answer_of_the_command() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let id = begin(&served, json!({ "kind": "run", "text": STUDY }));
    let job = ended(&served, &id);
    assert_eq!(job["state"], "done", "{job}");
    assert!(
        job["done"].as_u64().unwrap() > 0 && job["done"] == job["of"],
        "{}/{}",
        job["done"],
        job["of"]
    );
    let result = std::fs::read_to_string(folder.path().join("out/result.json")).unwrap();
    assert_eq!(job["answer"], serde_json::from_str::<Value>(&result).unwrap());
    let files: Vec<&str> = job["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_str)
        .collect();
    assert!(
        files.contains(&"out/report.html") && files.contains(&"out/plate.csv"),
        "{files:?}"
    );
    for file in files {
        assert_eq!(served.get(&format!("/api/files/{file}")).status, 200, "{file}");
    }
    let all = served.get("/api/jobs").json();
    assert_eq!(
        (all["jobs"][0]["id"].as_str(), &all["jobs"][0]["answer"]),
        (Some(id.as_str()), &Value::Null)
    );
}

#[test]
fn a_broken_study_becomes_a_job_that_failed_and_says_why() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let text = STUDY.replace("step_mm = 20", "step_mm = -1");
    let job = ended(&served, &begin(&served, json!({ "kind": "run", "text": text })));
    assert_eq!(job["state"], "failed");
    assert_eq!(job["error"]["problems"][0]["line"], 7);
    assert!(!folder.path().join("out/result.json").exists());
    let refused = served.post("/api/jobs", json!({ "kind": "dance", "text": STUDY }));
    assert_eq!(refused.status, 400);
    assert_eq!(served.get("/api/jobs/17").status, 404);
}

/// A search that takes long.
fn long_search() -> Value {
    json!({ "kind": "place", "text": STUDY, "options": { "place": { "x_mm": [700, 1300], "y_mm": [-400, 400], "z_mm": [400, 1200] } } })
}

#[test]
fn jobs_wait_for_each_other_and_are_cancelled() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let first = begin(&served, long_search());
    let second = begin(&served, long_search());
    let state = |id: &str| {
        served.get(&format!("/api/jobs/{id}")).json()["state"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    let begun = Instant::now();
    while state(&first) == "waiting" && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(state(&second), "waiting");
    assert_eq!(
        served.ask("DELETE", &format!("/api/jobs/{second}"), b"").json()["state"],
        "cancelled"
    );
    assert_eq!(
        served.ask("DELETE", &format!("/api/jobs/{first}"), b"").status,
        200
    );
    assert_eq!(ended(&served, &first)["state"], "cancelled");
    assert!(!folder.path().join("place/placement.json").exists());
    // What comes behind them is done.
    assert_eq!(
        ended(&served, &begin(&served, json!({ "kind": "run", "text": STUDY })))["state"],
        "done"
    );
}

#[test]
fn events_come_in_order_and_end_with_the_job() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let text = STUDY.replace("step_mm = 20", "step_mm = 1");
    let id = begin(
        &served,
        json!({ "kind": "run", "text": text, "options": { "no_pictures": true } }),
    );
    let mut stream = served.connect();
    let Served { port, token, .. } = &served;
    write!(stream, "GET /api/jobs/{id}/events?token={token} HTTP/1.1\r\nHost: localhost:{port}\r\nConnection: close\r\n\r\n").unwrap();
    let mut told: Vec<Value> = Vec::new();
    let mut names = 0;
    for line in BufReader::new(stream).lines() {
        let line = line.unwrap();
        names += usize::from(line == "event: job");
        told.extend(
            line.strip_prefix("data: ")
                .map(|data| serde_json::from_str(data).unwrap()),
        );
    }
    assert!(!told.is_empty() && names == told.len());
    let rank = |state: &Value| {
        ["waiting", "running", "done"]
            .iter()
            .position(|known| state == known)
            .unwrap()
    };
    for pair in told.windows(2) {
        assert!(rank(&pair[0]["state"]) <= rank(&pair[1]["state"]));
        assert!(pair[0]["seconds"].as_f64() <= pair[1]["seconds"].as_f64());
    }
    let last = told.last().unwrap();
    assert_eq!((&last["state"], &last["answer"]), (&json!("done"), &Value::Null));
}

#[test]
fn it_stops_while_a_job_computes_and_a_page_listens() {
    let folder = folder(STUDY);
    let mut served = serve(folder.path());
    let id = begin(&served, long_search());
    let mut stream = served.connect();
    write!(
        stream,
        "GET /api/jobs/{id}/events?token={} HTTP/1.1\r\nHost: localhost:{}\r\n\r\n",
        served.token, served.port
    )
    .unwrap();
    let mut first = String::new();
    BufReader::new(stream.try_clone().unwrap())
        .read_line(&mut first)
        .unwrap();
    assert!(first.contains("200"), "{first}");
    let idle = served.connect();
    let begun = Instant::now();
    served.server.take().unwrap().stop();
    assert!(begun.elapsed() < Duration::from_secs(15), "{:?}", begun.elapsed());
    assert!(std::net::TcpStream::connect(("127.0.0.1", served.port)).is_err());
    drop(idle);
    // What it left is whole: no half file, no hidden one.
    for entry in std::fs::read_dir(folder.path()).unwrap().flatten() {
        assert!(!entry.file_name().to_string_lossy().starts_with('.'));
    }
}
