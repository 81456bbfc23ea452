//! Finds a value of the tree by its path.

use std::ops::Range;

use super::path::{Step, steps};
use super::tree::{Node, Value};

/// The span of the value at `path`, or of the last value on the way there; the start of the file if there is none.
pub(super) fn nearest_span(root: &Node, path: &str) -> Range<usize> {
    walk(root, &steps(path)).0
}

/// Whether there is a value at `path`.
pub(super) fn exists(root: &Node, path: &str) -> bool {
    walk(root, &steps(path)).1
}

/// The value at `path`, if there is one.
pub(super) fn found<'a>(root: &'a Node, path: &str) -> Option<&'a Node> {
    steps(path).iter().try_fold(root, below)
}

/// The last span reached, and whether that is the end of the path.
fn walk(root: &Node, steps: &[Step]) -> (Range<usize>, bool) {
    let mut here = root;
    for step in steps {
        let Some(next) = below(here, step) else {
            return (here.span.clone(), false);
        };
        here = next;
    }
    (here.span.clone(), true)
}

/// The value one step below `here`, if there is one.
fn below<'a>(here: &'a Node, step: &Step) -> Option<&'a Node> {
    match (step, &here.value) {
        (Step::Key(key), Value::Table(table)) => table.get(key).map(|entry| &entry.node),
        (Step::Entry(index), Value::List(entries)) => entries.get(*index),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_path_is_only_a_key_that_is_not_found() {
        for path in ["[", "a[", "a[x]", "\"open", "..", "a..b", "]", "a[1", "ä[é]"] {
            let empty = Node {
                span: 0..0,
                value: Value::Table(Default::default()),
            };
            assert_eq!(nearest_span(&empty, path), 0..0, "{path}");
        }
    }
}
