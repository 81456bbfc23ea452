//! `armill completions` and `armill man`: what a shell and `man` take from the command.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::cell::Cell;

/// The commands that the help lists, without `help` itself.
fn commands() -> Vec<String> {
    let help = Cell::new().armill(&["--help"]).fine().out;
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let names: Vec<String> = list
        .lines()
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| Some(line.split_whitespace().next()?.to_owned()))
        .filter(|name| name != "help")
        .collect();
    assert!(names.len() > 20, "{help}");
    names
}

/// The long options in the help of a command.
fn long_options(command: &str) -> Vec<String> {
    let help = Cell::new().armill(&[command, "--help"]).fine().out;
    let starts = |line: &&str| line.trim_start().starts_with('-') && line.starts_with("  ");
    let of_line = |line: &str| {
        let (_, rest) = line.split_once("--")?;
        let end = rest.find(|c: char| c != '-' && !c.is_ascii_alphanumeric());
        Some(rest[..end.unwrap_or(rest.len())].to_owned())
    };
    help.lines().filter(starts).filter_map(of_line).collect()
}

/// Whether a program is on this machine; said where it is not.
fn is_here(program: &str) -> bool {
    let mut command = Command::new(program);
    command
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let here = command.status().is_ok_and(|status| status.success());
    if !here {
        println!("skipped: {program} is not installed");
    }
    here
}

#[test]
fn completions_know_every_command_and_flag() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let said = Cell::new().armill(&["completions", shell]).fine();
        for word in commands() {
            assert!(said.out.contains(&word), "no {word} for {shell}");
        }
        for word in ["no-pictures", "wrench-n"] {
            assert!(said.out.contains(word), "no {word} for {shell}");
        }
    }
    Cell::new().armill(&["completions", "tcsh"]).refused(&["tcsh"]);
}

#[test]
fn bash_reads_its_completions_and_offers_matching_names() {
    if !is_here("bash") {
        return;
    }
    let cell = Cell::new();
    let script = cell.armill(&["completions", "bash"]).fine().out;
    cell.file("armill.bash", &script);
    let requested = "source ./armill.bash; COMP_WORDS=(armill pose-); COMP_CWORD=1; _armill armill pose- armill; echo ${COMPREPLY[@]}";
    for arguments in [&["-n", "armill.bash"][..], &["--norc", "-c", requested]] {
        let ran = Command::new("bash")
            .args(arguments)
            .current_dir(cell.path())
            .output()
            .unwrap();
        assert!(
            ran.status.success() && ran.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&ran.stderr)
        );
        if arguments[0] == "--norc" {
            assert_eq!(String::from_utf8_lossy(&ran.stdout).trim(), "pose-accuracy");
        }
    }
}

#[test]
fn every_command_has_a_page_that_names_its_options() {
    let cell = Cell::new();
    let said = cell.armill(&["man", "man1"]).fine();
    assert!(said.out.contains("man1/armill.1\n") && said.out.contains("man1/armill-robots-import.1"));
    let whole = std::fs::read_to_string(cell.at("man1/armill.1")).unwrap();
    for command in commands() {
        let name = format!("armill\\-{}", command.replace('-', "\\-"));
        assert!(whole.contains(&name), "armill.1 does not name {name}");
        let page = std::fs::read_to_string(cell.at(&format!("man1/armill-{command}.1"))).unwrap();
        for option in long_options(&command) {
            // A hyphen that is to be seen as one.
            let option = format!("\\-\\-{}", option.replace('-', "\\-"));
            assert!(
                page.contains(&option),
                "armill-{command}.1 does not name {option}"
            );
        }
    }
    assert!(long_options("pose").contains(&"wrench-n".to_owned()));
    // They can be written again.
    let again = cell.armill(&["man", "man1"]).fine();
    assert_eq!(again.out, said.out);
}

#[test]
fn groff_sets_every_page_without_a_warning() {
    if !is_here("groff") {
        return;
    }
    let cell = Cell::new();
    let pages = cell.armill(&["man", "man1"]).fine().out;
    for page in pages.lines() {
        let mut groff = Command::new("groff");
        groff.args(["-ww", "-z", "-man", "-Tutf8", "-Kutf8", page]);
        let ran = groff.current_dir(cell.path()).output().unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success() && said.is_empty(), "{page}: {said}");
    }
}

#[test]
fn a_folder_where_no_page_can_be_written_is_reported() {
    let cell = Cell::new();
    cell.file("man1", "a file");
    cell.armill(&["man", "man1"]).refused(&["man1", "is a file"]);
    assert!(Path::new(&cell.at("man1")).is_file());
}
