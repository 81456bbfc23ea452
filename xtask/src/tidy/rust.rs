//! Rust source as the rules need it: tokens with their lines, without comments, the contents of literals, and tests.
//!
//! ```text
//! let a = "// no comment"; // why       ->       let   a   =   "   ;
//! ```
//!
//! Not seen: code made by macros, modules in other places by `#[path]`, tests marked by another attribute than
//! `#[cfg(test)]`.

use proc_macro2::{Delimiter, Group, LexError, TokenStream, TokenTree};

/// A Rust file without its tests.
pub struct RustFile {
    /// From the repository root.
    pub path: String,
    /// The lines before the tests, unchanged.
    pub lines: Vec<String>,
    /// The tokens before the tests, each group as one.
    pub trees: Vec<TokenTree>,
    /// The tokens before the tests, one by one.
    pub tokens: Vec<Token>,
    /// Whether the whole file is tests, by `#![cfg(test)]`.
    pub only_tests: bool,
    /// Modules that the file declares as `#[cfg(test)] mod name;`.
    test_modules: Vec<String>,
}

/// A token and the line where it begins, from 1.
pub struct Token {
    /// As written; a lifetime with its quote, a string or a character as one quote.
    pub text: String,
    pub line: usize,
}

impl RustFile {
    /// Splits `text`. Tests begin at `#[cfg(test)]` right before a module or an impl with a body, and are taken
    /// to go on to the end of the file.
    ///
    /// # Errors
    /// In a line: where `text` is not Rust.
    pub fn read(path: &str, text: &str) -> Result<Self, String> {
        let not_rust = |error: LexError| format!("{path}:{}: not Rust: {error}", error.span().start().line);
        let mut trees: Vec<TokenTree> = text
            .parse::<TokenStream>()
            .map_err(not_rust)?
            .into_iter()
            .collect();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let marks_file =
            |row: &[TokenTree]| is_punct(&row[0], '#') && is_punct(&row[1], '!') && is_cfg_test(row.last());
        let only_tests = trees.windows(3).any(marks_file);
        let mut test_modules = Vec::new();
        for at in 0..trees.len() {
            if !is_punct(&trees[at], '#') || !is_cfg_test(trees.get(at + 1)) {
                continue;
            }
            let item = item_after_attributes(&trees[at..]);
            let words: Vec<&str> = item.iter().map(|token| token.text.as_str()).collect();
            let module = words.iter().position(|word| *word == "mod");
            match module {
                Some(place) if words.ends_with(&[";"]) => test_modules.push(words[place + 1].to_owned()),
                None if !words.starts_with(&["impl"]) => {}
                _ => {
                    lines.truncate(trees[at].span().start().line - 1);
                    trees.truncate(at);
                    break;
                }
            }
        }
        Ok(Self {
            path: path.to_owned(),
            lines,
            tokens: tokens(trees.iter().cloned()),
            trees,
            only_tests,
            test_modules,
        })
    }

    /// The paths where the test modules that this file declares may be.
    pub fn test_files(&self) -> Vec<String> {
        let (folder, file) = self.path.rsplit_once('/').unwrap_or(("", &self.path));
        let folder = match file.trim_end_matches(".rs") {
            "lib" | "main" | "mod" => folder.to_owned(),
            stem => format!("{folder}/{stem}"),
        };
        let places = |name: &String| [format!("{folder}/{name}.rs"), format!("{folder}/{name}/mod.rs")];
        self.test_modules.iter().flat_map(places).collect()
    }

    /// The tokens `words` in a row: the first of each place where they are.
    pub fn find<'a>(&'a self, words: &'a [&str]) -> impl Iterator<Item = &'a Token> {
        self.places(words).map(|at| &self.tokens[at])
    }

    /// The first names after `root::` with their lines, those of a group `root::{a, b::c}` one by one.
    pub fn names_after(&self, root: &str) -> Vec<(usize, String)> {
        let words: Vec<&str> = root.split("::").flat_map(|word| [word, ":", ":"]).collect();
        let first = |at: &usize| !matches!(&self.tokens[..*at], [.., a, b] if a.text == ":" && b.text == ":");
        let after = self
            .places(&words)
            .filter(first)
            .map(|at| &self.tokens[at + words.len()..]);
        after.flat_map(first_names).collect()
    }

    /// Where the tokens `words` are in a row.
    fn places<'a>(&'a self, words: &'a [&str]) -> impl Iterator<Item = usize> {
        let begins = move |at: &usize| self.tokens[*at].text == words[0];
        let rest = move |at: &usize| {
            let row = self.tokens.get(*at..*at + words.len()).unwrap_or_default();
            row.iter().map(|token| &token.text).eq(words)
        };
        (0..self.tokens.len()).filter(begins).filter(rest)
    }
}

/// Whether `c` can be in a Rust name.
pub fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Where `word` first occurs in `line` as a whole name.
pub fn find_word(line: &str, word: &str) -> Option<usize> {
    line.match_indices(word)
        .map(|(at, _)| at)
        .find(|at| !line[..*at].ends_with(is_word) && !line[at + word.len()..].starts_with(is_word))
}

/// All tokens of `trees`, those inside of groups too.
pub fn tokens(trees: impl IntoIterator<Item = TokenTree>) -> Vec<Token> {
    let mut found = Vec::new();
    flatten(trees, &mut found);
    found
}

/// Adds the tokens of `trees` to `found`.
fn flatten(trees: impl IntoIterator<Item = TokenTree>, found: &mut Vec<Token>) {
    for tree in trees {
        let line = tree.span().start().line;
        let text = match tree {
            TokenTree::Group(group) => {
                let (open, close) = brackets(&group);
                found.push(Token {
                    text: open.to_owned(),
                    line,
                });
                flatten(group.stream(), found);
                let line = group.span_close().start().line;
                found.push(Token {
                    text: close.to_owned(),
                    line,
                });
                continue;
            }
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                let number = text.starts_with(|c: char| c.is_ascii_digit());
                if number { text } else { "\"".to_owned() }
            }
            TokenTree::Ident(name) => match found.last_mut() {
                // A lifetime: its quote is a token of its own.
                Some(quote) if quote.text == "'" => {
                    quote.text += &name.to_string();
                    continue;
                }
                _ => name.to_string(),
            },
            TokenTree::Punct(punct) => punct.as_char().to_string(),
        };
        found.push(Token { text, line });
    }
}

/// How a group begins and ends.
fn brackets(group: &Group) -> (&'static str, &'static str) {
    match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::None => ("", ""),
    }
}

/// Whether `tree` is this character.
pub fn is_punct(tree: &TokenTree, character: char) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == character)
}

/// Whether `tree` is what follows the `#` of an attribute for tests.
pub fn is_cfg_test(tree: Option<&TokenTree>) -> bool {
    let words = tokens(tree.cloned());
    words
        .iter()
        .map(|token| token.text.as_str())
        .eq(["[", "cfg", "(", "test", ")", "]"])
}

/// The item after the attributes that `trees` begins with, to its `;` or its body.
fn item_after_attributes(mut trees: &[TokenTree]) -> Vec<Token> {
    while let [hash, _, rest @ ..] = trees
        && is_punct(hash, '#')
    {
        trees = rest;
    }
    tokens(trees[..item_length(trees)].iter().cloned())
}

/// How many of `trees` the item takes that they begin with: to its `;` or its body.
pub fn item_length(trees: &[TokenTree]) -> usize {
    let is_end = |tree: &TokenTree| match tree {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        other => is_punct(other, ';'),
    };
    trees.iter().position(is_end).map_or(trees.len(), |end| end + 1)
}

/// Whether a file at `path` contains only tests or benchmarks.
pub fn is_test_path(path: &str) -> bool {
    let mut parts = path.rsplit('/');
    let file = parts.next().unwrap_or_default();
    file == "tests.rs"
        || file.ends_with("_tests.rs")
        || parts.any(|part| part == "tests" || part == "benches")
}

/// The name that `tokens` begins with, or the first name of each entry of the group there.
fn first_names(tokens: &[Token]) -> Vec<(usize, String)> {
    let mut names = Vec::new();
    let mut depth = 0;
    let mut expected = true;
    for Token { text, line } in tokens {
        match text.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "," if depth == 1 => expected = true,
            name => {
                if expected && name.starts_with(is_word) {
                    names.push((*line, name.to_owned()));
                }
                expected = false;
            }
        }
        // Without a group the first token decides; with one, its closing brace ends it.
        if depth <= 0 {
            break;
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> RustFile {
        RustFile::read("a.rs", text).unwrap()
    }

    fn words(text: &str) -> String {
        let words: Vec<String> = file(text).tokens.into_iter().map(|token| token.text).collect();
        words.join(" ")
    }

    #[test]
    fn comments_and_literals_are_taken_out() {
        let text = "a /* b /* c */ d */ e // f\n\"g \\\" h\" i 'j' '\\'' &'k l\nr#\"m \" n\"# o 1.5\n";
        assert_eq!(words(text), "a e \" i \" \" & 'k l \" o 1.5");
    }

    #[test]
    fn lines_keep_their_numbers_across_long_literals() {
        let file = file("let a = \"one\ntwo\";\n/* three\nfour */ b\n");
        assert_eq!((file.lines.len(), file.tokens.last().unwrap().line), (4, 4));
    }

    #[test]
    fn code_ends_where_the_tests_begin() {
        let text = "one\n#[cfg(test)]\nuse x;\ntwo\n#[cfg(test)]\nmod tests {\nthree\n}\n";
        assert_eq!(file(text).lines, ["one", "#[cfg(test)]", "use x;", "two"]);
        assert_eq!(words(text), "one # [ cfg ( test ) ] use x ; two");
        let file = file("one\n#[cfg(test)]\nmod cases;\ntwo\n");
        assert_eq!(file.lines.len(), 4);
        assert_eq!(
            file.test_files(),
            ["/a/cases.rs", "/a/cases/mod.rs"].map(str::to_owned)
        );
    }

    #[test]
    fn groups_are_reported_name_by_name() {
        let file = file("use crate::{\n    a::{b, c},\n    d,\n};\ncrate::e::f(mycrate::g);\n");
        let names = file.names_after("crate");
        assert_eq!(
            names,
            [(2, "a".to_owned()), (3, "d".to_owned()), (5, "e".to_owned())]
        );
    }

    #[test]
    fn text_that_is_not_rust_is_reported_with_its_line() {
        let problem = RustFile::read("a.rs", "a\n)\n").err().unwrap();
        assert!(problem.starts_with("a.rs:2: not Rust"), "{problem}");
    }
}
