//! The paths that a Rust file names: what it imports, what it exports again, and paths with `::` in its code.
//!
//! ```text
//! pub use a::B;   use c::{D, e::F as G};   H::i(j::k)       ->       a::B again; c::D, c::e::F as G; H::i, j::k
//! ```
//!
//! Left out is what belongs to tests, and the `in path` of a visibility.

use proc_macro2::{Delimiter, TokenTree};

use super::rust::{RustFile, is_cfg_test, is_punct, item_length};

/// The paths of a file.
#[derive(Debug, Default)]
pub struct Paths {
    /// Those of `use`.
    pub imports: Vec<Import>,
    /// Those of at least two names in the rest of the code, with their lines.
    pub others: Vec<(Vec<String>, usize)>,
}

/// One name that `use` brings.
#[derive(Debug, PartialEq, Eq)]
pub struct Import {
    /// Where it comes from; `*` as its last part for all names there.
    pub path: Vec<String>,
    /// How it is called in this file.
    pub name: String,
    /// Whether it is exported again, to anyone.
    pub again: bool,
    pub line: usize,
}

impl Paths {
    /// All paths of `file`.
    pub fn of(file: &RustFile) -> Self {
        let mut paths = Self::default();
        paths.add(&file.trees);
        paths
    }

    /// Adds those of `trees`.
    fn add(&mut self, trees: &[TokenTree]) {
        let mut at = 0;
        // Whether `pub` is right before.
        let mut again = false;
        while let Some(tree) = trees.get(at) {
            let rest = &trees[at..];
            let is_again = std::mem::take(&mut again);
            at += match tree {
                TokenTree::Punct(_) if is_punct(tree, '#') && is_cfg_test(rest.get(1)) => {
                    2 + item_length(&rest[2..])
                }
                TokenTree::Ident(word) if *word == "pub" => {
                    again = true;
                    1 + usize::from(rest.get(1).is_some_and(is_visibility))
                }
                TokenTree::Ident(word) if *word == "use" && is_path(rest.get(1)) => {
                    let length = item_length_of_use(rest);
                    let first = self.imports.len();
                    self.add_imports(&rest[1..length], &[]);
                    for import in &mut self.imports[first..] {
                        import.again = is_again;
                    }
                    length
                }
                TokenTree::Ident(_) => {
                    let (path, length) = path_at(rest);
                    if path.len() > 1 && !continues_path(&trees[..at]) {
                        self.others.push((path, tree.span().start().line));
                    }
                    length
                }
                TokenTree::Group(group) => {
                    self.add(&group.stream().into_iter().collect::<Vec<_>>());
                    1
                }
                _ => 1,
            };
        }
    }

    /// Adds the names of one tree of a `use` whose path so far is `before`.
    fn add_imports(&mut self, trees: &[TokenTree], before: &[String]) {
        let mut path = before.to_vec();
        let mut words = trees.iter().filter(|tree| !is_punct(tree, ':'));
        while let Some(tree) = words.next() {
            match tree {
                TokenTree::Group(group) => {
                    let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                    for part in inside.split(|tree| is_punct(tree, ',')) {
                        self.add_imports(part, &path);
                    }
                    return;
                }
                TokenTree::Ident(word) if *word == "as" => {
                    let name = words.next().map(TokenTree::to_string);
                    return self.add_import(path, name, tree);
                }
                // At the end of a path: the module itself.
                TokenTree::Ident(word) if *word == "self" && !path.is_empty() => {}
                other => path.push(other.to_string()),
            }
        }
        if let Some(last) = trees.last() {
            self.add_import(path, None, last);
        }
    }

    /// Adds the import of `path`, by the last of its names unless by another; `at` has the line.
    fn add_import(&mut self, path: Vec<String>, name: Option<String>, at: &TokenTree) {
        let Some(name) = name.or_else(|| path.last().cloned()) else {
            return;
        };
        self.imports.push(Import {
            path,
            name,
            again: false,
            line: at.span().start().line,
        });
    }
}

/// Whether `tree` follows `pub` to say for whom.
fn is_visibility(tree: &TokenTree) -> bool {
    let TokenTree::Group(group) = tree else {
        return false;
    };
    let words: Vec<String> = group.stream().into_iter().map(|tree| tree.to_string()).collect();
    let is_root = |word: &str| matches!(word, "crate" | "self" | "super");
    group.delimiter() == Delimiter::Parenthesis
        && match words.as_slice() {
            [word] => is_root(word),
            [word, ..] => word == "in",
            [] => false,
        }
}

/// Whether a path or a group of paths may begin with `tree`: not so in `impl Trait + use<'a>`.
fn is_path(tree: Option<&TokenTree>) -> bool {
    tree.is_some_and(|tree| !is_punct(tree, '<'))
}

/// How many of `trees`, which begin with `use`, belong to it, without its `;`.
fn item_length_of_use(trees: &[TokenTree]) -> usize {
    let end = trees.iter().position(|tree| is_punct(tree, ';'));
    end.unwrap_or(trees.len())
}

/// The path that `trees` begin with, as far as its names go, and how many of them it takes.
fn path_at(trees: &[TokenTree]) -> (Vec<String>, usize) {
    let mut path = vec![trees[0].to_string()];
    let mut length = 1;
    while let [a, b, TokenTree::Ident(name), ..] = &trees[length..]
        && is_punct(a, ':')
        && is_punct(b, ':')
    {
        path.push(name.to_string());
        length += 3;
    }
    (path, length)
}

/// Whether what follows `trees` continues a path that does not begin with a name: `<T as A>::b`.
fn continues_path(trees: &[TokenTree]) -> bool {
    matches!(trees, [.., a, b] if is_punct(a, ':') && is_punct(b, ':'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Paths {
        Paths::of(&RustFile::read("a.rs", text).unwrap())
    }

    fn imports(text: &str) -> Vec<String> {
        let shown = |import: &Import| {
            let again = if import.again { " again" } else { "" };
            format!(
                "{}: {} as {}{again}",
                import.line,
                import.path.join("::"),
                import.name
            )
        };
        paths(text).imports.iter().map(shown).collect()
    }

    fn others(text: &str) -> Vec<String> {
        let others = paths(text).others;
        others
            .iter()
            .map(|(path, line)| format!("{line}: {}", path.join("::")))
            .collect()
    }

    #[test]
    fn imports_are_listed_name_by_name() {
        let text =
            "use a;\nuse b::{\n    self,\n    c::{D, e as F},\n    g::*,\n};\nfn h() { use super::i::J; }\n";
        assert_eq!(
            imports(text),
            [
                "1: a as a",
                "3: b as b",
                "4: b::c::D as D",
                "4: b::c::e as F",
                "5: b::g::* as *",
                "7: super::i::J as J"
            ]
        );
    }

    #[test]
    fn what_is_exported_again_is_marked() {
        let text = "pub use a::B;\npub(in crate::c) use d::{E, f as G};\nuse h::I;\n";
        assert_eq!(
            imports(text),
            [
                "1: a::B as B again",
                "2: d::E as E again",
                "2: d::f as G again",
                "3: h::I as I"
            ]
        );
        assert_eq!(others(text), Vec::<String>::new());
    }

    #[test]
    fn paths_in_code_are_found_once_each_as_far_as_their_names_go() {
        let text = "fn a(b: c::d::E<f::G>) -> <h::I as J>::K {\n    l::m::<n::O>(p, q[r::s()])\n}\npub(super) struct T(pub (u::V, W));\n";
        assert_eq!(
            others(text),
            [
                "1: c::d::E",
                "1: f::G",
                "1: h::I",
                "2: l::m",
                "2: n::O",
                "2: r::s",
                "4: u::V"
            ]
        );
    }

    #[test]
    fn what_belongs_to_tests_is_left_out() {
        let text = "#[cfg(test)]\nuse a::b;\n#[cfg(test)]\n#[allow(c)]\nfn d() { e::f() }\nuse g::h;\nfn i() { j::k() }\n";
        assert_eq!(
            (imports(text), others(text)),
            (vec!["6: g::h as h".to_owned()], vec!["7: j::k".to_owned()])
        );
    }
}
