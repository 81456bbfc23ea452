//! The files of the page, if it was built: in the crate itself as it is published, in `web/dist` of the repository
//! otherwise.
//!
//! In the repository `dist` of this crate is a link to `web/dist`, so that `cargo package` finds it; where git makes no
//! links (on Windows), `web/dist` is taken. The output is a list of names and bytes for `src/page.rs`; it is empty
//! without a page.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    // `npm run build` of the page gives this file a new time.
    println!("cargo::rerun-if-changed=build.rs");
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let places = [here.join("dist"), here.join("../../web/dist")];
    let files = match places.iter().find(|place| place.is_dir()) {
        Some(page) => {
            println!("cargo::rerun-if-changed={}", page.display());
            let page = fs::canonicalize(page)?;
            let mut files = Vec::new();
            collect(&page, &page, &mut files)?;
            files.sort();
            files
        }
        None => Vec::new(),
    };
    let line = |(name, path): &(String, PathBuf)| format!("({name:?}, include_bytes!({path:?})),\n");
    let list: String = files.iter().map(line).collect();
    fs::write(
        Path::new(&env::var("OUT_DIR")?).join("page.rs"),
        format!("&[\n{list}]\n"),
    )?;
    Ok(())
}

/// The files in `folder` and below, each with its path from `page` as a browser names it.
fn collect(page: &Path, folder: &Path, files: &mut Vec<(String, PathBuf)>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(page, &path, files)?;
        } else {
            let name = path.strip_prefix(page)?.to_string_lossy().replace('\\', "/");
            files.push((name, path));
        }
    }
    Ok(())
}
