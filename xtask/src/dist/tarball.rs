//! The tarball: one folder with the command and all that goes with it; and checksums.
//!
//! ```text
//! armill-VERSION-TARGET/
//!   armill                         the command, its page in it
//!   completions/  man/man1/        for shells; manual pages
//!   README.md CHANGELOG.md docs/   what to read
//!   studies/ robots/ materials/    examples and libraries, to look at: the command has them built in
//!   LICENSE-* THIRD-PARTY-LICENSES.md armill-VERSION.cdx.json
//! ```

use super::{Release, copy, target_folder, write};
use crate::command::{printed, succeeded};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

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

/// Shells, and how each names its script.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "armill.bash"),
    ("elvish", "armill.elv"),
    ("fish", "armill.fish"),
    ("powershell", "_armill.ps1"),
    ("zsh", "_armill"),
];

/// Packs the command, its help texts, and these other files.
///
/// # Errors
/// In a line: the command does not run; a file cannot be copied; tar fails.
pub fn pack(release: &Release, program: &Path, others: &[&Path]) -> Result<PathBuf, String> {
    let name = format!("armill-{}-{}", release.version, release.target);
    let above = target_folder().join("dist-tarball");
    match fs::remove_dir_all(&above) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            return Err(format!("{}: {error}", above.display()));
        }
        _ => {}
    }
    let folder = above.join(&name);
    copy(program, &folder.join(program.file_name().unwrap_or_default()))?;
    for file in others {
        copy(file, &folder.join(file.file_name().unwrap_or_default()))?;
    }
    let tracked = printed(Command::new("git").args(["ls-files", "-z"]).args(WITH_IT))?;
    for file in tracked.split_terminator('\0') {
        copy(Path::new(file), &folder.join(file))?;
    }
    let completions = folder.join("completions");
    fs::create_dir_all(&completions).map_err(|error| format!("{}: {error}", completions.display()))?;
    for (shell, file) in COMPLETIONS {
        let script = printed(Command::new(program).args(["completions", shell]))?;
        write(&completions.join(file), &script)?;
    }
    printed(Command::new(program).arg("man").arg(folder.join("man/man1")))?;

    let tarball = release.out.join(format!("{name}.tar.gz"));
    let mut tar = Command::new("tar");
    tar.args([
        "--sort=name",
        "--owner=0",
        "--group=0",
        "--numeric-owner",
        "--mode=u=rwX,go=rX",
        "--format=gnu",
    ])
    .arg(format!("--mtime=@{}", release.committed_s))
    .args(["--use-compress-program", "gzip -9n", "-cf"])
    .arg(&tarball)
    .arg("-C")
    .arg(&above)
    .arg(&name);
    succeeded(&mut tar)?;
    Ok(tarball)
}

/// Writes the checksums of all files, as `sha256sum --check` reads them.
///
/// # Errors
/// In a line: a file cannot be read, or the list not written.
pub fn checksums(release: &Release, files: &[PathBuf]) -> Result<PathBuf, String> {
    let names = files.iter().filter_map(|file| file.file_name());
    let sums = printed(Command::new("sha256sum").args(names).current_dir(&release.out))?;
    let list = release.out.join("SHA256SUMS");
    write(&list, &sums)?;
    Ok(list)
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
