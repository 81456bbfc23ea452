//! Checks that every `console` block of README and guide shows the actual output.
//!
//! A page gets one folder, empty but for the URDFs of `validation/urdf-forward`. A line `$ ...` is a command of
//! `armill` (a shell runs it, so `>` and `&&` work);
//! the lines after it are its output, stdout and stderr in either order; `...` matches any lines.

use std::path::{Path, PathBuf};
use std::process::Command;

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Commands of a page with the output shown for each.
fn commands(page: &str) -> Vec<(String, Vec<String>)> {
    let mut commands: Vec<(String, Vec<String>)> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        match line {
            "```console" => inside = true,
            "```" => inside = false,
            _ if !inside => {}
            _ => match line.strip_prefix("$ ") {
                Some(command) => commands.push((command.to_owned(), Vec::new())),
                None => commands.last_mut().unwrap().1.push(line.to_owned()),
            },
        }
    }
    commands
}

/// Whether `shown` matches `real`, where `...` matches any lines.
fn fits(shown: &[String], real: &[&str]) -> bool {
    match shown.split_first() {
        None => real.is_empty(),
        Some((first, rest)) if first == "..." => (0..=real.len()).any(|skipped| fits(rest, &real[skipped..])),
        Some((first, rest)) => real
            .split_first()
            .is_some_and(|(line, more)| line == first && fits(rest, more)),
    }
}

fn run_page(path: &str) {
    let text = std::fs::read_to_string(repository().join(path)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let urdfs = "validation/urdf-forward";
    std::fs::create_dir_all(folder.path().join(urdfs)).unwrap();
    for name in ["mh12.urdf", "kr120r2500pro.urdf"] {
        let file = Path::new(urdfs).join(name);
        std::fs::copy(repository().join(&file), folder.path().join(&file)).unwrap();
    }
    let program = Path::new(assert_cmd::cargo::cargo_bin!("armill"))
        .parent()
        .unwrap()
        .to_owned();
    let search = std::env::join_paths(
        std::iter::once(program).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    for (command, shown) in commands(&text) {
        let ran = Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path())
            .env("PATH", search.as_ref().unwrap())
            .output()
            .unwrap();
        let (out, err) = (
            String::from_utf8(ran.stdout).unwrap(),
            String::from_utf8(ran.stderr).unwrap(),
        );
        let one = |a: &str, b: &str| format!("{a}{b}").lines().map(str::to_owned).collect::<Vec<_>>();
        let orders = [one(&out, &err), one(&err, &out)];
        let fitting = orders
            .iter()
            .any(|lines| fits(&shown, &lines.iter().map(String::as_str).collect::<Vec<_>>()));
        assert!(
            fitting,
            "{path}: `{command}` shows\n{}\nbut gives\n{out}{err}",
            shown.join("\n")
        );
    }
}

#[test]
fn readme_runs() {
    run_page("README.md");
}

#[test]
fn guide_runs() {
    for page in [
        "install",
        "predict",
        "your-robot",
        "measure-stiffness",
        "study-file",
        "robot-file",
        "results",
        "tool-path",
        "tool-path-words",
        "placement",
        "compare",
        "holes",
        "material-file",
        "measured-forces",
        "roundness",
        "ballbar",
        "calibrate",
        "budget",
        "live-page",
        "python",
        "cam-to-robot",
        "many-machines",
        "plotting",
        "ballbar-day",
        "how-far-to-trust-it",
        "README",
    ] {
        run_page(&format!("docs/guide/{page}.md"));
    }
}

#[test]
fn every_page_of_the_guide_is_run() {
    let pages = std::fs::read_dir(repository().join("docs/guide"))
        .unwrap()
        .count();
    assert_eq!(pages, 26, "name the new page in `guide_runs`");
}

#[test]
fn dots_match_any_lines_and_nothing_else_does() {
    let shown = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(fits(&shown("a\n...\nd"), &["a", "b", "c", "d"]));
    assert!(fits(&shown("a\n..."), &["a"]));
    assert!(!fits(&shown("a\nb"), &["a"]));
    assert!(!fits(&shown("a\n...\ne"), &["a", "b", "d"]));
}
