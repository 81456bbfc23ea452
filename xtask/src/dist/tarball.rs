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

use super::{Release, accompanying, copy, emptied, target_folder, write};
use crate::command::{printed, succeeded};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Shells, and how each names its script.
const COMPLETIONS: &[(&str, &str)] = &[
    ("bash", "armill.bash"),
    ("elvish", "armill.elv"),
    ("fish", "armill.fish"),
    ("powershell", "_armill.ps1"),
    ("zsh", "_armill"),
];

/// Packs the command, its help texts, and these other files; `runs` is the same command for this machine, which
/// generates the texts.
///
/// # Errors
/// In a line: the command does not run; a file cannot be copied; tar fails.
pub fn pack(release: &Release, program: &Path, runs: &Path, others: &[&Path]) -> Result<PathBuf, String> {
    let name = name(&release.version, &release.target);
    let above = target_folder().join("dist-tarball");
    emptied(&above)?;
    let folder = above.join(&name);
    copy(program, &folder.join(program.file_name().unwrap_or_default()))?;
    for file in others {
        copy(file, &folder.join(file.file_name().unwrap_or_default()))?;
    }
    accompanying::documents(&folder, |_| false)?;
    for (shell, file) in COMPLETIONS {
        accompanying::completions(runs, shell, &folder.join("completions").join(file))?;
    }
    accompanying::manual(runs, &folder.join("man/man1"))?;

    archive(release, &above, &name)
}

/// Packs the folder `above/name` and gives the path of the file: one folder gives the same bytes everywhere.
///
/// # Errors
/// In a line: tar fails.
pub fn archive(release: &Release, above: &Path, name: &str) -> Result<PathBuf, String> {
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
    .arg(above)
    .arg(name);
    succeeded(&mut tar)?;
    Ok(tarball)
}

/// The name of its folder; with `.tar.gz` that of the file.
fn name(version: &str, target: &str) -> String {
    format!("armill-{version}-{target}")
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
    use std::fs;
    use toml::de::DeTable;

    /// What `cargo binstall` makes of a template.
    fn filled(template: &str, target: &str) -> String {
        let values = [
            ("{ repo }", "https://example.org/armill"),
            ("{ version }", "0.1.0"),
            ("{ target }", target),
            ("{ bin }", "armill"),
            ("{ binary-ext }", ""),
        ];
        let text = values
            .iter()
            .fold(template.to_owned(), |text, (key, value)| text.replace(key, value));
        assert!(
            !text.contains(['{', '}']),
            "{text} has keys that are not known here"
        );
        text
    }

    #[test]
    fn binstall_looks_for_the_file_that_is_made() {
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/cli/Cargo.toml");
        let manifest = fs::read_to_string(manifest).unwrap();
        let manifest = DeTable::parse(&manifest).unwrap();
        let value = |key| {
            let package = manifest.get_ref().get("package")?.get_ref().get("metadata")?;
            let binstall = package.get_ref().get("binstall")?;
            binstall.get_ref().get(key)?.get_ref().as_str().map(str::to_owned)
        };
        for target in ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"] {
            let name = name("0.1.0", target);
            let address = filled(&value("pkg-url").unwrap(), target);
            assert_eq!(address.rsplit('/').next().unwrap(), format!("{name}.tar.gz"));
            let program = filled(&value("bin-dir").unwrap(), target);
            assert_eq!(program, format!("{name}/armill"));
        }
        assert_eq!(value("pkg-fmt").unwrap(), "tgz");
    }
}
