//! The licences of all that is built in, for people: a table, and every text once.

use super::component::{Component, Components};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The name of the page.
pub const NAME: &str = "THIRD-PARTY-LICENSES.md";

/// How the names of files begin that contain a licence or a notice, in capitals.
const BEGINNINGS: &[&str] = &[
    "LICENSE",
    "LICENCE",
    "COPYING",
    "COPYRIGHT",
    "NOTICE",
    "UNLICENSE",
];

/// The page, for the artifacts of these targets.
///
/// # Errors
/// In a line, where a licence cannot be read.
pub fn page(version: &str, targets: &[&str], components: &Components) -> Result<String, String> {
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut without = Vec::new();
    for component in components.values() {
        let Some(folder) = &component.folder else {
            continue;
        };
        let found = texts_in(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        if found.is_empty() {
            without.push(component);
        }
        for (file, text) in found {
            let of = format!("{} {}, {file}", component.name, component.version);
            texts.entry(text).or_default().push(of);
        }
    }
    let head = format!(
        "# Third-party software in armill {version}\n\n\
         Built into the command `armill`, its page or the Python package, for {}. armill itself is Apache-2.0 OR MIT, at\n\
         your choice. The standard library of Rust is built in too: MIT OR Apache-2.0, https://github.com/rust-lang/rust.\n\n",
        targets.join(" or ")
    );
    Ok(head + &table(components) + &unaccompanied(&without) + &all_texts(texts))
}

/// One row a component that is not ours.
fn table(components: &Components) -> String {
    let others = components.values().filter(|component| component.folder.is_some());
    let row = |it: &Component| {
        let licence = if it.licence.is_empty() {
            "see its text"
        } else {
            &it.licence
        };
        format!(
            "| {} | {} | {licence} | {} |\n",
            it.name, it.version, it.repository
        )
    };
    let rows: String = others.map(row).collect();
    format!("| package | version | licence | from |\n|---|---|---|---|\n{rows}")
}

/// Packages that contain no text of their licence.
fn unaccompanied(without: &[&Component]) -> String {
    if without.is_empty() {
        return String::new();
    }
    let line = |it: &&Component| format!("- {} {}: {}\n", it.name, it.version, it.licence);
    format!(
        "\n## Licences without a text in the package\n\n\
         Their standard texts are at https://spdx.org/licenses/; those of Apache-2.0 and MIT also below, and next to this file.\n\n{}",
        without.iter().map(line).collect::<String>()
    )
}

/// Every text under the names of those that it is for, in the order of these.
fn all_texts(texts: BTreeMap<String, Vec<String>>) -> String {
    let mut texts: Vec<(Vec<String>, String)> = texts.into_iter().map(|(text, of)| (of, text)).collect();
    texts.sort();
    let one = |(of, text): &(Vec<String>, String)| {
        let of: String = of.iter().map(|one| format!("- {one}\n")).collect();
        // Longer than any fence in a licence.
        format!("\n{of}\n``````text\n{text}\n``````\n")
    };
    format!("\n## Texts\n{}", texts.iter().map(one).collect::<String>())
}

/// The licences and notices in a folder and in its folder of licences, each with its name in it.
fn texts_in(folder: &Path) -> io::Result<Vec<(String, String)>> {
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if !is_licence(&path) {
            continue;
        }
        if path.is_dir() {
            for inner in fs::read_dir(&path)? {
                files.push(inner?.path());
            }
        } else {
            files.push(path);
        }
    }
    files.sort();
    files
        .into_iter()
        .map(|file| {
            let name = file.strip_prefix(folder).unwrap_or(&file).display().to_string();
            // Some are older than UTF-8.
            let text = String::from_utf8_lossy(&fs::read(&file)?).into_owned();
            let lines: Vec<&str> = text.trim_matches('\n').lines().map(str::trim_end).collect();
            Ok((name, lines.join("\n")))
        })
        .collect()
}

/// Whether a file is one by its name; sources are not.
fn is_licence(path: &Path) -> bool {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_uppercase();
    BEGINNINGS.iter().any(|beginning| name.starts_with(beginning)) && !name.ends_with(".RS")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn component(name: &str, folder: Option<&str>) -> (String, Component) {
        let component = Component {
            name: name.to_owned(),
            version: "1.0.0".to_owned(),
            licence: "MIT".to_owned(),
            repository: "https://example.org".to_owned(),
            folder: folder.map(PathBuf::from),
            ..Component::default()
        };
        (name.to_owned(), component)
    }

    #[test]
    fn licences_are_known_by_their_names() {
        for name in [
            "LICENSE",
            "LICENSE-MIT",
            "licence.txt",
            "COPYING",
            "NOTICE.md",
            "UNLICENSE",
        ] {
            assert!(is_licence(Path::new(name)), "{name}");
        }
        for name in ["license.rs", "README.md", "src"] {
            assert!(!is_licence(Path::new(name)), "{name}");
        }
    }

    #[test]
    fn texts_of_the_repository_are_found() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let found = texts_in(&root).unwrap();
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["LICENSE-APACHE", "LICENSE-MIT"]);
        assert!(found[1].1.contains("Permission is hereby granted"));
    }

    #[test]
    fn ours_have_no_row_and_a_missing_text_is_reported() {
        let components = Components::from([component("armill", None), component("other", Some("."))]);
        let table = table(&components);
        assert!(table.contains("| other | 1.0.0 | MIT | https://example.org |") && !table.contains("armill"));
        let other = &components["other"];
        assert!(unaccompanied(&[other]).contains("- other 1.0.0: MIT\n"));
        assert_eq!(unaccompanied(&[]), "");
    }

    #[test]
    fn a_text_of_many_is_reported_once() {
        let of = vec!["a 1, LICENSE".to_owned(), "b 1, LICENSE".to_owned()];
        let all = all_texts(BTreeMap::from([("the text".to_owned(), of)]));
        assert_eq!(all.matches("the text").count(), 1);
        assert!(all.contains("- a 1, LICENSE\n- b 1, LICENSE\n"));
    }
}
