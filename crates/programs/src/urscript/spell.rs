//! A pose as `p[x, y, z, rx, ry, rz]`.

use armill_core::frame::Isometry;
use armill_core::units::from_mm;
use armill_formats::convention::Convention;

use super::SYNTAX;
use crate::number::{fixed, replace_numbers};
use crate::spelling::Respelling;
use crate::tokens::{Cursor, tokens};

/// Minimum number of decimals, of m and rad: a micrometre, and as in the posts.
pub(super) const DECIMALS: usize = 6;
const MOST_DECIMALS: usize = 12;

/// The numbers of a pose, m and rad.
pub(super) fn numbers(pose: &Isometry) -> [f64; 6] {
    let of = Convention::Ur.numbers_of(pose);
    std::array::from_fn(|index| if index < 3 { from_mm(of[index]) } else { of[index] })
}

/// A complete pose.
pub(super) fn whole(pose: &Isometry, out: &mut String) {
    let numbers = numbers(pose).map(|number| fixed(number, DECIMALS));
    out.push_str(&format!("p[{}]", numbers.join(", ")));
}

/// Writes a pose in place of `before`: number for number if it has six numbers, otherwise as a new pose.
pub(crate) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    match places(before) {
        Some(places) => {
            let all = places.into_iter().zip(numbers(pose)).enumerate();
            let new = all
                .filter(|(index, _)| respelling.includes(*index))
                .map(|(_, replaced)| replaced);
            replace_numbers(before, new, [DECIMALS, MOST_DECIMALS], out);
        }
        None => whole(pose, out),
    }
}

/// Byte ranges of the six numbers of `p[...]`, if it has this form.
fn places(before: &str) -> Option<Vec<std::ops::Range<usize>>> {
    let found = tokens(before, &SYNTAX);
    let mut cursor = Cursor::new(before, &found);
    cursor.word().filter(|word| word == "P")?;
    cursor.number_list(6)
}
