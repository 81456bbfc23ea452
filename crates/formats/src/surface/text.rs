//! Text in headers that are ASCII.

/// One line of printable ASCII; other characters become a question mark.
pub(super) fn ascii_line(text: &str) -> String {
    let plain = |character: char| match character {
        ' '..='~' => character,
        _ => '?',
    };
    text.chars().map(plain).collect()
}
