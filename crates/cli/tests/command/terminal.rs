//! Stdout that closes, that is full, that is not a terminal; colour only if requested.

use std::io::Read;
use std::process::{Command, Stdio};

use crate::cell::{ARMILL, Cell, EVERY_KIND, SMALL};

/// A study with two problems, so that there is something to colour.
fn broken() -> Cell {
    Cell::with_study(&SMALL.replace("step_mm", "step").replace("tolerance_um", "limit"))
}

#[test]
fn a_closed_pipe_is_not_an_error() {
    let cell = Cell::with_study(&format!("{SMALL}{EVERY_KIND}"));
    for arguments in [
        &["pose", "yaskawa/mh12", "--at-mm", "1000,0,800", "--json"][..],
        &["robots", "yaskawa/mh12"],
        &["check", "--schema"],
        &["completions", "bash"],
        &["run", "study.toml", "--no-pictures", "--json"],
    ] {
        let mut command = Command::new(ARMILL);
        command
            .args(arguments)
            .current_dir(cell.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // Closed before a byte was read, as `| head -0` does.
        drop(child.stdout.take());
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}: {said}");
        assert!(
            !said.contains("panicked") && !said.contains("error:"),
            "{arguments:?}: {said}"
        );
    }
}

#[test]
fn characters_of_the_input_that_control_a_terminal_are_shown_as_escapes() {
    // TOML takes C1 and marks of direction as they are, all others by their escape.
    let hostile = "a\u{9b}31m\u{202e}b\u{2066}";
    let named = SMALL.replace("\"Small\"", &format!("\"{hostile}\\u001b]0;x\\u0007\""));
    let is_safe = |text: &[u8]| {
        let text = std::str::from_utf8(text).unwrap();
        !text.contains(|c: char| (c.is_control() && c != '\n') || ('\u{202a}'..='\u{2069}').contains(&c))
    };
    let cell = Cell::with_study(&named);
    let file = format!("{hostile}\u{1b}[31m.toml");
    for (text, arguments, code) in [
        (named.clone(), &["check", "study.toml"][..], 0),
        (named.clone(), &["check", "study.toml", "--json"], 0),
        // An excerpt, a message and a file name.
        (
            named.replace("tolerance_um", "limit"),
            &["check", "study.toml"],
            2,
        ),
        (
            named.replace("tolerance_um", "limit"),
            &["check", "study.toml", "--json"],
            2,
        ),
        (
            named.replace("yaskawa/mh12", &format!("{hostile}\\u001b[2J")),
            &["check", "study.toml"],
            2,
        ),
        (
            named.replace("tolerance_um", &format!("\"{hostile}\"")),
            &["check", "study.toml"],
            2,
        ),
        (SMALL.to_owned(), &["check", &file], 2),
        // A word that the options do not take.
        (SMALL.to_owned(), &["check", "study.toml", &file], 2),
        (SMALL.to_owned(), &[&file], 2),
    ] {
        std::fs::write(cell.path().join("study.toml"), text).unwrap();
        let output = Command::new(ARMILL)
            .args(arguments)
            .current_dir(cell.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(
            is_safe(&output.stdout),
            "{arguments:?}: {:?}",
            String::from_utf8_lossy(&output.stdout)
        );
        assert!(is_safe(&output.stderr), "{arguments:?}: {said:?}");
        if arguments.contains(&"--json") {
            serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap();
        }
    }
}

#[cfg(unix)]
#[test]
fn the_first_line_of_a_long_answer_can_be_taken_alone() {
    let script =
        format!("set -e; '{ARMILL}' completions bash | head -1; '{ARMILL}' robots yaskawa/mh12 | head -1");
    let output = Command::new("sh").args(["-c", &script]).output().unwrap();
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 2);
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_could_not_be_written_is_an_error() {
    let full = || Stdio::from(std::fs::File::options().write(true).open("/dev/full").unwrap());
    for arguments in [
        &["robots"][..],
        &["pose", "yaskawa/mh12", "--joints-deg", "0,0,0,0,0,0"],
        &["check", "--schema"],
    ] {
        let output = Command::new(ARMILL)
            .args(arguments)
            .stdout(full())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(
            said.contains("standard output") && !said.contains("panicked"),
            "{said}"
        );
    }
}

#[test]
fn without_a_terminal_nothing_is_coloured_and_no_bar_is_drawn() {
    let said = broken().armill(&["check", "study.toml"]).refused(&[]);
    assert!(!said.err.contains('\u{1b}'), "{:?}", said.err);
    let said = Cell::with_study(SMALL).armill(&["run", "study.toml"]).fine();
    let talk = |line: &str| line.starts_with("warning: ") || line == "results in out";
    assert!(
        said.err.lines().all(talk) && said.err.ends_with("results in out\n"),
        "{:?}",
        said.err
    );
    assert!(!said.out.contains('\u{1b}'), "{:?}", said.out);
    let said = Cell::new().armill(&["run", "--help"]).fine();
    assert!(!said.out.contains('\u{1b}'), "{:?}", said.out);
}

/// What armill writes on a terminal of its own, through script(1); `None` where that makes none.
#[cfg(target_os = "linux")]
fn on_a_terminal(cell: &Cell, command: &str, no_colour: Option<&str>) -> Option<String> {
    let mut script = Command::new("script");
    script
        .args(["-qec", &format!("'{ARMILL}' {command}"), "/dev/null"])
        .current_dir(cell.path());
    script
        .env_remove("NO_COLOR")
        .env("TERM", "xterm-256color")
        .stdin(Stdio::null());
    script.envs(no_colour.map(|value| ("NO_COLOR", value)));
    let output = script.output().ok()?;
    // A root without /dev/pts.
    let none = String::from_utf8_lossy(&output.stderr).contains("pseudo-terminal");
    (!none).then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Escape sequences of a colour: bold red, or any other.
#[cfg(target_os = "linux")]
fn is_coloured(text: &str) -> bool {
    text.split("\u{1b}[").skip(1).any(|rest| {
        let digits = rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';');
        digits.starts_with('m') && !rest.starts_with("0m") && !rest.starts_with('m')
    })
}

#[cfg(target_os = "linux")]
#[test]
fn on_a_terminal_problems_are_coloured_unless_no_color_is_set() {
    let cell = broken();
    let Some(coloured) = on_a_terminal(&cell, "check study.toml", None) else {
        println!("skipped: script(1) makes no terminal here, or is not installed");
        return;
    };
    assert!(coloured.contains("study.toml:4"), "{coloured:?}");
    assert!(is_coloured(&coloured), "{coloured:?}");
    let plain = on_a_terminal(&cell, "check study.toml", Some("1")).unwrap();
    assert!(!is_coloured(&plain), "{plain:?}");
    // An empty value does not count, as no-color.org has it.
    assert!(is_coloured(
        &on_a_terminal(&cell, "check study.toml", Some("")).unwrap()
    ));
}

#[cfg(target_os = "linux")]
#[test]
fn no_color_applies_to_argument_errors_and_the_progress_bar_too() {
    let cell = Cell::with_study(&format!("{SMALL}{EVERY_KIND}"));
    for command in ["fly", "--help", "run study.toml"] {
        let Some(said) = on_a_terminal(&cell, command, Some("1")) else {
            println!("skipped: script(1) makes no terminal here, or is not installed");
            return;
        };
        assert!(!said.is_empty() && !is_coloured(&said), "{command}: {said:?}");
    }
}
