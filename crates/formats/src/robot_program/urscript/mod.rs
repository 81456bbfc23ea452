//! URScript: `.script`, of controllers of Universal Robots.
//!
//! | statement | what it becomes |
//! |---|---|
//! | `movej` | a move of the joints: to joints, to a pose, to `get_inverse_kin(pose, qnear)` |
//! | `movel`, `movep` | a straight move |
//! | `movec(via, end)` | a circular move |
//! | `set_tcp(p[...])` | the tool |
//! | `name = ...` | a pose, joints or a number that later lines name |
//!
//! A pose is `p[x, y, z, rx, ry, rz]` in m and rad (rotation vector), in the base of the robot; of `pose_trans(a, b)` the
//! frame is a and the target b. Numbers may be computed from numbers. Moves that follow a signal (`servoj`, `speedl`, ...)
//! have no target, and are problems. `v` of straight moves is m/s; a move with `t` says nothing of the tip.
//!
//! `[recalled]`, not in a sample: order of arguments of `movep` and `movec`, `get_inverse_kin` and `qnear`, `d2r`,
//! `pose_inv`, and that numbers beside poses that `write` chooses (accelerations, speed of joints) suit every arm.
//!
//! In reading order: `read` statements; `motion` moves; `value` what expressions mean; `spell` a pose; `write` the
//! program out.

mod motion;
mod read;
mod spell;
mod value;
mod write;

pub use self::read::read;
pub(super) use self::spell::spell;
pub use self::write::write;

use super::tokens::Syntax;

/// Remarks from `#` on; texts in `"` or `'`.
const SYNTAX: Syntax = Syntax {
    remark: '#',
    quotes: &['"', '\''],
};
