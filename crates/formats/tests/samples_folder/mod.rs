//! The folder of real files, named by ARMILL_SAMPLES; without it what needs them checks nothing, and says so.

use std::path::{Path, PathBuf};

/// A folder of the samples, if there are any.
pub fn samples(folder: &str) -> Option<PathBuf> {
    let samples = std::env::var_os("ARMILL_SAMPLES");
    if samples.is_none() {
        println!("skipped: ARMILL_SAMPLES is not set");
    }
    samples.map(|samples| Path::new(&samples).join(folder))
}

/// Every file below a folder, in order.
#[allow(dead_code, reason = "not every test binary lists folders")]
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("it can be listed").path();
            match path.is_dir() {
                true => folders.push(path),
                false => found.push(path),
            }
        }
    }
    found.sort();
    found
}
