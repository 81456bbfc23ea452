//! Files are opened by addresses that are valid once and do not contain the token.

use serde_json::json;

use crate::client::{Answer, STUDY, Served, folder, serve};

/// As a browser requests an address: without the token.
fn opened(served: &Served, address: &str) -> Answer {
    let head = format!(
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n\r\n",
        served.port
    );
    served.raw(head.as_bytes())
}

fn address(served: &Served, path: &str) -> String {
    let answer = served.post("/api/tickets", json!({ "path": path }));
    assert_eq!(answer.status, 200, "{}", answer.text());
    answer.json()["address"].as_str().unwrap().to_owned()
}

#[test]
fn an_address_opens_one_file_once_without_the_token() {
    let folder = folder(STUDY);
    std::fs::create_dir(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("out/my report.html"), "<p>report").unwrap();
    let served = serve(folder.path());
    let to = address(&served, "out/my report.html");
    assert!(
        !to.contains(&served.token) && to.ends_with("/my%20report.html"),
        "{to}"
    );
    let report = opened(&served, &to);
    assert_eq!((report.status, report.text().as_str()), (200, "<p>report"));
    // No scripts of a file run with the rights of the page, and no copy stays in the cache.
    assert!(
        report
            .header("content-security-policy")
            .unwrap()
            .starts_with("sandbox;")
    );
    assert_eq!(report.header("cache-control").as_deref(), Some("no-store"));
    let again = opened(&served, &to);
    assert_eq!(again.status, 410);
    assert!(again.text().contains("Open the file again") && !again.text().contains("<p>report"));
    // Not another file by changing the address.
    let to = address(&served, "study.toml");
    assert_eq!(
        opened(&served, &to.replace("study.toml", "report.html")).text(),
        STUDY
    );
    assert_eq!(opened(&served, &to).status, 410);
}

#[test]
fn tickets_are_issued_with_the_token_for_files_of_the_folder_alone() {
    let folder = folder(STUDY);
    std::fs::write(folder.path().join(".hidden"), "secret").unwrap();
    let served = serve(folder.path());
    for path in ["no-such", "../study.toml", "/etc/passwd", ".hidden", "", "a//b"] {
        let refused = served.post("/api/tickets", json!({ "path": path }));
        assert_eq!(
            (refused.status, refused.kind().as_str()),
            (404, "not-found"),
            "{path}"
        );
    }
    let body = json!({ "path": "study.toml" }).to_string();
    let head = format!(
        "POST /api/tickets HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        served.port,
        body.len()
    );
    assert_eq!(
        served.raw(&[head.as_bytes(), body.as_bytes()].concat()).status,
        401
    );
    // A ticket is no token.
    let to = address(&served, "study.toml");
    let ticket = to.split('/').nth(2).unwrap().to_owned();
    let head = format!(
        "GET /api/study HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nAuthorization: Bearer {ticket}\r\nConnection: close\r\n\r\n",
        served.port
    );
    assert_eq!(served.raw(head.as_bytes()).status, 401);
    assert_eq!(
        opened(&served, &format!("/open/{}/study.toml", "0".repeat(32))).status,
        410
    );
    // Other sites are refused here, too.
    let head = format!(
        "GET {to} HTTP/1.1\r\nHost: evil.example:{}\r\nConnection: close\r\n\r\n",
        served.port
    );
    assert_eq!(served.raw(head.as_bytes()).status, 403);
    assert_eq!(opened(&served, &to).status, 200);
}
