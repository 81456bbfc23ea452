//! The sources of the Python package in one file (sdist), from which `pip install` builds it with Rust.
//!
//! It contains the crates that the package needs, the lock file, the built page and the licences. The wheel of the
//! release is built from it. Files that crates embed through links are looked for by name: cargo may reuse what it made of those in the
//! repository.

use super::{Release, copy, emptied, target_folder, third_party};
use crate::command::succeeded;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the package.
const PACKAGE: &str = "python";
/// What must be in the sources: the built page, without which `armill serve` of the installed package would have none, one file of
/// each folder that is embedded, the licences, the lock file.
const NEEDED: &[&str] = &[
    "crates/web/dist/index.html",
    "crates/study/robots/yaskawa/mh12.toml",
    "crates/study/materials/aluminium-6082-t6.toml",
    "crates/study/studies/mh12-groove/study.toml",
    third_party::NAME,
    "Cargo.lock",
];

/// Packs the sources with the licences in them and gives the path of the file.
///
/// # Errors
/// In a line: it cannot be packed, or is not where it should be.
pub fn pack(release: &Release, third_party: &Path) -> Result<PathBuf, String> {
    // maturin takes licences from the folder of the package alone.
    let licences = Path::new(PACKAGE).join(third_party::NAME);
    copy(third_party, &licences)?;
    let mut maturin = release.tools.command("maturin");
    maturin
        .args(["sdist", "--out"])
        .arg(&release.out)
        .current_dir(PACKAGE);
    let packed = succeeded(&mut release.building(maturin));
    let removed = fs::remove_file(&licences).map_err(|error| format!("{}: {error}", licences.display()));
    packed.and(removed)?;
    let file = release.out.join(format!("{}.tar.gz", name(&release.version)));
    match file.is_file() {
        true => Ok(file),
        false => Err(format!("maturin left no {}", file.display())),
    }
}

/// Unpacks the sources into an empty folder and gives the folder of the package in it.
///
/// # Errors
/// In a line: they cannot be unpacked, or lack a file of [`NEEDED`].
pub fn unpacked(release: &Release, sources: &Path) -> Result<PathBuf, String> {
    let above = target_folder().join(super::UNPACKED);
    emptied(&above)?;
    fs::create_dir_all(&above).map_err(|error| format!("{}: {error}", above.display()))?;
    succeeded(Command::new("tar").arg("-xzf").arg(sources).arg("-C").arg(&above))?;
    let folder = above.join(name(&release.version));
    for needed in NEEDED {
        if !folder.join(needed).is_file() {
            return Err(format!("{} does not contain {needed}", sources.display()));
        }
    }
    Ok(folder)
}

/// The name of the folder in the file.
fn name(version: &str) -> String {
    format!("armill-{version}")
}
