//! Refuses text that nests so deep that walking it would exhaust the stack.
//!
//! The TOML parser bounds brackets (80) and the parts of one key (80), but not their product: tables within dotted keys
//! reach 6400 levels, and even dropping such a tree overflows a thread's stack. So levels are counted on the tokens
//! first.

use toml_parser::lexer::TokenKind;

use super::problem::Problem;
use super::source::Source;

/// Brackets and dotted key parts within one another; real files need fewer than ten.
const MOST_LEVELS: usize = 64;

/// The first place that nests deeper than [`MOST_LEVELS`], counted from above: a point in a number counts as a level.
pub(super) fn too_deep(source: &Source) -> Option<Problem> {
    // Brackets that are open, each with the dots of the key before it: `a.b = [` makes two levels.
    let mut open: Vec<(TokenKind, usize)> = Vec::new();
    let mut dots = 0_usize;
    let mut levels = 0_usize;
    for token in toml_parser::Source::new(source.text()).lex() {
        let kind = token.kind();
        match kind {
            TokenKind::Dot => dots += 1,
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                open.push((kind, dots));
                levels += 1 + dots;
                dots = 0;
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                if let Some((_, outer)) = open.pop_if(|(opening, _)| closes(kind, *opening)) {
                    levels -= 1 + outer;
                    dots = outer;
                }
            }
            // The next key of an inline table, or the next number of a list, begins its own count.
            TokenKind::Comma => dots = 0,
            // Outside of brackets a line is a key of its own; inside, a list may go on over lines.
            TokenKind::Newline if open.is_empty() => dots = 0,
            _ => {}
        }
        if levels + dots > MOST_LEVELS {
            let message = format!("values nest deeper than {MOST_LEVELS} levels");
            let hint = "brackets and dotted keys each count as one level".to_owned();
            return Some(source.problem(token.span().start()..token.span().end(), message, Some(hint)));
        }
    }
    None
}

/// Whether a closing bracket fits the one that is open; one that does not is left to the parser, which refuses it.
fn closes(kind: TokenKind, opening: TokenKind) -> bool {
    match kind {
        TokenKind::RightSquareBracket => opening == TokenKind::LeftSquareBracket,
        _ => opening == TokenKind::LeftCurlyBracket,
    }
}
