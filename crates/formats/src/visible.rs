//! Text for a terminal: characters that would control it are shown as escapes.
//!
//! | characters | shown |
//! |---|---|
//! | tab, line feed, carriage return before a line feed | as they are |
//! | other controls: U+0000 to U+001F, U+007F to U+009F | `\u001b` |
//! | marks of writing direction: U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069 | `\u202e` |
//!
//! The escapes are those of JSON: a JSON text remains one with the same values.

use std::borrow::Cow;
use std::fmt::Write;

/// The text with every character that would control a terminal as an escape.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(controls) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let ends_line = c == '\r' && rest.peek() == Some(&'\n');
        if controls(c) && !ends_line {
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Whether a terminal would act on this character, or show what follows in another order.
fn controls(c: char) -> bool {
    let marks =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    marks || (c.is_control() && !matches!(c, '\t' | '\n'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn controls_and_marks_of_direction_are_escaped_and_lines_and_tabs_stay() {
        assert_eq!(
            visible("a\u{1b}[31m\u{7f}\u{9b}2J\r \u{202e}b\u{2066}\u{200f}\u{61c}"),
            "a\\u001b[31m\\u007f\\u009b2J\\u000d \\u202eb\\u2066\\u200f\\u061c"
        );
        for same in ["", "plain", "a\tb\nc\r\nd", "größe µm ±", "机器人", "\u{200d}"] {
            assert_eq!(visible(same), same);
        }
    }

    #[test]
    fn json_stays_json_with_the_same_value() {
        let value = serde_json::json!({ "name": "a\u{1b}\u{85}\u{202e}b\n", "more": [1, "\t"] });
        for text in [value.to_string(), serde_json::to_string_pretty(&value).unwrap()] {
            let shown = visible(&text).into_owned();
            assert!(!shown.contains(['\u{85}', '\u{202e}']), "{shown}");
            assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).unwrap(), value);
        }
    }
}
