//! Finds the files that the library embeds: in the crate itself as published, in the repository otherwise.
//!
//! In the repository `robots`, `materials` and `studies` of this crate are links to the folders of the root, so that
//! `cargo package` finds them; where git makes no links (on Windows), the folders of the root are taken.

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let library = if here.join("robots").is_dir() {
        here
    } else {
        here.join("../..")
    };
    println!("cargo::rustc-env=ARMILL_LIBRARY={}", library.display());
}
