//! `armill man`: a manual page for `armill` and one for each of its commands, such as `armill-run.1`.

use armill_formats::file::{FileError, create_folder, write_atomically};
use armill_study::StudyError;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

use crate::Outcome;
use crate::arguments::{Arguments, ManArguments};

/// Writes the pages, made from the same arguments that are parsed, and prints their paths.
///
/// # Errors
/// A place where nothing can be written; stdout takes no more.
pub(crate) fn run(arguments: &ManArguments) -> Result<Outcome, StudyError> {
    create_folder(&arguments.dir)?;
    // What `armill help` would repeat has a page.
    let mut armill = Arguments::command().disable_help_subcommand(true);
    // Names such as `armill-robots-import` are given here.
    armill.build();
    let mut written = Vec::new();
    for page in pages(&armill) {
        let path = arguments.dir.join(page.get_filename());
        let mut text = Vec::new();
        page.render(&mut text).map_err(|source| FileError::Other {
            path: path.clone(),
            source,
        })?;
        write_atomically(&path, &text)?;
        written.push(path.display().to_string());
    }
    crate::terminal::print(&written.join("\n"))?;
    Ok(Outcome::Fine)
}

/// The page of a command, and those of its own commands.
fn pages(command: &Command) -> Vec<Man> {
    let own = command.get_subcommands().flat_map(pages);
    let page = Man::new(command.clone()).source(concat!("armill ", env!("CARGO_PKG_VERSION")));
    [page].into_iter().chain(own).collect()
}
