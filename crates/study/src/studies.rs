//! Finding the study that a user means: a folder, a file, or an example by name.
//!
//! A folder means the `study.toml` in it. A file on disk has precedence over an example of the same name.

use std::io::Read;
use std::path::{Path, PathBuf};

use armill_formats::document::Document;
use armill_formats::input;
use armill_formats::toolpath::format::{Format, HEAD_BYTES};

use crate::error::StudyError;
use crate::file::format::StudyFile;
use crate::file::resolve::{Study, read, read_changed};
use crate::library;

/// A study that was found.
#[derive(Clone, Debug)]
pub struct FoundStudy {
    /// What errors call the file.
    pub shown: String,
    /// Folder to which robot files are relative, and for `out`.
    pub folder: PathBuf,
    /// The file.
    pub bytes: Vec<u8>,
}

impl FoundStudy {
    /// The study, checked.
    ///
    /// # Errors
    /// Every problem of the file.
    pub fn read(&self) -> Result<Study, StudyError> {
        read(&self.shown, &self.folder, &self.bytes)
    }

    /// The study after `change` of its file, checked.
    ///
    /// # Errors
    /// Every problem of the file.
    pub fn read_changed(&self, change: impl FnOnce(&mut StudyFile)) -> Result<Study, StudyError> {
        read_changed(&self.shown, &self.folder, &self.bytes, change)
    }
}

/// Whether this is a study on disk: a folder with a `study.toml`, or a TOML file that names a robot.
pub fn is_study(given: &Path) -> bool {
    if given.is_dir() {
        return given.join("study.toml").is_file();
    }
    let is_toml = given.extension().is_some_and(|ending| ending == "toml") && given.is_file();
    let bytes = is_toml.then(|| input::read(given).ok()).flatten();
    let document = bytes.and_then(|bytes| Document::from_bytes("study", &bytes).ok());
    document.is_some_and(|document| document.contains("robot"))
}

/// The study at `given`; an example of the library if there is nothing of that name on disk.
///
/// # Errors
/// Neither; a file that cannot be read.
pub fn find(given: &Path) -> Result<FoundStudy, StudyError> {
    let file = if given.is_dir() {
        given.join("study.toml")
    } else {
        given.to_owned()
    };
    let shown = file.display().to_string();
    if !file.exists() {
        return example(given, &shown);
    }
    refuse_program(&file)?;
    let bytes = input::read(&file).map_err(|error| {
        StudyError::value(format!("cannot read {shown}: {error}"), "give a readable file")
    })?;
    let folder = file.parent().map_or_else(|| PathBuf::from("."), Path::to_owned);
    Ok(FoundStudy { shown, folder, bytes })
}

/// A study that runs; FILE is filled in.
const SMALLEST: &str = r#"a program contains neither the robot nor the forces on the tool. Write a study.toml next to it, such as

    format = 1
    robot = "yaskawa/mh12"            # `armill robots` lists them
    tolerance_um = 100
    tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
    plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
    load = { frame = "feed", cases_n = [[-60, 40, 25]] }
    [[analysis]]
    kind = "path"
    program = { file = "FILE" }

  and give its folder here."#;

/// Refuses a program in place of a study.
fn refuse_program(file: &Path) -> Result<(), StudyError> {
    let is_study = file.extension().is_some_and(|ending| ending == "toml");
    // Reading a pipe would consume it.
    if is_study || !file.is_file() {
        return Ok(());
    }
    let mut head = Vec::new();
    let opened = input::open(file).map(|file| file.take(HEAD_BYTES));
    if opened.and_then(|mut begin| begin.read_to_end(&mut head)).is_err() {
        return Ok(());
    }
    let what = match Format::of(file, &String::from_utf8_lossy(&head)) {
        Ok(Format::Robot(language)) => format!("a program of a robot ({})", language.title()),
        Ok(_) => "a tool path".to_owned(),
        Err(_) => return Ok(()),
    };
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    Err(StudyError::value(
        format!("{} is {what}, not a study", file.display()),
        SMALLEST.replace("FILE", &name),
    ))
}

/// The example `given`, with or without its folder `studies`.
fn example(given: &Path, shown: &str) -> Result<FoundStudy, StudyError> {
    let name = given
        .strip_prefix("studies")
        .unwrap_or(given)
        .display()
        .to_string();
    let Ok(files) = library::example(&name) else {
        let examples: Vec<&str> = library::example_studies().map(|study| study.name).collect();
        return Err(StudyError::value(
            format!("no study at {shown}"),
            format!(
                "create one with `armill new DIR`, or run an example: {}",
                examples.join(", ")
            ),
        ));
    };
    let [(_, example)] = files[..] else {
        return Err(StudyError::value(
            format!("the example {name} is not there as a folder, and its study needs the other files in it"),
            format!("`armill new {name} --example {name}` creates it"),
        ));
    };
    Ok(FoundStudy {
        shown: example.path.to_owned(),
        folder: PathBuf::from(example.name),
        bytes: example.text.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_example_is_found_by_name_and_an_unknown_one_is_refused_with_the_list() {
        let found = find(Path::new("studies/mh12-groove")).unwrap();
        assert_eq!(found.shown, "studies/mh12-groove/study.toml");
        assert!(found.read().is_ok());
        let error = find(Path::new("no-such-study")).unwrap_err().to_string();
        assert!(error.contains("mh12-groove, kr120-groove"), "{error}");
    }
}
