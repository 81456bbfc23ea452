//! Staubli VAL3: projects of controllers CS8C and CS9 (s7, s8), a folder of `.pjx`, `.dtx`, `.pgx`.
//!
//! The data (`.dtx`) contain the points; the programs (`.pgx`) contain the moves.
//!
//! | in the project | here |
//! |---|---|
//! | `pointRx`: `x y z rx ry rz`, mm and deg | a pose in the frame that `fatherId` names |
//! | `shoulder`, `elbow`, `wrist` | righty rear; enegative lower; wnegative flip; `ssame`, `sfree`, ... do not give the posture |
//! | `jointRx`: `j1` to `j6`, deg | joints |
//! | `frame`, `tool` with `fatherId` | given, resolved to `world` and `flange` |
//! | `mdesc`: `tmax`, mm/s | tip speed in `movel`, `movec`; 99999 and more is not a limit |
//! | `movej`, `movel`, `movec` via, end | joint; straight; arc |
//! | `appro(..)`, `here(..)`, `p[i]`, points of libraries, parameters | [`Target::Elsewhere`](super::Target::Elsewhere) |
//!
//! A missing attribute is zero, as controllers write it. The program `start` is read, or the only one, or the file
//! that comes first. Programs that it calls are read if they are given.
//!
//! Source: the RoboDK posts for VAL3, their data and their order of the posture words. `[recalled]`: 99999 means no
//! limit; the length of names; `world` if no `fatherId` is given; the elbow behind axis 1.
//!
//! In reading order: `tags` (the part of XML that is needed), `data` (points and their frames), `code` (moves in the
//! code), `read` (both together), `write` (projects to load).

mod code;
mod data;
mod read;
mod tags;
mod write;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use super::number::fixed;
use super::spelling::{Part, Respelling, respelled};

pub use read::read;
pub use write::write;

/// The attributes of a pose.
const KEYS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Decimals of mm and of deg.
const DECIMALS: [usize; 2] = [3, 4];

/// Writes a pose in place of `before`, the attributes of a value: ` key="0" x="1.000" ... shoulder="lefty"`.
///
/// An attribute that was left out because it was zero is added if it is no longer zero.
pub(super) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    let values = Convention::Staubli.numbers_of(pose);
    let attributes = tags::attributes(Part { at: 0, text: before });
    let mut numbers = Vec::new();
    let mut missing = String::new();
    let keys = KEYS.iter().zip(values).enumerate();
    for (index, (key, value)) in keys.filter(|(index, _)| respelling.includes(*index)) {
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
    // After the closing quote of the last one.
    let given = numbers.last().map(|(place, ..)| place.end + 1);
    let end = given.unwrap_or(before.trim_end().len()).min(before.len());
    respelled(before.get(..end).unwrap_or(before), &numbers, out);
    out.push_str(&missing);
    out.push_str(before.get(end..).unwrap_or_default());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_written_with_attributes_that_were_left_out() {
        let pose = Convention::Staubli
            .pose(&[0.0, 2.0, 0.0, 0.0, 0.0, 90.0])
            .unwrap();
        let mut out = String::new();
        spell(&pose, Respelling::Pose, " key=\"3\" ", &mut out);
        assert_eq!(out, " key=\"3\" y=\"2.000\" rz=\"90.0000\" ");
        out.clear();
        spell(
            &pose,
            Respelling::Pose,
            " rz=\"1\" z=\"5\" wrist=\"wsame\"",
            &mut out,
        );
        assert_eq!(out, " rz=\"90.0000\" z=\"0.000\" y=\"2.000\" wrist=\"wsame\"");
    }
}
