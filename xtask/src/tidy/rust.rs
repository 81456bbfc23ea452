//! Rust text as the rules need it: code without comments, literals and tests. No parser: the source is
//! formatted by rustfmt, and a rule that looks at names needs no more.
//!
//! ```text
//! let a = "// no comment"; // why       ->       let a = ";         one quote for a literal
//! ```
//!
//! Lines keep their numbers. What it does not see: code made by macros, modules in other places by `#[path]`,
//! tests marked by another attribute than `#[cfg(test)]`.

/// A Rust file, split into lines.
pub struct RustFile<'a> {
    /// From the repository root.
    pub path: &'a str,
    /// Every line unchanged, tests included.
    pub raw: Vec<&'a str>,
    /// The lines before the tests; comments and the contents of literals are taken out.
    pub code: Vec<String>,
    /// Whether the whole file is tests, by its place, its name or `#![cfg(test)]`.
    pub only_tests: bool,
    /// Modules that the file declares as `#[cfg(test)] mod name;`.
    test_modules: Vec<String>,
}

impl<'a> RustFile<'a> {
    /// Splits `text`. Tests begin at `#[cfg(test)]` right before a module or an impl with a body, and are taken
    /// to go on to the end of the file.
    pub fn read(path: &'a str, text: &'a str) -> Self {
        let mut code = code_lines(text);
        let mut test_modules = Vec::new();
        let mut tests_begin = code.len();
        for (index, _) in code
            .iter()
            .enumerate()
            .filter(|(_, line)| line.trim_start().starts_with("#[cfg(test)]"))
        {
            let item = item_after_attributes(&code[index..]);
            let words: Vec<&str> = item
                .split(|c: char| !is_word(c))
                .filter(|word| !word.is_empty())
                .collect();
            let module = words
                .iter()
                .position(|word| *word == "mod")
                .and_then(|at| words.get(at + 1));
            match module {
                Some(name) if item.ends_with(';') => test_modules.push((*name).to_owned()),
                None if !item.starts_with("impl") => {}
                _ => {
                    tests_begin = index;
                    break;
                }
            }
        }
        let only_tests = is_test_path(path) || code.iter().any(|line| line.trim() == "#![cfg(test)]");
        code.truncate(tests_begin);
        Self {
            path,
            raw: text.lines().collect(),
            code,
            only_tests,
            test_modules,
        }
    }

    /// The paths where the test modules that this file declares may be.
    pub fn test_files(&self) -> Vec<String> {
        let folder = self.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        let stem = self
            .path
            .rsplit('/')
            .next()
            .unwrap_or_default()
            .trim_end_matches(".rs");
        let folder = match stem {
            "lib" | "main" | "mod" => folder.to_owned(),
            _ => format!("{folder}/{stem}"),
        };
        let places = |name: &String| [format!("{folder}/{name}.rs"), format!("{folder}/{name}/mod.rs")];
        self.test_modules.iter().flat_map(places).collect()
    }

    /// The first names after `root::` with their lines, those of a group `root::{a, b::c}` one by one.
    pub fn names_after(&self, root: &str) -> Vec<(usize, String)> {
        let text = self.code.join("\n");
        let mut names = Vec::new();
        for (at, _) in text.match_indices(&format!("{root}::")) {
            if text[..at].ends_with(|c: char| is_word(c) || c == ':') {
                continue;
            }
            let after = at + root.len() + "::".len();
            for (offset, name) in first_names(&text[after..]) {
                names.push((1 + text[..after + offset].matches('\n').count(), name));
            }
        }
        names
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

/// Whether a file at `path` contains only tests or benchmarks.
fn is_test_path(path: &str) -> bool {
    let mut parts = path.rsplit('/');
    let file = parts.next().unwrap_or_default();
    file == "tests.rs"
        || file.ends_with("_tests.rs")
        || parts.any(|part| part == "tests" || part == "benches")
}

/// The first line that is not an attribute, on the way past `#[cfg(test)]`.
fn item_after_attributes(lines: &[String]) -> &str {
    let without_attribute = |line: &'_ String| line.trim().is_empty() || line.trim().starts_with("#[");
    let first = lines
        .first()
        .map_or("", |line| line.trim().trim_start_matches("#[cfg(test)]").trim());
    if !first.is_empty() && !first.starts_with("#[") {
        return first;
    }
    lines
        .iter()
        .find(|line| !without_attribute(line))
        .map_or("", |line| line.trim())
}

/// The name at the start of `text`, or the first name of each entry of the group there, with its offset.
fn first_names(text: &str) -> Vec<(usize, String)> {
    let mut names = Vec::new();
    let mut depth = 0;
    let mut expected = true;
    for (at, c) in text.char_indices() {
        if expected && is_word(c) {
            names.push((at, text[at..].chars().take_while(|c| is_word(*c)).collect()));
            expected = false;
        }
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => expected = true,
            _ => {}
        }
        // Without a group the first character decides; with one, its closing brace ends it.
        if depth <= 0 && !c.is_whitespace() {
            break;
        }
    }
    names
}

/// The lines of `text` without comments; literals lose what is between their quotes.
fn code_lines(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let mut code = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(&c) = chars.get(at) {
        let rest = &chars[at..];
        let end = at
            + match (c, rest.get(1)) {
                ('/', Some('/')) => rest.iter().position(|c| *c == '\n').unwrap_or(rest.len()),
                ('/', Some('*')) => block_comment_length(rest),
                ('"', _) => string_length(rest),
                ('\'', _) => char_length(rest),
                ('r', Some('"' | '#')) if !code.ends_with(|c: char| is_word(c) && c != 'b') => {
                    raw_length(rest)
                }
                _ => 1,
            };
        let end = end.min(chars.len());
        if end == at + 1 {
            code.push(c);
        } else {
            // The removed text may not join its neighbours, and lines must still be counted.
            code.push(if c == '/' { ' ' } else { '"' });
            code.extend(chars[at..end].iter().filter(|c| **c == '\n'));
        }
        at = end;
    }
    code.lines().map(|line| line.trim_end().to_owned()).collect()
}

/// Characters of the block comment that `text` begins with; they nest.
fn block_comment_length(text: &[char]) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < text.len() {
        match text[at..] {
            ['/', '*', ..] => (depth, at) = (depth + 1, at + 2),
            ['*', '/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Characters of the string that `text` begins with, quotes included.
fn string_length(text: &[char]) -> usize {
    let mut at = 1;
    while at < text.len() && text[at] != '"' {
        at += if text[at] == '\\' { 2 } else { 1 };
    }
    at + 1
}

/// Characters of the character literal that `text` begins with; 1 for the quote of a lifetime.
fn char_length(text: &[char]) -> usize {
    match text {
        ['\'', '\\', _, rest @ ..] => 4 + rest.iter().position(|c| *c == '\'').unwrap_or(rest.len()),
        ['\'', _, '\'', ..] => 3,
        _ => 1,
    }
}

/// Characters of the raw string that `text` begins with; 1 where `r` begins something else.
fn raw_length(text: &[char]) -> usize {
    let hashes = text[1..].iter().take_while(|c| **c == '#').count();
    if text.get(1 + hashes) != Some(&'"') {
        return 1;
    }
    let body = 2 + hashes;
    let closes = |window: &[char]| window[0] == '"' && window[1..].iter().all(|c| *c == '#');
    let length = text[body..].windows(1 + hashes).position(closes);
    length.map_or(text.len(), |length| body + length + 1 + hashes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_are_taken_out() {
        let text = "a /* b /* c */ d */ e // f\n\"g \\\" h\" i 'j' '\\'' &'k l\nr#\"m \" n\"# o\n";
        assert_eq!(code_lines(text), ["a   e", "\" i \" \" &'k l", "\" o"]);
    }

    #[test]
    fn lines_keep_their_numbers_across_long_literals() {
        let lines = code_lines("let a = \"one\ntwo\";\n/* three\nfour */ b\n");
        assert_eq!(lines.len(), 4);
        assert!(lines[3].ends_with('b'));
    }

    #[test]
    fn code_ends_where_the_tests_begin() {
        let file = RustFile::read(
            "a.rs",
            "one\n#[cfg(test)]\nuse x;\ntwo\n#[cfg(test)]\nmod tests {\nthree\n",
        );
        assert_eq!(file.code, ["one", "#[cfg(test)]", "use x;", "two"]);
        let file = RustFile::read("a.rs", "one\n#[cfg(test)]\nmod cases;\ntwo\n");
        assert_eq!(file.code.len(), 4);
        assert_eq!(
            file.test_files(),
            ["/a/cases.rs", "/a/cases/mod.rs"].map(str::to_owned)
        );
    }

    #[test]
    fn groups_are_reported_name_by_name() {
        let file = RustFile::read(
            "a.rs",
            "use crate::{\n    a::{b, c},\n    d,\n};\ncrate::e::f(mycrate::g);\n",
        );
        let names = file.names_after("crate");
        assert_eq!(
            names,
            [(2, "a".to_owned()), (3, "d".to_owned()), (5, "e".to_owned())]
        );
    }
}
