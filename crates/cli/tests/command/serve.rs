//! `armill serve` as a user starts it: the address first, and an end without harm. What it answers is tested in
//! `crates/web/tests`.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::cell::Cell;

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
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("armill"))
        .args(["serve", "--no-open"])
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
        "GET /api/study?token={token} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    if cfg!(unix) {
        let asked = Command::new("kill").arg(child.id().to_string()).status().unwrap();
        assert!(asked.success());
        let begun = Instant::now();
        let ended = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            assert!(begun.elapsed() < Duration::from_secs(20));
            std::thread::sleep(Duration::from_millis(20));
        };
        assert_eq!(ended.code(), Some(0));
    }
}

#[test]
fn a_port_that_is_taken_and_a_study_that_is_none_are_told() {
    let cell = Cell::new();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    cell.armill(&["serve", "--no-open", "--port", &port])
        .refused(&["cannot listen on 127.0.0.1", "another --port"]);
    cell.armill(&["serve", "--no-open", "no-such"])
        .refused(&["no study at no-such", "mh12-groove"]);
}
