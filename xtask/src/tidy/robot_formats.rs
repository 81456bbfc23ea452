//! Every robot format is read, described, mutated and fuzzed.
//!
//! | place | required content |
//! |---|---|
//! | `robot/format.rs` | an arm of the last `match` that calls `module::read` |
//! | the module | `pub fn read`, or `read_to_tip` where a file has several ends |
//! | `tests/robots/mutations.rs` | a good file of the format, which is then spoiled |
//! | `docs/guide/your-robot.md` | its name among those of `--format` |
//! | `fuzz/src/targets.rs` | its verdict |

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "robot formats",
    reason: "a format that is only half supported fails for the first user",
    check,
};

/// Where formats are read, mutated, described and fuzzed.
const FOLDER: &str = "crates/formats/src/robot/";
const MUTATIONS: &str = "crates/formats/tests/robots/mutations.rs";
const GUIDE: &str = "docs/guide/your-robot.md";
const TARGETS: &str = "fuzz/src/targets.rs";

/// Our own format: it has a page of its own, and its slips are those of all our documents.
const OURS: &str = "Armill";

/// Goes through the cases of `Format`.
fn check(tree: &Tree) -> Vec<Violation> {
    let list = ["format.rs", "format/mod.rs"].map(|file| format!("{FOLDER}{file}"));
    let Some((path, text)) = list.iter().find_map(|path| Some((path, tree.text(path)?))) else {
        return Vec::new();
    };
    let mut violations = Vec::new();
    for format in formats(text) {
        let name = format.to_lowercase();
        let requested = [
            (MUTATIONS, format!(".{name}")),
            (GUIDE, format!("|{name}")),
            (TARGETS, format!("verdicts::{name},")),
        ];
        for (place, words) in requested {
            let ours = format == OURS && place != TARGETS;
            // The guide lists the names between strokes, the first one behind the option.
            let text = tree
                .text(place)
                .unwrap_or_default()
                .replace("--format ", "--format |");
            if !ours && !text.contains(&words) {
                let what = format!("format `{name}` is not there");
                violations.push(Violation::new(
                    place,
                    1,
                    what,
                    "see `a robot format` in ARCHITECTURE.md",
                ));
            }
        }
        let Some(module) = module_of(text, format) else {
            let what = format!("nothing reads format `{name}`");
            violations.push(Violation::new(path, 1, what, "call the `read` of its module"));
            continue;
        };
        let files = ["", "/mod"].map(|end| format!("{FOLDER}{module}{end}.rs"));
        if !files
            .iter()
            .filter_map(|file| tree.text(file))
            .any(|text| text.contains("pub fn read(") || text.contains("pub fn read_to_tip("))
        {
            let what = format!("module `{module}` has no `pub fn read`");
            violations.push(Violation::new(
                &files[0],
                1,
                what,
                "all formats are read by the same word",
            ));
        }
    }
    violations
}

/// The cases of `enum Format`.
fn formats(text: &str) -> Vec<&str> {
    let body = text.split("pub enum Format {").nth(1).unwrap_or_default();
    let lines = body.lines().map(str::trim).take_while(|line| *line != "}");
    lines.filter_map(|line| line.strip_suffix(',')).collect()
}

/// The module whose `read` the last arm of this format calls.
fn module_of<'a>(text: &'a str, format: &str) -> Option<&'a str> {
    let arms = text.rsplit("match format {").next()?;
    let arm = arms.split(&format!("Format::{format} =>")).nth(1)?;
    let before = &arm[..arm.find("::read")?];
    before.rsplit(|c: char| !super::rust::is_word(c)).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMATS: &str = "pub enum Format {\n    /// Ours.\n    Armill,\n    Dh,\n    Urdf,\n}\nfn read() {\n match format {\n\
        Format::Armill => {\n armill::read(text)\n}\nFormat::Dh => super::dh::read(text),\nFormat::Urdf => urdf::read_to_tip(text),\n}\n}\n";

    #[test]
    fn a_format_that_is_half_there_is_reported_with_what_it_lacks() {
        let tree = Tree::of(&[
            ("crates/formats/src/robot/format.rs", FORMATS),
            ("crates/formats/src/robot/armill/mod.rs", "pub fn read() {}"),
            ("crates/formats/src/robot/dh.rs", "pub fn read() {}"),
            ("crates/formats/src/robot/urdf.rs", "pub fn parse() {}"),
            (MUTATIONS, "include_str!(\"../seeds/arm.dh\")"),
            (GUIDE, "`--format urdf|dh`"),
            (TARGETS, "verdicts::armill, verdicts::dh, verdicts::urdf,"),
        ]);
        let given: Vec<String> = check(&tree)
            .into_iter()
            .map(|violation| format!("{} {}", violation.path, violation.what))
            .collect();
        assert_eq!(
            given,
            [
                "crates/formats/tests/robots/mutations.rs format `urdf` is not there",
                "crates/formats/src/robot/urdf.rs module `urdf` has no `pub fn read`"
            ]
        );
    }
}
