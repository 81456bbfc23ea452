//! No circle between the files of any crate.
//!
//! ```text
//! a.rs: use super::b::C;      b.rs: use super::a::D;        neither can be read without the other
//! ```
//!
//! Looked at are imports, and paths with `::` in code, that begin with `crate`, `self`, `super`, a child module or an
//! imported name. A name that a module exports again leads to the file that it comes from; exporting again is itself no
//! use, so that a `mod.rs` may show what its children contain. Tests may use everything.
//!
//! Not seen: what a `*` brings (it is a use of the file that it names), a name that a file exports again and uses itself
//! without `::`, modules with a body in the same file, calls of methods.

use std::collections::BTreeMap;

use super::Rule;
use super::circles::{Uses, circles};
use super::paths::Paths;
use super::rust::RustFile;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "file circles",
    reason: "a file must be readable without the ones that use it",
    check,
};

/// A name that is exported again more often than this is not followed further.
const MOST_EXPORTS: usize = 8;

/// Finds the circles of each crate.
fn check(tree: &Tree) -> Vec<Violation> {
    let manifests = tree.texts_in("crates/", "/Cargo.toml");
    let folders = manifests.filter_map(|(path, _)| path.strip_suffix("Cargo.toml"));
    let of_folder = |folder| {
        let uses = Crate::read(tree, &format!("{folder}src/")).uses();
        circles(&uses, "move what both need into a file below them")
    };
    folders.flat_map(of_folder).collect()
}

/// The path of a module from the root of its crate.
type Module = Vec<String>;

/// The files of a crate.
struct Crate<'a> {
    modules: BTreeMap<Module, Source<'a>>,
    /// The folder of the root.
    folder: &'a str,
}

/// A file of a crate.
struct Source<'a> {
    file: &'a RustFile,
    paths: Paths,
}

impl<'a> Crate<'a> {
    /// The crate whose root is in `folder`.
    fn read(tree: &'a Tree, folder: &'a str) -> Self {
        let mut modules = BTreeMap::new();
        for file in tree.rust_files(folder) {
            let paths = Paths::of(file);
            modules
                .entry(module(&file.path[folder.len()..]))
                .or_insert(Source { file, paths });
        }
        Self { modules, folder }
    }

    /// The uses between the files, by their paths from the folder.
    fn uses(&self) -> Uses {
        let mut uses = Uses::new();
        for (module, source) in &self.modules {
            let mut of_file = BTreeMap::new();
            for (path, line) in self.used_paths(module, &source.paths) {
                if let Some(used) = self.origin(path).filter(|used| used.path != source.file.path) {
                    of_file
                        .entry(self.name(used))
                        .or_insert((source.file.path.clone(), line));
                }
            }
            uses.insert(self.name(source.file), of_file);
        }
        uses
    }

    /// The path of `file` from the folder.
    fn name(&self, file: &RustFile) -> String {
        file.path[self.folder.len()..].to_owned()
    }

    /// From the root of the crate: the paths of this crate that `module` uses, with their lines.
    fn used_paths(&self, module: &[String], paths: &Paths) -> Vec<(Vec<String>, usize)> {
        let imports: Vec<_> = paths
            .imports
            .iter()
            .filter_map(|import| Some((import, self.absolute(module, &import.path)?)))
            .collect();
        let imported: BTreeMap<&str, &Vec<String>> = imports
            .iter()
            .map(|(import, path)| (import.name.as_str(), path))
            .collect();
        let others = paths.others.iter().filter_map(|(path, line)| {
            let path = self.absolute(module, path).or_else(|| {
                let first = imported.get(path[0].as_str())?;
                Some([first.as_slice(), &path[1..]].concat())
            });
            Some((path?, *line))
        });
        let used = imports.iter().filter(|(import, _)| !import.again);
        used.map(|(import, path)| (path.clone(), import.line))
            .chain(others)
            .collect()
    }

    /// From the root of the crate: a `path` in `module`; nothing where it leads to another crate or to an import.
    fn absolute(&self, module: &[String], path: &[String]) -> Option<Vec<String>> {
        let mut base = module.to_vec();
        let mut rest = path;
        while let [word, after @ ..] = rest {
            match word.as_str() {
                "crate" => base.clear(),
                "self" => {}
                "super" => {
                    base.pop();
                }
                _ => break,
            }
            rest = after;
        }
        let is_named = rest.len() < path.len();
        base.extend_from_slice(rest);
        let child = module.len() + 1;
        (is_named || self.modules.contains_key(&base[..child])).then_some(base)
    }

    /// The file where the name at `path`, from the root of the crate, is defined.
    fn origin(&self, mut path: Vec<String>) -> Option<&'a RustFile> {
        for _ in 0..MOST_EXPORTS {
            let length = (0..=path.len())
                .rev()
                .find(|length| self.modules.contains_key(&path[..*length]))?;
            let (module, rest) = path.split_at(length);
            let source = &self.modules[module];
            let exported = |name: &String| {
                source
                    .paths
                    .imports
                    .iter()
                    .find(|import| import.again && import.name == *name)
            };
            let Some(origin) = rest
                .first()
                .and_then(exported)
                .and_then(|import| self.absolute(module, &import.path))
            else {
                return Some(source.file);
            };
            path = [origin.as_slice(), &rest[1..]].concat();
        }
        None
    }
}

/// The module in the file at `path`, from the folder of the root.
fn module(path: &str) -> Module {
    let mut parts: Module = path
        .trim_end_matches(".rs")
        .split('/')
        .map(str::to_owned)
        .collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        parts.pop();
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(files: &[(&str, &str)]) -> Vec<String> {
        let mut all = vec![("crates/some/Cargo.toml", "[package]\nname = \"armill-some\"\n")];
        all.extend(files);
        check(&Tree::of(&all))
            .into_iter()
            .map(|violation| format!("{}:{}: {}", violation.path, violation.line, violation.what))
            .collect()
    }

    #[test]
    fn siblings_that_use_each_other_are_reported_with_their_way() {
        let files = [
            ("crates/some/src/lib.rs", "mod a;\n"),
            ("crates/some/src/a/mod.rs", "mod b;\nmod c;\n"),
            ("crates/some/src/a/b.rs", "use super::c::D;\n"),
            (
                "crates/some/src/a/c.rs",
                "struct D;\nfn e() { crate::a::b::f() }\n",
            ),
        ];
        assert_eq!(
            given(&files),
            ["crates/some/src/a/c.rs:2: `a/c.rs` uses `a/b.rs`, which leads back to it: a/b.rs -> a/c.rs"]
        );
    }

    #[test]
    fn a_module_and_its_child_that_use_each_other_are_reported() {
        for (parent, child) in [
            ("mod b;\nuse b::C;\n", "use super::D;\n"),
            ("mod b;\nfn c() { b::d() }\n", "fn e(f: super::G) {}\n"),
            (
                "mod b;\nuse self::b as c;\nfn d() { c::e() }\n",
                "use crate::a;\nfn f() { a::g() }\n",
            ),
        ] {
            let files = [
                ("crates/some/src/a/mod.rs", parent),
                ("crates/some/src/a/b.rs", child),
            ];
            assert_eq!(given(&files).len(), 1, "{parent}");
        }
    }

    #[test]
    fn a_name_that_is_exported_again_leads_to_the_file_it_comes_from() {
        let root = ("crates/some/src/lib.rs", "pub use a::{B, C as D};\n");
        let folder = (
            "crates/some/src/a/mod.rs",
            "mod b;\nmod c;\npub(crate) use b::B;\npub use c::C;\n",
        );
        let used = ("crates/some/src/a/b.rs", "pub struct B;\n");
        let user = ("crates/some/src/a/c.rs", "use super::B;\npub struct C;\n");
        assert_eq!(given(&[root, folder, used, user]), Vec::<String>::new());
        let back = ("crates/some/src/a/b.rs", "pub struct B(crate::D);\n");
        assert_eq!(
            given(&[root, folder, back, user]),
            ["crates/some/src/a/c.rs:1: `a/c.rs` uses `a/b.rs`, which leads back to it: a/b.rs -> a/c.rs"]
        );
    }

    #[test]
    fn uses_of_tests_and_of_other_crates_and_visibilities_pass() {
        let files = [
            (
                "crates/some/src/a.rs",
                "use crate::b::C;\nuse other::b::D;\nfn e() { std::b::f() }\n",
            ),
            (
                "crates/some/src/b.rs",
                "pub(in crate::a) struct C;\n#[cfg(test)]\nuse crate::a::G;\n#[cfg(test)]\nmod tests { use crate::a::e; }\n",
            ),
        ];
        assert_eq!(given(&files), Vec::<String>::new());
    }
}
