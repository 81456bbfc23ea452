//! Finding a robot: by library name, or by the path of a robot file.

use std::path::Path;

use armill_formats::document::Document;
use armill_formats::robot::{RobotDescription, armill, urdf};

use crate::error::StudyError;
use crate::library;

/// The robot `name`: of the library, or a `.toml` or `.urdf` file (relative to `folder`).
///
/// # Errors
/// An unknown name, a file that cannot be read, the problems of the file.
pub fn find(name: &str, folder: &Path) -> Result<RobotDescription, StudyError> {
    if let Some(found) = library::robot(name) {
        return Ok(found?);
    }
    let lower = name.to_lowercase();
    let (is_urdf, is_toml) = (lower.ends_with(".urdf"), lower.ends_with(".toml"));
    if !is_urdf && !is_toml {
        let message = format!("robot `{name}` is neither in the library nor a .toml or .urdf file");
        let hint = match library::most_like(name) {
            Some(like) => format!("did you mean `{like}`? `armill robots` lists all"),
            None => "`armill robots` lists the library".to_owned(),
        };
        return Err(StudyError::value(message, hint));
    }
    // A file of the current folder is called as the user called it.
    let path = if folder == Path::new(".") {
        Path::new(name).to_owned()
    } else {
        folder.join(name)
    };
    let shown = path.display().to_string();
    let bytes = std::fs::read(&path).map_err(|error| {
        let hint = "in a study, paths count from the folder of the study file";
        StudyError::value(format!("cannot read robot file {shown}: {error}"), hint)
    })?;
    let id = path
        .file_stem()
        .map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned());
    if is_toml {
        // Only to refuse bytes that are no text with their place.
        Document::from_bytes(&shown, &bytes)?;
    }
    let text = String::from_utf8_lossy(&bytes);
    Ok(if is_urdf {
        urdf::read(&shown, &id, &text)?
    } else {
        armill::read(&shown, &id, &text)?
    })
}

/// Path and text of the armill robot file behind `name`: of the library, or a `.toml` file of the current folder.
///
/// # Errors
/// Another format; a file that cannot be read.
pub fn text_of(name: &str) -> Result<[String; 2], StudyError> {
    if let Some(entry) = library::ROBOTS.iter().find(|robot| robot.name == name) {
        return Ok([entry.path.to_owned(), entry.text.to_owned()]);
    }
    if !name.to_lowercase().ends_with(".toml") {
        let message =
            format!("robot `{name}` is no armill robot file: compliances cannot be written into it");
        return Err(StudyError::value(
            message,
            "make one from it first, see docs/guide/robot-file.md",
        ));
    }
    let text = std::fs::read_to_string(name).map_err(|error| {
        StudyError::value(
            format!("cannot read robot file {name}: {error}"),
            "is the path right?",
        )
    })?;
    Ok([name.to_owned(), text])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_robot_is_told_with_the_one_most_like_it() {
        let error = find("yaskawa/mh21", Path::new(".")).unwrap_err().to_string();
        assert!(
            error.contains("`yaskawa/mh21`") && error.contains("`yaskawa/mh12`"),
            "{error}"
        );
    }

    #[test]
    fn a_missing_file_is_told_with_its_path() {
        let error = find("no-such.urdf", Path::new("/nowhere"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("/nowhere/no-such.urdf"), "{error}");
    }
}
