//! The command, for releases, without symbols.

use super::{Release, locked};
use crate::command::succeeded;
use std::path::PathBuf;

/// The oldest glibc that will do; that of manylinux2014.
const GLIBC: &str = "2.17";

/// Builds the command and gives its path.
///
/// # Errors
/// In a line, where it does not build.
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
    Ok(release
        .built()
        .join(format!("armill{}", std::env::consts::EXE_SUFFIX)))
}
