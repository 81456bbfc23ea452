//! A client that sends any request of a test, valid or not, and never waits for long.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use armill_web::{Options, Server};
use serde_json::Value;

/// Longest time that any test waits for one answer.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// A server with what is needed to send requests to it.
pub struct Served {
    pub server: Option<Server>,
    pub port: u16,
    pub token: String,
}

/// An answer.
#[derive(Debug)]
pub struct Answer {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|_| panic!("no JSON: {}", self.text()))
    }

    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// The kind of the error.
    pub fn kind(&self) -> String {
        self.json()["error"]["kind"].as_str().unwrap().to_owned()
    }

    pub fn header(&self, name: &str) -> Option<String> {
        self.head.lines().find_map(|line| {
            let (key, value) = line.split_once(':')?;
            key.eq_ignore_ascii_case(name).then(|| value.trim().to_owned())
        })
    }
}

/// Serves the study in this folder, or the example of this name.
pub fn serve(study: &Path) -> Served {
    let server = Server::start(&Options {
        study: Some(study.to_owned()),
        ..Options::default()
    })
    .unwrap();
    let rest = server.url().strip_prefix("http://127.0.0.1:").unwrap();
    let (port, token) = rest.split_once("/?token=").unwrap();
    Served {
        port: port.parse().unwrap(),
        token: token.to_owned(),
        server: Some(server),
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        if let Some(server) = self.server.take() {
            server.stop();
        }
    }
}

impl Served {
    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// What these bytes are answered.
    pub fn raw(&self, bytes: &[u8]) -> Answer {
        let mut stream = self.connect();
        stream.write_all(bytes).unwrap();
        read(&mut stream)
    }

    /// As the page does: with host, token and origin of its own.
    pub fn analysis(&self, method: &str, path: &str, body: &[u8]) -> Answer {
        let Served { port, token, .. } = self;
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
            body.len()
        );
        self.raw(&[head.as_bytes(), body].concat())
    }

    pub fn get(&self, path: &str) -> Answer {
        self.analysis("GET", path, b"")
    }

    pub fn post(&self, path: &str, body: Value) -> Answer {
        self.analysis("POST", path, body.to_string().as_bytes())
    }
}

/// Reads one answer to its end; the server closes behind it.
pub fn read(stream: &mut TcpStream) -> Answer {
    let mut bytes = Vec::new();
    let mut piece = [0; 65536];
    loop {
        match stream.read(&mut piece) {
            Ok(0) => break,
            Ok(read) => bytes.extend_from_slice(&piece[..read]),
            // What was sent before a connection was cut counts.
            Err(_) if !bytes.is_empty() => break,
            Err(error) => panic!("no answer: {error}"),
        }
    }
    let end = bytes
        .windows(4)
        .position(|four| four == b"\r\n\r\n")
        .unwrap_or(bytes.len());
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let status = head
        .split(' ')
        .nth(1)
        .and_then(|status| status.parse().ok())
        .unwrap_or(0);
    Answer {
        status,
        body: bytes.get(end + 4..).unwrap_or_default().to_vec(),
        head,
    }
}

/// A study that a user would keep, with a map, a circle and comments.
pub const STUDY: &str = "# my cell\nformat = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 100 # of the drawing\nload = { cases_n = [[3, 5, 5], [-40, 10, 0]] }\ntool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }\nplane = { centre_mm = [1000, 0, 800], half_size_mm = 100, step_mm = 20 } # the plate\n\n[[analysis]]\nkind = \"map\"\nname = \"plate\"\n\n[[analysis]]\nkind = \"path\"\nname = \"rim\"\ncircle = { radius_mm = 50 }\n";

/// A folder with this study.
pub fn folder(study: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("study.toml"), study).unwrap();
    folder
}
