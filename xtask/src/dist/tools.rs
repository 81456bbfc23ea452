//! What dist needs: looked for before anything is built, so that all that is missing is reported at once.
//!
//! maturin, zig, cargo-zigbuild and auditwheel are wheels of PyPI, and come into an environment of their own.

use super::target_folder;
use crate::command::succeeded;
use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The programs that were installed.
#[derive(Clone)]
pub struct Tools {
    /// Their folder.
    bin: PathBuf,
    /// Whether zig links.
    pub zig: bool,
}

/// What must be there: a command that succeeds where it is, and what to say where it is not.
const NEEDED: &[(&[&str], &str)] = &[
    (&["git", "--version"], "git"),
    (&["tar", "--sort=name", "--version"], "GNU tar"),
    (&["gzip", "--version"], "gzip"),
    (&["sha256sum", "--version"], "sha256sum (GNU coreutils)"),
    (
        &["python3", "-c", "import ensurepip, venv"],
        "Python 3 with venv (apt-get install python3-venv)",
    ),
    (&["node", "--version"], "Node 20 or later (https://nodejs.org)"),
    (&["npm", "--version"], "npm"),
];

/// Looks for what must be there.
///
/// # Errors
/// All that is not.
pub fn missing() -> Result<(), String> {
    let missing: Vec<&str> = NEEDED
        .iter()
        .filter(|(command, _)| !starts(command))
        .map(|(_, name)| *name)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    Err(format!("not installed, and needed: {}", missing.join("; ")))
}

/// Whether a command succeeds; its output is not shown.
fn starts(command: &[&str]) -> bool {
    let mut words = command.iter();
    let mut command = Command::new(words.next().unwrap_or(&""));
    command
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Installs the programs of PyPI.
///
/// # Errors
/// In a line: the environment cannot be made; pip cannot install.
pub fn installed(zig: bool) -> Result<Tools, String> {
    let venv = env::current_dir()
        .unwrap_or_default()
        .join(target_folder())
        .join("dist-venv");
    succeeded(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
    let bin = venv.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let mut pip = Command::new(bin.join("python"));
    pip.args([
        "-m",
        "pip",
        "install",
        "-q",
        "--disable-pip-version-check",
        "maturin>=1.9,<2",
    ]);
    if zig {
        pip.args(["ziglang", "cargo-zigbuild", "auditwheel"]);
    }
    succeeded(&mut pip)?;
    Ok(Tools { bin, zig })
}

impl Tools {
    /// One of them.
    pub fn command(&self, name: &str) -> Command {
        Command::new(self.bin.join(name))
    }

    /// The path to look for programs in, theirs first: cargo-zigbuild finds zig by the Python there.
    pub fn path(&self) -> OsString {
        let others = env::var_os("PATH").unwrap_or_default();
        let folders = [self.bin.clone()].into_iter().chain(env::split_paths(&others));
        env::join_paths(folders).unwrap_or(others)
    }
}
