//! KUKA KRL: `.src` with moves, `.dat` with the points that they name.
//!
//! | statement | read as |
//! |---|---|
//! | `PTP`, `SPTP`, `PTP_REL`, `SPTP_REL` | a joint move to axes or to a pose with S and T |
//! | `LIN`, `SLIN`, `SPL`, `LIN_REL`, `SLIN_REL` | a straight move; the course of a spline is not followed |
//! | `CIRC`, `SCIRC` | a circular move; a circle that continues by `CA` is a problem |
//! | `$BASE`, `$TOOL`, `BASE_DATA[n]`, `TOOL_DATA[n]`, `BAS(#BASE, n)`, `FDAT_ACT`, `WITH` | frame and tool |
//! | `$VEL.CP`, `$VEL`, `BAS(#CP_PARAMS, v)`, `LDAT_ACT`, `SVEL_CP(v)` | the speed of the tip, m/s |
//!
//! A component missing in `{...}` keeps its previous value. S: bit 0 rear, bit 1 elbow not lower, bit 2 flip; T: bit i
//! is 1 where axis i + 1 is below zero. Both are returned unchanged (the `turns` of a [`Target::Pose`](super::Target)
//! are the bits of A1 to A6). Frame 0 is the base of the robot, tool 0 its flange, as on a controller whose `$ROBROOT`
//! is null. External axes are kept in the text and are not joints in armill.
//!
//! `[recalled]`, not in a sample: the content of `WITH`, `FDAT`'s fields other than number and `IPO_FRAME`, `SPL`, the
//! geometric operator `P1:{...}`, that `LIN_REL` is relative to the base unless `#TOOL` follows, that the positions in
//! `$CONFIG.DAT` have names like `XHOME`.
//!
//! In reading order: `aggregate` (`{...}`), `points` (the content of data files), `state` (while lines are read),
//! `read` (statements), `motion` and `relative` (moves), `modal` (modal settings), `write` (programs to load).

mod aggregate;
mod modal;
mod motion;
mod points;
mod read;
mod relative;
mod state;
mod write;

pub(super) use self::aggregate::spell;
pub use self::read::read;
pub use self::write::write;

use super::tokens::Syntax;

/// Remarks begin with `;`; texts are in `"`, bits and hexadecimals in `'`.
const SYNTAX: Syntax = Syntax {
    remark: ';',
    quotes: &['"', '\''],
};
