//! What each command does: one file a command.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod forces;
pub(crate) mod identify;
pub(crate) mod materials;
pub(crate) mod new;
pub(crate) mod pose;
pub(crate) mod robots;
pub(crate) mod robots_check;
pub(crate) mod robots_import;
pub(crate) mod robots_list;
pub(crate) mod run;

mod drawing;
mod structure;
mod study_file;
