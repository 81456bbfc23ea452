//! Comments with messages: `(MSG,text)` and `(DEBUG,text #5420)`, in which parameters are replaced by their values.
//!
//! | comment | message |
//! |---|---|
//! | `(MSG, text)` | the text unchanged |
//! | `(DEBUG, x is #5420)` | parameters as numbers with six decimals, `######` where they have no value |
//! | any other | nothing |
//!
//! Source: LinuxCNC documentation, G-code overview, messages.

use super::expression::{Reader, Values};

/// The message of a comment to the operator, if there is one.
pub(super) fn message(comment: &[u8], values: &dyn Values) -> Option<String> {
    let comment = comment.trim_ascii_start();
    let (word, text) = comment.split_at_checked(comment.iter().position(|byte| *byte == b',')?)?;
    let text = text.get(1..).unwrap_or_default();
    let word = word.trim_ascii();
    if word.eq_ignore_ascii_case(b"msg") {
        return Some(String::from_utf8_lossy(text).into_owned());
    }
    if !word.eq_ignore_ascii_case(b"debug") {
        return None;
    }
    let mut said = Vec::new();
    let mut at = 0;
    while let Some(byte) = text.get(at).copied() {
        if byte == b'#' {
            let rest = text.get(at..).unwrap_or_default();
            let length = name_length(rest);
            let name: Vec<u8> = rest
                .get(..length)
                .unwrap_or_default()
                .iter()
                .filter(|byte| !byte.is_ascii_whitespace())
                .map(u8::to_ascii_lowercase)
                .collect();
            match Reader::new(&name, 0, values).value() {
                Ok(value) => said.extend_from_slice(format!("{value:.6}").as_bytes()),
                Err(_) => said.extend_from_slice(b"######"),
            }
            at += length;
        } else {
            said.push(byte);
            at += 1;
        }
    }
    Some(String::from_utf8_lossy(&said).into_owned())
}

/// How long the parameter at the start is: `#5420`, `#<name>`.
///
/// A name that is not closed goes to the end.
fn name_length(text: &[u8]) -> usize {
    match text.get(1) {
        Some(b'<') => text
            .iter()
            .position(|byte| *byte == b'>')
            .map_or(text.len(), |end| end + 1),
        _ => {
            1 + text
                .iter()
                .skip(1)
                .take_while(|byte| byte.is_ascii_digit())
                .count()
        }
    }
}
