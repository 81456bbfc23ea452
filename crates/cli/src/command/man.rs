//! `armill man`: one manual page for `armill` and one for each of its commands, such as `armill-run.1`.

use std::path::PathBuf;

use armill_formats::file::{FileError, create_folder};
use armill_study::StudyError;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

use crate::arguments::{Arguments, ManArguments};
use crate::outcome::Outcome;

/// Writes the pages, generated from the definition of the arguments, and prints their paths.
///
/// # Errors
/// A folder that cannot be written; stdout cannot be written.
pub(crate) fn run(arguments: &ManArguments) -> Result<Outcome, StudyError> {
    // `armill help` would repeat the pages of the commands.
    let mut armill = Arguments::command().disable_help_subcommand(true);
    // Names such as `armill-robots-import` are given here.
    armill.build();
    let mut files = Vec::new();
    for page in pages(&armill) {
        let path = arguments.dir.join(page.get_filename());
        let mut text = Vec::new();
        page.render(&mut text).map_err(|source| FileError::Other {
            path: path.clone(),
            source,
        })?;
        files.push((path, text));
    }
    let bytes: Vec<(PathBuf, &[u8])> = files
        .iter()
        .map(|(path, text)| (path.clone(), &text[..]))
        .collect();
    create_folder(&arguments.dir)?;
    arguments.writing.writer("man").write_all(&bytes)?;
    let written: Vec<String> = files.iter().map(|(path, _)| path.display().to_string()).collect();
    crate::terminal::print(&written.join("\n"))?;
    Ok(Outcome::Fine)
}

/// The page of a command, and those of its own commands.
fn pages(command: &Command) -> Vec<Man> {
    let own = command.get_subcommands().flat_map(pages);
    let page = Man::new(command.clone()).source(concat!("armill ", env!("CARGO_PKG_VERSION")));
    [page].into_iter().chain(own).collect()
}
