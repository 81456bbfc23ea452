//! A pose as `p[x, y, z, rx, ry, rz]`.

use armill_core::frame::Isometry;

use super::SYNTAX;
use crate::convention::Convention;
use crate::robot_program::number::{fixed, write_fixed};
use crate::robot_program::spelling::Anew;
use crate::robot_program::tokens::{Cursor, decimals, tokens};

/// Decimals at least, of m and rad: a micrometre, and the posts' own.
pub(super) const DECIMALS: usize = 6;
const MOST_DECIMALS: usize = 12;

/// The numbers of a pose, m and rad.
pub(super) fn numbers(pose: &Isometry) -> [f64; 6] {
    let of = Convention::Ur.numbers_of(pose);
    std::array::from_fn(|index| if index < 3 { of[index] * 1e-3 } else { of[index] })
}

/// A pose of its own.
pub(super) fn whole(pose: &Isometry, out: &mut String) {
    let numbers = numbers(pose).map(|number| fixed(number, DECIMALS));
    out.push_str(&format!("p[{}]", numbers.join(", ")));
}

/// Spells a pose in place of `before`: number for number where six stand there, else anew.
pub(in crate::robot_program) fn spell((pose, anew): (&Isometry, Anew), before: &str, out: &mut String) {
    match places(before) {
        Some(places) => {
            let mut done = 0;
            let all = places.into_iter().zip(numbers(pose)).enumerate();
            for (_, (place, number)) in all.filter(|(index, _)| anew.holds(*index)) {
                out.push_str(&before[done..place.start]);
                write_fixed(
                    out,
                    number,
                    decimals(&before[place.clone()], DECIMALS, MOST_DECIMALS),
                );
                done = place.end;
            }
            out.push_str(&before[done..]);
        }
        None => whole(pose, out),
    }
}

/// Where the six numbers of `p[...]` stand, if they are written as such.
fn places(before: &str) -> Option<Vec<std::ops::Range<usize>>> {
    let found = tokens(before, &SYNTAX);
    let mut cursor = Cursor::new(before, &found);
    cursor.word().filter(|word| word == "P")?;
    cursor.pass('[').then_some(())?;
    let mut places = Vec::new();
    for index in 0..6 {
        let start = cursor.place().start;
        cursor.number()?;
        places.push(start..cursor.before());
        cursor.pass(if index < 5 { ',' } else { ']' }).then_some(())?;
    }
    cursor.peek().is_none().then_some(places)
}
