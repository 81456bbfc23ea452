//! ARCHITECTURE.md names every crate, every folder and every file of the root, every task, and nothing else.
//!
//! The page is the entry point for new readers: the tree in its first code block, the sentence on the files
//! of the root, the line of the tasks. What each folder is for is not checked, only that it is named.

use super::Rule;
use super::tree::Tree;
use super::violation::Violation;
use crate::TASKS;

/// The rule and its reason.
pub const RULE: Rule = Rule {
    name: "architecture page",
    reason: "every folder must be described for new readers",
    check,
};

const PAGE: &str = "ARCHITECTURE.md";
/// How the sentence begins that names the files of the root.
const ROOT: &str = "In the root are";
/// What precedes the names of the tasks.
const TASKS_ARE: &str = "tasks in Rust: ";

/// Folders and files whose name begins with a dot are exempt: tools find them by that name, readers skip them.
fn check(tree: &Tree) -> Vec<Violation> {
    let Some(page) = tree.text(PAGE) else {
        return vec![Violation::new(
            PAGE,
            1,
            "the page is missing",
            "say what each folder is for",
        )];
    };
    let mut violations = missing_folders(tree, page);
    violations.extend(check_tree(tree, page));
    violations.extend(extra_files(tree, page));
    violations.extend(wrong_tasks(page));
    violations
}

/// Folders of the root and of `crates/` that the page leaves out.
fn missing_folders(tree: &Tree, page: &str) -> Vec<Violation> {
    let root = tree.folders_in("").into_iter();
    let folders = root.chain(tree.folders_in("crates/"));
    let missing = folders.filter(|folder| !folder.starts_with('.') && !names(page, folder));
    let reported = missing.map(|folder| {
        let what = format!("`{folder}/` is not mentioned");
        Violation::new(PAGE, 1, what, "say in a line what it is for")
    });
    reported.collect()
}

/// Lines of the tree that lead nowhere, or name another package than that of the folder.
fn check_tree(tree: &Tree, page: &str) -> Vec<Violation> {
    let mut violations = Vec::new();
    let mut parent = "";
    let lines = page.lines().enumerate();
    let lines = lines.skip_while(|(_, line)| !line.starts_with("```")).skip(1);
    for (index, line) in lines.take_while(|(_, line)| !line.starts_with("```")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(folder) = words.first().filter(|word| word.ends_with('/')) else {
            continue;
        };
        if !line.starts_with(' ') {
            parent = folder;
        }
        let path = if line.starts_with(' ') {
            format!("{parent}{folder}")
        } else {
            (*folder).to_owned()
        };
        if !tree.has(path.trim_end_matches('/')) {
            violations.push(Violation::new(
                PAGE,
                index + 1,
                format!("`{path}` is not there"),
                "correct it",
            ));
        }
        if let ["package", package, ..] = words[1..] {
            let manifest = format!("{path}Cargo.toml");
            let named = format!("name = \"{package}\"");
            if !tree
                .text(&manifest)
                .unwrap_or_default()
                .lines()
                .any(|line| line == named)
            {
                let what = format!("{manifest} has no package `{package}`");
                violations.push(Violation::new(
                    PAGE,
                    index + 1,
                    what,
                    "name it as its Cargo.toml does",
                ));
            }
        }
    }
    violations
}

/// Files of the root that the page does not name.
fn extra_files(tree: &Tree, page: &str) -> Vec<Violation> {
    let paragraph = page.split_once(ROOT).map_or("", |(_, rest)| rest);
    let paragraph = paragraph.split("\n\n").next().unwrap_or_default();
    let files = tree
        .paths()
        .filter(|path| !path.contains('/') && !path.starts_with('.'));
    let extra = files.filter(|file| *file != PAGE && !paragraph.contains(&format!("`{file}`")));
    let reported = extra.map(|file| {
        let hint = format!("put it into a folder; {PAGE} names what is in the root");
        Violation::new(file, 1, "a file in the root", hint)
    });
    reported.collect()
}

/// The tasks of the page, where they are not those of the program.
fn wrong_tasks(page: &str) -> Option<Violation> {
    let (before, list) = page.split_once(TASKS_ARE)?;
    let list = list.lines().next().unwrap_or_default();
    let names: Vec<&str> = TASKS.iter().map(|task| task.name).collect();
    let names = names.join(", ");
    (list != names).then(|| {
        let line = before.lines().count();
        Violation::new(PAGE, line, format!("tasks `{list}`"), format!("they are {names}"))
    })
}

/// Whether `page` has `folder/` as a whole word.
fn names(page: &str, folder: &str) -> bool {
    let with_slash = format!("{folder}/");
    page.match_indices(&with_slash)
        .any(|(at, _)| !page[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '-'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(page: &str, files: &[&str]) -> Vec<String> {
        let files: Vec<(&str, &str)> = files
            .iter()
            .map(|path| (*path, "name = \"armill-core\"\n"))
            .collect();
        let tree = Tree::of(&[&[(PAGE, page)], &files[..]].concat());
        check(&tree).into_iter().map(|violation| violation.what).collect()
    }

    #[test]
    fn a_folder_that_is_not_mentioned_is_reported() {
        let page = "crates/\n  core/ the mechanics\nmyrobots/\n";
        let files = ["crates/core/a.rs", "robots/a.toml", ".ci/run"];
        assert_eq!(reported(page, &files), ["`robots/` is not mentioned"]);
    }

    #[test]
    fn a_page_that_names_all_passes() {
        let page = "```\ncrates/\n  core/  package armill-core  mathematics\n         and no more\nrobots/  arms\n```\n\
                    In the root are `a.toml` and\n`b.md`.\n";
        let files = [
            "crates/core/Cargo.toml",
            "robots/a.toml",
            "a.toml",
            "b.md",
            ".gitignore",
        ];
        assert_eq!(reported(page, &files), [""; 0]);
    }

    #[test]
    fn a_tree_that_is_not_so_is_reported() {
        let page = "```\ncrates/\n  core/  package core\n  gone/\n```\nIn the root are `a.toml`.\n\n`b.md` is elsewhere.\n";
        assert_eq!(
            reported(page, &["crates/core/Cargo.toml", "b.md"]),
            [
                "crates/core/Cargo.toml has no package `core`",
                "`crates/gone/` is not there",
                "a file in the root"
            ]
        );
    }

    #[test]
    fn tasks_are_those_of_the_program() {
        let names: Vec<&str> = TASKS.iter().map(|task| task.name).collect();
        assert!(wrong_tasks(&format!("xtask/  {TASKS_ARE}{}\n", names.join(", "))).is_none());
        assert!(wrong_tasks(&format!("{TASKS_ARE}test\n")).is_some());
    }
}
