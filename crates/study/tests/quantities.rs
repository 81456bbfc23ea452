//! The list of quantities: what it says of their origin is there, and the page of the guide is made from it.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fmt::Write;
use std::path::{Path, PathBuf};

use armill_study::analysis::quantity::{ALL, Quantity};

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn every_quantity_leads_to_its_function_its_equations_and_its_proof() {
    let root = root();
    for quantity in ALL {
        let Some(origin) = quantity.origin else { continue };
        let source = std::fs::read_to_string(root.join("crates").join(origin.file)).unwrap();
        let name = origin.function.rsplit("::").next().unwrap();
        let signature = format!("fn {name}(");
        assert!(
            source.contains(&signature),
            "{}: {signature} in {}",
            quantity.key,
            origin.file
        );
        if let Some(page) = origin.theory {
            let page = root.join(format!("docs/theory/{page}.md"));
            assert!(page.is_file(), "{}: {}", quantity.key, page.display());
        }
        if let Some(case) = origin.validation {
            let table = std::fs::read_to_string(root.join("validation/TABLE.md")).unwrap();
            assert!(table.contains(&format!("[{case}]")), "{}: {case}", quantity.key);
        }
    }
}

#[test]
fn keys_are_unique_and_end_in_their_unit() {
    for (i, quantity) in ALL.iter().enumerate() {
        assert!(
            ALL[..i].iter().all(|other| other.key != quantity.key),
            "{}",
            quantity.key
        );
        if let Some(unit) = quantity.unit {
            // `mm^3/s` in a key is `mm3_per_s`, `N m` is `n_m`.
            let suffix = unit
                .replace('/', "_per_")
                .replace(' ', "_")
                .replace('^', "")
                .to_lowercase();
            assert!(quantity.key.ends_with(&suffix), "{} in {unit}", quantity.key);
        }
    }
}

/// A link to what is named, or that there is none yet.
fn link(name: Option<&str>, to: impl Fn(&str) -> String) -> String {
    name.map_or_else(|| "none yet".to_owned(), |name| format!("[{name}]({})", to(name)))
}

/// A row of the page.
fn row(quantity: &Quantity) -> String {
    let unit = quantity.unit.unwrap_or("-");
    let (function, theory, validation) = match quantity.origin {
        None => ("input".to_owned(), String::new(), String::new()),
        Some(origin) => (
            format!("[`{}`](../../crates/{})", origin.function, origin.file),
            link(origin.theory, |page| format!("../theory/{page}.md")),
            link(origin.validation, |case| {
                format!("../../validation/{case}/README.md")
            }),
        ),
    };
    format!(
        "| `{}` | {unit} | {} | {function} | {theory} | {validation} |",
        quantity.key, quantity.words
    )
}

#[test]
fn the_page_of_the_guide_is_made_from_the_list() {
    let mut page = "\
# Quantities of a point

The columns of tables, the fields of VTK files and the numbers of the page, each with the function that computes it, the
page with its equations, and the case that compares it with the numbers of others. Capitals in a key stand for a name or a
number. Made from `crates/study/src/analysis/quantity.rs`: do not edit.

| key | unit | meaning | function | equations | compared in |
|---|---|---|---|---|---|
"
    .to_owned();
    for quantity in ALL {
        writeln!(page, "{}", row(quantity)).unwrap();
    }
    let path = root().join("docs/guide/quantities.md");
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(there == page, "{} is to be:\n{page}", path.display());
}
