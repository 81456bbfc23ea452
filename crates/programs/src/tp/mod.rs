//! FANUC TP: listings of programs, `.ls`.
//!
//! | in the listing | here |
//! |---|---|
//! | `UF : 2, UT : 1` of a position | its user frame and tool; `F` means those selected by `UFRAME_NUM=`, `UTOOL_NUM=`; 0 is the robot base, the flange |
//! | `PR[9,1]=..` to `PR[9,6]=..`, `PR[9]=P[1]`, then `UFRAME[2]=PR[9]` or `UTOOL[1]=PR[9]` | frame or tool given as numbers |
//! | `CONFIG : 'N U T, 0, 0, 0'` | F flip; D lower arm; B rear; then the turns of axes 1, 4, 6 |
//! | `J`, `L`, `C` via and end, `S` | joint; straight; arc; a curve through points, replaced by straight lines |
//! | three `A` in a row | straight to the first, then an arc through the second to the third |
//! | `mm/sec`, `cm/min`, `inch/min` | tip speed; `%`, `deg/sec`, `sec`, `msec` do not give it |
//! | `PR[1]`, `P[R[1]]` as a target | [`Target::Elsewhere`](super::Target::Elsewhere) |
//!
//! Turns are `floor((|angle| + 180 deg) / 360 deg)` with the sign of the angle. Source: the sample of the RoboDK post,
//! and public listings from controllers for tabs, `-.858`, unset values, groups and moves over two lines.
//! `[recalled]`: on some systems the three turns are those of axes 4, 5, 6; rows of `A`; maximum lengths of names,
//! remarks and programs.
//!
//! In reading order: `statement` (the lines between /MN and /POS), `position` (the lines after /POS), `frames`
//! (registers, frames and tools), `read` (statements), `motion` (moves), `write` (listings to load).

mod frames;
mod motion;
mod position;
mod read;
mod statement;
mod write;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use self::position::KEYS;
use super::spelling::{Part, Respelling, respelled};

pub use read::read;
pub use write::write;

/// Decimals that controllers write, of mm and of deg.
const DECIMALS: usize = 3;

/// Writes a pose in place of `before`: `X = 1.0 mm, Y = ..., R = 2.0`.
pub(super) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    let values = Convention::Fanuc.numbers_of(pose);
    let whole = Part { at: 0, text: before };
    let numbers: Vec<_> = whole
        .split(|c| c == ',')
        .filter_map(|field| {
            let (key, number) = position::field(field)?;
            let index = KEYS.iter().position(|known| key.eq_ignore_ascii_case(known))?;
            respelling
                .includes(index)
                .then(|| (number.range(), values[index], DECIMALS))
        })
        .collect();
    respelled(before, &numbers, out);
}
