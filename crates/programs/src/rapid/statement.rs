//! A module as statements: they end with `;`; block heads end with their line or a word.

use crate::tokens::{Cursor, Kind, Token};

/// Heads that end with their line.
const LINES: [&str; 14] = [
    "MODULE",
    "ENDMODULE",
    "PROC",
    "ENDPROC",
    "FUNC",
    "ENDFUNC",
    "TRAP",
    "ENDTRAP",
    "RECORD",
    "ENDRECORD",
    "TEST",
    "VERSION",
    "LANGUAGE",
    "%",
];
/// Heads of a single word.
const WORDS: [&str; 8] = [
    "ELSE", "ENDIF", "ENDFOR", "ENDWHILE", "ENDTEST", "ERROR", "UNDO", "BACKWARD",
];

/// The statements of these tokens, without their `;`.
pub(super) fn statements<'a>(text: &'a str, tokens: &'a [Token]) -> Vec<Cursor<'a>> {
    let mut all = Vec::new();
    let mut rest = tokens;
    while let Some(first) = rest.first() {
        if first.is(';') {
            rest = &rest[1..];
            continue;
        }
        let length = length(text, rest);
        all.push(Cursor::new(text, &rest[..length]));
        rest = &rest[length..];
    }
    all
}

/// Number of tokens of the first statement, at least one.
fn length(text: &str, rest: &[Token]) -> usize {
    let first = &text[rest[0].span()];
    let word = first.to_ascii_uppercase();
    let after = |requested: &dyn Fn(&Token) -> bool| {
        let end = rest.iter().position(|token| token.is(';') || requested(token));
        end.map_or(rest.len(), |index| index + usize::from(!rest[index].is(';')))
    };
    let is = |token: &Token, requested: &str| text[token.span()].eq_ignore_ascii_case(requested);
    let is_label =
        rest.get(1).is_some_and(|token| token.is(':')) && !rest.get(2).is_some_and(|token| token.is('='));
    match word.as_str() {
        head if LINES.contains(&head) => {
            let mut depth = 0_usize;
            let mut line = rest[0].line;
            let end = rest.iter().position(|token| {
                let ends = token.line != line && depth == 0;
                match token.kind {
                    Kind::Mark('(') => depth += 1,
                    Kind::Mark(')') => depth = depth.saturating_sub(1),
                    _ => {}
                }
                line = token.line;
                ends
            });
            end.unwrap_or(rest.len())
        }
        head if WORDS.contains(&head) => 1,
        "WHILE" | "FOR" => after(&|token| is(token, "DO")),
        "DEFAULT" | "CASE" => after(&|token| token.is(':')),
        "IF" | "ELSEIF" => {
            // `IF a THEN`, or `IF a MoveL ...;` without.
            let end = rest
                .iter()
                .position(|token| token.is(';') || is(token, "THEN") || is_move(&text[token.span()]))
                .unwrap_or(rest.len());
            end + usize::from(rest.get(end).is_some_and(|token| is(token, "THEN")))
        }
        _ if is_label && rest[0].kind == Kind::Word => 2,
        _ => after(&|_| false),
    }
}

/// Whether a word names a move of the language or of a process.
pub(super) fn is_move(word: &str) -> bool {
    word.get(..4)
        .is_some_and(|begin| begin.eq_ignore_ascii_case("Move"))
}
