//! Finds the file that `$(find package)/urdf/x.xacro` names: without ROS, by the folders around.
//!
//! ```text
//! FOLDER/my_support/urdf/arm.xacro includes
//!   $(find my_support)/urdf/macro.xacro   FOLDER/my_support/urdf/macro.xacro
//!   $(find other)/urdf/x.xacro            FOLDER/other/urdf/x.xacro, else x.xacro next to arm.xacro
//! ```

use std::path::{Path, PathBuf};

/// The places where an included file may be, the likeliest first. `None` for a name that is an expression.
///
/// For `$(find package)/rest`: `rest` in a folder around that is called `package` or is next to one that is; then
/// the file itself next to the one that includes it.
pub(super) fn candidates(folder: &Path, filename: &str) -> Option<Vec<PathBuf>> {
    let inside = |open: &str, close: char| filename.strip_prefix(open)?.split_once(close);
    let packaged = inside("$(find ", ')').or_else(|| inside("package://", '/'));
    let Some((package, rest)) = packaged else {
        let plain = !filename.contains("${") && !filename.contains("$(");
        return plain.then(|| vec![folder.join(filename)]);
    };
    let (package, rest) = (package.trim(), rest.trim_start_matches('/'));
    let file = Path::new(rest).file_name()?;
    if rest.contains("${") || rest.contains("$(") {
        return None;
    }
    let mut places: Vec<PathBuf> = homes(folder, package).map(|home| home.join(rest)).collect();
    places.push(folder.join(file));
    Some(places)
}

/// Folders that may be the package, inner ones first.
pub(super) fn homes(folder: &Path, package: &str) -> impl Iterator<Item = PathBuf> {
    // A relative folder has no folders around it in its name.
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let around: Vec<PathBuf> = whole.ancestors().map(Path::to_owned).collect();
    let package = package.to_owned();
    around.into_iter().flat_map(move |folder| {
        let itself = folder.ends_with(&package).then(|| folder.clone());
        itself.into_iter().chain([folder.join(&package)])
    })
}

/// The ROS package of this name that `folder` is in: a folder around it of that name with a `package.xml`.
pub(super) fn own(folder: &Path, package: &str) -> Option<PathBuf> {
    let whole = folder.canonicalize().ok()?;
    let mut around = whole.ancestors();
    around
        .find(|folder| folder.ends_with(package) && folder.join("package.xml").is_file())
        .map(Path::to_owned)
}
