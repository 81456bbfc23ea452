//! Dependencies: licences, banned crates and origins, by the rules in `deny.toml`.
//!
//! By `deny.toml`; nothing is downloaded. The program must be installed: it is not built here.
//!
//! Known vulnerabilities (advisories) are checked where cargo-deny has a copy of their database, as old as that is.
//! The database comes from GitHub, no registry has it; without a copy the task reports that they were not checked.

use crate::COULD_NOT_RUN;
use crate::command::{cargo, expect_no_arguments, has_cargo_tool, run_in_place};
use std::env;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Description in the list of tasks.
pub const ABOUT: &str = "Checks licences, origins and (with a copy of the database) advisories of all dependencies with cargo-deny.";

/// Checks the rules of `deny.toml`, or reports how to install the program for it.
pub fn run(arguments: &[String]) -> ExitCode {
    if let Err(code) = expect_no_arguments("audit", arguments) {
        return code;
    }
    if !has_cargo_tool("deny") {
        eprintln!("cargo-deny is not installed: cargo install --locked cargo-deny@^0.20");
        return ExitCode::from(COULD_NOT_RUN);
    }
    let has_advisories = database().is_some_and(|folder| has_entries(&folder));
    let verdict = run_in_place(cargo(&words(has_advisories)));
    if !has_advisories {
        eprintln!("{NOT_CHECKED}");
    }
    verdict
}

/// The message where there is no database.
const NOT_CHECKED: &str = "advisories (known vulnerabilities) were NOT checked: their database is not on this machine; \
                           with access to github.com: cargo deny check advisories";

/// The words of cargo: what is checked; advisories by the copy of their database alone.
fn words(has_advisories: bool) -> Vec<&'static str> {
    match has_advisories {
        true => vec![
            "deny",
            "check",
            "--disable-fetch",
            "licenses",
            "bans",
            "sources",
            "advisories",
        ],
        false => vec!["deny", "check", "licenses", "bans", "sources"],
    }
}

/// The folder in which cargo-deny keeps databases of advisories.
fn database() -> Option<PathBuf> {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(env::var_os("HOME")?).join(".cargo")))?;
    Some(home.join("advisory-dbs"))
}

/// Whether a database was ever fetched into the folder.
fn has_entries(folder: &Path) -> bool {
    folder
        .read_dir()
        .is_ok_and(|mut entries| entries.any(|entry| entry.is_ok_and(|entry| entry.path().is_dir())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advisories_are_checked_where_their_database_is_and_reported_as_not_checked_elsewhere() {
        let folder = env::temp_dir().join(format!("armill-audit-{}", std::process::id()));
        assert!(!has_entries(&folder));
        std::fs::create_dir_all(folder.join("github.com-2f857891b7f43c59")).unwrap();
        assert!(has_entries(&folder));
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(words(true).contains(&"advisories") && words(true).contains(&"--disable-fetch"));
        assert!(!words(false).contains(&"advisories"));
        assert!(NOT_CHECKED.contains("NOT checked") && NOT_CHECKED.contains("cargo deny check advisories"));
    }
}
