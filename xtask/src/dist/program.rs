//! The command, for releases, without symbols and with the page.

use super::{Release, locked};
use crate::command::succeeded;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The oldest glibc that will do; that of manylinux2014.
const GLIBC: &str = "2.17";

/// The page that is built in.
const PAGE: &str = "web/dist";

/// Builds the command and gives its path.
///
/// # Errors
/// In a line: it does not build, or a file of the page is not in it.
pub fn build(release: &Release) -> Result<PathBuf, String> {
    let mut command = if release.tools.zig {
        let mut zig = release.tools.command("cargo-zigbuild");
        zig.args(["rustc", "--locked", "--target"])
            .arg(format!("{}.{GLIBC}", release.target));
        zig
    } else {
        let mut cargo = locked(&["rustc"]);
        cargo.args(["--target", &release.target]);
        cargo
    };
    command.args([
        "--release",
        "-p",
        "armill",
        "--bin",
        "armill",
        "--",
        "-C",
        "strip=symbols",
    ]);
    succeeded(&mut release.building(command))?;
    let program = release
        .built()
        .join(format!("armill{}", std::env::consts::EXE_SUFFIX));
    match left_out(&program, Path::new(PAGE)).map_err(|error| format!("{}: {error}", program.display()))? {
        Some(file) => Err(format!(
            "{} does not contain {}",
            program.display(),
            file.display()
        )),
        None => Ok(program),
    }
}

/// The first file of the page that the program does not contain, byte by byte.
fn left_out(program: &Path, page: &Path) -> io::Result<Option<PathBuf>> {
    let program = fs::read(program)?;
    for file in fs::read_dir(page)? {
        let file = file?.path();
        if !contains(&program, &fs::read(&file)?) {
            return Ok(Some(file));
        }
    }
    Ok(None)
}

/// Whether `whole` contains these bytes.
fn contains(whole: &[u8], part: &[u8]) -> bool {
    part.is_empty() || whole.windows(part.len()).any(|window| window == part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_found_only_if_it_is_complete() {
        for part in ["", "a", "bcd", "abcde"] {
            assert!(contains(b"abcde", part.as_bytes()), "{part}");
        }
        for part in ["bd", "abcdef", "e f"] {
            assert!(!contains(b"abcde", part.as_bytes()), "{part}");
        }
    }
}
