//! Finding a robot: by library name, or by the path of a robot file of any format.

use std::path::{Path, PathBuf};

use armill_formats::input;
use armill_formats::robot::format::{self, Format, RobotReadOptions};
use armill_formats::robot::{RobotDescription, armill};

use crate::error::StudyError;
use crate::library;

/// The robot `name`: of the library, or a robot file of any format (relative to `folder`).
///
/// # Errors
/// An unknown name, a file that cannot be read, the problems of the file.
pub fn find(name: &str, folder: &Path) -> Result<RobotDescription, StudyError> {
    if let Some(found) = library::robot(name) {
        return Ok(found?);
    }
    // A file of the current folder is called as the user called it.
    let path = if folder == Path::new(".") {
        PathBuf::from(name)
    } else {
        folder.join(name)
    };
    if !Format::has_ending(Path::new(name)) && !path.is_file() {
        let message = format!("robot `{name}` is neither in the library nor a robot file");
        let hint = match library::most_like(name) {
            Some(like) => format!("did you mean `{like}`? `armill robots` lists all"),
            None => format!(
                "`armill robots` lists the library; robot files end in {}",
                format::endings()
            ),
        };
        return Err(StudyError::value(message, hint));
    }
    read(&path, &RobotReadOptions::default())
}

/// The robot of a foreign robot file, for conversion to the format of armill.
///
/// # Errors
/// As [`find`] of a file; a file that is in this format already.
pub fn import(path: &Path, requested: &RobotReadOptions) -> Result<RobotDescription, StudyError> {
    let ours = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    if requested.format == Some(Format::Armill) || (ours && requested.format.is_none()) {
        let message = format!(
            "{} is already a robot file of armill: it need not be imported",
            path.display()
        );
        return Err(StudyError::value(
            message,
            "use it directly: `armill robots FILE`, `armill pose FILE`",
        ));
    }
    read(path, requested)
}

/// The robot of the file at `path`, called after it.
fn read(path: &Path, requested: &RobotReadOptions) -> Result<RobotDescription, StudyError> {
    let shown = path.display();
    let bytes = input::read(path).map_err(|error| {
        let hint = "in a study, paths are relative to the folder of the study file";
        StudyError::value(format!("cannot read robot file {shown}: {error}"), hint)
    })?;
    let id = path
        .file_stem()
        .map_or_else(|| shown.to_string(), |stem| stem.to_string_lossy().into_owned());
    Ok(format::read(path, &id, &bytes, requested)?)
}

/// Path and text of the armill robot file behind `name`: of the library, a `.toml` file, or what `found`, read from a
/// file of another format, is as one.
///
/// # Errors
/// A file that cannot be read.
pub fn text_of(name: &str, found: &RobotDescription) -> Result<[String; 2], StudyError> {
    if let Some(entry) = library::ROBOTS.iter().find(|robot| robot.name == name) {
        return Ok([entry.path.to_owned(), entry.text.to_owned()]);
    }
    if !name.to_lowercase().ends_with(".toml") {
        return Ok([name.to_owned(), armill::write(found)]);
    }
    let text = input::read_text(Path::new(name)).map_err(|error| {
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
    fn an_unknown_robot_is_refused_with_the_most_similar_name() {
        let error = find("yaskawa/mh21", Path::new(".")).unwrap_err().to_string();
        assert!(
            error.contains("`yaskawa/mh21`") && error.contains("`yaskawa/mh12`"),
            "{error}"
        );
    }

    #[test]
    fn a_missing_file_is_reported_with_its_path() {
        let error = find("no-such.urdf", Path::new("/nowhere"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("/nowhere/no-such.urdf"), "{error}");
    }

    #[test]
    fn an_unknown_extension_is_refused_with_the_known_formats() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("arm.step"), "ISO-10303-21;").unwrap();
        let error = find("arm.step", folder.path()).unwrap_err().to_string();
        assert!(
            error.contains("`.step` is not an ending of robot files"),
            "{error}"
        );
        assert!(error.contains(".xacro"), "{error}");
    }

    #[test]
    fn a_file_of_ours_is_not_imported() {
        let error = import(Path::new("arm.toml"), &RobotReadOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains("already"), "{error}");
    }
}
