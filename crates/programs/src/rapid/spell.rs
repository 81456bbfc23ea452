//! A pose as a robtarget.

use std::ops::Range;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use super::SYNTAX;
use crate::number::{fixed, replace_numbers};
use crate::spelling::Respelling;
use crate::tokens::{Cursor, Kind, tokens};

/// Minimum and maximum number of decimals of mm and of a quaternion.
const MM: usize = 3;
const QUATERNION: usize = 8;
const MOST_DECIMALS: usize = 12;

/// Writes a pose in place of `before`: number for number in a robtarget. A name, or a target with an offset, becomes a
/// robtarget with the posture and the external axes of that name.
pub(crate) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    let numbers = Convention::Abb.numbers_of(pose);
    let (place, turn) = numbers.split_at(3);
    let (mut base, mut entries) = (before.trim(), Vec::new());
    let is_list = base.starts_with('[');
    // `Offs(RelTool(p10, ...), ...)` is based on p10.
    while !base.starts_with('[') {
        let Some((_, arguments)) = base.split_once('(') else {
            break;
        };
        let inner = parts(arguments).into_iter().next().unwrap_or(0..arguments.len());
        base = arguments[inner].trim();
    }
    if let Some(inner) = base.strip_prefix('[') {
        entries = parts(inner)
            .into_iter()
            .map(|entry| entry.start + 1..entry.end + 1)
            .collect();
    }
    match (is_list, entries.as_slice()) {
        (true, [first, second, ..]) => {
            let begin = before.len() - before.trim_start().len();
            out.push_str(&before[..begin + first.start]);
            list(place, &base[first.clone()], MM, out);
            out.push_str(&base[first.end..second.start]);
            match respelling {
                Respelling::Pose => list(turn, &base[second.clone()], QUATERNION, out),
                Respelling::Place => out.push_str(&base[second.clone()]),
            }
            out.push_str(&before[begin + second.end..]);
        }
        (_, entries) => {
            let (confdata, external) = match entries {
                [_, _, confdata, external, ..] => (
                    base[confdata.clone()].to_owned(),
                    base[external.clone()].to_owned(),
                ),
                _ => (format!("{base}.robconf"), format!("{base}.extax")),
            };
            out.push('[');
            list(place, "", MM, out);
            out.push(',');
            list(turn, "", QUATERNION, out);
            out.push_str(&format!(",{},{}]", confdata.trim(), external.trim()));
        }
    }
}

/// The numbers in place of the list `before`, or a new list if `before` has another number of entries.
fn list(numbers: &[f64], before: &str, least: usize, out: &mut String) {
    match places(before, numbers.len()) {
        Some(places) => {
            let new = places.into_iter().zip(numbers.iter().copied());
            replace_numbers(before, new, [least, MOST_DECIMALS], out);
        }
        None => {
            let written: Vec<String> = numbers.iter().map(|number| fixed(*number, least)).collect();
            // Surrounding blanks are kept.
            let inner = before.trim();
            let begin = before.len() - before.trim_start().len();
            out.push_str(&before[..begin]);
            out.push_str(&format!("[{}]", written.join(",")));
            out.push_str(&before[begin + inner.len()..]);
        }
    }
}

/// Byte ranges of the numbers of `[1, 2, 3]`.
fn places(before: &str, count: usize) -> Option<Vec<Range<usize>>> {
    let found: Vec<_> = tokens(before, &SYNTAX)
        .into_iter()
        .filter(|token| token.kind != Kind::Line)
        .collect();
    Cursor::new(before, &found).number_list(count)
}

/// The parts between the commas (or before optional arguments) of a list, from after its opening mark to its closing
/// one.
fn parts(text: &str) -> Vec<Range<usize>> {
    let (mut all, mut start, mut depth) = (Vec::new(), 0, 0_usize);
    for token in tokens(text, &SYNTAX) {
        match token.kind {
            Kind::Mark('(' | '[' | '{') => depth += 1,
            Kind::Mark(')' | ']' | '}') if depth == 0 => {
                all.push(start..token.start);
                break;
            }
            Kind::Mark(')' | ']' | '}') => depth -= 1,
            Kind::Mark(',' | '\\') if depth == 0 => {
                all.push(start..token.start);
                start = token.end;
            }
            _ => {}
        }
    }
    all
}

/// The first two entries of a robtarget.
pub(super) fn whole(pose: &Isometry, out: &mut String) {
    let numbers = Convention::Abb.numbers_of(pose);
    list(&numbers[..3], "", MM, out);
    out.push(',');
    list(&numbers[3..], "", QUATERNION, out);
}
