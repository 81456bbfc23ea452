//! Connections: clients that do not read or that leave, and how long the head of a request may be.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::json;

use crate::client::{STUDY, Served, folder, read, serve};

/// More than the system keeps of an answer for a client that does not read.
const LARGE: u64 = 64 << 20;

/// Requests a file of so many bytes, and reads nothing yet.
fn requested_large(served: &Served, folder: &tempfile::TempDir) -> TcpStream {
    let file = std::fs::File::create(folder.path().join("large.csv")).unwrap();
    file.set_len(LARGE).unwrap();
    let mut stream = served.connect();
    let Served { port, token, .. } = served;
    write!(stream, "GET /api/files/large.csv HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\n\r\n").unwrap();
    stream
}

/// Reads to the end, with a pause behind each MiB; how much it was.
fn read_slowly(stream: &mut TcpStream, pause: Duration) -> u64 {
    let (mut piece, mut bytes, mut paused) = (vec![0; 1 << 16], 0, 0);
    loop {
        match stream.read(&mut piece) {
            Ok(0) => return bytes,
            Ok(read) => bytes += read as u64,
            Err(error) if error.kind() == ErrorKind::ConnectionReset => return bytes,
            Err(error) => panic!("still open: {error}"),
        }
        if bytes >> 20 > paused {
            paused = bytes >> 20;
            std::thread::sleep(pause);
        }
    }
}

#[test]
fn a_client_that_does_not_read_is_closed() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let mut stream = requested_large(&served, &folder);
    // The limit is 10 s: with room for a busy machine.
    std::thread::sleep(Duration::from_secs(20));
    let read = read_slowly(&mut stream, Duration::ZERO);
    assert!(read > 0 && read < LARGE, "{read} bytes");
    assert_eq!(served.get("/api/study").status, 200);
}

#[test]
fn a_client_that_reads_slowly_gets_the_whole_answer() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let mut stream = requested_large(&served, &folder);
    let begun = Instant::now();
    let read = read_slowly(&mut stream, Duration::from_millis(200));
    assert!(
        begun.elapsed() > Duration::from_secs(12),
        "longer than the limit for each write"
    );
    assert!(read > LARGE, "{read} bytes");
}

/// A request for the study of which the head has so many bytes.
fn with_head(served: &Served, bytes: usize) -> Vec<u8> {
    let Served { port, token, .. } = served;
    let begin = format!(
        "GET /api/study HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\nX-Long: "
    );
    let end = "\r\n\r\n";
    let head = begin.clone() + &"a".repeat(bytes - begin.len() - end.len()) + end;
    assert_eq!(head.len(), bytes);
    head.into_bytes()
}

#[test]
fn a_head_of_the_limit_passes_and_one_byte_more_does_not() {
    const LIMIT: usize = 65536;
    let folder = folder(STUDY);
    let served = serve(folder.path());
    assert_eq!(served.raw(&with_head(&served, LIMIT)).status, 200);
    assert_eq!(served.raw(&with_head(&served, LIMIT + 1)).status, 431);
    // However it is cut on its way.
    for (bytes, expected) in [(LIMIT, 200), (LIMIT + 1, 431)] {
        let mut stream = served.connect();
        for piece in with_head(&served, bytes).chunks(20_000) {
            stream.write_all(piece).unwrap();
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(read(&mut stream).status, expected, "{bytes} bytes in pieces");
    }
    // What follows a head is not part of it.
    let body = json!({ "text": STUDY }).to_string();
    let head = String::from_utf8(with_head(&served, LIMIT - 50)).unwrap();
    let head = head.replace("GET /api/study", "POST /api/check").replacen(
        "X-Long",
        &format!("Content-Length: {}\r\nX-Long", body.len()),
        1,
    );
    assert!(head.len() < LIMIT && head.len() + body.len() > LIMIT);
    assert_eq!(
        served.raw(&[head.as_bytes(), body.as_bytes()].concat()).status,
        200
    );
}

#[test]
fn a_request_of_the_limit_passes_and_one_byte_more_does_not() {
    const LIMIT: usize = 16 << 20;
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let body = json!({ "text": STUDY }).to_string();
    let padded = format!("{body}{}", " ".repeat(LIMIT - body.len()));
    assert_eq!(
        served.analysis("POST", "/api/check", padded.as_bytes()).status,
        200
    );
    // One byte more is refused as soon as it is announced.
    let Served { port, token, .. } = &served;
    let head = format!(
        "POST /api/check HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        LIMIT + 1
    );
    assert_eq!(served.raw(head.as_bytes()).status, 413);
    let text = |bytes: usize| format!("{STUDY}{}", "#".repeat(bytes - STUDY.len()));
    for (bytes, expected) in [(4 << 20, 200), ((4 << 20) + 1, 413)] {
        let answer = served.post("/api/check", json!({ "text": text(bytes) }));
        assert_eq!(answer.status, expected, "a text of {bytes} bytes");
    }
}

/// Requests a computation of seconds, with these bytes behind the request.
fn requested_long(served: &Served, behind: &str) -> TcpStream {
    let text = STUDY.replace("step_mm = 20", "step_mm = 0.3");
    let body = json!({ "text": text, "analysis": "plate" }).to_string();
    let mut stream = served.connect();
    let Served { port, token, .. } = served;
    write!(stream, "POST /api/answer HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nContent-Length: {}\r\n\r\n{body}{behind}", body.len()).unwrap();
    stream
}

#[test]
fn the_work_of_clients_that_have_left_ends() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    // All questions of a round together would take more than a minute on two processors.
    // hyper buffers the bytes behind a request, and then does not see that its client leaves.
    for behind in ["", "\r\n", "GET / HTTP/1.1\r\n"] {
        let requested: Vec<TcpStream> = (0..60).map(|_| requested_long(&served, behind)).collect();
        std::thread::sleep(Duration::from_millis(500));
        let begun = Instant::now();
        drop(requested);
        assert_eq!(served.get("/api/study").status, 200);
        assert!(
            begun.elapsed() < Duration::from_secs(15),
            "{behind:?}: {:?}",
            begun.elapsed()
        );
    }
}
