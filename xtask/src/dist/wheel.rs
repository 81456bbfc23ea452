//! The Python package as a wheel, for every Python from 3.10 on: its native part uses the stable interface alone.
//!
//! It is built from the source package. The level of Linux is checked by auditwheel.

use super::{Release, emptied};
use crate::command::{printed, succeeded};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The oldest Linux that will do, as maturin names it: glibc 2.17, that of the command.
const LEVEL: &str = "manylinux2014";
/// The same, as auditwheel reports it, without the processor.
const REPORTED: &str = "manylinux_2_17_";

/// Builds the wheel from the unpacked source package and gives its path.
///
/// # Errors
/// In a line: it does not build, is not where it should be, or needs a newer Linux than stated.
pub fn build(release: &Release, sources: &Path) -> Result<PathBuf, String> {
    let folder = release.out.join("wheel");
    emptied(&folder)?;
    let mut maturin = release.tools.command("maturin");
    maturin
        .args([
            "build",
            "--release",
            "--locked",
            "--target",
            &release.target,
            "--out",
        ])
        .arg(&folder)
        .current_dir(sources);
    if release.tools.zig {
        maturin.args(["--zig", "--compatibility", LEVEL]);
    }
    succeeded(&mut release.building(maturin))?;
    let made = wheel_in(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let made = made.ok_or_else(|| format!("maturin left no wheel in {}", folder.display()))?;
    let wheel = release.out.join(made.file_name().unwrap_or_default());
    fs::rename(&made, &wheel).map_err(|error| format!("{}: {error}", wheel.display()))?;
    fs::remove_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    if release.tools.zig {
        let mut auditwheel = release.tools.command("python");
        auditwheel.args(["-m", "auditwheel", "show"]).arg(&wheel);
        let reported = printed(&mut auditwheel)?;
        if !is_at_level(&reported, &release.target) {
            return Err(format!("{} is not {LEVEL}:\n{reported}", wheel.display()));
        }
    }
    Ok(wheel)
}

/// Whether auditwheel reports the level for the processor of the target.
fn is_at_level(reported: &str, target: &str) -> bool {
    let processor = target.split('-').next().unwrap_or_default();
    // Lines are wrapped in the middle of sentences.
    let words = reported.split_whitespace().collect::<Vec<_>>().join(" ");
    let tag = format!("consistent with the following platform tag: \"{REPORTED}{processor}\"");
    words.contains(&tag)
}

/// The wheel in a folder.
fn wheel_in(folder: &Path) -> io::Result<Option<PathBuf>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "whl") {
            return Ok(Some(path));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wheel_for_a_newer_linux_or_another_processor_is_refused() {
        let reported = "\narmill-0.1.0.whl is\nconsistent with the following platform tag:\n\"manylinux_2_17_x86_64\".\n";
        assert!(is_at_level(reported, "x86_64-unknown-linux-gnu"));
        assert!(!is_at_level(reported, "aarch64-unknown-linux-gnu"));
        let newer = reported.replace("2_17", "2_34");
        assert!(!is_at_level(&newer, "x86_64-unknown-linux-gnu"));
    }
}
