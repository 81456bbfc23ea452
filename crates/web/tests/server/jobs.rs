//! Jobs: completed, cancelled, their progress; and how the server stops.

use std::io::{BufRead, BufReader, Write};
use std::time::{Duration, Instant};

use armill_core::nalgebra::Vector3;
use armill_core::watch::Watch;
use armill_measure::identify::{self, PointsModel, PriorModel, Question, Units};
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::file::placement::PlaceTable;
use armill_study::studies;
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
    assert_eq!(job["answer"], answer_in(&folder, "out"));
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
fn an_invalid_study_becomes_a_failed_job_with_its_problems() {
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

/// The file of the folder that a job wrote, as JSON.
fn written(folder: &tempfile::TempDir, name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.path().join(name)).unwrap()).unwrap()
}

/// The answer in `result.json` of a folder, without the list of its files.
fn answer_in(folder: &tempfile::TempDir, name: &str) -> Value {
    let mut result = written(folder, &format!("{name}/result.json"));
    let files = result.as_object_mut().unwrap().remove("files");
    assert!(files.is_some_and(|files| files.is_object()));
    result
}

#[test]
fn a_placement_ends_in_the_place_that_the_command_finds() {
    // A wide step and little room, so that it ends soon.
    let text = STUDY.replace("radius_mm = 50 }", "radius_mm = 50 }\nstep_mm = 30")
        + "[place]\nanalysis = \"rim\"\nx_mm = [950, 1050]\n";
    let folder = folder(&text);
    let found = studies::find(folder.path()).unwrap();
    let study = found.read().unwrap();
    let placing = PlacementSearch::new(&study, PlaceTable::default(), 1).unwrap();
    let command = placing
        .search(&mut Journal::none(), Watch::NONE, &|_| ())
        .unwrap();
    let served = serve(folder.path());
    let job = ended(&served, &begin(&served, json!({ "kind": "place", "text": text })));
    assert_eq!(job["state"], "done", "{job}");
    // Read as the job's is read: numbers may lose their last bit on that way.
    let answer = serde_json::to_string(&command.answer).unwrap();
    let answer: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(job["answer"], answer);
    assert_eq!(written(&folder, "place/placement.json"), answer);
    assert_eq!(job["best"], command.answer.sentences().join(" "));
    // The path at that place, as a run writes it.
    let result = written(&folder, "place/result.json");
    let um = |value: &Value| value.as_f64().unwrap();
    let apart = um(&result["paths"][0]["worst"]["in_plane_um"]) - um(&answer["recommended"]["cost_um"]);
    assert!(apart.abs() < 1e-6, "{apart} um");
    assert!(!folder.path().join("place/place.rounds").exists());
}

#[test]
fn a_search_of_postures_ends_with_its_files() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let options = json!({ "step_deg": 30, "objective": "mean" });
    let job = ended(
        &served,
        &begin(
            &served,
            json!({ "kind": "posture", "text": STUDY, "options": options }),
        ),
    );
    assert_eq!(job["state"], "done", "{job}");
    let search = &job["answer"]["paths"][0]["search"];
    assert_eq!(
        (&search["objective"], &search["turns"]),
        (&json!("mean"), &json!(12))
    );
    assert_eq!(answer_in(&folder, "posture"), job["answer"]);
    let table = std::fs::read_to_string(folder.path().join("posture/rim.csv")).unwrap();
    assert!(table.contains("turn_deg"));
    let wrong = json!({ "kind": "posture", "text": STUDY, "options": { "step_deg": 0 } });
    let job = ended(&served, &begin(&served, wrong));
    assert_eq!(job["state"], "failed", "{job}");
}

#[test]
fn springs_are_found_from_a_table_of_the_folder() {
    let folder = folder(STUDY);
    let robot = armill_study::library::robot("yaskawa/mh12")
        .unwrap()
        .unwrap()
        .robot;
    let question = Question {
        unknowns: "drives".to_owned(),
        points: PointsModel::Known,
        point_u: 0.2,
        prior: PriorModel::Typical,
        tool_point: Vector3::new(0.0, 0.06, 0.15),
        units: Units::Checked,
    };
    // The gauge shows what the drives of the robot file would show.
    let plan = identify::plan(&robot, &question, 14, [500.0, 1e-6]).unwrap();
    let filled = plan.table.lines().enumerate().map(|(line, text)| {
        let mut cells: Vec<&str> = text.split(',').collect();
        if line > 0 {
            cells.copy_within(13..16, 10);
        }
        cells.join(",") + "\n"
    });
    std::fs::write(folder.path().join("tests.csv"), filled.collect::<String>()).unwrap();
    let served = serve(folder.path());
    let options = json!({ "tests": "tests.csv", "unknowns": "drives", "tool_mm": [0, 60, 150] });
    let job = ended(
        &served,
        &begin(
            &served,
            json!({ "kind": "identify", "text": STUDY, "options": options }),
        ),
    );
    assert_eq!(
        (&job["state"], &job["files"]),
        (&json!("done"), &json!(["identify/robot.toml"])),
        "{job}"
    );
    let known = robot.compliance().unwrap();
    for (spring, known) in job["answer"]["springs"].as_array().unwrap().iter().zip(known) {
        let of = |key: &str| spring[key].as_f64().unwrap();
        assert!(
            (of("compliance_rad_per_n_m") - known.value).abs() < 4.0 * of("compliance_u_rad_per_n_m"),
            "{spring}"
        );
    }
    // The robot that it wrote is one: the study runs with it.
    let mine = STUDY.replace("yaskawa/mh12", "identify/robot.toml");
    assert_eq!(
        served
            .post("/api/answer", json!({ "text": mine, "analysis": "plate" }))
            .status,
        200
    );
    for tests in ["../tests.csv", "none.csv", "/etc/passwd"] {
        let job = json!({ "kind": "identify", "text": STUDY, "options": { "tests": tests } });
        assert_eq!(ended(&served, &begin(&served, job))["state"], "failed", "{tests}");
    }
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
        served
            .analysis("DELETE", &format!("/api/jobs/{second}"), b"")
            .json()["state"],
        "cancelled"
    );
    assert_eq!(
        served
            .analysis("DELETE", &format!("/api/jobs/{first}"), b"")
            .status,
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
    write!(stream, "GET /api/jobs/{id}/events HTTP/1.1\r\nAuthorization: Bearer {token}\r\nHost: localhost:{port}\r\nConnection: close\r\n\r\n").unwrap();
    let mut given: Vec<Value> = Vec::new();
    let mut names = 0;
    for line in BufReader::new(stream).lines() {
        let line = line.unwrap();
        names += usize::from(line == "event: job");
        given.extend(
            line.strip_prefix("data: ")
                .map(|data| serde_json::from_str(data).unwrap()),
        );
    }
    assert!(!given.is_empty() && names == given.len());
    let rank = |state: &Value| {
        ["waiting", "running", "done"]
            .iter()
            .position(|known| state == known)
            .unwrap()
    };
    for pair in given.windows(2) {
        assert!(rank(&pair[0]["state"]) <= rank(&pair[1]["state"]));
        assert!(pair[0]["seconds"].as_f64() <= pair[1]["seconds"].as_f64());
    }
    let last = given.last().unwrap();
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
        "GET /api/jobs/{id}/events HTTP/1.1\r\nAuthorization: Bearer {}\r\nHost: localhost:{}\r\n\r\n",
        served.token, served.port
    )
    .unwrap();
    let mut first = String::new();
    BufReader::new(stream.try_clone().unwrap())
        .read_line(&mut first)
        .unwrap();
    assert!(first.contains("200"), "{first}");
    let idle = served.connect();
    served.server.take().unwrap().stop();
    assert!(
        !folder.path().join("place/placement.json").exists(),
        "it did not wait until the search had ended"
    );
    assert!(std::net::TcpStream::connect(("127.0.0.1", served.port)).is_err());
    drop(idle);
    // What it left is whole: no half file, no hidden one.
    for entry in std::fs::read_dir(folder.path()).unwrap().flatten() {
        assert!(!entry.file_name().to_string_lossy().starts_with('.'));
    }
}

/// An open event stream of this job, and the status that it was answered with.
fn listening(served: &Served, id: &str) -> (std::net::TcpStream, u16) {
    let mut stream = served.connect();
    let Served { port, token, .. } = served;
    write!(
        stream,
        "GET /api/jobs/{id}/events HTTP/1.1\r\nAuthorization: Bearer {token}\r\nHost: localhost:{port}\r\n\r\n"
    )
    .unwrap();
    let mut first = String::new();
    BufReader::new(stream.try_clone().unwrap())
        .read_line(&mut first)
        .unwrap();
    let status = first.split(' ').nth(1).unwrap().parse().unwrap();
    (stream, status)
}

#[test]
fn event_streams_are_limited_and_closed_ones_make_room() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let ids: Vec<String> = (0..5).map(|_| begin(&served, long_search())).collect();
    let mut open: Vec<_> = (0..16).map(|_| listening(&served, &ids[0])).collect();
    assert!(open.iter().all(|(_, status)| *status == 200));
    let refused = |id: &str| {
        let answer = served.get(&format!("/api/jobs/{id}/events"));
        assert_eq!(
            (answer.status, answer.kind().as_str()),
            (429, "too-many"),
            "{}",
            answer.text()
        );
        answer.text()
    };
    assert!(refused(&ids[0]).contains("16 event streams of this job"));
    for id in &ids[1..4] {
        open.extend((0..16).map(|_| listening(&served, id)));
    }
    assert!(open.iter().all(|(_, status)| *status == 200));
    assert!(refused(&ids[4]).contains("64 event streams of all jobs"));
    // Other questions are answered, and a stream that is closed makes room.
    assert_eq!(served.get("/api/jobs").status, 200);
    open.clear();
    let begun = Instant::now();
    while listening(&served, &ids[4]).1 != 200 {
        assert!(begun.elapsed() < PATIENCE, "no room came back");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[cfg(unix)]
#[test]
fn results_are_written_inside_the_folder_only() {
    let outer = tempfile::tempdir().unwrap();
    let cell = outer.path().join("cell");
    std::fs::create_dir_all(cell.join("results")).unwrap();
    std::fs::create_dir(outer.path().join("elsewhere")).unwrap();
    std::fs::write(cell.join("study.toml"), STUDY).unwrap();
    let served = serve(&cell);
    let link = |name: &str, to: &std::path::Path| {
        let _ = std::fs::remove_file(cell.join(name));
        std::os::unix::fs::symlink(to, cell.join(name)).unwrap();
        let job = match name {
            "out" => json!({ "kind": "run", "options": { "analysis": "rim", "no_pictures": true } }),
            "posture" => json!({ "kind": "posture", "options": { "step_deg": 60 } }),
            "place" => json!({ "kind": "place", "options": { "place": { "x_mm": [1000, 1000] } } }),
            _ => json!({ "kind": "identify", "options": { "tests": "tests.csv", "tool_mm": [0, 0, 0] } }),
        };
        let mut job = job;
        job["text"] = STUDY.into();
        ended(&served, &begin(&served, job))
    };
    for name in ["out", "posture", "place", "identify"] {
        for to in ["elsewhere", "cell/../elsewhere", "missing"] {
            let job = link(name, &outer.path().join(to));
            assert_eq!(job["state"], "failed", "{to}: {job}");
            let message = job["error"]["message"].as_str().unwrap();
            assert!(
                message.contains(&format!("/{name}`"))
                    && message.contains("is a link that leads out of the folder"),
                "{message}"
            );
        }
    }
    assert_eq!(
        std::fs::read_dir(outer.path().join("elsewhere")).unwrap().count(),
        0
    );
    assert!(!outer.path().join("missing").exists());
    // A link inside the folder is fine, and a job does not choose its folder.
    assert_eq!(link("out", &cell.join("results"))["state"], "done");
    assert!(cell.join("results/result.json").exists());
    for out in ["../elsewhere", "/tmp", "results"] {
        let job = json!({ "kind": "run", "text": STUDY, "options": { "out": out } });
        assert_eq!(served.post("/api/jobs", job).status, 400, "{out}");
    }
}
