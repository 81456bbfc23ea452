//! A request without the right token learns nothing and changes nothing, and comes from this machine.

use std::io::ErrorKind;
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::time::Duration;

use crate::client::{Answer, STUDY, Served, folder, serve};

/// A request for this path and method with this token, or none, and a small body.
fn requested(served: &Served, request: &str, token: Option<&str>) -> Answer {
    let token = token.map_or_else(String::new, |token| format!("Authorization: {token}\r\n"));
    let head = format!(
        "{request} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{token}Content-Length: 4\r\nConnection: close\r\n\r\nmine",
        served.port
    );
    served.raw(head.as_bytes())
}

/// Status, headers but for date and duration, and body.
fn shown(answer: &Answer) -> (u16, String, String) {
    let other = |line: &&str| {
        !["date:", "server-timing:"]
            .iter()
            .any(|name| line.to_lowercase().starts_with(name))
    };
    let head: Vec<&str> = answer.head.lines().filter(other).collect();
    (answer.status, head.join("\n"), answer.text())
}

#[test]
fn tokens_of_any_other_length_or_form_are_wrong_and_the_reply_shows_nothing() {
    let folder = folder(STUDY);
    std::fs::write(folder.path().join("part.csv"), "x_mm\n1\n").unwrap();
    let served = serve(folder.path());
    let token = &served.token;
    let (shorter, cut) = token.split_at(token.len() - 1);
    let other = if cut == "0" { "1" } else { "0" };
    let wrong = [
        None,
        Some(format!("Bearer {shorter}")),
        Some(format!("Bearer {token}0")),
        Some(format!("Bearer {shorter}{other}")),
        Some(format!("Bearer {token} {token}")),
        Some(format!("Basic {token}")),
        Some(token.clone()),
        Some(format!("Bearer {}", token.repeat(1000))),
    ];
    for token in &wrong {
        let reply = |request: &str| shown(&requested(&served, request, token.as_deref()));
        let missing = reply("GET /api/files/missing.csv");
        assert_eq!(missing.0, 401, "{token:?}");
        for there in [
            "GET /api/files/part.csv",
            "GET /api/study",
            "GET /api/jobs",
            "GET /api/no-such",
        ] {
            assert_eq!(reply(there), missing, "{there} {token:?}");
        }
        for writing in [
            "PUT /api/study",
            "PUT /api/files/part.csv?replace=1",
            "PUT /api/files/new.csv",
            "POST /api/jobs",
            "POST /api/tickets",
            "DELETE /api/jobs/1",
        ] {
            assert_eq!(reply(writing).0, 401, "{writing} {token:?}");
        }
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).ok();
    assert_eq!(read("study.toml").as_deref(), Some(STUDY));
    assert_eq!(read("part.csv").as_deref(), Some("x_mm\n1\n"));
    assert_eq!(read("new.csv"), None);
    // The right one reads it.
    let right = requested(
        &served,
        "GET /api/files/part.csv",
        Some(&format!("Bearer {token}")),
    );
    assert_eq!((right.status, right.text().as_str()), (200, "x_mm\n1\n"));
}

/// All addresses 127.x.x.x are this machine on Linux: a server that listens on every address is found at each.
#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only on Linux are all addresses 127.x.x.x this machine"
)]
fn it_listens_on_one_address_alone() {
    let folder = folder(STUDY);
    let served = serve(folder.path());
    let at = |address: Ipv4Addr| {
        let address = SocketAddr::from((address, served.port));
        TcpStream::connect_timeout(&address, Duration::from_secs(10))
    };
    assert!(at(Ipv4Addr::LOCALHOST).is_ok());
    let other = at(Ipv4Addr::new(127, 0, 0, 2)).unwrap_err();
    assert_eq!(other.kind(), ErrorKind::ConnectionRefused, "{other}");
}
