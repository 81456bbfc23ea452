//! What the server refuses: strangers, other sites, paths that lead out, and requests that are too large.

use std::io::{Read, Write};
use std::time::{Duration, Instant};

use serde_json::json;

use crate::client::{PATIENCE, STUDY, Served, folder, read, serve};

/// A request with these lines behind the first.
fn request(served: &Served, first: &str, lines: &[&str]) -> u16 {
    let lines: String = lines.iter().map(|line| format!("{line}\r\n")).collect();
    let answer = served.raw(format!("{first} HTTP/1.1\r\n{lines}Connection: close\r\n\r\n").as_bytes());
    assert_eq!(
        answer.header("x-content-type-options").as_deref(),
        Some("nosniff"),
        "{first}"
    );
    assert!(answer.header("content-security-policy").is_some(), "{first}");
    answer.status
}

#[test]
fn without_the_token_there_is_no_api() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let host = format!("Host: 127.0.0.1:{}", served.port);
    let wrong: String = served.token.chars().rev().collect();
    let with = |token: &str| format!("Authorization: Bearer {token}");
    assert_eq!(request(&served, "GET /api/study", &[&host]), 401);
    assert_eq!(request(&served, "GET /api/study", &[&host, &with(&wrong)]), 401);
    assert_eq!(request(&served, "GET /api/study", &[&host, &with("")]), 401);
    assert_eq!(request(&served, "GET /api/study?token=", &[&host]), 401);
    assert_eq!(
        request(
            &served,
            &format!("GET /api/study?token={}0", served.token),
            &[&host]
        ),
        401
    );
    assert_eq!(request(&served, "GET /api/no-such", &[&host]), 401);
    assert_eq!(request(&served, "GET /api", &[&host]), 401);
    assert_eq!(
        request(&served, "PUT /api/files/x.csv", &[&host, "Content-Length: 0"]),
        401
    );
    assert!(!folder.path().join("x.csv").exists());
    // With it there is; the page itself contains nothing and needs none.
    assert_eq!(
        request(&served, "GET /api/study", &[&host, &with(&served.token)]),
        200
    );
    assert_eq!(
        request(
            &served,
            &format!("GET /api/study?token={}", served.token),
            &[&host]
        ),
        401,
        "an address never contains the token"
    );
    assert_eq!(request(&served, "GET /", &[&host]), 200);
    assert_eq!(
        request(&served, "GET /api/no-such", &[&host, &with(&served.token)]),
        404
    );
    assert_eq!(
        request(&served, "DELETE /api/study", &[&host, &with(&served.token)]),
        405
    );
}

#[test]
fn other_sites_are_refused_even_with_the_token() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let (port, token) = (served.port, format!("Authorization: Bearer {}", served.token));
    let host = format!("Host: 127.0.0.1:{port}");
    let foreign = [
        "Host: evil.example".to_owned(),
        format!("Host: evil.example:{port}"),
        "Host: 127.0.0.1".to_owned(),
        "Host: 127.0.0.1:1".to_owned(),
        format!("Host: 127.0.0.1:{port}.evil.example"),
        format!("Host: user@127.0.0.1:{port}"),
        format!("Host: [::1]:{port}"),
    ];
    for foreign in foreign {
        assert_eq!(
            request(&served, "GET /api/study", &[&foreign, &token]),
            403,
            "{foreign}"
        );
        assert_eq!(request(&served, "GET /", &[&foreign]), 403, "{foreign}");
    }
    // Two hosts, and a whole address in the first line.
    assert!(matches!(
        request_any(&served, &[&host, "Host: evil.example", &token]),
        400 | 403
    ));
    assert_eq!(
        request(&served, "GET http://evil.example/api/study", &[&host, &token]),
        403
    );
    for origin in [
        "http://evil.example",
        "null",
        "https://127.0.0.1",
        "http://127.0.0.1:1",
        "file://",
    ] {
        let origin = format!("Origin: {origin}");
        assert_eq!(
            request(&served, "GET /api/study", &[&host, &token, &origin]),
            403,
            "{origin}"
        );
    }
    for name in ["127.0.0.1", "localhost", "LocalHost"] {
        let (host, origin) = (
            format!("Host: {name}:{port}"),
            format!("Origin: http://{name}:{port}"),
        );
        assert_eq!(
            request(&served, "GET /api/study", &[&host, &token, &origin]),
            200,
            "{name}"
        );
    }
}

fn request_any(served: &Served, lines: &[&str]) -> u16 {
    let lines: String = lines.iter().map(|line| format!("{line}\r\n")).collect();
    served
        .raw(format!("GET /api/study HTTP/1.1\r\n{lines}Connection: close\r\n\r\n").as_bytes())
        .status
}

/// A folder next to a file that may not be read.
fn guarded() -> (tempfile::TempDir, std::path::PathBuf) {
    let outer = tempfile::tempdir().unwrap();
    let inner = outer.path().join("cell");
    std::fs::create_dir_all(inner.join("out")).unwrap();
    std::fs::write(outer.path().join("secret.csv"), "secret").unwrap();
    std::fs::write(inner.join("study.toml"), STUDY).unwrap();
    std::fs::write(inner.join("out/plate.csv"), "x_mm\n1\n").unwrap();
    std::fs::write(inner.join(".hidden"), "secret").unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outer.path().join("secret.csv"), inner.join("link.csv")).unwrap();
        std::os::unix::fs::symlink(outer.path(), inner.join("linked")).unwrap();
        std::os::unix::fs::symlink(inner.join(".hidden"), inner.join("shown.csv")).unwrap();
        std::os::unix::fs::symlink(outer.path().join("made.csv"), inner.join("made.csv")).unwrap();
    }
    (outer, inner)
}

#[test]
fn no_path_leads_out_of_the_folder() {
    let (outer, inner) = guarded();
    let served = serve(&inner);
    let secret = outer.path().join("secret.csv").display().to_string();
    let out = [
        "../secret.csv",
        "%2e%2e/secret.csv",
        "%2e%2e%2fsecret.csv",
        "..%2fsecret.csv",
        "..%5csecret.csv",
        "out/../../secret.csv",
        "out/%2e%2e/%2e%2e/secret.csv",
        "%252e%252e/secret.csv",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "//etc/passwd",
        ".hidden",
        "%2ehidden",
        "out/.armill-files",
        "link.csv",
        "linked/secret.csv",
        "shown.csv",
        "out",
        "out/",
        ".",
        "",
        "%00",
        "a%00.csv",
        "C:%5cWindows",
        "out//plate.csv",
        "./study.toml",
        &secret,
    ];
    for path in out {
        let answer = served.get(&format!("/api/files/{path}"));
        assert!(
            matches!(answer.status, 400 | 403 | 404 | 405),
            "{path}: {}",
            answer.status
        );
        assert!(!answer.text().contains("secret"), "{path}: {}", answer.text());
        let put = served.analysis("PUT", &format!("/api/files/{path}?replace=1"), b"mine");
        assert!(
            matches!(put.status, 400 | 403 | 404 | 405 | 409),
            "PUT {path}: {}",
            put.status
        );
    }
    let put = served.analysis("PUT", "/api/files/made.csv?replace=1", b"mine");
    assert_eq!(put.status, 409);
    assert!(!outer.path().join("made.csv").exists());
    assert_eq!(
        std::fs::read_to_string(outer.path().join("secret.csv")).unwrap(),
        "secret"
    );
    assert_eq!(std::fs::read_to_string(inner.join(".hidden")).unwrap(), "secret");
    assert_eq!(
        served
            .analysis("PUT", "/api/files/study.toml?replace=1", b"mine")
            .status,
        403
    );

    // The page's own paths lead nowhere else either.
    for path in ["/../Cargo.toml", "/%2e%2e/Cargo.toml", "//etc/passwd", "/src/"] {
        assert!(matches!(served.get(path).status, 400 | 404), "{path}");
    }
    let names: Vec<String> = served.get("/api/files").json()["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|file| file["name"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(names, ["out/plate.csv", "study.toml"]);
    // What is inside is read, and shown without scripts.
    let inside = served.get("/api/files/out/plate.csv");
    assert_eq!((inside.status, inside.text().as_str()), (200, "x_mm\n1\n"));
    assert!(
        inside
            .header("content-security-policy")
            .unwrap()
            .starts_with("sandbox")
    );
    let saved = served.get("/api/files/study.toml");
    assert_eq!(saved.header("content-disposition").as_deref(), Some("attachment"));
}

/// Files that are not whole yet.
fn unfinished(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let paths = std::fs::read_dir(folder)
        .unwrap()
        .flatten()
        .map(|entry| entry.path());
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "part"))
        .collect()
}

#[test]
fn files_of_a_killed_upload_are_removed_at_the_next_start() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let mut stream = served.connect();
    let head = format!(
        "PUT /api/files/record.csv HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\nContent-Length: 8\r\nConnection: close\r\n\r\n",
        served.port, served.token
    );
    stream.write_all(format!("{head}half").as_bytes()).unwrap();
    let begun = Instant::now();
    while unfinished(folder.path()).is_empty() {
        assert!(begun.elapsed() < PATIENCE, "no upload began");
        std::thread::sleep(Duration::from_millis(10));
    }
    // As a kill leaves it: of the same form, and open nowhere.
    let part = unfinished(folder.path()).remove(0);
    std::fs::copy(&part, folder.path().join(".armill-k1LL3d.part")).unwrap();
    let another = serve(folder.path());
    assert_eq!(unfinished(folder.path()), [part]);
    // The upload that is under way is not disturbed.
    stream.write_all(b"+end").unwrap();
    assert_eq!(read(&mut stream).status, 201);
    assert_eq!(
        std::fs::read(folder.path().join("record.csv")).unwrap(),
        b"half+end"
    );
    drop(another);
}

#[test]
fn files_are_uploaded_once_and_completely() {
    let (_outer, inner) = guarded();
    let served = serve(&inner);
    let put = |name: &str, body: &[u8]| served.analysis("PUT", &format!("/api/files/{name}"), body);
    let taken = put("part%201.ngc", b"G21\nG1 X1 F100\n");
    assert_eq!((taken.status, taken.json()["kind"].as_str()), (201, Some("path")));
    assert_eq!(
        std::fs::read(inner.join("part 1.ngc")).unwrap(),
        b"G21\nG1 X1 F100\n"
    );
    assert_eq!(put("part%201.ngc", b"x").status, 409);
    assert_eq!(put("part%201.ngc?replace=1", b"x").status, 201);
    assert_eq!(put(&"n".repeat(101), b"x").status, 403);
    assert_eq!(put("out/x.csv", b"x").status, 403);
    // A body that breaks off leaves nothing.
    let mut stream = served.connect();
    let head = format!(
        "PUT /api/files/half.csv HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\nContent-Length: 1000\r\n\r\nhalf",
        served.port, served.token
    );
    stream.write_all(head.as_bytes()).unwrap();
    let left = || unfinished(&inner).len();
    let begun = Instant::now();
    while left() == 0 {
        assert!(begun.elapsed() < PATIENCE, "no upload began");
        std::thread::sleep(Duration::from_millis(10));
    }
    drop(stream);
    let begun = Instant::now();
    while left() > 0 && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(left(), 0);
    assert!(!inner.join("half.csv").exists());
}

/// Peak memory of this process, kB; 0 where the system does not report it.
fn peak_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok())
        .unwrap_or(0)
}

#[test]
fn a_gigabyte_is_refused_without_being_kept() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let head = |method: &str, path: &str, more: &str| {
        format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\n{more}\r\n\r\n",
            served.port, served.token
        )
    };
    // Announced: refused before a byte of it.
    for (method, path) in [
        ("POST", "/api/answer"),
        ("PUT", "/api/study"),
        ("PUT", "/api/files/big.csv"),
    ] {
        let answer =
            served.raw(head(method, path, "Content-Length: 1073741824\r\nConnection: close").as_bytes());
        assert_eq!(
            (answer.status, answer.kind().as_str()),
            (413, "too-large"),
            "{method} {path}"
        );
    }
    // Not announced: refused as soon as it is too much.
    let before = peak_kb();
    let stream = served.connect();
    let mut writing = stream.try_clone().unwrap();
    let mut reading = stream;
    let sent = head("POST", "/api/answer", "Transfer-Encoding: chunked");
    let writer = std::thread::spawn(move || {
        let mut sent_bytes = 0_u64;
        let chunk = [
            format!("{:x}\r\n", 1 << 20).as_bytes(),
            &vec![b' '; 1 << 20],
            b"\r\n",
        ]
        .concat();
        if writing.write_all(sent.as_bytes()).is_ok() {
            while sent_bytes < 1 << 30 && writing.write_all(&chunk).is_ok() {
                sent_bytes += 1 << 20;
            }
        }
        sent_bytes
    });
    let answer = read(&mut reading);
    drop(reading);
    assert_eq!(answer.status, 413);
    assert!(writer.join().unwrap() < 1 << 28, "the server read on");
    assert!(peak_kb() - before < 200_000, "{} kB more", peak_kb() - before);
    let names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .flatten()
        .map(|entry| entry.file_name())
        .collect();
    assert_eq!(names, ["study.toml"]);
    // A text may be 4 MiB, a question 16.
    let long = served.post("/api/check", json!({ "text": " ".repeat((4 << 20) + 1) }));
    assert_eq!(long.status, 413);
}

#[test]
fn a_client_that_sends_slowly_is_disconnected() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let mut stream = served.connect();
    stream.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    let begun = Instant::now();
    stream.write_all(b"GET /api/study HTTP/1.1\r\nX-Slow: ").unwrap();
    let cut = loop {
        assert!(begun.elapsed() < PATIENCE, "still open");
        let mut piece = [0; 64];
        let ended = match stream.read(&mut piece) {
            Ok(_) => true,
            Err(error) => !matches!(
                error.kind(),
                std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
            ),
        };
        if ended || stream.write_all(b"a").is_err() {
            break begun.elapsed();
        }
    };
    assert!(cut > Duration::from_secs(5), "cut after {cut:?}");
    // The others are answered meanwhile and after.
    assert_eq!(served.get("/api/study").status, 200);
}

#[test]
fn a_stalled_body_is_answered_and_closed() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let begun = Instant::now();
    let stalled: Vec<_> = [("POST", "/api/check"), ("PUT", "/api/files/slow.csv")]
        .map(|(method, path)| {
            let mut stream = served.connect();
            write!(
                stream,
                "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {}\r\nContent-Length: 1000\r\nConnection: close\r\n\r\n{{\"text\":",
                served.port, served.token
            )
            .unwrap();
            stream
        })
        .into_iter()
        .collect();
    // The others are answered meanwhile.
    assert_eq!(served.get("/api/study").status, 200);
    for mut stream in stalled {
        assert_eq!(read(&mut stream).status, 408);
    }
    // Not at once, and not only at the limit of a whole body, which is a minute.
    let waited = begun.elapsed();
    assert!(
        waited > Duration::from_secs(5) && waited < Duration::from_secs(60),
        "{waited:?}"
    );
    // Nothing of it was kept.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn invalid_requests_are_refused_with_a_message() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    for body in [
        "",
        "{",
        "[]",
        "null",
        "{\"text\": 1}",
        "{\"text\": \"\", \"unknown\": 1}",
        "\u{0}",
    ] {
        let answer = served.analysis("POST", "/api/answer", body.as_bytes());
        assert_eq!(
            (answer.status, answer.kind().as_str()),
            (400, "invalid-input"),
            "{body}"
        );
    }
    let at = |at: serde_json::Value| {
        served
            .post(
                "/api/pose",
                json!({ "text": STUDY, "analysis": "plate", "at": at }),
            )
            .status
    };
    assert_eq!(at(json!({})), 400);
    assert_eq!(at(json!({ "joints_deg": [1, 2] })), 400);
    assert_eq!(at(json!({ "xyz_mm": [1e300, 0, 0] })), 400);
    assert_eq!(at(json!({ "y_mm": 1, "z_mm": 1, "point": 1 })), 400);
    let deep = format!("{{\"text\":{}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(served.analysis("POST", "/api/check", deep.as_bytes()).status, 400);
    // No HTTP at all.
    let mut stream = served.connect();
    stream.write_all(&[0x16, 3, 1, 2, 0, 1, 0]).unwrap();
    stream.write_all(b"\r\n\r\n").unwrap();
    let mut rest = Vec::new();
    let _ = stream.read_to_end(&mut rest);
    assert_eq!(served.get("/api/study").status, 200);
}
