//! What goes with the command in the tarball and in the Debian package: documents, examples, completions, manual pages.

use super::{copy, write};
use crate::command::printed;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Files and folders of the repository that go with the command, as git has them.
const WITH_IT: &[&str] = &[
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "docs",
    "materials",
    "robots",
    "studies",
    "validation/TABLE.md",
];

/// Copies documents, examples and libraries into a folder, without those of which `left_out` is true.
///
/// # Errors
/// In a line: a file cannot be copied; git does not answer.
pub fn documents(folder: &Path, left_out: fn(&str) -> bool) -> Result<(), String> {
    let tracked = printed(Command::new("git").args(["ls-files", "-z"]).args(WITH_IT))?;
    for file in tracked.split_terminator('\0').filter(|file| !left_out(file)) {
        copy(Path::new(file), &folder.join(file))?;
    }
    Ok(())
}

/// Writes the completions for a shell, as the command of this machine generates them.
///
/// # Errors
/// In a line: the command does not run; the file cannot be written.
pub fn completions(command: &Path, shell: &str, file: &Path) -> Result<(), String> {
    let script = printed(Command::new(command).args(["completions", shell]))?;
    let folder = file.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    write(file, &script)
}

/// Writes the manual pages into a folder.
///
/// # Errors
/// In a line: the command does not run; its list of files cannot be removed.
pub fn manual(command: &Path, folder: &Path) -> Result<(), String> {
    printed(Command::new(command).arg("man").arg(folder))?;
    // By this list the command recognises its own files at the next call; here there is none.
    let list = folder.join(".armill-files");
    fs::remove_file(&list).map_err(|error| format!("{}: {error}", list.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_of_the_command_exist() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for path in WITH_IT {
            assert!(root.join(path).exists(), "{path}");
        }
    }
}
