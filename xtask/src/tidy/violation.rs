//! One place that breaks a rule.
//!
//! The line that is printed is one that an editor opens.

use std::fmt;

/// Prints as `path:line: what; hint`.
#[derive(Debug, PartialEq, Eq)]
pub struct Violation {
    /// From the repository root, with `/`.
    pub path: String,
    /// From 1; 1 where the whole file is meant.
    pub line: usize,
    /// The offending thing, and the limit where there is one.
    pub what: String,
    /// What to do about it.
    pub hint: String,
}

impl Violation {
    /// A violation at `path:line`.
    pub fn new(path: &str, line: usize, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            line,
            what: what.into(),
            hint: hint.into(),
        }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}; {}", self.path, self.line, self.what, self.hint)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_violation_is_one_line_that_an_editor_can_jump_to() {
        let violation = Violation::new("a/b.rs", 7, "`x` has no unit", "name it x_mm");
        assert_eq!(violation.to_string(), "a/b.rs:7: `x` has no unit; name it x_mm");
    }
}
