//! The Python package as a wheel, for every Python from 3.10 on: its native part uses the stable interface alone.

use super::{Release, copy, third_party};
use crate::command::succeeded;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The folder of the package.
const PACKAGE: &str = "python";

/// Builds the wheel with the licences in it and gives its path.
///
/// # Errors
/// In a line: it does not build, or is not where it should be.
pub fn build(release: &Release, third_party: &Path) -> Result<PathBuf, String> {
    // maturin takes licences from the folder of the package alone.
    let licences = Path::new(PACKAGE).join(third_party::NAME);
    copy(third_party, &licences)?;
    let built = built(release);
    let removed = fs::remove_file(&licences).map_err(|error| format!("{}: {error}", licences.display()));
    built.and_then(|wheel| removed.map(|()| wheel))
}

/// Builds the wheel and gives its path.
fn built(release: &Release) -> Result<PathBuf, String> {
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
        .current_dir(PACKAGE);
    if release.tools.zig {
        maturin.args(["--zig", "--compatibility", "manylinux2014"]);
    }
    succeeded(&mut release.building(maturin))?;
    let made = wheel_in(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let made = made.ok_or_else(|| format!("maturin left no wheel in {}", folder.display()))?;
    let wheel = release.out.join(made.file_name().unwrap_or_default());
    fs::rename(&made, &wheel).map_err(|error| format!("{}: {error}", wheel.display()))?;
    fs::remove_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(wheel)
}

/// Takes away what an earlier run left.
fn emptied(folder: &Path) -> Result<(), String> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(format!("{}: {error}", folder.display()))
        }
        _ => Ok(()),
    }
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
