//! The checks of the case, applied to the files of the manufacturers if they are available.

#[path = "library.rs"]
mod library;
#[path = "xacro.rs"]
mod xacro;

use std::path::{Path, PathBuf};

use super::{apart, read};
use crate::arms;

/// Expanded URDFs among the samples.
const FILES: [&str; 7] = [
    "abb/irb2400.urdf",
    "abb/irb6640.urdf",
    "abb/irb6640_185_280.urdf",
    "kuka/kr120r2500pro.urdf",
    "kuka/kr16_2.urdf",
    "kuka/kr210l150.urdf",
    "staubli/rx160.urdf",
];

fn robots() -> Option<PathBuf> {
    let samples = std::env::var_os("ARMILL_SAMPLES");
    if samples.is_none() {
        println!("skipped: ARMILL_SAMPLES is not set");
    }
    samples.map(|folder| Path::new(&folder).join("robots"))
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("sample {}: {error}", path.display()))
}

#[test]
fn files_of_the_makers_are_read_as_they_say() {
    let Some(robots) = robots() else { return };
    for file in FILES {
        let text = text(&robots.join(file));
        let [metres, radians] = apart(&read(file, &text), &text);
        assert!(
            metres < 1e-12 && radians < 1e-12,
            "{file}: {metres} m, {radians} rad"
        );
    }
}

#[test]
fn library_kr120_is_that_of_its_maker() {
    let Some(robots) = robots() else { return };
    let text = text(&robots.join("kuka/kr120r2500pro.urdf"));
    let [metres, radians] = apart(&arms::library("kuka/kr120r2500pro"), &text);
    assert!(metres < 1e-9 && radians < 1e-6, "{metres} m, {radians} rad");
}
