//! Plain words: those that a native engineer would stumble over are not used, each with what to write instead.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "plain words",
    reason: "readers skim, search and translate by machine: one standard term per idea, no figures of speech",
    check,
};

/// A word or phrase, in lower case with `~` where it is cut (this file must not break its own rule), and what to write
/// instead and why.
const WORDS: &[(&str, &str)] = &[
    ("to~ld", "given, specified, reported: numbers do not speak"),
    ("unto~ld", "not given, unknown: see above"),
    ("te~lls", "reports, states, shows: programs do not speak"),
    ("forete~ll", "predict: the term of the field"),
    ("no~body", "not known, not modelled: the passive needs no agent"),
    ("some~body", "the user, or the passive"),
    ("who~ever", "anyone who, or the passive"),
    ("like~wise", "the same: say what is the same"),
    ("a~new", "again"),
    ("there~by", "say by what"),
    ("shar~er", "contributor: the term of ISO/IEC Guide 98-3"),
    ("shar~ers", "contributors: the term of ISO/IEC Guide 98-3"),
    ("sigh~ted", "screened, evaluated"),
    ("apprai~sal", "evaluation, score"),
    ("untol~ds", "unknowns"),
    ("cho~re", "task: the term of cargo and npm"),
    ("cho~res", "tasks: the term of cargo and npm"),
    ("gives wa~y", "deflects: the term of mechanics"),
    ("give wa~y", "deflect: the term of mechanics"),
    ("as dra~wn", "nominal, as programmed: a path is not a drawing"),
    ("joint to spa~re", "redundant joint: ISO 8373"),
    ("joints to spa~re", "redundant joints: ISO 8373"),
    ("this ve~ry", "this"),
    ("makes up fo~r", "compensates"),
    (
        "stra~ying",
        "deflection under the cut, force-deflection equilibrium",
    ),
];

/// Words that are right where they are: path, word, why.
const EXCEPTIONS: &[(&str, &str, &str)] = &[];

/// Endings of files that people read; pages that are generated follow their sources.
const ENDINGS: &[&str] = &[".md", ".rs", ".py", ".pyi", ".ts", ".toml", ".html"];
const GENERATED: &[&str] = &["web/src/api.d.ts", "CHANGELOG.md"];

fn check(tree: &Tree) -> Vec<Violation> {
    let words: Vec<(String, &str)> = WORDS
        .iter()
        .map(|(word, instead)| (word.replace('~', ""), *instead))
        .collect();
    let mut violations = Vec::new();
    for (path, text) in tree.texts() {
        if !ENDINGS.iter().any(|ending| path.ends_with(ending)) || GENERATED.contains(&path) {
            continue;
        }
        let text = text.to_lowercase();
        let words: Vec<_> = words.iter().filter(|(word, _)| text.contains(word)).collect();
        for (index, line) in text.lines().enumerate() {
            for (word, instead) in &words {
                let excepted = EXCEPTIONS.iter().any(|(at, of, _)| *at == path && of == word);
                if !excepted && contains_word(line, word) {
                    let hint = format!("write: {instead}");
                    violations.push(Violation::new(path, index + 1, format!("`{word}`"), hint));
                }
            }
        }
    }
    violations
}

/// Whether `word` is in `line` as a whole word; the parts of a name with underscores are words.
fn contains_word(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        let is_letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
        let (before, after) = (&line[..at], &line[at + word.len()..]);
        !is_letter(before.chars().next_back()) && !is_letter(after.chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_reported_alone_and_in_names_but_not_inside_of_others() {
        let text = "it is to~ld\nfn is_to~ld()\nbeto~lden\n// Like~wise.\n".replace('~', "");
        let found: Vec<usize> = check(&Tree::of(&[("crates/study/src/a.rs", &text)]))
            .iter()
            .map(|violation| violation.line)
            .collect();
        assert_eq!(found, [1, 2, 4]);
    }

    #[test]
    fn changelog_and_generated_files_are_left_alone() {
        let text = "to~ld".replace('~', "");
        assert!(check(&Tree::of(&[("CHANGELOG.md", &text), ("web/src/api.d.ts", &text)])).is_empty());
    }
}
