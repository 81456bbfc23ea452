//! The files in a folder, two folders deep at most, and never one outside of it.
//!
//! A name that begins with a point is not accepted; a link that leads out of the folder is not followed.

use std::path::{Component, Path, PathBuf};
use std::time::{Duration, SystemTime};

use armill_formats::input::real_path;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::ApiError;

/// Files listed at most.
const MOST_FILES: usize = 2000;

/// One file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FileRow {
    /// Its path in the folder, such as `out/report.html`.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Time since it was written.
    pub modified_s_ago: f64,
}

/// The files of the folder and of its folders.
pub(crate) fn listed(root: &Path) -> Vec<FileRow> {
    let mut files = Vec::new();
    add(root, "", &mut files, 2);
    files.sort_by(|a, b| a.name.cmp(&b.name));
    files
}

/// Adds the content of `folder`, so many folders deep.
fn add(folder: &Path, before: &str, files: &mut Vec<FileRow>, depth: usize) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        // What a link leads to is not looked at here.
        let (Ok(kind), true) = (entry.file_type(), is_plain(&name)) else {
            continue;
        };
        if files.len() >= MOST_FILES {
            return;
        }
        let name = format!("{before}{name}");
        if kind.is_dir() && depth > 0 {
            add(&entry.path(), &format!("{name}/"), files, depth - 1);
        } else if let (true, Ok(meta)) = (kind.is_file(), entry.metadata()) {
            let age = meta
                .modified()
                .ok()
                .and_then(|at| SystemTime::now().duration_since(at).ok());
            files.push(FileRow {
                name,
                bytes: meta.len(),
                modified_s_ago: age.unwrap_or(Duration::ZERO).as_secs_f64(),
            });
        }
    }
}

/// Whether a part of a path is a plain name: not hidden, without separators.
pub(crate) fn is_plain(name: &str) -> bool {
    let odd = |c: char| c.is_control() || matches!(c, '/' | '\\' | ':');
    !name.is_empty() && !name.starts_with('.') && !name.contains(odd)
}

/// The file at this path of the folder, where there is one in it.
pub(crate) fn inside(root: &Path, path: &str) -> Result<PathBuf, ApiError> {
    let none = || ApiError::not_found("there is no such file");
    if !path.split('/').all(is_plain) {
        return Err(none());
    }
    // Links are followed first: what counts is where they lead.
    let real = real_path(&root.join(path)).map_err(|_| none())?;
    let below = real.strip_prefix(root).map_err(|_| none())?;
    let plain = below.components().all(|part| match part {
        Component::Normal(name) => name.to_str().is_some_and(is_plain),
        _ => false,
    });
    match plain && real.is_file() {
        true => Ok(real),
        false => Err(none()),
    }
}
