//! The site: the documentation, and the live page without a server with its program, in one folder for a web server.
//!
//! ```text
//! armill-site-VERSION/
//!   index.html                       the documentation
//!   live/index.html                  the page
//!   THIRD-PARTY-LICENSES.md          of all that is in its program
//!   LICENSE-mkdocs-material          of what the documentation looks and searches with
//! ```

use super::{Release, copy, emptied, tarball, target_folder};
use crate::command::succeeded;
use crate::site;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where `cargo xtask site` builds.
const SITE: &str = "target/site";

/// Builds the site and packs it with the licences of what is in it; gives the path of the file.
///
/// # Errors
/// In a line: it cannot be built or packed, or the generator has no licence.
pub fn pack(release: &Release, third_party: &Path) -> Result<PathBuf, String> {
    // Also what an earlier version had.
    emptied(Path::new(SITE))?;
    site::build(&release.remapped(), Some(&release.committed_s))?;
    let above = target_folder().join("dist-site");
    emptied(&above)?;
    let name = format!("armill-site-{}", release.version);
    let folder = above.join(&name);
    fs::create_dir_all(&above).map_err(|error| format!("{}: {error}", above.display()))?;
    succeeded(Command::new("cp").arg("-R").arg(SITE).arg(&folder))?;
    copy(third_party, &folder.join(super::third_party::NAME))?;
    copy(
        &licence_of_theme(Path::new(site::VENV))?,
        &folder.join("LICENSE-mkdocs-material"),
    )?;
    tarball::archive(release, &above, &name)
}

/// The licence of the theme, as pip installed it in this environment.
///
/// # Errors
/// In a line: it is not there.
fn licence_of_theme(environment: &Path) -> Result<PathBuf, String> {
    let folders = |folder: PathBuf| {
        let found = fs::read_dir(folder).into_iter().flatten().flatten();
        found.map(|entry| entry.path())
    };
    folders(environment.join("lib"))
        .flat_map(|python| folders(python.join("site-packages")))
        .filter(|package| {
            let name = package.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("mkdocs_material-") && name.ends_with(".dist-info")
        })
        .map(|package| package.join("licenses/LICENSE"))
        .find(|licence| licence.is_file())
        .ok_or_else(|| format!("{} has no licence of mkdocs-material", environment.display()))
}
