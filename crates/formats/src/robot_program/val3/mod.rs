//! Staubli VAL3: projects of controllers CS8C and CS9 (s7, s8), a folder of `.pjx`, `.dtx`, `.pgx`.
//!
//! The data (`.dtx`) hold the points, the programs (`.pgx`) go to them.
//!
//! | in the project | here |
//! |---|---|
//! | `pointRx`: `x y z rx ry rz`, mm and deg | a pose in the frame that `fatherId` names |
//! | `shoulder`, `elbow`, `wrist` | righty rear; enegative lower; wnegative flip; `ssame`, `sfree`, ... say nothing |
//! | `jointRx`: `j1` to `j6`, deg | joints |
//! | `frame`, `tool` with `fatherId` | told, back to `world` and `flange` |
//! | `mdesc`: `tmax`, mm/s | speed of the tip in `movel`, `movec`; 99999 and more says nothing of it |
//! | `movej`, `movel`, `movec` via, end | joint; straight; arc |
//! | `appro(..)`, `here(..)`, `p[i]`, points of libraries, parameters | [`Target::Elsewhere`](super::Target::Elsewhere) |
//!
//! An attribute that is left out is zero, as controllers write. Read is the program `start`, or the only one, or the file
//! that comes first; what it calls is followed where it is given.
//!
//! Source: the RoboDK posts for VAL3, their data and their order of the words of a posture. `[recalled]` 99999 as no limit,
//! length of names, `world` where no `fatherId` is told; elbows behind axis 1.
//!
//! In reading order: `tags` XML as far as it is needed, `data` points and what they count in, `code` moves as they stand,
//! `read` both together, `write` projects to load.

mod code;
mod data;
mod read;
mod tags;
mod write;

use armill_core::frame::Isometry;

use super::number::fixed;
use super::spelling::{Anew, Part, respelled};
use crate::convention::Convention;

pub use read::read;
pub use write::write;

/// The attributes of a pose.
const KEYS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Decimals of mm and of deg.
const DECIMALS: [usize; 2] = [3, 4];

/// Spells a pose in place of `before`, the attributes of a value: ` key="0" x="1.000" ... shoulder="lefty"`.
///
/// An attribute that was left out for zero is written where it no longer is.
pub(super) fn spell((pose, anew): (&Isometry, Anew), before: &str, out: &mut String) {
    let values = Convention::Staubli.numbers_of(pose);
    let attributes = tags::attributes(Part { at: 0, text: before });
    let mut numbers = Vec::new();
    let mut missing = String::new();
    let keys = KEYS.iter().zip(values).enumerate();
    for (index, (key, value)) in keys.filter(|(index, _)| anew.holds(*index)) {
        let decimals = DECIMALS[index / 3];
        match attributes.iter().find(|attribute| attribute.name == *key) {
            Some(attribute) => numbers.push((attribute.value.range(), value, decimals)),
            None => {
                let said = fixed(value, decimals);
                if said.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
                    missing.push_str(&format!(" {key}=\"{said}\""));
                }
            }
        }
    }
    numbers.sort_by_key(|(place, ..)| place.start);
    // Behind the closing quote of the last of them.
    let given = numbers.last().map(|(place, ..)| place.end + 1);
    let end = given.unwrap_or(before.trim_end().len()).min(before.len());
    respelled(before.get(..end).unwrap_or(before), &numbers, out);
    out.push_str(&missing);
    out.push_str(before.get(end..).unwrap_or_default());
}

#[cfg(test)]
mod tests;
