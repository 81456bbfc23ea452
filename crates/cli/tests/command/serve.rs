//! `armill serve` as a user starts it: the address first, and an end without harm. What it answers is tested in
//! `crates/web/tests`.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::cell::{Cell, files_in};

/// After this a test gives up; nothing takes so long, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(600);

/// The server of this cell and its address; ended with the test, however it ends.
struct Served(Child, String);

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn served(cell: &Cell) -> Served {
    started(cell, |serve| serve.arg("--no-open"))
}

/// The server with further arguments or variables.
fn started(cell: &Cell, change: impl Fn(&mut Command) -> &mut Command) -> Served {
    let mut serve = Command::new(assert_cmd::cargo::cargo_bin!("armill"));
    let mut child = change(serve.arg("serve"))
        .current_dir(cell.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut address = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut address)
        .unwrap();
    Served(child, address.trim().to_owned())
}

#[test]
fn the_first_line_is_the_address_and_a_signal_ends_it_with_zero() {
    let cell = Cell::new();
    let Served(child, address) = &mut served(&cell);
    let (host, token) = address
        .strip_prefix("http://")
        .unwrap()
        .split_once("/?token=")
        .unwrap();
    assert!(host.starts_with("127.0.0.1:") && token.len() == 32, "{address}");
    let mut stream = TcpStream::connect(host).unwrap();
    write!(
        stream,
        "GET /api/study HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    if cfg!(unix) {
        let requested = Command::new("kill").arg(child.id().to_string()).status().unwrap();
        assert!(requested.success());
        let begun = Instant::now();
        let ended = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            assert!(begun.elapsed() < PATIENCE, "still running");
            std::thread::sleep(Duration::from_millis(20));
        };
        assert_eq!(ended.code(), Some(0));
    }
}

/// Waits until `happens`.
#[cfg(target_os = "linux")]
fn wait_until(what: &str, happens: impl Fn() -> bool) {
    let begun = Instant::now();
    while !happens() {
        assert!(begun.elapsed() < PATIENCE, "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// A server that opens the browser, in whose place a script notes its arguments, the modes of what it is given, and
/// then
/// its text; with the folder for temporary files.
#[cfg(target_os = "linux")]
fn with_browser(cell: &Cell) -> (Served, std::path::PathBuf) {
    use std::os::unix::fs::PermissionsExt;
    let (programs, temporary) = (cell.at("programs"), cell.at("temporary"));
    std::fs::create_dir_all(&programs).unwrap();
    std::fs::create_dir_all(&temporary).unwrap();
    let script = format!(
        "#!/bin/sh\n{{ echo \"$@\"; stat -c %a \"$1\" \"$(dirname \"$1\")\"; cat \"$1\"; }} > {0}/noted.new\nmv {0}/noted.new {0}/noted\n",
        cell.path().display()
    );
    let browser = programs.join("xdg-open");
    std::fs::write(&browser, script).unwrap();
    std::fs::set_permissions(&browser, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let server = started(cell, |serve| serve.env("PATH", &path).env("TMPDIR", &temporary));
    (server, temporary)
}

#[cfg(target_os = "linux")]
#[test]
fn no_command_line_contains_the_token_and_the_page_that_leads_to_it_is_private() {
    let cell = Cell::new();
    let (server, temporary) = with_browser(&cell);
    wait_until("no browser was opened", || cell.at("noted").exists());
    let noted = std::fs::read_to_string(cell.at("noted")).unwrap();
    let [arguments, file, folder, text] = noted.splitn(4, '\n').collect::<Vec<_>>()[..] else {
        panic!("{noted}")
    };
    let (_, token) = server.1.split_once("token=").unwrap();
    assert!(
        !arguments.contains(token) && arguments.starts_with(temporary.to_str().unwrap()),
        "{arguments}"
    );
    assert_eq!((file, folder), ("600", "700"));
    assert!(text.contains(&format!("url={}", server.1)), "{text}");
    // It exists until the browser has the address, whatever other clients request.
    let page = std::path::Path::new(arguments);
    let (host, _) = server.1.strip_prefix("http://").unwrap().split_once('/').unwrap();
    let analysis = |path: &str| {
        let mut stream = TcpStream::connect(host).unwrap();
        write!(
            stream,
            "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        )
        .unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        assert!(answer.starts_with(b"HTTP/1.1 200"), "{path}");
    };
    analysis("/");
    analysis("/?token=0123");
    assert!(page.exists());
    analysis(&format!("/?token={token}"));
    assert!(!page.exists() && !page.parent().unwrap().exists());
}

#[cfg(target_os = "linux")]
#[test]
fn the_page_of_a_killed_server_is_removed_by_a_later_one_and_that_of_an_ended_one_by_itself() {
    let cell = Cell::new();
    let pages = |temporary: &std::path::Path| {
        let entries = std::fs::read_dir(temporary)
            .unwrap()
            .flatten()
            .map(|entry| entry.path());
        entries
            .filter(|path| {
                path.file_name()
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .starts_with("armill-open-")
            })
            .collect::<Vec<_>>()
    };
    let (killed, temporary) = with_browser(&cell);
    wait_until("no browser was opened", || cell.at("noted").exists());
    drop(killed);
    let left = pages(&temporary);
    assert_eq!(left.len(), 1, "a kill leaves it");
    let old = std::time::SystemTime::now() - Duration::from_secs(300);
    std::fs::File::open(&left[0]).unwrap().set_modified(old).unwrap();
    std::fs::remove_file(cell.at("noted")).unwrap();
    let (mut ended, _) = with_browser(&cell);
    wait_until("no browser was opened", || cell.at("noted").exists());
    assert!(!left[0].exists());
    assert_eq!(pages(&temporary).len(), 1);
    assert!(
        Command::new("kill")
            .arg(ended.0.id().to_string())
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(ended.0.wait().unwrap().code(), Some(0));
    assert_eq!(pages(&temporary).len(), 0);
}

/// A defect found before: 520 clients without the token send requests and never read. As many send nothing.
#[cfg(unix)]
#[test]
fn clients_without_the_token_do_not_keep_out_one_that_has_it() {
    let cell = Cell::new();
    let server = served(&cell);
    let (host, _) = server.1.strip_prefix("http://").unwrap().split_once('/').unwrap();
    // So much that what answers it does not fit into what the system keeps.
    let requested = format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n").repeat(4000);
    let answered = || {
        let mut strangers = Vec::new();
        for number in 0..520 {
            let mut stranger = TcpStream::connect(host).unwrap();
            stranger.set_nonblocking(true).unwrap();
            if number % 2 == 0 {
                // What the system does not take is not sent.
                let _ = stranger.write(requested.as_bytes());
            }
            strangers.push(stranger);
        }
        let begun = Instant::now();
        assert_eq!(server.requested("GET", "/api/jobs", ""), json!({ "jobs": [] }));
        begun.elapsed()
    };
    // Before the time limits of the strangers, ten seconds, end any of their connections; if it waited for them, it would every time.
    let times: Vec<Duration> = (0..10)
        .map(|_| answered())
        .take_while(|time| *time > Duration::from_secs(8))
        .collect();
    assert!(times.len() < 10, "{times:?}");
}

#[test]
fn a_used_port_and_an_invalid_study_are_reported() {
    let cell = Cell::new();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    cell.armill(&["serve", "--no-open", "--port", &port])
        .refused(&["cannot listen on 127.0.0.1", "another --port"]);
    cell.armill(&["serve", "--no-open", "no-such"])
        .refused(&["no study at no-such", "mh12-groove"]);
}

/// Room along x and to tilt: enough rounds to be killed between.
const PLACED: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 0, 800], tilt_deg = 0, half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, -5, -5], [3, 5, 5]] }
posture = { branch = "front elbow-up" }
[[analysis]]
kind = "path"
name = "ring"
circle.radius_mm = 60
step_mm = 30
[place]
x_mm = [700, 1200]
tilt_deg = [-30, 60]
"#;

impl Served {
    /// The answer of the server in JSON.
    fn requested(&self, method: &str, path: &str, body: &str) -> Value {
        let (host, token) = self
            .1
            .strip_prefix("http://")
            .unwrap()
            .split_once("/?token=")
            .unwrap();
        let mut stream = TcpStream::connect(host).unwrap();
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
    }

    /// Begins the placement of the study.
    fn place(&self) -> String {
        let job = json!({ "kind": "place", "text": PLACED }).to_string();
        self.requested("POST", "/api/jobs", &job)["id"]
            .as_str()
            .unwrap()
            .to_owned()
    }

    /// The job, once it is done.
    fn done(&self, id: &str) -> Value {
        let begun = Instant::now();
        loop {
            let job = self.requested("GET", &format!("/api/jobs/{id}"), "");
            match job["state"].as_str().unwrap() {
                "done" => return job,
                "waiting" | "running" => assert!(begun.elapsed() < PATIENCE, "{job}"),
                other => panic!("{other}: {job}"),
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// Placement and result without the mark of an interruption, and every other file.
fn placed(cell: &Cell) -> ([Value; 2], Vec<(String, Vec<u8>)>) {
    let mut files = files_in(&cell.at("place"));
    let mut json = |name: &str| -> Value { serde_json::from_slice(&files.remove(name).unwrap()).unwrap() };
    let [mut placement, mut result] = [json("placement.json"), json("result.json")];
    placement["rounds_taken_up"] = 0.into();
    result["files"]["placement.json"] = 0.into();
    // What a kill leaves of a file under way is known by its name.
    let whole = files
        .into_iter()
        .filter(|(name, _)| !name.starts_with(".armill-"));
    ([placement, result], whole.collect())
}

#[test]
fn a_placement_continues_after_the_server_was_killed() {
    let whole = Cell::with_study(PLACED);
    let server = served(&whole);
    let id = server.place();
    let undisturbed = server.done(&id);
    assert_eq!(undisturbed["answer"]["rounds_taken_up"], 0);

    let killed = Cell::with_study(PLACED);
    let mut server = served(&killed);
    server.place();
    let begun = Instant::now();
    while !killed.at("place/place.rounds").exists() {
        assert!(begun.elapsed() < PATIENCE, "no round");
        std::thread::sleep(Duration::from_millis(1));
    }
    server.0.kill().unwrap();
    server.0.wait().unwrap();
    assert!(killed.at("place/place.rounds").exists() && !killed.at("place/placement.json").exists());
    let server = served(&killed);
    let id = server.place();
    let job = server.done(&id);
    assert!(job["answer"]["rounds_taken_up"].as_u64() >= Some(1), "{job}");
    assert!(
        placed(&killed) == placed(&whole),
        "the files differ from those of an undisturbed search"
    );

    // The command says the same.
    let command = Cell::with_study(PLACED);
    command.armill(&["place", "study.toml"]).fine();
    assert!(
        placed(&command) == placed(&whole),
        "the files differ from those of the command"
    );
}
