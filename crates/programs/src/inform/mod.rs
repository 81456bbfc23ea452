//! Yaskawa INFORM: jobs, `.jbi`.
//!
//! A job lists its positions first (`//POS`), then its instructions (`//INST`). Frame, tool, type and configuration of
//! positions remain valid until the next definition.
//!
//! | in the job | here |
//! |---|---|
//! | `///POSTYPE BASE`, `ROBOT` | poses in the robot's base |
//! | `///POSTYPE USER`, `///USER n` | poses in the controller's user frame n |
//! | `///POSTYPE PULSE` | [`Target::Elsewhere`](super::Target::Elsewhere): only the controller can convert pulses |
//! | `///POSTYPE ANGLE` | joints, deg |
//! | `///RCONF l,m,n,o,p,q` | l 0 flip, 1 none; m 1 lower arm; n 1 rear; o, p, q: axes R, T, S turned beyond 180 deg |
//! | `MOVJ`, `MOVL`, `MOVS` | joint; straight; a curve through points, replaced by straight lines |
//! | three `MOVC` in a row | straight to the first, then an arc through the second to the third |
//! | `V=` | mm/s; `VJ=`, `VR=`, `VE=` do not give the tip speed |
//!
//! A job of the RoboDK post has RCONF in another order (rear, lower, flip). It is recognised by that name in the job.
//!
//! Source: Yaskawa's manuals of data transmission (NX100, DX100) for the lists and RCONF; a public program that writes
//! jobs for ANGLE. `[recalled]`: Yaskawa's flip is axis B (5) bent the other way, as in armill; `FPT` ends an arc where
//! the next begins; parameters of `PL=`.
//!
//! In reading order: `position` (the list of positions), `read` (the instructions), `motion` (moves), `write` (jobs to
//! load).

mod motion;
mod position;
mod read;
mod write;

use armill_core::frame::Isometry;
use armill_formats::convention::Convention;

use super::spelling::{Part, Respelling, respelled};

pub use read::read;
pub use write::write;

/// Decimals of lengths in mm and of angles in deg that controllers since DX100 write.
const DECIMALS: [usize; 2] = [3, 4];

/// Writes a pose in place of `before`, six numbers between commas.
pub(super) fn spell(pose: &Isometry, respelling: Respelling, before: &str, out: &mut String) {
    let whole = Part { at: 0, text: before };
    let numbers: Vec<_> = whole
        .split(|c| c == ',')
        .zip(Convention::Yaskawa.numbers_of(pose))
        .enumerate()
        .filter(|(index, _)| respelling.includes(*index))
        .map(|(index, (part, value))| (part.trimmed().range(), value, DECIMALS[index / 3]))
        .collect();
    respelled(before, &numbers, out);
}
