//! The path of a value, as text: `analysis[2].distances_mm[0]`, `material."EN AW-6082".density`.
//!
//! ```text
//! path  = part { "." key | "[" index "]" }      part = key | "[" index "]"
//! key   = letters, digits, _, -                 or any text in double quotes, with \ before " and \
//! index = from 0
//! ```
//!
//! [`joined`] writes paths and [`steps`] reads them, leniently: a path comes from our own code, never from a user, and
//! one that finds nothing costs no more than a problem reported at a parent.

/// One part of a path.
#[derive(Debug, PartialEq)]
pub(super) enum Step {
    /// A field of a table, as it is called once quotes are taken off.
    Key(String),
    /// An entry of a list, from 0.
    Entry(usize),
}

/// A path longer by a key, which is quoted unless it is bare in TOML.
pub(crate) fn joined(path: &str, key: &str) -> String {
    let bare = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { format!("{key:?}") };
    if path.is_empty() {
        key
    } else {
        format!("{path}.{key}")
    }
}

/// The parts of a path; what cannot be understood is taken as a key that will not be found.
pub(super) fn steps(path: &str) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        rest = rest.strip_prefix('.').unwrap_or(rest);
        if let Some((inside, after)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            steps.push(
                inside
                    .parse()
                    .map_or_else(|_| Step::Key(inside.to_owned()), Step::Entry),
            );
            rest = after;
        } else if let Some((key, after)) = quoted(rest) {
            steps.push(Step::Key(key));
            rest = after;
        } else {
            // At least one character is consumed, so that even an unmatched `[` is passed.
            let end = rest
                .char_indices()
                .skip(1)
                .find(|(_, c)| matches!(c, '.' | '['))
                .map_or(rest.len(), |(at, _)| at);
            steps.push(Step::Key(rest[..end].to_owned()));
            rest = &rest[end..];
        }
    }
    steps
}

/// A key in double quotes and what follows it.
///
/// `None` where no quote begins it, or none ends it. Whatever follows a backslash is taken unchanged.
fn quoted(path: &str) -> Option<(String, &str)> {
    let body = path.strip_prefix('"')?;
    let mut key = String::new();
    let mut characters = body.char_indices();
    while let Some((at, character)) = characters.next() {
        match character {
            '"' => return Some((key, &body[at + 1..])),
            '\\' => key.push(characters.next()?.1),
            _ => key.push(character),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_keys_and_entries() {
        let key = |name: &str| Step::Key(name.to_owned());
        assert_eq!(
            steps("analysis[2].x_mm[0]"),
            [key("analysis"), Step::Entry(2), key("x_mm"), Step::Entry(0)]
        );
        assert_eq!(
            steps(r#"a."b.c \"d\"".e"#),
            [key("a"), key("b.c \"d\""), key("e")]
        );
        assert_eq!(steps(""), []);
    }

    #[test]
    fn a_joined_path_is_read_back() {
        let path = joined(&joined("a", "EN \"AW\".6082"), "b");
        let key = |name: &str| Step::Key(name.to_owned());
        assert_eq!(steps(&path), [key("a"), key("EN \"AW\".6082"), key("b")]);
    }
}
