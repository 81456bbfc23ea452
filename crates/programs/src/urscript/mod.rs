//! URScript: `.script`, of controllers of Universal Robots.
//!
//! | statement | read as |
//! |---|---|
//! | `movej` | a joint move: to joints, to a pose, to `get_inverse_kin(pose, qnear)` |
//! | `movel`, `movep` | a straight move |
//! | `movec(via, end)` | a circular move |
//! | `set_tcp(p[...])` | the tool |
//! | `pose_trans(Table, p[...])` with a name that has no value | a target in a feature of the installation, a frame that is not known |
//! | `name = ...` | a pose, joints or a number for later lines |
//!
//! A pose is `p[x, y, z, rx, ry, rz]` in m and rad (rotation vector), in the robot base. In `pose_trans(a, b)` the
//! frame is a and the target b. Numbers may be computed from numbers. Moves controlled by a signal (`servoj`, `speedl`,
//! ...) have no target and are problems. `v` of straight moves is m/s; a move with `t` does not give the tip speed.
//!
//! Source: public programs for `popup(s, title, warning, error, blocking)`, `sleep`.
//!
//! `[recalled]`, not in a sample: the order of the arguments of `movep` and `movec`, `get_inverse_kin` and `qnear`,
//! `d2r`, `pose_inv`, and that the default values chosen by `write` (accelerations, joint speed) suit all arms.
//!
//! In reading order: `value` (values of expressions), `read` (statements), `expression` (how expressions are read),
//! `motion` (moves), `spell` (a pose), `write` (programs to load).

mod expression;
mod motion;
mod read;
mod spell;
mod value;
mod write;

pub use self::read::read;
pub(super) use self::spell::spell;
pub use self::write::write;

use super::tokens::Syntax;

/// Remarks begin with `#`; texts are in `"` or `'`.
const SYNTAX: Syntax = Syntax {
    remark: '#',
    quotes: &['"', '\''],
};
